"""Plots of a quantity against settings: curves over one (with baselines), a map over two."""

import math

from .cases import chosen, variant_text
from .digits import exact, pretty
from .kinds import capital, curve_of, kind, level_of, scale_of, setting_of, without, words_of
from .loading import number
from .quantities import axis, name_and_unit


def _factor(plot):
    return number(plot.get("y_scale")) or 1.0


def _pooled(entries, factor):
    """(mean, low, high) over all runs of the levels that share a place."""
    values = [v * factor for path, level in entries for v in level.values(path)]
    return sum(values) / len(values), min(values), max(values)


class _Rows:
    """Levels that share a place of a plot, seen as one."""

    def __init__(self, levels):
        self.rows = [row for level in levels for row in level.rows]


def _places(cases, plot, keys):
    """({rest of the label: {settings: [(path, level), ...]}}, {key: units}, {rest: case})."""
    groups, units, first = {}, {key: set() for key in keys}, {}
    for case in chosen(cases, plot):
        level = level_of(case, plot)
        found = [setting_of(level.rows[0], key) if level else None for key in keys]
        if None in found or not level.values(plot["quantity"]):
            continue
        for key, (_, unit) in zip(keys, found):
            units[key].add(unit)
        rest = without(case.label, *keys) or case.label
        place = tuple(value for value, _ in found)
        groups.setdefault(rest, {}).setdefault(place, []).append((plot["quantity"], level))
        first.setdefault(rest, case)
    return groups, units, first


def _setting_label(plot, along, key, units):
    short, unit = words_of(key), next(iter(units)) if len(units) == 1 else ""
    return plot.get(f"{along}_label") or (f"{short} [{unit}]" if unit else short)


@kind("sweep")
def sweep(study, cases, plot):
    key = plot.get("setting")
    if not key:
        return "the plot names no setting"
    groups, units, first = _places(cases, plot, [key])
    if not groups:
        return f"no run of this report tells {plot['quantity']} and the setting {key}"
    curves = []
    for index, (rest, places) in enumerate(groups.items()):
        points = [(place[0], *_pooled(levels, _factor(plot)), _Rows([l for _, l in levels]))
                  for place, levels in sorted(places.items(), key=lambda p: p[0])]
        curves.append({**curve_of(first[rest], points, rest), "case": -1 - index, "style": index})
    xs = [x for c in curves for x in c["x"]]
    positive = [x for x in xs if x > 0]
    broken_off = scale_of(positive) == "log" and min(xs) == 0  # a log axis has no place for 0
    lines, missing = _baselines(cases, plot, (min(xs), max(xs)), len(curves))
    name = name_and_unit(plot["quantity"])[0]
    short = words_of(key)
    told = "; ".join(f"{c['label']} smallest {pretty(min(c['y']))} at {pretty(c['x'][c['y'].index(min(c['y']))])}"
                     for c in curves)
    told += "".join(f"; {c['label']} {pretty(c['y'][0])}" for c in lines)
    several = any(a != b for c in curves + lines for a, b in zip(c["low"], c["high"]))
    note = "Means; bars and bands span all runs of a setting." if several else ""
    return {"scales": ["log" if broken_off else scale_of(xs), scale_of([v for c in curves + lines for v in c["low"]])],
            "xlabel": _setting_label(plot, "x", key, units[key]),
            "ylabel": plot.get("y_label") or axis(plot["quantity"]), "curves": curves + lines, "triangles": [],
            "zero_apart": broken_off, "from_zero": True, "note": " ".join(filter(None, (note, missing))),
            "title": plot.get("title") or f"{capital(name)} against {short}",
            "alt": f"Plot of {name} against {short}. {told}."}


