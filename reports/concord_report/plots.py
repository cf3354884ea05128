"""What a study's plots show, as plain data: the drawing itself (draw.py) is cached by it."""

import json
import re

from . import cache
from .cases import chosen, fit_of
from .digits import engineering, pretty
from .histories import history_curves
from .loading import dig, number
from .palette import look
from .quantities import axis, name_and_unit

KINDS = {}
DIRECT = 9  # at most so many curves are labelled at their ends; the page's key names all
MODULES = ("draw", "draw_labels", "draw_triangles", "svg", "palette", "digits")


def kind(name):
    """Registers a function (study, cases, plot) -> specification, or a text: why there is none."""
    def register(function):
        KINDS[name] = function
        return function
    return register


def _curve(case, points, label, **more):
    return {"case": case.index, "method": case.method, "style": case.style, "label": label,
            "x": [p[0] for p in points], "y": [p[1] for p in points], **more}


def _against(study, cases, plot, abscissa):
    """Curves of the plot's quantity against `abscissa` (a path), means over seeds with spread."""
    path, curves = plot["quantity"], []
    for case in cases:
        points = []
        for level in case.levels:
            x, y = level.mean(abscissa), level.mean(path)
            if x and y and x > 0 and y > 0:
                points.append((x, y, *(level.spread(path) or (y, y))))
        if not points:
            continue
        fit = fit_of(study, case, path) or {}
        curves.append(_curve(case, points, case.label, low=[p[2] for p in points],
                             high=[p[3] for p in points], slope=number(fit.get("slope"))))
    return curves


@kind("convergence")
def convergence(study, cases, plot):
    curves = _against(study, cases, plot, "h")
    if not curves:
        return f"no run of this report has {plot['quantity']} and a spacing"
    orders = sorted({s for s in (c["slope"] for c in curves) if s is not None})
    told = "; ".join(f"{c['label']} {pretty(c['slope'])}" for c in curves if c["slope"] is not None)
    name = name_and_unit(plot["quantity"])[0]
    wanted = number(plot.get("slope"))
    return {"scales": ["log", "log"], "xlabel": "mean spacing h [m]", "ylabel": axis(plot["quantity"]),
            "curves": curves, "title": plot.get("title") or f"{_capital(name)} against spacing",
            "note": "Fitted orders in brackets." if orders and len(curves) <= DIRECT else "",
            "triangles": [wanted] if wanted else _nominal(orders),
            "alt": f"Log-log plot of {name} against mean spacing h."
                   + (f" Fitted orders: {told}." if told else "")}


def _nominal(orders):
    """Whole orders near the fitted ones, at most three: the slopes of the triangles."""
    return sorted({float(round(o)) for o in orders if round(o) >= 1})[:3]


@kind("cost")
def cost(study, cases, plot):
    curves = _against(study, cases, plot, "wall_s")
    if not curves:
        return f"no run of this report has {plot['quantity']} and a run time"
    name = name_and_unit(plot["quantity"])[0]
    curves = [{**c, "slope": None} for c in curves]  # an order is against h, not against time
    threads = sorted({str(t) for t in (dig(r, "threads") for c in cases for r in c.rows) if t})
    on = f", {' or '.join(threads)} thread{'s' if threads != ['1'] else ''}" if threads else ""
    best = "; ".join(f"{c['label']} {pretty(c['y'][-1], 2)} in {pretty(c['x'][-1], 2)} s" for c in curves)
    return {"scales": ["log", "log"], "xlabel": f"run time [s]{on}", "ylabel": axis(plot["quantity"]),
            "curves": curves, "title": plot.get("title") or f"{_capital(name)} against run time",
            "triangles": [], "alt": f"Log-log plot of {name} against run time. Finest: {best}."}


@kind("history")
def history(study, cases, plot):
    column = plot["quantity"]
    curves, note = history_curves(study, cases, plot)
    if isinstance(curves, str):
        return curves
    name, unit = name_and_unit(column)
    curves, times = _scaled(curves, "x", "s")
    curves, unit = _scaled(curves, "y", unit)
    ends = "; ".join(f"{c['label']} from {pretty(min(c['y']))} to {pretty(max(c['y']))}" for c in curves)
    ends += f" {unit}" if unit else ""
    return {"scales": ["linear", "linear"], "xlabel": f"time [{times}]",
            "ylabel": f"{name} [{unit}]" if unit else name,
            "curves": curves, "title": plot.get("title") or f"{_capital(name)} over time",
            "note": note, "triangles": [], "alt": f"Plot of {name} over time. Ranges: {ends}."}


def _scaled(curves, along, unit):
    """(curves, unit) with values that read well: 0.0005 m becomes 0.5 mm."""
    factor, unit = engineering(max(abs(v) for c in curves for v in c[along]), unit)
    return [{**c, along: [v * factor for v in c[along]]} for c in curves], unit


