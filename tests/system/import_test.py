# SPDX-License-Identifier: BSD-3-Clause
"""`livens import`: robots out of URDFs, as a user meets it.

    LIVENS_PROGRAM=build/release/livens python3 import_test.py [CLASS ...]
"""
import json
import os
import pathlib
import resource
import subprocess
import sys
import tempfile
import unittest

PROGRAM = os.environ.get("LIVENS_PROGRAM", "build/release/livens")
SOURCE = pathlib.Path(os.environ.get("LIVENS_SOURCE_DIR", pathlib.Path(__file__).resolve().parents[2]))
ROBOT = SOURCE / "tests/fuzz/corpus_urdf/every_tag.urdf"
SANITIZED = b"__asan_init" in pathlib.Path(PROGRAM).read_bytes()   # which wants address space without limits
USAGE, SCENARIO, RESOURCES, IO = 2, 3, 5, 6

ARM = """<robot name="arm">
  <link name="base"/>
  <link name="rod"><inertial><origin xyz="0.5 0 0"/><mass value="2"/><inertia ixx="0.001" iyy="0.17" izz="0.17"/></inertial></link>
  <joint name="hinge" type="revolute"><parent link="base"/><child link="rod"/><axis xyz="0 1 0"/><dynamics damping="0.1"/>
    <limit lower="-1" upper="1" effort="10" velocity="2"/></joint>
</robot>
"""


class ProgramTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / "arm.urdf").write_text(ARM)

    def run_program(self, *arguments, code=0, **more):
        ran = subprocess.run([PROGRAM, *map(str, arguments)], cwd=self.folder, capture_output=True, text=True, check=False, **more)
        self.assertEqual(ran.returncode, code, ran.stdout + ran.stderr)
        return ran


class Import(ProgramTest):
    def test_what_it_writes_is_solved(self):
        ran = self.run_program("import", "arm.urdf", "--at", "hinge=0.5", "--end", "2")
        self.assertIn("Written: arm.toml, 1 body, 1 joint and 1 load", ran.stdout)
        self.assertIn("import-lost", ran.stderr)
        text = (self.folder / "arm.toml").read_text()
        self.assertTrue(text.startswith("# From arm.urdf, by livens import.\n# import-"), text)
        solved = json.loads(self.run_program("solve", "arm.toml", "--json").stdout)
        self.assertTrue(solved["converged"])
        shown = json.loads(self.run_program("sample", "arm.nc", "--joint", "hinge", "--at", "0", "--json").stdout)
        self.assertIn("0.5", json.dumps(shown))

    def test_losses_are_listed_for_machines(self):
        ran = self.run_program("import", ROBOT, "-o", "robot.toml", "--json", "--quiet")
        told = json.loads(ran.stdout)
        self.assertEqual(told["scenario"], "robot.toml")
        codes = {warning["code"] for warning in told["warnings"]}
        self.assertEqual(codes, {"import-lost", "import-mended", "import-merged"})
        self.assertTrue(all(warning["line"] > 0 for warning in told["warnings"]))
        self.run_program("check", "robot.toml")

    def test_strict_refuses_what_changes_the_motion(self):
        ran = self.run_program("import", "arm.urdf", "--limits", "ignore", "--strict", code=SCENARIO)
        self.assertIn("error[import-lost]: joint limits are not kept: 1 joint ('hinge')", ran.stderr)
        self.assertIn("arm.urdf:5:5", ran.stderr)
        self.assertFalse((self.folder / "arm.toml").exists())

    def test_files_of_others_stay(self):
        (self.folder / "arm.toml").write_text("mine\n")
        self.run_program("import", "arm.urdf", code=IO)
        self.assertEqual((self.folder / "arm.toml").read_text(), "mine\n")
        self.run_program("import", "arm.urdf", "-o", "arm.urdf", "--force", code=IO)
        self.run_program("import", "arm.urdf", "--force")
        self.run_program("import", "arm.urdf")   # what it made itself it replaces

    def test_usage(self):
        for wrong in (["--at", "hinge"], ["--at", "hinge=x"], ["--base", "loose"], ["--package", "p="], ["--end", "-"]):
            with self.subTest(wrong=wrong):
                self.run_program("import", "arm.urdf", *wrong, code=USAGE)
        self.run_program("import", "none.urdf", code=IO)
        self.run_program("import", "arm.urdf", "--at", "elbow=1", code=SCENARIO)


