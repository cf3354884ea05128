"""FIXTURE DATA. Writes a folder of made-up studies, in the shape that the study runner writes, to
try the report on. The numbers are formulas of this file; nothing here is a result."""

import json
import math
import random
import sys
from pathlib import Path

import h5py
import numpy as np

import fixture_bar
import fixture_voronoi
import fixture_work

SIGN = "FIXTURE DATA made by tests/browser/fixture.py, not a result."
MACHINE = {"cpu": "Fixture CPU, 2 cores", "simd": "AVX2", "threads": 1}
BUILD = {"version": "0.0.0", "commit": "fixture", "compiler": "none", "flags": "-O3 -fixture"}


def frame(path, points, displacement, fields, connectivity=None, offsets=None, types=None):
    """One VTKHDF 1.0 frame; without cells every point is a vertex cell."""
    count = len(points)
    if connectivity is None:
        connectivity, offsets, types = np.arange(count), np.arange(count + 1), np.ones(count)
    with h5py.File(path, "w") as file:
        root = file.create_group("VTKHDF")
        root.attrs["Version"] = np.array([1, 0])
        root.attrs.create("Type", np.bytes_("UnstructuredGrid"))
        for name, value in (("NumberOfPoints", count), ("NumberOfCells", len(types)),
                            ("NumberOfConnectivityIds", len(connectivity))):
            root[name] = np.array([value])
        root["Points"] = points + displacement
        root["Connectivity"] = np.asarray(connectivity, np.int64)
        root["Offsets"] = np.asarray(offsets, np.int64)
        root["Types"] = np.asarray(types, np.uint8)
        root["PointData/displacement"] = displacement
        for name, data in fields.items():
            root[f"PointData/{name}"] = data


def series(folder, *times):
    files = [{"name": f"fields_{k:04d}.hdf", "time": time} for k, time in enumerate(times)]
    (folder / "fields.hdf.series").write_text(json.dumps({"file-series-version": "1.0", "files": files}))


def lattice(n, size=(1, 1, 1)):
    axes = [np.linspace(0, s, max(2, round(n * s) + 1)) for s in size]
    shape = tuple(len(a) for a in axes)
    return np.stack(np.meshgrid(*axes, indexing="ij"), -1).reshape(-1, 3), shape


def hexahedra(shape):
    """(connectivity, offsets, types) of the lattice's cells in VTK's order."""
    at = np.arange(np.prod(shape)).reshape(shape)
    corner = [at[i:shape[0] - 1 + i, j:shape[1] - 1 + j, k:shape[2] - 1 + k].reshape(-1)
              for k in (0, 1) for i, j in ((0, 0), (1, 0), (1, 1), (0, 1))]
    cells = np.stack(corner, -1)
    return cells.reshape(-1), np.arange(len(cells) + 1) * 8, np.full(len(cells), 12)


def row(scene, method, variant, n, seed, error, wall, **more):
    unknowns = 3 * (n + 1) ** 3
    steps = 40 * n
    return {"scene": scene, "method": method, "variant": variant, "dim": 3, "resolution": n, "h": 1 / n,
            "unknowns": unknowns, "particles": (n + 1) ** 3, "seed": seed, "perturb": 0.25, "steps": steps,
            "dt": 2e-3 / steps, "t_end": 2e-3, "setup_s": wall / 9, "wall_s": wall,
            "ns_per_particle_step": 1e9 * wall / steps / (n + 1) ** 3, "peak_rss_mb": 60 + n ** 3 / 90,
            "threads": 1, "errors": {"displacement_l2": error}, "quantities": {},
            "invariants": {"linear_momentum_drift": 3.1e-13 * seed, "angular_momentum_drift": 8.2e-13},
            "machine": MACHINE, "build": BUILD, **more}


