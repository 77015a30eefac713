# SPDX-License-Identifier: BSD-3-Clause
"""MuJoCo. Settings: "INTEGRATOR:STEPS" with RK4, Euler, implicit or implicitfast. Loops close by its `connect`, which
is soft and set as stiff as is stable (a time constant of two steps): not quite the rigid problem."""
import mujoco
import numpy as np

from serve import inside, serve, tree


def words(v):
    return " ".join(repr(float(c)) for c in v)


def quaternion(R):
    q = np.empty(4)
    mujoco.mju_mat2Quat(q, R.flatten())
    return q


def model_of(m, integrator, step):
    branches, rest = tree(m)
    if any(b.parent is None for b in branches):
        raise ValueError("it has no rods between free bodies")

    def body(i):
        b = branches[i]
        joint = 'type="ball"' if b.kind == "ball" else f'type="hinge" axis="{words(b.axis)}"'
        inertia = words(np.maximum(b.body.inertia, 1e-12))   # zero is refused
        sites = "".join(f'<site name="p{k}" pos="{words(at)}"/>' for k, (j, at) in enumerate(m.points) if j == i)
        inner = "".join(body(k) for k, other in enumerate(branches) if other.parent == i)
        return (f'<body name="b{i}" pos="{words(b.place)}" quat="{words(quaternion(b.R))}"><joint {joint}/>'
                f'<inertial mass="{b.body.mass!r}" pos="{words(b.body.center)}" diaginertia="{inertia}"/>'
                f"{sites}{inner}</body>")

    closed = "".join(
        f'<connect body1="b{first}" body2="b{second}" anchor="{words(inside(m, first, at[:3]))}" '
        f'solref="{2 * step!r} 1" solimp="0.9999 0.9999 0.001"/>' for _, first, second, at in rest)
    roots = "".join(body(i) for i, b in enumerate(branches) if b.parent == -1)
    text = (f'<mujoco><compiler boundmass="0" boundinertia="0"/><option gravity="{words(m.gravity)}" '
            f'timestep="{step!r}" integrator="{integrator}"><flag contact="disable"/></option>'
            f"<worldbody>{roots}</worldbody><equality>{closed}</equality></mujoco>")
    rates = [w for b in in_order(branches) for w in (b.rate if b.kind == "ball" else [b.rate @ b.axis])]
    return mujoco.MjModel.from_xml_string(text), rates


def in_order(branches, parent=-1):
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
