# SPDX-License-Identifier: BSD-3-Clause
"""Each thing that lv.from_mjcf takes, alone, against MuJoCo's RK4; and what it says of the rest."""
import contextlib
import io
import pathlib
import re
import sys
import tempfile
import unittest
import warnings

import menagerie

ASSETS, mujoco, lv = menagerie.packages()
import numpy as np   # noqa: E402  which the packages bring

FREE, BALL, SLIDE, HINGE = range(4)
LINK = "<geom type='box' size='.2 .05 .03' pos='.2 0 0' density='1000' contype='0' conaffinity='0'/>"
HEAD = "<mujoco><compiler angle='radian'/><option timestep='1e-4' integrator='RK4' tolerance='1e-15' iterations='200'/>"


TURNING = {"tendon of constant length", "curved coupling"}


def model(bodies, *more):
    return HEAD + f"<worldbody>{bodies}</worldbody>{''.join(more)}</mujoco>"


def body(name, inside, at="0 0 0"):
    return f"<body name='{name}' pos='{at}'>{inside}</body>"


def arm(first, second, more=""):
    """Two links, with these joints."""
    return body("a", first + LINK + body("b", second + LINK + more, ".4 0 0"))


HINGED = "<joint name='{}' type='hinge' axis='{}' {}/>"
PAIR = arm(HINGED.format("p", "0 1 0", ""), HINGED.format("q", "0 1 .2", ""))
HUNG = arm(HINGED.format("p", "0 1 0", ""), HINGED.format("q", "0 1 .2", ""), "<site name='e' pos='.35 .02 .03'/>").replace(
    "<body name='b'", "<site name='s' pos='.2 0 .1'/><body name='b'") + "<site name='o' pos='-.2 .1 .4'/><site name='w' pos='.5 .1 .6'/>"
