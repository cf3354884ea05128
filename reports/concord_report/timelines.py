"""Plots of columns of history.csv over time: one of many runs, or several of a few."""

from . import curves as lines
from .balance import broken
from .cases import chosen, variant_text
from .digits import pretty
from .histories import rate, series_of, share_of
from .kinds import capital, kind, scaled, time_name, times
from .loading import number
from .palette import BALANCES, COLUMNS, DASHES
from .quantities import name_and_unit

FEW = 3  # runs that dashes tell apart
MOST_RUNS = 12  # of one column; beyond that only the finest level of each case is drawn
MEANT = {"J": "energy", "kg m/s": "momentum", "kg m²/s": "angular momentum", "N": "force", "m": "length"}


@kind("history")
def history(study, cases, plot):
    columns = plot.get("columns") or [plot["quantity"]]
    units = {_unit(name_and_unit(column)[1], plot) for column in columns}
    if len(units) > 1:
        return f"the columns {', '.join(columns)} have several units ({', '.join(sorted(units))})"
    one = plot.get("norm") or plot.get("share_of")  # of several columns one line
    several = len(columns) > 1 and not one
    runs, note = _picked(chosen(cases, plot), plot, several)
    wanted = columns if several else [tuple(columns) if one else columns[0]]
    found = _several_columns(study, runs, wanted, plot) if several else _one_column(study, runs, wanted[0], plot)
    missing = [c for c in columns if several and not any(line["column"] == c for line in found)]
    found += [line for entry in lines.entries(plot, "baseline") for line in _compared(study, cases, entry, wanted, plot)]
    if not found:
        return f"no history.csv of this report has the column {' or '.join(columns)}"
    if plot.get("log"):
        found, zero = lines.magnitudes(found)
        note = f"{note} {zero}".strip()
        if not found:
            return f"on a logarithmic axis: {zero}"
    rows = [c.pop("row") for c in found]
    if any(c.get("rank") for c in found):
        note = f"{note} The stronger the line, the finer the run.".strip()
    if missing:
        note = f"{note} No run has {' or '.join(name_and_unit(c)[0] for c in missing)}.".strip()
    spec = _axes(plot, found, rows, columns, units.pop())
    spec["curves"] += lines.published(plot)
    return spec | {"note": note, "legend": several or len(found) > 4 or any("dash" in c for c in spec["curves"])}


def _axes(plot, found, rows, columns, unit):
    over = time_name(rows)
    seconds = "s" if over == "time" else "s for explicit runs" if "time" in over else ""
    if number(plot.get("x_scale")):
        found, seconds = times(found, "x", plot["x_scale"]), ""
    elif seconds == "s":
        found, seconds = scaled(found, "x", "s")
    if number(plot.get("y_scale")):
        found, unit = times(found, "y", plot["y_scale"]), ""
    elif not plot.get("log"):
        found, unit = scaled(found, "y", unit)
    name = _shared_name(columns)
    if plot.get("change") or number(plot.get("change_from")) is not None:
        name = f"change of {name}"
    name = f"share of {name}" if plot.get("share_of") else f"rate of {name}" if plot.get("rate_over") else name
    if plot.get("log"):
        name = f"size of {name}" if not name.startswith("change") else f"size of the {name}"
    ends = "; ".join(f"{c['label']} from {pretty(min(c['y']))} to {pretty(max(c['y']))}" for c in found)
    ends += f" {unit}" if unit else ""
    return {"scales": ["linear", "log" if plot.get("log") else "linear"], "xlabel": f"{over} [{seconds}]" if seconds else over,
            "ylabel": plot.get("y_label") or (f"{name} [{unit}]" if unit else name), "triangles": [],
            "curves": [{k: v for k, v in c.items() if k != "column"} for c in found],
            "title": plot.get("title") or f"{capital(name)} over {over}",
            "alt": f"Plot of {name} over {over}. Ranges: {ends}."}


