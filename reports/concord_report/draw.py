"""Draws a plot's specification (plots.py) with matplotlib. Imported only when the cache lacks it."""

import math

import matplotlib

matplotlib.use("svg")
from matplotlib.figure import Figure  # noqa: E402  (after the choice of back end)
from matplotlib.ticker import FixedLocator, FuncFormatter, LogLocator, NullFormatter  # noqa: E402

from . import draw_labels, draw_triangles, svg  # noqa: E402
from .digits import SUPERSCRIPTS, exact, pretty, ticks  # noqa: E402
from .palette import ROLES, colour, dash, hollow, marker  # noqa: E402

INK, MUTED, GRID, PAPER = (ROLES[r][1] for r in ("ink", "muted", "grid", "paper"))
SIZE = 13
HEIGHT = 380
BOTTOM, TOP = 50, 12
AREA = 360  # width of the axes beside labels; all in CSS pixels
PLAIN = 500  # width of a plot without labels

matplotlib.rcParams.update({
    "svg.hashsalt": "concord", "svg.fonttype": "none", "font.size": SIZE, "axes.unicode_minus": True,
    "font.family": "DejaVu Sans", "path.simplify": True, "path.simplify_threshold": 0.3,
    "axes.edgecolor": MUTED, "axes.labelcolor": INK, "xtick.color": MUTED, "ytick.color": MUTED,
    "xtick.labelcolor": INK, "ytick.labelcolor": INK, "text.color": INK, "axes.linewidth": 0.8,
})


def draw(spec):
    """The specification as an <svg> element."""
    curves = spec["curves"]
    labelled = spec["labelled"]
    right = 22 + max(_width(_end_label(c)) for c in curves) if labelled else 14
    figure = Figure(figsize=(PLAIN / 72, HEIGHT / 72), dpi=72)
    axes = figure.add_axes([0, 0, 1, 1])
    _frame(axes, spec, curves)
    left = 18 + _tick_width(axes)
    width = left + AREA + right if labelled else PLAIN
    figure.set_size_inches(width / 72, HEIGHT / 72)
    axes.set_position([left / width, BOTTOM / HEIGHT, (width - left - right) / width,
                       (HEIGHT - BOTTOM - TOP - 16) / HEIGHT])
    # the y label lies flat above the axis: no one reads sideways
    figure.text(4 / width, 1 - (TOP + 5) / HEIGHT, spec["ylabel"], ha="left", va="bottom", color=INK)
    for number, curve in enumerate(curves):
        _line(axes, curve, number, len(curve["x"]) > 40)
    if spec["triangles"]:
        draw_triangles.draw(axes, curves, spec["triangles"], MUTED, GRID)
    if labelled:
        _labels(axes, curves)
    return svg.fragment(figure, spec["ident"], spec["alt"])


def _width(words):
    """Of a text in the drawing [CSS pixels]."""
    from matplotlib.textpath import TextPath
    return TextPath((0, 0), words, size=SIZE).get_extents().x1


def _tick_width(axes):
    """Of the longest tick label of the y axis."""
    axis = axes.yaxis
    places = [v for v in axis.get_majorticklocs() if axes.get_ylim()[0] <= v <= axes.get_ylim()[1]]
    return max((_width(t) for t in axis.get_major_formatter().format_ticks(places) if t), default=20)


def _end_label(curve):
    slope = curve.get("slope")
    return curve["label"] + (f" ({pretty(slope)})" if slope is not None else "")


def _frame(axes, spec, curves):
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    axes.grid(True, color=GRID, linewidth=0.8)
    axes.set_axisbelow(True)
    axes.tick_params(length=3.5, width=0.8)
    axes.tick_params(which="minor", length=2, width=0.6)
    axes.set_xlabel(spec["xlabel"], labelpad=6)
    x = [v for c in curves for v in c["x"]]
    y = [v for c in curves for v in c["y"] + (c["low"] or []) + (c["high"] or [])]
    levels = [curve["x"] for curve in curves]
    for values, scale, one, is_x in ((x, spec["scales"][0], axes.xaxis, True),
                                     (y, spec["scales"][1], axes.yaxis, False)):
        (_log if scale == "log" else _linear)(axes, one, values, is_x, levels)


