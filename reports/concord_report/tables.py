"""The tables of a study, as plain data for the template: captions, columns, cells that line up."""

from .balance import NOTE, any_broken, how_many, state
from .cases import fit_of, local_orders
from .digits import DASH, between, column, exact_column, takes_powers
from .kinds import time_name
from .loading import dig, number
from .palette import swatch
from .quantities import axis, name_and_unit


ENDS = {"time": "end [s]", "load parameter t": "end t", "load parameter t, or time": "end (t, or time [s])"}
FOLD_FROM = 30  # lines: a longer table is folded up


def text_column(label, texts, head=False, marks=None):
    """A column of words; `head` makes its cells row headers, `marks` are drawings before them."""
    marks = marks or [""] * len(texts)
    cells = [{"text": t or DASH, "value": t or "", "mark": m, "badge": False} for t, m in zip(texts, marks)]
    return {"label": label, "kind": "head" if head else "text", "cells": cells}


def balance_column(groups, word=how_many):
    """A badge where the energy balance of a line's runs does not close; None when all close, or
    none has one. `word` makes the text of a line's rows."""
    if not any(map(any_broken, groups)):
        return None
    cells = [{"text": word(rows), "value": word(rows), "mark": "", "badge": any_broken(rows)} for rows in groups]
    return {"label": "energy balance", "kind": "text", "cells": cells}


def number_column(label, values, digits=3, texts=None):
    """A column of numbers in one notation. None when every value is missing."""
    if all(number(v) is None for v in values):
        return None
    texts = texts or column(values, digits)
    cells = [{"text": t, "value": number(v), "mark": ""} for t, v in zip(texts, values)]
    return {"label": label, "kind": "number", "cells": cells}


def table(caption, columns, note=""):
    """Columns that are None are left out: a column with nothing in it tells nothing."""
    columns = [c for c in columns if c]
    rows = list(zip(*[c["cells"] for c in columns]))
    starts = [i == 0 or row[0]["text"] != rows[i - 1][0]["text"] for i, row in enumerate(rows)]
    grouped = sum(starts) < len(rows)
    if any(cell.get("badge") for row in rows for cell in row):
        note = f"{note} {NOTE}".strip()
    return {"caption": caption, "columns": columns, "note": note, "rows": rows, "fold": len(rows) > FOLD_FROM,
            "starts": [grouped and s for s in starts]}


def spread_texts(spreads):
    """"(1.47 to 1.70)×10⁻²" a cell; a dash with fewer than two seeds."""
    powers = takes_powers([v for s in spreads if s for v in s])
    return [between(*s, powers) if s else DASH for s in spreads]


def spacing_column(levels):
    spacings = [level.h for level in levels]
    return number_column("h [m]", spacings, texts=exact_column(spacings))


def quantities_with_levels(study):
    """Paths that have a fit or a convergence plot, in the study's order."""
    out = []
    for entry in study.listed("fits") + [p for p in study.listed("plots") if p.get("kind") == "convergence"]:
        if entry.get("quantity") and entry["quantity"] not in out:
            out.append(entry["quantity"])
    return out


def _case_column(pairs):
    return text_column("case", [c.label for c, _ in pairs], head=True,
                       marks=[swatch(c.method, c.style) for c, _ in pairs])


