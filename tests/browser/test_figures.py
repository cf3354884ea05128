"""Tests of the figures for plastic and static studies: curves, sweeps, maps, panels, balances."""

import json
import math
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ET
from pathlib import Path

sys.dont_write_bytecode = True
HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent.parent / "reports")]

import fixture  # noqa: E402  (needs the paths above)
import fixture_bar  # noqa: E402
import numpy as np  # noqa: E402
from concord_report import (balance, cache, captions, cases, draw, frames, kinds, pictures, plane_cells, plots,  # noqa: E402
                            quantities, tables)
from concord_report.loading import Study  # noqa: E402


def study(rows, folder=".", **more):
    return Study("by_hand", Path(folder), {"name": "by_hand", "rows": rows, **more}, [], rows)


def spec_of(rows, plot, folder="."):
    one = study(rows, folder, plots=[plot])
    return plots.plot_specs(one, cases.cases_of(one))[0][1]


def drawing(spec):
    return draw.draw(json.loads(json.dumps({**spec, "ident": "here", "labelled": True})))


def row(method, variant, value, **more):
    return {"scene": "s", "method": method, "variant": variant, "resolution": 10, "h": 0.1, "seed": 1, "t_end": 1.0,
            "errors": {"e": value}, **more}


class Curves(unittest.TestCase):
    def spec(self, **more):
        with tempfile.TemporaryDirectory() as folder:
            rows = []
            for n in (4, 8.0001, 16):
                run = Path(folder) / f"run{n:g}"
                run.mkdir()
                (run / "history.csv").write_text("t_s,long_m,pull_y_N\n0,0,0\n1,1e-3,5\n2,2e-3,7\n3,1.5e-3,2\n")
                rows.append(row("cbm", "", None, resolution=n, particles=int(n * n), run=run.name))
            rows.append(row("fem", "T6", None, unknowns=12345, run="nowhere"))
            plot = {"kind": "curve", "x": "long_m", "y": "pull_y", **more}
            return spec_of(rows, plot, folder)

    def test_a_line_a_run_in_the_order_of_the_history(self):
        quantities.learn(["pull_y_N"])
        spec = self.spec(x_scale=500.0, x_label="strain")
        self.assertEqual([c["label"] for c in spec["curves"]],
                         ["CBM, 256 particles", "CBM, 64 particles", "CBM, 16 particles"])
        self.assertEqual([c["rank"] for c in spec["curves"]], [0, 1, 2])
        self.assertEqual(spec["curves"][0]["x"], [0, 0.5, 1.0, 0.75])  # turns back where the load does
        self.assertEqual((spec["xlabel"], spec["ylabel"]), ("strain", "pull y [N]"))

    def test_resolutions_need_not_be_written_with_all_digits(self):
        self.assertEqual(len(self.spec(resolutions=[8])["curves"]), 1)

    def test_missing_column_is_told(self):
        self.assertIn("pull_x", self.spec(y="pull_x"))

    def test_half_an_inset_shows_what_passes(self):
        scales = {"x_scale": 500.0, "y_scale": 1}
        self.assertEqual(self.spec(**scales, inset={"x": [0.4, 1.1]})["inset"][0], [0.4, 1.1])
        low, high = self.spec(**scales, inset={"x": [0.4, 1.1]})["inset"][1]  # 2 N to 7 N and some room
        self.assertTrue(1.5 < low < 2 and 7 < high < 7.5)
        self.assertIsNone(self.spec(inset={})["inset"])
        self.assertIsNone(self.spec(inset={"x": [90, 91]})["inset"])

    def test_inset_is_drawn_once_more(self):
        plain, zoomed = (drawing(self.spec(**more)) for more in ({}, {"inset": {"x": [0, 1], "y": [4, 6]}}))
        self.assertEqual(zoomed.count('class="curve" data-case="-1"'),
                         plain.count('class="curve" data-case="-1"') + 1)