CUBE = (("delaunay", "xi 1, regular", 0.31, 1.86, 1.0, 1), ("delaunay", "xi 1, 25 %", 0.27, 2.02, 1.0, 5),
        ("delaunay", "xi 0, 25 %", 0.13, 1.28, 0.9, 5), ("tlsph", "support 1.5", 0.45, 1.72, 1.5, 3),
        ("tlsph", "support 2", 0.75, 1.66, 2.4, 3), ("fem", "Q1", 0.24, 2.0, 0.8, 1),
        ("fem", "Q2", 0.19, 2.95, 2.1, 1), ("fem", "P1", 0.5, 1.9, 0.7, 1), ("tlsph", "support 3", 0.9, 1.6, 4.4, 1),
        ("delaunay", "xi 0.1, 25 %", 0.2, 1.9, 1.0, 1))  # more than a plot labels at its ends


def cube(folder):
    """Convergence with seeds, pictures of particles and of a mesh."""
    chance, rows, fits = random.Random(7), [], []
    for method, variant, factor, order, cost, seeds in CUBE:
        for n in (4, 8, 16):
            for seed in range(1, seeds + 1):
                error = factor * n ** -order * (1 + (0.12 * chance.uniform(-1, 1) if seeds > 1 else 0))
                made = row("cube_fixture", method, variant, n, seed, error, cost * 1.1e-6 * n ** 4)
                if n == 16 and seed == 1 and (method, variant) in (("delaunay", "xi 1, 25 %"), ("fem", "Q2"),
                                                                   ("tlsph", "support 2")):
                    made["run"] = f"runs/{method}-{n}"
                    cube_frame(folder / made["run"], 16, method == "fem", error)
                rows.append(made)
        fits.append({"method": method, "variant": variant, "quantity": "errors.displacement_l2",
                     "slope": order, "r2": 0.9987, "intercept": math.log(factor)})
    picture = {"color": "von_mises", "scale_displacement": 100, "resolution": 16, "caption": "Fixture field"}
    return {"title": "Fixture: cube", "paper_statement": "The displacement exhibits a quadratic convergence.",
            "rows": rows, "fits": fits,
            "claims": [claim("order", "Second order on irregular particles", "2", 2.02, ">= 1.8 and <= 2.6"),
                       claim("control", "Without stabilisation the order falls below 1.6", "", 1.28, "<= 1.6"),
                       claim("finest", "Error on the finest level", "", 1.02e-3, "<= 1.8e-3"),
                       claim("later", "Order over five levels", "2", None, ">= 1.9", "full report only")],
            "plots": [{"kind": "convergence", "quantity": "errors.displacement_l2"},
                      {"kind": "cost", "quantity": "errors.displacement_l2"}],
            "pictures": [{"method": "delaunay", "variant": "xi 1, 25 %", **picture},
                         {"method": "tlsph", "variant": "support 2", **picture},
                         {"method": "fem", "variant": "Q2", **picture},
                         {"method": "fem", "variant": "Q9", **picture}]}


def cube_frame(folder, n, mesh, error):
    folder.mkdir(parents=True)
    points, shape = lattice(n)
    x, y, z = (0.5 * math.pi * points).T
    u = 5e-4 * np.stack([np.sin(x * 2) * np.cos(y) * np.cos(z), np.cos(x) * np.sin(y) * np.cos(z),
                         -np.cos(x) * np.cos(y) * np.sin(z)], -1)
    stress = 2e4 * np.abs(np.cos(x) * np.cos(y) + 0.3 * np.sin(z))
    cells = hexahedra(shape) if mesh else ()
    frame(folder / "fields_0000.hdf", points, u, {"von_mises": stress, "displacement_error": error * np.abs(u)},
          *cells)
    series(folder, 2e-3)


def claim(ident, statement, source_value, measured, bound, verdict="pass", **more):
    return {"id": ident, "statement": statement, "source": "Fixture, Fig. 0", "source_value": source_value,
            "measured": measured, "bound": bound, "verdict": verdict, **more}


