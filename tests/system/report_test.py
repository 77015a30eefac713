# SPDX-License-Identifier: BSD-3-Clause
"""The report as a file: what is in it is read here without any code of livens, nor of the page's.

    LIVENS_PROGRAM=build/release/livens python3 report_test.py [CLASS ...]

tests/report/browser.mjs opens it in a browser.
"""
import base64
import bisect
import hashlib
import http.client
import itertools
import json
import math
import os
import pathlib
import re
import select
import signal
import socket
import struct
import subprocess
import time
import unittest
import urllib.parse
import zlib

from program_test import IO, NOT_CONVERGED, PROGRAM, SMALL, SOURCE, SUSPECT, USAGE, ProgramTest, text_with

RUN = re.compile(r'<script type="application/json" class="run">(.*?)</script>\n'
                 r'<script type="text/plain" class="numbers">([A-Za-z0-9+/=]*)</script>', re.S)
HOSTILE = '</script><img src=x onerror=alert(1)>'


class Page:
    """One run of a page."""

    def __init__(self, text, which=0):
        self.text = text
        meta, numbers = RUN.findall(text)[which]
        self.meta = json.loads(meta)
        plain, at, self.arrays = zlib.decompress(base64.b64decode(numbers, validate=True)), 0, {}
        for name, (kind, count) in self.meta["arrays"].items():
            size, letter = {"f8": (8, "d"), "f4": (4, "f"), "u4": (4, "I"), "d1": (4, "I"), "d2": (4, "I")}[kind]
            block = plain[at:at + size * count]
            mixed = bytearray(size * count)
            for k in range(size):   # bytes of one significance lie together
                mixed[k::size] = block[k * count:(k + 1) * count]
            numbers = struct.unpack(f"<{count}{letter}", mixed)
            self.arrays[name] = numbers if kind[0] != "d" else self.summed(name, numbers, int(kind[1]))
            at += size * count
        assert at == len(plain), "numbers that no name belongs to"

    def summed(self, name, differences, order):
        """Whole multiples of a step for each channel, from their differences modulo 2^32."""
        lows, steps, numbers = self.arrays[f"{name}_low"], self.arrays[f"{name}_step"], []
        n = len(differences) // max(len(lows), 1)
        for channel, (low, step) in enumerate(zip(lows, steps)):
            one = [(x >> 1) ^ -(x & 1) for x in differences[channel * n:(channel + 1) * n]]
            for _ in range(order):
                one = list(itertools.accumulate(one))
            whole = [(x + 2**31) % 2**32 - 2**31 for x in one]
            numbers += [math.nan if x < 0 else low + x * step for x in whole]
        return numbers

    def stored(self, body, node):
        """X of a body at a node, as 12 numbers."""
        pose, forms = self.meta["pose"], self.meta["pose"]["forms"]
        nodes = len(self.arrays["pose"]) // sum(forms)
        first = sum(forms[:body])
        x = [self.arrays["pose"][(first + i) * nodes + node] for i in range(forms[body])]
        if forms[body] == 12:
            return x
        if forms[body] == 3:
            return x + [math.nan] * 9
        w, a, b, c = x[3:]
        s = 1 / (w * w + a * a + b * b + c * c)
        return x[:3] + [(w * w + a * a - b * b - c * c) * s, 2 * (a * b + w * c) * s, 2 * (a * c - w * b) * s,
                        2 * (a * b - w * c) * s, (w * w - a * a + b * b - c * c) * s, 2 * (b * c + w * a) * s,
                        2 * (a * c + w * b) * s, 2 * (b * c - w * a) * s, (w * w - a * a - b * b + c * c) * s]

    def pose(self, body, t):
        """By Lagrange's products."""
        pose, ends = self.meta["pose"], self.arrays["pose_end"]
        e = min(bisect.bisect_right(ends, t), len(ends) - 1) - 1
        s, p, nodes = (t - ends[e]) / (ends[e + 1] - ends[e]), pose["degree"], pose["nodes"]
        first = e * (p if pose["continuous"] else p + 1)
        M = [math.prod((s - nodes[b]) / (nodes[a] - nodes[b]) for b in range(p + 1) if b != a) for a in range(p + 1)]
        if W := self.arrays["pose_weight"]:
            M = [m * W[first + a] for a, m in enumerate(M)]
            M = [m / sum(M) for m in M]
        X = [self.stored(body, first + a) for a in range(p + 1)]
        return [sum(m * x[i] for m, x in zip(M, X)) for i in range(12)]

    def curve_at_start(self, kind, index, name):
        """Of a series the value at the start, from the right."""
        for c, channel in enumerate(self.meta["channels"]):
            if (channel["kind"], channel["index"], channel["name"]) == (kind, index, name):
                count = len(self.arrays["curve"]) // len(self.meta["channels"])
                return self.arrays["curve"][c * count]
        raise KeyError((kind, index, name))


