# SPDX-License-Identifier: BSD-3-Clause
"""The problems of the comparison as data: bodies, joints and the points that are compared at the end.

A problem may be put in several ways that have the same motion (cubes on rods never turn: they are point masses);
every engine takes the way that suits it best. `text` is what engines in C++ read (mechanism.h), Python's take the
object. Joints are given at the start in space; the first ball, hinge or slide of a body hangs it, by its origin, on
the body before, others close loops. Coordinates of hinges and slides are zero at the start. Loads:

    torsion j k c r         k (q - r) + c q' against the coordinate q of joint j
    control j k c r         the same, but a controller, which livens is told as an expression
    spring a b p q k c l A w   between points of two bodies, k (length - l) + c length'; the first, if it is of the ground,
                            is led along z by A sin(w t)
    bushing a b x k c       of two frames at x with axes of the world at the start: six stiffnesses and dampings, by
                            displacements in axes of the first and the rotation vector
    gear i j ratio          the coordinate of joint j is ratio times that of joint i
"""
from __future__ import annotations

import dataclasses
import math

GROUND = -1
TURNED = (math.sqrt(0.5), 0, 0, math.sqrt(0.5))   # a quarter turn about z, as all quaternions w first
UPRIGHT = (1, 0, 0, 0)


@dataclasses.dataclass
class Body:
    mass: float
    center: tuple
    inertia: tuple            # principal, about the centre, along the body's axes
    x: tuple = (0, 0, 0)
    q: tuple = UPRIGHT
    v: tuple = (0, 0, 0)
    w: tuple = (0, 0, 0)


@dataclasses.dataclass
class Mechanism:
    end: float
    gravity: tuple = (0, 0, -9.81)
    name: str = ""
    bodies: list = dataclasses.field(default_factory=list)
    joints: list = dataclasses.field(default_factory=list)   # (kind, first, second, numbers)
    loads: list = dataclasses.field(default_factory=list)    # (kind, numbers)
    scenario: str = ""                                       # file of the same for livens, where it has loads
    points: list = dataclasses.field(default_factory=list)   # (body, its coordinates)

    def text(self):
        def words(*parts):
            flat = [w for p in parts for w in (p if isinstance(p, (tuple, list)) else (p,))]
            return " ".join(w if isinstance(w, str) else repr(w) for w in flat)
        lines = ["mechanism", *(words(key, value) for key, value in (("name", self.name), ("scenario", self.scenario))
                                if value), words("end", self.end), words("gravity", self.gravity)]
        lines += [words("body", *dataclasses.astuple(body)) for body in self.bodies]
        lines += [words(*entry) for entry in (*self.joints, *self.loads)]
        lines += [words("point", *point) for point in self.points]
        return "\n".join(lines + ["done", ""])


def chain(n, kind, end):
    """Bricks of 1 kg and 1 x 0.2 x 0.1 m in a zigzag along x and y. On balls they start at rest; on hinges, each
    across the one before, they whirl about the first, which is upright, at 1 rad/s."""
    m, x = Mechanism(end), (0, 0, 0)
    whirl = 1 if kind == "hinge" else 0
    for k in range(n):
        along_y = k % 2 == 1
        m.bodies.append(Body(1, (0.5, 0, 0), (0.05 / 12, 1.01 / 12, 1.04 / 12), x, TURNED if along_y else UPRIGHT,
                             (-whirl * x[1], whirl * x[0], 0), (0, 0, whirl)))
        axis = ((-1, 0, 0) if along_y else (0, 0, 1),) if kind == "hinge" else ()
        m.joints.append((kind, k - 1, k, x, *axis))
        m.points.append((k, (1, 0, 0)))
        x = (x[0] + (not along_y), x[1] + along_y, 0)
    return m


def links():
    """P14: two links of 1 m with unit inertia on parallel hinges, released from the horizontal."""
    m = Mechanism(5, (0, -10, 0))
    for k in range(2):
        m.bodies.append(Body(1, (0.5, 0, 0), (1, 1, 1), (k, 0, 0)))
        m.joints.append(("hinge", k - 1, k, (k, 0, 0), (0, 0, 1)))
        m.points.append((k, (1, 0, 0)))
    return m


def rods(way):
    """The paper's first double pendulum, two cubes on rods of 4 m between their centres, to 10 s."""
    m, s = Mechanism(10), 4 / math.sqrt(2)
    for k, edge in enumerate((1, 0.8)):
        mass = 1.5 * edge ** 3
        if way == "hinged masses":   # that end massless links, along x of the body
            slope = (math.cos(math.pi / 8), 0, -math.sin(math.pi / 8), 0)
            m.bodies.append(Body(mass, (4, 0, 0), (0, 0, 0), (s * k, 0, s * k), slope))
            m.joints.append(("hinge", k - 1, k, (s * k, 0, s * k), (0, 1, 0)))
            m.points.append((k, (4, 0, 0)))
            continue
        J = mass * edge ** 2 / 6 if way == "cubes on rods" else 0
        m.bodies.append(Body(mass, (0, 0, 0), (J, J, J), (s * (k + 1), 0, s * (k + 1))))
        m.joints.append(("rod", k - 1, k, (0, 0, 0), (0, 0, 0), 4))
        m.points.append((k, (0, 0, 0)))
    return m


