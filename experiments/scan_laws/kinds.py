# SPDX-License-Identifier: BSD-3-Clause
"""Random laws of one coordinate, by kind: a scenario each, and its true motion.

A case hangs on the seed, its kind and its number alone. Forces are made for a mass of 1 kg (or an inertia of
1 kg m^2) and then scaled; numbers have three or four digits, so that program and truth read the same ones.
"""
import math
import pathlib
import random
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import laws  # noqa: E402
import paper  # noqa: E402

G = 9.81
REAL = laws.REAL


class Choice(random.Random):
    """Random numbers of few digits."""

    def number(self, low, high, digits=3):
        return float(f"{self.uniform(low, high):.{digits}g}")

    def log(self, low, high, digits=3):
        return float(f"{math.exp(self.uniform(math.log(low), math.log(high))):.{digits}g}")

    def either(self):
        return self.choice((-1, 1))

    def chance(self, share):
        return self.random() < share

    def direction(self):
        vector = np.array([self.gauss(0, 1) for _ in range(3)])
        return vector / np.linalg.norm(vector)


class Case:
    """A scenario without [time] and [method], the motion it has, and what is asked for.

    law, x, v   of the coordinate; of a bead alone the truth is a quadrature
    place       function of coordinates: centres (time, 3) and triads (time, xyz, director)
    """

    def __init__(self, kind, number, text, law, x, v, end, place):
        self.kind, self.laws, self.number, self.text = kind, [kind], number, text
        self.law, self.x, self.v, self.end, self.place = law, x, v, end, place
        self.speed = None   # of a bead that keeps it

    def truth(self):
        """Found once; what it is off itself stands in `error`."""
        if self.speed is None:
            motion = laws.march(self.law, self.x, self.v, self.end)
            self.error, coordinate = motion.error, motion.coordinate
        else:
            self.error = 1e-15
            def coordinate(times): return self.law.by_length(self.x, self.speed, times)
        return Place(coordinate, self.place, self.end)


class Place:
    """What scans.errors asks of a true motion."""

    def __init__(self, coordinate, place, end):
        self.coordinate, self.place, self.ends = coordinate, place, [0, end]

    def at(self, times):
        centres, triads = self.place(self.coordinate(np.minimum(times, self.ends[-1])))
        return centres[:, None].astype(float), triads[:, None].astype(float)