def convergence_table(study, cases, path):
    """h, unknowns, error, spread over seeds, local and fitted order, cost: a line a level."""
    ladders = [c for c in cases if _measured(c, path) > 1]
    pairs = [(c, l) for c in ladders or cases if c.has(path) for l in c.levels]
    if not pairs:
        return None
    first = (quantities_with_levels(study) or [path])[0]
    orders = {c.index: local_orders(c, path, first) for c in cases if c.has(path)}
    name, unit = name_and_unit(path)
    spreads = [l.spread(path) for _, l in pairs]
    seeds = sorted({len(l.rows) for _, l in pairs})
    fits = [fit_of(study, c, path) if l is c.levels[-1] else None for c, l in pairs]
    return table(
        f"Convergence: {axis(path)}",
        [_case_column(pairs),
         spacing_column([l for _, l in pairs]),
         number_column("unknowns", [_typical(l, "unknowns") for _, l in pairs]),
         number_column(f"error [{unit}]" if unit else "error" if path.startswith("errors.") else name,
                       [l.mean(path) for _, l in pairs]),
         number_column("range over the seeds", [s and s[1] for s in spreads], texts=spread_texts(spreads)),
         number_column("seeds", [len(l.rows) for _, l in pairs]) if seeds != [1] else None,
         number_column("local order", [orders[c.index][c.levels.index(l)] for c, l in pairs], 3),
         number_column("fitted order", [f and f.get("slope") for f in fits], 3),
         number_column("R²", [f and f.get("r2") for f in fits], 4),
         *_costs(study, [number_column("run time [s]", [l.mean("wall_s") for _, l in pairs], 3),
                         number_column("ns a particle a step", [l.mean("ns_per_particle_step") for _, l in pairs], 3)]),
         balance_column([l.rows for _, l in pairs])],
        "Errors are means over the seeds. The local order is taken against the line before; the "
        "fitted order stands on the finest line of its case."
        if seeds != [1] else
        "The local order is taken against the line before; the fitted order stands on the finest "
        "line of its case.")


def _costs(study, columns):
    """Columns of run time: only of studies that ran one run at a time (`timing = true`)."""
    return columns if study.data.get("timing") else []


def _measured(case, path):
    """On how many levels a case has this quantity."""
    return sum(1 for level in case.levels if level.values(path))


def _typical(level, path):
    value = level.mean(path)
    return None if value is None else round(value)


def results_table(study, cases):
    """What claims ask of runs and no convergence table shows for all of them: mean and spread a level."""
    signals = {f"errors.{name}" for c in cases for r in c.rows for name in (r.get("error_sources") or {})}
    shown = [q for q in quantities_with_levels(study)  # and of every case: a ladder or nothing
             if not any(_measured(c, q) > 1 for c in cases) or all(_measured(c, q) != 1 for c in cases)]
    paths = []
    for claim in study.claims:
        path = claim.get("quantity")
        told = path in signals or str(path).startswith("signals.")  # by signals.py
        if path and path not in shown and path not in paths and not told:
            paths.append(path)
    if not paths and not shown and not signals:
        found = {f"{group}.{key}" for c in cases for r in c.rows for group in ("errors", "quantities")
                 for key in (r.get(group) or {})
                 if not key.startswith(("nonaffine_energy_share", "checkerboard"))}
        paths = sorted(found)[:8]
    pairs = [(c, l) for c in cases for l in c.levels if any(l.values(p) for p in paths)]
    if not pairs:
        return None
    columns = [_case_column(pairs), spacing_column([l for _, l in pairs]),
               number_column("seeds", [len(l.rows) for _, l in pairs])]
    for path in paths:
        spreads = [l.spread(path) for _, l in pairs]
        columns.append(number_column(axis(path), [l.mean(path) for _, l in pairs]))
        if any(s and s[0] != s[1] for s in spreads):
            columns.append(number_column("largest", [max(l.values(path), default=None) for _, l in pairs]))
    columns.append(balance_column([l.rows for _, l in pairs]))
    return table("Results", columns, "Means over the seeds, and the largest of them.")


DRIFTS = ("linear_momentum_drift", "angular_momentum_drift", "energy_drift")


HOURGLASS = ("nonaffine_energy_share_mean", "nonaffine_energy_share_max", "checkerboard_max")  # quantities of runs


