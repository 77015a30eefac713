# SPDX-License-Identifier: BSD-3-Clause
"""Skew directors (P4), and the stress that keeps bodies rigid, as a user meets them.

    LIVENS_PROGRAM=build/release/livens python3 skew_test.py [CLASS ...]

The classical rules are solved here once more in skew directors, with (P4), (P7) and (P21) to the letter and nothing of
livens: lists of numbers, derivatives by complex steps, Gauss' elimination.
"""
import json
import math
import unittest

from program_test import SCENARIO, SUSPECT, ProgramTest

GRAVITY = [0.0, 0.0, -9.81]
ROWS = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def add(*vectors):
    return [sum(parts) for parts in zip(*vectors)]


def times(c, v):
    return [c * x for x in v]


def multiply(A, B):
    return [[sum(a * b for a, b in zip(row, column)) for column in zip(*B)] for row in A]


def transpose(A):
    return [list(row) for row in zip(*A)]


def inverse(A):
    """Of 3 x 3, by rows."""
    a, b, c = A
    det = dot(a, cross(b, c))
    return transpose([times(1 / det, cross(b, c)), times(1 / det, cross(c, a)), times(1 / det, cross(a, b))])


def eliminate(A, b):
    """x of A x = b, by Gauss with pivots; A and b are lost."""
    n = len(b)
    for k in range(n):
        pivot = max(range(k, n), key=lambda i: abs(A[i][k]))
        A[k], A[pivot], b[k], b[pivot] = A[pivot], A[k], b[pivot], b[k]
        for i in range(k + 1, n):
            if (factor := A[i][k] / A[k][k]) != 0:
                A[i] = [x - factor * y for x, y in zip(A[i], A[k])]
                b[i] -= factor * b[k]
    for k in reversed(range(n)):
        b[k] = (b[k] - sum(A[k][j] * b[j] for j in range(k + 1, n))) / A[k][k]
    return b


# A box of 2 kg, and how it is described: along axes E that are perpendicular, or along D = E C.
E = transpose([[0.48, 0.6, 0.64], [0.8, 0, -0.6], [-0.36, 0.8, -0.48]])   # columns e1, e2, e3: one negative, turned below
if dot(transpose(E)[0], cross(*transpose(E)[1:])) < 0:
    E = transpose([transpose(E)[0], transpose(E)[1], times(-1, transpose(E)[2])])
H = math.radians(30)
# Directors d1, d2, d3 with 30 degrees between any two, as columns in the axes E: one along e1, one in the plane e1 e2.
C12, S12 = math.cos(H), math.sin(H)
C23 = (C12 - C12 * C12) / S12
C = transpose([[1, 0, 0], [C12, S12, 0], [C12, C23, math.sqrt(1 - C12**2 - C23**2)]])
MASS, CENTRE, INERTIA = 2.0, [0.3, 0.1, -0.2], [0.04, 0.09, 0.11]   # about the centre, principal in E
POINT = [-0.2, 0.05, 0.1]   # of the joint, along E
HELD = [0.4, -0.3, 0.2]   # where it is, world
RATES = [0.7, -1.1, 2.0]   # angular velocity, world
TORQUE = [0.5, 2.0, -1.0]
FORCE = [1.0, -2.0, 0.5]   # at the centre, along E


def moments():
    """M, S, E along the axes E."""
    half = sum(INERTIA) / 2
    return MASS, times(MASS, CENTRE), [
        [MASS * CENTRE[i] * CENTRE[j] + (half - INERTIA[i] if i == j else 0) for j in range(3)] for i in range(3)]


def along_skew(theta):
    return [dot(row, theta) for row in inverse(C)]


def skew_moments():
    M, S, Euler = moments()
    back = inverse(C)
    return M, along_skew(S), multiply(multiply(back, Euler), transpose(back))


def numbers(v):
    return "[" + ", ".join(numbers(x) if isinstance(x, list) else repr(float(x)) for x in v) + "]"