SLIDES = arm("<joint name='p' type='slide' axis='0 0 1' stiffness='900'/>", "<joint name='q' type='slide' axis='1 0 0'/>")
STIFF = "solref='0.0005 1' solimp='.9999 .9999 .001 .5 2'"
CASES = {   # the model, what moves at first by joint, and the bound
    "hinge": (arm(HINGED.format("p", "0 1 0", "damping='.3' stiffness='4' springref='.5' armature='.2' ref='.3'"),
                  HINGED.format("q", ".2 1 0", "armature='.01' pos='.1 .2 0'")), [], {"p": 0.7, "q": -0.4}, 1e-9),
    "slide": (arm("<joint name='p' type='slide' axis='0 .6 .8' damping='2' stiffness='300' armature='3'/>",
                  HINGED.format("q", "0 1 0", "")), [], {"p": 0.1, "q": 1}, 1e-9),
    "ball": (arm("<joint name='p' type='ball' damping='.2'/>", "<joint name='q' type='ball' pos='.05 0 0'/>"), [], {}, 1e-9),
    "ball spring": (arm("<joint name='p' type='ball' stiffness='12'/>", HINGED.format("q", "0 0 1", "")), [], {"q": 0.4}, 1e-9),
    "several joints": (arm("<joint name='x' type='slide' axis='1 0 0' stiffness='200'/><joint name='z' type='slide' axis='0 0 1' stiffness='400'/>"
                           + HINGED.format("p", "0 1 0", "pos='.1 0 0' damping='.1'"),
                           HINGED.format("q", "1 0 0", "") + HINGED.format("r", "0 1 0", "") + HINGED.format("s", "0 0 1", "")), [],
                       {"x": 0.05, "q": 0.3, "r": 0.5, "s": -0.6}, 1e-7),
    "free": (body("a", "<freejoint/>" + LINK + body("c", LINK, ".1 .1 .1") + body("b", HINGED.format("q", "0 1 0", "") + LINK, ".4 0 0")),
             [], {"q": 0.5}, 1e-9),
    "free with damping": (body("a", "<joint type='free' damping='.3'/>" + LINK), [], {}, 1e-9),
    "gravity compensation": (body("a", HINGED.format("p", "0 1 0", "") + LINK).replace("name='a'", "name='a' gravcomp='.7'"), [], {}, 1e-9),
    "motor": (PAIR, ["<actuator><motor name='m' joint='p' gear='3' ctrllimited='true' ctrlrange='-1 1'/></actuator>"], {}, 1e-9),
    "servo": (PAIR, ["<actuator><position name='m' joint='p' kp='30' kv='2' gear='2'/><velocity name='v' joint='q' kv='.4'/></actuator>"],
              {"p": 0.2}, 1e-9),
    "force limit": (PAIR, ["<actuator><position name='m' joint='p' kp='90' forcelimited='true' forcerange='-5 5'/></actuator>"],
                    {"p": 0.2}, 1e-7),
    "rotor of a motor": (PAIR, ["<actuator><position name='m' joint='p' kp='9' gear='2' armature='.3' damping='.2'/></actuator>"], {}, 1e-9),
    "tendon": (PAIR, ["<tendon><fixed name='t' stiffness='20' damping='1'><joint joint='p' coef='1'/><joint joint='q' coef='-.5'/></fixed></tendon>",
                      "<actuator><position name='m' tendon='t' kp='3'/></actuator>"], {"p": 0.4, "q": 0.2}, 1e-9),
    "slack tendon": (PAIR, ["<tendon><fixed name='t' stiffness='40' springlength='-.1 .1'><joint joint='p' coef='1'/></fixed></tendon>"], {}, 1e-7),
    "tendon over sites": (HUNG, ["<tendon><spatial name='t' stiffness='300' damping='3' springlength='.5'><site site='o'/><site site='s'/><site site='w'/>"
                                "<site site='e'/></spatial></tendon>"], {"p": 0.4, "q": 0.2}, 1e-9),
    "slack tendon over sites": (HUNG, ["<tendon><spatial name='t' stiffness='300' springlength='0 1.2'><site site='o'/><site site='s'/><site site='e'/>"
                                      "</spatial></tendon>"], {"p": 0.4, "q": 0.2}, 1e-7),
    "tendon of constant length": (HUNG, ["<tendon><spatial name='t'><site site='o'/><site site='s'/><site site='w'/><site site='e'/></spatial></tendon>",
                                        f"<equality><tendon tendon1='t' {STIFF}/></equality>"], {}, 1e-6),
    "curved coupling": (PAIR, [f"<equality><joint joint1='q' joint2='p' polycoef='.1 -.5 .3 .2 0' {STIFF}/></equality>"], {"p": 0.3}, 1e-7),
    "gear": (PAIR, [f"<equality><joint joint1='q' joint2='p' polycoef='.1 -2 0 0 0' {STIFF}/></equality>"], {"p": 0.3}, 1e-7),
    "gear without teeth": (PAIR, [f"<equality><joint joint1='q' joint2='p' polycoef='0 1.2345678 0 0 0' {STIFF}/></equality>"], {"p": 0.3}, 1e-7),
    "rack": (arm(HINGED.format("p", "0 1 0", ""), "<joint name='q' type='slide' axis='1 0 0'/>"),
             [f"<equality><joint joint1='q' joint2='p' polycoef='0 .2 0 0 0' {STIFF}/></equality>"], {"p": 0.3}, 1e-7),
    "two slides": (SLIDES, [f"<equality><joint joint1='q' joint2='p' polycoef='0 .5 0 0 0' {STIFF}/></equality>"], {"p": 0.05}, 1e-7),
    "held joint": (PAIR, [f"<equality><joint joint1='q' polycoef='.4 0 0 0 0' {STIFF}/></equality>"], {"p": 0.3}, 1e-7),
    "connect": (PAIR + body("c", HINGED.format("r", "0 1 0", "") + LINK, "0 0 -.3"),
                [f"<equality><connect body1='a' body2='c' anchor='.1 0 0' {STIFF}/></equality>"], {}, 1e-6),
    "slide and ball": (arm("<joint name='x' type='slide' axis='0 0 1' stiffness='500'/><joint name='p' type='ball' damping='.1'/>",
                           HINGED.format("q", "0 1 0", "")), [], {"x": 0.02, "q": 0.3}, 1e-7),
    "connect of sites": (PAIR.replace("name='p'", "name='p' damping='.1'") + body("c", HINGED.format("r", "0 1 0", "") + LINK
                         + "<site name='s' pos='.1 0 .3'/>", "0 0 -.3") + "<site name='w' pos='.1 0 0'/>",
                         [f"<equality><connect site1='s' site2='w' {STIFF}/></equality>"], {}, 1e-6),
    "weld of sites": (body("a", HINGED.format("p", "0 1 0", "") + LINK + "<site name='s' pos='.3 .1 -.1' euler='.1 .2 .3'/>")
                      + body("c", "<freejoint/>" + LINK + "<site name='t' euler='.1 .2 .3'/>", ".3 .1 -.1"),
                      [f"<equality><weld site1='s' site2='t' {STIFF}/></equality>"], {}, 1e-6),
    "weld to the world": (arm("<joint name='p' type='ball'/>", "<joint name='q' type='ball'/>") + body("c", "<freejoint/>" + LINK, ".3 .1 -.1"),
                          [f"<equality><weld body1='c' {STIFF}/></equality>"], {}, 1e-6),
    "weld at a point": (body("a", HINGED.format("p", "0 1 0", "") + LINK) + body("c", "<freejoint/>" + LINK, ".3 .1 -.1").replace("name='c'", "name='c' euler='.4 0 .2'"),
                        [f"<equality><weld body1='a' body2='c' anchor='.1 .2 0' {STIFF}/></equality>"], {}, 1e-6),
    "coupled tendons": (PAIR, ["<tendon><fixed name='t'><joint joint='p' coef='.3'/></fixed><fixed name='u'><joint joint='q' coef='.6'/></fixed></tendon>",
                               f"<equality><tendon tendon1='u' tendon2='t' polycoef='0 1.5 0 0 0' {STIFF}/></equality>"], {}, 1e-7),
    "motor in the parent": (PAIR, ["<actuator><motor name='m' jointinparent='q' gear='3'/></actuator>"], {}, 1e-9),
    "limit of the joint": (arm(HINGED.format("p", "0 1 0", "actuatorfrcrange='-4 4'"), HINGED.format("q", "0 1 0", "")),
                           ["<actuator><position name='m' joint='p' kp='30'/></actuator>"], {}, 1e-7),
    "general law": (PAIR, ["<actuator><general name='m' joint='p' gaintype='affine' gainprm='3 .5 -.2' biastype='affine' biasprm='1 -4 -.3' gear='1.5'/></actuator>"],
                    {"p": 0.2}, 1e-9),
    "weld": (body("a", HINGED.format("p", "0 1 0", "") + LINK) + body("c", "<freejoint/>" + LINK, ".3 .1 -.1"),
             [f"<equality><weld body1='a' body2='c' {STIFF}/></equality>"], {}, 1e-6),
}


