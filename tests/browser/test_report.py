"""Tests of the report's Python modules on fixture data (fixture.py) and on small inputs by hand."""

import json
import math
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ET
from pathlib import Path

sys.dont_write_bytecode = True
HERE = Path(__file__).resolve().parent
REPORTS = HERE.parent.parent / "reports"
sys.path[:0] = [str(HERE), str(REPORTS)]

import fixture  # noqa: E402  (needs the paths above)
from concord_report import (cases, claims, digits, draw_labels, frames, histories, outputs,  # noqa: E402
                            pictures, plots, quantities, tables)
from concord_report.loading import InputError, Study, load_studies, number, study_verdict  # noqa: E402


def study(rows=(), **more):
    data = {"name": "by_hand", "rows": list(rows), **more}
    return Study("by_hand", Path("."), data, data.get("claims") or [], data["rows"])


def run(folder, *more):
    command = [sys.executable, str(REPORTS / "make_report.py"), "--studies", str(folder), *map(str, more)]
    return subprocess.run(command, capture_output=True, text=True, check=False)


class Numbers(unittest.TestCase):
    def test_significant_digits(self):
        self.assertEqual(digits.pretty(0.0022304), "2.23×10⁻³")
        self.assertEqual(digits.pretty(123456.0), "1.23×10⁵")
        self.assertEqual(digits.pretty(2.0), "2.00")
        self.assertEqual(digits.pretty(2), "2")
        self.assertEqual(digits.pretty(-0.5), "−0.500")
        self.assertEqual(digits.text(8.4e-16), "8.40e−16")

    def test_missing_is_a_dash_and_never_zero(self):
        for value in (None, math.nan, math.inf, "text", True):
            self.assertIsNone(number(value))
            self.assertEqual(digits.pretty(value), "–")
        self.assertEqual(digits.column([None, 0.0, 1e-9])[0], "–")
        self.assertEqual(digits.column([None, 0.0, 1e-9])[1], "0")

    def test_columns_line_up(self):
        texts = digits.exact_column([0.25, 0.125, 0.0625])
        self.assertEqual([t.rstrip("\u2007") for t in texts], ["0.25", "0.125", "0.0625"])
        ends = {len(t) - t.index(".") for t in texts}
        self.assertEqual(len(ends), 1)
        self.assertEqual(digits.column([14739, 375]), ["14\u202f739", "375"])

    def test_chosen_values_have_no_trailing_zeros(self):
        self.assertEqual([digits.exact(v) for v in (0.25, 1000.0, 1e-6, 2.5e7)],
                         ["0.25", "1000", "10⁻⁶", "2.5×10⁷"])

    def test_units_of_quantities_come_from_histories(self):
        quantities.learn(["t_s", "made_up_force_N"])
        self.assertEqual(quantities.axis("quantities.made_up_force"), "made up force [N]")
        self.assertEqual(quantities.axis("errors.made_up_force"), "made up force")
        self.assertEqual(quantities.axis("tip_z_m"), "tip z [m]")

    def test_units_get_prefixes(self):
        factor, unit = digits.engineering(2.6e4, "Pa")
        self.assertEqual((26, "kPa"), (round(2.6e4 * factor), unit))


class Claims(unittest.TestCase):
    def claim(self, **more):
        return {"id": "a", "statement": "A", "verdict": "pass", **more}

    def test_bounds_in_every_form(self):
        expected = {"<= 1e-10 N": "≤\u00a010⁻¹⁰ N", ">= 1.8 and <= 2.6": "1.8 to 2.6", "": "–"}
        for bound, text in expected.items():
            self.assertEqual(claims.bound_text(self.claim(bound=bound)), text)
        self.assertEqual(claims.bound_text(self.claim(bound={"min": 1.8, "max": None})), "≥\u00a01.8")
        self.assertEqual(claims.bound_text(self.claim(bound=[0.1, 0.2], unit="mm")), "0.1 to 0.2 mm")

    def test_rounding_never_moves_a_value_over_its_bound(self):
        text = claims.measured_text(self.claim(measured=1.7999, bound=">= 1.8", verdict="fail"))
        self.assertLess(float(text), 1.8)
        self.assertEqual(claims.measured_text(self.claim(measured=1.7512, bound=">= 1.8")), "1.75")

    def test_as_many_digits_as_the_source(self):
        found = claims.measured_text(self.claim(measured=14.7254, source_value="14.74 mm", bound="", unit="mm"))
        self.assertEqual(found, "14.73\u00a0mm")

    def test_failed_claim_outweighs_the_studys_word(self):
        painted = study(verdict="pass", claims=[self.claim(verdict="fail")])
        self.assertEqual(study_verdict(painted), "fail")
        self.assertEqual(study_verdict(study(claims=[self.claim(verdict="full report only")])), "open")