def scenario(skew, method, elements=40, end=0.4, more=""):
    """The box on a ball joint under its weight, a torque and a force that follows it."""
    M, S, Euler = skew_moments() if skew else moments()
    place = along_skew if skew else list
    directors = multiply(E, C) if skew else E
    arm = [dot(row, POINT) for row in E]
    position = add(HELD, times(-1, arm))
    return f"""format = 1
gravity = {numbers(GRAVITY)}

[[body]]
name = "box"
mass = {M!r}
first_moment = {numbers(S)}
second_moment = {numbers(Euler)}
directors = {numbers(transpose(directors))}
position = {numbers(position)}
velocity = {numbers(times(-1, cross(RATES, arm)))}
angular_velocity = {numbers(RATES)}

[[joint]]
name = "ball"
type = "spherical"
between = ["world", "box"]
points = [{numbers(HELD)}, {numbers(place(POINT))}]

[[load]]
type = "torque"
body = "box"
value = {numbers(TORQUE)}

[[load]]
type = "force"
body = "box"
point = {numbers(place(CENTRE))}
frame = "body"
table = {{ times = [0, 0.2, 0.4], values = [{numbers(place(FORCE))}, {numbers(place(times(0.5, FORCE)))}, {numbers(place(FORCE))}] }}
{more}
[time]
end = {end}
elements = {elements}

[method]
{method}
"""


class Rule:
    """The midpoint rule, or that of Euler, of the box on its ball joint, in any directors; without the second force."""

    def __init__(self, skew, middle):
        self.middle = middle
        M, S, Euler = skew_moments() if skew else moments()
        self.m = [[M, *S], *([S[i], *Euler[i]] for i in range(3))]
        D = transpose(multiply(E, C) if skew else E)
        self.G = [[dot(a, b) for b in D] for a in D]
        self.point = [1.0, *(along_skew(POINT) if skew else POINT)]
        arm = [dot(row, POINT) for row in E]
        self.X = [add(HELD, times(-1, arm)), *D]
        V = [times(-1, cross(RATES, arm)), *(cross(RATES, d) for d in D)]
        self.P = multiply(transpose(self.m), V)

    def force(self, X):
        """Weight and torque (P21), column by column."""
        D = X[1:]
        metric = inverse([[dot(a, b) for b in D] for a in D])
        contravariant = [add(*(times(metric[i][j], D[j]) for j in range(3))) for i in range(3)]
        F = [times(self.m[0][a], GRAVITY) for a in range(4)]
        return [F[0], *(add(F[i + 1], times(0.5, cross(TORQUE, contravariant[i]))) for i in range(3))]

    def residual(self, z, h):
        X1, multipliers = [z[3 * a:3 * a + 3] for a in range(4)], z[12:]
        change = [add(X1[a], times(-1, self.X[a])) for a in range(4)]
        P1 = multiply(self.m, times_all(1 / h, change))
        if self.middle:
            P1 = [add(times(2, P1[a]), times(-1, self.P[a])) for a in range(4)]
        at = [times(0.5, add(X1[a], self.X[a])) for a in range(4)] if self.middle else X1
        F = self.force(at)
        r = [add(P1[a], times(-1, self.P[a]), times(-h, F[a]), times(h * self.point[a], multipliers[6:]))
             for a in range(4)]
        for (i, j), value in zip(ROWS, multipliers):
            r[i + 1] = add(r[i + 1], times(0.5 * h * value, at[j + 1]))
            r[j + 1] = add(r[j + 1], times(0.5 * h * value, at[i + 1]))
        rows = [0.5 * (dot(X1[i + 1], X1[j + 1]) - self.G[i][j]) for i, j in ROWS]
        held = add(*(times(self.point[a], X1[a]) for a in range(4)), times(-1, HELD))
        self.next = X1, P1
        return [x for column in r for x in column] + rows + held

    def step(self, h):
        z = [x for column in self.X for x in column] + [0.0] * 9
        for _ in range(20):
            columns = []
            for k in range(21):
                moved = list(z)
                moved[k] += 1e-30j
                columns.append([x.imag / 1e-30 for x in self.residual(moved, h)])
            change = eliminate(transpose(columns), [-x for x in self.residual(z, h)])
            z = [x + d for x, d in zip(z, change)]
            if max(abs(x) for x in change[:12]) < 1e-14:
                break
        self.residual(z, h)
        self.X, self.P = self.next