class Mount:
    """One body that has one coordinate, called x in laws, its rate v.

    kind    "slide", "hinge" (without weight) or "pendulum"
    mass    kg or kg m^2: what x'' is multiplied by
    """

    def __init__(self, c, x, v, kinds=("slide", "slide", "hinge", "pendulum")):
        self.kind, self.x, self.v = c.choice(kinds), x, v
        m = c.log(0.2, 10)
        self.loads, self.gravity = [], (0, 0, 0)
        body, joint = {"name": "m", "mass": m}, {"name": "p", "between": ["world", "m"]}
        if self.kind == "slide":
            self.mass, self.axis = REAL(m), np.array([1.0, 0, 0]) if c.chance(0.6) else c.direction()
            self.start = np.zeros(3) if c.chance(0.6) else np.array([c.number(-1, 1) for _ in range(3)])
            body |= {"inertia": [c.number(0.01, 0.05) * m] * 3, "position": self.start,
                     "velocity": v * self.axis}
            joint |= {"type": "prismatic", "at": self.start, "axis": self.axis, "coordinate": x}
        else:
            i = c.number(0.05, 0.3) * m
            self.mass = REAL(i)
            body |= {"inertia": [0.9 * i, i, 0.8 * i], "angular_velocity": [0, v, 0],
                     "rotation_vector": [0, x, 0]}
            joint |= {"type": "revolute", "at": [0, 0, 0], "axis": [0, 1, 0], "coordinate": x}
            self.arm = 0.0
            if self.kind == "pendulum":
                self.arm = c.number(0.3, 1.5)
                self.mass = REAL(i) + REAL(m) * REAL(self.arm) ** 2
                self.gravity = (0, 0, -G)
                body |= {"position": [-self.arm * math.sin(x), 0, -self.arm * math.cos(x)],
                         "velocity": [-self.arm * math.cos(x) * v, 0, self.arm * math.sin(x) * v]}
        self.body, self.joint, self.m = body, joint, m

    def law(self, **more):
        law = laws.Law(self.mass, **more)
        if self.kind == "pendulum":
            law.add("-weight*sin(x)", weight=lambda t, x, v: REAL(self.m) * REAL(G) * REAL(self.arm))
        return law

    def by(self, number, digits=4):
        """A force of a mass of 1, for this mass."""
        return float(f"{number * float(self.mass):.{digits}g}")

    def actuator(self, text, law):
        """A formula of x, v, t: as a load and in the law."""
        what = "displacement" if self.kind == "slide" else "angle"
        used = {name: f"p.{what}{rate}" for name, rate in (("x", ""), ("v", "_rate"))
                if name in text.replace("exp", "").replace("max", "")}
        self.loads.append({"type": "actuator", "joint": "p", "expression": text} |
                          ({"inputs": used} if used else {}))
        law.add(text)

    def place(self, x):
        x = np.asarray(x, REAL)
        triads = np.broadcast_to(np.eye(3, dtype=REAL), (len(x), 3, 3))
        if self.kind == "slide":
            return self.start + (x - REAL(self.x))[:, None] * self.axis, triads
        sine, cosine, zero = np.sin(x), np.cos(x), 0 * x
        triads = np.stack([np.stack([cosine, zero, sine], -1), np.stack([zero, zero + 1, zero], -1),
                           np.stack([-sine, zero, cosine], -1)], -2)
        return np.stack([-self.arm * sine, zero, -self.arm * cosine], -1), triads

    def case(self, kind, number, law, end):
        text = scenario(kind, [self.body], [self.joint], self.loads, self.gravity)
        return Case(kind, number, text, law, self.x, self.v, end, self.place)


def scenario(kind, bodies, joints, loads, gravity=(0, 0, 0)):
    return paper.scenario(kind, bodies, joints, loads, {}, {}, gravity=gravity).split("[time]")[0]


def start(c, rest=0.3, x=(0.05, 0.5), v=(0.5, 3)):
    """Place and speed; some at rest."""
    return c.either() * c.number(*x), 0.0 if c.chance(rest) else c.either() * c.number(*v)


def drive(c, mount, share=0.5, force=(3, 20)):
    """A sine over time that is added to a law, or nothing."""
    return f" + {mount.by(c.number(*force))}*sin({c.number(2, 12)}*t)" if c.chance(share) else ""


def spring(c, mount, share=0.8, rate=(5, 60)):
    return f"-{mount.by(c.number(*rate))}*x" if c.chance(share) else "0*x"


def smooth_sign(c, of, s):
    """Of a quantity, within 1/s of zero."""
    kind = c.choice(["tanh"] * 6 + ["root", "arc"] + ["logistic"] * (s < 100))
    return {"tanh": f"tanh({s}*({of}))", "root": f"({of})/sqrt(({of})^2 + {1 / s:.3g}^2)",
            "arc": f"2/pi*atan2({s}*({of}), 1)", "logistic": f"(2/(1 + exp(-{2 * s}*({of}))) - 1)"}[kind]


# ---------------------------------------------------------------- kinds

def tanh_place(c, kind, number):
    x, v = start(c)
    s, mount = c.log(30, 5000), Mount(c, x, v)
    a = 0 if c.chance(0.6) else c.number(-0.1, 0.1)
    law = mount.law(sharp=[("x", a, 1 / s)])
    place = f"x - {a}" if a > 0 else f"x + {-a}" if a else "x"
    mount.actuator(f"{spring(c, mount)} - {mount.by(c.number(1, 10))}*{smooth_sign(c, place, s)}"
                   f"{drive(c, mount, 0.4)}", law)
    return mount.case(kind, number, law, c.number(0.5, 3))


