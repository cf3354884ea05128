"""Areas to fill in pictures of plane problems: triangles inside finite elements, and the share of
the deformed body that belongs to each particle."""

import numpy as np

CORNERS = {5: 3, 22: 3, 9: 4, 23: 4, 28: 4}  # VTK type: corners; nodes on edges follow, then the centre
NODES = {5: 3, 22: 6, 9: 4, 23: 8, 28: 9}
TORN = 1.6  # times its length in the reference body: a longer edge joins the sides of a crack
SLENDER = 1.5  # spacings, the local one where that is larger: a larger circumradius is of a triangle across a notch, not in the body


def _triangle_shape(nodes, r, s):
    t = 1 - r - s
    if nodes == 3:
        return np.stack([t, r, s], -1)
    return np.stack([t * (2 * t - 1), r * (2 * r - 1), s * (2 * s - 1), 4 * t * r, 4 * r * s, 4 * s * t], -1)


def _quad_shape(nodes, r, s):
    """On the unit square, corners counted round from (0, 0)."""
    if nodes == 4:
        return np.stack([(1 - r) * (1 - s), r * (1 - s), r * s, (1 - r) * s], -1)
    if nodes == 8:
        x, y = 2 * r - 1, 2 * s - 1
        corner = [(1 + a * x) * (1 + b * y) * (a * x + b * y - 1) / 4 for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
        middle = [(1 - x * x) * (1 - y) / 2, (1 + x) * (1 - y * y) / 2, (1 - x * x) * (1 + y) / 2,
                  (1 - x) * (1 - y * y) / 2]
        return np.stack(corner + middle, -1)
    def along(v): return (1 - v) * (1 - 2 * v), v * (2 * v - 1), 4 * v * (1 - v)
    a, b = along(r), along(s)
    return np.stack([a[0] * b[0], a[1] * b[0], a[1] * b[1], a[0] * b[1],
                     a[2] * b[0], a[1] * b[2], a[2] * b[1], a[0] * b[2], a[2] * b[2]], -1)


def _shape(kind, r, s):
    return (_triangle_shape if CORNERS[kind] == 3 else _quad_shape)(NODES[kind], r, s)


def _lattice(corners, pieces):
    """(r, s, triangles) of the element's parent, each edge cut into `pieces`."""
    at = {}
    for j in range(pieces + 1):
        for i in range(pieces + 1 - (j if corners == 3 else 0)):
            at[i, j] = len(at)
    triangles = []
    for i, j in at:
        if (i + 1, j) in at and (i, j + 1) in at:
            triangles.append((at[i, j], at[i + 1, j], at[i, j + 1]))
            if (i + 1, j + 1) in at:
                triangles.append((at[i + 1, j], at[i + 1, j + 1], at[i, j + 1]))
    places = np.array(list(at), float) / pieces
    return places[:, 0], places[:, 1], np.array(triangles)


def supported(frame):
    """True when every cell is a plane element that is known here."""
    return len(frame["types"]) > 0 and set(np.unique(frame["types"]).tolist()) <= set(NODES)


def _of_kind(frame, kind):
    starts = np.asarray(frame["offsets"])[:-1][frame["types"] == kind]
    return frame["connectivity"][starts[:, None] + np.arange(NODES[kind])]


def elements(frame, positions, data, pieces):
    """(points, values, triangles, outlines): every element cut into small triangles by its own
    shape functions; outlines are polylines along the elements' edges, curved where they are."""
    points, values, triangles, outlines, count = [], [], [], [], 0
    for kind in map(int, np.unique(frame["types"])):
        nodes = _of_kind(frame, kind)
        r, s, small = _lattice(CORNERS[kind], pieces if NODES[kind] > CORNERS[kind] or CORNERS[kind] == 4 else 1)
        weights = _shape(kind, r, s)
        x, v = np.einsum("pn,end->epd", weights, positions[nodes]), np.einsum("pn,en->ep", weights, data[nodes])
        first = count + np.arange(len(nodes))[:, None, None] * len(r)
        triangles.append((small[None] + first).reshape(-1, 3))
        points.append(x.reshape(-1, 2))
        values.append(v.reshape(-1))
        count += v.size
        outlines += list(np.einsum("pn,end->epd", _shape(kind, *_rim(CORNERS[kind])), positions[nodes]))
    return np.concatenate(points), np.concatenate(values), np.concatenate(triangles), outlines


def rim(frame, outlines):
    """The body's edge as polylines: those edges of elements that no other element shares. `outlines`
    as from `elements`."""
    ends, lines, first = [], [], 0
    for kind in map(int, np.unique(frame["types"])):
        corner = _of_kind(frame, kind)[:, :CORNERS[kind]]
        for k in range(CORNERS[kind]):
            ends.append(np.stack([corner[:, k], corner[:, (k + 1) % CORNERS[kind]]], -1))
            lines += [outlines[first + e][k * PIECES:(k + 1) * PIECES + 1] for e in range(len(corner))]
        first += len(corner)
    return [lines[i] for i in _lonely(np.concatenate(ends))]


def _lonely(ends):
    """Positions of the pairs that occur once, in either direction."""
    _, first, count = np.unique(np.sort(ends, axis=1), axis=0, return_index=True, return_counts=True)
    return first[count == 1]


PIECES = 4  # of an element's edge, drawn as a polyline


def _rim(corners, pieces=PIECES):
    """(r, s) once around the parent."""
    places = np.array([(0, 0), (1, 0), (0, 1), (0, 0)] if corners == 3 else
                      [(0, 0), (1, 0), (1, 1), (0, 1), (0, 0)], float)
    at = np.arange(len(places) - 1)
    fine = np.linspace(0, len(places) - 1, (len(places) - 1) * pieces + 1)
    knots = np.append(at, len(places) - 1)
    return np.interp(fine, knots, places[:, 0]), np.interp(fine, knots, places[:, 1])


def shares(reference, positions, h, torn=False):
    """(quadrilaterals, owner of each, particles without any, the body's edge as lines). The triangles
    between neighbouring particles of the reference body are cut where points are as near to one
    particle as to the next; the pieces next to a particle are its share, carried along by the
    deformation. Of a body that is `torn`, triangles across a crack are left out."""
    from matplotlib.tri import Triangulation
    try:
        corner = Triangulation(reference[:, 0], reference[:, 1]).triangles
    except (RuntimeError, ValueError):  # fewer than three points, or all on a line
        return np.zeros((0, 4, 2)), np.zeros(0, int), np.arange(len(positions)), []
    opposite = np.linalg.norm(reference[np.roll(corner, -1, axis=1)] - reference[np.roll(corner, 1, axis=1)], axis=2)
    weight, radius = _centres(opposite)
    inside = radius <= SLENDER * np.maximum(max(h or 0.0, float(np.median(opposite))), np.median(_nearest(corner, opposite), axis=1))
    if torn:
        now = positions[corner]
        longest = np.linalg.norm(np.roll(now, -1, axis=1) - np.roll(now, 1, axis=1), axis=2)
        inside &= (longest <= TORN * opposite).all(axis=1)
    corner, weight = corner[inside], weight[inside]
    x = positions[corner]
    centre = np.repeat(np.einsum("tk,tkd->td", weight, x)[:, None], 3, axis=1)
    after, before = np.roll(x, -1, axis=1), np.roll(x, 1, axis=1)
    quads = np.stack([x, (x + after) / 2, centre, (x + before) / 2], axis=2).reshape(-1, 4, 2)
    alone = np.setdiff1d(np.arange(len(positions)), corner)
    ends = np.stack([corner, np.roll(corner, -1, axis=1)], -1).reshape(-1, 2)
    return quads, corner.reshape(-1), alone, list(positions[ends[_lonely(ends)]])


def _nearest(corner, opposite):
    """How far the nearest neighbour of each corner is: the spacing where particles are not equally dense."""
    near = np.full(corner.max() + 1, np.inf)
    for k in range(3):
        np.minimum.at(near, corner[:, k], np.minimum(opposite[:, k - 1], opposite[:, k - 2]))
    return near[corner]


def _centres(opposite):
    """(barycentric coordinates of the circumcentres, circumradii) of triangles with these edges, each
    opposite to its corner. Where the circumcentre lies outside, the middle of the longest edge
    stands for it: the pieces still fill the triangle."""
    squares = opposite ** 2
    weight = squares * (squares.sum(axis=1, keepdims=True) - 2 * squares)
    outside = (weight < 0).any(axis=1)
    weight[outside] = np.where(weight[outside] < 0, 0.0, 0.5)
    sixteen = 2 * (squares.sum(axis=1) ** 2 / 2 - (squares ** 2).sum(axis=1))  # (4 area)^2, Heron
    with np.errstate(divide="ignore", invalid="ignore"):
        radius = np.where(sixteen > 0, opposite.prod(axis=1) / np.sqrt(np.maximum(sixteen, 0)), np.inf)
        weight = weight / weight.sum(axis=1, keepdims=True)
    return np.nan_to_num(weight, nan=1 / 3), radius