class Report(ProgramTest):
    def report(self, *runs, output="page.html"):
        self.expect(0, "report", *(runs or ("run.nc",)), "-o", output)
        return Page((self.folder / output).read_text(encoding="utf-8"))

    def sample(self, *arguments):
        return json.loads(self.expect(0, "sample", "run.nc", *arguments, "--json").out)

    def worst_pose(self, page, n=20):
        """Largest difference of positions and directors from `livens sample` at n instants."""
        start, end = page.meta["start"], page.meta["end"]
        times = [start + (end - start) * (math.sqrt(2) * k % 1) for k in range(n - 1)] + [end]
        worst = 0
        for b, body in enumerate(page.meta["bodies"]):
            at = [f for t in times for f in ("--at", repr(t))]
            for t, s in zip(times, self.sample("--body", body["name"], *at)["samples"]):
                mine = page.pose(b, t)
                theirs = s["position"] + (sum(s["directors_raw"], []) if s["directors_raw"] else [])
                worst = max([worst] + [abs(x - y) for x, y in zip(mine, theirs)])
        return worst

    def test_poses_are_those_of_sample(self):
        for name in ("four_bar", "double_pendulum_spatial", "lagrange_top"):
            with self.subTest(name):
                self.solve((SOURCE / f"examples/{name}.toml").read_text())
                page = self.report()
                self.assertEqual(page.meta["pose"]["precision"], "double")
                self.assertEqual(set(page.meta["pose"]["forms"]), {7}, "quaternions suffice")
                self.assertLess(self.worst_pose(page), 1e-13)

    def test_point_masses_and_elements_of_other_kinds(self):
        radau = text_with('family = "lobatto"\ndegree = 4', 'family = "radau"\ndegree = 3')
        stepped = text_with('family = "lobatto"\ndegree = 4', 'family = "midpoint"', text_with("elements = 10", "elements = 500"))
        for text in (SMALL, radau, stepped):
            self.solve(text)
            page = self.report()
            self.assertEqual(page.meta["pose"]["forms"][1], 3, "a point mass")
            self.assertLess(self.worst_pose(page), 1e-13)

    def test_directors_that_are_free_are_kept_whole(self):
        """Those of the family mixed are orthonormal in the mean only; of NURBS there are weights."""
        text = (SOURCE / "examples/backward.toml").read_text()
        elements = int(re.search(r"elements = (\d+)", text).group(1))
        weights = [1 + 0.3 * (k % 2) for k in range(elements + 4)]
        for basis, has_weights in (('"bspline"', False), (f'"nurbs"\nweights = {weights}', True)):
            self.write("small.toml", re.sub(r'basis = "\w+"', f"basis = {basis}", text))
            done = self.run_program("solve", "small.toml", "-o", "run.nc")
            self.assertIn(done.returncode, (0, SUSPECT), done.err)
            page = self.report()
            self.assertIn(12, page.meta["pose"]["forms"])
            self.assertEqual(len(page.arrays["pose_weight"]) > 0, has_weights)
            self.assertLess(self.worst_pose(page), 1e-13)

    def test_a_wrong_pose_would_be_seen(self):
        self.solve()
        page = self.report()
        pose = list(page.arrays["pose"])
        pose[7] += 1e-11
        page.arrays["pose"] = tuple(pose)
        self.assertGreater(self.worst_pose(page, 40), 1e-13)

    def test_joints_lie_where_the_scenario_has_them(self):
        self.solve((SOURCE / "examples/four_bar.toml").read_text())
        page = self.report()
        points = {"crank shaft": (0, 0, 0), "crank pin": (0, 0, 0.42), "rocker pin": (0.72, 0, 0.96),
                  "rocker shaft": (1, 0, 0)}

        def moved(body, v, is_point):
            if body < 0:
                return v
            X = page.pose(body, 0)
            return [(X[i] if is_point else 0) + sum(X[3 + 3 * k + i] * v[k] for k in range(3)) for i in range(3)]

        for joint in page.meta["joints"]:
            for side in ("first", "second"):
                for x, y in zip(moved(joint[side], joint[f"point_{side}"], True), points[joint["name"]]):
                    self.assertAlmostEqual(x, y, delta=1e-12, msg=joint["name"])
                axis = moved(joint[side], joint[f"axis_{side}"], False)
                self.assertAlmostEqual(abs(axis[1]), 1, delta=1e-12)

    def test_directions_of_joints_that_keep_none(self):
        """They are read from the rows: a universal joint's two axes, a line, a normal."""
        def one(kind, keys):
            return (f'format = 1\n[[body]]\nname = "b"\nmass = 1\ninertia = [1, 1, 1]\nposition = [1, 2, 3]\n'
                    f'rotation_vector = [0.3, -0.2, 0.5]\n[[joint]]\nname = "j"\ntype = "{kind}"\n'
                    f'between = ["world", "b"]\nat = [1, 2, 3]\n{keys}\n[time]\nend = 0.1\nelements = 4\n')
        for kind, keys, first, second in (
                ("universal", "axes = [[0, 0.6, 0.8], [1, 0, 0]]", (0, 0.6, 0.8), (1, 0, 0)),
                ("point_on_line", "axis = [0, 0.6, 0.8]", (0, 0.6, 0.8), None),
                ("point_in_plane", "axis = [0, 0.6, 0.8]", (0, 0.6, 0.8), None)):
            with self.subTest(kind):
                self.solve(one(kind, keys))
                page = self.report()
                joint, X = page.meta["joints"][0], page.pose(0, 0)
                self.assertAlmostEqual(abs(sum(a * b for a, b in zip(joint["axis_first"], first))), 1, delta=1e-12)
                if second:
                    axis = [sum(X[3 + 3 * k + i] * joint["axis_second"][k] for k in range(3)) for i in range(3)]
                    self.assertAlmostEqual(abs(sum(a * b for a, b in zip(axis, second))), 1, delta=1e-12)

    def test_series_are_those_of_sample(self):
        self.solve((SOURCE / "examples/furuta_pendulum.toml").read_text())
        page = self.report()
        for j, joint in enumerate(page.meta["joints"]):
            there = self.sample("--joint", joint["name"], "--at", "0")
            for part, name in ((part, f"{what} {x}") for what in ("force", "torque") for part, x in zip(there["right"][what], "xyz")):
                self.assertAlmostEqual(page.curve_at_start("reaction", j, name), part, delta=1e-5 * max(1, abs(part)), msg=name)
            self.assertAlmostEqual(page.curve_at_start("joint", j, "angle"), there["angle"], delta=1e-6)

    def test_loads_act_where_the_scenario_has_them(self):
        """Loads are functions: where they act is read from their forces. A torque acts nowhere."""
        loads = ('[[load]]\nname = "spring"\ntype = "spring"\nbetween = ["world", "brick"]\nstiffness = 7\nfree_length = 0.3\n'
                 'points = [[0, 2, 0], [0.1, 0.05, 0.03]]\n[[load]]\nname = "push"\ntype = "force"\nbody = "brick"\n'
                 'point = [0.1, 0.2, -0.3]\nvalue = [0, 3, 1]\n[[load]]\nname = "twist"\ntype = "torque"\nbody = "brick"\nvalue = [0, 0, 1]\n')
        self.solve(text_with("[time]", loads + "[time]"))
        spring, push, twist = self.report().meta["loads"]
        self.assertEqual([spring["first"], spring["second"]], [0, -1])
        for point, exact in ((spring["point_second"], (0, 2, 0)), (spring["point_first"], (0.1, 0.05, 0.03)),
                             (push["point_first"], (0.1, 0.2, -0.3))):
            for x, y in zip(point, exact):
                self.assertAlmostEqual(x, y, delta=1e-12)
        self.assertEqual([push["point_second"], twist["point_first"], twist["point_second"]], [None] * 3)

    def test_names_are_text(self):
        names = [HOSTILE, "маятник", "振り子", "a<!--b", '"&amp;\\']
        text = SMALL.replace('"brick"', json.dumps(names[0])).replace('"bob"', json.dumps(names[1]))
        text = text.replace('name = "upper"', "name = " + json.dumps(names[2])).replace('name = "lower"', "name = " + json.dumps(names[3]))
        text = text.replace('title = "a brick on a rod"', "title = " + json.dumps(names[0] + names[4]))
        self.solve(text)
        page = self.report()
        self.assertEqual([b["name"] for b in page.meta["bodies"]], names[:2])
        self.assertEqual([j["name"] for j in page.meta["joints"]], names[2:4])
        self.assertEqual(page.meta["scenario"], text)
        self.assertNotIn("<img", page.text)
        script = (SOURCE / "src/livens/io/report/page.html").read_text(encoding="utf-8")
        for tag in ("<script", "</script", "<!--"):   # two more scripts of a run, one of the program
            more = {"<script": 3, "</script": 3, "<!--": -2}[tag]
            self.assertEqual(page.text.count(tag), script.count(tag) + more, tag)
        title = re.search("<title>(.*?)</title>", page.text, re.S).group(1)
        self.assertTrue(title.startswith("&lt;/script&gt;&lt;img"), title)

    def test_loads_nothing_and_admits_its_own_script_alone(self):
        self.solve()
        text = self.report().text
        policy = re.search(r'Content-Security-Policy" content="([^"]*)"', text).group(1)
        rules = dict(rule.strip().split(" ", 1) for rule in policy.split(";"))
        self.assertEqual(rules["default-src"], "'none'")
        self.assertNotIn("unsafe", policy)
        self.assertNotIn("http", policy)

        def hash_of(content):
            return "'sha256-" + base64.b64encode(hashlib.sha256(content.encode()).digest()).decode() + "'"

        scripts = re.findall(r'<script type="module">(.*?)</script>', text, re.S)
        styles = re.findall(r"<style>(.*?)</style>", text, re.S)
        packed = re.search(r'<script type="text/plain" id="code">([A-Za-z0-9+/=]*)</script>', text).group(1)
        scripts.append(zlib.decompress(base64.b64decode(packed, validate=True)).decode())
        self.assertEqual(" ".join(hash_of(s) for s in scripts), rules["script-src"], "the loader, and what it unpacks")
        self.assertNotIn("connect-src", rules)
        self.assertEqual([hash_of(s) for s in styles], [rules["style-src"]])
        self.assertEqual(set(re.findall(r'<script type="([^"]*)"', text)), {"module", "application/json", "text/plain"})
        outside = text.replace(scripts[0], "")
        self.assertIsNone(re.search(r'<(link|iframe|object|embed|img|base)\b|\bsrc=|@import|url\(|\son\w+="', outside))
        for name in ("three", "uplot"):
            self.assertRegex(scripts[1][:4000], rf"{name} \d.*MIT")
        self.assertLess(len(text), 400_000, "its script is compressed")

    def test_runs_that_are_not_right_say_so(self):
        poor = text_with("end = 0.5\nelements = 10\noutput = 0.1", "end = 50\nelements = 1")
        stopped = poor.replace('family = "lobatto"\ndegree = 4', 'family = "midpoint"\nmax_iterations = 1')
        pendulum = (SOURCE / "examples/double_pendulum_spatial.toml").read_text()
        coarse = re.sub(r"(?m)^output = .*\n", "", re.sub(r"elements = \d+", "elements = 3", pendulum))
        for text, code, status in ((stopped, NOT_CONVERGED, "not converged"), (coarse, SUSPECT, "suspect")):
            self.solve(text, code=code)
            page = self.report()
            self.assertEqual(page.meta["status"], status)
            self.assertNotEqual(page.meta["message"], "")
        self.solve(stopped, code=NOT_CONVERGED)
        page = self.report()
        self.assertEqual(page.meta["figures"]["elements"], 0)
        self.assertEqual(len(page.arrays["pose_end"]), 1, "nothing but the start")

    def test_two_runs(self):
        self.solve(output="run.nc")
        self.solve(text_with("elements = 10", "elements = 20"), output="b.nc")
        page = self.report("run.nc", "b.nc")
        self.assertEqual(len(RUN.findall(page.text)), 2)
        self.assertEqual([Page(page.text, k).meta["name"] for k in (0, 1)], ["run", "b"])

    def test_sizes(self):
        self.solve((SOURCE / "examples/four_bar.toml").read_text())
        self.assertLess(len(self.report().text.encode()), 850_000)
        self.assertLess((SOURCE / "src/livens/io/report/page.html").stat().st_size, 690_000)
        self.solve(hundred(5, 125))
        page = self.report()
        self.assertGreaterEqual(len(page.arrays["pose"]) / sum(page.meta["pose"]["forms"]), 1000)
        self.assertEqual(page.meta["pose"]["precision"], "rounded")
        self.assertLess(len(page.text.encode()), 3_000_000)
        self.assertEqual(page.meta["shapes"], 1, "boxes of a hundred sizes are one form")

    def test_long_runs_say_what_they_lost(self):
        for elements, precision, most in ((100, "rounded", 1e-6), (500, "thinned", 1e-3)):
            self.solve(hundred(elements / 25, elements))
            page = self.report()
            pose = page.meta["pose"]
            self.assertEqual(pose["precision"], precision)
            self.assertLess(len(page.text.encode()), 3_000_000)
            self.assertTrue(1e-9 < pose["orientation_loss"] < most, pose)
            page.meta["bodies"] = page.meta["bodies"][:1]   # enough to be sampled
            worst = self.worst_pose(page)
            self.assertGreater(worst, 1e-10)
            self.assertLess(worst, 2 * pose["orientation_loss"] + pose["position_loss"])

    def test_same_run_same_bytes(self):
        self.solve()
        self.report(output="a.html")
        self.report(output="b.html")
        self.assertEqual((self.folder / "a.html").read_bytes(), (self.folder / "b.html").read_bytes())

    def test_places(self):
        self.solve()
        before = (self.folder / "run.nc").read_bytes()
        self.expect(0, "report", "run.nc")
        self.assertIn("run.html", self.files())
        self.expect(USAGE, "report", "run.nc", "-o", "page.txt")
        self.expect(IO, "report", "run.nc", "-o", "run.nc")
        self.expect(IO, "report", "run.nc", "-o", "no/where.html")
        self.expect(IO, "report", "small.toml")
        done = json.loads(self.expect(0, "report", "run.nc", "-o", "page.html", "--json").out)
        self.assertEqual(done, {"report": "page.html", "bytes": (self.folder / "page.html").stat().st_size})
        self.assertEqual((self.folder / "run.nc").read_bytes(), before)
        self.assert_no_temporaries()


