"""Rows of a study, ordered into cases (one curve each) and levels (one resolution each)."""

import math
import re
from dataclasses import dataclass, field

from .loading import dig, number
from .palette import method_name

GREEK = {"xi": "ξ", "psi": "ψ", "nu": "ν", "beta": "β", "alpha": "α", "rho": "ρ"}


def variant_text(variant):
    """"xi 1, 25 %" -> "ξ 1, 25 %"; the numbers keep their unit on the line."""
    out = re.sub(r"\b(" + "|".join(GREEK) + r")(?=[\s=_]|$)", lambda m: GREEK[m[1]], variant or "")
    return re.sub(r"(\d) %", "\\1\u202f%", out)


@dataclass
class Level:
    """The runs of a case at one resolution, one a seed."""

    resolution: float
    rows: list

    def mean(self, path):
        values = self.values(path)
        return sum(values) / len(values) if values else None

    def values(self, path):
        """One number a run that went to its end; what a failed run left is not a result."""
        found = (number(dig(row, path)) for row in self.rows if not row.get("error"))
        return [v for v in found if v is not None]

    def spread(self, path):
        """(smallest, largest) over the seeds, or None when there is one value at most."""
        values = self.values(path)
        return (min(values), max(values)) if len(values) > 1 else None

    @property
    def h(self):
        return self.mean("h")


@dataclass
class Case:
    """One curve. `index` is its place in the study, `style` its place among its method's cases."""

    scene: str
    method: str
    variant: str
    index: int
    style: int
    label: str
    probe: str = ""
    levels: list = field(default_factory=list)

    def has(self, path):
        return any(level.values(path) for level in self.levels)

    @property
    def rows(self):
        return [row for level in self.levels for row in level.rows]


def cases_of(study):
    """The study's cases in the order of their first row; levels from coarse to fine."""
    grouped = {}
    for row in study.rows:
        key = (row.get("scene") or "", row["method"], row.get("variant") or "", row.get("probe") or "")
        grouped.setdefault(key, []).append(row)
    several_scenes = len({key[0] for key in grouped}) > 1
    cases, per_method = [], {}
    for key, rows in grouped.items():
        scene, method, variant, probe = key
        styles = per_method.setdefault(method, {})
        style = styles.setdefault((variant, scene), len(styles))
        label = " ".join(filter(None, (method_name(method), variant_text(variant))))
        if several_scenes and scene:
            label += ", " + scene.replace("_", " ")
        if probe:
            label += ", " + probe.replace("_", " ")
        cases.append(Case(scene, method, variant, len(cases), style, label, probe, _levels(rows)))
    return cases


def _levels(rows):
    by_resolution = {}
    for row in rows:
        resolution = number(row.get("resolution"))
        h = number(row.get("h"))
        if resolution is None:
            resolution = 1 / h if h else math.nan
        by_resolution.setdefault(resolution, []).append(row)
    return [Level(r, by_resolution[r]) for r in sorted(by_resolution)]


def local_orders(case, path, first_quantity):
    """Order between each level and the one before it: from the rows where they tell it for this
    quantity, else log(e1/e2)/log(h1/h2) of the means over the seeds. None where undefined."""
    orders = []
    for position, level in enumerate(case.levels):
        told = [_told(row, path, first_quantity) for row in level.rows]
        told = [t for t in told if t is not None]
        if told:
            orders.append(sum(told) / len(told))
        else:
            orders.append(_order(case.levels[position - 1], level, path) if position else None)
    return orders


def _told(row, path, first_quantity):
    orders = row.get("local_orders")
    if isinstance(orders, dict):
        return number(orders.get(path))
    return number(row.get("local_order")) if path == first_quantity else None


def _order(coarse, fine, path):
    e1, e2, h1, h2 = coarse.mean(path), fine.mean(path), coarse.h, fine.h
    if not (e1 and e2 and h1 and h2) or min(e1, e2, h1, h2) <= 0 or h1 == h2:
        return None
    return math.log(e1 / e2) / math.log(h1 / h2)


def fit_of(study, case, path):
    """The fit of this case and quantity, or None."""
    for fit in study.listed("fits"):
        same = fit.get("method") == case.method and (fit.get("variant") or "") == case.variant
        if same and fit.get("quantity") == path and fit.get("scene") in (None, case.scene):
            return fit
    return None


def chosen(cases, wanted):
    """The cases that a plot or picture asks for: filters `scene`, `method`, `variant` (a text or
    a list of texts); no filter means all."""
    def fits(case, key):
        want = wanted.get(key)
        if want is None or want == "" or want == []:
            return True
        return getattr(case, key) in (want if isinstance(want, list) else [want])
    return [c for c in cases if all(fits(c, k) for k in ("scene", "method", "variant", "probe"))]
