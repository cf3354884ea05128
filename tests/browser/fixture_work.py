"""FIXTURE DATA: a made-up study of work against precision, of matched errors, signals and a heat map. The numbers
are formulas of this file; nothing here is a result."""

import math

QUANTITY = "errors.displacement_l2"
LEVELS = (0.1, 0.03, 0.01, 0.003)
LADDERS = (  # scene, method, variant, error at h = 1, order, run time at h = 1, its power, resolutions
    ("cube_fixture", "delaunay", "xi 1", 0.5, 2.0, 1.2e-4, 4.0, (2, 4, 8, 16)),
    ("cube_fixture", "delaunay", "xi 0", 0.4, 1.4, 1.0e-4, 4.0, (2, 4, 8, 16)),
    ("cube_fixture", "tlsph", "support 2, psi 1", 0.9, 1.7, 5e-4, 4.1, (2, 4, 8, 16)),
    ("cube_fixture", "fem", "Q1", 0.45, 2.0, 4e-4, 4.0, (2, 4, 8, 16)),
    ("cube_fixture", "fem", "Q2", 0.2, 3.0, 4e-3, 4.1, (1, 2, 4, 8)),
    ("beam_fixture", "delaunay", "xi 1", 0.8, 1.9, 2e-3, 4.0, (2, 4, 8)),
    ("beam_fixture", "tlsph", "support 2, psi 1", 1.9, 1.1, 6e-3, 4.0, (2, 4, 8)),
    ("beam_fixture", "fem", "Q2", 0.05, 2.8, 9e-2, 4.0, (1, 2, 4)),
)
BROKEN = ("tlsph", 2)  # method and resolution of a run whose balance does not close
TESTS = (  # label, unit, good, bad, better, digits, note, a value a column or the reason why there is none
    ("stable step over its estimate", "1", 1, 0.5, "high", 2, "least of 200 arrangements", (1.31, 1.12, 0.98, 1.0)),
    ("zero modes beyond rigid", "1", 0, 6, "low", 2, "", (0, 12, 3, 0)),
    ("energy drift over a million steps", "1", 1e-9, 1e-3, "low", 2, "", (2.4e-10, 3.1e-8, 8.8e-5,
     "finite elements of this study run no million steps: they would take 11 hours")),
    ("compression", "%", 80, 20, "high", 2, "how far it goes", (80, 64, 41, 55)),
    ("spread over seeds", "%", 1, 20, "low", 2, "", (0.84, 2.2, None, 0)),
)


def _point(ladder, n):
    scene, method, variant, factor, order, cost, power, _ = ladder
    error, time = factor * n ** -order, cost * n ** power
    out = {"resolution": n, "h": 1 / n, "error": error, "error_min": error, "error_max": error, "time": time,
           "setup_s": 0.2 * time, "wall_s": time, "wall_s_quartiles": [0.96 * time, 1.05 * time], "repeats": 5,
           "memory_mb": 1e-3 * (n + 1) ** 3, "particles": (n + 1) ** 3, "unknowns": 3 * (n + 1) ** 3, "seeds": 1,
           "runs": [f"runs/{scene}-{method}-{n}"], "pareto": False}
    if method == "delaunay":
        out |= {"error_min": 0.9 * error, "error_max": 1.1 * error, "seeds": 3}
    return out | ({"balance": "does not close"} if (method, n) == BROKEN else {})


def ladders(scene):
    """The curves of a scene's plot, and its Pareto front as [[curve, point], ...]."""
    chosen = [l for l in LADDERS if l[0] == scene]
    curves = [{"scene": scene, "method": l[1], "variant": l[2], "points": [_point(l, n) for n in l[-1]]} for l in chosen]
    points = [(p["time"], p["error"], c, k) for c, curve in enumerate(curves) for k, p in enumerate(curve["points"])]
    front = [(t, e, c, k) for t, e, c, k in sorted(points)
             if not any(u <= t and f <= e and (u, f) != (t, e) for u, f, _, _ in points)]
    for _, _, c, k in front:
        curves[c]["points"][k]["pareto"] = True
    return curves, [[c, k] for _, _, c, k in front]


def _at(points, level):
    """What a case needs for an error, by the formats of studies/README.md."""
    last = points[-1]
    if last["error"] > level:
        return {"level": level, "status": "not reached", "finest_error": last["error"], "finest_time": last["time"]}
    if points[0]["error"] <= level:
        return {"level": level, "status": "met by the coarsest", **_needs(points[0], points[0], 0)}
    low, high = next((a, b) for a, b in zip(points, points[1:]) if a["error"] > level >= b["error"])
    share = math.log(low["error"] / level) / math.log(low["error"] / high["error"])
    return {"level": level, "status": "met", **_needs(low, high, share)}


def _needs(low, high, share):
    def between(key): return math.exp((1 - share) * math.log(low[key]) + share * math.log(high[key]))
    out = {key: between(key) for key in ("time", "setup_s", "wall_s", "memory_mb", "resolution")}
    return out | ({"balance": "does not close"} if "balance" in low or "balance" in high else {})


