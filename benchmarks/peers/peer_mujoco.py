# SPDX-License-Identifier: BSD-3-Clause
"""MuJoCo. Settings: "INTEGRATOR:STEPS" with RK4, Euler, implicit or implicitfast. Loops close by its `connect`, gears by
its `joint`, which are soft and set as stiff as is stable (a time constant of two steps): not quite the rigid problem.
Springs between points are tendons; a road that is led is a slide of 1e12 kg on a spring, which swings as it is told.
Bodies without mass are more joints of the body that hangs on them."""
import mujoco
import numpy as np

from serve import GROUND, inside, of_kind, serve, tree

HEAVY = 1e12   # kg


def words(v):
    return " ".join(repr(float(c)) for c in v)


def quaternion(R):
    q = np.empty(4)
    mujoco.mju_mat2Quat(q, R.flatten())
    return q


def joint(b):
    if b.kind == "ball":
        return '<joint type="ball"/>'
    k = b.load.stiffness
    spring = f' stiffness="{k!r}" springref="{b.load.push / k!r}"' if k else ""
    return f'<joint name="j{b.joint}" type="{b.kind}" axis="{words(b.axis)}" damping="{b.load.damping!r}"{spring}/>'


class Bodies:
    """The tree as text, with the sites of springs and compared points."""

    def __init__(self, m, branches):
        self.branches = branches
        self.sites = {}   # body -> text
        for k, (body, at) in enumerate(m.points):
            self.add_site(body, f"p{k}", at)
        for k, spring in enumerate(of_kind(m, "spring")):
            for body, name, at in ((spring[0], f"a{k}", spring[2:5]), (spring[1], f"b{k}", spring[5:8])):
                self.add_site("road" if spring[11] and body == GROUND else int(body), name, at)

    def add_site(self, body, name, at):
        at = (0, 0, 0) if body == "road" else at
        self.sites[body] = self.sites.get(body, "") + f'<site name="{name}" pos="{words(at)}"/>'

    def text(self, i):
        first, joints = self.branches[i], joint(self.branches[i])
        while not self.branches[i].body.mass:
            i, = (k for k, other in enumerate(self.branches) if other.parent == i)
            if self.branches[i].place.any():
                raise ValueError("it has no bodies without mass")
            joints += joint(self.branches[i])
        b = self.branches[i].body
        inertia = words(np.maximum(b.inertia, 1e-12))   # zero is refused
        inner = "".join(self.text(k) for k, other in enumerate(self.branches) if other.parent == i)
        return (f'<body name="b{i}" pos="{words(first.place)}" quat="{words(quaternion(first.R))}">{joints}'
                f'<inertial mass="{b.mass!r}" pos="{words(b.center)}" diaginertia="{inertia}"/>'
                f'{self.sites.get(i, "")}{inner}</body>')


def roads(m, bodies):
    """Their bodies, and their velocities at the start."""
    led = [spring for spring in of_kind(m, "spring") if spring[11]]
    text = "".join(f'<body pos="{words(s[2:5])}" gravcomp="1"><joint type="slide" axis="0 0 1" '
                   f'stiffness="{HEAVY * s[12] ** 2!r}"/><inertial mass="{HEAVY!r}" pos="0 0 0" diaginertia="1 1 1"/>'
                   f'{bodies.sites["road"]}</body>' for s in led)
    return text, [s[11] * s[12] for s in led]


def model_of(m, integrator, step):
    branches, rest = tree(m)
    if any(b.parent is None for b in branches):
        raise ValueError("it has no rods between free bodies" if m.joints and m.joints[0][0] == "rod" else "it has no bushings")
    bodies = Bodies(m, branches)
    road, road_rates = roads(m, bodies)
    stiff = f'solref="{2 * step!r} 1" solimp="0.9999 0.9999 0.001"'
    closed = "".join(
        f'<connect body1="b{first}" body2="b{second}" anchor="{words(inside(m, first, at[:3]))}" {stiff}/>'
        for _, first, second, at in rest)
    closed += "".join(f'<joint joint1="j{int(second)}" joint2="j{int(first)}" polycoef="0 {ratio!r} 0 0 0" {stiff}/>'
                      for first, second, ratio in of_kind(m, "gear"))
    tendons = "".join(f'<spatial stiffness="{s[8]!r}" damping="{s[9]!r}" springlength="{s[10]!r}"><site site="a{k}"/>'
                      f'<site site="b{k}"/></spatial>' for k, s in enumerate(of_kind(m, "spring")))
    roots = "".join(bodies.text(i) for i, b in enumerate(branches) if b.parent == GROUND)
    tolerance = 'tolerance="1e-19"' if road else ""   # of inertias' mean, which a road makes large
    text = (f'<mujoco><compiler angle="radian" boundmass="0" boundinertia="0"/><option gravity="{words(m.gravity)}" {tolerance} '
            f'timestep="{step!r}" integrator="{integrator}"><flag contact="disable"/></option>'
            f'<worldbody>{bodies.sites.get(GROUND, "")}{roots}{road}</worldbody><equality>{closed}</equality>'
            f"<tendon>{tendons}</tendon></mujoco>")
    rates = [w for b in in_order(branches) for w in rates_of(b)]
    return mujoco.MjModel.from_xml_string(text), rates + road_rates


def rates_of(b):
    return b.rate if b.kind == "ball" else [b.rate @ b.axis if b.kind == "hinge" else 0]


def in_order(branches, parent=GROUND):
    """Depth first, as MuJoCo numbers its bodies."""
    for i, b in enumerate(branches):
        if b.parent == parent:
            yield b
            yield from in_order(branches, i)


def prepare(m, setting):
    steps = int(setting[1])
    model, rates = model_of(m, setting[0], m.end / steps)
    data = mujoco.MjData(model)
    data.qvel[:] = rates

    def points():
        mujoco.mj_forward(model, data)
        return [data.site(f"p{k}").xpos for k in range(len(m.points))]

    def solve():
        mujoco.mj_step(model, data, steps)
        return points
    return solve


if __name__ == "__main__":
    serve(prepare)