def setting_of(row, key):
    """(number, unit text) of a setting: a field of the row, of its settings, or a word of its
    variant ("support 3, psi 0.1"); None when the row does not tell."""
    short = key.split(".")[-1]
    places = [row] + [row[k] for k in ("settings", "scene_settings", "set", "scene_set", "parameters")
                      if isinstance(row.get(k), dict)]
    for place in places:
        for name in (key, short):
            found = place.get(name) if name in place else dig(place, name)
            if number(found) is not None:
                return number(found), ""
            if isinstance(found, str):
                return _quantity(found)
    name = re.escape(short)
    match = re.search(rf"(?:^|[\s,]){name}(?:_\w)?[\s=]+([^,]+)", row.get("variant") or "")
    return _quantity(match[1]) if match else None


def _quantity(words):
    match = re.match(r"\s*([-+]?[\d.]+(?:[eE][-+]?\d+)?)\s*([^\d\s].*)?$", words)
    return (float(match[1]), (match[2] or "").strip()) if match else None


@kind("sweep")
def sweep(study, cases, plot):
    path, key = plot["quantity"], plot.get("setting")
    if not key:
        return "the plot names no setting"
    groups, units = {}, set()
    for case in cases:
        level = _level(case, plot)
        found = setting_of(level.rows[0], key) if level else None
        if not found or level.mean(path) is None:
            continue
        units.add(found[1])
        y = level.mean(path)
        rest = _without(case.label, key)
        groups.setdefault(rest, []).append((found[0], y, *(level.spread(path) or (y, y)), case))
    curves = [_sweep_curve(label, points, index) for index, (label, points) in enumerate(groups.items())]
    if not curves:
        return f"no run of this report tells {path} and the setting {key}"
    unit = next(iter(units)) if len(units) == 1 else ""
    short = _words_of(key)
    name = name_and_unit(path)[0]
    xs = [x for c in curves for x in c["x"]]
    ys = [v for c in curves for v in c["low"]]
    def wide(v): return "log" if min(v) > 0 and max(v) / min(v) > 15 else "linear"
    told = "; ".join(f"{c['label']} smallest {pretty(min(c['y']))} at {pretty(c['x'][c['y'].index(min(c['y']))])}"
                     for c in curves)
    return {"scales": [wide(xs), wide(ys)], "xlabel": f"{short} [{unit}]" if unit else short,
            "ylabel": axis(path), "curves": curves, "triangles": [],
            "title": plot.get("title") or f"{_capital(name)} against {short}",
            "alt": f"Plot of {name} against {short}. {told}."}


def _sweep_curve(label, points, index):
    points.sort(key=lambda p: p[0])
    case = points[-1][4]
    same = [p for p in points if p[4].method == case.method]
    curve = _curve(case, same, label, low=[p[2] for p in same], high=[p[3] for p in same], slope=None)
    return {**curve, "case": -1 - index, "style": index}


def _words_of(key):
    short = key.split(".")[-1]
    return name_and_unit(short)[0]


def _without(label, key):
    """The case's label less the words that tell the setting."""
    short = _words_of(key)
    out = re.sub(rf"(?:,\s*)?\b{re.escape(short)}[\s=]+[^,]+", "", label)
    return re.sub(r"^\s*,\s*|\s*,\s*$", "", out).strip() or label


def _level(case, plot):
    wanted = number(plot.get("resolution"))
    if wanted is None:
        return case.levels[-1] if case.levels else None
    return next((level for level in case.levels if level.resolution == wanted), None)


def _capital(words):
    return words[:1].upper() + words[1:]


def plot_specs(study, cases):
    """[(plot, specification or text)] in the study's order. An unknown kind is told, not hidden."""
    out = []
    for plot in study.listed("plots"):
        make = KINDS.get(plot.get("kind"))
        if make is None or not plot.get("quantity"):
            out.append((plot, f"plots of kind {plot.get('kind')!r} are unknown here; known: "
                              + ", ".join(sorted(KINDS))))
            continue
        out.append((plot, make(study, chosen(cases, plot), plot)))
    return out


def drawn(spec, ident, store):
    """The SVG of a specification, from the cache where it is there."""
    labelled = len(spec["curves"]) <= DIRECT or any(c["case"] < 0 for c in spec["curves"])
    spec = {**spec, "ident": ident, "labelled": labelled}
    looks = [look(c["method"]) for c in spec["curves"]]
    key = cache.digest(spec, looks, cache.source_digest(*MODULES))
    found = store.get(key, ".svg")
    if found is None:
        from . import draw
        found = draw.draw(json.loads(json.dumps(spec))).encode()
        store.put(key, ".svg", found)
    return found.decode()
