"""Reads study.json files. Missing optional fields are fine; a broken file is an InputError."""

import json
import math
from dataclasses import dataclass, field
from pathlib import Path


class InputError(Exception):
    """A file that cannot be used. The message says which, where, what was found, what is allowed."""


@dataclass
class Study:
    """One study as its study.json tells it. `folder` is where the runs' paths start."""

    name: str
    folder: Path
    data: dict
    claims: list = field(default_factory=list)
    rows: list = field(default_factory=list)

    @property
    def title(self):
        return self.data.get("title") or self.name.replace("_", " ").capitalize()

    def listed(self, key):
        return self.data.get(key) or []


LISTS = ("claims", "rows", "fits", "references", "plots", "pictures", "matched", "heatmap", "tables")
TEXTS = ("name", "title", "question", "source", "paper_statement", "mode", "verdict")
VERDICTS = ("pass", "fail")


def number(value):
    """The value as a finite float, or None: null, absent, text, NaN and infinity are all missing."""
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return None
    return float(value) if math.isfinite(value) else None


def dig(row, path):
    """row["errors"]["displacement_l2"] for "errors.displacement_l2"; None where it is missing."""
    if path in row:
        return row[path]
    node = row
    for key in path.split("."):
        if not isinstance(node, dict) or key not in node:
            return None
        node = node[key]
    return node


def read_json(path):
    """The parsed file; InputError with line and column when it is not JSON."""
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"{path}: cannot be read: {error}") from error
    try:
        return json.loads(text)
    except json.JSONDecodeError as error:
        raise InputError(
            f"{path}:{error.lineno}:{error.colno}: not JSON ({error.msg}); "
            "was the run cut short while writing? Run the study again."
        ) from error


def _check(path, data):
    if not isinstance(data, dict):
        raise InputError(f"{path}: found {type(data).__name__}, expected an object")
    if not isinstance(data.get("name"), str) or not data["name"]:
        raise InputError(f"{path}: key 'name': expected the study's name as text")
    for key in TEXTS:
        if data.get(key) is not None and not isinstance(data[key], str):
            raise InputError(f"{path}: key '{key}': found {data[key]!r}, expected text")
    for key in LISTS:
        value = data.get(key)
        if value is None:
            continue
        if not isinstance(value, list):
            raise InputError(f"{path}: key '{key}': found {type(value).__name__}, expected a list")
        for position, entry in enumerate(value):
            if not isinstance(entry, dict):
                raise InputError(f"{path}: {key}[{position}]: found {entry!r}, expected an object")
    for position, claim in enumerate(data.get("claims") or []):
        for key in ("id", "statement", "verdict"):
            if not isinstance(claim.get(key), str) or not claim[key]:
                raise InputError(f"{path}: claims[{position}]: key '{key}': found "
                                 f"{claim.get(key)!r}, expected text")
    for position, row in enumerate(data.get("rows") or []):
        if not isinstance(row.get("method"), str):
            raise InputError(f"{path}: rows[{position}]: key 'method': found "
                             f"{row.get('method')!r}, expected text")


PAIR, WINDOW = "[low, high]", "{x: [low, high], y: [low, high]} or one of the two"


def _is_pair(value):
    return isinstance(value, list) and len(value) == 2 and None not in map(number, value) and value[0] < value[1]


def _is_window(value):
    return isinstance(value, dict) and set(value) <= {"x", "y"} and all(map(_is_pair, value.values()))


def _is_table_list(value):
    return isinstance(value, list) and all(isinstance(v, dict) for v in value)


def _is_points(value):
    x, y = value.get("x"), value.get("y")
    return isinstance(value.get("label"), str) and isinstance(x, list) and isinstance(y, list) and len(x) == len(y) > 0 \
        and None not in map(number, x + y)


ANIMATION = "{frames, seconds, from, to}: numbers, the first two above 0"


def _is_animation(value):
    return isinstance(value, dict) and set(value) <= {"frames", "seconds", "from", "to"} and None not in map(number, value.values()) \
        and all(value.get(key, 1) > 0 for key in ("frames", "seconds"))


