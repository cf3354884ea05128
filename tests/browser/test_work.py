"""Tests of work against precision, matched errors, signals and heat maps: what is drawn and set is what study.json says."""

import json
import re
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
import fixture_work  # noqa: E402
from concord_report import case_tables, cases, digits, fronts, heatmaps, matched, outputs, plots, quantities, signals, tables  # noqa: E402
from concord_report.loading import Study, load_study  # noqa: E402
from test_figures import drawing, row, study  # noqa: E402


class Fixture(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = Path(folder.name) / "fixture_work"
        cls.folder.mkdir()
        data = {"name": "fixture_work", **fixture.work(cls.folder)}
        (cls.folder / "study.json").write_text(json.dumps(data))
        cls.study = load_study(cls.folder / "study.json")
        cls.cases = cases.cases_of(cls.study)
        quantities.learn(["tip_z_m"])


class Fronts(Fixture):
    def spec(self, number=0, **more):
        plot = {**self.study.data["plots"][number], **more}
        one = study(self.study.rows, self.folder, plots=[plot])
        return plot, plots.plot_specs(one, self.cases)[0][1]

    def test_points_are_those_of_the_study(self):
        plot, spec = self.spec()
        for curve, told in zip(spec["curves"], plot["curves"], strict=True):
            self.assertEqual((curve["x"], curve["y"]), ([p["time"] for p in told["points"]], [p["error"] for p in told["points"]]))
            self.assertEqual(curve["high"], [p["error_max"] for p in told["points"]])
            self.assertEqual(curve["right"], [p["wall_s_quartiles"][1] for p in told["points"]])
        self.assertEqual(spec["scales"], ["log", "log"])
        self.assertEqual(spec["curves"][0]["label"], "Delaunay ξ 1")  # of one scene: not said

    def test_front_is_that_of_the_study_and_no_point_beats_it(self):
        plot, spec = self.spec()
        self.assertEqual(spec["front"], [(plot["curves"][c]["points"][p]["time"], plot["curves"][c]["points"][p]["error"])
                                         for c, p in plot["front"]])
        everything = [(x, y) for c in spec["curves"] for x, y in zip(c["x"], c["y"])]
        for time, error in spec["front"]:
            self.assertFalse(any(x < time and y < error for x, y in everything))
        self.assertIn("FEM Q2 at resolution 8", spec["alt"])

    def test_drawing_has_a_ring_a_front_point_and_a_text_a_run(self):
        plot, spec = self.spec()
        root = ET.fromstring(drawing(spec))
        told = [t.text for t in root.iter("title")]
        self.assertEqual(len(told), sum(len(c["points"]) for c in plot["curves"]))
        self.assertIn("Delaunay ξ 1\nresolution 2, h = 0.5 m\n27 particles, 81 unknowns\n"
                      "relative L2 error of displacement 0.125 (0.113 to 0.138, 3 seeds)\n"
                      "run time 1.9 ms (quartiles 1.8 ms to 2.0 ms of 5)\nset-up 384 µs\nmemory 0.0270 MB\n"
                      "on the Pareto front", told)
        rings, = re.findall(r'<g class="rings">(.*?)</g>', drawing(spec), re.S)
        self.assertEqual(rings.count("<use "), len(plot["front"]))

    def test_runs_that_do_not_balance_and_scalar_finite_elements_are_told(self):
        _, spec = self.spec()
        self.assertIn("⊗", spec["note"])
        self.assertEqual(spec["note"].count("scalar"), 1)
        self.assertEqual(self.spec(note="FEM: scalar kernels.")[1]["note"].count("scalar"), 1)
        self.assertEqual([c["broken"] for c in spec["curves"] if c["method"] == "tlsph"], [[True, False, False, False]])

    def test_set_up_counts_where_the_study_says_so(self):
        self.assertTrue(self.spec(time="total")[1]["xlabel"].startswith("set-up and run time [s]"))

    def test_cases_without_points_are_left_out(self):
        plot = self.study.data["plots"][0]
        gone = {"points": [], "absent": [{"resolution": 2, "reason": "det F <= 0"}]}
        curves = [{**c, **gone} if c["method"] == "delaunay" else c for c in plot["curves"]]
        _, spec = self.spec(curves=curves, front=[[4, 3]])
        self.assertEqual([c["method"] for c in spec["curves"]], ["tlsph", "fem", "fem"])
        self.assertEqual(spec["front"], [(plot["curves"][4]["points"][3]["time"], plot["curves"][4]["points"][3]["error"])])
        self.assertIn("Not drawn: Delaunay ξ 1 at resolution 2, Delaunay ξ 0 at resolution 2 (det F <= 0).", spec["note"])
        self.assertIn("no run", self.spec(curves=[], front=[])[1])


class Matched(Fixture):
    def setUp(self):
        self.table, = matched.tables_of(self.study, self.cases)
        self.told = self.study.data["matched"][0]["cases"]

    def test_numbers_are_those_of_the_study(self):
        self.assertEqual(self.table["levels"], ["10\u202f%", "3\u202f%", "1\u202f%", "0.3\u202f%"])
        for line, case in zip(self.table["lines"], self.told, strict=True):
            for cell, at in zip(line["cells"], case["at"], strict=True):
                self.assertEqual((cell["value"], cell["fastest"]), (at.get("time"), bool(at.get("fastest"))))
        cell = self.table["lines"][0]["cells"][0]
        self.assertEqual((cell["text"], cell["below"]), (digits.duration(self.told[0]["at"][0]["time"]), "0.035 MB, N = 2.24"))

    def test_one_is_fastest_in_each_scene_and_level(self):
        for scene in ("cube", "beam"):
            lines = [l for l in self.table["lines"] if f"{scene} fixture" in l["label"]]
            for k in range(4):
                known = [l["cells"][k] for l in lines if l["cells"][k]["value"] is not None]
                self.assertEqual([c["fastest"] for c in known], [c["value"] == min(d["value"] for d in known) for c in known])

    def test_what_is_not_reached_has_no_time(self):
        cell = self.table["lines"][1]["cells"][3]
        self.assertEqual((cell["text"], cell["value"], cell["kind"]), ("not reached", None, "not"))
        self.assertEqual(cell["below"], f"best 0.82\u202f% in {digits.duration(self.told[1]['at'][3]['finest_time'])}")

    def test_the_coarsest_is_an_upper_bound_and_open_balances_are_marked(self):
        self.assertTrue(self.table["lines"][-1]["cells"][0]["text"].startswith("≤ "))
        self.assertTrue(self.table["lines"][2]["cells"][0]["broken"])
        self.assertIn("⊗", self.table["lines"][2]["cells"][0]["below"])
        self.assertIn("does not close", self.table["note"])

    def test_sentences_name_cases_and_times_as_the_table_does(self):
        self.assertEqual(self.table["sentences"], [
            "cube fixture, 1\u202f%: Delaunay ξ 1 is the fastest with 3.05 ms; TLSPH takes 4.1 times as long."])

    def test_no_value_says_why(self):
        cell = matched._cell({"at": [{"level": 0.1, "status": "no value", "reason": "every run failed"}]}, 0.1)
        self.assertEqual((cell["text"], cell["below"], cell["value"]), ("–", "every run failed", None))


class Signals(Fixture):
    def test_values_and_signed_errors_stand_side_by_side(self):
        made = signals.signals_table(self.cases)
        labels = [c["label"] for c in made["columns"]]
        self.assertEqual(labels[2:6], ["tip, first peak [m]", "its error [%]", "tip, first peak time [s]", "its error [%]"])
        rows = [r for r in self.study.rows if r.get("signals")]
        for line, told in zip(made["rows"], rows, strict=True):
            self.assertEqual(line[2]["value"], told["signals"]["tip"].get("first_peak"))
            for cell, name in ((line[3], "tip_peak"), (line[5], "tip_peak_time")):
                error = told["errors"].get(name)
                self.assertEqual(cell["value"], error if error is None else 100 * error)
        self.assertEqual([line[3]["text"] for line in made["rows"][:3]], ["−5.00", "−1.25", "−0.312"])
        self.assertEqual(made["rows"][6][3]["text"], "+20.0")
        self.assertIn("no first peak: it never turns", made["note"])
        self.assertIn("fem (Q2), resolution 4", made["note"])

    def test_of_several_seeds_the_farthest_counts_with_its_sign(self):
        rows = [row("delaunay", "", None, seed=k, errors={"p": e}, error_sources={"p": {}}) for k, e in ((1, 0.01), (2, -0.03))]
        made = signals.signals_table(cases.cases_of(study(rows)))
        self.assertEqual(made["rows"][0][-1]["text"], "−3.00")

    def test_per_cent(self):
        self.assertEqual([signals.per_cent(v) for v in (0.0125, -4e-4, 1e-9, None)], ["+1.25", "−0.040", "0.000", "–"])
        self.assertEqual(signals.per_cent(0.5, signed=False), "50.0")

    def test_no_table_without_signals(self):
        self.assertIsNone(signals.signals_table(cases.cases_of(study([row("fem", "", 1.0)]))))


class ChosenCases(unittest.TestCase):
    def setUp(self):
        cell = lambda value, runs=1, **more: {"value": value, "runs": runs, **more}  # noqa: E731
        entry = {"title": "Choices", "note": "One at a time.",
                 "columns": [{"label": "arrival", "unit": "us", "digits": 4}, {"label": "change", "unit": "us", "digits": 2, "difference": True}],
                 "rows": [{"label": "base", "source_value": "102 µs", "cells": [cell(100.25, 5), cell(None, 0)]},
                          {"label": "slit", "cells": [cell(131.5), cell(31.25)]},
                          {"label": "slides", "cells": [cell(97.0), cell(-3.25, balance="does not close")]}]}
        one = Study("s", Path("."), {"name": "s", "tables": [entry, {"title": "Empty", "columns": [{"label": "x"}],
                                                                             "rows": [{"label": "a", "cells": [cell(None, 0)]}]}]})
        self.table, self.empty = case_tables.tables_of(one)

    def test_a_line_a_case_with_signs_on_differences(self):
        self.assertEqual([c["label"] for c in self.table["columns"]], ["", "source", "arrival [µs]", "change [µs]", "runs"])
        texts = [[cell["text"].strip("\u2007\u2008") for cell in row] for row in self.table["rows"]]
        self.assertEqual(texts[0], ["base", "102 µs", "100.2", digits.DASH, "5"])
        self.assertEqual(texts[1][3], "+31")
        self.assertEqual(texts[2][3], "\u22123.2")

    def test_notes_tell_runs_that_do_not_balance_and_empty_columns_go(self):
        self.assertTrue(self.table["note"].startswith("One at a time. "))
        self.assertGreater(len(self.table["note"]), 20)
        self.assertEqual([c["label"] for c in self.empty["columns"]], [""])



class Heatmaps(Fixture):
    def setUp(self):
        self.map, = heatmaps.maps_of(self.study, "here", self.folder.parent)
        self.told = self.study.data["heatmap"][0]

    def test_cells_have_their_number_score_evidence_and_command(self):
        for line, row_ in zip(self.map["rows"], self.told["rows"], strict=True):
            for cell, told in zip(line["cells"], row_["cells"], strict=True):
                self.assertEqual(cell["text"], digits.pretty(told["value"], row_["digits"]))
                self.assertEqual(cell["reason"], told["reason"])
                self.assertEqual(cell["look"] and cell["look"]["words"], told["score"] is not None and f"score {told['score']:.2f}" or None)
                self.assertEqual(cell["command"], told.get("command", ""))
                self.assertEqual(cell["link"], f"fixture_work/{told['run']}" if told.get("run") else "")

    def test_a_cell_without_a_number_says_why_and_has_no_colour(self):
        cell = self.map["rows"][2]["cells"][3]
        self.assertEqual((cell["text"], cell["look"]), ("–", None))
        self.assertIn("11 hours", cell["reason"])
        self.assertEqual((self.map["missing"], self.map["count"]), (2, 20))

    def test_evidence_that_is_gone_is_no_link(self):
        self.assertEqual(heatmaps._link(self.study, "runs/gone", self.folder), "")

    def test_scale_in_words(self):
        self.assertEqual([r["scale"] for r in self.map["rows"][:4]],
                         ["good ≥ 1, bad ≤ 0.5", "good ≤ 0, bad ≥ 6", "good ≤ 10⁻⁹, bad ≥ 0.001", "good ≥ 80\u202f%, bad ≤ 20\u202f%"])

    def test_a_disc_is_as_full_as_the_score(self):
        self.assertEqual([heatmaps._look(s)["step"] for s in (0, 0.5, 1)], [0, 5, 10])
        self.assertEqual(heatmaps.pie(0), "")
        self.assertIn("A5 5 0 0 1 12.00 7.00", heatmaps.pie(0.25))
        self.assertIn("A5 5 0 1 1 2.00 7.00", heatmaps.pie(0.75))

    def test_summary_has_the_map_and_who_is_fastest(self):
        words = outputs.summary([self.study], [])
        self.assertIn("| zero modes beyond rigid | 0 | 12 | 3 | 0 |", words)
        self.assertIn("| compression [%] | 80 | 64 | 41 ⊗ | 55 |", words)
        self.assertIn("- cube_fixture, 1 %: delaunay (xi 1) is", words)


class Page(Fixture):
    def test_the_page_has_them_all(self):
        out = self.folder.parent / "out"
        subprocess.run([sys.executable, REPORTS / "make_report.py", "--studies", self.folder.parent, "--out", out,
                        "--cache", self.folder.parent / ".cache"], check=True, capture_output=True)
        html = (out / "index.html").read_text()
        for words in ('<table class="heat">', '<td class="s0">', "not reached", "Signals and their errors", "★",
                      "finite elements of this study run no million steps"):
            self.assertIn(words, html)
        cells = len(fixture_work.TESTS) * 4
        self.assertEqual(len(set(re.findall(r'href="#(fixture-work-heat0-\d-\d)"', html))), cells)
        self.assertEqual(len(re.findall(r'<dt id="fixture-work-heat0-\d-\d">', html)), cells)
        for link in re.findall(r'<a href="(\.\.[^"]+)/"', html):
            self.assertTrue((out / link).is_dir(), link)


class Balance(unittest.TestCase):
    def test_references_that_do_not_balance_are_marked(self):
        entries = [{"method": "fem", "quantity": "q", "value": 1.0, **more} for more in ({}, {"balance": "does not close"})]
        made = tables.references_table(study([], references=entries), lambda e: e["method"])
        self.assertEqual([line[-1]["badge"] for line in made["rows"]], [False, True])
        self.assertIsNone(next((c for c in tables.references_table(study([], references=entries[:1]), lambda e: "")["columns"]
                                if c["label"] == "energy balance"), None))


class Names(unittest.TestCase):
    def test_errors_of_a_study_are_called_so(self):
        before = quantities.axis("errors.tip_w")
        quantities.ERRORS.add("tip_w")
        self.addCleanup(quantities.ERRORS.discard, "tip_w")
        self.assertEqual((before, quantities.axis("errors.tip_w")), ("tip w", "error of tip w"))

    def test_probes_are_cases_of_their_own(self):
        rows = [row("fem", "Q2", 1.0), {**row("fem", "Q2", 2.0), "probe": "stable_step"}]
        found = cases.cases_of(study(rows))
        self.assertEqual([c.label for c in found], ["FEM Q2", "FEM Q2, stable step"])
        self.assertIs(fronts.case_of(found, {"scene": "s", "method": "fem", "variant": "Q2"}), found[0])
        self.assertEqual(cases.chosen(found, {"probe": "stable_step"}), [found[1]])


if __name__ == "__main__":
    unittest.main()