def _baselines(cases, plot, span, count):
    """(horizontal lines of the selected cases' values, what could not be drawn)."""
    wanted = plot.get("baseline") or []
    lines, missing = [], []
    for entry in [wanted] if isinstance(wanted, dict) else wanted:
        path = entry.get("quantity") or plot["quantity"]
        found = chosen(cases, entry)
        levels = [(case, level_of(case, {"resolution": entry.get("resolution", plot.get("resolution"))}))
                  for case in found]
        levels = [(case, level) for case, level in levels if level and level.values(path)]
        if not levels:
            who = " ".join(str(entry[k]) for k in ("method", "variant", "scene") if entry.get(k))
            missing.append(f"No baseline {who or '(empty selection)'}: no such run has a value.")
        for case, level in levels:
            pooled = _pooled([(path, level)], _factor(plot))
            points = [(x, *pooled, level) for x in span]
            lines.append({**curve_of(case, points, variant_text(entry.get("label")) or case.label),
                          "case": -1 - count - len(lines), "baseline": True, "style": case.style})
    return lines, " ".join(missing)


@kind("map")
def heat_map(study, cases, plot):
    """Cells of a quantity over two settings; a map a variant-without-the-settings."""
    keys = [plot.get("setting"), plot.get("setting_y")]
    if None in keys or "" in keys:
        return "the plot needs setting and setting_y"
    groups, units, _ = _places(cases, plot, keys)
    if not groups:
        return f"no run of this report tells {plot['quantity']} and the settings {keys[0]} and {keys[1]}"
    factor, label = _map_scale(plot, groups)
    maps = [_map(rest, places, factor, len(groups) > 1) for rest, places in groups.items()]
    values = [v for m in maps for line in m["values"] for v in line if v is not None]
    name = name_and_unit(plot["quantity"])[0]
    short = [words_of(key) for key in keys]
    told = "; ".join(f"{m['title'] + ' ' if m['title'] else ''}smallest {m['least'][2]} at {short[0]} "
                     f"{m['x'][m['least'][1]]}, {short[1]} {m['y'][m['least'][0]]}" for m in maps)
    several = any(len([v for _, l in ls for v in l.rows]) > 1 for g in groups.values() for ls in g.values())
    return {"map": maps, "curves": [], "limits": [min(values), max(values)], "scale": scale_of(values),
            "xlabel": _setting_label(plot, "x", keys[0], units[keys[0]]),
            "ylabel": _setting_label(plot, "y", keys[1], units[keys[1]]), "label": label,
            "title": plot.get("title") or f"{capital(name)} over {short[0]} and {short[1]}",
            "note": "The smallest value is framed." + (" Means over the runs of a cell." if several else ""),
            "broken": any(any(line) for m in maps for line in m["broken"]),
            "alt": f"Map of {name} over {short[0]} and {short[1]}. {told}."}


def _map_scale(plot, groups):
    """(factor, what the numbers are): relative errors are shown in per cent."""
    name, unit = name_and_unit(plot["quantity"])
    if number(plot.get("y_scale")):
        return number(plot["y_scale"]), plot.get("label") or name
    values = [v for g in groups.values() for ls in g.values() for p, l in ls for v in l.values(p)]
    if not unit and plot["quantity"].startswith("errors.") and max(map(abs, values)) < 10:
        return 100.0, f"{name} [%]"
    return 1.0, f"{name} [{unit}]" if unit else name


def _map(rest, places, factor, titled):
    xs, ys = (sorted({place[k] for place in places}) for k in (0, 1))
    values, broken = ([[None] * len(xs) for _ in ys] for _ in range(2))
    for (x, y), levels in places.items():
        row, column = ys.index(y), xs.index(x)
        values[row][column] = _pooled(levels, factor)[0]
        broken[row][column] = any(r.get("balance") == "does not close" for _, l in levels for r in l.rows)
    known = [(v, i, j) for i, line in enumerate(values) for j, v in enumerate(line) if v is not None]
    value, i, j = min(known)
    return {"title": rest if titled else "", "x": [exact(x) for x in xs], "y": [exact(y) for y in ys],
            "values": values, "texts": [[_cell(v) for v in line] for line in values],
            "broken": [[bool(b) for b in line] for line in broken], "least": [i, j, _cell(value)]}


def _cell(value):
    """Three digits at most, no more than two decimals: a cell is small."""
    if value is None:
        return "–"
    if value and not 0.01 <= abs(value) < 1e4:
        return pretty(value, 2)
    size = math.floor(math.log10(abs(value))) if value else 0
    return f"{value:.{max(0, min(2, 2 - size))}f}".replace("-", "−")
