"""Statistics, reading and messages of compare.py, on programs made up here."""

import json
import random
import stat
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.dont_write_bytecode = True
import compare  # noqa: E402  (the script beside this one)

# A benchmark program in place of a real one: times from its own file, names from --benchmark_list_tests.
PROGRAM = """#!/usr/bin/python3
import json, re, sys
times = json.loads(%r)
wanted = next(a.split("=", 1)[1] for a in sys.argv if a.startswith("--benchmark_filter="))
names = [n for n in times if (re.search(wanted[1:], n) is None if wanted[0] == "-" else re.search(wanted, n))]
if "--benchmark_list_tests=true" in sys.argv:
    print("\\n".join(names))
elif %r:
    sys.exit("it broke")
else:
    entry = lambda n: {"name": n, "run_name": n, "run_type": "iteration", "cpu_time": times[n], "real_time": 7, "time_unit": "us"}
    print(json.dumps({"benchmarks": [entry(n) for n in names for _ in range(3)]}))
"""


def rounds_of(true_ratio, scatter, count, generator):
    """Ratios of rounds with normally distributed logarithms."""
    return [true_ratio * 2 ** generator.gauss(0, scatter) for _ in range(count)]


class Statistics(unittest.TestCase):
    def test_interval_holds_the_truth_as_often_as_it_says(self):
        generator = random.Random(7)
        hits = 0
        for _ in range(300):
            _, low, high = compare.interval(rounds_of(1.03, 0.02, 10, generator), resamples=400)
            hits += low <= 1.03 <= high
        # Bootstrap intervals of a median of ten cover 90 to 97 %; three standard deviations of 300 trials are 5 %.
        self.assertGreater(hits / 300, 0.86)
        self.assertLess(hits / 300, 1.0)

    def test_difference_of_five_percent_in_one_percent_noise(self):
        ratio, low, high = compare.interval(rounds_of(1.05, 0.01, 10, random.Random(3)))
        self.assertAlmostEqual(ratio, 1.05, delta=0.01)
        self.assertEqual(compare.verdict(low, high), "slower")
        _, low, high = compare.interval(rounds_of(0.95, 0.01, 10, random.Random(4)))
        self.assertEqual(compare.verdict(low, high), "faster")

    def test_no_difference(self):
        _, low, high = compare.interval(rounds_of(1.0, 0.01, 10, random.Random(5)))
        self.assertEqual(compare.verdict(low, high), "no difference seen")

    def test_same_rounds_same_answer(self):
        rounds = rounds_of(1.1, 0.05, 10, random.Random(6))
        self.assertEqual(compare.interval(rounds), compare.interval(rounds))

    def test_rounds_are_paired(self):
        # Both slow down threefold half way: each round's ratio is untouched.
        speed = [1, 1, 1, 1, 1, 3, 3, 3, 3, 3]
        row = compare.summarise([({"x": 10.0 * s}, {"x": 11.0 * s}) for s in speed])[0]
        self.assertAlmostEqual(row["ratio"], 1.1)
        self.assertAlmostEqual(row["low"], 1.1)
        self.assertAlmostEqual(row["high"], 1.1)
        self.assertEqual(row["verdict"], "slower")


class Reading(unittest.TestCase):
    def entry(self, **given):
        return {"run_type": "iteration", "name": "x", "run_name": "x", "cpu_time": 1.0, "real_time": 5.0, "time_unit": "ms", **given}

    def read(self, *entries):
        return compare.read_times(json.dumps({"benchmarks": list(entries)}))

    def test_median_of_cpu_times_in_nanoseconds_without_aggregates(self):
        times = self.read(self.entry(cpu_time=3.0), self.entry(cpu_time=1.0), self.entry(cpu_time=2.0),
                          self.entry(run_type="aggregate", cpu_time=99.0))
        self.assertEqual(times, {"x": 2e6})

    def test_wall_time_of_several_threads(self):
        self.assertEqual(self.read(self.entry(run_name="s/threads:2")), {"s/threads:2": 5e6})
        self.assertEqual(self.read(self.entry(run_name="s/real_time")), {"s/real_time": 5e6})
        self.assertEqual(self.read(self.entry(run_name="s/threads:1")), {"s/threads:1": 1e6})

    def test_benchmark_that_failed(self):
        with self.assertRaises(compare.BrokenRun):
            self.read(self.entry(error_occurred=True, error_message="no scene"))


class WholeProgram(unittest.TestCase):
    def compare(self, old, new, *options, broken=False):
        """(exit code, stdout, stderr, JSON or None) of a comparison of two made-up programs."""
        with tempfile.TemporaryDirectory() as folder:
            out = Path(folder) / "out.json"
            command = ["/usr/bin/python3", str(Path(__file__).parent / "compare.py"), "--out", str(out)]
            for side, times in (("old", old), ("new", new)):
                program = Path(folder) / side
                program.write_text(PROGRAM % (json.dumps(times), broken))
                program.chmod(program.stat().st_mode | stat.S_IXUSR)
                command += [f"--{side}", f"the {side} one", str(program), folder]
            run = subprocess.run([*command, "--rounds", "5", *options], capture_output=True, text=True)
            return run.returncode, run.stdout, run.stderr, json.loads(out.read_text()) if out.exists() else None

    def test_table_and_file(self):
        code, printed, _, written = self.compare({"a": 1.0, "gone": 1.0}, {"a": 2.0, "added": 1.0})
        self.assertEqual(code, 0)
        self.assertRegex(printed, r"a +1 us +2 us +2\.000 +2\.000 to 2\.000 +slower")
        self.assertIn("only in the old one: gone", printed)
        self.assertIn("only in the new one: added", printed)
        self.assertEqual([(row["name"], row["ratio"]) for row in written["rows"]], [("a", 2.0)])

    def test_filter(self):
        _, _, _, written = self.compare({"a": 1.0, "b": 1.0}, {"a": 1.0, "b": 1.0}, "b")
        self.assertEqual([row["name"] for row in written["rows"]], ["b"])
        _, _, _, written = self.compare({"a/edge:17": 1.0, "a/edge:100": 1.0, "setup": 1.0}, {"a/edge:17": 1.0, "a/edge:100": 1.0, "setup": 1.0})
        self.assertEqual([row["name"] for row in written["rows"]], ["a/edge:17"])

    def test_nothing_in_common(self):
        code, _, told, written = self.compare({"a": 1.0}, {"b": 1.0}, "a")
        self.assertEqual((code, written), (2, None))
        self.assertIn("matches no benchmark that both", told)

    def test_program_that_fails(self):
        code, _, told, written = self.compare({"a": 1.0}, {"a": 1.0}, broken=True)
        self.assertEqual((code, written), (3, None))
        self.assertIn("it broke", told)

    def test_bad_options(self):
        for option, value in (("--rounds", "2"), ("--rounds", "many"), ("--repeats", "0"), ("--seconds", "-1")):
            code, _, told, _ = self.compare({"a": 1.0}, {"a": 1.0}, option, value)
            self.assertEqual(code, 2)
            self.assertIn(option, told)


if __name__ == "__main__":
    unittest.main()
