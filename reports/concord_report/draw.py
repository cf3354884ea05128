"""Draws a plot's specification (plots.py) with matplotlib. Imported only when the cache lacks it."""

import functools
import math

import matplotlib

matplotlib.use("svg")
from matplotlib.figure import Figure  # noqa: E402  (after the choice of back end)
from matplotlib.ticker import FixedLocator, FuncFormatter, LogLocator, NullFormatter  # noqa: E402

from . import draw_front, draw_inset, draw_labels, draw_map, draw_triangles, svg  # noqa: E402
from .balance import SIGN  # noqa: E402
from .digits import SUPERSCRIPTS, exact, pretty, ticks  # noqa: E402
from .palette import ROLES, colour, dash, hollow, marker  # noqa: E402

INK, MUTED, GRID, PAPER = (ROLES[r][1] for r in ("ink", "muted", "grid", "paper"))
SIZE = 13
HEIGHT = 380
BOTTOM, TOP = 50, 12
AREA, BESIDE = 360, 330  # width of the axes beside labels, beside a legend; all in CSS pixels
SAMPLE = 26  # length of a line in the legend
PUBLISHED = ("D", "s", "^", "o")  # markers of values that a source gives
LINE = 1.32  # height of a label's line, in font sizes
PLAIN = 500  # width of a plot without labels

matplotlib.rcParams.update({
    "svg.hashsalt": "concord", "svg.fonttype": "none", "font.size": SIZE, "axes.unicode_minus": True,
    "font.family": "DejaVu Sans", "path.simplify": True, "path.simplify_threshold": 0.1,
    "axes.edgecolor": MUTED, "axes.labelcolor": INK, "xtick.color": MUTED, "ytick.color": MUTED,
    "xtick.labelcolor": INK, "ytick.labelcolor": INK, "text.color": INK, "axes.linewidth": 0.8,
})


def draw(spec):
    """The specification as an <svg> element."""
    if spec.get("map"):
        return draw_map.draw(spec, SIZE)
    if spec.get("zero_apart"):
        spec = _with_zero(spec)
    curves = spec["curves"]
    labelled = spec["labelled"]
    legend = spec.get("legend", False)
    right = 22 + (SAMPLE + 4) * legend + max(_width(_end_label(c)) for c in curves) if labelled else 14
    height = max(HEIGHT, BOTTOM + TOP + 16 + len(curves) * SIZE * LINE if labelled else 0)
    figure = Figure(figsize=(PLAIN / 72, height / 72), dpi=72)
    axes = figure.add_axes([0, 0, 1, 1])
    _frame(axes, spec, curves)
    left = 18 + _tick_width(axes)
    width = left + (BESIDE if legend else AREA) + right if labelled else PLAIN
    figure.set_size_inches(width / 72, height / 72)
    axes.set_position([left / width, BOTTOM / height, (width - left - right) / width,
                       (height - BOTTOM - TOP - 16) / height])
    # the y label lies flat above the axis: no one reads sideways
    figure.text(4 / width, 1 - (TOP + 5) / height, spec["ylabel"], ha="left", va="bottom", color=INK)
    lines(axes, curves)
    if spec.get("zero_apart"):
        _zero_tick(axes, spec["zero_at"])
    if spec["triangles"]:
        draw_triangles.draw(axes, curves, spec["triangles"], MUTED, GRID)
    if spec.get("inset"):
        draw_inset.draw(axes, curves, spec["inset"], lines)
    if labelled:
        _labels(axes, curves, legend)
    if spec.get("front"):
        draw_front.draw(axes, spec["front"])
    tips = draw_front.tips(axes, [c for c in curves if c.get("tips")])
    return svg.fragment(figure, spec["ident"], spec["alt"], tips)


def lines(axes, curves):
    """All curves; the finer of two levels lies above."""
    for number, curve in enumerate(curves):
        if curve.get("points"):
            _points(axes, curve, number)
        elif curve.get("baseline"):
            _baseline(axes, curve, number)
        else:
            _line(axes, curve, number, _long(curve))


def _long(curve):
    """True for a curve that is drawn without markers."""
    return len(curve["x"]) > 40 or "dash" in curve  # of a line, not of points


def _with_zero(spec):
    """Puts the points at 0 a little left of the smallest positive value, apart from their curve."""
    xs = sorted({x for c in spec["curves"] for x in c["x"] if x > 0})
    at = xs[0] / max((xs[-1] / xs[0]) ** 0.13, 1.3)
    moved = [{**c, "x": [x or at for x in c["x"]], "apart": any(x == 0 for x in c["x"])}
             for c in spec["curves"]]
    return {**spec, "curves": moved, "zero_at": at}