def matched(scenes):
    cases = []
    for scene in scenes:
        here = [{**{k: c[k] for k in ("scene", "method", "variant")}, "at": [_at(c["points"], level) for level in LEVELS]}
                for c in ladders(scene)[0]]
        for k, _ in enumerate(LEVELS):
            times = [c["at"][k]["time"] for c in here if "time" in c["at"][k]]
            for case in here:
                case["at"][k]["fastest"] = bool(times) and case["at"][k].get("time") == min(times)
        cases += here
    return {"title": "Time and memory at one error", "quantity": QUANTITY, "time": "wall_s", "levels": list(LEVELS),
            "cases": cases, "note": "A note of the study.",
            "sentences": ["cube_fixture, 1 %: delaunay (xi 1) is the fastest with 3.05e-03 s; tlsph takes 4.1 times as long."]}


def heatmap():
    columns = [{"label": label, "method": method, "variant": variant} for label, method, variant in (
        ("Delaunay, ξ 1", "delaunay", "xi 1"), ("Delaunay, ξ 0", "delaunay", "xi 0"),
        ("TLSPH, ψ 1", "tlsph", "support 2, psi 1"), ("FEM, Q2", "fem", "Q2"))]
    rows = []
    for label, unit, good, bad, better, digits, note, values in TESTS:
        cells = []
        for column, value in zip(columns, values):
            cell = {"value": None, "score": None, "reason": value if isinstance(value, str) else "no such probe"}
            if isinstance(value, (int, float)):
                along = math.log if good > 0 and bad / good > 100 else float
                score = (along(bad) - along(value or good)) / (along(bad) - along(good))
                cell = {"value": value, "score": min(max(score, 0), 1), "reason": "",
                        "run": f"runs/cube_fixture-{column['method']}-2", "command":
                        f"concord probe spectrum cube --method {column['method']} --resolution 4 --set xi_n=1 --out DIR"}
            if (column["method"], label) == ("tlsph", "compression"):
                cell["balance"] = "does not close"
            cells.append(cell)
        rows.append({"label": label, "unit": unit, "good": good, "bad": bad, "better": better, "scale": "log" if good and bad / good > 100 else "linear",
                     "digits": digits, "note": note, "quantity": "quantities.x", "scene": "cube_fixture",
                     "probe": "spectrum", "cells": cells})
    return {"title": "Stability", "columns": columns, "rows": rows}


def _rows(folder, row):
    rows = []
    for ladder in LADDERS:
        scene, method, variant = ladder[:3]
        for n in ladder[-1]:
            point = _point(ladder, n)
            made = row(scene, method, variant, n, 1, point["error"], point["wall_s"])
            made |= {"run": point["runs"][0], "command": f"concord run {scene} --method {method} --resolution {n}"}
            if "balance" in point:
                made["balance"] = point["balance"]
            (folder / made["run"]).mkdir(parents=True, exist_ok=True)
            if scene == "beam_fixture":
                _signals(made, n, method, variant)
            rows.append(made)
    return rows


def _signals(made, n, method, variant):
    error = (-1 if method == "delaunay" else 1) * 0.2 / n ** 2
    made["signals"] = {"tip": {"column": "tip_z_m", "first_peak": 3.0 * (1 + error), "first_peak_time": 0.5 * (1 - error)}}
    if (method, n) == ("tlsph", 2):
        made["signals"]["tip"]["not_found"] = {"first_peak": "it never turns"}
        del made["signals"]["tip"]["first_peak"]
    if (method, n) == ("fem", 4):
        return
    made["error_sources"] = {
        "tip_peak": {"quantity": "signals.tip.first_peak", "value": 3.0, "reference": "fem (Q2), resolution 4"},
        "tip_peak_time": {"quantity": "signals.tip.first_peak_time", "value": 0.5, "reference": "fem (Q2), resolution 4"}}
    made["errors"] |= {"tip_peak": error, "tip_peak_time": -error}
    if (method, n) == ("tlsph", 2):
        del made["errors"]["tip_peak"]
        made["error_sources"]["tip_peak"]["reason"] = "no signals.tip.first_peak: it never turns"


def work(folder, row, claim):
    plots = []
    for scene in ("cube_fixture", "beam_fixture"):
        curves, front = ladders(scene)
        plots.append({"kind": "work_precision", "quantity": QUANTITY, "time": "wall_s", "scene": scene, "curves": curves,
                      "front": front, "title": f"Work against precision, {scene.split('_')[0]}"})
    return {"title": "Fixture: work and stability", "rows": _rows(folder, row), "plots": plots, "timing": True,
            "matched": [matched(("cube_fixture", "beam_fixture"))], "heatmap": [heatmap()],
            "claims": [claim("faster", "Delaunay over TLSPH at 1 % error", "", 6.2, ">= 5")]}
