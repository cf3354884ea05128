"""Heat maps of methods by tests: every cell with its number, its evidence and what reproduces it."""

import math
import os

from .balance import NOTE, SIGN
from .cases import variant_text
from .digits import DASH, exact, pretty
from .loading import number

STEPS = 10  # of the colour scale


def maps_of(study, ident, out):
    """The study's heat maps as plain data. `out` is the folder of the page: evidence is linked relative to it."""
    return [_map(study, entry, f"{ident}-heat{k}", out) for k, entry in enumerate(study.listed("heatmap"))]


def _map(study, entry, ident, out):
    columns = [variant_text(c.get("label") or c.get("method") or "") for c in entry.get("columns") or []]
    rows = []
    for k, row in enumerate(entry.get("rows") or []):
        cells = [_cell(study, row, cell, f"{ident}-{k}-{j}", out) for j, cell in enumerate(row.get("cells") or [])]
        rows.append({"label": variant_text(row.get("label") or ""), "unit": _unit(row), "scale": _scale(row),
                     "note": row.get("note") or "", "cells": cells})
    broken = any(c["broken"] for r in rows for c in r["cells"])
    return {"title": entry.get("title") or "Heat map", "id": ident, "columns": columns, "rows": rows,
            "note": NOTE if broken else "", "missing": sum(c["text"] == DASH for r in rows for c in r["cells"]),
            "count": sum(len(r["cells"]) for r in rows), "legend": [_look(k / 4) for k in range(4, -1, -1)]}


def _unit(row):
    return "" if row.get("unit") in ("", "1", None) else row["unit"]


def _scale(row):
    """"good ≤ 0, bad ≥ 6": where the colours end."""
    low = row.get("better") == "low" or (row.get("better") is None and row.get("good", 0) < row.get("bad", 0))
    if number(row.get("good")) is None or number(row.get("bad")) is None:
        return ""
    good, bad = ("≤", "≥") if low else ("≥", "≤")
    unit = f"\u202f{_unit(row)}" if _unit(row) else ""
    return f"good {good} {exact(row['good'])}{unit}, bad {bad} {exact(row['bad'])}{unit}"


def _cell(study, row, cell, ident, out):
    value, score, broken = number(cell.get("value")), number(cell.get("score")), cell.get("balance") == "does not close"
    text = DASH if value is None else pretty(cell["value"], int(row.get("digits") or 3))
    return {"id": ident, "text": text, "sign": SIGN if broken else "", "broken": broken, "look": _look(score),
            "reason": cell.get("reason") or "", "command": cell.get("command") or "", "link": _link(study, cell.get("run"), out),
            "run": cell.get("run") or "", "value": "" if value is None else exact(value, 6)}


def _look(score):
    """{step, share, words} of a score: a colour, a pie for who sees no colours, a word for who sees neither."""
    if score is None:
        return None
    share = min(max(score, 0.0), 1.0)
    return {"step": round(share * STEPS), "pie": pie(share), "words": f"score {share:.2f}"}


def pie(share, radius=5.0, centre=7.0):
    """The path of a share of a disc, from the top clockwise; a whole one for 1, none for 0."""
    if share >= 0.995:
        return f"M{centre} {centre - radius}a{radius} {radius} 0 1 1 -.01 0z"
    if share <= 0.005:
        return ""
    angle = 2 * math.pi * share
    x, y = centre + radius * math.sin(angle), centre - radius * math.cos(angle)
    return f"M{centre:g} {centre:g}V{centre - radius:g}A{radius:g} {radius:g} 0 {int(share > 0.5)} 1 {x:.2f} {y:.2f}z"


def _link(study, run, out):
    """The run's folder as the page's folder sees it; "" where it is not there."""
    folder = study.folder / run if run else None
    if folder is None or not folder.is_dir() or out is None:
        return ""
    return os.path.relpath(folder, out).replace(os.sep, "/")