class Sweeps(unittest.TestCase):
    rows = [row("tlsph", f"support {s}, psi {p}", 0.01 * s + 0.1 * abs(math.log10(max(p, 1e-4))) , settings={"psi": p, "support": s})
            for s in (2, 3) for p in (0, 0.01, 0.1, 1)] + \
           [row("cbm", "", 0.015), row("cbm", "", 0.017, seed=2)]

    def test_baseline_is_a_line_across_with_its_spread(self):
        spec = spec_of(self.rows, {"kind": "sweep", "quantity": "errors.e", "setting": "psi", "method": "tlsph",
                                   "baseline": [{"method": "cbm", "label": "ours"}, {"method": "mpm"}], "y_scale": 100})
        line = spec["curves"][-1]
        self.assertEqual((line["label"], line["baseline"], line["x"]), ("ours", True, [0, 1]))
        for found, wanted in zip((line["y"][0], line["low"][0], line["high"][0]), (1.6, 1.5, 1.7)):
            self.assertAlmostEqual(found, wanted)
        self.assertIn("No baseline mpm", spec["note"])
        self.assertEqual([c["label"] for c in spec["curves"][:2]], ["TLSPH support 2", "TLSPH support 3"])

    def test_zero_stands_apart_on_a_log_axis(self):
        spec = spec_of(self.rows, {"kind": "sweep", "quantity": "errors.e", "setting": "psi", "method": "tlsph"})
        self.assertEqual((spec["scales"][0], spec["zero_apart"]), ("log", True))
        ticks = [t.text for t in ET.fromstring(drawing(spec)).iter("text")]
        for tick in ("0", "0.01", "0.1", "1"):
            self.assertIn(tick, ticks)

    def test_labels_lose_the_setting_and_its_comma(self):
        for label, wanted in (("TLSPH ψ 0.1, support 2", "TLSPH support 2"), ("TLSPH support 2, ψ 0.1", "TLSPH support 2"),
                              ("TLSPH a, ψ 0.1, support 2", "TLSPH a, support 2")):
            self.assertEqual(kinds.without(label, "tlsph.psi"), wanted)

    def test_cases_that_share_a_setting_are_one_point(self):
        rows = [row("tlsph", v, e, settings={"psi": 0.1}) for v, e in (("psi 0.1", 1.0), ("psi 0.10", 3.0))]
        curve, = spec_of(rows, {"kind": "sweep", "quantity": "errors.e", "setting": "psi"})["curves"]
        self.assertEqual((curve["y"], curve["low"], curve["high"]), ([2.0], [1.0], [3.0]))

    def test_map_has_its_smallest_cell_and_per_cent(self):
        plot = {"kind": "map", "quantity": "errors.e", "setting": "psi", "setting_y": "support", "method": "tlsph"}
        rows = [*self.rows, row("tlsph", "support 2, psi 10", None, settings={"psi": 10, "support": 2})]
        rows[0] = {**rows[0], "balance": "does not close"}
        spec = spec_of(rows, plot)
        one, = spec["map"]
        self.assertEqual((one["x"], one["y"], one["least"]), (["0", "0.01", "0.1", "1"], ["2", "3"], [0, 3, "2.00"]))
        self.assertIn("[%]", spec["label"])
        self.assertIn("smallest 2.00 at ψ 1, support 2", spec["alt"])
        self.assertIn(balance.SIGN, spec["note"])
        told = drawing(spec)
        self.assertEqual(told.count(balance.SIGN), 1)
        self.assertIn(">2.00<", told)

    def test_a_map_for_each_remaining_variant(self):
        rows = [row("tlsph", f"{k}, support 2, psi {p}", p, settings={"psi": p, "support": 2}) for k in ("a", "b")
                for p in (0.1, 0.2)]
        spec = spec_of(rows, {"kind": "map", "quantity": "errors.e", "setting": "psi", "setting_y": "support"})
        self.assertEqual([m["title"] for m in spec["map"]], ["TLSPH a", "TLSPH b"])


class Balance(unittest.TestCase):
    def test_only_runs_that_do_not_close_are_marked(self):
        closed, opened, without = ({"balance": "closes"}, {"balance": "does not close"}, {})
        self.assertEqual([balance.state([r]) for r in (closed, opened, without)], ["closes", "⊗ does not close", ""])
        self.assertEqual(balance.how_many([opened, closed, without]), "⊗ does not close in 1 of 3")

    def test_tables_have_a_badge_and_a_note(self):
        for mark in (None, "does not close"):
            rows = [row("cbm", "", 1.0), row("cbm", "b", 2.0, balance=mark)]
            one = study(rows)
            made = tables.runs_table(one, cases.cases_of(one))
            badges = [cell for line in made["rows"] for cell in line if cell.get("badge")]
            self.assertEqual(len(badges), 1 if mark else 0)
            self.assertEqual("does not close" in made["note"], bool(mark))
            self.assertEqual("energy balance" in [c["label"] for c in made["columns"]], bool(mark))

    def test_points_of_a_plot_are_crossed(self):
        rows = [row("cbm", "", 0.1, resolution=n, h=1 / n, balance="does not close" if n == 8 else "closes")
                for n in (4, 8)]
        spec = spec_of(rows, {"kind": "convergence", "quantity": "errors.e"})
        self.assertEqual(spec["curves"][0]["broken"], [False, True])
        self.assertIn("does not close", spec["note"])