class Cases(unittest.TestCase):
    def row(self, n, seed, value, **more):
        return {"scene": "s", "method": "delaunay", "variant": "xi 1", "resolution": n, "h": 1 / n,
                "seed": seed, "errors": {"e": value}, **more}

    def test_levels_means_spread_and_local_order(self):
        rows = [self.row(8, 1, 0.01), self.row(4, 1, 0.05), self.row(4, 2, 0.03), self.row(8, 2, 0.01)]
        case, = cases.cases_of(study(rows))
        self.assertEqual([l.resolution for l in case.levels], [4, 8])
        self.assertAlmostEqual(case.levels[0].mean("errors.e"), 0.04)
        self.assertEqual(case.levels[0].spread("errors.e"), (0.03, 0.05))
        orders = cases.local_orders(case, "errors.e", "errors.e")
        self.assertIsNone(orders[0])
        self.assertAlmostEqual(orders[1], 2.0)

    def test_failed_run_gives_no_value(self):
        rows = [self.row(4, 1, 0.05), self.row(4, 2, 9.9, error="diverged in step 3")]
        case, = cases.cases_of(study(rows))
        self.assertEqual(case.levels[0].values("errors.e"), [0.05])

    def test_costs_are_shown_of_timed_studies_only(self):
        rows = [self.row(4, 1, 0.05, wall_s=1.0, setup_s=0.5), self.row(8, 1, 0.01, wall_s=2.0, setup_s=0.5)]
        for timing in (True, False):
            one = study(rows, timing=timing)
            found = cases.cases_of(one)
            made = [tables.convergence_table(one, found, "errors.e"), tables.runs_table(one, found)]
            for table in made:
                self.assertEqual("run time [s]" in [c["label"] for c in table["columns"]], timing)

    def test_table_leaves_out_empty_columns_and_marks_missing(self):
        rows = [self.row(4, 1, 0.05, wall_s=1.0), self.row(8, 1, None)]
        one = study(rows, fits=[{"method": "delaunay", "variant": "xi 1", "quantity": "errors.e", "slope": 2.0}])
        table = tables.convergence_table(one, cases.cases_of(one), "errors.e")
        labels = [c["label"] for c in table["columns"]]
        self.assertNotIn("unknowns", labels)
        self.assertNotIn("seeds", labels)
        errors = [row[labels.index("error")] for row in table["rows"]]
        self.assertEqual((errors[0]["value"], errors[1]["value"], errors[1]["text"]), (0.05, None, "–"))
        self.assertEqual(table["rows"][1][labels.index("fitted order")]["text"], "2.00")

    def test_scenes_set_cases_apart(self):
        other = {**self.row(4, 1, 0.1), "scene": "t"}
        found = cases.cases_of(study([self.row(4, 1, 0.2), other]))
        self.assertEqual([c.label for c in found], ["Delaunay ξ 1, s", "Delaunay ξ 1, t"])


