"""Tests of the figures for particles inside their body: Voronoi cells, robust scales, animations; and of plots of
changes from an instant, lengths of vectors, logarithmic histories and published points."""

import json
import sys
import tempfile
import unittest
from pathlib import Path

sys.dont_write_bytecode = True
HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent.parent / "reports")]

import fixture  # noqa: E402  (needs the paths above)
import fixture_voronoi  # noqa: E402
import numpy as np  # noqa: E402
from concord_report import cache, captions, cases, films, frames, loading, page, pictures, plane_cells, render, voronoi_cells  # noqa: E402
from concord_report.loading import InputError  # noqa: E402
from test_figures import drawing, row, spec_of, study  # noqa: E402

F = np.array([[1.2, 0.3, 0.0], [0.1, 0.9, 0.2], [0.0, -0.1, 1.1]])


def folder_of(test):
    made = tempfile.TemporaryDirectory()
    test.addCleanup(made.cleanup)
    return Path(made.name)


def volume(points, corners, begin):
    """Of a closed surface of polygons, and the number of edges that are not shared by exactly two of them."""
    total, edges = 0.0, {}
    for a, b in zip(begin, begin[1:]):
        ring = corners[a:b]
        for k in range(1, len(ring) - 1):
            total += np.dot(points[ring[0]], np.cross(points[ring[k]], points[ring[k + 1]])) / 6
        for p, q in zip(ring, np.roll(ring, -1)):
            edges[min(p, q), max(p, q)] = edges.get((min(p, q), max(p, q)), 0) + 1
    return abs(total), sum(n != 2 for n in edges.values())


class Cells(unittest.TestCase):
    size, n = (2, 1, 1), 3

    def setUp(self):
        self.folder = folder_of(self)
        self.X = fixture_voronoi.inside(self.n, self.size)
        faces = fixture_voronoi.box_cells(self.X, self.size)
        outward = []
        for a, b, corners in faces:  # seen from outside, as the surface of the cell a
            normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
            outward.append((a, b, corners if np.dot(normal, corners[0] - self.X[a]) > 0 else corners[::-1]))
        fixture_voronoi.write_cells(self.folder / "cells.hdf", outward)
        self.cells = voronoi_cells.read(voronoi_cells.path_in(self.folder))

    def test_an_affine_motion_is_exact_and_the_skin_closed(self):
        points, corners, begin, owner = voronoi_cells.skin(self.cells, self.X, self.X @ F.T, 1 / self.n)
        found, loose = volume(points, corners, begin)
        self.assertAlmostEqual(found, 2 * np.linalg.det(F), 10)
        self.assertEqual((loose, len(owner)), (0, len(begin) - 1))
        back = points @ np.linalg.inv(F).T
        self.assertLess(min(abs(back).min(), abs(back - self.size).min()), 1e-9)
        self.assertTrue(((back > -1e-9) & (back < np.array(self.size) + 1e-9)).all())

    def test_a_bent_body_has_no_gaps(self):
        x = self.X + 0.3 * np.stack([0 * self.X[:, 0], np.sin(2 * self.X[:, 0]), self.X[:, 0] ** 2], -1)
        points, corners, begin, _ = voronoi_cells.skin(self.cells, self.X, x, 1 / self.n)
        found, loose = volume(points, corners, begin)
        self.assertEqual(loose, 0)
        self.assertAlmostEqual(found, 2, 1)  # the motion keeps volume; straight cells do so nearly

    def test_plane_cells_fill_the_body(self):
        X = fixture_voronoi.inside(6, (1, 0.5))
        fixture_voronoi.write_cells(self.folder / "plane.hdf", fixture_voronoi.box_cells(X, (1, 0.5)))
        flat, plane_F = np.pad(X, ((0, 0), (0, 1))), np.diag([1.3, 0.8, 1.0])
        triangles, owner, inner, edge = voronoi_cells.plane(voronoi_cells.read(self.folder / "plane.hdf"), flat, flat @ plane_F, 1 / 6)
        a, b = triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
        self.assertAlmostEqual(abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum() / 2, 0.5 * 1.3 * 0.8, 10)
        self.assertEqual(set(owner), set(range(len(X))))
        self.assertAlmostEqual(np.linalg.norm(edge[:, 1] - edge[:, 0], axis=1).sum(), 2 * (1.3 + 0.4), 10)
        self.assertEqual(len(triangles), 2 * len(inner) + len(edge))

    def test_cells_of_another_body_and_broken_files_are_refused(self):
        with self.assertRaisesRegex(InputError, "more than the frame's 3 particles"):
            voronoi_cells.skin(self.cells, self.X[:3], self.X[:3], 0.3)
        (self.folder / "broken.hdf").write_text("not HDF5")
        with self.assertRaisesRegex(InputError, "broken.hdf"):
            voronoi_cells.read(self.folder / "broken.hdf")
        self.assertIsNone(voronoi_cells.path_in(HERE))