class HostileImport(ProgramTest):
    def refused(self, text, code=SCENARIO, **more):
        (self.folder / "hostile.urdf").write_bytes(text if isinstance(text, bytes) else text.encode())
        ran = self.run_program("import", "hostile.urdf", code=code, **more)
        self.assertFalse((self.folder / "hostile.toml").exists())
        return ran.stderr

    def test_entities_are_not_expanded(self):
        lines = "".join(f'<!ENTITY l{i + 1} "{f"&l{i};" * 10}">\n' for i in range(12))
        self.assertIn("document types and entities", self.refused(f'<!DOCTYPE r [<!ENTITY l0 "lol">\n{lines}]>\n<robot name="&l12;"/>'))
        secret = self.folder / "secret"
        secret.write_text("do not show")
        for kind in ("SYSTEM", "PUBLIC 'x'"):
            told = self.refused(f'<!DOCTYPE r [<!ENTITY x {kind} "file://{secret}">]>\n' + ARM.replace('"arm"', '"&x;"'))
            self.assertNotIn("do not show", told)

    def test_meshes_go_with_the_scenario(self):
        mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
        visual = "<visual><geometry><mesh filename='package://p/m/a.obj'/></geometry></visual></link>"
        (self.folder / "p/m").mkdir(parents=True)
        (self.folder / "far").mkdir()
        (self.folder / "p/m/a.obj").write_text(mesh)
        (self.folder / "arm.urdf").write_text(ARM.replace("</inertial></link>", "</inertial>" + visual))
        for output, copied in (("near.toml", []), ("far/arm.toml", ["far/p/m/a.obj"])):
            self.run_program("import", "arm.urdf", "-o", output, "--package", "p=p", "--quiet")
            self.assertIn('mesh = "p/m/a.obj"', (self.folder / output).read_text())
            self.run_program("check", output)
            self.assertEqual([str(x.relative_to(self.folder)) for x in self.folder.glob("far/**/*.obj")], copied)
        (self.folder / "far/p/m/a.obj").write_text("else")
        ran = self.run_program("import", "arm.urdf", "-o", "far/arm.toml", "--package", "p=p", code=IO)
        self.assertIn("a file of other content is there", ran.stderr)
        self.run_program("import", "arm.urdf", "-o", "far/arm.toml", "--package", "p=p", "--force", "--quiet")
        self.assertEqual((self.folder / "far/p/m/a.obj").read_text(), mesh)
        self.assertEqual((self.folder / "p/m/a.obj").read_text(), mesh)

    def test_a_large_file_is_refused_by_its_size(self):
        def limit():
            if not SANITIZED:
                resource.setrlimit(resource.RLIMIT_AS, (1 << 29, 1 << 29))
        self.refused(b"<robot>" + b" " * (100 << 20), code=RESOURCES, preexec_fn=limit)

    def test_nothing_else_is_opened(self):
        """By what the kernel sees of it, where strace is there."""
        try:
            subprocess.run(["strace", "-V"], capture_output=True, check=True)
        except (OSError, subprocess.CalledProcessError):
            self.skipTest("no strace")
        visual = "<visual><geometry><mesh filename='{}'/></geometry></visual></link>"
        for name in ("/etc/passwd.stl", "../../secret.stl", "http://localhost/x.stl", "package://p/x.stl"):
            (self.folder / "arm.urdf").write_text(ARM.replace("</inertial></link>", "</inertial>" + visual.format(name)))
            ran = subprocess.run(["strace", "-f", "-e", "trace=network,openat", PROGRAM, "import", "arm.urdf", "--force"],
                                 cwd=self.folder, capture_output=True, text=True, check=False)
            if "Operation not permitted" in ran.stderr and ran.returncode != 0:
                self.skipTest("strace may not trace here")
            self.assertNotIn("socket(", ran.stderr)
            self.assertNotIn(".stl\", O_RDONLY", ran.stderr)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[1:]])