def _shared_name(columns):
    """"energy" for the kinetic and the internal one, "linear momentum" for its components."""
    names = [name_and_unit(c)[0].split() for c in columns]
    if len(names) == 1:
        return " ".join(names[0])
    shortest = min(map(len, names))
    for size in range(shortest, 0, -1):
        for part in (slice(None, size), slice(-size, None)):
            if len({tuple(n[part]) for n in names}) == 1:
                return " ".join(names[0][part])
    return MEANT.get(name_and_unit(columns[0])[1], "value")


def _picked(cases, plot, several=False):
    """([(case, level, number of the level's rank from the finest, how many of the case)], note)."""
    wanted = plot.get("resolutions") or ([plot["resolution"]] if number(plot.get("resolution")) else [])
    picked = [(case, [l for l in case.levels[::-1] if not wanted or any(lines.near(l.resolution, w) for w in wanted)])
              for case in cases]
    note = ""
    if sum(len(levels) for _, levels in picked) > MOST_RUNS or several and not wanted:
        if any(len(levels) > 1 for _, levels in picked):
            note = "Finest level of each case."
        picked = [(case, levels[:1]) for case, levels in picked]
    return [(case, level, rank, len(levels)) for case, levels in picked for rank, level in enumerate(levels)], note


def _line(study, case, level, column, plot, **more):
    """The column, or the length of the vector of several, of the level's first run that has it, or None."""
    row, series = next(((r, s) for r in level.rows if (s := _series(study, r, column, plot))), (None, None))
    if not series:
        return None
    return {"case": case.index, "method": case.method, "style": case.style, "x": series[0], "y": series[1],
            "low": None, "high": None, "slope": None, "broken": [broken(row)], "row": row, "column": column, **more}


def _series(study, row, column, plot):
    """What the plot makes of a run's column or columns, or None."""
    if plot.get("share_of"):
        return share_of(study, row, column, plot["share_of"])
    series = series_of(study, row, column, number(plot.get("change_from")), plot.get("change"))
    over = number(plot.get("rate_over"))
    return series if not series or over is None else rate(*series, over)


def _unit(unit, plot):
    return "" if plot.get("share_of") else f"{unit}/s" if plot.get("rate_over") else unit


def _one_column(study, runs, column, plot):
    """Hue by method; dashes by variant, or by level where there is but one case. Many variants of one method, a run
    each, have hues of their own: dashes alone do not tell so many apart."""
    order = list(dict.fromkeys(case.index for case, *_ in runs))
    alone = len(order) == 1
    own = len(order) == len(runs) > FEW and len({case.method for case, *_ in runs}) == 1
    out = []
    for case, level, rank, count in runs:
        more = {"dash": rank, "fade": 1 + 0.3 * rank} if alone and count > 1 else {}
        if own:
            place = order.index(case.index)
            more = {"hue": COLUMNS[place % len(COLUMNS)], "dash": place // len(COLUMNS)}
        line = _line(study, case, level, column, plot, rank=rank, label=_run(case, level, count > 1), **more)
        out += [line] if line else []
    return out


def _run(case, level, several):
    row = next((r for r in level.rows if not r.get("error")), level.rows[0])
    return lines.run_label(case, level, row, several)


def _several_columns(study, runs, columns, plot):
    """Hue by column, dashes by run."""
    out, hues = [], {}
    for column in columns:
        zero = column.startswith("energy_balance")
        hues[column] = BALANCES if zero else COLUMNS[len([h for h in hues.values() if h != BALANCES]) % len(COLUMNS)]
    for number_, (case, level, _, count) in enumerate(runs):
        for column in columns:
            label = name_and_unit(column)[0]
            label = f"{label}, {_run(case, level, count > 1)}" if len(runs) > 1 else label
            line = _line(study, case, level, column, plot, label=label, hue=hues[column], dash=number_ % len(DASHES))
            out += [{**line, "case": -1 - len(out)}] if line else []
    return out


def _compared(study, cases, entry, columns, plot):
    """Runs to compare with: the finest of each case, or the one at the entry's resolution."""
    out = []
    for case, level, _, _ in _picked(chosen(cases, entry), entry, True)[0]:
        label = variant_text(entry.get("label")) or case.label
        line = _line(study, case, level, entry.get("quantity") or columns[0], plot, label=label, reference=True, dash=0)
        out += [line] if line else []
    return out