def reference(m, q, v, control):
    data = mujoco.MjData(m)
    data.qpos[:], data.qvel[:], data.ctrl[:] = q, v, control
    found = [np.array(data.qpos)]
    for _ in range(5):
        mujoco.mj_step(m, data, 1000)
        found.append(np.array(data.qpos))
    return np.array(found)


def difference(m, made, at, q, v, control):
    """Largest of any coordinate of hinges and slides, and of places and directors of bodies."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        sol = lv.solve(made, 0.5, accuracy=1e-10, output=0.1)(np.linspace(0, 0.5, 6))
    expected, worst = reference(m, q, v, control), 0.0
    data = mujoco.MjData(m)
    for k, row in enumerate(expected):
        data.qpos[:] = row
        mujoco.mj_kinematics(m, data)
        for b in range(1, m.nbody):
            name = mujoco.mj_id2name(m, mujoco.mjtObj.mjOBJ_BODY, b)
            if name in made.bodies:
                worst = max(worst, np.abs(sol[name].position[k] - data.xpos[b]).max(),
                            np.abs(sol[name].directors[k].T - data.xmat[b].reshape(3, 3)).max())
    for j in range(m.njnt):
        name = mujoco.mj_id2name(m, mujoco.mjtObj.mjOBJ_JOINT, j)
        if m.jnt_type[j] in (HINGE, SLIDE):
            found = sol[name].angle if m.jnt_type[j] == HINGE else sol[name].displacement
            worst = max(worst, np.abs(found - expected[:, m.jnt_qposadr[j]]).max())
    return worst


class TakesEachAlone(unittest.TestCase):
    def check(self, case, spoilt=0.0):
        bodies, more, at, bound = CASES[case]
        m = mujoco.MjModel.from_xml_string(model(bodies, *more))
        control = {mujoco.mj_id2name(m, mujoco.mjtObj.mjOBJ_ACTUATOR, i): 0.8 for i in range(m.nu)}
        v = np.random.default_rng(3).uniform(-1, 1, m.nv) if m.neq == 0 else np.zeros(m.nv)
        made = lv.from_mjcf(m, at=at, qvel=v, control=control)
        data = mujoco.MjData(m)
        for name, value in at.items():
            data.qpos[m.jnt_qposadr[mujoco.mj_name2id(m, mujoco.mjtObj.mjOBJ_JOINT, name)]] = value
        for e in range(m.neq):
            if m.eq_type[e] == mujoco.mjtEq.mjEQ_JOINT:   # as it is told: moved to where it belongs
                follows, leads = m.eq_obj1id[e], m.eq_obj2id[e]
                x = data.qpos[m.jnt_qposadr[leads]] if leads >= 0 else 0
                data.qpos[m.jnt_qposadr[follows]] = np.polynomial.polynomial.polyval(x, m.eq_data[e][:5])
        return difference(m, made, at, data.qpos, v, [0.8 + spoilt] * m.nu), bound

    def test_a_control_that_is_off_is_seen(self):
        worst, bound = self.check("servo", 1e-6)
        self.assertGreater(worst, bound)


    def test_rows_whose_gradients_turn(self):
        """MuJoCo's constraints leave out how fast their gradients turn, and give way by that times the square of their time."""
        for case in sorted(TURNING):
            bodies, more, at, bound = CASES[case]
            apart = []
            for time in (".0008", ".0004", ".0002"):
                CASES["softer"] = bodies, [one.replace("'0.0005 1'", f"'{time} 1'") for one in more], at, bound
                apart.append(self.check("softer")[0])
            del CASES["softer"]
            print(f"| {case} | {apart} |", flush=True)
            for soft, stiff in zip(apart, apart[1:]):
                self.assertAlmostEqual(soft / stiff, 4, delta=0.4)
            self.assertLess(abs(4 * apart[2] - apart[1]) / 3, 2e-7)   # what is left as they stiffen


