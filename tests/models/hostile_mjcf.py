# SPDX-License-Identifier: BSD-3-Clause
"""Ten thousand models of MuJoCo with a fault or a few each: lv.from_mjcf makes a model that a scenario holds, or raises an error
that has a code. MuJoCo itself ends the process for some, so that workers are made anew; what ends in our code is a failure."""
import collections
import os
import random
import re
import sys
import time
import unittest
import warnings

import menagerie

ASSETS, mujoco, lv = menagerie.packages()
import reads_mjcf   # noqa: E402

N, SEED, SECONDS = int(os.environ.get("LIVENS_MUTATIONS", "10000")), 1, 20
NUMBERS = ["0", "-1", "1e-300", "1e300", "nan", "inf", "-inf", "1e9", "0.1 0.2", "", "x", "1,2", "0x10", "99999999999999999999", "-0"]
PLAUSIBLE = ["0", "0.3", "2", "-0.4", "1e-3", "50", "-1 1", "0 .1 .2", "1 0 0", "1 0 0 0", "0 0 1"]
WORDS = ["../../etc/passwd", "/dev/zero", "a" * 3000, "\u00e9\u0000"[:1], "world", "p", "q", "a", "&#10;", "&lt;", "'.angle", "%s%n", "true", "free"]
TAGS = ["<freejoint/>", "<joint type='ball'/>", "<site name='p'/>", "<body name='a'/>", "<include file='none.xml'/>", "<geom type='mesh' mesh='m'/>",
        "<inertial pos='0 0 0' mass='0' diaginertia='0 0 0'/>", "<frame euler='1 2 3'>", "</body>", "<!--", "<![CDATA[", "<composite type='cable' count='3 1 1' size='1'/>",
        "<replicate count='3' offset='1 0 0'>", "<keyframe><key qpos='1 2 3'/></keyframe>", "<option gravity='nan 0 0'/>", "<equality><connect body1='a' body2='b' anchor='0 0 0'/></equality>"]


def seeds():
    """Each thing alone, and two of gymnasium, which mark values by other quotes."""
    folder = ASSETS / "gymnasium/envs/mujoco/assets"
    whole = [(folder / name).read_text().replace('"', "'") for name in ("ant.xml", "half_cheetah.xml")]
    return whole + [reads_mjcf.model(bodies, *more) for bodies, more, _, _ in reads_mjcf.CASES.values()]


def spoilt(text, draw):
    is_mild = draw.random() < 0.6   # what MuJoCo may well read
    for _ in range(draw.choice([1, 1, 1, 2, 3, 6])):
        kind = 2 if is_mild else draw.randrange(7)
        values = list(re.finditer(r"='([^']*)'", text))
        tags = list(re.finditer(r"<[^>]*>", text))
        if kind <= 2 and values:
            at = draw.choice(values)
            new = draw.choice(WORDS)
            if kind:   # one number of several
                parts = at[1].split() or [""]
                parts[draw.randrange(len(parts))] = draw.choice(PLAUSIBLE).split()[0] if is_mild else draw.choice(NUMBERS)
                new = " ".join(parts)
            text = f"{text[:at.start(1)]}{new}{text[at.end(1):]}"
        elif kind == 3 and len(tags) > 1:   # a tag more, or one less
            at = draw.choice(tags[1:])
            text = text[:at.start()] + draw.choice(["", at[0] * 2, draw.choice(TAGS) + at[0]]) + text[at.end():]
        elif kind == 4 and len(tags) > 1:   # two change places
            first, second = sorted(draw.sample(tags, 2), key=lambda t: t.start())
            text = text[:first.start()] + second[0] + text[first.end():second.start()] + first[0] + text[second.end():]
        elif kind == 5:
            at = draw.randrange(len(text) + 1)
            text = text[:at] + draw.choice(["", "\0", "<", "'", ">", "\u00e9", " "]) + text[at + draw.randrange(4):]
        else:
            word = draw.choice(["hinge", "slide", "box", "'a'", "'p'"])
            text = text[:1 + draw.randrange(len(text))] if draw.random() < 0.1 else \
                text.replace(word, draw.choice(["ball", "free", "slide", "mesh", "'b'"]), 1)
    return text


def outcome(text):
    """read, or the code of the error."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            m = lv.from_mjcf(text)
    except lv.InputError as error:
        if not error.code or not all(d.message for d in error.diagnostics):
            raise
        return error.code
    except OSError:   # what does not begin with < is the name of a file
        return "no file"
    if lv.load(text=m.to_toml()) != m:
        raise AssertionError("what is written is another model")
    return "read"


def worker(first, last, texts, to):
    """Writes a line for each before and after it."""
    sys.stderr.flush()
    os.dup2(os.open(os.devnull, os.O_WRONLY), 2)   # MuJoCo's own words
    for k in range(first, last):
        os.write(to, b"%d " % k)
        try:
            said = outcome(texts[k])
        except BaseException as error:
            where = error.__traceback__
            while where.tb_next is not None:
                where = where.tb_next
            said = f"FAILED {type(error).__name__}: {error} ({where.tb_frame.f_code.co_filename}:{where.tb_lineno})"
        os.write(to, said.encode("utf-8", "replace").replace(b"\n", b" ")[:1000] + b"\n")
    os._exit(0)


def run(texts):
    """What becomes of each; `ended` where MuJoCo takes the process with it, `late` after some seconds."""
    found, k = [], 0
    while k < len(texts):
        get, put = os.pipe()
        child = os.fork()
        if child == 0:
            worker(k, min(k + 500, len(texts)), texts, put)
        os.close(put)
        said = listen(get, child)
        os.close(get)
        os.waitpid(child, 0)
        lines = said.decode("utf-8", "replace").splitlines()
        done = [line.partition(" ")[2] for line in lines]
        if done and not said.endswith(b"\n"):
            done[-1] = "ended"
        found += done
        k = len(found)
    return found


def listen(get, child):
    """All that it says; it is ended where it says nothing for some seconds."""
    import select
    import signal
    said, last = b"", time.monotonic()
    while True:
        ready, _, _ = select.select([get], [], [], 1)
        if ready:
            part = os.read(get, 65536)
            if not part:
                return said
            said, last = said + part, time.monotonic()
        elif time.monotonic() - last > SECONDS:
            os.kill(child, signal.SIGKILL)
            last = time.monotonic()


class EndsInNoOtherWay(unittest.TestCase):
    def test_models_with_faults_are_read_or_refused_with_a_code(self):
        draw, good = random.Random(SEED), seeds()
        texts = [spoilt(draw.choice(good), draw) for _ in range(N)]
        found = run(texts)
        self.assertEqual(len(found), N)
        told = collections.Counter(word.partition(":")[0] for word in found)
        for word, n in told.most_common():
            print(f"| {word} | {n} |")
        failed = [(word, text) for word, text in zip(found, texts) if word.startswith("FAILED")]
        for word, text in failed[:5]:
            print(word, "\n", text[:3000])
        self.assertEqual(len(failed), 0)
        self.assertGreater(told["read"], N // 10)
        self.assertGreater(told["mjcf-read"], N // 10)
        self.assertLess(told["ended"], N // 100)

    def test_a_failure_of_our_own_would_be_seen(self):
        self.assertEqual(run([reads_mjcf.model(reads_mjcf.PAIR)]), ["read"])
        original, lv.from_mjcf = lv.from_mjcf, lambda text: 1 / 0
        try:
            self.assertIn("ZeroDivisionError", run(["<mujoco/>"])[0])
        finally:
            lv.from_mjcf = original


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[1:]])