def tanh_rate(c, kind, number):
    x, v = start(c)
    s, mount = c.log(30, 3000), Mount(c, x, v)
    belt = 0 if c.chance(0.8) else c.number(0.1, 1)
    law = mount.law(sharp=[("v", belt, 1 / s)])
    size = f"{mount.by(c.number(1, 8))}"
    if c.chance(0.15):   # more before it slides
        size = f"({size} + {mount.by(c.number(1, 4))}*exp(-(v/{c.number(0.05, 0.4)})^2))"
    rate = f"v - {belt}" if belt else "v"
    mount.actuator(f"{spring(c, mount, 0.9)} - {size}*{smooth_sign(c, rate, s)}{drive(c, mount, 0.7)}", law)
    return mount.case(kind, number, law, c.number(0.5, 3))


def rest_on_sharp(c, kind, number):
    s = c.log(30, 3000)
    if c.chance(0.6):   # friction
        mount = Mount(c, 0.0 if c.chance(0.5) else c.number(-0.5, 0.5), 0.0)
        law = mount.law(sharp=[("v", 0, 1 / s)])
        push = f"{mount.by(c.number(3, 15))}" + c.choice(["", f"*sin({c.number(2, 12)}*t)"])
        mount.actuator(f"{push} - {mount.by(c.number(1, 8))}*{smooth_sign(c, 'v', s)}", law)
    else:
        mount = Mount(c, 0.0 if c.chance(0.4) else float(f"{c.either() * c.uniform(0.2, 3) / s:.3g}"), 0.0)
        law = mount.law(sharp=[("x", 0, 1 / s)])
        mount.actuator(f"-{mount.by(c.number(1, 10))}*{smooth_sign(c, 'x', s)}{drive(c, mount, 1)}", law)
    return mount.case(kind, number, law, c.number(0.3, 2))


def drag(c, kind, number):
    x, v = start(c, 0.2)
    mount = Mount(c, x, v)
    law, load = mount.law(), {"type": "drag", "body": "m"}
    quadratic = c.log(0.1, 5) * float(mount.mass)
    linear = c.number(0.1, 2) * float(mount.mass) if c.chance(0.3) else 0.0
    arm, speed = 1.0, "v"
    if mount.kind == "slide" and c.chance(0.4):
        along = c.number(-2, 2)
        across = np.cross(mount.axis, c.direction())
        across *= (0 if c.chance(0.5) else c.log(1e-3, 1)) / np.linalg.norm(across)
        load["medium"] = along * mount.axis + across
        along, across = float(load["medium"] @ mount.axis), float(np.linalg.norm(across))
        speed = f"(v - {along!r})" if along > 0 else f"(v + {-along!r})"
    else:
        across = 0.0
        if mount.kind == "hinge":
            arm = c.number(0.2, 1)
            load["point"] = [0, 0, -arm]
        elif mount.kind == "pendulum":
            arm = mount.arm
    load |= {"quadratic": float(f"{quadratic / arm**3:.3g}")} | \
        ({"linear": float(f"{linear / arm**2:.3g}")} if linear else {})
    size = f"sqrt({speed}^2 + {across!r}^2)" if across else f"abs({speed})"
    if across:
        law = mount.law(sharp=[("v", along, across)])
    law.add(f"-{arm!r}^2*({load.get('linear', 0.0)!r} + {load['quadratic']!r}*{arm!r}*{size})*{speed}")
    mount.actuator(spring(c, mount, 1 if mount.kind == "hinge" else 0.85) + drive(c, mount, 0.3), law)
    mount.loads.append(load)
    return mount.case(kind, number, law, c.number(0.5, 3))


