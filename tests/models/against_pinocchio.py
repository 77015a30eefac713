# SPDX-License-Identifier: BSD-3-Clause
"""Robots fall for a second from a random pose with damping 0.1 at every joint: by livens, and by Pinocchio's articulated-body
algorithm in SciPy's DOP853 to 1e-11. Angles agree to 1e-8."""
import json
import pathlib
import sys
import tempfile
import unittest

import robots

ROBOTS, BULLET = robots.packages()
import numpy as np   # noqa: E402  which the packages bring
import pinocchio as pin   # noqa: E402
from scipy.integrate import solve_ivp   # noqa: E402

DAMPING, BOUND = 0.1, 1e-8
CASES = {   # file, whether its base is free
    "UR5": (ROBOTS / "ur_description/urdf/ur5_robot.urdf", False),
    "Panda": (ROBOTS / "panda_description/urdf/panda.urdf", False),
    "iiwa": (BULLET / "kuka_iiwa/model.urdf", False),
    "Z1": (ROBOTS / "z1_description/urdf/z1.urdf", False),
    "ANYmal C": (ROBOTS / "anymal_c_simple_description/urdf/anymal.urdf", True),
    "Solo12": (ROBOTS / "solo_description/robots/solo12.urdf", True),
    "Talos reduced": (ROBOTS / "talos_data/robots/talos_reduced.urdf", False),
    "G1": (ROBOTS / "g1_description/urdf/g1_29dof_rev_1_0.urdf", False),
}


def velocity(model, q, v):
    """Rates of configuration numbers."""
    rates = np.zeros(model.nq)
    for joint in list(model.joints)[1:]:
        a, b = joint.idx_q, joint.idx_v
        if joint.nq == joint.nv:
            rates[a:a + joint.nq] = v[b:b + joint.nv]
        elif joint.nq == 2:
            rates[a], rates[a + 1] = -q[a + 1] * v[b], q[a] * v[b]
        else:   # a free flyer
            x, y, z, w = q[a + 3:a + 7]
            rates[a:a + 3] = pin.Quaternion(w, x, y, z).matrix() @ v[b:b + 3]
            p, r, s = v[b + 3:b + 6]
            rates[a + 3:a + 7] = 0.5 * np.array([w * p + y * s - z * r, w * r + z * p - x * s, w * s + x * r - y * p,
                                                 -x * p - y * r - z * s])
    return rates


def reference(urdf, at, free):
    """Coordinates of joints at 0, 0.1, .. 1 s by name."""
    model = pin.buildModelFromUrdf(str(urdf), pin.JointModelFreeFlyer()) if free else pin.buildModelFromUrdf(str(urdf))
    data = model.createData()
    q, damping = pin.neutral(model), np.zeros(model.nv)
    for name, value in at.items():
        joint = model.joints[model.getJointId(name)]
        q[joint.idx_q:joint.idx_q + joint.nq] = (np.cos(value), np.sin(value)) if joint.nq == 2 else value
        damping[joint.idx_v] = DAMPING

    def rates(_, state):
        q, v = state[:model.nq], state[model.nq:]
        return np.concatenate([velocity(model, q, v), pin.aba(model, data, q, v, -damping * v)])
    times = np.linspace(0, 1, 11)
    solved = solve_ivp(rates, (0, 1), np.concatenate([q, np.zeros(model.nv)]), method="DOP853", rtol=1e-11, atol=1e-12,
                       t_eval=times)
    found = {}
    for name in at:
        joint = model.joints[model.getJointId(name)]
        of = solved.y[joint.idx_q]
        found[name] = np.unwrap(np.arctan2(solved.y[joint.idx_q + 1], of)) if joint.nq == 2 else of
    return found


def difference(case, accuracy, bend=0.0):
    """Largest of any joint at any instant, and what livens says of itself. `bend` spoils the reference's pose."""
    urdf, free = CASES[case]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        moving = robots.prepared(urdf, DAMPING, folder / "robot.urdf")
        at = dict(zip(moving, np.random.default_rng(1).uniform(-0.5, 0.5, len(moving)).tolist()))
        found, summary, _ = robots.angles(folder / "robot.urdf", at, free, accuracy, folder)
        expected = reference(folder / "robot.urdf", {n: v + bend for n, v in at.items()}, free)
    return max(float(np.abs(np.array(found[name]) - expected[name]).max()) for name in moving), json.loads(summary)


class AgainstPinocchio(unittest.TestCase):
    def check(self, case, accuracy=1e-9):
        worst, summary = difference(case, accuracy)
        told = {key: summary.get(key) for key in ("method", "elements", "solve_seconds", "estimated_error")}
        print(f"| {case} | {worst:.1e} | {told['estimated_error']:.1e} | {told['elements']} |", flush=True)
        self.assertLess(worst, BOUND)

    def test_a_pose_that_is_off_is_seen(self):
        self.assertGreater(difference("UR5", 1e-9, bend=1e-7)[0], BOUND)


for word in CASES:
    setattr(AgainstPinocchio, "test_" + word.lower().replace(" ", "_"), lambda self, word=word: self.check(word))

if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[1:]])