def invariants_table(cases):
    """Largest drift and hourglass number over the seeds on the finest level of each case."""
    pairs = [(c, c.levels[-1]) for c in cases if c.levels]
    names = sorted({k for c, l in pairs for r in l.rows for k in (r.get("invariants") or {})},
                   key=lambda n: (DRIFTS.index(n) if n in DRIFTS else len(DRIFTS), n))
    paths = [f"invariants.{n}" for n in names] + [f"quantities.{n}" for n in HOURGLASS]
    pairs = [(c, l) for c, l in pairs if any(l.values(p) for p in paths)]
    if not pairs:
        return None
    columns, hourglass = [_case_column(pairs), spacing_column([l for _, l in pairs])], False
    for path in paths:
        worst = [max(map(abs, l.values(path)), default=None) for _, l in pairs]
        columns.append(number_column(axis(path), worst, 2))
        hourglass |= path.startswith("quantities.") and columns[-1] is not None
    columns.append(balance_column([l.rows for _, l in pairs]))
    note = "Largest magnitude over the seeds."
    if hourglass:
        note += (" Hourglass numbers: the share of the energy in bonds that deform otherwise than their particles do, and "
                 "the part of the displacements that alternates from particle to particle; both 0 where it is affine.")
    return table("Conservation" + " and hourglass numbers" * hourglass + " on the finest level", columns, note)


def references_table(study, label):
    """References with their own discretisation error. `label(entry)` names the case."""
    entries = study.listed("references")
    if not entries:
        return None
    return table(
        "References and their own discretisation error",
        [text_column("case", [label(e) for e in entries], head=True),
         text_column("quantity", [axis(e.get("quantity") or "") for e in entries]),
         number_column("value", [e.get("value") for e in entries], 4),
         number_column("observed order", [e.get("order") for e in entries]),
         number_column("GCI, relative", [e.get("gci") for e in entries], 2),
         number_column("safety factor", [_safety(e) for e in entries],
                       texts=exact_column([_safety(e) for e in entries])),
         text_column("in words", [e.get("statement") or e.get("text") or "" for e in entries]),
         balance_column([[e] for e in entries])],
        "GCI: grid convergence index from three levels, with the safety factor of Roache’s rule.")


def _safety(entry):
    return entry.get("safety_factor", entry.get("safety"))


def runs_table(study, cases):
    """Every run, one a line: for whoever wants to check the means."""
    rows = [(c, r) for c in cases for r in c.rows]
    if not rows:
        return None
    errors = sorted({k for _, r in rows for k in (r.get("errors") or {})})[:4]
    def numbers(label, path, digits=3): return number_column(label, [dig(r, path) for _, r in rows], digits)
    return table(
        "Every run",
        [text_column("case", [c.label for c, _ in rows], head=True),
         number_column("resolution", [r.get("resolution") for _, r in rows],
                       texts=exact_column([r.get("resolution") for _, r in rows])),
         numbers("seed", "seed"), numbers("particles", "particles"),
         numbers("unknowns", "unknowns"), numbers("steps", "steps"), numbers("Δt [s]", "dt"),
         numbers(ENDS[time_name([r for _, r in rows])], "t_end"),
         *[numbers(axis(e), f"errors.{e}") for e in errors],
         *_costs(study, [numbers("set-up [s]", "setup_s"), numbers("run time [s]", "wall_s")]),
         numbers("threads", "threads"), numbers("memory [MB]", "peak_rss_mb"),
         balance_column([[r] for _, r in rows], state),
         text_column("remark", [_remark(r) for _, r in rows]) if any(_remark(r) for _, r in rows) else None])


def _remark(row):
    """Why a run failed, or was compared with nothing."""
    compared = (row.get("comparisons") or {}).values()
    reasons = [str(c["reason"]) for c in compared if isinstance(c, dict) and c.get("reason")]
    return str(row.get("error") or "; ".join(dict.fromkeys(reasons)))


MACHINE = (("processor", "machine.cpu"), ("SIMD", "machine.simd"), ("threads", "machine.threads"),
           ("version", "build.version"), ("commit", "build.commit"), ("compiler", "build.compiler"),
           ("flags", "build.flags"))


def machine_facts(rows):
    """[(what, [values])] over all rows; more than one value means that runs came from several."""
    out = []
    for label, path in MACHINE:
        values = []
        for row in rows:
            value = dig(row, path)
            if value not in (None, "") and str(value) not in values:
                values.append(str(value))
        if values:
            out.append((label, values))
    return out