class Cracks(unittest.TestCase):
    def test_nothing_is_drawn_across_a_crack(self):
        X = fixture.lattice(1, (8, 4, 0))[0][::2, :2]  # one of its two layers
        self.assertEqual(len(X), 9 * 5)
        x = X + np.where(X[:, :1] > 4.5, [[1.0, 0]], [[0, 0]])
        def area(quads):
            a, b = quads[:, 2] - quads[:, 0], quads[:, 3] - quads[:, 1]
            return abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum() / 2
        for torn, wanted in ((False, 9 * 4), (True, 7 * 4)):  # between the columns at 4 and 5 there is nothing left
            quads, _, alone, edge = plane_cells.shares(X, x, 1.0, torn)
            self.assertAlmostEqual(area(quads), wanted)
            self.assertEqual((len(alone), len(edge)), (0, 2 * (8 + 4) if not torn else 2 * (4 + 4) + 2 * (3 + 4)))
        x[7] += 30
        self.assertIn(7, plane_cells.shares(X, x, 1.0, True)[2])  # one that flew off


class Graded(unittest.TestCase):
    def test_coarse_regions_beside_fine_ones_are_filled(self):
        fine, coarse = (np.stack(np.meshgrid(xs, np.arange(0, 4.01, s), indexing="ij"), -1).reshape(-1, 2)
                        for xs, s in ((np.arange(0, 3.01, 0.25), 0.25), (np.arange(3.5, 8.6, 1.0), 1.0)))
        X = np.concatenate([fine, coarse])
        quads, _, alone, _ = plane_cells.shares(X, X, 0.3)
        a, b = quads[:, 2] - quads[:, 0], quads[:, 3] - quads[:, 1]
        self.assertAlmostEqual(abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum() / 2, 8.5 * 4)
        self.assertEqual(len(alone), 0)