def _log(axes, one, values, is_x, levels):
    low, high = min(values), max(values)
    room = max((high / low) ** 0.06, 1.12)
    (axes.set_xscale if is_x else axes.set_yscale)("log")
    (axes.set_xlim if is_x else axes.set_ylim)(low / room, high * room)
    places = sorted({v for level in levels for v in level})
    if is_x and len(places) <= 7 and _apart(places, low, high):
        one.set_major_locator(FixedLocator(places))
        one.set_minor_locator(FixedLocator([]))
        one.set_major_formatter(FuncFormatter(lambda v, _: exact(v)))
        return
    narrow = high / low < 30
    one.set_major_locator(LogLocator(10, subs=(1, 2, 5) if narrow else (1,), numticks=12))
    one.set_minor_locator(LogLocator(10, subs=range(2, 10), numticks=12))
    one.set_minor_formatter(NullFormatter())
    powers = not narrow and (low < 1e-3 or high > 1e4)
    one.set_major_formatter(FuncFormatter(lambda v, _: _decade(v) if powers else exact(v, 2)))


def _decade(value):
    return "10" + str(round(math.log10(value))).translate(SUPERSCRIPTS)


def _apart(places, low, high):
    """True when labels at these places of a log axis do not touch."""
    full = math.log(high / low) or 1
    return all(math.log(b / a) / full > 0.085 for a, b in zip(places, places[1:]))


def _linear(axes, one, values, is_x, levels):
    low, high = min(values), max(values)
    room = 0.04 * (high - low) or 0.05 * abs(high) or 1
    limits = (low if is_x else low - room, high if is_x else high + room)
    if limits[0] == limits[1]:
        limits = (low - room, high + room)
    (axes.set_xlim if is_x else axes.set_ylim)(*limits)
    places = ticks(*limits, count=6 if is_x else 5)
    digits = 3
    while len({exact(p, digits) for p in places}) < len(places) and digits < 8:
        digits += 1
    clean = [0.0 if abs(p) < 1e-9 * (limits[1] - limits[0]) else p for p in places]
    one.set_major_locator(FixedLocator(clean))
    one.set_major_formatter(FuncFormatter(lambda v, _: exact(float(f"{v:.10g}"), digits)))


def _line(axes, curve, number, long):
    hue, style = colour(curve["method"]), curve["style"]
    dashes = tuple(float(v) for v in dash(style).split())
    rank = curve.get("rank", 0)
    line, = axes.plot(curve["x"], curve["y"], color=hue, linewidth=1.7 if rank == 0 else 1.0,
                      alpha=1 if rank == 0 else max(0.3, 0.7 - 0.15 * rank),
                      marker=None if long else marker(style), markersize=6,
                      markerfacecolor=PAPER if hollow(style) else hue, markeredgecolor=hue,
                      markeredgewidth=1.4, zorder=3, clip_on=long)
    if dashes:
        line.set_linestyle((0, tuple(d / 1.7 for d in dashes)))
    line.set_gid(f"curve:{curve['case']}:{number}")
    if curve["low"] and curve["low"] != curve["high"]:
        bars = axes.vlines(curve["x"], curve["low"], curve["high"], color=hue, linewidth=3.4,
                           alpha=0.33, zorder=2)
        bars.set_gid(f"curve:{curve['case']}:{number}s")


def _labels(axes, curves):
    """Each at the end that is nearest to the right edge, joined to it by a thin line."""
    ends = []
    for curve in curves:
        last = max(range(len(curve["x"])), key=lambda i: curve["x"][i])
        ends.append(axes.transData.transform((curve["x"][last], curve["y"][last])))
    box = axes.bbox
    places = draw_labels.spread([e[1] for e in ends], SIZE * 1.32, box.y0 + 6, box.y1 + 8)
    edge = box.x1 + 12
    back = axes.figure.transFigure.inverted()
    for number, (curve, end, y) in enumerate(zip(curves, ends, places)):
        (x0, y0), (x1, y1) = back.transform((end[0] + 4, end[1])), back.transform((edge - 2, y))
        from matplotlib.lines import Line2D
        lead = Line2D([x0, x1], [y0, y1], color=colour(curve["method"]), linewidth=0.7, alpha=0.7,
                      transform=axes.figure.transFigure)
        lead.set_gid(f"curve:{curve['case']}:{number}l")
        axes.figure.add_artist(lead)
        place = back.transform((edge, y))
        words = axes.figure.text(*place, _end_label(curve), ha="left", va="center", color=INK)
        words.set_gid(f"curve:{curve['case']}:{number}t")
