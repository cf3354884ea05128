"""Heat maps over two settings: equal cells with their numbers, the smallest one framed."""

import math

from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from . import svg
from .balance import SIGN
from .palette import ROLES, VIRIDIS

INK, MUTED, GRID = (ROLES[r][1] for r in ("ink", "muted", "grid"))
DARK, LIGHT = "#0c0c0c", "#fdfdfd"  # of numbers on a cell; the same on either ground
CELL = (54, 34)
HEAD = 26  # the line that says what the numbers are
LEFT, TOP, TITLE, BOTTOM, RIGHT = 66, 28, 22, 48, 12
STOPS = VIRIDIS[::-1]  # large values are dark: the eye finds the light minimum


def _colour(value, limits, log):
    low, high = (math.log(v) if log else v for v in limits)
    at = ((math.log(value) if log else value) - low) / (high - low) if high > low else 0.0
    place = min(max(at, 0), 1) * (len(STOPS) - 1)
    k = min(int(place), len(STOPS) - 2)
    a, b = ([int(s[i:i + 2], 16) for i in (1, 3, 5)] for s in (STOPS[k], STOPS[k + 1]))
    return tuple((p + (place - k) * (q - p)) / 255 for p, q in zip(a, b))


def _text_colour(rgb):
    """Black or white, whichever has the greater contrast (WCAG's relative luminance)."""
    linear = [v / 12.92 if v <= 0.03928 else ((v + 0.055) / 1.055) ** 2.4 for v in rgb]
    luminance = 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]
    return DARK if luminance > 0.179 else LIGHT


def draw(spec, size):
    """The specification's maps, one below the other, as an <svg> element."""
    maps = spec["map"]
    titles = TITLE if any(m["title"] for m in maps) else 0
    width = LEFT + max(len(m["x"]) for m in maps) * CELL[0] + RIGHT
    height = sum(TOP + titles + len(m["y"]) * CELL[1] + BOTTOM for m in maps) + HEAD
    width = max(width, 440, 8 + 0.62 * size * len(spec["label"]))
    figure = Figure(figsize=(width / 72, height / 72), dpi=72)
    top = height - HEAD
    figure.text(4 / width, 1 - 11 / height, spec["label"], color=INK, fontsize=size, va="center")
    for one in maps:
        _map(figure, spec, one, (width, height), top, size, titles)
        top -= TOP + titles + len(one["y"]) * CELL[1] + BOTTOM
    return svg.fragment(figure, spec["ident"], spec["alt"])


def _map(figure, spec, one, page, top, size, titles):
    width, height = page
    columns, rows = len(one["x"]), len(one["y"])
    def text(x, y, words, **more):
        figure.text(x / width, y / height, words, **{"color": INK, "fontsize": size, **more})
    if titles:
        text(4, top - 14, one["title"], va="center", fontweight="bold")
    text(4, top - titles - 14, spec["ylabel"], va="center")
    floor = top - titles - TOP - rows * CELL[1]
    for i in range(rows):
        y = floor + i * CELL[1]
        text(LEFT - 8, y + CELL[1] / 2, one["y"][i], ha="right", va="center")
        for j in range(columns):
            _cell(figure, spec, one, (i, j), (LEFT + j * CELL[0], y), page, size)
    for j in range(columns):
        text(LEFT + (j + 0.5) * CELL[0], floor - 7, one["x"][j], ha="center", va="top")
    text(LEFT + columns * CELL[0] / 2, floor - 26, spec["xlabel"], ha="center", va="top")
    i, j, _ = one["least"]
    frame = Rectangle(((LEFT + j * CELL[0] + 1) / width, (floor + i * CELL[1] + 1) / height),
                      (CELL[0] - 2) / width, (CELL[1] - 2) / height, fill=False, edgecolor=INK, linewidth=2.6,
                      transform=figure.transFigure, zorder=4)
    figure.add_artist(frame)


def _cell(figure, spec, one, place, corner, page, size):
    (i, j), (x, y), (width, height) = place, corner, page
    value, words = one["values"][i][j], one["texts"][i][j]
    face = GRID if value is None else _colour(value, spec["limits"], spec["scale"] == "log")
    figure.add_artist(Rectangle(((x + 1) / width, (y + 1) / height), (CELL[0] - 2) / width,
                                (CELL[1] - 2) / height, facecolor=face, linewidth=0,
                                transform=figure.transFigure, zorder=2))
    sign = f" {SIGN}" if one["broken"][i][j] else ""
    figure.text((x + CELL[0] / 2) / width, (y + CELL[1] / 2 - 0.5) / height, words + sign, ha="center", va="center",
                fontsize=size - (2 if sign and len(words) > 3 else 0), zorder=3,
                color=MUTED if value is None else _text_colour(face))
