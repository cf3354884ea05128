"""The kinds of plots, and what they share. A kind makes plain data: the drawing is cached by it."""

import re

from .balance import any_broken
from .digits import engineering
from .loading import dig, number
from .quantities import name_and_unit

KINDS = {}


def kind(name):
    """Registers a function (study, cases, plot) -> specification, or a text: why there is none.
    `cases` are all of the study's; `chosen` (cases.py) applies the plot's selection."""
    def register(function):
        KINDS[name] = function
        return function
    return register


def curve_of(case, points, label, **more):
    """A curve through points (x, y, low, high, level); `broken` tells where the level has a run
    whose energy balance does not close."""
    ends = [(p[2], p[3]) for p in points]
    return {"case": case.index, "method": case.method, "style": case.style, "label": label,
            "x": [p[0] for p in points], "y": [p[1] for p in points],
            "low": [e[0] for e in ends], "high": [e[1] for e in ends],
            "broken": [any_broken(p[4].rows) for p in points], "slope": None, **more}


def level_of(case, plot):
    """The level at the plot's resolution; the finest when it names none."""
    wanted = number(plot.get("resolution"))
    if wanted is None:
        return case.levels[-1] if case.levels else None
    return next((level for level in case.levels if level.resolution == wanted), None)


def capital(words):
    return words[:1].upper() + words[1:]


def scale_of(values):
    """"log" for positive numbers that span decades."""
    known = [v for v in values if v is not None]
    return "log" if known and min(known) > 0 and max(known) / min(known) > 15 else "linear"


def scaled(curves, along, unit):
    """(curves, unit) with values that read well: 0.0005 m becomes 0.5 mm."""
    factor, unit = engineering(max(abs(v) for c in curves for v in c[along]), unit)
    return [{**c, along: [v * factor for v in c[along]]} for c in curves], unit


def times(curves, along, factor):
    return [{**c, along: [v * factor for v in c[along]]} for c in curves]


def is_static(row):
    """True for a run of a static solver: its "time" is the load parameter. Rows may say so
    (`static`); a static run has an end and no time step."""
    if isinstance(row.get("static"), bool):
        return row["static"]
    return number(row.get("t_end")) is not None and number(row.get("dt")) is None


def time_name(rows):
    """The quantity on the axis of histories: "time", "load parameter t", or both."""
    states = {is_static(row) for row in rows if not row.get("error")}
    if states == {True}:
        return "load parameter t"
    return "time" if True not in states else "load parameter t, or time"


def setting_of(row, key):
    """(number, unit text) of a setting: a field of the row, of its settings, or a word of its
    variant ("support 3, psi 0.1"); None when the row does not tell."""
    short = key.split(".")[-1]
    places = [row] + [row[k] for k in ("settings", "scene_settings", "set", "scene_set", "parameters")
                      if isinstance(row.get(k), dict)]
    for place in places:
        for name in (key, short):
            found = place.get(name) if name in place else dig(place, name)
            if number(found) is not None:
                return number(found), ""
            if isinstance(found, str):
                return _quantity(found)
    name = re.escape(short)
    match = re.search(rf"(?:^|[\s,]){name}(?:_\w)?[\s=]+([^,]+)", row.get("variant") or "")
    return _quantity(match[1]) if match else None


def _quantity(words):
    match = re.match(r"\s*([-+]?[\d.]+(?:[eE][-+]?\d+)?)\s*([^\d\s].*)?$", words)
    return (float(match[1]), (match[2] or "").strip()) if match else None


def words_of(key):
    """What a setting is called: "tlsph.psi" -> "ψ"."""
    return name_and_unit(key.split(".")[-1])[0]


def without(label, *keys):
    """The case's label less the words that tell these settings, and less one comma with each."""
    for short in map(words_of, keys):
        words = rf"(?<!\w){re.escape(short)}[\s=]+[^,]+"
        label = re.sub(rf",\s*{words}|{words},\s*|{words}", "", label)
    return label.strip()
