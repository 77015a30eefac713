# SPDX-License-Identifier: BSD-3-Clause
"""Problems of the comparison with what people have on their joints: dampers, springs, motors, bushings and gears."""
import math

from problems import GROUND, UPRIGHT, Body, Mechanism, about_y, chain


def product(a, b):
    """Of two quaternions: first b, then a."""
    (w, *u), (v, *s) = a, b
    return (w * v - sum(x * y for x, y in zip(u, s)),
            *(w * y + v * x + z for x, y, z in zip(u, s, cross(u, s))))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def turned(q, x):
    w, *u = q
    across = cross(u, x)
    return tuple(a + 2 * (w * b + c) for a, b, c in zip(x, across, cross(u, across)))


def plus(a, b):
    return tuple(x + y for x, y in zip(a, b))


def about(axis, angle):
    return (math.cos(angle / 2), *(a * math.sin(angle / 2) for a in axis))


def damped(n, stiffness=0.0):
    """The whirling chain of hinges with a damper, and perhaps a spring, at each."""
    m = chain(n, "hinge", 1)
    m.loads = [("torsion", k, stiffness, 0.5, 0.0) for k in range(n)]
    return m


def arm():
    """Seven links on hinges along z and y in turn, bent, whose controllers lead them to another pose against weight
    and friction."""
    m, place, turn = Mechanism(0.5), (0, 0, 0.15), UPRIGHT
    lengths = (0.19, 0.21, 0.19, 0.21, 0.19, 0.08, 0.12)
    masses = (4.0, 4.0, 3.0, 2.7, 1.7, 1.8, 0.8)
    pose = (0.3, 0.8, -0.4, -1.2, 0.5, 0.9, 0.2)
    way = (0.6, -0.5, 0.4, 0.7, -0.5, -0.6, 0.8)
    gains = ((400, 40), (400, 40), (200, 20), (200, 15), (50, 3), (30, 1), (10, 0.4))
    for k, (length, mass) in enumerate(zip(lengths, masses)):
        axis = (0.0, 0.0, 1.0) if k % 2 == 0 else (0.0, 1.0, 0.0)
        turn = product(turn, about(axis, pose[k]))
        wide = mass * (0.1 ** 2 + length ** 2) / 12
        m.bodies.append(Body(mass, (0.01, 0.02, 0.6 * length), (wide, 1.1 * wide, 0.5 * wide + mass * 0.02 ** 2), place, turn))
        m.joints.append(("hinge", k - 1, k, place, turned(turn, axis)))
        m.loads += [("control", k, *map(float, gains[k]), way[k]), ("torsion", k, 0.0, 0.02 * gains[k][1], 0.0)]
        place = plus(place, turned(turn, (0, 0, length)))
    m.points = [(3, (0, 0, lengths[3])), (6, (0, 0, lengths[6]))]
    return m


def suspension():
    """The corner of a car of examples/wheel_suspension.toml; the road leads the end of the tyre."""
    m = Mechanism(2)
    lower, upper, ball, pin = (0, 0.3, -0.2), (0, 0.35, 0.1), (0, 0.7, -0.2), (0, 0.6893993667531185, 0.07979926121197167)
    hub = (0, 0.7953851790413263, -0.0763000904638402)
    arm_center = plus((0, 0.5196996833765593, 0.08989963060598584), (0, -upper[1], -upper[2]))
    from_pin = plus(hub, (0, -pin[1], -pin[2]))
    m.bodies = [Body(300, (0, 0, 0), (50, 50, 50)),
                Body(4, (0, 0.2, 0), (0.06, 0.01, 0.06), lower),
                Body(3, arm_center, (0.03, 0.01, 0.03), upper),
                Body(25, from_pin, (0.6, 0.4, 0.4), pin)]
    along_x = (1, 0, 0)
    m.joints = [("slide", GROUND, 0, (0, 0, 0), (0, 0, 1)), ("hinge", 0, 1, lower, along_x), ("hinge", 0, 2, upper, along_x),
                ("hinge", 2, 3, pin, along_x), ("ball", 1, 3, ball)]
    tyre = plus(from_pin, (0, 0.015143761781259202, -0.3997132303028167))
    m.loads = [("spring", 0, 1, (0, 0.3, 0.35), (0, 0.28, 0), 60000.0, 4000.0, 0.72, 0.0, 0.0),
               ("spring", GROUND, 3, plus(pin, tyre[:2] + (tyre[2] - 0.3,)), tyre, 180000.0, 300.0, 0.3, 0.03, 3 * math.pi)]
    m.points = [(0, (0, 0, 0)), (3, from_pin)]
    return m


