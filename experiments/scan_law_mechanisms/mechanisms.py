# SPDX-License-Identifier: BSD-3-Clause
"""Random mechanisms of 1 to 4 bodies with laws that are sharp, bend or jump.

A case hangs on the seed and its number alone. Forces are made for the inertia of a coordinate at the start.
"""
import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "scan_laws"))
import kinds  # noqa: E402
import paper  # noqa: E402
import trees  # noqa: E402

JOINTS = [kind for kind, n in (("revolute", 10), ("prismatic", 4), ("cylindrical", 3), ("universal", 2),
                               ("spherical", 2), ("rod", 1)) for _ in range(n)]
LAWS = ["tanh_place", "tanh_rate", "tanh_rate", "spline", "spline", "lines", "jump", "stop", "v_abs_v",
        "time_pulse", "place_pulse"]
KEPT = paper.ROOT / "build" / "truth"


class Case:
    def __init__(self, kind, laws, number, text, sharp, end):
        self.kind, self.laws, self.number = kind, laws, number
        self.text, self.sharp, self.end = text, sharp, end

    def truth(self):
        motion = trees.of(self.text, self.end, self.sharp, KEPT)
        self.error = motion.error
        return motion


class Builder:
    """Bodies and joints first; then what each coordinate weighs, laws, and velocities."""

    def __init__(self, c):
        self.c, self.bodies, self.joints, self.loads, self.sharp = c, [], [], [], []
        self.gravity = [0, 0, -kinds.G] if c.chance(0.6) else [0, 0, 0]
        for k in range(c.choice([1, 1, 2, 2, 3, 4])):
            self.add(k)
        self.tree = trees.Tree(self.text())
        self.weights = 1 / np.diag(np.linalg.inv(trees.State(
            self.tree, np.zeros(1), np.zeros((1, self.tree.n)), np.zeros((1, self.tree.n)), full=True).M[0]))

    def text(self):
        return kinds.scenario("mechanism", self.bodies, self.joints, self.loads, self.gravity)

    def digits(self, vector):
        return [float(f"{x:.3f}") for x in vector]

    def add(self, k):
        c = self.c
        above = self.bodies[-1 if c.chance(0.75) else c.randrange(k)] if k else None
        before = np.array(above["position"]) if k else np.zeros(3)
        kind = c.choice(JOINTS)
        if kind == "rod" and above and above.get("shape"):
            kind = "revolute"
        place = self.digits(before + c.uniform(0.3, 0.8) * c.direction())
        m = c.log(0.3, 5)
        body = {"name": f"b{k}", "mass": m, "position": place}
        joint = {"name": f"j{k}", "type": kind, "between": [above["name"] if k else "world", body["name"]]}
        if kind == "rod":
            body["shape"] = {"point": True}
        else:
            a, b, d = (c.uniform(0.05, 0.3) for _ in range(3))   # half edges of a box
            body["inertia"] = [float(f"{m * (p * p + q * q) / 3:.4g}") for p, q in ((b, d), (a, d), (a, b))]
            if c.chance(0.4):
                body["rotation_vector"] = self.digits(c.uniform(0.1, 2) * c.direction())
            if c.chance(0.3):
                body["center_of_mass"] = self.digits(0.05 * c.direction())
            joint["at"] = self.digits(before + c.uniform(0.2, 0.8) * (np.array(place) - before) +
                                      0.1 * c.direction())
        if kind in ("revolute", "prismatic", "cylindrical"):
            joint["axis"] = c.choice([[1, 0, 0], [0, 1, 0], [0, 0, 1], self.digits(c.direction())])
        elif kind == "universal":
            axis = self.digits(c.direction())
            other = np.cross(axis, c.direction())
            joint["axes"] = [axis, list(other / np.linalg.norm(other))]
        if above and above.get("shape") and kind != "rod":   # nothing turns with a point
            joint["between"][0] = "world"
        self.bodies.append(body)
        self.joints.append(joint)

    # laws: each adds loads and says what it is

    def by(self, what, number):
        weight = self.weights[self.tree.coordinates[what][0]]
        return float(f"{number * weight:.4g}")

    def on(self, what, text):
        """An actuator by a formula of x and v, its own coordinate and its rate."""
        joint, _, coordinate = what.partition(".")
        used = {name: f"{what}{rate}" for name, rate in (("x", ""), ("v", "_rate"))
                if name in text.replace("exp", "").replace("max", "")}
        self.loads.append({"type": "actuator", "joint": joint, "coordinate": coordinate, "expression": text} |
                          ({"inputs": used} if used else {}))

    def spring(self, what, **more):
        joint, _, coordinate = what.partition(".")
        self.loads.append({"type": "spring", "joint": joint, "coordinate": coordinate} | more)

    def law(self, what):
        """A law of one coordinate; its kind."""
        c = self.c
        kind = c.choice(LAWS)
        def by(*bounds): return self.by(what, c.number(*bounds))
        if kind == "tanh_place":
            s, a = c.log(30, 3000), 0.0 if c.chance(0.5) else c.number(0.01, 0.2)
            self.on(what, f"-{by(1, 10)}*{kinds.smooth_sign(c, f'x - {a}', s)}")
            self.sharp.append((what, a, 1 / s))
        elif kind == "tanh_rate":
            s = c.log(30, 2000)
            self.on(what, f"-{by(0.5, 6)}*{kinds.smooth_sign(c, 'v', s)}")
            self.sharp.append((f"{what}_rate", 0, 1 / s))
        elif kind in ("spline", "lines"):
            wide = c.number(0.2, 0.7)
            class Weighed:
                by = staticmethod(lambda number, digits: self.by(what, number))
            elongations, forces = kinds.rows(c, Weighed, -wide, wide * c.uniform(0.5, 1.2))
            way = "spline" if kind == "spline" else "linear"
            self.spring(what, law="table",
                        table={"elongations": elongations, "forces": forces, "interpolation": way})
        elif kind == "jump":
            a = c.number(0.001, 0.1)
            self.on(what, f"-{by(1, 8)}*((x - {a})/abs(x - {a}))")
        elif kind == "stop":
            self.on(what, f"-{self.by(what, c.log(1e2, 1e5))}*max(0, x - {c.number(0.02, 0.5)})")
        elif kind == "v_abs_v":
            self.on(what, f"-{by(0.2, 4)}*v*abs(v)")
        elif kind == "time_pulse":
            centre, width = (float(f"{self.end * share:.3g}")
                             for share in (c.uniform(0.05, 0.9), c.log(1e-3, 0.2)))
            self.on(what, kinds.pulse(c, "t", centre, width, self.by(what, c.either() * c.number(0.3, 2))))
            self.sharp.append(("t", centre, width))
        else:
            centre, width = c.either() * c.number(0.01, 0.4), c.log(5e-4, 0.05)
            self.on(what, kinds.pulse(c, "x", centre, width, self.by(what, c.either() * c.number(0.1, 1.5))))
            self.sharp.append((what, centre, width))
        return kind

    def between(self):
        """A spring between points, by a spline or linear."""
        c, k = self.c, self.c.randrange(len(self.bodies))
        body = self.bodies[k]
        other = "world" if k == 0 or c.chance(0.7) else f"b{c.randrange(k)}"
        tied = [k] if other == "world" else [int(other[1:]), k]
        points = [self.digits(c.uniform(0.02, 0.15) * c.direction())
                  if "inertia" in self.bodies[i] else [0, 0, 0] for i in tied]
        if other == "world":
            points.insert(0, self.digits(np.array(body["position"]) + c.uniform(0.3, 0.8) * c.direction()))
        ends = self.tree.two_points({"between": [other, body["name"]], "points": points})
        length = float(np.linalg.norm(ends[0][1] - ends[1][1])) if other == "world" else \
            float(np.linalg.norm(np.array(body["position"]) - self.bodies[int(other[1:])]["position"]))
        rate = float(f"{body['mass'] * c.uniform(5, 60):.3g}")
        free = float(f"{length * c.uniform(0.5, 1.1):.3g}")
        spring = {"type": "spring", "between": [other, body["name"]], "points": points, "free_length": free}
        if self.tree.coordinates and c.chance(0.3):
            damping = float(f"{rate * c.uniform(0, 0.05):.3g}")
            self.loads.append(spring | {"stiffness": rate, "damping": damping})
            return "linear_spring"
        class Weighed:
            by = staticmethod(lambda number, digits: float(f"{number * body['mass']:.{digits}g}"))
        elongations, forces = kinds.rows(c, Weighed, -0.5 * length, c.uniform(0.2, 0.6) * length)
        way = "spline" if c.chance(0.7) else "linear"
        self.loads.append(spring | {"law": "table", "table": {"elongations": elongations, "forces": forces,
                                                              "interpolation": way}})
        return "spline_between" if way == "spline" else "lines_between"

    def drag(self):
        c, k = self.c, self.c.randrange(len(self.bodies))
        body = self.bodies[k]
        quadratic = float(f"{body['mass'] * c.log(0.1, 3):.3g}")
        load = {"type": "drag", "body": body["name"], "quadratic": quadratic}
        if "inertia" in body and c.chance(0.5):
            load["point"] = self.digits(c.uniform(0.05, 0.3) * c.direction())
        if c.chance(0.3):
            load["linear"] = float(f"{body['mass'] * c.uniform(0.05, 1):.3g}")
        if c.chance(0.25):
            load["medium"] = self.digits(c.uniform(0.2, 2) * c.direction())
        self.loads.append(load)
        return "drag"

    def bushing(self, joint):
        """About a joint whose axis is one of the world's."""
        c, turns = self.c, joint["type"] == "revolute"
        what = f"{joint['name']}.{'angle' if turns else 'displacement'}"
        free = joint["axis"].index(1) + 3 * turns
        def of(value, others): return [value if i == free else others for i in range(6)]
        self.loads.append({"type": "bushing", "between": joint["between"], "at": joint["at"],
                           "stiffness": of(self.by(what, c.log(5, 500)), 50.0),
                           "damping": of(self.by(what, c.number(0, 1)), 0.5)})

    def fill(self):
        """Loads; the kind of the case is that of its first law."""
        c = self.c
        coordinates = list(self.tree.coordinates)
        c.shuffle(coordinates)
        found = [self.drag()] if not coordinates or c.chance(0.3) else []
        found = [self.between()] + found if not coordinates or c.chance(0.3) else found
        for what in coordinates:
            if c.chance(0.75) or not found:
                found.append(self.law(what))
            if "displacement" in what or c.chance(0.3):
                self.spring(what, stiffness=self.by(what, c.number(5, 40)),
                            damping=self.by(what, c.number(0, 0.5)))
            if c.chance(0.25):
                self.on(what, f"{self.by(what, c.number(2, 10))}*sin({c.number(2, 12)}*t)")
        for joint in self.joints:
            along = sorted(joint.get("axis", ())) == [0, 0, 1]
            if joint["type"] in ("revolute", "prismatic") and along and c.chance(0.08):
                self.bushing(joint)
        return found

    def move(self):
        """Velocities that fit the joints."""
        c = self.c
        if c.chance(0.2):
            return   # from rest
        rates = [c.number(-4, 4) if kind == "R" else c.number(-1.5, 1.5) for kind in self.tree.kinds]
        for body, (velocity, spin) in zip(self.bodies, self.tree.moving(rates)):
            body["velocity"] = velocity
            if "inertia" in body:
                body["angular_velocity"] = spin


def case(seed, number):
    c = kinds.Choice(f"{seed} mechanism {number}")
    end = c.log(0.3, 5)
    builder = Builder(c)
    builder.end = end
    found = builder.fill()
    builder.move()
    count = len(builder.bodies)
    kind = f"{count} {'body' if count == 1 else 'bodies'}"
    return Case(kind, sorted({*found}), number, builder.text(), builder.sharp, end)
