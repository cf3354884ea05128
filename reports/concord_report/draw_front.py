"""Plots of work against precision: the Pareto front as a staircase, a ring round each of its points, and what
a reader is told who points at a run."""

from .palette import ROLES

INK = ROLES["ink"][1]


def draw(axes, front):
    """The staircase: the least error that any run reaches within a time."""
    low, high = axes.get_ylim()
    right = axes.get_xlim()[1]
    x, y = [front[0][0]], [high]
    for time, error in front:
        x += [time, time]
        y += [y[-1], error]
    line, = axes.plot(x + [right], y + [y[-1]], color=INK, linewidth=1.1, linestyle=(0, (4, 2)), alpha=0.75, zorder=2.2)
    line.set_gid("front")
    axes.set_ylim(low, high)
    rings = axes.plot(*zip(*front), linestyle="none", marker="o", markersize=12.5, markerfacecolor="none",
                      markeredgecolor=INK, markeredgewidth=1.2, zorder=4, clip_on=False)
    rings[0].set_gid("rings")


def tips(axes, curves):
    """Invisible discs over the points, named "tip:N"; returns their texts."""
    told = []
    for curve in curves:
        for x, y, text in zip(curve["x"], curve["y"], curve["tips"]):
            disc, = axes.plot([x], [y], linestyle="none", marker="o", markersize=15, markerfacecolor=INK,
                              markeredgewidth=0, alpha=0, zorder=9, clip_on=False)
            disc.set_gid(f"tip:{len(told)}")
            told.append(text)
    return told