def figure():
    """Thirty bricks: trunk, neck and head, arms and legs of six each, the trunk on a bar that it swings about."""
    m, places = Mechanism(1), {}

    def add(name, parent, length, direction, axis, mass):
        """Along `direction` from the end of its parent, or from where that says."""
        place = places[parent] if isinstance(parent, str) else parent
        k, wide = len(m.bodies), mass * length ** 2 / 12 + 2e-3 * mass
        inertia = tuple(wide if d == 0 else 0.3 * wide + 1e-3 * mass for d in direction)
        spin = cross((0, 2, 0), place)   # all turn about the bar at 2 rad/s
        m.bodies.append(Body(mass, tuple(0.5 * length * d for d in direction), inertia, place, UPRIGHT, spin, (0, 2, 0)))
        m.joints.append(("hinge", names[parent] if parent in names else GROUND, k, place, axis))
        m.loads.append(("torsion", k, 0.0, 0.2, 0.0))
        places[name], names[name] = plus(place, tuple(length * d for d in direction)), k

    names, x, y, z = {}, (1, 0, 0), (0, 1, 0), (0, 0, 1)
    up, down = z, (0, 0, -1)
    add("pelvis", (0, 0, 0), 0.1, up, y, 8)
    for name, parent, length, axis, mass in (("lumbar", "pelvis", 0.12, x, 6), ("trunk", "lumbar", 0.12, y, 7),
                                             ("chest", "trunk", 0.18, z, 9), ("neck", "chest", 0.1, x, 1.5),
                                             ("head", "neck", 0.2, y, 4.5)):
        add(name, parent, length, up, axis, mass)
    for side, s in (("left", 1), ("right", -1)):
        outward = (0, s, 0)
        for name, parent, length, axis, mass in (
                ("clavicle", "chest", 0.18, x, 1), ("shoulder", "clavicle", 0.05, z, 1), ("upper arm", "shoulder", 0.28, x, 2.2),
                ("forearm", "upper arm", 0.25, z, 1.4), ("wrist", "forearm", 0.05, y, 0.5), ("hand", "wrist", 0.15, x, 0.5)):
            add(f"{side} {name}", f"{side} {parent}" if parent != "chest" else parent, length, outward, axis, mass)
        for name, parent, length, axis, mass in (
                ("hip", "side", 0.06, z, 1.5), ("buttock", "hip", 0.06, x, 1.5), ("thigh", "buttock", 0.4, y, 8),
                ("shin", "thigh", 0.4, y, 3.5), ("ankle", "shin", 0.05, x, 0.6)):
            if parent == "side":
                places[f"{side} side"], names[f"{side} side"] = (0, 0.1 * s, 0), 0
            add(f"{side} {name}", f"{side} {parent}", length, down, axis, mass)
        add(f"{side} foot", f"{side} ankle", 0.2, x, y, 0.9)
    m.points = [(names[name], m.bodies[names[name]].center) for name in ("head", "left hand", "right foot")]
    return m


