"""Animations: which frames of the runs, on one scale and one view, and the sheet that holds them all. The page shows one of
its pictures at a time."""

from . import frames
from .loading import number

WIDE = 360  # pixels of a frame, at most
BUDGET = 500_000  # bytes of an animation, all of its panels together
COLUMNS = 6  # of pictures on a sheet


def wanted(picture):
    """{frames, seconds, from, to} of a picture that is to move, or None."""
    told = picture.get("animate")
    return None if told is None else {"frames": 24, "seconds": 4, **told}


def instants(found, told):
    """At most as many of the frames [(time, path)] as wanted, evenly spaced over the time wanted."""
    first, last = (found[k][0] if number(told.get(key)) is None else float(told[key]) for k, key in ((0, "from"), (-1, "to")))
    inside = [f for f in found if first - 1e-9 * abs(first) <= f[0] <= last + 1e-9 * abs(last)]
    count = min(max(2, round(told["frames"])), len(inside))
    if count < 2:
        return inside
    start, end = inside[0][0], inside[-1][0]
    picked = [frames.at_time(inside, start + k * (end - start) / (count - 1)) for k in range(count)]
    return [f for k, f in enumerate(picked) if k == 0 or f != picked[k - 1]]


def together(facts):
    """What all frames of a body need: the largest range and extent; the rest is the last frame's."""
    gone = next((f for f in facts if "missing" in f), None)
    if gone:
        return gone
    def ends(key):
        return [[min(f[key][0][k] for f in facts) for k in range(3)], [max(f[key][1][k] for f in facts) for k in range(3)]]
    def span(key):
        return [min(f[key][0] for f in facts), max(f[key][1] for f in facts)]
    return {**facts[-1], "seen": ends("seen"), "seen_flat": ends("seen_flat"), "range": span("range"),
            "quantiles": [q for f in facts for q in f["quantiles"]],
            "flat": all(f["flat"] for f in facts), "thin": facts[0]["thin"], "plane": all(f["plane"] for f in facts), "nan": max(f["nan"] for f in facts)}


def columns(count):
    return min(count, COLUMNS)


def sheet(drawings):
    """One RGBA array of all drawings, in rows."""
    import numpy as np
    high, wide, _ = drawings[0].shape
    across = columns(len(drawings))
    out = np.zeros((-(-len(drawings) // across) * high, across * wide, 4), np.uint8)
    for k, pixels in enumerate(drawings):
        row, column = divmod(k, across)
        out[row * high:(row + 1) * high, column * wide:(column + 1) * wide] = pixels
    return out