def compared(case):
    def test(self):
        worst, bound = self.check(case)
        print(f"| {case} | {worst:.1e} | {bound:g} |", flush=True)
        self.assertLess(worst, bound)
    return test


for word in CASES.keys() - TURNING:
    setattr(TakesEachAlone, "test_" + word.replace(" ", "_"), compared(word))

def losses(m):
    return {(d.code, d.message.partition(":")[0]): d.message.partition(": ")[2] for d in m.imported}


class Tells(unittest.TestCase):
    def made(self, bodies, *more, **options):
        return lv.from_mjcf(model(bodies, *more), **options)

    def refused(self, code, call, *words):
        with self.assertRaises(lv.InputError) as caught:
            call()
        self.assertEqual(caught.exception.code, code, str(caught.exception))
        for word in words:
            self.assertIn(word, str(caught.exception))
        return caught.exception

    def test_what_is_lost_is_listed_once_with_count_and_names(self):
        touching = LINK.replace(" contype='0' conaffinity='0'", " name='{}'")
        m = self.made("<light/><camera name='c'/>" + body("a", HINGED.format("p", "0 1 0", "frictionloss='1'") + touching.format("g"))
                      + body("b", HINGED.format("q", "0 1 0", "frictionloss='2'") + touching.format("h"), "3 0 0"),
                      "<actuator><muscle name='u' joint='p' lengthrange='0 1'/></actuator>", "<sensor><jointpos joint='p'/></sensor>")
        told = losses(m)
        self.assertEqual(told["import-lost", "dry friction is not kept"], "2 joints ('p', 'q')")
        self.assertEqual(told["import-lost", "contacts are not kept (bodies do not touch)"], "2 geoms ('g', 'h')")
        self.assertEqual(told["import-lost", "muscles, actuators with states of their own, plugins and delays are not kept"], "1 actuator ('u')")
        for word in ("cameras", "lights", "sensors"):
            self.assertIn(("import-lost", f"{word} are not kept"), told)
        self.assertEqual([d.severity for d in m.imported], ["warning"] * len(m.imported))

    def test_strict_refuses_what_changes_the_motion_alone(self):
        self.assertTrue(self.made("<camera/>" + PAIR, strict=True).imported)
        error = self.refused("import-lost", lambda: self.made(PAIR.replace("'q'", "'q' frictionloss='1'"), strict=True), "dry friction")
        self.assertTrue(all(d.severity == "error" for d in error.diagnostics))

    def test_ratios_of_angles_become_those_of_whole_numbers(self):
        for ratio, told in (("0.9999", "rounded"), ("-0.25", ""), ("2.5", ""), ("-0.3333333", "rounded"), ("1e-5", "10000 apart"), ("1e7", "10000 apart")):
            m = self.made(PAIR, f"<equality><joint joint1='q' joint2='p' polycoef='0 {ratio} 0 0 0'/></equality>")
            said = [d.message for d in m.imported if "rounded" in d.message or "apart" in d.message]
            self.assertEqual(len(said), bool(told), ratio)
            self.assertTrue(not told or told in said[0])
            if "apart" in told:
                self.assertNotIn("equality 0", m.joints)
            else:
                sol = lv.solve(m, 0.3)
                self.assertAlmostEqual(sol["q"].angle[-1], float(ratio) * sol["p"].angle[-1], delta=2e-7)

    def test_balls_are_limited_from_where_their_quaternion_is_one(self):
        def ball(most):
            return arm(f"<joint name='p' type='ball' limited='true' range='0 {most}'/>", "")
        m = self.made(ball(0.7), qpos=[np.cos(0.1), np.sin(0.1), 0, 0])
        m.add_sensor("s", type="joint", joint="p")
        sol = lv.solve(m, 0.01)
        self.assertAlmostEqual(sol.sensors["s"].rotation_angle[0], 0.2, delta=1e-12)
        self.assertAlmostEqual(m["p"].limit, 0.7, delta=1e-12)
        for most, word in ((0.1, "limits are not kept beyond which a joint begins"), (3.1, "limits of ball joints beyond 170 degrees are not kept")):
            m = self.made(ball(most), qpos=[np.cos(0.1), np.sin(0.1), 0, 0])
            self.assertIn("1 joint ('p')", losses(m)["import-lost", word])
            self.assertIsNone(m["p"].limit)

    def test_limits_are_kept_left_out_or_told(self):
        bodies = arm(HINGED.format("p", "0 1 0", "range='-1 1'"), HINGED.format("q", "0 1 0", "range='0 2'"))
        m = self.made(bodies)
        self.assertEqual((list(m["p"].limits), list(m["q"].limits)), ([-1, 1], [0, 2]))   # where it begins is no loss
        self.assertNotIn("beyond which", str(losses(m)))
        m = self.made(bodies, at={"q": -2e-9})
        self.assertEqual((list(m["p"].limits), list(m["q"].limits)), ([-1, 1], [-np.inf, 2]))
        self.assertIn("1 joint ('q')", losses(m)["import-lost", "limits are not kept beyond which a joint begins"])
        self.assertNotIn("limits", self.made(bodies, limits="ignore").to_toml())
        self.refused("unknown-choice", lambda: self.made(bodies, limits="none"))

    def test_what_is_switched_off_in_the_file_is_off(self):
        loaded = arm(HINGED.format("p", "0 1 0", "damping='1' stiffness='2' range='-1 1'"), HINGED.format("q", "0 1 0", ""))
        off = "<option><flag gravity='disable' limit='disable' actuation='disable'/></option>"
        m = self.made(loaded, off, "<actuator><position joint='p' kp='3'/></actuator>")
        self.assertEqual((list(m.gravity), len(m.loads), "limits" in m.to_toml()), ([0, 0, 0], 0, False))

    def test_keyframes_controls_and_states(self):
        key = "<keyframe><key/><key name='bent' qpos='.5 -.2' qvel='1 2' ctrl='3'/></keyframe>"
        motor = "<actuator><motor name='m' joint='p' gear='2'/></actuator>"
        for wanted in ("bent", 1):
            m = self.made(PAIR, motor, key, keyframe=wanted)
            self.assertEqual((m["p"].coordinate, m["q"].coordinate, m["m"].value), (.5, -.2, 6))
            self.assertAlmostEqual(m["b"].angular_velocity[1], 1 + 2 / np.hypot(1, .2), places=12)
        self.assertEqual(self.made(PAIR, motor, at={"p": "30 deg"})["p"].coordinate, np.pi / 6)
        for options, code in (({"keyframe": "bnet"}, "unknown-choice"), ({"keyframe": 2}, "unknown-choice"), ({"qpos": [1]}, "wrong-type"),
                              ({"qpos": [1, np.nan]}, "not-finite"), ({"at": {"r": 1}}, "joint-unknown"), ({"at": {"p": "1 m"}}, "unit"),
                              ({"control": {"n": 1}}, "load-unknown"), ({"qvel": "fast"}, "wrong-type"), ({"keyframe": True}, "unknown-choice")):
            self.refused(code, lambda options=options: self.made(PAIR, motor, key, **options))

    def test_a_formula_steers(self):
        motor = "<actuator><position name='m' joint='p' kp='50' kv='5' ctrllimited='true' ctrlrange='-.3 .3'/></actuator>"
        at_once = self.made(PAIR, motor, control={"m": 0.9})
        by_formula = self.made(PAIR, motor, control={"m": "0.4 + 0.5*cos(0*t)"})
        one, other = (lv.solve(m, 0.5, accuracy=1e-9)["p"].angle[-1] for m in (at_once, by_formula))
        self.assertAlmostEqual(one, other, places=9)
        self.assertNotAlmostEqual(one, lv.solve(self.made(PAIR, motor, control={"m": -0.3}), 0.5)["p"].angle[-1], places=3)

    def test_names_are_unique_and_points_stay(self):
        m = self.made(body("a", HINGED.format("a", "0 1 0", "") + LINK + body("tip", "<site name='a' pos='0 0 .1'/>" + LINK, ".4 0 0")),
                      "<actuator><motor name='a' joint='a'/></actuator>")
        self.assertEqual((list(m.bodies), list(m.joints), list(m.points), list(m.loads)), (["a"], ["a joint"], ["tip", "a site"], ["a motor"]))
        self.assertEqual(list(m["a site"].position), [.4, 0, .1])

    def test_a_file_of_its_own_says_the_same(self):
        with tempfile.TemporaryDirectory() as folder:
            for case, (bodies, more, at, _) in CASES.items():
                m = self.made(bodies, *more, at=at)
                self.assertEqual(lv.load(text=m.to_toml()), m, case)
            m.to_toml(pathlib.Path(folder, "m.toml"))
            m.time.end = 0.1
            m.to_toml(pathlib.Path(folder, "m.toml"), force=True)
            lv.solve(m).save(pathlib.Path(folder, "one.nc"))
            lv.solve(lv.load(pathlib.Path(folder, "m.toml"))).save(pathlib.Path(folder, "other.nc"))
            self.assertEqual(pathlib.Path(folder, "one.nc").read_bytes(), pathlib.Path(folder, "other.nc").read_bytes())

    def test_meshes_are_written_where_they_are_asked_for(self):
        file = ASSETS / CASES_WITH_MESHES
        self.assertIn(("import-lost", "meshes are not drawn"), losses(lv.from_mjcf(file)))
        with tempfile.TemporaryDirectory() as folder:
            for _ in range(2):   # the same once more is no loss
                m = lv.from_mjcf(file, meshes=pathlib.Path(folder, "new"))
            meshes = sorted(path.name for path in pathlib.Path(folder, "new").iterdir())
            self.assertGreater(len(meshes), 5)
            self.assertTrue(all(name.endswith(".stl") for name in meshes))
            m.to_toml(pathlib.Path(folder, "new/robot.toml"))
            self.assertEqual(lv.load(pathlib.Path(folder, "new/robot.toml")), m)
            pathlib.Path(folder, "new", meshes[0]).write_text("mine")
            with self.assertRaises(FileExistsError):
                lv.from_mjcf(file, meshes=pathlib.Path(folder, "new"))

    def test_what_is_no_mjcf_is_refused(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, "m.xml")
            file.write_text("<mujoco>\n<worldbody>\n<bdy/>\n</worldbody></mujoco>")
            error = self.refused("mjcf-read", lambda: lv.from_mjcf(file), "bdy")
            self.assertEqual((error.file, error.line), (str(file), 3))
            self.assertRaises(FileNotFoundError, lv.from_mjcf, file.with_name("none.xml"))
            self.assertRaises(IsADirectoryError, lv.from_mjcf, folder)
        self.refused("mjcf-read", lambda: lv.from_mjcf("<robot name='r'><link name='l'/></robot>"), "lv.from_urdf")
        self.refused("mjcf-read", lambda: lv.from_mjcf("<sdf/>"), "<mujoco>")
        self.refused("mass-missing", lambda: self.made(LINK), "nothing")
        self.assertRaises(TypeError, lv.from_mjcf, 7)

    def test_a_model_a_specification_and_a_text_are_the_same(self):
        text = model(PAIR)
        for given in (mujoco.MjModel.from_xml_string(text), mujoco.MjSpec.from_string(text)):
            self.assertEqual(lv.from_mjcf(given), lv.from_mjcf(text))

    def test_a_compiled_model_that_was_spoilt_is_refused(self):
        for field, value, code in (("body_mass", np.nan, "not-finite"), ("body_mass", -1, "mass-not-positive"),
                                   ("dof_damping", np.inf, "not-finite"), ("qpos0", np.nan, "not-finite")):
            m = mujoco.MjModel.from_xml_string(model(PAIR))
            getattr(m, field)[-1] = value
            self.refused(code, lambda m=m: lv.from_mjcf(m))
        m.opt.gravity[:] = np.nan
        m.qpos0[:] = 0
        self.refused("not-finite", lambda: lv.from_mjcf(m), "gravity")
        self.refused("expression-syntax", lambda: self.made(PAIR, "<actuator><motor name='m' joint='p'/></actuator>", control={"m": "1 +"}))

    def test_the_page_does_what_it_shows(self):
        root = menagerie.ROOT
        sys.path.insert(0, str(root / "tests/docs"))
        import blocks
        page = (root / "docs/howto/mujoco.md").read_text(encoding="utf-8")
        space = {}
        for code, shown in re.findall(r"```python\n(.*?)```\s*```text\n(.*?)```", page, re.S):
            printed = io.StringIO()
            with contextlib.redirect_stdout(printed):
                exec(code, space)
            self.assertTrue(blocks.same(shown, printed.getvalue()), f"shown:\n{shown}\ncame out:\n{printed.getvalue()}")


CASES_WITH_MESHES = "robosuite/models/assets/robots/panda/robot.xml"

if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[1:]])
