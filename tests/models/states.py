# SPDX-License-Identifier: BSD-3-Clause
"""Mass matrix, inverse dynamics, gravity torques and Jacobians of robots in random states: as Pinocchio's to 1e-12, relative to
the largest entry."""
import pathlib
import sys
import tempfile
import unittest
import warnings

import robots

ROBOTS, _ = robots.packages()
import numpy as np   # noqa: E402  which the packages bring
import pinocchio as pin   # noqa: E402

# The package that scripts/python_tests builds; last: numpy and others are those of Pinocchio.
of = "%d.%d" % sys.version_info[:2]
sys.path.append(str(pathlib.Path(__file__).parents[2] / f"build/python-venv-{of}/lib/python{of}/site-packages"))
try:
    import livens as lv   # noqa: E402
except ImportError as error:
    print(f"SKIPPED: states of robots ({error}); scripts/python_tests builds the package")
    sys.exit(robots.SKIPPED)

BOUND = 1e-12
CASES = {   # file, whether its base is free
    "UR5": (ROBOTS / "ur_description/urdf/ur5_robot.urdf", False),
    "Panda": (ROBOTS / "panda_description/urdf/panda.urdf", False),
    "Talos reduced": (ROBOTS / "talos_data/robots/talos_reduced.urdf", False),
    "ANYmal C": (ROBOTS / "anymal_c_simple_description/urdf/anymal.urdf", True),
}


def relative(found, expected):
    return float(np.abs(found - expected).max() / np.abs(expected).max())


class Pair:
    """A robot in a random state, in both. Columns of S are the coordinates of livens in those of Pinocchio, where a base has its
    velocities in its own axes. Joints that mimic others move by themselves, in both."""

    def __init__(self, urdf, free, seed):
        with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
            warnings.simplefilter("ignore")
            robots.prepared(urdf, 0, pathlib.Path(folder, "robot.urdf"))
            urdf = pathlib.Path(folder, "robot.urdf")
            self.model = pin.buildModelFromUrdf(str(urdf), *([pin.JointModelFreeFlyer()] if free else []))
            self.m = lv.from_urdf(urdf, base="free" if free else "fixed", meshes="none", limits="ignore")
            names = self.m.coordinates.q
        rng = np.random.default_rng(seed)
        q, self.v = rng.uniform(-1, 1, len(names)), rng.uniform(-1, 1, len(self.m.coordinates.v))
        self.a = rng.uniform(-2, 2, len(self.v))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            self.state = self.m.at(q, self.v)
        self.data = self.model.createData()
        self.Q, self.S = pin.neutral(self.model), np.zeros((self.model.nv, len(self.v)))
        self.drift = np.zeros(self.model.nv)   # of accelerations: axes of the base turn
        if free:
            self.take_base(q)
        for name in self.m.joints:
            self.take_joint(name)
        self.V, self.A = self.S @ self.v, self.S @ self.a + self.drift

    def take_base(self, q):
        base = self.state[self.m.coordinates.q[0].rpartition(".")[0]]
        w, x, y, z = base.quaternion
        R = pin.Quaternion(w, x, y, z).matrix()
        self.Q[:7] = [*base.position, x, y, z, w]
        self.S[:3, :3] = self.S[3:6, 3:6] = R.T
        self.drift[:3] = R.T @ np.cross(base.velocity, base.angular_velocity)

    def called(self, name):
        """The joint of Pinocchio: one that shares its name with a link has " joint" behind it in livens."""
        return name if self.model.existJointName(name) else name.removesuffix(" joint")

    def take_joint(self, name):
        of = self.model.joints[self.model.getJointId(self.called(name))]
        word, value = next(iter(self.state.joints[name].coordinates.items()))
        self.Q[of.idx_q:of.idx_q + of.nq] = (np.cos(value), np.sin(value)) if of.nq == 2 else value
        self.S[of.idx_v, self.m.coordinates.v.index(f"{name}.{word}_rate")] = 1

    def jacobians(self):
        """Of the place of the last joint on its second body, by both."""
        name = list(self.m.joints)[-1]
        frame = self.model.getFrameId(self.called(name), pin.FrameType.JOINT)
        J = pin.computeFrameJacobian(self.model, self.data, self.Q, frame, pin.LOCAL_WORLD_ALIGNED)
        body = self.state.bodies[self.m.joints[name].between[1]]
        w, x, y, z = body.quaternion
        arm = pin.Quaternion(w, x, y, z).matrix().T @ (self.data.oMf[frame].translation - body.position)
        return self.state.jacobian(body.name, arm), J @ self.S

    def mass_matrix(self):
        M = pin.crba(self.model, self.data, self.Q)
        return self.S.T @ (np.triu(M) + np.triu(M, 1).T) @ self.S


class States(unittest.TestCase):
    def check(self, case):
        for seed in (1, 2, 3):
            p = Pair(*CASES[case], seed)
            found = {
                "mass matrix": relative(p.state.mass_matrix, p.mass_matrix()),
                "inverse dynamics": relative(p.state.inverse_dynamics(p.a) + p.state.load_forces,
                                             p.S.T @ pin.rnea(p.model, p.data, p.Q, p.V, p.A)),
                "gravity": relative(p.state.gravity_forces, p.S.T @ pin.computeGeneralizedGravity(p.model, p.data, p.Q)),
                "Jacobian": relative(*p.jacobians()),
            }
            print(f"| {case} | " + " | ".join(f"{what} {size:.1e}" for what, size in found.items()) + " |", flush=True)
            for what, size in found.items():
                self.assertLess(size, BOUND, what)

    def test_a_state_that_is_off_is_seen(self):
        p = Pair(*CASES["UR5"], 1)
        p.Q[1] += 1e-9
        self.assertGreater(relative(p.state.mass_matrix, p.mass_matrix()), BOUND)

    def test_inverse_kinematics_of_ur5(self):
        p = Pair(*CASES["UR5"], 5)
        goal = p.state["wrist_3_link"]
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            start = dict(zip(p.m.coordinates.q, p.state.q + 0.3))
            found = p.m.at(lv.reach(p.m, "wrist_3_link", (goal.position, goal.quaternion), start=start))
        self.assertLess(np.abs(found["wrist_3_link"].position - goal.position).max(), BOUND)
        self.assertLess(np.abs(found.q - p.state.q).max(), 1e-9)   # on the same branch


for word in CASES:
    setattr(States, "test_" + word.lower().replace(" ", "_"), lambda self, word=word: self.check(word))

if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[1:]])