class Ladders(unittest.TestCase):
    def test_single_levels_stand_among_the_results(self):
        rows = [row("cbm", "", 1 / n, resolution=n, h=1 / n) for n in (4, 8)] + [row("tlsph", "psi 1", 0.3)]
        one = study(rows, plots=[{"kind": "convergence", "quantity": "errors.e"}])
        one.claims.append({"id": "a", "statement": "A", "verdict": "pass", "quantity": "errors.e"})
        found = cases.cases_of(one)
        self.assertEqual(len(tables.convergence_table(one, found, "errors.e")["rows"]), 2)
        self.assertEqual(len(tables.results_table(one, found)["rows"]), 3)
        self.assertIsNone(tables.results_table(one, found[:1]))


class Words(unittest.TestCase):
    def test_differences_to_a_reference(self):
        self.assertEqual(quantities.axis("errors.plastic_strain_difference"),
                         "relative L2 difference of equivalent plastic strain")
        self.assertEqual(quantities.axis("errors.kirchhoff_mises_explicit"),
                         "relative L2 difference of equivalent Kirchhoff stress, explicit")
        self.assertEqual(quantities.field_name("kirchhoff_mises_difference"),
                         ("difference in equivalent Kirchhoff stress", "Pa"))

    def test_labels_and_factors_of_any_plot(self):
        rows = [row("cbm", "", 0.1, resolution=n, h=1 / n, wall_s=1.0) for n in (4, 8)]
        spec = spec_of(rows, {"kind": "cost", "quantity": "errors.e", "y_scale": 100, "y_label": "error [%]"})
        self.assertEqual((spec["ylabel"], spec["curves"][0]["y"]), ("error [%]", [10.0, 10.0]))

    def test_a_run_that_was_compared_with_nothing_tells_why(self):
        one = study([row("cbm", "", 1.0, comparisons={"difference": {"reason": "the reference was not run"}})])
        made = tables.runs_table(one, cases.cases_of(one))
        self.assertEqual(made["rows"][0][-1]["text"], "the reference was not run")


class Static(unittest.TestCase):
    def test_time_of_static_runs_is_the_load_parameter(self):
        static, moving = row("fem", "", 1.0), row("cbm", "", 1.0, dt=1e-8)
        self.assertEqual(kinds.time_name([static]), "load parameter t")
        self.assertEqual(kinds.time_name([moving]), "time")
        self.assertEqual(kinds.time_name([static, moving]), "load parameter t, or time")
        self.assertFalse(kinds.is_static({**static, "static": False}))


