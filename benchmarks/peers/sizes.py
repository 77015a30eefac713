# SPDX-License-Identifier: BSD-3-Clause
"""Time and memory of livens where there is much of something, and of a tenth of it: the solution alone by the C++
interface, and the program with all that a user gets (reading, an estimate of the error, checks, the file)."""
import dataclasses
import json
import os
import pathlib
import subprocess
import tempfile
import time

import engines
import problems
import scenarios


@dataclasses.dataclass
class Size:
    title: str
    n: int
    make: object        # mechanism of n
    setting: object     # degree and elements of n


def box(_):
    """A brick that tumbles on a ball joint."""
    return problems.chain(1, "ball", 10)


SIZES = [
    Size("linear elements of one body", 1_000_000, box, lambda n: (1, n)),
    Size("bodies in a chain on ball joints, to 1 s", 1000, lambda n: problems.chain(n, "ball", 1),
         lambda n: (8, 50)),
    Size("unconnected boxes, to 1 s", 100, problems.separate, lambda n: (6, 100)),
]


# Scenarios beside this file, with the default accuracy.
CORNERS = [("hoop", "bead on a hoop that turns, through four points, 5 s", 0.1),
           ("hoop48", "the same through 48 points", 0.3)]


def peak(pid):
    """MiB so far; what a process inherits of its parent (as in getrusage) is not in it."""
    for line in pathlib.Path(f"/proc/{pid}/status").read_text().splitlines():
        if line.startswith("VmHWM:"):
            return int(line.split()[1]) / 1024
    return 0


def process(command, text=None):
    """(processor seconds, peak MiB, what it printed) of a process to its end."""
    with tempfile.TemporaryFile("w+") as given, tempfile.TemporaryFile("w+") as printed:
        given.write(text or "")
        given.seek(0)
        child = subprocess.Popen(command, stdin=given, stdout=printed, stderr=subprocess.DEVNULL)
        most, ended = 0, (0, 0, None)
        while not ended[0]:
            most = max(most, peak(child.pid))
            time.sleep(0.002)
            ended = os.wait4(child.pid, os.WNOHANG)
        child.returncode = os.waitstatus_to_exitcode(ended[1])
        printed.seek(0)
        return ended[2].ru_utime + ended[2].ru_stime, most, printed.read()


def solution(size, n):
    """Least seconds and peak memory of solve()."""
    m, (degree, elements) = size.make(n), size.setting(n)
    command, best, most = engines.ENGINES["livens_accuracy"].command(), float("inf"), 0
    for _ in range(3):
        _, most, said = process(command, m.text() + f"solve {degree}:{elements} 1\n")
        best = min(best, json.loads(said)["seconds"])
    return best, most


def program(size, n):
    livens = engines.ROOT / "build" / "release" / "livens"
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "size.toml"
        degree, elements = size.setting(n)
        file.write_text(scenarios.text(size.make(n), f"elements = {elements}", f'family = "lobatto"\ndegree = {degree}'))
        runs = [process([livens, "solve", file, "-o", file.with_suffix(".nc"), "--json"]) for _ in range(2)]
        status = json.loads(runs[0][2]).get("status", "failed")
    return min(r[0] for r in runs), runs[0][1], status


def corners():
    """Processor seconds of the program for what was slow once, from its start to its end, and what was asked."""
    livens, found = engines.ROOT / "build" / "release" / "livens", []
    for name, title, allowed in CORNERS:
        with tempfile.TemporaryDirectory() as folder:
            command = [livens, "solve", engines.HERE / f"{name}.toml", "-o", f"{folder}/run.nc", "-q"]
            found.append({"title": title, "seconds": min(process(command)[0] for _ in range(3)), "allowed": allowed})
    return found


def measured():
    bare = solution(dataclasses.replace(SIZES[-1], setting=lambda n: (1, 1)), 1)[1]
    found = []
    for size in SIZES:
        row = {"title": size.title, "n": size.n, "setting": size.setting(size.n)}
        for which, run in (("solution", solution), ("program", program)):
            (t1, m1, *_), (t2, m2, *status) = run(size, size.n // 10), run(size, size.n)
            row[which] = {"seconds": t2, "memory": m2, "time_ratio": t2 / t1 / 10,
                          "memory_ratio": (m2 - bare) / (m1 - bare) / 10, "status": status[0] if status else ""}
        found.append(row)
        print(f"{size.n} {size.title}: {row['solution']['seconds']:.3g} s, {row['solution']['memory']:.0f} MiB; "
              f"program {row['program']['seconds']:.3g} s, {row['program']['memory']:.0f} MiB", flush=True)
    return found
