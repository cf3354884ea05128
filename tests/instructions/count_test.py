"""The judge of the counts notices what it is for."""

import sys
import unittest

sys.dont_write_bytecode = True
import count  # noqa: E402  (the script beside this one)


def feature_counts(paid=0.0, used=1.5):
    """Counts in which everything off costs `paid` and everything on `used` times as much."""
    whole = {}
    for _, off, _, on in count.FEATURES:
        whole[on] = whole.setdefault(off, 100.0) * used
    without = {}
    for _, off, program, _ in count.FEATURES:
        without.setdefault(program, {})[off] = whole[off] / (1 + paid)
    return whole, without


class Features(unittest.TestCase):
    def test_off_and_free(self):
        self.assertTrue(count.judge_features(*feature_counts())[1])

    def test_off_and_paid_for(self):
        for paid in (0.002, -0.002):
            lines, well = count.judge_features(*feature_counts(paid=paid))
            self.assertFalse(well)
            self.assertIn("paid for", "\n".join(lines))

    def test_feature_that_is_not_there_at_all(self):
        lines, well = count.judge_features(*feature_counts(used=1.0))
        self.assertFalse(well)
        self.assertIn("sees nothing", "\n".join(lines))


class Flowing(unittest.TestCase):
    def judge(self, none, half, everything):
        return count.judge_flowing({case: value for cases in count.FLOWING for case, value in zip(cases, (none, half, everything))})

    def test_halfway(self):
        self.assertTrue(self.judge(100.0, 150.0, 200.0)[1])

    def test_flow_that_others_pay_for(self):
        self.assertFalse(self.judge(100.0, 160.0, 200.0)[1])

    def test_flow_that_costs_nothing(self):
        self.assertFalse(self.judge(100.0, 100.0, 100.0)[1])


class Kernels(unittest.TestCase):
    def judge(self, factor):
        return count.judge_kernels({"a": 100.0, "b": 10.0}, {"a": 100.0 * factor, "b": 10.0})

    def test_rise(self):
        self.assertTrue(self.judge(1.02)[1])
        lines, well = self.judge(1.04)
        self.assertFalse(well)
        self.assertIn("count.py update", "\n".join(lines))

    def test_fall(self):
        lines, well = self.judge(0.9)
        self.assertTrue(well)
        self.assertIn("please update", "\n".join(lines))

    def test_kernels_that_came_or_went(self):
        self.assertFalse(count.judge_kernels({"a": 1.0}, {"a": 1.0, "b": 1.0})[1])
        self.assertFalse(count.judge_kernels({"a": 1.0, "b": 1.0}, {"a": 1.0})[1])


class Files(unittest.TestCase):
    def test_counts_come_back(self):
        text = count.file_text("GCC 12.2.0, AVX2", {"x": 12.25, "yz": 3000.0})
        self.assertEqual(count.read_file(text), ("GCC 12.2.0, AVX2", {"x": 12.2, "yz": 3000.0}))

    def test_steps_by_difference(self):
        printed = "compiled GCC 1\ncase x steps 4 particles 10\n"
        counts, compiled = count.read_counts(printed, {"x once": 1400, "x twice": 2200})
        self.assertEqual((counts, compiled), ({"x": 20.0}, "GCC 1"))
        with self.assertRaises(count.CannotCount):
            count.read_counts(printed, {"x once": 1400})


if __name__ == "__main__":
    unittest.main()
