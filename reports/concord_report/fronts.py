"""Plots of work against precision: error against run time, a line a case, the Pareto front marked."""

from .balance import SIGN, WORDS
from .digits import duration, exact, grouped, pretty
from .kinds import capital, kind
from .loading import dig, number
from .quantities import axis, name_and_unit

FEM = ("FEM run times are scalar: Debian’s deal.II has no vectorised matrix-free kernels; a native build is "
       "1.5 to 3.5 times faster.")
TIMES = {"wall_s": "run time", "total": "set-up and run time"}


def case_of(cases, entry):
    """The study's case that an entry with scene, method, variant (and probe) means, or None."""
    named = {key: entry.get(key) or "" for key in ("scene", "method", "variant", "probe")}
    return next((c for c in cases if all(getattr(c, key) == value for key, value in named.items())), None)


def fem_note(cases, *told):
    """The remark on run times of finite elements, unless what is told already says so."""
    return FEM if any(c.method == "fem" for c in cases) and not any("scalar" in (t or "") for t in told) else ""


@kind("work_precision")
def work_precision(study, cases, plot):
    labels = _labels(cases, plot)
    curves = [_curve(cases, plot, entry, labels) for entry in plot.get("curves") or []]
    if not any(curves):
        return f"no run of this report has {plot['quantity']} and a run time"
    front = [(curves[c]["x"][p], curves[c]["y"][p]) for c, p in _front(curves, plot)]
    on = [_words(curves[c], p) for c, p in _front(curves, plot)]
    curves = [c for c in curves if c]
    drawn = [case for case in cases if case.index in {c["case"] for c in curves}]
    name = name_and_unit(plot["quantity"])[0]
    note = ["Ringed, on the stepped line: the Pareto front. No other run is both as fast and as accurate." if front else "",
            _absent(plot, labels, cases), plot.get("note"), fem_note(drawn, plot.get("note"))]
    time = TIMES.get(plot.get("time"), TIMES["wall_s"])
    return {"scales": ["log", "log"], "xlabel": f"{time} [s]{_threads(drawn)}", "ylabel": axis(plot["quantity"]),
            "curves": curves, "front": front, "legend": True, "triangles": [],
            "title": plot.get("title") or f"{capital(name)} against {time}",
            "note": " ".join(filter(None, note)),
            "alt": f"Log-log plot of {name} against {time}. Pareto front: {'; '.join(on) or 'none'}."}


def _labels(cases, plot):
    """{number of a case: its label}, without the scene where the plot has but one."""
    found = [case for entry in plot.get("curves") or [] if (case := case_of(cases, entry))]
    scenes = {case.scene for case in found}
    end = ", " + scenes.pop().replace("_", " ") if len(scenes) == 1 else ""
    return {case.index: case.label.removesuffix(end) for case in found}


def _absent(plot, labels, cases):
    """The resolutions that have no point, by their reasons."""
    reasons = {}
    for entry in plot.get("curves") or []:
        case = case_of(cases, entry)
        for told in entry.get("absent") or []:
            who = f"{labels[case.index]} at resolution {exact(told.get('resolution'))}" if case else ""
            reasons.setdefault(told.get("reason") or "no number", []).append(who)
    return " ".join(f"Not drawn: {', '.join(filter(None, who))} ({why})." for why, who in reasons.items())


def _front(curves, plot):
    """(curve, point) of the front in the order of time, as the study found it."""
    return [(c, p) for c, p in plot.get("front") or [] if curves[c] and p < len(curves[c]["x"])]


def _curve(cases, plot, entry, labels):
    """A curve of the plot; None when the case has no point, or is none of this report."""
    case = case_of(cases, entry)
    points = entry.get("points") or []
    if case is None or not points:
        return None
    across, up = (number(plot.get(f"{along}_scale")) or 1.0 for along in "xy")
    whole = plot.get("time") == "total"
    def quartile(point, k):
        ends = point.get("wall_s_quartiles")
        return across * (ends[k] if ends and not whole else point["time"])
    return {"case": case.index, "method": case.method, "style": case.style, "label": labels[case.index],
            "x": [across * p["time"] for p in points], "y": [up * p["error"] for p in points],
            "low": [up * p.get("error_min", p["error"]) for p in points],
            "high": [up * p.get("error_max", p["error"]) for p in points],
            "left": [quartile(p, 0) for p in points], "right": [quartile(p, 1) for p in points],
            "broken": [p.get("balance") == "does not close" for p in points], "slope": None,
            "resolutions": [p.get("resolution") for p in points],
            "tips": [tip(labels[case.index], p, plot["quantity"]) for p in points]}


def _words(curve, point):
    return (f"{curve['label']} at resolution {exact(curve['resolutions'][point])}, {pretty(curve['y'][point], 2)} in "
            f"{pretty(curve['x'][point], 2)} s")


def tip(label, point, quantity):
    """What a reader who points at it is told of a run."""
    name, unit = name_and_unit(quantity)
    lines = [label, f"resolution {exact(point.get('resolution'))}, h = {exact(point.get('h'))} m"]
    size = [f"{grouped(round(point[key]))} {key}" for key in ("particles", "unknowns") if number(point.get(key))]
    lines.append(", ".join(size))
    spread = ""
    if point.get("error_max") != point.get("error_min"):
        spread = f" ({pretty(point['error_min'])} to {pretty(point['error_max'])}, {point.get('seeds')} seeds)"
    lines.append(f"{name} {pretty(point['error'])} {unit}".strip() + spread)
    quartiles = point.get("wall_s_quartiles")
    of = f" (quartiles {duration(quartiles[0])} to {duration(quartiles[1])} of {point.get('repeats')})" if quartiles else ""
    lines.append(f"run time {duration(point.get('wall_s', point['time']))}{of}")
    lines.append(f"set-up {duration(point['setup_s'])}" if number(point.get("setup_s")) is not None else "")
    lines.append(f"memory {pretty(point['memory_mb'])} MB" if number(point.get("memory_mb")) else "")
    lines.append("on the Pareto front" if point.get("pareto") else "")
    lines.append(f"{SIGN} {WORDS}" if point.get("balance") == "does not close" else "")
    return "\n".join(filter(None, lines))


def _threads(cases):
    found = sorted({str(t) for t in (dig(r, "threads") for c in cases for r in c.rows) if t})
    return f", {' or '.join(found)} thread{'s' if found != ['1'] else ''}" if found else ""