class Plots(unittest.TestCase):
    def rows(self):
        return [{"scene": "s", "method": m, "variant": "", "resolution": n, "h": 1 / n, "seed": 1,
                 "wall_s": n / 10, "errors": {"e": 1 / n ** p}} for m, p in (("fem", 2), ("tlsph", 1))
                for n in (4, 8, 16)]

    def spec(self, kind, **more):
        fits = [{"method": "fem", "variant": "", "quantity": "errors.e", "slope": 2.0004},
                {"method": "tlsph", "variant": "", "quantity": "errors.e", "slope": 0.98}]
        one = study(self.rows(), fits=fits, plots=[{"kind": kind, "quantity": "errors.e", **more}])
        return plots.plot_specs(one, cases.cases_of(one))[0][1]

    def test_slope_triangles_and_labels_follow_the_fits(self):
        spec = self.spec("convergence")
        self.assertEqual(spec["triangles"], [1.0, 2.0])
        self.assertIn("FEM 2.00; TLSPH 0.980", spec["alt"])
        self.assertEqual(self.spec("convergence", slope=3)["triangles"], [3.0])

    def test_drawing_is_stable_labelled_and_its_own(self):
        from concord_report import draw
        spec = {**self.spec("convergence"), "ident": "here", "labelled": True}
        once, again = draw.draw(spec), draw.draw(spec)
        self.assertEqual(once, again)
        drawing = ET.fromstring(once)
        self.assertEqual(drawing.get("role"), "img")
        self.assertIn("Fitted orders", drawing.get("aria-label"))
        self.assertIn("FEM (2.00)", once)
        self.assertTrue(all(e.get("id").startswith("here-") for e in drawing.iter() if e.get("id")))
        self.assertNotIn("DejaVu", once)

    def test_cost_plot_gives_no_orders(self):
        self.assertTrue(all(c["slope"] is None for c in self.spec("cost")["curves"]))

    def test_unknown_kind_and_missing_quantity_are_told(self):
        self.assertIn("unknown", self.spec("pie"))
        self.assertIn("no run", plots.convergence(study(self.rows()), [], {"quantity": "errors.none"}))

    def test_setting_of_a_sweep(self):
        self.assertEqual(plots.setting_of({"variant": "support 3, psi 0.1"}, "tlsph.psi"), (0.1, ""))
        self.assertEqual(plots.setting_of({"variant": "U 0.5 mm"}, "parameters.U"), (0.5, "mm"))
        self.assertEqual(plots.setting_of({"settings": {"psi": "0.3"}}, "psi"), (0.3, ""))
        self.assertIsNone(plots.setting_of({"variant": "xi 1"}, "psi"))

    def test_labels_do_not_overlap(self):
        places = draw_labels.spread([10, 10, 11, 50, 99], 12, 0, 100)
        ordered = sorted(places)
        self.assertTrue(all(b - a >= 12 - 1e-9 for a, b in zip(ordered, ordered[1:])))
        self.assertTrue(0 <= ordered[0] and ordered[-1] <= 100)

    def test_thinning_keeps_the_peaks(self):
        y = [math.sin(i / 7) for i in range(5000)]
        y[2345] = 7.0
        x, kept = histories.thinned(list(range(5000)), y)
        self.assertLessEqual(len(x), histories.MOST_POINTS + 2)
        self.assertEqual(max(kept), 7.0)
        self.assertEqual(x, sorted(x))


class Fields(unittest.TestCase):
    def test_colour_limits(self):
        self.assertEqual(pictures._limits(0.1, 5.0), ([0.0, 5.0], False))
        self.assertEqual(pictures._limits(-2.0, 5.0), ([-5.0, 5.0], True))
        self.assertEqual(pictures._limits(4.0, 5.0), ([4.0, 5.0], False))

    def test_frame_is_read_and_a_broken_one_refused(self):
        with tempfile.TemporaryDirectory() as folder:
            fixture.cube_frame(Path(folder) / "run", 2, True, 1e-3)
            path = Path(folder) / "run/fields_0000.hdf"
            frame = frames.read(path)
            self.assertEqual((len(frame["points"]), len(frame["types"])), (27, 8))
            self.assertEqual(len(frames.values(frame, "displacement")), 27)
            moved, reference = frames.deformed(frame, 100)
            self.assertAlmostEqual(abs(reference).max(), 1.0)
            self.assertGreater(abs(moved - reference).max(), 0.01)
            self.assertIn("von_mises", frames.facts(path, "nothing", 1)["missing"])
            path.write_bytes(path.read_bytes()[:600])
            with self.assertRaises(InputError):
                frames.read(path)


