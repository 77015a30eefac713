# SPDX-License-Identifier: BSD-3-Clause
"""scripts/needs in a repository of its own: a change selects what depends on it, and nothing else; where nothing can be
compared everything is selected. needs_test.py ROOT; exit 77 without git."""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(sys.argv.pop(1) if len(sys.argv) > 1 else ".").resolve()
EVERYTHING = {"fuzzers", "program", "browser", "installs", "shared", "models", "controls", "site", "packages", "headers=all", "mutants=all"}
IDENTITY = {f"GIT_{who}_{what}": "nobody@example.org" for who in ["AUTHOR", "COMMITTER"] for what in ["NAME", "EMAIL"]}


def run(folder, *command, **variables):
    environment = {name: value for name, value in os.environ.items() if not name.startswith(("GIT_", "LIVENS_BASE"))}
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False,
                          env=environment | IDENTITY | {"GIT_CONFIG_GLOBAL": os.devnull} | variables)


class Needs(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.scratch.name, "livens")
        for name in ["src", "tests", "cmake", "report/src"]:
            shutil.copytree(ROOT / name, cls.folder / name, ignore=shutil.ignore_patterns("corpus*", "data", "*.html"))
        for name in ["scripts/needs", "README.md"]:
            (cls.folder / name).parent.mkdir(exist_ok=True)
            shutil.copy(ROOT / name, cls.folder / name)
        for command in [["init", "-q", "-b", "main"], ["add", "."], ["commit", "-q", "-m", "all of it"]]:
            run(cls.folder, "git", *command)

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    def setUp(self):
        run(self.folder, "git", "checkout", "-q", "-f", "-B", "branch", "main")
        run(self.folder, "git", "clean", "-q", "-f", "-d")

    def change(self, *paths, line="int changed;"):
        for path in paths:
            file = self.folder / path
            file.parent.mkdir(parents=True, exist_ok=True)
            with file.open("a") as text:
                text.write(f"{line}\n")

    def commit(self, *paths):
        self.change(*paths)
        run(self.folder, "git", "add", ".")
        run(self.folder, "git", "commit", "-q", "--allow-empty", "-m", "change")

    def needed(self, *arguments, **variables):
        """The words but for mutants and headers, the mutants' names, and what was said."""
        ran = run(self.folder, sys.executable, "-B", "scripts/needs", *arguments, **variables)
        self.assertEqual(ran.returncode, 0, ran.stderr)
        words = ran.stdout.split()
        self.assertTrue(words[-2].startswith("headers="))
        self.assertTrue(words[-1].startswith("mutants="))
        self.headers = set(words[-2].removeprefix("headers=").split(";"))
        return set(words[:-2]), set(words[-1].removeprefix("mutants=").split(";")), ran.stderr

    def test_a_header_selects_itself_and_all_that_include_it(self):
        self.needed(LIVENS_BASE="HEAD")
        self.assertEqual(self.headers, {"none"})
        self.needed()
        self.assertEqual(self.headers, {"all"}, "there is no HEAD~20")
        (self.folder / "src/livens/new").mkdir()
        for name, included in [("a", "<vector>"), ("b", '"livens/new/a.h"'), ("c", '"livens/new/b.h"'), ("d", "<vector>")]:
            self.change(f"src/livens/new/{name}.h", line=f"#include {included}")
        run(self.folder, "git", "add", ".")
        run(self.folder, "git", "commit", "-q", "-m", "headers")
        self.change("src/livens/new/a.h")
        self.needed(LIVENS_BASE="HEAD")
        self.assertEqual(self.headers, {f"livens/new/{name}.h" for name in "abc"})

    def test_a_source_selects_its_mutants_and_no_others(self):
        self.commit("src/livens/time/quadrature.cpp")
        words, mutants, _ = self.needed()
        self.assertIn("lobatto_weight", mutants)
        faults = (ROOT / "tests/mutants/faults.cmake").read_text()
        self.assertEqual(len(mutants), faults.count("FILE time/quadrature.cpp"))
        self.assertEqual(words, {"fuzzers"})   # files have laws in time

    def test_a_line_of_comment_selects_no_mutants(self):
        self.change("src/livens/time/quadrature.cpp", line="    // why it is so")
        self.assertEqual(self.needed()[1], {"none"})
        self.change("src/livens/time/quadrature.cpp", line="int x;   // why it is so")
        self.assertIn("lobatto_weight", self.needed()[1])

    def test_a_test_selects_the_mutants_that_it_must_notice(self):
        paths = (self.folder / "tests/unit/time").glob("*.cpp")
        self.change(*[path.relative_to(self.folder) for path in paths if "TEST(GaussLobatto," in path.read_text()])
        words, mutants, _ = self.needed()
        self.assertIn("lobatto_weight", mutants)
        self.assertNotIn("torque_half", mutants)
        self.assertEqual(words, set())

    def test_a_fault_that_is_told_otherwise_selects_itself(self):
        file = self.folder / "tests/mutants/faults.cmake"
        file.write_text(file.read_text().replace("[[2 / ((n + 1) * (n + 2) * p * p)]]", "[[2 / (n * n * p * p)]]"))
        self.assertEqual(self.needed()[:2], (set(), {"lobatto_weight"}))

    def test_how_mutants_are_made_selects_a_few_of_them_all(self):
        self.change("tests/mutants/mutate.cmake")
        n = (ROOT / "tests/mutants/faults.cmake").read_text().count("livens_mutant(NAME")
        self.assertEqual(len(self.needed()[1]), -(-n // 40))

    def test_a_test_that_stands_in_another_namespace_selects_nothing(self):
        path = self.folder / "tests/unit/time/quadrature.cpp"
        text = path.read_text()
        path.write_text(text.replace("namespace livens::quadrature_test", "namespace livens::elsewhere"))
        self.assertNotEqual(path.read_text(), text)
        self.assertEqual(self.needed()[:2], (set(), {"none"}))
        path.write_text(path.read_text().replace("TEST(", "TEST(Renamed", 1))
        self.assertNotEqual(self.needed()[1], {"none"})

    def test_folders_select_what_depends_on_them(self):
        for path, words in [("report/src/new.ts", {"browser"}), ("docs/theory.md", {"site"}), ("packaging/README.md", {"packages"}),
                            ("tests/install/install.cmake", {"installs", "shared"}), ("tests/fuzz/mesh.cpp", {"fuzzers"}),
                            ("src/livens/geometry/new.cpp", {"fuzzers"}), ("reported/by/nobody", set()),
                            ("src/livens/multibody/model.h", {"site", "installs", "shared"}), ("tests/layout/new.py", {"controls"}), ("tests/unit/time/new.h", set())]:
            with self.subTest(path):
                self.setUp()
                self.change(path)
                self.assertEqual(self.needed()[0], words)

    def test_a_file_that_moves_away_is_a_change(self):
        run(self.folder, "git", "mv", "src/livens/time/quadrature.cpp", "src/livens/moved.cpp")
        self.assertIn("lobatto_weight", self.needed()[1])

    def test_all_is_all(self):
        self.assertEqual(self.needed("--all")[:2], (EVERYTHING - {"headers=all", "mutants=all"}, {"all"}))

    def test_without_git_or_history_everything_runs(self):
        everything = (EVERYTHING - {"headers=all", "mutants=all"}, {"all"})
        run(self.folder, "git", "checkout", "-q", "main")   # of one commit
        self.change("README.md")
        words, mutants, said = self.needed()
        self.assertEqual((words, mutants), everything)
        self.assertIn("there is no HEAD~20", said)
        for no_git in [{"PATH": os.devnull}, {"GIT_DIR": "/nowhere"}]:
            self.assertEqual(self.needed(**no_git)[:2], everything)
        (self.folder / ".git").rename(self.folder.parent / ".git")   # a folder of somebody else's repository
        self.addCleanup(lambda: (self.folder.parent / ".git").rename(self.folder / ".git"))
        self.assertEqual(self.needed()[:2], everything)

    def test_a_branch_is_compared_with_where_it_left_main(self):
        self.commit("report/src/new.ts")
        run(self.folder, "git", "update-ref", "refs/remotes/origin/main", "HEAD")   # newer than this clone's own main
        self.addCleanup(run, self.folder, "git", "update-ref", "-d", "refs/remotes/origin/main")
        self.commit("packaging/README.md")
        self.change("tests/fuzz/mesh.cpp")
        self.assertEqual(self.needed()[:2], ({"packages", "fuzzers"}, {"none"}))

    def test_main_itself_is_compared_with_twenty_commits_ago(self):
        self.commit("README.md")
        self.commit("report/src/new.ts")
        for _ in range(19):
            self.commit()
        run(self.folder, "git", "update-ref", "refs/remotes/origin/main", "HEAD")
        self.addCleanup(run, self.folder, "git", "update-ref", "-d", "refs/remotes/origin/main")
        for how in [["-B", "branch"], ["--detach"]]:
            run(self.folder, "git", "checkout", "-q", *how)
            self.assertEqual(self.needed()[:2], ({"browser"}, {"none"}))
        self.assertEqual(self.needed(LIVENS_BASE="HEAD~21")[0], {"browser", "site"})
        words, mutants, said = self.needed(LIVENS_BASE="HEAD")
        self.assertEqual((words, mutants), (set(), {"none"}))
        self.assertEqual(said.count("LEFT OUT"), len(EVERYTHING), said)   # each says so

    def test_a_base_that_is_none_is_refused(self):
        ran = run(self.folder, sys.executable, "-B", "scripts/needs", LIVENS_BASE="nonsense")
        self.assertNotEqual(ran.returncode, 0)
        self.assertEqual(ran.stdout, "")

    def test_what_is_named_is_there(self):
        # A folder that moved would select nothing for ever, in silence.
        names = {}
        exec(compile((ROOT / "scripts/needs").read_text(), "needs", "exec"), names)   # pylint: disable=exec-used
        for what, paths in names["SELDOM"].values():
            for path in paths:
                self.assertTrue((ROOT / path).exists(), f"{what}: {path}")
        text = (ROOT / "tests/mutants/faults.cmake").read_text()
        faults = names["faults"](text)
        self.assertEqual(len(faults), text.count("livens_mutant(NAME"))
        os.chdir(ROOT)
        for name, (_, file, again, program, tests) in faults.items():
            sources = names["test_sources"](program, tests)
            self.assertLessEqual(len(sources), len(tests), f"{name}: {tests} are not all there")
            mutated = [path if path.startswith("apps/") else f"src/livens/{path}" for path in [file, *again]]
            for source in [*mutated, *sources]:
                self.assertTrue((ROOT / source).exists(), f"{name}: {source}")


if __name__ == "__main__":
    if shutil.which("git") is None:
        print("SKIPPED: no git")
        sys.exit(77)
    unittest.main()
