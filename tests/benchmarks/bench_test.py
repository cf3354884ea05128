"""concord bench FILTER: the triad runs first beside what is asked for, and a filter that matches nothing is bad input.

bench_test.py PROGRAM
"""

import os
import re
import subprocess
import sys
import unittest
from pathlib import Path

PROGRAM = sys.argv.pop(1)
TOP = Path(__file__).resolve().parents[2]


def bench(*arguments):
    environment = dict(os.environ, CONCORD_HOME=str(TOP), OPENBLAS_NUM_THREADS="1", BENCHMARK_MIN_TIME="0.01")
    return subprocess.run([PROGRAM, "bench", *arguments], capture_output=True, text=True, env=environment)


class Bench(unittest.TestCase):
    def test_triad_first(self):
        run = bench("^plane/elastic$")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual(re.findall(r"^(\S+) +[\d.]+ [mun]s", run.stdout, re.M), ["triad", "plane/elastic"])
        self.assertRegex(run.stdout, r"triad .*GB_s=")

    def test_filters_that_match_nothing(self):
        for filter in ("nonsense", "(", "it's"):
            run = bench(filter)
            self.assertEqual(run.returncode, 2)
            self.assertIn(f"FILTER: found {filter}; allowed:", run.stderr)
            self.assertIn("delaunay_step", run.stderr)


if __name__ == "__main__":
    unittest.main()