class Panels(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        fixture.write(cls.folder.name)
        where = Path(cls.folder.name) / "fixture_bar"
        data = json.loads((where / "study.json").read_text())
        cls.study = Study(data["name"], where, data, data["claims"], data["rows"])
        cls.warnings = []
        cls.jobs = pictures.prepare(cls.study, cases.cases_of(cls.study), cache.Cache(where / "cache"), cls.warnings)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_panels_share_scale_and_view(self):
        pair = self.jobs[:2]
        self.assertEqual(pair[0]["group"], pair[1]["group"])
        self.assertEqual((pair[0]["limits"], pair[0]["view"]), (pair[1]["limits"], pair[1]["view"]))
        self.assertNotEqual(pair[0]["group"], self.jobs[2]["group"])
        self.assertTrue(all(j["plane"] for j in pair))

    def test_crop_and_wanted_range(self):
        job = self.jobs[4]
        self.assertEqual(job["view"]["low"][:2], [-0.006, 0.012])
        self.assertEqual((job["limits"], job["beyond"]), ([0, 0.5], [False, True]))
        self.assertGreater(job["range"][0], 0)  # the ends of the bar, where it is 0, are not seen

    def test_difference_is_symmetric_about_zero(self):
        job = self.jobs[13]
        self.assertEqual((job["color"], job["diverging"]), ("plastic_strain_difference", True))
        self.assertEqual(job["limits"][0], -job["limits"][1])
        self.assertEqual(Path(job["path"]).name, "difference.hdf")
        self.assertIn("no difference.hdf", " ".join(self.warnings))

    def test_words(self):
        self.assertEqual(captions.ends(2.8e-8, 0.55), "0 to 0.550")
        self.assertEqual(captions.ends(-0.0161, 0.0165), "−0.0161 to 0.0165")
        self.assertEqual([captions.columns({}, n) for n in (2, 4, 6, 8, 9, 7)], [2, 4, 3, 4, 3, 4])
        self.assertEqual(pictures._limits(0.1, 0.4, [0, 1]), ([0, 1], False))
        self.assertEqual(pictures._limits(-0.1, 0.4, None, True), ([-0.4, 0.4], True))


def areas(polygons):
    x, y = polygons[..., 0], polygons[..., 1]
    return 0.5 * np.abs((x * np.roll(y, -1, axis=1) - np.roll(x, -1, axis=1) * y).sum(axis=1))


class Areas(unittest.TestCase):
    def test_shares_of_a_lattice_are_its_cells(self):
        points = np.stack(np.meshgrid(np.arange(6.0), np.arange(5.0)), -1).reshape(-1, 2)
        quads, owner, alone, rim = plane_cells.shares(points, points, 1.0)
        share = np.bincount(owner, areas(quads))
        self.assertEqual(sorted(set(share.round(9))), [0.25, 0.5, 1.0])
        self.assertEqual((len(alone), len(rim)), (0, 18))

    def test_a_notch_stays_open_and_a_lone_particle_is_told(self):
        points = np.stack(np.meshgrid(np.arange(9.0), np.arange(9.0)), -1).reshape(-1, 2)
        points = points[~((points[:, 0] > 4) & (abs(points[:, 1] - 4) < 2))]
        quads, _, alone, _ = plane_cells.shares(np.vstack([points, [20, 20]]), np.vstack([points, [20, 20]]), 1.0)
        self.assertAlmostEqual(areas(quads).sum(), 64 - 4 * 4 + 2 * 0.5, 6)  # its two inner corners are cut
        self.assertEqual(alone.tolist(), [len(points)])

    def test_quadratic_elements_are_filled_to_their_curved_edges(self):
        points, *cells = fixture_bar.quadratic_mesh(4, 30)
        frame = dict(zip(("connectivity", "offsets", "types"), cells))
        at, values, triangles, outlines = plane_cells.elements(frame, points[:, :2], points[:, 0] ** 2, 4)
        y = np.linspace(0, fixture_bar.HEIGHT, 100001)
        exact = np.trapezoid(2 * fixture_bar.half_width(y), y) if hasattr(np, "trapezoid") else \
            np.trapz(2 * fixture_bar.half_width(y), y)
        self.assertAlmostEqual(areas(at[triangles]).sum() / exact, 1, 3)
        self.assertAlmostEqual(values.max() / fixture_bar.GRIP ** 2, 1, 12)
        self.assertEqual(len(plane_cells.rim(frame, outlines)), 2 * (4 + 30))

    def test_shape_functions_at_their_nodes(self):
        nodes = {22: [(0, 0), (1, 0), (0, 1), (.5, 0), (.5, .5), (0, .5)], 5: [(0, 0), (1, 0), (0, 1)],
                 9: [(0, 0), (1, 0), (1, 1), (0, 1)]}
        nodes[23] = nodes[9] + [(.5, 0), (1, .5), (.5, 1), (0, .5)]
        nodes[28] = nodes[23] + [(.5, .5)]
        for kind, places in nodes.items():
            r, s = np.array(places, float).T
            self.assertLess(abs(plane_cells._shape(kind, r, s) - np.eye(len(places))).max(), 1e-14, kind)

    def test_three_dimensional_cells_are_left_to_vtk(self):
        with tempfile.TemporaryDirectory() as folder:
            fixture.cube_frame(Path(folder) / "run", 2, True, 1e-3)
            self.assertFalse(frames.facts(Path(folder) / "run/fields_0000.hdf", "von_mises", 1)["plane"])


if __name__ == "__main__":
    unittest.main()