# list and key of an entry: (what is allowed in words, the test); a missing key is fine everywhere
ALLOWED = {
    ("plots", "inset"): (WINDOW, _is_window),
    ("plots", "baseline"): ("a selection {method, variant, ...} or a list of them",
                            lambda v: isinstance(v, dict) or _is_table_list(v)),
    ("plots", "points"): ("a list of {label, x: numbers, y: as many}", lambda v: _is_table_list(v) and all(map(_is_points, v))),
    ("plots", "change_from"): ("a time in s", lambda v: number(v) is not None),
    ("plots", "resolutions"): ("a list of numbers",
                               lambda v: isinstance(v, list) and None not in map(number, v)),
    ("plots", "rate_over"): ("a time in s, above 0", lambda v: number(v) is not None and v > 0),
    ("plots", "share_of"): ("a list of columns of history.csv",
                            lambda v: isinstance(v, list) and v and all(isinstance(c, str) for c in v)),
    ("plots", "columns"): ("a list of columns of history.csv",
                           lambda v: isinstance(v, list) and v and all(isinstance(c, str) for c in v)),
    ("pictures", "times"): ("a list of times in s",
                            lambda v: isinstance(v, list) and v and None not in map(number, v)),
    ("pictures", "panels"): ("a list of {method, variant, ...}", _is_table_list),
    ("pictures", "range"): (f'"common", "robust" or {PAIR}', lambda v: v in ("common", "robust") or _is_pair(v)),
    ("pictures", "draw"): ('"body", "cells" or "spheres"', lambda v: v in ("body", "cells", "spheres")),
    ("pictures", "animate"): (ANIMATION, _is_animation),
    ("pictures", "crop"): (WINDOW, _is_window),
}


def _check_figures(path, data):
    """The nested keys of plots and pictures, those of panels included."""
    for name in ("plots", "pictures"):
        for position, entry in enumerate(data.get(name) or []):
            panels = entry.get("panels") if _is_table_list(entry.get("panels")) else []
            for part in [entry, *panels]:
                for key, value in part.items():
                    words, fits = ALLOWED.get((name, key), ("", None))
                    if fits and value is not None and not fits(value):
                        raise InputError(f"{path}: {name}[{position}]: key '{key}': found {value!r}, expected {words}")


def load_study(path):
    """The study in `path` (a study.json)."""
    data = read_json(path)
    _check(path, data)
    _check_figures(path, data)
    return Study(data["name"], path.parent, data, data.get("claims") or [], data.get("rows") or [])


def load_studies(folder):
    """(studies sorted by title, warnings) from every sub-folder of `folder` with a study.json."""
    folder = Path(folder)
    if not folder.is_dir():
        raise InputError(f"{folder}: no such folder; expected one sub-folder per study")
    if (folder / "study.json").is_file():
        return [load_study(folder / "study.json")], []
    studies, warnings = [], []
    for sub in sorted(p for p in folder.iterdir() if p.is_dir() and not p.name.startswith(".")):
        if (sub / "study.json").is_file():
            studies.append(load_study(sub / "study.json"))
        elif any(sub.glob("*/summary.json")) or (sub / "tables").is_dir():
            warnings.append(f"{sub.name}: no study.json, so the study did not finish; left out")
    if not studies:
        raise InputError(f"{folder}: no sub-folder holds a study.json; run a study first")
    names = [s.name for s in studies]
    for name in names:
        if names.count(name) > 1:
            raise InputError(f"{folder}: two studies are called '{name}'")
    return studies, warnings


def verdict(claim):
    """"pass", "fail", or "open" for a claim that this run did not judge."""
    return claim["verdict"] if claim["verdict"] in VERDICTS else "open"


def study_verdict(study):
    """The study's own word, except that a failed claim is never painted over."""
    verdicts = [verdict(c) for c in study.claims]
    if "fail" in verdicts or study.data.get("verdict") == "fail":
        return "fail"
    return "pass" if "pass" in verdicts else "open"
