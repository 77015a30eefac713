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


def scenario(m, degree, elements):
    def values(v):
        return "[" + ", ".join(repr(float(c)) for c in v) + "]"
    lines = ["format = 1", f"gravity = {values(m.gravity)}"]
    for i, b in enumerate(m.bodies):
        lines += ["[[body]]", f'name = "b{i}"', f"mass = {b.mass}", f"center_of_mass = {values(b.center)}",
                  f"inertia = {values(b.inertia)}", f"position = {values(b.x)}", f"quaternion = {values(b.q)}",
                  f"velocity = {values(b.v)}", f"angular_velocity = {values(b.w)}"]
    for j, (kind, first, second, at) in enumerate((*joint[:3], joint[3]) for joint in m.joints):
        ends = ", ".join('"world"' if i < 0 else f'"b{i}"' for i in (first, second))
        lines += ["[[joint]]", f'name = "j{j}"', f'type = "{"spherical" if kind == "ball" else "revolute"}"',
                  f"between = [{ends}]", f"at = {values(at)}"]
    lines += ["[time]", f"end = {m.end}", f"elements = {elements}", "[method]", 'family = "lobatto"',
              f"degree = {degree}", ""]
    return "\n".join(lines)


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
        file.write_text(scenario(size.make(n), *size.setting(n)))
        runs = [process([livens, "solve", file, "-o", file.with_suffix(".nc"), "--json"]) for _ in range(2)]
        status = json.loads(runs[0][2]).get("status", "failed")
    return min(r[0] for r in runs), runs[0][1], status


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
