"""Time series from the runs' history.csv: the columns, read."""

import bisect
import csv
import math

from .loading import InputError, number

MOST_POINTS = 600  # of a drawn curve; see thinned()


def read_history(path, column, against=None):
    """(x, values) of one column against another, the time when none is named; InputError for a
    file that is not a table of numbers. None when a column is not there."""
    try:
        with open(path, newline="", encoding="utf-8") as stream:
            lines = csv.reader(stream)
            header = [name.strip() for name in next(lines, [])]
            value = _column(header, column)
            x = _column(header, against) if against else header.index("t_s") if "t_s" in header else 0
            if value is None or x is None:
                return None
            out = []
            for line in lines:
                if len(line) == len(header):  # a last line cut short is left out
                    out.append((float(line[x]), float(line[value])))
    except (OSError, UnicodeDecodeError, ValueError, csv.Error) as error:
        raise InputError(f"{path}: not a table of numbers with one header line: {error}") from error
    return [p[0] for p in out], [p[1] for p in out]


def _column(header, column):
    """Position of "tip_z" or "tip_z_m" in the header, or None."""
    wanted = column.split(".")[-1]
    if wanted in header:
        return header.index(wanted)
    for position, name in enumerate(header):
        if name.startswith(wanted + "_") and name.count("_") - wanted.count("_") == 1:
            return position
    return None


def header_of(study):
    """Column names of the first history.csv of every scene in the study."""
    names, scenes = [], set()
    for row in study.rows:
        if row.get("run") and row.get("scene") not in scenes:
            path = study.folder / row["run"] / "history.csv"
            if path.is_file():
                with open(path, encoding="utf-8", errors="replace") as stream:
                    names += stream.readline().strip().split(",")
                scenes.add(row.get("scene"))
    return names


def thinned(x, y, most=MOST_POINTS):
    """At most `most` points, keeping the smallest and largest value of every stretch."""
    if len(x) <= most:
        return x, y
    size = 2 * len(x) / most
    keep = {0, len(x) - 1}
    for k in range(most // 2):
        stretch = range(int(k * size), min(len(x), max(int((k + 1) * size), int(k * size) + 1)))
        if stretch:
            keep.add(min(stretch, key=lambda i: y[i]))
            keep.add(max(stretch, key=lambda i: y[i]))
    order = sorted(keep)
    return [x[i] for i in order], [y[i] for i in order]


def _read(study, row, column, against=None):
    """Finite pairs of a run's history, or None."""
    if not row.get("run"):
        return None
    path = study.folder / row["run"] / "history.csv"
    if not path.is_file():
        return None
    found = read_history(path, column, against)
    if not found or not found[0]:
        return None
    return [(x, v) for x, v in zip(*found) if number(x) is not None and number(v) is not None]


def share_of(study, row, columns, whole):
    """(times, values) of the sum of `columns` over the last sum of the columns `whole`, thinned. None when
    the run has not all of them, or the whole is 0."""
    parts, all_ = ([_read(study, row, name) for name in names] for names in (columns, whole))
    if not all(parts) or not all(all_) or len({len(p) for p in parts}) > 1:
        return None
    end = sum(part[-1][1] for part in all_)
    if not end:
        return None
    return thinned([t for t, _ in parts[0]], [sum(v) / end for v in zip(*([v for _, v in part] for part in parts))])


def rate(x, y, over):
    """(times, change of y over a window of this width around the time, divided by it); linear between
    samples, only where the whole window lies in the record."""
    def at(t):
        k = min(max(bisect.bisect_left(x, t), 1), len(x) - 1)
        return y[k - 1] + (y[k] - y[k - 1]) * (t - x[k - 1]) / (x[k] - x[k - 1])
    inside = [t for t in x if x[0] <= t - over / 2 and t + over / 2 <= x[-1]] if len(x) > 1 else []
    return inside, [(at(t + over / 2) - at(t - over / 2)) / over for t in inside]


def series_of(study, row, columns, change_from=None, change=False):
    """(times, values) of a column, or of the length of the vector of several, thinned; less its first
    value with `change`, less that at `change_from` and from then on. None when the run has no such column."""
    names = [columns] if isinstance(columns, str) else columns
    parts = [_read(study, row, name) for name in names]
    if not all(parts) or len({len(p) for p in parts}) > 1:
        return None
    if change_from is not None:
        parts = [[p for p in part if p[0] >= change_from * (1 - 1e-9)] for part in parts]
        if not parts[0]:
            return None
    first = [part[0][1] if change or change_from is not None else 0.0 for part in parts]
    values = [[v - zero for _, v in part] for part, zero in zip(parts, first)]
    whole = values[0] if isinstance(columns, str) else [math.hypot(*v) for v in zip(*values)]
    return thinned([t for t, _ in parts[0]], whole)


def pair(study, row, x, y, most):
    """(x values, y values) of column y against column x in the order of the history, thinned to
    about `most` points; a path may turn back (unloading). None when a column is not there."""
    finite = _read(study, row, y, x)
    if not finite:
        return None
    step = max(1, -(-len(finite) // most))
    kept = finite[::step] + ([finite[-1]] if (len(finite) - 1) % step else [])
    return [p[0] for p in kept], [p[1] for p in kept]