def patch(folder):
    """No convergence, round-off numbers, a claim that fails, a study without plots."""
    rows = []
    for seed in range(1, 6):
        for method in ("delaunay", "tlsph"):
            made = row("patch_fixture", method, "", 4, seed, None, 2e-3)
            made["errors"] = {"force_max_N": (1 + seed) * 1.1e-11 * (1 if method == "delaunay" else 900)}
            rows.append(made)
    quantity = {"quantity": "errors.force_max_N", "unit": "N"}
    return {"title": "Fixture: patch tests", "rows": rows, "plots": [], "claims": [
        claim("a", "Largest residual force of test A", "2.8e-11 N", 6.6e-11, "<= 1e-10 N", **quantity),
        claim("b", "The same for a method that cannot pass", "", 5.9e-8, "<= 1e-10 N", "fail",
              note="5.9e-08 is not <= 1e-10 N", **quantity)]}


def beam(folder):
    """Histories of one and of several columns, bodies at instants, a missing column."""
    rows = []
    for method, variant, stiff in (("delaunay", "xi 1", 1.0), ("fem", "Q2", 1.02)):
        for n in (2, 4, 8):
            made = row("beam_fixture", method, variant, n, 1, None, 0.02 * n ** 4)
            made["errors"], made["run"] = {}, f"runs/{method}-{n}"
            here = folder / made["run"]
            here.mkdir(parents=True)
            rate = stiff * 3.4 * (1 + 0.25 / n ** 2)
            lines = [f"{t:.6g},{3.42 * (1 - 0.4 / n ** 2) * math.sin(rate * t):.6g},"
                     f"{1e5 * math.cos(rate * t) ** 2:.6g},{1e5 * math.sin(rate * t) ** 2:.6g},{1e-9 * t:.6g}"
                     for t in np.linspace(0, 3, 900)]
            (here / "history.csv").write_text(
                "t_s,tip_z_m,kinetic_energy_J,internal_energy_J,energy_balance_J\n" + "\n".join(lines) + "\n")
            if n == 4:
                points, shape = lattice(n, (6, 1, 1))
                for k, part in enumerate((-0.5, 0.5, 1)):
                    u = np.zeros_like(points)
                    u[:, 2] = 0.08 * part * points[:, 0] ** 2
                    u[:, 0] = -0.16 * part * points[:, 0] * (points[:, 2] - 0.5) - 0.009 * part ** 2 * points[:, 0] ** 2
                    stress = abs(part) * 3e5 * (6 - points[:, 0]) * np.abs(points[:, 2] - 0.5) + 1e4
                    frame(here / f"fields_{k:04d}.hdf", points, u, {"von_mises": stress, "velocity": u * 3},
                          *(hexahedra(shape) if method == "fem" else ()))
                series(here, 0.1, 0.25, 0.43)
            rows.append(made)
    shots = [{"method": m, "variant": v, "resolution": 4, "color": "von_mises"}
             for m, v in (("delaunay", "xi 1"), ("fem", "Q2"))]
    panels = [{k: v for k, v in shot.items() if k != "color"} | {"caption": shot["method"]} for shot in shots]
    shots.append({"color": "von_mises", "times": [0.1, 0.25, 0.43], "caption": "At three instants", "range": "common",
                  "panels": [*panels, {"method": "cbm", "caption": "cbm"}]})
    energies = [f"{name}_J" for name in ("kinetic_energy", "internal_energy", "viscous_dissipation", "energy_balance")]
    return {"title": "Fixture: beam", "rows": rows, "pictures": shots, "claims": [
        claim("peak", "Largest deflection", "3.4 m", 3.401, ">= 3.35 and <= 3.45 m", unit="m")],
        "plots": [{"kind": "history", "quantity": "tip_z_m", "title": "Deflection of the tip"},
                  {"kind": "history", "quantity": "tip_z_m", "title": "Every density beside FEM", "method": "delaunay",
                   "baseline": [{"method": "fem", "label": "FEM"}]},
                  {"kind": "history", "columns": energies, "method": "delaunay", "title": "Energies"},
                  {"kind": "history", "quantity": "no_such_column"}]}