def _zero_tick(axes, at):
    """The label 0 below the points that were put there, and a break in the axis."""
    low, high = axes.get_xlim()
    decades = [10.0 ** k for k in range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)]
    places = [at] + [d for d in decades if at < d <= high]
    axes.xaxis.set_major_locator(FixedLocator(places))
    axes.xaxis.set_minor_locator(FixedLocator(
        [k * d for d in decades for k in range(2, 10) if k * d > at * 1.6]))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda v, _: "0" if v == at else exact(v, 2)))
    first = min(x for line in axes.get_lines() for x in line.get_xdata() if x > at)
    middle = axes.transAxes.inverted().transform(axes.transData.transform(
        (math.sqrt(at * first), axes.get_ylim()[0])))[0]
    box = {"transform": axes.transAxes, "clip_on": False, "zorder": 6}
    axes.plot([middle - 0.008, middle + 0.008], [0, 0], color=PAPER, linewidth=3, **box)
    for shift in (-0.008, 0.008):
        axes.plot([middle + shift - 0.006, middle + shift + 0.006], [-0.018, 0.018], color=MUTED,
                  linewidth=0.9, **box)


@functools.lru_cache(maxsize=None)
def _width(words):
    """Of a text in the drawing [CSS pixels]. Its outline's exact extents would cost a hundred times as much."""
    from matplotlib.textpath import TextPath
    return float(TextPath((0, 0), words, size=SIZE).vertices[:, 0].max(initial=0.0))


def _tick_width(axes):
    """Of the longest tick label of the y axis."""
    axis = axes.yaxis
    places = [v for v in axis.get_majorticklocs() if axes.get_ylim()[0] <= v <= axes.get_ylim()[1]]
    return max((_width(t) for t in axis.get_major_formatter().format_ticks(places) if t), default=20)


def _end_label(curve):
    """A curve without markers carries here the sign that its run's energy balance does not close."""
    slope = curve.get("slope")
    sign = f" {SIGN}" if any(curve.get("broken") or []) and (_long(curve) or curve.get("baseline")) else ""
    return curve["label"] + (f" ({pretty(slope)})" if slope is not None else "") + sign


def _frame(axes, spec, curves):
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    axes.grid(True, color=GRID, linewidth=0.8)
    axes.set_axisbelow(True)
    axes.tick_params(length=3.5, width=0.8)
    axes.tick_params(which="minor", length=2, width=0.6)
    axes.set_xlabel(spec["xlabel"], labelpad=6)
    x = [v for c in curves for v in c["x"] + c.get("left", []) + c.get("right", [])]
    y = [v for c in curves for v in c["y"] + (c["low"] or []) + (c["high"] or [])]
    if spec.get("from_zero") and spec["scales"][1] == "linear":
        y.append(0.0)
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
        one.set_major_formatter(FuncFormatter(lambda v, _: exact(v, 3)))
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
    wide = [_width(exact(p, 3)) / AREA for p in places]
    return all(math.log(b / a) / full > (wide[k] + wide[k + 1]) / 2 + 0.025
               for k, (a, b) in enumerate(zip(places, places[1:])))


def _linear(axes, one, values, is_x, levels):
    low, high = min(values), max(values)
    room = 0.04 * (high - low) or 0.05 * abs(high) or 1
    limits = (low if is_x or low == 0 else low - room, high if is_x else high + room)
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


def _hue(curve):
    """Of the method, but where a plot has several columns of a run; published values are in ink."""
    if curve.get("points"):
        return INK
    return colour(curve.get("hue", curve["method"]))


def _dashes(curve, width):
    style = tuple(float(v) / width for v in dash(curve.get("dash", curve["style"])).split())
    return (0, style) if style else "-"


def _stroke(curve, sample=False):
    """What a curve's line looks like. Lines that may coincide carry a few markers, each its own
    places, so that each of them can be found."""
    rank, hue = curve.get("rank", 0), _hue(curve)
    if curve.get("points"):
        return {"linestyle": "none", "marker": PUBLISHED[curve["style"] % len(PUBLISHED)], "markersize": 8, "color": hue,
                "markerfacecolor": PAPER, "markeredgecolor": hue, "markeredgewidth": 1.5}
    width = 1.7 if rank == 0 else 1.2
    look = {"color": hue, "linewidth": width, "linestyle": _dashes(curve, 1.7),
            "alpha": (1 if rank == 0 else max(0.35, 0.75 - 0.18 * rank)) * curve.get("fade", 1)}
    if curve.get("reference"):
        look |= {"linewidth": 4.2, "alpha": 0.4}
    if "marks" in curve or sample and not _long(curve):
        look |= {"marker": marker(curve["style"]), "markersize": 5, "markeredgewidth": 1.1, "markeredgecolor": hue,
                 "markerfacecolor": PAPER if hollow(curve["style"]) else hue}
        if not sample:
            look["markevery"] = curve["marks"]
    return look