class Report(unittest.TestCase):
    """The program itself, on the fixture: files out, exit codes, repeatability."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.studies, cls.out = Path(cls.folder.name) / "studies", Path(cls.folder.name) / "out"
        fixture.write(cls.studies)
        cls.done = run(cls.studies, "--out", cls.out)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_makes_the_four_files_although_a_claim_failed(self):
        self.assertEqual(self.done.returncode, 0, self.done.stderr)
        for name in ("index.html", "summary.md", "junit.xml", "report.json"):
            self.assertTrue((self.out / name).is_file(), name)
        self.assertNotIn("failed:", self.done.stderr)  # no fallback of the pictures

    def test_page_is_self_contained_and_tells_what_is_missing(self):
        html = (self.out / "index.html").read_text()
        for outside in ('src="http', 'href="http', "@import", "url(http", "<link"):
            self.assertNotIn(outside, html)
        self.assertIn("No picture of fem Q9 16", html)
        self.assertIn("no_such_column", html)
        self.assertEqual(html.count("<img "), 42)

    def test_pictures_show_something(self):
        import base64
        import io
        import re
        from PIL import Image
        for kind, data in re.findall(r'src="data:image/(\w+);base64,([^"]+)"', (self.out / "index.html").read_text()):
            image = Image.open(io.BytesIO(base64.b64decode(data)))
            covered = sum(1 for a in image.getchannel("A").getdata() if a > 128) / (image.width * image.height)
            self.assertGreater(covered, 0.1, kind)
            self.assertGreater(len(set(image.convert("RGB").resize((40, 40)).getdata())), 50)

    def test_junit(self):
        root = ET.parse(self.out / "junit.xml").getroot()
        suites = {s.get("name"): s for s in root}
        self.assertEqual(suites["fixture_patch"].get("failures"), "1")
        failure = suites["fixture_patch"].find("testcase[@name='b']/failure")
        self.assertIn("measured 5.90×10⁻⁸", failure.get("message"))
        self.assertIsNone(suites["fixture_patch"].find("testcase[@name='a']/failure"))
        self.assertIsNotNone(suites["fixture_cube"].find("testcase[@name='later']/skipped"))
        self.assertEqual(sum(int(s.get("tests")) for s in root), 12)

    def test_summary_and_json(self):
        summary = (self.out / "summary.md").read_text()
        self.assertIn("2 of 11 claims failed", summary)
        self.assertLess(summary.index("## Failed"), summary.index("## Fixture: beam"))
        data = json.loads((self.out / "report.json").read_text())
        self.assertEqual((data["verdict"], data["claims"]), ("fail", {"pass": 9, "fail": 2, "open": 1}))
        self.assertEqual(len(data["studies"]), 7)

    def test_second_time_is_the_same(self):
        before = (self.out / "index.html").read_bytes()
        self.assertEqual(run(self.studies, "--out", self.out).returncode, 0)
        self.assertEqual((self.out / "index.html").read_bytes(), before)


class BadInput(unittest.TestCase):
    def refused(self, text, *words):
        with tempfile.TemporaryDirectory() as folder:
            here = Path(folder) / "one"
            here.mkdir()
            (here / "study.json").write_text(text)
            done = run(folder)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertNotIn("Traceback", done.stderr)
            for word in ("study.json", *words):
                self.assertIn(word, done.stderr)
            self.assertFalse((Path(folder) / "index.html").exists())

    def test_broken_study_files(self):
        self.refused('{"name": "one", "rows": [', ":1:", "not JSON")
        self.refused("[]", "expected an object")
        self.refused("{}", "'name'")
        self.refused('{"name": "one", "rows": {}}', "'rows'", "a list")
        self.refused('{"name": "one", "rows": [3]}', "rows[0]")
        self.refused('{"name": "one", "rows": [{}]}', "rows[0]", "'method'")
        self.refused('{"name": "one", "claims": [{"id": "a", "verdict": "pass"}]}', "claims[0]", "'statement'")

    def test_broken_figures(self):
        for entry, *words in (('"plots": [{"kind": "curve", "inset": {"x": [2, 1]}}]', "plots[0]", "'inset'"),
                              ('"plots": [{"kind": "sweep", "baseline": ["cbm"]}]', "'baseline'", "selection"),
                              ('"pictures": [{"range": [3, 2]}]', "'range'", '"common"'),
                              ('"pictures": [{}, {"panels": [{"crop": {"z": [0, 1]}}]}]', "pictures[1]", "'crop'")):
            self.refused(f'{{"name": "one", "rows": [], {entry}}}', *words)

    def test_nothing_to_report(self):
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(run(folder).returncode, 2)
            self.assertEqual(run(Path(folder) / "none").returncode, 2)

    def test_broken_history(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "history.csv"
            path.write_text("t_s,tip_z_m\n0,0\n1,abc\n")
            with self.assertRaises(InputError):
                histories.read_history(path, "tip_z_m")
            path.write_text("t_s,tip_z_m\n0,0\n1,2\n2")
            self.assertEqual(histories.read_history(path, "tip_z"), ([0.0, 1.0], [0.0, 2.0]))

    def test_least_study_is_enough(self):
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "one").mkdir()
            (Path(folder) / "one/study.json").write_text('{"name": "one", "rows": [{"method": "fem"}]}')
            done = run(folder)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn("No claim was judged", (Path(folder) / "index.html").read_text())
            self.assertEqual(len(load_studies(folder)[0]), 1)
            self.assertEqual(outputs.count(load_studies(folder)[0]), {"pass": 0, "fail": 0, "open": 0})


if __name__ == "__main__":
    unittest.main()