def rows(c, mount, low, high, least=4):
    """Elongations and forces of a table that pulls back, mostly."""
    n, high = c.randint(least, 9), max(high, low + 0.2)
    gaps = np.array([c.uniform(0.3, 2) for _ in range(n - 1)])
    places = low + (high - low) * np.concatenate([[0], np.cumsum(gaps) / gaps.sum()])
    rate, more = c.uniform(10, 60), c.uniform(0, 60)
    forces = [mount.by(rate * e + more * e**3 + c.uniform(-0.1, 0.1) * rate * (high - low), 3)
              for e in places]
    return [float(f"{e:.3g}") for e in places], forces


def table_spring(c, kind, number):
    """On the joint; the motion passes beyond the rows often."""
    x, v = start(c, 0.2, (0.02, 0.4), (0.5, 6))
    mount = Mount(c, x, v)
    law = mount.law()
    wide = c.number(0.2, 0.7)
    elongations, forces = rows(c, mount, -wide, wide * c.uniform(0.5, 1.2))
    rest = 0.0 if c.chance(0.7) else c.number(-0.1, 0.1)
    damping = mount.by(c.number(0.05, 1)) if c.chance(0.3) else 0.0
    way = "spline" if kind.startswith("spline") else "linear"
    mount.loads.append({"type": "spring", "joint": "p", "law": "table", "rest": rest, "damping": damping,
                        "table": {"elongations": elongations, "forces": forces, "interpolation": way}})
    law.add_table(laws.Table(elongations, forces, way == "spline"), lambda x: x - REAL(rest))
    law.add(f"-{damping!r}*v")
    if c.chance(0.25):
        mount.actuator("0*x" + drive(c, mount, 1), law)
    return mount.case(kind, number, law, c.number(0.5, 2.5))


def beside(c, mount, d):
    """A point of the world beside a slide, d off its line, abreast of x = b."""
    b = c.number(-0.1, 0.1)
    across = np.cross(mount.axis, c.direction())
    if d == 0:
        return b, mount.start + (b - mount.x) * mount.axis, REAL(0)
    point = mount.start + (b - mount.x) * mount.axis + d * across / np.linalg.norm(across)
    off = laws.real(point) - mount.start
    along = (off * mount.axis).sum()
    return along + REAL(mount.x), point, np.sqrt((off * off).sum() - along * along)


def table_between(c, kind, number):
    """Between a point of the world and a body that slides past it."""
    x, v = start(c, 0.2, (0.1, 0.6), (0.5, 5))
    mount = Mount(c, x, v, ["slide"])
    b, point, d = beside(c, mount, c.number(0.1, 0.6))
    law, free = mount.law(), c.number(0.05, 0.6)
    farthest = math.hypot(float(d), abs(x) + 0.3) - free
    elongations, forces = rows(c, mount, float(d) * c.uniform(0.9, 1.2) - free,
                               farthest * c.uniform(0.7, 1.1))
    way = "spline" if kind.startswith("spline") else "linear"
    mount.loads.append({"type": "spring", "between": ["world", "m"], "points": [point, [0, 0, 0]],
                        "law": "table", "free_length": free,
                        "table": {"elongations": elongations, "forces": forces, "interpolation": way}})

    def length(x):
        return np.sqrt((x - b) ** 2 + d * d)
    law.add_table(laws.Table(elongations, forces, way == "spline"), lambda x: length(x) - REAL(free),
                  lambda x: -(x - b) / length(x))
    mount.actuator(spring(c, mount, 1, (5, 30)) + drive(c, mount, 0.2), law)
    return mount.case(kind, number, law, c.number(0.5, 2.5))