def _line(axes, curve, number, long):
    hue, style = _hue(curve), curve["style"]
    x, y, apart = curve["x"], curve["y"], curve.get("apart")
    line, = axes.plot(x[1:] if apart else x, y[1:] if apart else y, zorder=2.5 if curve.get("reference") else 3 - 0.1 * curve.get("rank", 0),
                      clip_on=long, **_stroke(curve))
    line.set_gid(f"curve:{curve['case']}:{number}")
    broken = curve.get("broken") or [False] * len(x)
    for bad in () if long else (False, True):
        places = [(a, b) for a, b, sign in zip(x, y, broken) if bool(sign) == bad]
        if places:
            marks = axes.plot(*zip(*places), linestyle="none", marker=marker(style), markersize=7 if bad else 6,
                              markerfacecolor=PAPER if bad or hollow(style) else hue, markeredgecolor=hue,
                              markeredgewidth=1.4, zorder=3, clip_on=False)
            crosses = axes.plot(*zip(*places), linestyle="none", marker="x", markersize=9, markeredgecolor=hue,
                                markeredgewidth=1.2, zorder=3.1, clip_on=False) if bad else []
            for k, artist in enumerate(marks + crosses):
                artist.set_gid(f"curve:{curve['case']}:{number}m{int(bad)}{k}")
    if curve["low"] and curve["low"] != curve["high"]:
        bars = axes.vlines(x, curve["low"], curve["high"], color=hue, linewidth=3.4, alpha=0.33, zorder=2)
        bars.set_gid(f"curve:{curve['case']}:{number}s")
    if curve.get("left") and curve["left"] != curve["right"]:
        bars = axes.hlines(y, curve["left"], curve["right"], color=hue, linewidth=3.4, alpha=0.33, zorder=2)
        bars.set_gid(f"curve:{curve['case']}:{number}w")


def _points(axes, curve, number):
    marks, = axes.plot(curve["x"], curve["y"], zorder=4, clip_on=False, **_stroke(curve))
    marks.set_gid(f"curve:{curve['case']}:{number}")


def _baseline(axes, curve, number):
    """A value that has nothing to do with the abscissa: a line across, a band for its spread."""
    hue = colour(curve["method"])
    line = axes.axhline(curve["y"][0], color=hue, linewidth=1.7, linestyle=_dashes(curve, 1.7), zorder=2.5)
    line.set_gid(f"curve:{curve['case']}:{number}")
    if curve["low"][0] != curve["high"][0]:
        band = axes.axhspan(curve["low"][0], curve["high"][0], color=hue, alpha=0.16, linewidth=0, zorder=1.5)
        band.set_gid(f"curve:{curve['case']}:{number}s")


def _labels(axes, curves, legend=False):
    """Each at the end that is nearest to the right edge, joined to it by a thin line; in a legend,
    where curves coincide, with a piece of its line instead."""
    from matplotlib.lines import Line2D
    ends = []
    for curve in curves:
        last = max(range(len(curve["x"])), key=lambda i: curve["x"][i])
        ends.append(axes.transData.transform((curve["x"][last], curve["y"][last])))
    box = axes.bbox
    places = draw_labels.spread([e[1] for e in ends], SIZE * LINE, box.y0 + 6, box.y1 + 8)
    edge = box.x1 + 12 + (SAMPLE + 4 if legend else 0)
    figure, back = axes.figure, axes.figure.transFigure.inverted()
    for number, (curve, end, y) in enumerate(zip(curves, ends, places)):
        start, look = (end[0] + 4, end[1]), {"linewidth": 0.7, "alpha": 0.7, "color": _hue(curve)}
        if legend:
            start, look = (edge - SAMPLE - 4, y), _stroke(curve, sample=True)
        line = list(zip(*(back.transform(p) for p in (start, ((start[0] + edge - 4) / 2, y), (edge - 4, y)))))
        pick = slice(None) if legend else slice(None, None, 2)
        mark = {"markevery": [1]} if "marker" in look else {}
        lead = Line2D(line[0][pick], line[1][pick], transform=figure.transFigure, **look, **mark)
        lead.set_gid(f"curve:{curve['case']}:{number}l")
        figure.add_artist(lead)
        words = figure.text(*back.transform((edge, y)), _end_label(curve), ha="left", va="center", color=INK)
        words.set_gid(f"curve:{curve['case']}:{number}t")
