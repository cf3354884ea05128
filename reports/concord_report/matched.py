"""Tables of time, memory and resolution at matched errors, as the study found them."""

import re

from .balance import NOTE, SIGN
from .cases import variant_text
from .digits import DASH, duration, exact, pretty
from .fronts import TIMES, case_of, fem_note
from .loading import number
from .palette import method_name, swatch
from .quantities import name_and_unit


def tables_of(study, cases):
    """One for each [[matched]] of the study, as plain data for the template."""
    return [_table(cases, entry) for entry in study.listed("matched")]


def _table(cases, entry):
    pairs = [(case, told) for told in entry.get("cases") or [] if (case := case_of(cases, told))]
    starts = [k > 0 and case.scene != pairs[k - 1][0].scene for k, (case, _) in enumerate(pairs)]
    scenes = {case.scene for case, _ in pairs}
    end = f", {scenes.pop().replace('_', ' ')}" if len(scenes) == 1 else ""  # the title tells it
    lines = [{"label": case.label.removesuffix(end), "start": start, "mark": swatch(case.method, case.style),
              "cells": _cells(told, entry["levels"])} for (case, told), start in zip(pairs, starts)]
    name = name_and_unit(entry["quantity"])[0]
    time = TIMES.get(entry.get("time"), TIMES["wall_s"])
    cells = [cell for line in lines for cell in line["cells"]]
    notes = [f"Under each error the {time}, below it the memory and the resolution N, interpolated between the two "
             "resolutions that have the error between them. The fastest of its scene is marked.",
             "≤: the coarsest run is already better." if any(c["kind"] == "coarsest" for c in cells) else "",
             NOTE if any(c["broken"] for c in cells) else "", entry.get("note"),
             fem_note([case for case, _ in pairs], entry.get("note"))]
    return {"caption": entry.get("title") or f"{time.capitalize()} at one {name}", "name": name,
            "levels": [_level(level) for level in entry["levels"]], "lines": lines,
            "sentences": [sentence(s, [case for case, _ in pairs]) for s in entry.get("sentences") or []], "note": " ".join(filter(None, notes))}


def sentence(words, cases):
    """The study's words with cases, scenes and times as the table has them."""
    for case in sorted(cases, key=lambda c: -len(c.variant)):
        scene = case.scene.replace("_", " ")
        if case.variant:
            words = words.replace(f"{case.method} ({case.variant})", case.label.removesuffix(f", {scene}"))
        words = words.replace(case.scene, scene) if case.scene else words
    for method in {case.method for case in cases}:
        words = re.sub(rf"(?<!\w){method}(?= (?:is|takes|does|has)\b)", method_name(method), words)
    seconds = r"(?<![\w.])(\d+(?:\.\d+)?(?:e[-+]?\d+)?) s\b"
    return variant_text(re.sub(seconds, lambda m: duration(float(m[1]), 3), words))


def _level(level):
    return f"{exact(100 * level)}\u202f%"


def _cells(told, levels):
    """What a case needs for each error. How far it came is told once, beside the first error that it does not reach."""
    cells = [_cell(told, level) for level in levels]
    return [{**c, "below": ""} if k and c["kind"] == "not" == cells[k - 1]["kind"] and c["below"] == cells[k - 1]["below"] else c
            for k, c in enumerate(cells)]


def _cell(told, level):
    """What a case needs for an error: {kind, text, below, value, fastest, broken}."""
    at = next((a for a in told.get("at") or [] if a.get("level") == level), {"status": "no value"})
    status, out = at.get("status"), {"value": None, "fastest": False, "broken": at.get("balance") == "does not close"}
    if status in ("met", "met by the coarsest"):
        sign = "≤ " if status != "met" else ""
        needs = [f"{pretty(at['memory_mb'], 2)} MB" if number(at.get("memory_mb")) is not None else "",
                 f"N = {exact(at['resolution'], 3)}" if number(at.get("resolution")) is not None else ""]
        return out | {"kind": "met" if status == "met" else "coarsest", "text": sign + duration(at["time"]),
                      "below": ", ".join(filter(None, needs)) + (f" {SIGN}" if out["broken"] else ""),
                      "value": at["time"], "fastest": bool(at.get("fastest"))}
    if status == "not reached":
        best = f"best {_error(at['finest_error'])} in {duration(at.get('finest_time'))}" if at.get("finest_error") else ""
        return out | {"kind": "not", "text": "not reached", "below": best + (f" {SIGN}" if out["broken"] else "")}
    return out | {"kind": "none", "text": DASH, "below": at.get("reason") or ""}


def _error(error):
    return f"{pretty(100 * error, 2)}\u202f%"