def times_all(c, columns):
    return [times(c, v) for v in columns]


class Skew(ProgramTest):
    def end_state(self, text, t="0.4"):
        self.write("box.toml", text)
        (self.folder / "box.nc").unlink(missing_ok=True)
        done = self.run_program("solve", "box.toml", "-o", "box.nc", "-q")
        self.assertIn(done.returncode, (0, SUSPECT), done.err)   # as those of Euler are
        return json.loads(self.expect(0, "sample", "box.nc", "--body", "box", "--at", t, "--json").out)

    def test_the_classical_rules_in_skew_directors(self):
        for family, middle in (("midpoint", True), ("endpoint", False)):
            rule = Rule(True, middle)
            for _ in range(20):
                rule.step(0.01)
            text = scenario(True, f'family = "{family}"\nestimate = "none"', elements=20, end=0.2)
            text = text[:text.rindex("[[load]]")] + text[text.index("[time]"):]
            found = self.end_state(text, "0.2")
            for a, b in zip([found["position"], *found["directors_raw"]], rule.X):
                self.assertLess(max(abs(x - y) for x, y in zip(a, b)), 1e-12, family)
            D = found["directors_raw"]
            for i, j in ROWS:
                self.assertAlmostEqual(dot(D[i], D[j]), 1 if i == j else math.cos(H), delta=1e-14)

    def test_the_same_motion_as_in_perpendicular_directors(self):
        methods = ('degree = 3', 'degree = 5\nwindow = 7', 'family = "radau"', 'family = "midpoint"',
                   'family = "endpoint"', 'family = "mixed"\ndegree = 1', 'family = "mixed"\ndegree = 2\nwindow = 10',
                   'family = "mixed"\nbasis = "bspline"\nmomentum = "strong"')
        for method in methods:
            method += '\nestimate = "none"'   # of some it is large
            straight = self.end_state(scenario(False, method))
            skew = self.end_state(scenario(True, method))
            for key in ("position", "center_of_mass", "velocity", "angular_velocity", "linear_momentum",
                        "angular_momentum"):
                size = max(1, *(abs(x) for x in straight[key]))
                self.assertLess(max(abs(x - y) for x, y in zip(straight[key], skew[key])), 1e-12 * size, method + key)
            for key in ("directors", "directors_raw"):
                expected = transpose(multiply(transpose(straight[key]), C))
                for a, b in zip(expected, skew[key]):
                    self.assertLess(max(abs(x - y) for x, y in zip(a, b)), 1e-12, method + key)
            # Lambda = C^-1 Lambda' C^-T
            back = inverse(C)
            expected = multiply(multiply(back, straight["rigidity"]["right"]), transpose(back))
            for a, b in zip(expected, skew["rigidity"]["right"]):
                self.assertLess(max(abs(x - y) for x, y in zip(a, b)), 1e-9, method)   # accelerations
            components = add(*(times(w, d) for w, d in zip(skew["angular_velocity_body"], skew["directors"])))
            self.assertLess(max(abs(x - y) for x, y in zip(components, skew["angular_velocity"])), 1e-12)

    def test_joints_and_loads_on_skew_bodies(self):
        """Axes, frames, springs, drag and sensors: all that is said in coordinates of the body."""
        for kind in ("revolute", "slot", "bushing"):
            states = []
            for skew in (False, True):
                place = along_skew if skew else list
                axis = [0.6, 0, 0.8]
                world_axis = [dot(row, axis) for row in E]
                text = scenario(skew, "degree = 4", elements=60)
                arm = cross(times(3, world_axis), times(-1, [dot(row, POINT) for row in E]))
                if kind == "revolute":
                    text = text.replace('type = "spherical"', 'type = "revolute"').replace(
                        "points = [" + numbers(HELD), f"axes = [{numbers(world_axis)}, {numbers(place(axis))}]\n"
                        + "points = [" + numbers(HELD), 1)
                    text = text.replace(f"angular_velocity = {numbers(RATES)}",
                                        f"angular_velocity = {numbers(times(3, world_axis))}")
                    lines = [f"velocity = {numbers(arm)}" if line.startswith("velocity") else line
                             for line in text.split("\n")]
                    text = "\n".join(lines)
                elif kind == "slot":
                    start, end = text.index("[[joint]]"), text.index("[[load]]")
                    text = text[:start] + f"""[[body]]
name = "bead"
shape = {{ point = true }}
mass = 0.3
position = {numbers(add(HELD, times(0.1, world_axis)))}
velocity = {numbers(times(0.1, cross(RATES, world_axis)))}

[[joint]]
name = "wire"
type = "slot"
between = ["box", "bead"]
curve = {{ points = [{numbers(place(add(POINT, times(-9, axis))))}, {numbers(place(add(POINT, times(9, axis))))}] }}

""" + text[start:end] + text[end:]
                else:
                    text = text.replace("[time]", f"""[[load]]
type = "spring"
between = ["world", "box"]
points = [[0, 1, 0], {numbers(place([0.2, 0.3, 0.1]))}]
stiffness = 90
free_length = 0.3

[[load]]
type = "drag"
body = "box"
point = {numbers(place(CENTRE))}
linear = 0.3

[[sensor]]
name = "tip"
type = "point"
body = "box"
point = {numbers(place([0.2, 0.3, 0.1]))}

[[load]]
type = "force"
body = "box"
point = {numbers(place([0.2, 0.3, 0.1]))}
frame = "body"
inputs = {{ x = "tip.x" }}
expression = [{', '.join(f'"{float(v)!r} * x"' for v in place([1, 2, 3]))}]

[time]""")
                states.append(self.end_state(text))
            for key in ("position", "velocity", "angular_velocity"):
                difference = max(abs(x - y) for x, y in zip(states[0][key], states[1][key]))
                self.assertLess(difference, 1e-11 if kind == "slot" else 1e-12, kind + key)
        self.assertGreater(abs(states[0]["position"][0] - HELD[0]), 0)

    def test_places_of_the_body_and_of_the_world(self):
        """What is said in coordinates of the body is, and what is the world's stays where it is."""
        there, tip = [0.2, 0.3, 0.1], [0.4, -0.1, 0.3]
        world = numbers([1.5, -0.4, 0.7])
        sensor = '[[sensor]]\nname = "tip"\ntype = "{}"\n'

        def words(place):
            at = numbers(place(there))
            pair = f"points = [{world}, {at}]"
            formula = ", ".join(f'"{float(v)!r} * x"' for v in place([1, 2, 3]))
            turning = f'frame = "body"\ninputs = {{ x = "tip.x" }}\nexpression = [{formula}]\n'
            point = sensor.format("point") + f'body = "box"\npoint = {at}\n'
            pull = f'[[load]]\ntype = "attraction"\nbody = "box"\npoint = {world}\nmu = 3\n'
            frames = f"frames = [{{ point = {world} }}, {{ point = {at} }}]"
            axes = f"axes = [{world}, {numbers(place(tip))}]"
            return {
                "attraction": pull, "attraction with gradient": pull + "gradient = true\n",
                "drag": f'[[load]]\ntype = "drag"\nbody = "box"\npoint = {at}\nquadratic = 2\nmedium = {world}\n',
                "torque": point + '[[load]]\ntype = "torque"\nbody = "box"\n' + turning,
                "body force": point + '[[load]]\ntype = "body_force"\nbody = "box"\n' + turning,
                "spring": f'[[load]]\ntype = "spring"\nbetween = ["world", "box"]\n{pair}\nstiffness = 70\nfree_length = 0.4\n',
                "relative sensor": sensor.format("relative") + f'between = ["world", "box"]\n{pair}\n'
                                   + '[[load]]\ntype = "torque"\nbody = "box"\n' + turning,
                "bushing": f'[[load]]\ntype = "bushing"\nbetween = ["world", "box"]\n{frames}\n'
                           "stiffness = [9, 8, 7, 0, 0, 0]\n",
                "rod": f'[[joint]]\nname = "rod"\ntype = "rod"\nbetween = ["world", "box"]\n{pair}\n',
                "plane": '[[joint]]\nname = "plane"\ntype = "point_in_plane"\nbetween = ["box", "world"]\n'
                         f"points = [{at}, {world}]\naxis = {numbers(place(self.across()))}\n",
                "axes": f'[[joint]]\nname = "axes"\ntype = "constant_angle"\nbetween = ["world", "box"]\n{axes}\n',
                "distance": f'[[drive]]\ntype = "distance"\nbetween = ["world", "box"]\n{pair}\nrate = 0.1\n'}

        for word in words(list):
            states = [self.end_state(scenario(skew, "degree = 4", elements=60,
                                              more=words(along_skew if skew else list)[word]
                                              + '[start]\ninitial = "project"\n')) for skew in (False, True)]
            for key in ("position", "velocity", "angular_velocity"):
                size = max(1, *(abs(x) for x in states[0][key]))
                difference = max(abs(x - y) for x, y in zip(states[0][key], states[1][key]))
                self.assertLess(difference, 1e-11 * size, word + ": " + key)
            self.assertNotAlmostEqual(states[0]["angular_velocity"][0], self.alone()["angular_velocity"][0], 4, word)

    @staticmethod
    def across():
        """A normal, along E, of a plane through the point of the box that passes through the world's."""
        at = add(add(HELD, times(-1, [dot(row, POINT) for row in E])), [dot(row, [0.2, 0.3, 0.1]) for row in E])
        away = [dot(column, add([1.5, -0.4, 0.7], times(-1, at))) for column in transpose(E)]
        return cross(away, [0.3, 0.5, -0.2])

    def alone(self):
        return self.end_state(scenario(False, "degree = 4", elements=60))

    def test_rates_in_any_words(self):
        text = scenario(True, "degree = 4")
        expected = self.end_state(text)
        spin = "angular_velocity = " + numbers(RATES)
        D = transpose(multiply(E, C))
        for words in ("director_rates = " + numbers([cross(RATES, d) for d in D]),
                      "angular_velocity_body = " + numbers([dot(row, RATES) for row in inverse(transpose(D))])):
            found = self.end_state(text.replace(spin, words))
            for key in ("position", "velocity", "angular_velocity"):
                self.assertLess(max(abs(x - y) for x, y in zip(expected[key], found[key])), 1e-12, words)

    def test_conditions_at_the_end(self):
        """Where the motion went is where it came from; a triad of another shape is refused."""
        there = self.end_state(scenario(True, "degree = 5"))
        given = f"""[body.end]
directors = {numbers(there["directors"])}
position = {numbers(there["position"])}
velocity = {numbers(there["velocity"])}
angular_velocity = {numbers(there["angular_velocity"])}
"""
        text = scenario(True, "degree = 5").replace("[[joint]]", given + "\n[[joint]]", 1)
        text += '\n[start]\ngiven = "nothing"\n\n[end]\ngiven = "state"\n'
        start = self.end_state(text, "0")
        D = transpose(multiply(E, C))
        for a, b in zip(start["directors"], D):
            self.assertLess(max(abs(x - y) for x, y in zip(a, b)), 1e-10)
        turned = text.replace("directors = " + numbers(there["directors"]),
                              "quaternion = " + numbers(there["quaternion"]))
        again = self.end_state(turned, "0")
        self.assertLess(max(abs(x - y) for x, y in zip(again["position"], start["position"])), 1e-11)
        self.write("other.toml", text.replace("directors = " + numbers(there["directors"]),
                                              "directors = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]"))
        self.assertIn("directors-metric", self.expect(SCENARIO, "check", "other.toml").err)

    def test_what_keeps_a_rod_together(self):
        """E11 w^2 along a rod that spins, and its mean stress; with a force at its end half of that more."""
        rod = """format = 1
[[body]]
name = "box"
shape = { box = [2, 0.1, 0.1] }
mass = 3
angular_velocity = [0, 0, 5]

[time]
end = 1
elements = 10
output = 4
"""
        E11, E22 = 3 * 4 / 12, 3 * 0.01 / 12
        for method in ("\n[method]\ndegree = 8\n", '\n[method]\nfamily = "midpoint"\n', '\n[method]\nfamily = "mixed"\n'):
            text = rod.replace("elements = 10", "elements = 400") if "family" in method else rod
            found = self.end_state(text + method, "0.53")
            expected = [[E11 * 25, 0, 0], [0, E22 * 25, 0], [0, 0, 0]]
            for a, b in zip(found["rigidity"]["right"], expected):
                self.assertLess(max(abs(x - y) for x, y in zip(a, b)), 2e-3 if "family" in method else 1e-9, method)
            stress = found["mean_stress"][0][0]
            self.assertAlmostEqual(stress, found["rigidity"]["right"][0][0] / 0.02, delta=1e-9)
        pulled = rod + """
[[load]]
type = "force"
body = "box"
point = [1, 0, 0]
value = [7, 0, 0]
frame = "body"
"""
        # Half the force is what the rod's own inertia takes from it: mean of 7 (1 + x) / 2.
        found = self.end_state(pulled.replace("angular_velocity = [0, 0, 5]", ""), "1")
        self.assertAlmostEqual(found["rigidity"]["left"][0][0], 7, delta=1e-11)
        self.assertIs(found["rigidity"]["unique"], True)

    def test_what_a_hanging_bar_bears(self):
        """Half its weight on average, and twice that where it stands on its foot: less."""
        bar = """format = 1
gravity = [0, 0, -10]
[[body]]
name = "box"
shape = { box = [0.1, 0.1, 2] }
mass = 3
position = [0, 0, POSITION]

[[joint]]
name = "hook"
type = "weld"
between = ["world", "box"]
at = [0, 0, 0]

[time]
end = 1
elements = 3
"""
        for position, expected in ((-1, 30), (1, -30)):   # int of N dx = +- 30 N / 2 * 2 m
            found = self.end_state(bar.replace("POSITION", str(position)), "1")
            self.assertAlmostEqual(found["rigidity"]["right"][2][2], expected, delta=1e-10)

    def test_files_hold_it(self):
        try:
            from netCDF4 import Dataset   # pylint: disable=import-outside-toplevel
        except ImportError:
            self.skipTest("needs netCDF4")
        self.end_state(scenario(True, "degree = 4"))
        with Dataset(self.folder / "box.nc") as file:
            file.set_auto_mask(False)
            rows = file["rigidity_stress"][:]
            self.assertEqual(rows.shape[1:], (1, 6))
            sample = json.loads(self.expect(0, "sample", "box.nc", "--body", "box", "--at", "0.4", "--json").out)
            right = sample["rigidity"]["right"]
            for k, (i, j) in enumerate(ROWS):
                self.assertAlmostEqual(rows[-1, 0, k], right[i][j], delta=1e-12 * abs(right[0][0]))
            self.assertTrue(math.isnan(file["body_volume"][0]))

    def test_what_is_refused(self):
        good = scenario(True, "")
        D = numbers(transpose(multiply(E, C)))
        for directors, code in (([[1, 0, 0], [0, 1, 0], [1, 1, 0]], "directors-dependent"),
                                ([[0, 1, 0], [1, 0.5, 0], [0, 0, 1]], "directors-left-handed"),
                                ([[0, 0, 0], [0, 1, 0], [0, 0, 1]], "directors-dependent")):
            self.write("bad.toml", good.replace(D, numbers(directors)))
            self.assertIn(code, self.expect(SCENARIO, "check", "bad.toml").err)
        rounded = scenario(False, "").replace(numbers(transpose(E)),
                                              numbers([[x + 1e-6 * k for k, x in enumerate(v)] for v in transpose(E)]))
        self.write("rounded.toml", rounded.replace('type = "spherical"', 'type = "point_in_plane"\naxis = [0, 0, 1]'))
        self.assertIn("directors-nearly-orthonormal", self.run_program("check", "rounded.toml").err)


if __name__ == "__main__":
    unittest.main()
