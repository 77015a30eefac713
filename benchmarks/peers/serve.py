# SPDX-License-Identifier: BSD-3-Clause
"""What serve.h and mechanism.h are to engines in C++, for those in Python (of their virtual environment)."""
import dataclasses
import json
import os
import statistics
import sys
import time

import numpy as np

from problems import GROUND, Body, Mechanism

LOADS = ("torsion", "control", "spring", "bushing", "gear")


@dataclasses.dataclass
class JointLoad:
    """push - stiffness q - damping q' along the coordinate q of a joint."""
    stiffness: float = 0
    damping: float = 0
    push: float = 0


def read_mechanism(lines):
    m = Mechanism(1)
    for line in lines:
        key, *words = line.split()
        if key == "done":
            return m
        if key in ("name", "scenario"):
            setattr(m, key, words[0])
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
        elif key in LOADS:
            m.loads.append((key, v))
        else:
            m.joints.append((key, int(v[0]), int(v[1]), np.array(v[2:])))
    return m


def joint_loads(m):
    """Of every joint, all that acts along its coordinate."""
    found = [JointLoad() for _ in m.joints]
    for kind, (joint, *numbers) in m.loads:
        if kind in ("torsion", "control"):
            stiffness, damping, rest = numbers
            at = found[int(joint)]
            at.stiffness, at.damping, at.push = at.stiffness + stiffness, at.damping + damping, at.push + stiffness * rest
    return found


def of_kind(m, kind):
    return [numbers for name, numbers in m.loads if name == kind]


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
    load: JointLoad = None   # of a hinge or slide
    joint: int = None        # which of the mechanism's it hangs on


def place_of(m, body):
    return np.zeros(3) if body == GROUND else np.array(m.bodies[body].x)


def turn_of(m, body):
    return np.eye(3) if body == GROUND else turn(m.bodies[body].q)


def inside(m, body, x):
    """Body coordinates of a point in space, at the start."""
    return turn_of(m, body).T @ (np.asarray(x) - place_of(m, body))


def tree(m):
    """The branches, and the joints that are left: those that close loops, and rods."""
    branches, rest, loads = [Branch(body) for body in m.bodies], [], joint_loads(m)
    for k, joint in enumerate(m.joints):
        kind, first, second, numbers = joint
        b = branches[second]
        if kind == "rod" or b.parent is not None:
            rest.append(joint)
            continue
        R, w = turn_of(m, second), np.array(b.body.w)
        b.parent, b.kind, b.place = first, kind, inside(m, first, numbers[:3])
        b.R, b.axis = turn_of(m, first).T @ R, R.T @ numbers[3:6] if kind != "ball" else None
        b.load, b.joint = loads[k], k
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
            taken = []
            while not taken or (len(taken) < int(repeats) and sum(taken) < 10):
                solve = prepare(mechanism, setting.split(":"))
                start = time.process_time()
                points = solve()
                taken.append(time.process_time() - start)
            found = [[float(c) for c in p] for p in points()]
            answers.write(json.dumps({"seconds": statistics.median(taken), "points": found}) + "\n")
        except Exception as failure:   # whatever an engine throws is its answer
            answers.write(json.dumps({"failed": str(failure)[:200]}) + "\n")