def through_anchor(c, kind, number):
    """A spring with a free length whose end passes its other end, or close by."""
    mount = Mount(c, c.either() * c.number(0.3, 1), 0.0, ["slide"])
    close = 0.0 if c.chance(0.4) else c.log(1e-6, 1e-1)
    alone = close == 0 and c.chance(0.5)   # a point mass on a line
    if alone:
        mount.axis, mount.start = np.array([1.0, 0, 0]), np.array([mount.x, 0, 0])
    b, point, d = (0.0, np.zeros(3), REAL(0)) if alone else beside(c, mount, close)
    mount.v = -math.copysign(c.number(1, 5), mount.x)
    mount.body["velocity"] = mount.v * mount.axis
    law = mount.law(sharp=[("x", b, d)] if d else [])
    k, free = mount.by(c.number(3, 50)), c.number(0.1, 0.6)
    mount.loads.append({"type": "spring", "between": ["world", "m"], "points": [point, [0, 0, 0]],
                        "stiffness": k, "free_length": free})
    names = {"b": lambda t, x, v: REAL(b), "d": lambda t, x, v: d}
    law.add(f"-{k!r}*(1 - {free!r}/sqrt((x - b)^2 + d^2))*(x - b)" if d else
            f"-{k!r}*(abs(x - b) - {free!r})*((x - b)/abs(x - b))", **names)
    if alone:
        body = {"name": "m", "shape": {"point": True}, "mass": mount.m, "position": mount.start,
                "velocity": mount.v * mount.axis}
        text = scenario(kind, [body], [], mount.loads)
        return Case(kind, number, text, law, mount.x, mount.v, c.number(0.5, 3), mount.place)
    if c.chance(0.3):
        mount.actuator(spring(c, mount, 1, (5, 30)), law)
    return mount.case(kind, number, law, c.number(0.5, 3))


def wire(c, kind, number):
    """A bead on a bent wire: open, closed, or with weight along it."""
    closed = kind == "wire_closed" or kind == "wire_weight" and c.chance(0.3)
    n = c.randint(5, 8) if closed else c.randint(4, 8)
    if closed:
        angles = np.sort([(k + c.uniform(-0.25, 0.25)) * 2 * math.pi / n for k in range(n)])
        points = [[c.uniform(0.5, 0.9) * math.cos(a), c.uniform(0.5, 0.9) * math.sin(a), c.uniform(-0.2, 0.2)]
                  for a in angles]
    else:
        points, way = [np.zeros(3)], c.direction()
        for _ in range(n - 1):
            way = way + c.uniform(0, 0.8) * c.direction()
            way /= np.linalg.norm(way)
            points.append(points[-1] + c.uniform(0.2, 0.6) * way)
    points = [[float(f"{x:.3f}") for x in point] for point in points]
    law = laws.Wire(points, closed, (0, 0, -G) if kind == "wire_weight" else (0, 0, 0))
    first = len(law.knots) // 2 if c.chance(0.4) else None
    at = law.knots[first] if first is not None else REAL(c.uniform(0.02, 0.98)) * law.round
    borders = law.borders[0]
    speed = c.either() * c.number(0.5, 4)
    piece = int(np.searchsorted(borders, at + REAL(1e-12)))
    place, slope, _ = (part[0] for part in law.shape(laws.real([at]), piece))
    steep = np.sqrt((slope * slope).sum())
    end = float(f"{law.round / abs(speed) * c.uniform(0.3, 1.5 if closed else 0.9):.3g}")
    m = c.log(0.2, 10)
    body = {"name": "bead", "mass": m, "inertia": [c.number(0.01, 0.1) * m] * 3,
            "position": place.astype(float), "velocity": (speed * slope / steep).astype(float)}
    joint = {"name": "wire", "type": "slot", "between": ["world", "bead"],
             "curve": {"points": points} | ({"closed": True} if closed else {})}
    text = scenario(kind, [body], [joint], [], (0, 0, -G) if kind == "wire_weight" else (0, 0, 0))
    def where(x): return law.places(x), np.broadcast_to(np.eye(3), (len(x), 3, 3))
    case = Case(kind, number, text, law, at, REAL(speed) / steep, min(end, 3.0), where)
    if kind != "wire_weight":
        case.speed = speed
    return case


