"""./concord bench --compare from end to end, on a small project in a git repository made up here."""

import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.dont_write_bytecode = True
from compare_test import PROGRAM  # noqa: E402  (the file beside this one)

TOP = Path(__file__).resolve().parents[2]
CMAKE = """cmake_minimum_required(VERSION 3.25)
project(Small NONE)
add_custom_target(concord_benchmarks COMMAND ${CMAKE_COMMAND} -E copy ${CMAKE_SOURCE_DIR}/program
                  ${CMAKE_BINARY_DIR}/bin/concord_benchmarks)
"""


class Launcher(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)
        for name in ("concord", "packages.txt", "CMakePresets.json", ".gitignore", "tests/benchmarks/compare.py"):
            (self.folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(TOP / name, self.folder / name)
        (self.folder / "CMakeLists.txt").write_text(CMAKE)
        self.program({"kernel": 2.0})

    def program(self, times):
        path = self.folder / "program"
        path.write_text(PROGRAM % (str(times).replace("'", '"'), False))
        path.chmod(0o755)

    def git(self, *arguments):
        identity = {f"GIT_{who}_{what}": "test@example.org" for who in ("AUTHOR", "COMMITTER") for what in ("NAME", "EMAIL")}
        subprocess.run(["git", "-C", str(self.folder), *arguments], check=True, capture_output=True, env={**os.environ, **identity})

    def commit(self):
        if not (self.folder / ".git").exists():
            self.git("init", "-q")
        self.git("add", "-A")
        self.git("commit", "-q", "-m", "state")

    def compare(self, *arguments):
        environment = {key: value for key, value in os.environ.items() if not key.startswith("GIT_")}
        environment.update(CONCORD_SKIP_PACKAGES="1", GIT_CEILING_DIRECTORIES=str(self.folder.parent))
        run = subprocess.run([str(self.folder / "concord"), "bench", "--compare", *arguments], capture_output=True, text=True,
                             env=environment)
        return run.returncode, run.stdout, run.stderr

    def test_every_command_of_the_usage_text_is_known(self):
        def launcher(*arguments):
            return subprocess.run([str(self.folder / "concord"), *arguments], capture_output=True, text=True,
                                  env={**os.environ, "CONCORD_SKIP_PACKAGES": "1"})
        commands = set(re.findall(r"^  \./concord (\w+)", launcher("help").stdout, re.MULTILINE))
        self.assertGreaterEqual(commands, {"report", "test", "run", "probe", "study", "bench", "list", "describe"})
        allowed = launcher("nonsense").stderr
        self.assertIn('found "nonsense"', allowed)
        for command in commands:
            self.assertIn(command, allowed)
            self.assertNotIn("command line: found", launcher(command).stderr, command)

    def test_every_source_makes_the_launcher_build(self):
        watched = re.search(r"^sources=\(([^)]*)\)", (TOP / "concord").read_text(), re.MULTILINE).group(1).split()
        for folder in ("scene", "particle", "sph_reference", "fem_reference", "studies", "tests", "cmake"):
            for path in (TOP / folder).rglob("*"):
                if path.suffix in (".cpp", ".hpp", ".inc", ".cmake") or path.name == "CMakeLists.txt":
                    name = path.relative_to(TOP).as_posix()
                    self.assertTrue(any(name == w or name.startswith(w + "/") for w in watched), name)

    def test_working_tree_against_a_revision(self):
        self.commit()
        self.program({"kernel": 1.0})
        code, printed, told = self.compare("HEAD", "--rounds", "5")
        self.assertEqual(code, 0, told)
        self.assertRegex(printed, r"kernel +2 us +1 us +0\.500 .* faster")
        self.assertIn("with uncommitted changes", told)
        self.assertTrue(list((self.folder / "build/compare").glob("*.json")))
        self.assertEqual(self.compare("HEAD", "--rounds", "5")[0], 0)  # the checkout is there already

    def test_bad_revisions(self):
        self.commit()
        for arguments, found in (((), '""'), (("nonsense",), '"nonsense"'), (("--rounds", "5"), '"--rounds"')):
            code, _, told = self.compare(*arguments)
            self.assertEqual(code, 2)
            self.assertIn(f"found {found}; allowed:", told)

    def test_no_repository(self):
        code, _, told = self.compare("HEAD")
        self.assertEqual(code, 2)
        self.assertIn("no git checkout", told)

    def test_revision_that_does_not_build(self):
        (self.folder / "CMakeLists.txt").write_text("message(FATAL_ERROR \"no such thing\")\n")
        self.commit()
        (self.folder / "CMakeLists.txt").write_text(CMAKE)
        code, _, told = self.compare("HEAD")
        self.assertEqual(code, 2)
        self.assertIn("no such thing", told)
        self.assertIn("build/compare/", told)

    def test_checkout_that_was_changed(self):
        self.commit()
        self.assertEqual(self.compare("HEAD", "--rounds", "5")[0], 0)
        tree = next(path for path in (self.folder / "build/compare").iterdir() if path.is_dir())
        (tree / "program").write_text("changed")
        code, _, told = self.compare("HEAD", "--rounds", "5")
        self.assertEqual(code, 2)
        self.assertIn("has been changed", told)

    def test_filter_that_matches_nothing(self):
        self.commit()
        code, _, told = self.compare("HEAD", "nothing like it")
        self.assertEqual(code, 2)
        self.assertIn("matches no benchmark", told)


if __name__ == "__main__":
    unittest.main()
