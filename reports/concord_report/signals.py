"""The table of signals: what was drawn from histories, and the errors of it, at each resolution."""

from .digits import DASH, MINUS, plain
from .loading import number
from .palette import swatch
from .quantities import learned_unit, words
from .tables import balance_column, number_column, spacing_column, table, text_column

TIMES = ("first_peak_time", "period")  # features in s, whatever the column's unit
NONE = ("relative_change",)  # and without any


def signals_table(cases):
    """Values of signals with their errors beside them, a line a level; None when there are none."""
    pairs = [(c, l) for c in cases for l in c.levels if any(r.get("signals") or r.get("error_sources") for r in l.rows)]
    if not pairs:
        return None
    rows = [r for _, l in pairs for r in l.rows]
    errors = _errors(rows)
    columns, used = [], set()
    for path, label in _features(rows):
        columns.append(number_column(label, [l.mean(path) for _, l in pairs], 4))
        for name, of in errors.items():
            if of == path:
                columns.append(_error_column("its error [%]", name, pairs))
                used.add(name)
    for name, of in errors.items():
        if name not in used:
            columns.append(_error_column(f"error of {words(name)} [%]", name, pairs))
    columns.append(balance_column([l.rows for _, l in pairs]))
    head = [text_column("case", [c.label for c, _ in pairs], head=True, marks=[swatch(c.method, c.style) for c, _ in pairs]),
            spacing_column([l for _, l in pairs])]
    seeds = {len(l.rows) for _, l in pairs}
    if seeds != {1}:
        head.append(number_column("seeds", [len(l.rows) for _, l in pairs]))
    return table("Signals and their errors", [*head, *columns], _note(rows, pairs, seeds))


def _features(rows):
    """[(path, label with unit)] in the order of the rows."""
    out = {}
    for row in rows:
        for name, told in (row.get("signals") or {}).items():
            for feature, value in told.items():
                if number(value) is None:
                    continue
                unit = "s" if feature in TIMES else "" if feature in NONE else \
                    learned_unit(told["column"]) if told.get("column") else ""
                label = f"{words(name)}, {words(feature)}"
                out.setdefault(f"signals.{name}.{feature}", f"{label} [{unit}]" if unit else label)
    return list(out.items())


def _errors(rows):
    """{name: path of what it is an error of, or ""} in the order of the rows."""
    out = {}
    for row in rows:
        for name, source in (row.get("error_sources") or {}).items():
            out.setdefault(name, source.get("quantity") or "")
    return out


def _error_column(label, name, pairs):
    """Per cent, with a sign where the study keeps signs; of several seeds the one that is farthest off."""
    worst = [max(l.values(f"errors.{name}"), key=abs, default=None) for _, l in pairs]
    signed = any(v is not None and v < 0 for v in worst)
    return number_column(label, [v if v is None else 100 * v for v in worst], texts=[per_cent(v, signed) for v in worst])


def per_cent(value, signed=True):
    """"+1.25", "−0.040": an error in per cent, three digits above a hundredth."""
    if value is None:
        return DASH
    size = abs(100 * value)
    text = plain(size, 3) if size >= 0.1 else f"{size:.3f}" if size >= 5e-4 else "0.000"
    sign = "" if not signed or text == "0.000" else "+" if value > 0 else MINUS
    return sign + text


def _note(rows, pairs, seeds):
    out = ["Errors are relative, in per cent; with a sign: above zero where the value is too large."]
    if seeds != {1}:
        out.append("Values are means over the seeds, errors those of the seed that is farthest off.")
    against = dict.fromkeys(s["reference"] for r in rows for s in (r.get("error_sources") or {}).values() if s.get("reference"))
    if against:
        out.append(f"Compared with {'; '.join(against)}.")
    if any(s.get("balance") for r in rows for s in (r.get("error_sources") or {}).values()):
        out.append("The energy balance of a reference does not close.")
    reasons = {}
    for case, level in pairs:
        for row in level.rows:
            for told in (row.get("signals") or {}).values():
                for feature, why in (told.get("not_found") or {}).items():
                    reasons.setdefault(f"no {words(feature)}: {why}", []).append(case.label)
    out += [f"{'; '.join(dict.fromkeys(who))}: {what}." for what, who in reasons.items()]
    return " ".join(out)