def bushings(way):
    """Two bars on rubber bushes, let go from the horizontal. Its motion is in the plane y = 0, where the bushing is two
    slides and a hinge with their springs, between bodies without mass."""
    m = Mechanism(0.5)
    bars = ((0.6, 3.0, (5e4, 5e4, 8e4, 50, 30, 50), (100, 100, 150, 0.5, 0.3, 0.5)),
            (0.4, 1.5, (3e4, 3e4, 2e4, 30, 20, 30), (60, 60, 40, 0.3, 0.2, 0.3)))
    x, last = 0.0, GROUND
    for length, mass, stiffness, damping in bars:
        wide = mass * length ** 2 / 12
        bar, place = Body(mass, (length / 2, 0, 0), (1e-3 * mass, wide, wide), (x, 0, 0)), (x, 0, 0)
        if way == "bushings":
            m.bodies.append(bar)
            m.loads.append(("bushing", last, len(m.bodies) - 1, place, tuple(map(float, stiffness)), tuple(map(float, damping))))
        else:
            for kind, axis, entry in (("slide", (1, 0, 0), 0), ("slide", (0, 0, 1), 2), ("hinge", (0, 1, 0), 4)):
                m.bodies.append(bar if kind == "hinge" else Body(0, (0, 0, 0), (0, 0, 0), place))
                m.joints.append((kind, last if entry == 0 else len(m.bodies) - 2, len(m.bodies) - 1, place, axis))
                m.loads.append(("torsion", len(m.joints) - 1, float(stiffness[entry]), float(damping[entry]), 0.0))
        last = len(m.bodies) - 1
        m.points.append((last, (length, 0, 0)))
        x += length
    return m


def gears():
    """An arm of two links in the plane y = 0 with geared motors, 20 to 1 by an idler and 10 to 1; the second rides on
    the first link. Controllers of the motors' angles lead it up."""
    m, axis, s = Mechanism(0.5), (0, 1, 0), 0.6
    along = (s, -0.8)

    def on_first(r):
        return (r * along[0], 0, r * along[1])

    m.bodies = [Body(0.3, (0, 0, 0), (1e-4, 2e-4, 1e-4), (-0.3, 0, 0)), Body(0.5, (0, 0, 0), (6e-4, 1.2e-3, 6e-4), (-0.1, 0, 0)),
                Body(2, (0.25, 0, 0), (0.004, 0.044, 0.044), (0, 0, 0), about_y(*along)),
                Body(0.2, (0, 0, 0), (6e-5, 1.2e-4, 6e-5), on_first(0.4)),
                Body(1.2, (0.2, 0, 0), (0.002, 0.018, 0.018), on_first(0.5), about_y(0, -1))]
    m.joints = [("hinge", GROUND, 0, (-0.3, 0, 0), axis), ("hinge", GROUND, 1, (-0.1, 0, 0), axis),
                ("hinge", GROUND, 2, (0, 0, 0), axis), ("hinge", 2, 3, on_first(0.4), axis), ("hinge", 2, 4, on_first(0.5), axis)]
    m.loads = [("gear", 0, 1, -0.25), ("gear", 1, 2, -0.2), ("gear", 3, 4, -0.1),
               ("control", 0, 0.25, 0.04, -16.0), ("control", 3, 0.4, 0.04, 8.0),
               ("torsion", 2, 0.0, 0.5, 0.0), ("torsion", 4, 0.0, 0.2, 0.0)]
    m.points = [(2, (0.5, 0, 0)), (4, (0.4, 0, 0))]
    return m


def loaded(problem):
    """name -> Problem; `problem` is its maker."""
    return {
        "damped10": problem("Chain of 10 bricks on damped hinges, whirling, to 1 s", {"": damped(10)}, 60),
        "damped20": problem("Chain of 20 bricks on damped hinges, whirling, to 1 s", {"": damped(20)}, 60),
        "arm": problem("Arm of seven joints with controllers and friction, to 0.5 s", {"": arm()}, 300),
        "suspension": problem("Wheel suspension on a wavy road, to 2 s", {"": suspension()}, 1000),
        "figure": problem("Figure of 30 bodies on damped hinges, to 1 s", {"": figure()}, 200),
        "bushing": problem("Two bars on rubber bushes, to 0.5 s", {"slides and hinges": bushings(""), "bushings": bushings("bushings")},
                           1000),
        "gears": problem("Arm of two links with geared motors, to 0.5 s", {"": gears()}, 1000),
    }
