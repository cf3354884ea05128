"""Draws one frame of a plane problem with matplotlib: finite elements with their own interpolation,
particles as the share of the deformed body that is nearest to each. One colour a particle: what a particle
method computes is not smoothed."""

import numpy as np

from . import frames, plane_cells, voronoi_cells
from .palette import WHOLE_OR_BROKEN

CRACKS = WHOLE_OR_BROKEN  # a field that only bodies have whose bonds can break
GREY = "#9e9e9e"
PALE = "#b7cfe6"  # of bodies without a field
EDGES = (0.05, 0.06, 0.08, 0.28)
RIM = (0.45, 0.47, 0.5, 0.9)
DOT_FROM = 15.0  # pixels of a spacing from which on particles show as dots
EDGES_FROM = 24.0  # pixels of an element from which on its edges are drawn: below, they hide the field
MANY = 6000  # elements; more are cut into fewer triangles
DPI = 100


def size(view, long):
    """Pixels of the drawing: the shape of what is seen, its longer side `long`."""
    wide, high = (view["high"][k] - view["low"][k] for k in (0, 1))
    reach = max(wide, high) or 1.0
    return tuple(2 * max(40, round(long * v / reach / 2)) for v in (wide, high))


def draw(frame, job):
    """RGBA pixels of the job's frame on a transparent ground."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.colors import LinearSegmentedColormap, Normalize
    from matplotlib.figure import Figure
    positions, reference = frames.deformed(frame, job["scale"])
    data = frames.values(frame, job["color"])
    view = job["view"]
    pixels = size(view, job["long"])
    figure = Figure(figsize=[p / DPI for p in pixels], dpi=DPI)
    canvas = FigureCanvasAgg(figure)
    figure.patch.set_alpha(0)
    axes = figure.add_axes([0, 0, 1, 1])
    axes.set_axis_off()
    axes.set_xlim(view["low"][0], view["high"][0])
    axes.set_ylim(view["low"][1], view["high"][1])
    colours = LinearSegmentedColormap.from_list("page", job["stops"])
    colours.set_bad(GREY)
    look = {"cmap": colours, "norm": Normalize(*job["limits"])}
    per_metre = pixels[0] / max(view["high"][0] - view["low"][0], 1e-300)
    if job["particles"]:
        reference = positions if reference is None else reference
        if job["draw"] == "spheres":
            _discs(axes, positions[:, :2], data, job["h"], look)
        elif job["cells"]:
            _cells(axes, job, reference, positions, data, per_metre, look)
        else:
            _particles(axes, reference[:, :2], positions[:, :2], data, job["h"], per_metre, look, CRACKS in frame["fields"])
    else:
        _elements(axes, frame, positions[:, :2], data, per_metre, look)
    canvas.draw()
    return np.asarray(canvas.buffer_rgba()).copy()


def _elements(axes, frame, positions, data, per_metre, look):
    from matplotlib.collections import LineCollection
    pieces = 4 if len(frame["types"]) < MANY else 2
    points, values, triangles, outlines = plane_cells.elements(frame, positions, data, pieces)
    axes.tripcolor(points[:, 0], points[:, 1], triangles, values, shading="gouraud", **look)
    length = np.median([np.linalg.norm(o[4] - o[0]) for o in outlines[:500]])
    if length * per_metre > EDGES_FROM:
        axes.add_collection(LineCollection(outlines, colors=[EDGES], linewidths=0.8), autolim=False)
    _rim(axes, plane_cells.rim(frame, outlines))


def _rim(axes, lines):
    """The body's edge: where a field is nearly white, the page would swallow the body."""
    from matplotlib.collections import LineCollection
    axes.add_collection(LineCollection(lines, colors=[RIM], linewidths=1.1, capstyle="round"), autolim=False)


def _particles(axes, reference, positions, data, h, per_metre, look, torn):
    from matplotlib.collections import PolyCollection
    good = np.isfinite(positions).all(axis=1)
    reference, positions = reference[good], positions[good]
    data = np.ma.masked_invalid(data[good])
    quads, owner, alone, edge = plane_cells.shares(reference, positions, h, torn)
    filled = PolyCollection(quads, array=data[owner], edgecolors="face", linewidths=0.5, antialiaseds=False, **look)  # no seams
    axes.add_collection(filled, autolim=False)
    _rim(axes, edge)
    if len(alone):
        _discs(axes, positions[alone], data[alone], h, look)
    if h and h * per_metre > DOT_FROM:
        _dots(axes, positions, 1.8)


def _dots(axes, positions, size, plain=False):
    """Particles: faint ones, or white ones with a dark rim, which show on every colour."""
    look = {"color": "white", "markeredgecolor": EDGES[:3], "markeredgewidth": 0.9} if plain else \
        {"color": EDGES[:3], "alpha": 0.45, "markeredgewidth": 0}
    axes.plot(positions[:, 0], positions[:, 1], "o" if plain else ".", markersize=size, **look)


def _discs(axes, positions, data, h, look):
    """Of diameter h."""
    from matplotlib.collections import EllipseCollection
    good = np.isfinite(positions).all(axis=1)
    positions, data = positions[good], np.ma.masked_invalid(data[good])
    wide = np.full(len(positions), h or 0.01 * np.ptp(positions, axis=0).max())
    axes.add_collection(EllipseCollection(wide, wide, np.zeros(len(positions)), units="xy", offsets=positions,
                                          offset_transform=axes.transData, array=data, linewidths=0, **look), autolim=False)


def _cells(axes, job, reference, positions, data, per_metre, look):
    """Each particle's Voronoi cell in one colour; with draw = "cells" all edges and the particles."""
    from matplotlib.collections import LineCollection, PolyCollection
    triangles, owner, inner, edge = voronoi_cells.plane(voronoi_cells.read(job["cells"]), reference, positions, job["h"])
    if job["color"] == frames.PLAIN:
        fill = {"facecolors": PALE, "edgecolors": PALE}
    else:
        fill = {"array": np.ma.masked_invalid(data[owner]), "edgecolors": "face", **look}
    axes.add_collection(PolyCollection(triangles, linewidths=0.5, **fill), autolim=False)
    shown = job["draw"] == "cells"
    if shown or job["h"] * per_metre > EDGES_FROM:
        axes.add_collection(LineCollection(inner, colors=[EDGES[:3] + (0.8,) if shown else EDGES], linewidths=0.9), autolim=False)
    _rim(axes, edge)
    if shown or job["h"] * per_metre > DOT_FROM:
        _dots(axes, positions, 5.0 if shown else 1.8, shown)
