"""FIXTURE DATA for fixture.py: a method whose particles lie inside the body, in space and in the plane, with its cells;
momenta that change from an instant on; a punch; published points. The numbers are formulas of this file."""

import math

import h5py
import numpy as np
from scipy.spatial import Voronoi


def inside(n, size, noise=0.2, seed=4):
    """Centres of an n x ... lattice in a box, stirred by `noise` spacings."""
    axes = [(np.arange(max(1, round(n * s))) + 0.5) / max(1, round(n * s)) * s for s in size]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), -1).reshape(-1, len(size))
    return points + noise / n * np.random.default_rng(seed).uniform(-1, 1, points.shape)


def box_cells(points, size):
    """[(particle, neighbour or -1, corners)] of the Voronoi cells in the box: mirror images make its walls."""
    images, count = [points], len(points)
    for k, s in enumerate(size):
        for wall in (0.0, s):
            mirrored = points.copy()
            mirrored[:, k] = 2 * wall - mirrored[:, k]
            images.append(mirrored)
    made = Voronoi(np.concatenate(images))
    faces = []
    for (a, b), corners in zip(made.ridge_points, made.ridge_vertices):
        a, b = min(a, b), max(a, b)
        if a < count:
            faces.append((a, b if b < count else -1, made.vertices[corners]))
    return faces


def write_cells(path, faces):
    """As the Voronoi method writes them: corners polygon after polygon."""
    corners = np.concatenate([f[2] for f in faces])
    begin = np.concatenate([[0], np.cumsum([len(f[2]) for f in faces])])
    with h5py.File(path, "w") as file:
        root = file.create_group("VTKHDF")
        root.attrs["Version"] = np.array([1, 0])
        root.attrs.create("Type", np.bytes_("UnstructuredGrid"))
        root["Points"] = np.pad(corners, ((0, 0), (0, 3 - corners.shape[1])))
        root["Connectivity"], root["Offsets"] = np.arange(len(corners)), begin
        root["Types"] = np.full(len(faces), 7 if corners.shape[1] == 3 else 3, np.uint8)
        root["CellData/particle"] = np.array([f[0] for f in faces])
        root["CellData/neighbour"] = np.array([f[1] for f in faces])
        root["CellData/wall"] = np.array([int(f[1] < 0) for f in faces])


def twist(X, t):
    """Turns the cross sections of a bar along x by an angle that grows with x and time."""
    angle = 0.9 * math.sin(t) * X[:, 0]
    y, z = X[:, 1] - 0.5, X[:, 2] - 0.5
    return np.stack([0 * y, np.cos(angle) * y - np.sin(angle) * z - y, np.sin(angle) * y + np.cos(angle) * z - z], -1)


def press(X, t):
    """A punch on the top of a strip, in the plane."""
    under = 1 / (1 + ((X[:, 0] - 0.5) / 0.22) ** 4)
    return np.stack([0.22 * t * (X[:, 0] - 0.5) * X[:, 1], -0.3 * t * under * X[:, 1], 0 * X[:, 0]], -1)


def body(folder, run, X, faces, move, times, stress, frame, series, cells=()):
    here = folder / run
    here.mkdir(parents=True, exist_ok=True)
    X = np.pad(X, ((0, 0), (0, 3 - X.shape[1])))
    for k, t in enumerate(times):
        frame(here / f"fields_{k:04d}.hdf", X, move(X, t), {"von_mises": stress(X, t), "pressure": stress(X, t) / 3}, *cells)
    series(here, *times)
    if faces:
        write_cells(here / "cells.vtkhdf", faces)
    return here


def momenta(path, kept):
    """Angular momentum that grows until t = 5 and then stays, to round-off or but roughly."""
    chance, lines = np.random.default_rng(1), []
    for t in np.linspace(0, 55, 600):
        loaded = min(t, 5.0)
        drift = 1e-12 * chance.normal() if kept else 3e-3 * (t - loaded) ** 2
        l = [a * loaded * (10 - loaded) + b * drift for a, b in ((120, 1), (-80, 2), (30, -1))]
        p = [1e-13 * chance.normal() for _ in range(3)]
        lines.append(",".join(f"{v:.17g}" for v in (t, *p, *l, 1e3 * math.sin(t) ** 2)))
    names = [f"linear_momentum_{k}_kg_m_s" for k in "xyz"] + [f"angular_momentum_{k}_kg_m2_s" for k in "xyz"]
    path.write_text(",".join(["t_s", *names, "kinetic_energy_J"]) + "\n" + "\n".join(lines) + "\n")