def jump(c, kind, number):
    x, v = start(c)
    mount, a = Mount(c, x, v), 0 if c.chance(0.5) else c.number(0.01, 0.2)
    law, place = mount.law(), f"x - {a}" if a else "x"
    mount.actuator(f"{spring(c, mount)} - {mount.by(c.number(1, 10))}*(({place})/abs({place}))"
                   f"{drive(c, mount, 0.3)}", law)
    return mount.case(kind, number, law, c.number(0.5, 2.5))


def stop(c, kind, number):
    x, v = start(c, 0.2, (0.02, 0.4), (1, 4))
    mount, a = Mount(c, x, v), c.number(0.05, 0.5)
    law, hard = mount.law(), mount.by(c.log(1e2, 1e6))
    text = f"{spring(c, mount, 0.9)} - {hard}*max(0, x - {a})"
    if c.chance(0.4):
        text += f" + {hard}*max(0, -x - {c.number(0.05, 0.5)})"
    mount.actuator(text + drive(c, mount, 0.4), law)
    return mount.case(kind, number, law, c.number(0.5, 2.5))


def grazed_stop(c, kind, number):
    """Let go at rest, the other end of the swing reaches into a stop by a given depth."""
    far = c.number(0.2, 0.6)
    side = c.either()
    mount = Mount(c, -side * far, 0.0)
    depth = c.log(1e-9, 1e-3)
    law, k = mount.law(), c.number(5, 60)
    back = f"-{mount.by(k)}*x" if mount.kind != "pendulum" else "0*x"
    a = far - depth
    mount.actuator(f"{back} - {mount.by(c.log(1e4, 1e6))}*" +
                   (f"max(0, x - {a!r})" if side > 0 else f"min(0, x + {a!r})"), law)
    return mount.case(kind, number, law, c.number(1.5, 5))


def v_abs_v(c, kind, number):
    x, v = start(c)
    mount = Mount(c, x, v)
    law = mount.law()
    mount.actuator(f"{spring(c, mount, 0.9)} - {mount.by(c.log(0.1, 5))}*v*abs(v){drive(c, mount, 0.5)}", law)
    return mount.case(kind, number, law, c.number(0.5, 3))


def pulse(c, of, centre, width, area):
    """A narrow term of a quantity, with about that area under it (a step: that height)."""
    shape = c.choice(["gauss", "gauss", "lorentz", "step", "bell"])
    q = f"(({of} - {centre})/{width})" if centre >= 0 else f"(({of} + {-centre})/{width})"
    height = float(f"{area / width / 1.8:.4g}")
    return {"gauss": f"{height}*exp(-{q}^2)", "lorentz": f"{height}/(1 + {q}^2)",
            "step": f"{float(f'{area:.4g}')}*tanh{q}", "bell": f"{height}*(1 - tanh{q}^2)"}[shape]


def time_pulse(c, kind, number):
    x, v = start(c, 0.5)
    mount, end = Mount(c, x, v), c.number(0.5, 5)
    times = [(float(f"{end * c.uniform(0.05, 0.95):.3g}"), float(f"{end * c.log(1e-3, 0.3):.3g}"))
             for _ in range(c.choice([1, 1, 2, 3, 4]))]
    law = mount.law(sharp=[("t", *of) for of in times])
    mount.actuator(" + ".join([spring(c, mount, 0.5)] + [
        pulse(c, "t", *of, mount.by(c.either() * c.number(0.3, 3))) for of in times]), law)
    return mount.case(kind, number, law, end)