def hundred(end, elements):
    """A hundred pendulums, each of its own size."""
    bodies = "".join(
        f'[[body]]\nname = "pendulum {n}"\nshape = {{ box = [0.08, 0.08, {0.5 + 0.003 * n}] }}\ndensity = 2000\n'
        f"position = [{n // 10}, {n % 10}, 0]\ncenter_of_mass = [0, 0, {-0.25 - 0.0015 * n}]\n"
        f"rotation_vector = [0, {0.4 + 0.02 * n}, 0]\n[[joint]]\nname = \"pivot {n}\"\ntype = \"revolute\"\n"
        f'between = ["world", "pendulum {n}"]\nat = [{n // 10}, {n % 10}, 0]\naxis = [0, 1, 0]\n' for n in range(100))
    return (f'format = 1\ntitle = "a hundred pendulums"\ngravity = [0, 0, -9.81]\n{bodies}'
            f'[time]\nend = {end}\nelements = {elements}\n[method]\nfamily = "lobatto"\ndegree = 8\nestimate = "none"\n')


class View(ProgramTest):
    def serve(self, *arguments, **variables):
        process = subprocess.Popen([PROGRAM, "view", "run.nc", *arguments], cwd=self.folder, text=True, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, env={**os.environ, **variables})
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        self.assertTrue(select.select([process.stdout], [], [], 60)[0], "no address")
        return process, process.stdout.readline().strip()

    def get(self, address, path=None, host=None, method="GET"):
        parts = urllib.parse.urlsplit(address)
        connection = http.client.HTTPConnection("127.0.0.1", parts.port, timeout=20)
        self.addCleanup(connection.close)
        connection.request(method, path or parts.path, headers={"Host": host} if host else {})
        answer = connection.getresponse()
        return answer, answer.read()

    def test_serves_the_page_here_and_nothing_else(self):
        self.solve()
        self.expect(0, "report", "run.nc", "-o", "page.html")
        process, address = self.serve("--address")
        self.assertRegex(address, r"^http://127\.0\.0\.1:\d+/[0-9a-f]{32}/$")
        answer, body = self.get(address)
        self.assertEqual(answer.status, 200)
        self.assertEqual(answer.headers["Content-Type"], "text/html; charset=utf-8")
        self.assertEqual(body, (self.folder / "page.html").read_bytes())
        self.assertEqual(self.get(address, method="HEAD")[1], b"")
        for path, host in (("/", None), ("/favicon.ico", None), ("/../run.nc", None), (None, "evil.example")):
            self.assertEqual(self.get(address, path, host)[0].status, 404, (path, host))
        self.assertEqual(self.get(address)[0].status, 200, "still there")
        port = urllib.parse.urlsplit(address).port
        sockets = pathlib.Path("/proc/net/tcp").read_text(encoding="ascii").splitlines()
        listening = [line.split()[1] for line in sockets if line.split()[3] == "0A"]
        self.assertEqual([place for place in listening if place.endswith(f":{port:04X}")], [f"0100007F:{port:04X}"])
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(20), 0)

    def ask(self, address, lines, method="GET"):
        """The answer to a request of these lines."""
        parts = urllib.parse.urlsplit(address)
        with socket.create_connection(("127.0.0.1", parts.port), timeout=10) as browser:
            browser.sendall("\r\n".join([f"{method} {parts.path} HTTP/1.1", *lines, "", ""]).encode())
            answer = b""
            while piece := browser.recv(1 << 16):
                answer += piece
        return answer

    def test_names_of_fields_and_hosts_have_no_case(self):
        self.solve()
        _, address = self.serve("--address")
        port = urllib.parse.urlsplit(address).port
        for lines in ([f"host: 127.0.0.1:{port}"], [f"HOST:LocalHost:{port}"], ["Accept: */*", f"hOst: \t127.0.0.1:{port} \t"]):
            self.assertTrue(self.ask(address, lines).startswith(b"HTTP/1.1 200 "), lines)
        for lines in ([], ["host: evil.example"], [f"Host: 127.0.0.1:{port}", "Host: evil.example"], [f"X-Host: 127.0.0.1:{port}"],
                      [f"Host: 127.0.0.1:{port}.evil.example"], ["Host: 127.0.0.1"]):
            self.assertTrue(self.ask(address, lines).startswith(b"HTTP/1.1 404 "), lines)

    def test_who_is_slow_blocks_nobody(self):
        self.solve()
        process, address = self.serve("--address")
        port = urllib.parse.urlsplit(address).port

        def come():
            browser = socket.create_connection(("127.0.0.1", port), timeout=20)
            self.addCleanup(browser.close)
            return browser
        silent, dripping = [come() for _ in range(100)], come()
        asking = come()
        asking.sendall(f"GET {urllib.parse.urlsplit(address).path} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\n\r\n".encode())
        begin = time.monotonic()   # it takes nothing of its page meanwhile
        for _ in range(3):
            dripping.send(b"G")
            self.assertEqual(self.get(address)[0].status, 200)
        self.assertLess(time.monotonic() - begin, 3)
        self.assertEqual(silent[0].recv(1), b"", "one too many, the first of all")
        for _ in range(20):   # for ever, if each byte were waited for
            try:
                dripping.send(b"G")
            except OSError:
                break
            time.sleep(0.5)
        self.assertLess(time.monotonic() - begin, 9)
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(20), 0)

    def test_opens_the_browser_that_is_chosen(self):
        self.solve()
        browser = self.write("browser", "#!/bin/sh\nprintf '%s' \"$1\" > told\n")
        browser.chmod(0o755)
        process, address = self.serve(BROWSER=str(browser))
        told = self.folder / "told"
        for _ in range(200):
            if told.exists() and told.read_text() == address:
                break
            select.select([], [], [], 0.05)
        self.assertEqual(told.read_text(), address)
        process.send_signal(signal.SIGTERM)
        self.assertEqual(process.wait(20), 0)

    def test_ports(self):
        self.solve()
        _, address = self.serve("--address")
        port = urllib.parse.urlsplit(address).port
        done = self.expect(IO, "view", "run.nc", "--address", "--port", port)
        self.assertIn("127.0.0.1", done.err)
        self.expect(USAGE, "view", "run.nc", "--port", 70000)


if __name__ == "__main__":
    unittest.main()
