# SPDX-License-Identifier: BSD-3-Clause
"""What a saved change costs `livens view --watch`: processor time of the program until the page has been told.

    benchmarks/watching.py build/release/livens [FILE.toml ...]

Without files: a chain of ten bodies. Each is changed 20 times. The kernel's count of the process (all its threads, those
that have ended among them) is divided by 20; what the program takes while it waits is measured, too.
"""
import json
import os
import pathlib
import socket
import subprocess
import sys
import tempfile
import time
import urllib.parse

CHANGES, BOUND = 20, 0.3


def chain(n):
    """n rods in a row, which fall from level."""
    text = 'format = 1\ntitle = "a chain"\ngravity = [0, 0, -9.81]\n'
    for k in range(n):
        text += (f'[[body]]\nname = "rod {k}"\nshape = {{ box = [0.2, 0.02, 0.02] }}\ndensity = 7850\nposition = [{0.2 * k + 0.1:.2f}, 0, 0]\n'
                 f'[[joint]]\nname = "pin {k}"\ntype = "revolute"\nbetween = ["{f"rod {k - 1}" if k else "world"}", "rod {k}"]\n'
                 f"at = [{0.2 * k:.2f}, 0, 0]\naxis = [0, 1, 0]\n")
    return text + "[time]\nend = 2\n"


def processor_time(process):
    """s, of all threads."""
    fields = pathlib.Path(f"/proc/{process.pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def next_run(stream):
    """The data of the next event that brings a run."""
    kind = None
    for line in stream:
        if line.startswith(b"event: "):
            kind = line[7:].strip()
            if kind == b"fault":
                raise SystemExit("the scenario could not be solved")
        elif line.startswith(b"data: ") and kind == b"run":
            return line
    raise SystemExit("the program has ended")


def measure(program, text, folder):
    file = folder / "watched.toml"
    file.write_text(text)
    process = subprocess.Popen([program, "view", "--watch", file, "--address", "--quiet"], stdout=subprocess.PIPE, text=True)
    try:
        address = urllib.parse.urlsplit(process.stdout.readline().strip())
        with socket.create_connection(("127.0.0.1", address.port)) as page:
            page.sendall(f"GET {address.path}events?0 HTTP/1.1\r\nHost: {address.netloc}\r\n\r\n".encode())
            stream = page.makefile("rb")
            next_run(stream)
            begin, waited = processor_time(process), time.monotonic()
            time.sleep(2)
            idle = (processor_time(process) - begin) / (time.monotonic() - waited)
            begin, wall = processor_time(process), time.monotonic()
            for k in range(CHANGES):
                file.write_text(text + f"# {k}\n")
                size = len(next_run(stream))
            return {"cpu_seconds": (processor_time(process) - begin) / CHANGES, "wall_seconds": (time.monotonic() - wall) / CHANGES,
                    "bytes": size, "idle_share": idle}
    finally:
        process.terminate()
        process.wait()


def main():
    if len(sys.argv) < 2:
        raise SystemExit(__doc__)
    program, files = sys.argv[1], [pathlib.Path(file) for file in sys.argv[2:]]
    worst = 0
    with tempfile.TemporaryDirectory() as folder:
        for name, text in [(file.name, file.read_text()) for file in files] or [("chain of 10 bodies", chain(10))]:
            found = measure(program, text, pathlib.Path(folder))
            worst = max(worst, found["cpu_seconds"])
            print(json.dumps({"scenario": name, **{key: round(value, 5) for key, value in found.items()}}))
    raise SystemExit(worst >= BOUND)


if __name__ == "__main__":
    main()