class Films(unittest.TestCase):
    def test_instants_are_evenly_spaced_and_no_more_than_there_are(self):
        found = [(0.1 * k, k) for k in range(101)]
        self.assertEqual([k for _, k in films.instants(found, {"frames": 5, "from": 2, "to": 6})], [20, 30, 40, 50, 60])
        self.assertEqual(len(films.instants(found, {"frames": 1000})), 101)
        self.assertEqual(films.instants(found, {"frames": 4, "from": 20, "to": 30}), [])
        self.assertEqual(films.wanted({"animate": {"seconds": 2}}), {"frames": 24, "seconds": 2})
        self.assertIsNone(films.wanted({}))

    def test_the_sheet_has_its_pictures_in_rows(self):
        drawings = [np.full((4, 6, 4), k, np.uint8) for k in range(8)]
        sheet = films.sheet(drawings)
        self.assertEqual(sheet.shape, (8, 36, 4))
        self.assertEqual((sheet[5, 7, 0], sheet[5, 13, 0], sheet[0, 35, 0]), (7, 0, 5))

    def test_a_sheet_keeps_to_its_budget_while_coarser_qualities_are_left(self):
        noise = np.random.default_rng(1).integers(0, 255, (200, 400, 4), np.uint8)
        noise[..., 3] = 255
        fine = len(render.encode(noise, render.COARSER, 10 ** 9)[1])
        light = len(render.encode(noise, render.COARSER, fine // 2)[1])
        self.assertLess(light, fine)
        self.assertLessEqual(light, fine // 2)


class Pictures(unittest.TestCase):
    """A bar of particles inside it whose field has one peak, with and without cells."""

    def setUp(self):
        self.folder = folder_of(self)
        X = fixture_voronoi.inside(5, (1, 1, 1))
        def field(points, t): return np.where(np.arange(len(points)) == 7, 1000.0, 10 * t * points[:, 0])
        faces = fixture_voronoi.box_cells(X, (1, 1, 1))
        self.rows = []
        for variant, cells in (("cells", faces), ("bare", [])):
            fixture_voronoi.body(self.folder, variant, X, cells, fixture_voronoi.twist, (0.0, 0.5, 1.0), field, fixture.frame,
                                 fixture.series)
            self.rows.append(row("voronoi", variant, None, resolution=5, h=0.2, dt=0.1, run=variant))

    def jobs(self, **more):
        one = study(self.rows, self.folder, pictures=[{"color": "von_mises", **more}])
        self.told, store = [], cache.Cache(self.folder / "cache")
        return pictures.prepare(one, cases.cases_of(one), store, self.told)

    def test_a_robust_scale_tells_what_it_clips(self):
        panels = [{"variant": "cells"}, {"variant": "bare"}]
        for wanted, top in (("common", 1000.0), ("robust", 9.8)):
            jobs = self.jobs(panels=panels, range=wanted, times=[0.5, 1.0])
            self.assertEqual(len({json.dumps(j["limits"]) for j in jobs}), 1)
            self.assertLess(abs(jobs[0]["limits"][1] - top), 1.0)
        self.assertEqual(jobs[0]["beyond"], [False, True])
        share = jobs[0]["clipped"]
        self.assertTrue(1 / 125 <= share <= 5 / 125, share)
        words = captions.note(jobs)
        self.assertIn("1st and 99th percentile", words)
        self.assertIn(captions.share(max(j["clipped"] for j in jobs)), words)
        self.assertEqual(captions.share(2e-5), "less than 0.1 %")

    def test_pictures_weigh_alike_in_a_robust_scale(self):
        alike = [{"quantiles": list(np.linspace(0, 1, 201))} for _ in range(3)]
        low, high = pictures._tails(alike)
        self.assertAlmostEqual(low, 0.01, 2)
        self.assertAlmostEqual(high, 0.99, 2)
        peak = {"quantiles": [0.5] * 190 + [100.0] * 11}  # a twentieth of one picture in four is 1.4 % of all
        self.assertEqual(pictures._tails([*alike, peak])[1], 100)
        self.assertLess(pictures._tails([*alike * 2, peak])[1], 1.01)

    def test_a_list_of_variants_is_a_panel_each(self):
        one = study(self.rows, self.folder, pictures=[{"color": "von_mises", "variant": ["cells", "bare"], "caption": "Both"}])
        found = pictures.entries(one)
        self.assertEqual([(e["variant"], e["caption"]) for e, _ in found], [("cells", "cells"), ("bare", "bare")])
        self.assertTrue(all(whole["caption"] == "Both" for _, whole in found))

    def test_cells_that_are_not_there_are_told(self):
        here, gone = self.jobs(panels=[{"variant": "cells"}, {"variant": "bare"}], draw="cells")
        self.assertTrue(here["cells"].endswith("cells.vtkhdf"))
        self.assertIn("no cells.vtkhdf", gone["missing"])
        self.assertIn("bare", self.told[0])
        surface = self.jobs(variant="bare")[0]
        self.assertIn("surface through the outermost particles", captions.caption(surface)[1])

    def test_the_reference_body_and_no_field(self):
        job, = self.jobs(variant="cells", color="none", scale_displacement=0, draw="cells")
        self.assertEqual((job["scale"], job["range"]), (0.0, [0.0, 0.0]))
        self.assertIn("reference body", captions.caption(job)[1])
        job.update(format="png", image=b"", width=10, height=10)
        (group,), _ = page._pictures([job], "x")
        self.assertTrue(group["plain"])
        self.assertIn("its Voronoi cells", group["pictures"][0]["alt"])

    def test_an_animation_is_one_job_a_panel_on_one_scale(self):
        jobs = self.jobs(panels=[{"variant": "cells"}, {"variant": "bare"}], animate={"frames": 9}, range="common")
        self.assertEqual([len(j["film"]) for j in jobs], [3, 3])
        self.assertEqual([j["times"] for j in jobs], [[0.0, 0.5, 1.0]] * 2)
        self.assertEqual(jobs[0]["view"], jobs[1]["view"])
        self.assertEqual(jobs[0]["budget"], films.BUDGET // 2)
        store = cache.Cache(self.folder / "cache")
        pictures.render_missing(jobs, store, self.told)
        self.assertEqual(self.told, [])
        for job in jobs:
            self.assertEqual((job["across"], job["down"]), (3, 1))
            self.assertLess(len(job["image"]), job["budget"])
        (group,), _ = page._pictures(jobs, "x")
        self.assertEqual(group["film"], {"count": 3, "seconds": 4, "times": ["t = 0 s", "t = 0.5 s", "t = 1 s"]})
        self.assertEqual(group["pictures"][0]["sheet"], {"count": 3, "across": 3, "down": 1, "left": -200, "top": 0})
        self.assertIn("3 frames", group["common"])

    def test_a_plate_never_hides_the_body_and_needs_a_face_that_is_held(self):
        points, _ = fixture.lattice(2, (2, 1, 1))
        for axis, end, wanted in ((0, 0, True), (1, 0, False), (2, 1, False), (1, 1, True)):
            u = 0.1 * abs(points - end * points.max(axis=0))[:, [axis]] * np.ones(3)
            frame = {"points": points + u, "fields": {"displacement": u}}
            self.assertEqual(frames.held(frame) is not None, wanted, (axis, end))
            loose = np.where(points.sum(axis=1, keepdims=True) > 1.4, u + 1, u)
            self.assertIsNone(frames.held({"points": points + loose, "fields": {"displacement": loose}}))

    def test_thin_bodies_are_seen_from_the_front(self):
        self.assertTrue(frames._thin(fixture.lattice(10, (1, 0.5, 0.1))[0]))
        self.assertFalse(frames._thin(fixture.lattice(4, (6, 1, 1))[0]))
        seen = {"h": 0.1, "particles": False, "cells": None, "crop": None, "thin": True, "picture": {},
                "seen": [[0, 0, 0], [9, 9, 9]], "seen_flat": [[0, 0, 0], [1, 0.5, 0.1]]}
        self.assertEqual(pictures._view(seen, [seen], False)["high"], [1, 0.5, 0.1])

    def test_rows_of_instants_are_as_high_as_they_need(self):
        rows = {}
        for k, t in enumerate((0.0, 1.0)):
            job = {"h": 0.1, "particles": True, "cells": None, "crop": None, "thin": False, "picture": {"instant": k}}
            job["seen"] = [[0, -t, 0], [2, 0.2, 1]]
            rows[k] = job
        views = [pictures._view(rows[k], list(rows.values()), False) for k in (0, 1)]
        self.assertEqual([v["low"][0] for v in views], [-0.05] * 2)
        self.assertEqual([round(v["low"][1], 3) for v in views], [-0.05, -1.05])


class Lines(unittest.TestCase):
    def setUp(self):
        self.folder = folder_of(self)
        self.rows = []
        for variant, drift in (("kept", 0.0), ("lost", 1e-6)):
            run = self.folder / variant
            run.mkdir()
            lines = [f"{t},{3 + 3 * drift * t},{4 + 4 * drift * t},{t ** 2},{-2 * t}" for t in range(11)]
            (run / "history.csv").write_text("t_s,momentum_x_kg_m_s,momentum_y_kg_m_s,path_m,push_N\n" + "\n".join(lines) + "\n")
            self.rows.append(row("voronoi", variant, None, dt=0.1, run=variant))

    def spec(self, **plot):
        return spec_of(self.rows, plot, self.folder)

    def history(self, **more):
        return self.spec(kind="history", columns=["momentum_x_kg_m_s", "momentum_y_kg_m_s"], norm=True, **more)

    def test_the_length_of_a_vector_and_of_its_change(self):
        kept, lost = self.history()["curves"]
        self.assertEqual((kept["y"][0], kept["label"]), (5.0, "Voronoi kept"))
        self.assertAlmostEqual(lost["y"][-1], 5 * (1 + 1e-5))
        spec = self.history(change_from=4)
        self.assertEqual(spec["curves"][1]["x"][0], 4)
        self.assertEqual(spec["curves"][1]["y"][0], 0)
        self.assertIn("change of momentum", spec["ylabel"])

    def test_a_logarithmic_axis_leaves_out_zeros_and_says_so(self):
        spec = self.history(change_from=4, log=True)
        lost, = spec["curves"]
        self.assertEqual((spec["scales"][1], len(lost["x"])), ("log", 6))
        self.assertAlmostEqual(lost["y"][-1] / 3e-5, 1, 3)
        self.assertIn("Voronoi kept: 0 throughout.", spec["note"])
        self.assertIn("size of the change of momentum", spec["ylabel"])
        drawing(spec)
        self.assertIn("0 throughout", self.history(change=True, log=True, variant="kept"))
        self.assertIn("no history.csv", self.history(change_from=11))

    def test_published_points_are_in_the_units_drawn_and_in_ink(self):
        points = [{"label": "Someone 1981", "x": [1, 2], "y": [3, 5]}]
        spec = self.spec(kind="curve", x="path_m", y="push_N", y_scale=-1, x_scale=1, points=points,
                         baseline=[{"variant": "kept", "label": "ours"}])
        line = spec["curves"][-1]
        self.assertEqual((line["label"], line["x"], line["y"]), ("Someone 1981", [1, 2], [3, 5]))
        self.assertEqual([c["label"] for c in spec["curves"] if c.get("reference")], ["ours"])
        self.assertEqual(len({c["case"] for c in spec["curves"]}), 4)
        svg = drawing(spec)
        self.assertIn("Someone 1981", svg)
        plain = drawing({**spec, "curves": spec["curves"][:-1]})
        self.assertEqual(svg.count('data-case="-1001"'), plain.count('data-case="-1001"') + 3)  # marks, their sample, label

    def test_labels_tell_the_scene_only_where_there_are_several(self):
        rows = [*self.rows, {**self.rows[0], "scene": "other_scene"}]
        both = spec_of(rows, {"kind": "history", "quantity": "path_m"}, self.folder)
        one = spec_of(rows, {"kind": "history", "quantity": "path_m", "scene": "s"}, self.folder)
        self.assertIn("Voronoi kept, other scene", [c["label"] for c in both["curves"]])
        self.assertEqual([c["label"] for c in one["curves"]], ["Voronoi kept", "Voronoi lost"])

    def test_bad_entries_are_refused(self):
        for name, entry, key in (("plots", {"points": [{"label": "a", "x": [1], "y": [1, 2]}]}, "points"),
                                 ("plots", {"change_from": "5 s"}, "change_from"), ("pictures", {"range": "wide"}, "range"),
                                 ("pictures", {"animate": {"frames": 0}}, "animate"), ("pictures", {"draw": "lines"}, "draw")):
            path = self.folder / "study.json"
            path.write_text(json.dumps({"name": "x", name: [entry]}))
            with self.assertRaisesRegex(InputError, f"key '{key}'"):
                loading.load_study(path)

    def test_what_all_notes_say_is_said_once(self):
        shown = [{"note": f"Of all plots. {k}" if k else "Of all plots."} for k in ("", "One.", "Two. More.")]
        self.assertEqual(page._said_once(shown), "Of all plots.")
        self.assertEqual([s["note"] for s in shown], ["", "One.", "Two. More."])
        self.assertEqual(page._said_once(shown[:2]), "")


if __name__ == "__main__":
    unittest.main()
