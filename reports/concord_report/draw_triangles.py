"""Slope triangles of log-log plots, placed where they cover no curve."""

import numpy as np
from scipy.spatial import KDTree

WIDTH = 0.13  # of the axes
CLEAR = 0.045  # wanted distance from curves, in fractions of the axes


def _to_axes(axes, x, y):
    points = axes.transData.transform(np.column_stack([x, y]))
    return axes.transAxes.inverted().transform(points)


def _dense(axes, curves):
    """Points along the curves' lines and spreads, in axes coordinates."""
    out = []
    for curve in curves:
        at = _to_axes(axes, curve["x"], curve["y"])
        steps = np.linspace(0, 1, 12)[:, None]
        for a, b in zip(at[:-1], at[1:]):
            out.append(a + steps * (b - a))
        out.append(at)
        if curve.get("low"):
            out.append(_to_axes(axes, curve["x"], curve["low"]))
            out.append(_to_axes(axes, curve["x"], curve["high"]))
    return np.concatenate(out)


def _rise(axes, slope):
    """Height in axes fractions of a slope over WIDTH of the axes."""
    x0, x1 = np.log(axes.get_xlim())
    y0, y1 = np.log(axes.get_ylim())
    return slope * WIDTH * (x1 - x0) / (y1 - y0)


def _area(corner, height):
    """Sample points of the triangle's neighbourhood: its box, with room for its labels."""
    xs = np.linspace(-0.01, WIDTH + 0.075, 7)
    ys = np.linspace(-0.065, height + 0.01, 7)
    return np.array([(corner[0] + x, corner[1] + y) for x in xs for y in ys
                     if y <= height * max(x, 0) / WIDTH + 0.03])


def _anchor(axes, curves, slope):
    """Axes coordinates of the finer half of the curve whose fitted slope is nearest."""
    fitted = [c for c in curves if c["slope"] is not None] or curves
    near = min(fitted, key=lambda c: (abs((c["slope"] or 0) - slope), min(c["y"])))
    return _to_axes(axes, near["x"], near["y"]).mean(axis=0)


def _corners(height, anchor):
    """Lower left corners inside the axes, nearest to the anchor first and rather below it."""
    places = [(x, y) for x in np.arange(0.03, 0.91 - WIDTH, 0.03)
              for y in np.arange(0.08, 0.97 - height, 0.03)]
    def cost(place):
        away = np.array([place[0] + WIDTH / 2, place[1] + height / 2]) - anchor
        return np.hypot(*away) + (0.1 if away[1] > 0 else 0)
    return sorted(places, key=cost)


def place(axes, curves, slopes):
    """[(slope, (x, y) of the lower left corner, height)] in axes fractions; one that finds no
    free place is left out."""
    taken = KDTree(_dense(axes, curves))
    placed = []
    for slope in slopes:
        height = _rise(axes, slope)
        if not 0.02 < height < 0.6:
            continue
        for corner in _corners(height, _anchor(axes, curves, slope)):
            area = _area(corner, height)
            if np.isinf(taken.query(area, distance_upper_bound=CLEAR)[0]).all():
                placed.append((slope, corner, height))
                taken = KDTree(np.concatenate([taken.data, area]))
                break
    return placed


def draw(axes, curves, slopes, colour, grid):
    """Draws the triangles with "1" below and the order beside each."""
    for slope, (x, y), height in place(axes, curves, slopes):
        corners = [(x, y), (x + WIDTH, y), (x + WIDTH, y + height)]
        from matplotlib.patches import Polygon
        axes.add_patch(Polygon(corners, closed=True, transform=axes.transAxes, facecolor=grid,
                               edgecolor=colour, linewidth=0.9, zorder=1.5))
        axes.text(x + WIDTH / 2, y - 0.012, "1", transform=axes.transAxes, ha="center", va="top",
                  color=colour, fontsize=11)
        axes.text(x + WIDTH + 0.012, y + height / 2, f"{slope:g}", transform=axes.transAxes,
                  ha="left", va="center", color=colour, fontsize=11)