def membrane(folder):
    """A plane problem, references with their own error, sweeps."""
    rows = []
    for n in (4, 8, 16):
        for variant, order in (("Q1", 1.2), ("Q2", 2.1)):
            made = row("membrane_fixture", "fem", variant, n, 1, None, 1e-3 * n ** 2)
            made.update(dim=2, errors={"tip_difference": 3.1 * n ** -order})
            made["quantities"] = {"tip_y_mm": 14.74 - 9 * n ** -order}
            rows.append(made)
    for psi in (0.01, 0.03, 0.1, 0.3, 1):
        for support in (2, 3):
            value = 0.02 + 0.015 * abs(math.log10(psi / 0.1)) * support
            made = row("membrane_fixture", "tlsph", f"support {support}, psi {psi}", 16, 1, value, 0.3)
            made["settings"] = {"support": str(support), "psi": str(psi)}
            made["dim"] = 2
            rows.append(made)
    here = folder / "runs/plane"
    here.mkdir(parents=True)
    rows[-1]["run"] = "runs/plane"
    s, t = np.meshgrid(np.linspace(0, 1, 25), np.linspace(0, 1, 25), indexing="ij")
    points = np.stack([0.048 * s, 0.044 * t * (1 - s) + s * (0.044 + 0.016 * t), 0 * s], -1).reshape(-1, 3)
    u = np.stack([-4 * points[:, 0] ** 2, 6 * points[:, 0] ** 2, 0 * points[:, 0]], -1)
    frame(here / "fields_0000.hdf", points, u, {"pressure": 1e5 * np.sin(60 * points[:, 1] + 40 * points[:, 0])})
    series(here, 1.0)
    rows[-1]["h"] = 0.0019
    return {"title": "Fixture: membrane", "rows": rows,
            "fits": [{"method": "fem", "variant": v, "quantity": "errors.tip_difference", "slope": o, "r2": 1}
                     for v, o in (("Q1", 1.2), ("Q2", 2.1))],
            "references": [
                {"method": "fem", "variant": "Q2", "quantity": "quantities.tip_y_mm", "value": 14.735,
                 "order": 2.06, "gci": 4.1e-4, "safety_factor": 1.25, "statement": "within 10 % of the formal order"},
                {"method": "fem", "variant": "Q1", "quantity": "quantities.tip_y_mm", "value": 14.42,
                 "asymptotic": False, "statement": "not asymptotic"}],
            "claims": [claim("tip", "Deflection of the tip", "14.74 mm", 14.735, ">= 14.7 and <= 14.8 mm",
                             unit="mm")],
            "plots": [{"kind": "convergence", "quantity": "errors.tip_difference"},
                      {"kind": "sweep", "quantity": "errors.displacement_l2", "setting": "psi",
                       "method": "tlsph"}],
            "pictures": [{"method": "tlsph", "variant": "support 3, psi 1", "resolution": 16,
                          "color": "pressure", "scale_displacement": 1}]}


def tensile_bar(folder):
    """A static plastic bar: curves, sweeps with baselines, a map, panels, differences, open balances."""
    return fixture_bar.bar(folder, row, claim, frame, series)


def work(folder):
    """Work against precision, matched errors, a heat map."""
    return fixture_work.work(folder, row, claim)


def voronoi(folder):
    """Particles inside their body: cells, animations, changes from an instant, published points."""
    return fixture_voronoi.voronoi(folder, row, claim, frame, series, lattice, hexahedra)


def write(folder):
    """The fixture's studies below `folder`."""
    for name, make in (("cube", cube), ("patch", patch), ("beam", beam), ("membrane", membrane),
                       ("bar", tensile_bar), ("work", work), ("voronoi", voronoi)):
        here = Path(folder) / f"fixture_{name}"
        here.mkdir(parents=True)
        data = {"name": here.name, "question": SIGN, "source": "tests/browser/fixture.py", "mode": "quick",
                **make(here)}
        data["verdict"] = "fail" if any(c["verdict"] == "fail" for c in data["claims"]) else "pass"
        (here / "study.json").write_text(json.dumps(data, indent=1))


if __name__ == "__main__":
    write(sys.argv[1])
