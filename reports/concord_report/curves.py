"""Plots of one history column against another: one line a run, such as a stress-strain curve."""

from .balance import broken
from .cases import chosen, variant_text
from .digits import exact, grouped, pretty
from .histories import pair
from .kinds import capital, kind, scaled
from .loading import number
from .palette import DASHES
from .quantities import name_and_unit

FINE = 240  # points of a drawn curve
MARKS = 4  # markers on a line


@kind("curve")
def curve(study, cases, plot):
    columns = [plot.get("x"), plot.get("y") or plot.get("quantity")]
    if None in columns:
        return "the plot names no columns x and y"
    wanted = plot.get("resolutions") or ([plot["resolution"]] if plot.get("resolution") else [])
    lines, styles = [], {}
    for case in chosen(cases, plot):
        levels = [l for l in case.levels if not wanted or any(near(l.resolution, w) for w in wanted)]
        for rank, level in enumerate(reversed(levels)):  # 0 for the finest
            found = next(filter(None, (_line(study, row, columns) for row in level.rows)), None)
            if not found:
                continue
            x, y, row = found
            style = styles.setdefault((case.method, case.variant, case.scene), len(styles))
            round_ = style // len(DASHES)  # when all dashes are used up, paler ones follow
            lines.append({"case": -1 - len(lines), "method": case.method, "dash": style, "style": style,
                          "fade": max(0.35, 1 - 0.4 * round_), "x": x, "y": y, "rank": rank,
                          "label": run_label(case, level, row, len(levels) > 1), "low": None, "high": None, "slope": None, "broken": [broken(row)]})
    lines += [line for entry in entries(plot, "baseline") for line in _compared(study, cases, entry, columns, len(lines))]
    if not lines:
        return f"no history.csv of this report has the columns {columns[0]} and {columns[1]}"
    zero = ""
    if plot.get("log"):
        lines, zero = magnitudes(lines)
        if not lines:
            return f"on a logarithmic axis: {zero}"
    _mark(lines)
    lines, labels = _in_units(lines, plot, columns)
    ends = "; ".join(f"{c['label']} ends at {pretty(c['x'][-1])}, {pretty(c['y'][-1])}" for c in lines)
    inset = _window(plot.get("inset"), lines)
    return {"scales": ["linear", "log" if plot.get("log") else "linear"], "xlabel": labels[0], "ylabel": labels[1],
            "curves": lines + published(plot),
            "title": plot.get("title") or f"{capital(_name(labels[1]))} against {_name(labels[0])}",
            "note": " ".join(filter(None, (
                "The stronger the line, the finer the run." if any(c["rank"] for c in lines) else "", zero,
                "No curve passes through the window of the inset." if plot.get("inset") and not inset else ""))),
            "inset": inset, "legend": True,
            "triangles": [], "alt": f"Plot of {labels[1]} against {labels[0]}. {ends}."}


def entries(plot, key):
    """The entries of a plot's list, which may be a single one."""
    wanted = plot.get(key) or []
    return [wanted] if isinstance(wanted, dict) else wanted


def _compared(study, cases, entry, columns, drawn):
    """Runs to compare with, broad and pale: the finest of each case, or the one at the entry's resolution."""
    out = []
    for case in chosen(cases, entry):
        levels = [l for l in case.levels if not entry.get("resolution") or near(l.resolution, entry["resolution"])]
        found = next(filter(None, (_line(study, row, columns) for l in levels[::-1] for row in l.rows)), None)
        if found:
            out.append({"case": -1 - drawn - len(out), "method": case.method, "dash": 0, "style": 0, "x": found[0], "y": found[1],
                        "rank": 0, "label": variant_text(entry.get("label")) or case.label, "reference": True, "low": None,
                        "high": None, "slope": None, "broken": [broken(found[2])]})
    return out


def published(plot):
    """Values that a source gives, in the units drawn: markers without a line."""
    return [{"case": -1001 - k, "method": "", "style": k, "x": p["x"], "y": p["y"], "label": variant_text(p["label"]),
             "points": True, "low": None, "high": None, "slope": None, "broken": []}
            for k, p in enumerate(entries(plot, "points"))]


def magnitudes(lines):
    """(the curves' absolute values, less those that are 0, which no logarithmic axis has; a sentence
    that names the curves that are 0 throughout)."""
    out, gone = [], []
    for line in lines:
        kept = [(x, abs(y)) for x, y in zip(line["x"], line["y"]) if y]
        if kept:
            out.append({**line, "x": [x for x, _ in kept], "y": [y for _, y in kept]})
        else:
            gone.append(line["label"])
    return out, f"{' and '.join(gone)}: 0 throughout." if gone else ""


def _window(wanted, lines):
    """[x range, y range] of the inset; a range left out is that of the curves in the other one. None
    when nothing is wanted, or no curve passes."""
    if not wanted:
        return None
    def inside(value, along): return along not in wanted or wanted[along][0] <= value <= wanted[along][1]
    seen = [(x, y) for c in lines for x, y in zip(c["x"], c["y"]) if inside(x, "x") and inside(y, "y")]
    if not seen:
        return None
    out = []
    for k, along in enumerate("xy"):
        values = wanted.get(along) or [min(p[k] for p in seen), max(p[k] for p in seen)]
        if not values[0] < values[1]:
            return None
        room = 0 if along in wanted else 0.06 * (values[1] - values[0])
        out.append([values[0] - room, values[1] + room])
    return out


def _mark(lines):
    """Gives the finest line of each case a few markers, at places that no other line has, when several
    cases share a method's colour."""
    finest = [c for c in lines if c["rank"] == 0 and not c.get("reference")]
    if len(finest) == len({c["method"] for c in finest}):
        return
    for number, line in enumerate(finest):
        count = len(line["x"])
        line["marks"] = sorted({round((k + (number + 0.5) / len(finest)) * (count - 1) / MARKS) for k in range(MARKS)})


def near(a, b):
    """Resolutions are written with few digits: 72.7273 is 40/0.55."""
    return number(b) is not None and abs(a - b) <= 1e-4 * abs(b)


def _line(study, row, columns):
    return (*found, row) if (found := pair(study, row, *columns, FINE)) else None


def run_label(case, level, row, several):
    """The case and, when there are several levels, how large the run was."""
    if not several:
        return case.label
    if case.method == "fem" and row.get("unknowns"):
        return f"{case.label}, {grouped(row['unknowns'])} unknowns"
    if row.get("particles"):
        return f"{case.label}, {grouped(row['particles'])} particles"
    return f"{case.label}, L/{exact(level.resolution)}"


def _in_units(lines, plot, columns):
    """(curves, axis labels): the author's factors and labels, else units that read well."""
    labels = []
    for along, column in zip("xy", columns):
        factor = number(plot.get(f"{along}_scale"))
        name, unit = name_and_unit(f"quantities.{column}")  # the header tells a unit left out here
        if factor is not None:
            lines = [{**c, along: [v * factor for v in c[along]]} for c in lines]
            unit = "" if factor != 1 else unit
        else:
            lines, unit = scaled(lines, along, unit)
        labels.append(plot.get(f"{along}_label") or (f"{name} [{unit}]" if unit else name))
    return lines, labels


def _name(label):
    return label.split(" [")[0]
