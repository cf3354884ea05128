"""A magnified part of a plot, in the corner where it covers least."""

import numpy as np
from matplotlib.ticker import FixedLocator, FuncFormatter

from .digits import exact, ticks
from .palette import ROLES

MUTED, GRID, PAPER = (ROLES[r][1] for r in ("muted", "grid", "paper"))
WIDTH, HEIGHT = 0.40, 0.42  # of the axes
PLACES = [(x, y) for x in (0.57, 0.34, 0.12) for y in (0.11, 0.33, 0.55)]
LABELS = (0.09, 0.09)  # room for tick labels left of and below the inset


def draw(axes, curves, window, lines):
    """Draws `window` = [[x low, x high], [y low, y high]] again, larger; `lines` draws curves."""
    covered = _dense(axes, curves)
    frame = np.array([_corner(axes, window, k) for k in (0, 1)])
    left, low = min(PLACES, key=lambda place: _cost(place, covered, frame))
    inset = axes.inset_axes([left, low, WIDTH, HEIGHT], zorder=5)
    lines(inset, curves)
    inset.set_xlim(*window[0])
    inset.set_ylim(*window[1])
    inset.set_facecolor(PAPER)
    inset.grid(True, color=GRID, linewidth=0.7)
    inset.set_axisbelow(True)
    inset.tick_params(labelsize=11, length=2.5, width=0.7, pad=2)
    for one, span in ((inset.xaxis, window[0]), (inset.yaxis, window[1])):
        one.set_major_locator(FixedLocator([float(f"{t:.9g}") for t in ticks(*span, count=3)]))
        one.set_major_formatter(FuncFormatter(lambda v, _: exact(float(f"{v:.9g}"), 5)))
    for words in inset.get_yticklabels() + inset.get_xticklabels():
        words.set_bbox({"facecolor": PAPER, "edgecolor": "none", "pad": 0.8})  # above the connectors
    for side in inset.spines.values():
        side.set_color(MUTED)
    _, connectors = axes.indicate_inset_zoom(inset, edgecolor=MUTED, linewidth=0.9, alpha=0.9)
    for line in connectors or ():
        line.set_linewidth(0.6)


def _corner(axes, window, k):
    return axes.transAxes.inverted().transform(axes.transData.transform((window[0][k], window[1][k])))


def _dense(axes, curves):
    """Points along the curves in fractions of the axes."""
    out = []
    for curve in curves:
        at = axes.transAxes.inverted().transform(
            axes.transData.transform(np.column_stack([curve["x"], curve["y"]])))
        steps = np.linspace(0, 1, 10)[:, None]
        out += [a + steps * (b - a) for a, b in zip(at[:-1], at[1:])]
    return np.concatenate(out)


def _cost(place, covered, frame):
    """How many points of curves, and of the magnified window's edge, the inset would hide."""
    low = np.array(place) - LABELS
    high = np.array(place) + (WIDTH + 0.01, HEIGHT + 0.01)
    hidden = ((covered > low) & (covered < high)).all(axis=1).sum()
    overlap = np.clip(np.minimum(high, frame[1]) - np.maximum(low, frame[0]), 0, None).prod()
    return hidden + (len(covered) if overlap > 0 else 0)