def about_y(x, z):
    """The turn that lays the body's x axis along (x, 0, z)."""
    half = -0.5 * math.atan2(z, x)
    return (math.cos(half), 0, math.sin(half), 0)


def four_bar():
    """A crank-rocker of bars 0.04 x 0.02 m of steel swings in the plane y = 0 (examples/four_bar.toml)."""
    m = Mechanism(5)
    for length, x, z, along in ((0.42, 0, 0, (0, 1)), (0.9, 0, 0.42, (0.8, 0.6)), (1, 1, 0, (-0.28, 0.96))):
        mass = 7850 * length * 0.04 * 0.02
        J = (mass * 0.002 / 12, mass * (length ** 2 + 0.0004) / 12, mass * (length ** 2 + 0.0016) / 12)
        m.bodies.append(Body(mass, (length / 2, 0, 0), J, (x, 0, z), about_y(*along)))
    for first, second, x, z in ((-1, 0, 0, 0), (0, 1, 0, 0.42), (-1, 2, 1, 0), (2, 1, 0.72, 0.96)):
        m.joints.append(("hinge", first, second, (x, 0, z), (0, 1, 0)))
    m.points = [(0, (0.42, 0, 0)), (2, (1, 0, 0))]
    return m


def parallelograms(n=2):
    """P02: n + 1 upright links of 1 m and n bars between their tips; all lie on one line twice a turn."""
    m = Mechanism(10, (0, -9.81, 0))
    slender = (1e-3, 1 / 12, 1 / 12)
    m.bodies = [Body(1, (0.5, 0, 0), slender, (k, 0, 0), TURNED, (0, 0, 0), (0, 0, -1)) for k in range(n + 1)]
    m.bodies += [Body(1, (0.5, 0, 0), slender, (k, 1, 0), UPRIGHT, (1, 0, 0)) for k in range(n)]
    places = [(GROUND, k, k, 0) for k in range(n + 1)] + [(k, n + 1 + k, k, 1) for k in range(n)]
    places += [(k + 1, n + 1 + k, k + 1, 1) for k in range(n)]
    m.joints = [("hinge", first, second, (x, y, 0), (0, 0, 1)) for first, second, x, y in places]
    m.points = [(k, (1, 0, 0)) for k in range(n + 1)]
    return m


def separate(n):
    """n bricks that fall side by side, each with its own spin."""
    m = Mechanism(1)
    for k in range(n):
        m.bodies.append(Body(1, (0, 0, 0), (0.05 / 12, 1.01 / 12, 1.04 / 12), (2 * k, 0, 0), UPRIGHT,
                             (0, 0, 0), (1 + 0.01 * k, 2, 3)))
    return m


@dataclasses.dataclass
class Problem:
    title: str
    ways: dict                 # what it is called -> mechanism
    steps: int = 400           # of the reference
    digits: tuple = ()         # published: where the last of the points is at the end
    quick: bool = False        # part of --quick
    chain: tuple = ()          # kind of joint, bodies
    loaded: bool = False       # what people have: part of --loaded
    asked: bool = False        # to be quicker, asked for an accuracy, than others in their best settings


def table():
    import loaded   # which is made of what stands above
    lengths = (2, 10, 20, 50, 100)
    problems = {
        "bricks": Problem("P16: two bricks on ball joints, to 2 s", {"": chain(2, "ball", 2)}, quick=True,
                          digits=(0.644182606655, -0.291228917392, -1.136547655061)),
        "rods": Problem("Rod pendulum: two cubes on rods between their centres, to 10 s",
                        {way: rods(way) for way in ("cubes on rods", "masses on rods", "hinged masses")}, 1000),
        "links": Problem("P14: two links on parallel hinges, to 5 s", {"": links()}, 1000),
        "four_bar": Problem("Four-bar linkage, to 5 s", {"": four_bar()}, 1000),
        "parallelograms": Problem("P02: two parallelograms through their singular positions, to 10 s",
                                  {"": parallelograms()}, 1000),
    }
    for kind, word in (("ball", "ball joints"), ("hinge", "hinges, whirling")):
        for n in lengths:
            problems[f"{kind}s{n}"] = Problem(f"Chain of {n} bricks on {word}, to 1 s", {"": chain(n, kind, 1)}, 60,
                                              quick=n == 10 and kind == "ball", chain=(kind, n))
    problems |= loaded.loaded(lambda *a: Problem(*a, loaded=True, asked=True))
    for name in ("bricks", "rods", "four_bar"):
        problems[name].asked = True
    for name, problem in problems.items():
        for mechanism in problem.ways.values():
            mechanism.name = name
    return problems