def place_pulse(c, kind, number):
    """Wells and hills of energy on the way."""
    v = c.either() * c.number(1, 6)
    turns = c.chance(0.5)
    mount = Mount(c, 0.0, v, ["slide", "hinge"] if not turns else ["slide", "hinge", "pendulum"])
    k = c.number(5, 60) if turns and mount.kind != "pendulum" else 0
    end = c.number(0.5, 3)
    way = abs(v) / math.sqrt(k) if k else 0.5 if turns else abs(v) * end
    places = [(float(f"{math.copysign(way * c.uniform(0.05, 0.95), v):.3g}"),
               float(f"{way * c.log(1e-3, 0.1):.3g}"))
              for _ in range(c.choice([1, 1, 2, 3, 4]))]
    law = mount.law(sharp=[("x", *of) for of in places])
    mount.actuator(" + ".join([f"-{mount.by(k)}*x" if k else "0*x"] + [
        pulse(c, "x", *of, mount.by(c.either() * c.uniform(0.05, 0.5) * v * v / 2)) for of in places]), law)
    return mount.case(kind, number, law, end)


def rate_pulse(c, kind, number):
    """A force about one speed."""
    x, v = start(c)
    mount = Mount(c, x, v, ["slide", "hinge"])
    k = c.number(5, 60)
    fast = math.hypot(x * math.sqrt(k), v)
    speeds = [(float(f"{c.either() * fast * c.uniform(0, 0.9):.3g}"), float(f"{fast * c.log(2e-3, 0.1):.3g}"))
              for _ in range(c.choice([1, 1, 2]))]
    law = mount.law(sharp=[("v", *of) for of in speeds])
    mount.actuator(" + ".join([f"-{mount.by(k)}*x"] + [
        f"{mount.by(c.either() * c.number(1, 10))}*exp(-((v - {centre})/{width})^2)".replace("- -", "+ ")
        for centre, width in speeds]), law)
    return mount.case(kind, number, law, c.number(0.5, 3))


def bushing(c, kind, number):
    """Springs and dampers of a bushing along the coordinate that is free, and a sharp law."""
    x, v = start(c)
    mount = Mount(c, x, v, ["slide", "hinge"])
    if mount.kind == "slide":
        mount.axis = np.array([1.0, 0, 0])
        mount.body["velocity"], mount.joint["axis"] = v * mount.axis, mount.axis
    s = c.log(30, 1000)
    law = mount.law(sharp=[("v", 0, 1 / s)])
    k, damper, ahead = mount.by(c.log(10, 3000)), mount.by(c.number(0, 1)), mount.by(c.number(-2, 2))
    free = 0 if mount.kind == "slide" else 4

    def of(value, others): return [value if i == free else others for i in range(6)]
    mount.loads.append({"type": "bushing", "between": ["world", "m"],
                        "at": mount.start if free == 0 else [0, 0, 0],
                        "stiffness": of(k, 100.0), "damping": of(damper, 1.0), "preload": of(ahead, 0.0)})
    law.add(f"-{k!r}*(x - begin) - {damper!r}*v - {ahead!r}".replace("- -", "+ "),
            begin=lambda t, x, v: REAL(mount.x))
    mount.actuator(f"-{mount.by(c.number(1, 8))}*{smooth_sign(c, 'v', s)}{drive(c, mount, 0.7)}", law)
    return mount.case(kind, number, law, c.number(0.3, 2))


# How many of a thousand.
KINDS = {"tanh_place": (tanh_place, 90), "tanh_rate": (tanh_rate, 110), "rest_on_sharp": (rest_on_sharp, 60),
         "drag": (drag, 90), "spline_spring": (table_spring, 90), "spline_between": (table_between, 50),
         "line_spring": (table_spring, 30), "line_between": (table_between, 20), "wire_open": (wire, 50),
         "wire_closed": (wire, 25), "wire_weight": (wire, 35), "jump": (jump, 50), "stop": (stop, 50),
         "grazed_stop": (grazed_stop, 60), "v_abs_v": (v_abs_v, 30), "through_anchor": (through_anchor, 40),
         "time_pulse": (time_pulse, 30), "place_pulse": (place_pulse, 70), "rate_pulse": (rate_pulse, 10),
         "bushing": (bushing, 10)}


def case(seed, kind, number):
    return KINDS[kind][0](Choice(f"{seed} {kind} {number}"), kind, number)
