"""Tests of the figures for dynamic studies: histories of several columns, pictures at instants, solid bodies."""

import json
import sys
import tempfile
import unittest
from pathlib import Path

sys.dont_write_bytecode = True
HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent.parent / "reports")]

import fixture  # noqa: E402  (needs the paths above)
import numpy as np  # noqa: E402
from concord_report import cache, captions, cases, frames, histories, page, pictures, plots, solid_cells  # noqa: E402
from test_figures import drawing, row, study  # noqa: E402


class Histories(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.rows = []
        for method, n, scale in (("delaunay", 2, 1), ("delaunay", 4, 2), ("fem", 4, 3)):
            run = Path(self.folder.name) / f"{method}{n}"
            run.mkdir()
            lines = [f"{t},{scale * t},{scale * (3 - t)},{7 * scale},{t}" for t in range(4)]
            (run / "history.csv").write_text("t_s,kinetic_energy_J,internal_energy_J,energy_balance_J,tip_z_m\n"
                                             + "\n".join(lines) + "\n")
            self.rows.append(row(method, "", None, resolution=n, particles=10 * n, dt=0.1, run=run.name))

    def spec(self, **more):
        one = study(self.rows, self.folder.name, plots=[{"kind": "history", **more}])
        return plots.plot_specs(one, cases.cases_of(one))[0][1]

    def test_several_columns_have_the_numbers_of_the_file_and_hues_of_their_own(self):
        spec = self.spec(columns=["kinetic_energy_J", "internal_energy_J", "energy_balance_J"], method="delaunay")
        self.assertEqual([c["y"] for c in spec["curves"]], [[0, 2, 4, 6], [6, 4, 2, 0], [14] * 4])  # of the finest
        self.assertEqual([c["label"] for c in spec["curves"]], ["kinetic energy", "internal energy", "energy balance"])
        self.assertEqual(len({c["hue"] for c in spec["curves"]}), 3)
        self.assertEqual((spec["ylabel"], spec["xlabel"], spec["note"]),
                         ("energy [J]", "time [s]", "Finest level of each case."))

    def test_several_runs_are_told_apart_by_dashes_and_labels(self):
        spec = self.spec(columns=["kinetic_energy_J", "internal_energy_J"], resolutions=[4])
        self.assertEqual([(c["label"], c["dash"]) for c in spec["curves"]],
                         [("kinetic energy, Delaunay", 0), ("internal energy, Delaunay", 0),
                          ("kinetic energy, FEM", 1), ("internal energy, FEM", 1)])
        self.assertIn("kinetic energy, FEM", drawing(spec))

    def test_change_is_from_the_first_value(self):
        spec = self.spec(quantity="internal_energy_J", change=True, resolutions=[4], method="fem")
        self.assertEqual(spec["curves"][0]["y"], [0, -3, -6, -9])
        self.assertTrue(spec["ylabel"].startswith("change of"))

    def test_many_variants_of_one_method_have_hues_of_their_own(self):
        run = self.rows[1]["run"]
        self.rows = [row("cbm", f"Gf {k}", None, resolution=6, particles=9, dt=0.1, run=run) for k in range(5)]
        spec = self.spec(quantity="tip_z_m")
        self.assertEqual([len({c["hue"] for c in spec["curves"]}), {c["dash"] for c in spec["curves"]}], [5, {0}])
        self.rows = self.rows[:3]
        self.assertNotIn("hue", self.spec(quantity="tip_z_m")["curves"][0])

    def test_share_of_the_total_at_the_end(self):
        spec = self.spec(columns=["kinetic_energy_J"], share_of=["kinetic_energy_J", "internal_energy_J"], resolutions=[4], method="fem",
                         y_label="share")
        self.assertEqual([round(y, 12) for y in spec["curves"][0]["y"]], [0, round(1 / 3, 12), round(2 / 3, 12), 1])
        self.assertEqual(spec["ylabel"], "share")
        both = self.spec(columns=["kinetic_energy_J", "internal_energy_J"], share_of=["kinetic_energy_J"], resolutions=[4], method="fem")
        self.assertEqual([len(both["curves"]), both["curves"][0]["y"]], [1, [1, 1, 1, 1]])
        self.assertIsInstance(self.spec(columns=["kinetic_energy_J"], share_of=["gone_J"]), str)

    def test_rate_is_the_change_over_a_window_inside_the_record(self):
        spec = self.spec(quantity="kinetic_energy_J", rate_over=1.5, resolutions=[4], method="fem")
        self.assertEqual([spec["curves"][0]["x"], spec["curves"][0]["y"]], [[1, 2], [3, 3]])
        self.assertEqual(spec["ylabel"], "rate of kinetic energy [J/s]")
        self.assertEqual(histories.rate([0, 1, 2, 3], [0, 0, 4, 4], 2), ([1, 2], [2, 2]))

    def test_every_density_beside_a_run_to_compare_with(self):
        spec = self.spec(quantity="kinetic_energy_J", method="delaunay",
                         baseline=[{"method": "fem", "resolution": 4, "label": "truth"}])
        self.assertEqual([(c["label"], c["y"][-1], bool(c.get("reference"))) for c in spec["curves"]],
                         [("Delaunay, 40 particles", 6, False), ("Delaunay, 20 particles", 3, False), ("truth", 9, True)])
        self.assertNotEqual(spec["curves"][0]["dash"], spec["curves"][1]["dash"])

    def test_columns_of_several_units_are_refused_and_missing_ones_told(self):
        self.assertIn("several units", self.spec(columns=["kinetic_energy_J", "tip_z_m"]))
        self.assertIn("No run has viscous dissipation",
                      self.spec(columns=["kinetic_energy_J", "viscous_dissipation_J"])["note"])
        self.assertIn("no history.csv", self.spec(columns=["a_J", "b_J"]))


class Instants(unittest.TestCase):
    """A beam held at x = 0 that swings, and one that flies."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.rows = []
        for method in ("delaunay", "fem"):
            for scene, fly in (("held", 0), ("free", 1)):
                run = Path(cls.folder.name) / f"{scene}-{method}"
                run.mkdir()
                points, shape = fixture.lattice(2, (3, 1, 1))
                files = []
                for k, t in enumerate((0.0, 0.5, 0.996)):
                    u = np.zeros_like(points)
                    u[:, 2] = 0.1 * t * points[:, 0] ** 2
                    u[:, 0] = 20 * fly * t
                    name = f"fields_{k:04d}.hdf"
                    fixture.frame(run / name, points, u, {"s": points[:, 0] + t},
                                  *(fixture.hexahedra(shape) if method == "fem" else ()))
                    files.append({"name": name, "time": t})
                (run / "fields.hdf.series").write_text(json.dumps({"files": files}))
                cls.rows.append(row(method, "", None, scene=scene, resolution=2, h=0.5, dt=0.1, run=run.name))

    def jobs(self, scene, **more):
        picture = {"color": "s", "scene": scene, "panels": [{"method": "delaunay"}, {"method": "fem"}], **more}
        one = study(self.rows, self.folder.name, pictures=[picture])
        return pictures.prepare(one, cases.cases_of(one), cache.Cache(Path(self.folder.name) / "cache"), [])

    def test_a_row_an_instant_a_column_a_panel_on_one_scale(self):
        jobs = self.jobs("held", times=[0.5, 1])
        self.assertEqual([(j["time"], j["case"].method) for j in jobs],
                         [(0.5, "delaunay"), (0.5, "fem"), (0.996, "delaunay"), (0.996, "fem")])
        self.assertEqual(len({json.dumps(j["limits"]) for j in jobs}), 1)
        self.assertEqual([jobs[k]["view"] for k in (0, 2)], [jobs[k]["view"] for k in (1, 3)])  # of a row
        for end in ("low", "high"):  # all rows are as wide
            self.assertEqual(len({j["view"][end][0] for j in jobs}), 1)
        self.assertEqual(jobs[0]["limits"], [0.0, 3.996])
        self.assertEqual(captions.columns(jobs[0]["whole"], 4), 2)

    def test_a_panel_may_have_a_time_of_its_own(self):
        jobs = self.jobs("held", time=0, panels=[{"method": "fem", "time": 0.5}, {"method": "fem"}])
        self.assertEqual([j["time"] for j in jobs], [0.5, 0])

    def test_bodies_that_travel_are_followed_row_by_row(self):
        jobs = self.jobs("free", times=[0.5, 1])
        self.assertTrue(all(j["followed"] for j in jobs))
        low, high = (np.array([j["view"][k] for j in jobs]) for k in ("low", "high"))
        self.assertLess(np.ptp(high - low, axis=0)[[0, 2]].max(), 1e-12)  # of one width
        self.assertEqual(low[0].tolist(), low[1].tolist())
        self.assertGreater(np.abs(low[2] - low[0]).max(), 5)
        self.assertEqual(captions.row_text(0.5, jobs[:2]), "t = 0.5 s; bodies about x = 11.5 m, y = 0.500 m, z = 0.663 m")
        held = self.jobs("held", times=[0.5, 1])
        self.assertFalse(any(j["followed"] for j in held))
        self.assertEqual(captions.row_text(0.5, held[:2]), "t = 0.5 s")

    def test_the_plate_stands_behind_the_face_that_is_held(self):
        plate = np.array(self.jobs("held", times=[1])[0]["plate"])
        self.assertEqual(plate[:, 0].max(), 0)
        self.assertLess(plate[:, 0].min(), 0)
        self.assertGreater(plate[:, 1].max(), 1)
        self.assertIsNone(self.jobs("free", times=[1])[0]["plate"])

    def test_a_run_without_frames_leaves_its_place_empty(self):
        jobs = self.jobs("held", times=[0.5, 1], panels=[{"method": "cbm", "caption": "gone"}, {"method": "fem"}])
        for job in jobs:
            job.update(format="png", image=b"", width=10, height=10)
        (group,), missing = page._pictures(jobs, "x")
        self.assertEqual([p.get("why") for p in group["pictures"]], ["this report has no such run", None] * 2)
        self.assertEqual(([p["instant"] for p in group["pictures"]], missing), (["t = 0.5 s", "", "t = 1 s", ""], []))

    def test_instants_of_one_body_stand_side_by_side_and_tell_their_times(self):
        jobs = self.jobs("held", times=[0, 0.5, 1], panels=[], method="fem")
        self.assertEqual(captions.columns(jobs[0]["whole"], 3), 3)
        self.assertEqual([j["time"] for j in jobs], [0.0, 0.5, 0.996])
        self.assertIn("t = 0.5 s", captions.caption(jobs[1])[1])

    def test_a_frame_that_is_off_tells_its_time(self):
        near, far = self.jobs("held", times=[1])[0], self.jobs("held", times=[0.7])[0]
        self.assertNotIn("t = 0.996 s", captions.caption(near)[1])
        self.assertIn("t = 0.5 s", captions.caption(far)[1])


def measures(points, triangles):
    """(area, volume) of a closed surface."""
    a, b, c = (points[triangles[:, k]] for k in range(3))
    normal = np.cross(b - a, c - a) / 2
    return np.linalg.norm(normal, axis=1).sum(), (normal * (a + b + c)).sum() / 9


class Solids(unittest.TestCase):
    def lattice(self, n, noise):
        points = fixture.lattice(1, (n, n, n))[0]
        inside = ((points > 0) & (points < n)).all(axis=1)
        points[inside] += noise * np.random.default_rng(3).uniform(-1, 1, (inside.sum(), 3))
        return points

    def test_surface_of_regular_and_perturbed_particles_is_that_of_the_body(self):
        for noise in (0, 0.25, 0.45):
            points = self.lattice(6, noise)
            triangles, alone = solid_cells.surface(points, 1.0)
            for found, wanted in zip(measures(points, triangles), (216, 216)):
                self.assertAlmostEqual(found, wanted, 6, noise)
            self.assertEqual(len(alone), 0)

    def test_a_notch_stays_open_and_a_lone_particle_is_told(self):
        points = self.lattice(8, 0)
        points = points[~((points[:, 0] > 4.5) & (abs(points[:, 1] - 4) < 2))]
        triangles, alone = solid_cells.surface(np.vstack([points, [30, 30, 30]]), 1.0)
        self.assertLess(measures(np.vstack([points, [30, 30, 30]]), triangles)[1], 512 - 0.7 * 4 * 4 * 8)
        self.assertEqual(alone.tolist(), [len(points)])

    def test_each_particle_has_its_share_of_the_surface(self):
        points = self.lattice(4, 0)
        triangles, _ = solid_cells.surface(points, 1.0)
        at, quads, owner = solid_cells.shares(triangles, points, 2 * points)
        p = at[quads]
        area = np.linalg.norm(np.cross(p[:, 2] - p[:, 0], p[:, 3] - p[:, 1]), axis=1) / 2
        share = np.bincount(owner, area)[np.unique(owner)]
        self.assertAlmostEqual(share.sum(), 4 * 96)
        self.assertEqual(sorted(set(share.round(6))), [3.0, 4.0])  # of a corner 3 (2/2)^2; of an edge or a face 4

    def test_flat_clouds_have_no_surface(self):
        self.assertEqual(len(solid_cells.surface(np.zeros((3, 3)), 1.0)[0]), 0)

    def test_axes_as_seen(self):
        axes = {name: (right, up) for name, right, up in captions.triad()}
        for name, *seen in captions.triad():
            unit = np.eye(3)["xyz".index(name)]
            self.assertTrue(np.allclose(seen, frames.view_axes(False)[:2] @ unit, atol=1e-3))
        self.assertEqual(axes["z"][0], 0)


if __name__ == "__main__":
    unittest.main()
