"""Draws one frame with matplotlib alone: coloured points. For machines without VTK or xvfb."""

import numpy as np

from . import frames


def draw(frame, job):
    """RGBA pixels of the job's frame on a transparent ground."""
    import matplotlib
    matplotlib.use("agg")
    from matplotlib.colors import LinearSegmentedColormap, Normalize
    from matplotlib.figure import Figure
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    positions, _ = frames.deformed(frame, job["scale"])
    data = frames.values(frame, job["color"])
    good = np.isfinite(positions).all(axis=1)
    positions, data = positions[good], data[good]
    figure = Figure(figsize=(8.8, 6.6), dpi=200)
    canvas = FigureCanvasAgg(figure)
    figure.patch.set_alpha(0)
    look = {"c": data, "cmap": LinearSegmentedColormap.from_list("page", job["stops"]),
            "norm": Normalize(*job["limits"]), "s": max(4.0, min(120.0, 90000.0 / len(data))), "alpha": 1,
            "linewidths": 0}
    if job["view"]["flat"]:
        axes = figure.add_axes([0, 0, 1, 1], aspect="equal")
        axes.scatter(positions[:, 0], positions[:, 1], **look)
    else:
        axes = figure.add_axes([0, 0, 1, 1], projection="3d", elev=25, azim=-58)
        axes.patch.set_alpha(0)
        axes.scatter(*positions.T, **look)
        axes.set_box_aspect(np.maximum(np.ptp(positions, axis=0), 1e-300), zoom=1.1)
    axes.set_axis_off()
    canvas.draw()
    return np.asarray(canvas.buffer_rgba()).copy()