def voronoi(folder, row, claim, frame, series, lattice, hexahedra):
    times = np.linspace(0, 2.2, 12)
    size, n = (3, 1, 1), 4
    X = inside(n, size)
    faces = box_cells(X, size)
    def hot(X, t): return 2e4 * abs(math.sin(t)) * np.hypot(X[:, 1] - 0.5, X[:, 2] - 0.5) * (1 + 40 * (X[:, 0] > 2.8))
    rows = []
    for variant, kept in (("face-compatible", True), ("static", False)):
        made = row("bar_fixture", "voronoi", variant, n, 1, None, 1.0)
        made.update(errors={}, run=f"runs/{variant}", h=1 / n)
        here = body(folder, made["run"], X, faces, twist, times, hot, frame, series)
        momenta(here / "history.csv", kept)
        rows.append(made)
    points, shape = lattice(n, size)
    made = row("bar_fixture", "fem", "Q1", n, 1, None, 1.0)
    made.update(errors={}, run="runs/fem", h=1 / n)
    momenta(body(folder, "runs/fem", points, [], twist, times, hot, frame, series, hexahedra(shape)) / "history.csv", True)
    rows.append(made)
    X = inside(8, (1, 0.5))
    def pushed(X, t): return 1e5 * t * np.exp(-((X[:, 0] - 0.5) / 0.3) ** 2) * X[:, 1]
    for scale, variant in ((1, "plane"), (1.06, "plane, coarse")):
        made = row("strip_fixture", "voronoi", variant, 8, 1, None, 1.0)
        made.update(errors={}, run=f"runs/{variant}".replace(", ", "-"), h=1 / 8, dim=2)
        here = body(folder, made["run"], X, box_cells(X, (1, 0.5)), press, (0, 0.5, 1.0), pushed, frame, series)
        (here / "history.csv").write_text("t_s,punch_y_m,punch_force_y_N\n" + "".join(
            f"{t:.4g},{-0.15 * t:.5g},{-scale * 900 * (t + 2 * t ** 3):.6g}\n" for t in np.linspace(0, 1, 40)))
        rows.append(made)
    one = {"method": "voronoi", "variant": "face-compatible"}
    panels = [{**one, "caption": "Voronoi"}, {"method": "fem", "caption": "FEM"}]
    return {"title": "Fixture: Voronoi", "rows": rows,
            "claims": [claim("kept", "Largest change of angular momentum after 5 s", "0", 3.1e-12, "<= 1e-9")],
            "plots": [
                {"kind": "history", "columns": [f"angular_momentum_{k}_kg_m2_s" for k in "xyz"], "norm": True, "change_from": 5,
                 "log": True, "scene": "bar_fixture", "title": "Angular momentum after the end of loading",
                 "statement": "All momentum components can be considered to be conserved.", "source": "Fig. 8b"},
                {"kind": "history", "columns": [f"angular_momentum_{k}_kg_m2_s" for k in "xyz"], "method": "voronoi",
                 "variant": "face-compatible", "title": "Components of angular momentum"},
                {"kind": "curve", "x": "punch_y_m", "y": "punch_force_y_N", "x_scale": -1000, "y_scale": -1e-3,
                 "x_label": "punch displacement [mm]", "y_label": "punch force [kN]", "scene": "strip_fixture",
                 "points": [{"label": "Fixture 1981", "x": [50, 100, 150], "y": [0.38, 1.2, 2.7]}],
                 "baseline": [{"method": "voronoi", "variant": "plane", "label": "baseline"}]}],
            "pictures": [
                {**one, "draw": "cells", "color": "none", "scale_displacement": 0, "caption": "Cells of the reference body"},
                {"color": "von_mises", "times": [0.8, 1.6], "range": "robust", "panels": panels, "caption": "At two instants"},
                {"color": "von_mises", "range": "robust", "animate": {"frames": 10, "seconds": 2}, "panels": panels,
                 "caption": "Twisting"},
                {"color": "pressure", "times": [0.5, 1.0], "range": "common", "caption": "Plane strip",
                 "panels": [{"method": "voronoi", "variant": "plane", "caption": "cells"},
                            {"method": "voronoi", "variant": "plane", "draw": "cells", "caption": "cells and particles"},
                            {"method": "voronoi", "variant": "plane", "draw": "spheres", "caption": "discs"}]}]}
