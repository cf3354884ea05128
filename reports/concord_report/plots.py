"""What a study's plots show, as plain data: the drawing itself (draw.py) is cached by it. Here the
plots over spacing and cost; sweeps.py, curves.py and timelines.py have the others."""

import json

from . import balance, cache
from . import curves as _curves  # noqa: F401  (registers its kinds)
from . import fronts as _fronts  # noqa: F401
from . import sweeps as _sweeps  # noqa: F401
from . import timelines as _timelines  # noqa: F401
from .cases import chosen, fit_of
from .digits import pretty
from .kinds import KINDS, capital, curve_of, kind, setting_of, times
from .loading import dig, number
from .palette import look
from .quantities import axis, name_and_unit

__all__ = ["convergence", "cost", "drawn", "plot_specs", "setting_of"]
DIRECT = 9  # at most so many curves are labelled at their ends; the page's key names all
MODULES = ("draw", "draw_labels", "draw_triangles", "draw_map", "draw_inset", "draw_front", "svg", "palette", "digits")


def _against(study, cases, plot, abscissa):
    """Curves of the plot's quantity against `abscissa` (a path), means over seeds with spread."""
    path, curves = plot["quantity"], []
    across, up = (number(plot.get(f"{along}_scale")) or 1.0 for along in "xy")
    for case in chosen(cases, plot):
        points = []
        for level in case.levels:
            x, y = level.mean(abscissa), level.mean(path)
            if x and y and x > 0 and y > 0:
                ends = level.spread(path) or (y, y)
                points.append((across * x, up * y, up * ends[0], up * ends[1], level))
        if not points:
            continue
        fit = fit_of(study, case, path) or {}
        curves.append(curve_of(case, points, case.label, slope=number(fit.get("slope"))))
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
    unit = "m"
    if not number(plot.get("x_scale")) and max(x for c in curves for x in c["x"]) < 0.01:
        curves, unit = times(curves, "x", 1e3), "mm"
    return {"scales": ["log", "log"], "xlabel": f"mean spacing h [{unit}]", "ylabel": axis(plot["quantity"]),
            "curves": curves, "title": plot.get("title") or f"{capital(name)} against spacing",
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
    threads = sorted({str(t) for t in (dig(r, "threads") for c in chosen(cases, plot) for r in c.rows) if t})
    on = f", {' or '.join(threads)} thread{'s' if threads != ['1'] else ''}" if threads else ""
    best = "; ".join(f"{c['label']} {pretty(c['y'][-1], 2)} in {pretty(c['x'][-1], 2)} s" for c in curves)
    return {"scales": ["log", "log"], "xlabel": f"run time [s]{on}", "ylabel": axis(plot["quantity"]),
            "curves": curves, "title": plot.get("title") or f"{capital(name)} against run time",
            "triangles": [], "alt": f"Log-log plot of {name} against run time. Finest: {best}."}


def plot_specs(study, cases):
    """[(plot, specification or text)] in the study's order. An unknown kind is told, not hidden."""
    out = []
    for plot in study.listed("plots"):
        make = KINDS.get(plot.get("kind"))
        if make is None or not any(plot.get(key) for key in ("quantity", "y", "columns")):
            out.append((plot, f"plots of kind {plot.get('kind')!r} are unknown here or name no quantity; "
                              "known: " + ", ".join(sorted(KINDS))))
            continue
        spec = make(study, cases, plot)
        if not isinstance(spec, str):
            _without_scene(spec, cases)
        if not isinstance(spec, str) and (spec.get("broken") or any(any(c.get("broken") or []) for c in spec["curves"])):
            spec["note"] = " ".join(filter(None, (spec.get("note"), f"{balance.SIGN} {balance.WORDS}.")))
        if not isinstance(spec, str):
            spec |= {f"{along}label": plot[f"{along}_label"] for along in "xy" if plot.get(f"{along}_label")}
        out.append((plot, spec))
    return out


def _without_scene(spec, cases):
    """Takes the scene out of the labels of curves that are all of one."""
    lines = [c for c in spec["curves"] if not c.get("points") and not c.get("reference")]
    ends = {f", {case.scene.replace('_', ' ')}" for case in cases if case.scene}
    end = next((e for e in ends if lines and all(c["label"].endswith(e) for c in lines)), None)
    for curve in lines if end else ():
        curve["label"] = curve["label"].removesuffix(end)


def labelled(spec):
    """True for a plot that names its curves itself: it needs no key."""
    return len(spec["curves"]) <= DIRECT or bool(spec.get("legend")) or any(c["case"] < 0 for c in spec["curves"])


def drawn(spec, ident, store):
    """The SVG of a specification, from the cache where it is there."""
    spec = {**spec, "ident": ident, "labelled": labelled(spec)}
    looks = [look(c["method"]) for c in spec["curves"]]
    key = cache.digest(spec, looks, cache.source_digest(*MODULES))
    found = store.get(key, ".svg")
    if found is None:
        from . import draw
        found = draw.draw(json.loads(json.dumps(spec))).encode()
        store.put(key, ".svg", found)
    return found.decode()
