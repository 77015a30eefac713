# SPDX-License-Identifier: BSD-3-Clause
"""What serve.h and mechanism.h are to engines in C++, for those in Python (of their virtual environment)."""
import dataclasses
import json
import os
import sys
import time

import numpy as np

from problems import GROUND, Body, Mechanism


def read_mechanism(lines):
    m = Mechanism(1)
    for line in lines:
        key, *words = line.split()
        if key == "done":
            return m
        if key == "name":
            m.name = words[0]
            continue
        v = [float(w) for w in words]
        if key == "end":
            m.end = v[0]
        elif key == "gravity":
            m.gravity = v
        elif key == "body":
            m.bodies.append(Body(v[0], v[1:4], v[4:7], v[7:10], v[10:14], v[14:17], v[17:20]))
        elif key == "point":
            m.points.append((int(v[0]), np.array(v[1:])))
        else:
            m.joints.append((key, int(v[0]), int(v[1]), np.array(v[2:])))
    return m


def turn(q):
    w, x, y, z = q
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


@dataclasses.dataclass
class Branch:
    """A body as it hangs in a tree, at the start: place and orientation in its parent; axis and angular velocity
    against the parent in its own axes."""
    body: Body
    parent: int = None   # None: it is free
    kind: str = ""
    place: np.ndarray = None
    R: np.ndarray = None
    axis: np.ndarray = None
    rate: np.ndarray = None


def place_of(m, body):
    return np.zeros(3) if body == GROUND else np.array(m.bodies[body].x)


def turn_of(m, body):
    return np.eye(3) if body == GROUND else turn(m.bodies[body].q)


def inside(m, body, x):
    """Body coordinates of a point in space, at the start."""
    return turn_of(m, body).T @ (np.asarray(x) - place_of(m, body))


def tree(m):
    """The branches, and the joints that are left: those that close loops, and rods."""
    branches, rest = [Branch(body) for body in m.bodies], []
    for joint in m.joints:
        kind, first, second, numbers = joint
        b = branches[second]
        if kind == "rod" or b.parent is not None:
            rest.append(joint)
            continue
        R, w = turn_of(m, second), np.array(b.body.w)
        b.parent, b.kind, b.place = first, kind, inside(m, first, numbers[:3])
        b.R, b.axis = turn_of(m, first).T @ R, R.T @ numbers[3:6] if kind == "hinge" else None
        b.rate = R.T @ (w if first == GROUND else w - np.array(m.bodies[first].w))
    return branches, rest


def serve(prepare):
    """prepare(mechanism, setting) returns a callable that solves once; that returns another, which gives the
    points. The first alone is timed."""
    answers = os.fdopen(os.dup(1), "w", buffering=1)
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)   # what an engine prints stays off the answers
    mechanism = None
    for line in sys.stdin:
        order, setting, repeats = (line.split() + ["", "1"])[:3]
        if order == "mechanism":
            mechanism = read_mechanism(sys.stdin)
            continue
        try:
            least, total, done = float("inf"), 0.0, 0
            while done == 0 or (done < int(repeats) and total < 10):
                solve = prepare(mechanism, setting.split(":"))
                start = time.process_time()
                points = solve()
                taken = time.process_time() - start
                least, total, done = min(least, taken), total + taken, done + 1
            found = [[float(c) for c in p] for p in points()]
            answers.write(json.dumps({"seconds": least, "points": found}) + "\n")
        except Exception as failure:   # whatever an engine throws is its answer
            answers.write(json.dumps({"failed": str(failure)[:200]}) + "\n")
