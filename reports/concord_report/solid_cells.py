"""The surface of a three-dimensional body of particles, and the part of it that belongs to each particle."""

import numpy as np
from scipy.spatial import Delaunay, QhullError

from .plane_cells import _centres

SLENDER = 1.6  # spacings: a larger circumradius is of a tetrahedron across a notch, not in the body
FLAT = 1e-3  # of the cube on a spacing: less volume is none
STIR = 1e-6  # spacings: lattices are moved by so much, as many of their points lie on one sphere
FACES = np.array([(1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1)])  # of a tetrahedron, each opposite to its number


def surface(reference, h):
    """((n, 3) particles at the corners of the triangles that bound the reference body, anticlockwise as seen
    from outside, particles outside it)."""
    stirred = reference + STIR * h * np.random.default_rng(1).uniform(-1, 1, reference.shape)
    try:
        cells = Delaunay(stirred).simplices
    except (QhullError, ValueError):  # fewer than four particles, or all in a plane
        return np.zeros((0, 3), int), np.arange(len(reference))
    edges = stirred[cells[:, 1:]] - stirred[cells[:, :1]]
    volume = np.linalg.det(edges) / 6
    cells = np.where((volume < 0)[:, None], cells[:, [0, 2, 1, 3]], cells)
    body = _radius(stirred[cells]) <= SLENDER * h
    cells, volume = cells[body], abs(volume[body])
    return _peel(cells, volume > FLAT * h ** 3), np.setdiff1d(np.arange(len(reference)), cells)


def _radius(x):
    """Circumradii of tetrahedra; infinite where flat."""
    a = x[:, 1:] - x[:, :1]
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        b, c, d = a[:, 0], a[:, 1], a[:, 2]
        across = ((b ** 2).sum(1)[:, None] * np.cross(c, d) + (c ** 2).sum(1)[:, None] * np.cross(d, b)
                  + (d ** 2).sum(1)[:, None] * np.cross(b, c))
        radius = np.linalg.norm(across, axis=1) / abs(2 * (b * np.cross(c, d)).sum(1))
    return np.where(np.isfinite(radius), radius, np.inf)


def _peel(cells, solid):
    """The outer faces, after flat cells were taken off the outside as long as there are any."""
    kept = np.ones(len(cells), bool)
    while True:
        cell, face = _outer(cells[kept])
        cell = np.flatnonzero(kept)[cell]
        loose = cell[~solid[cell]]
        if not len(loose):
            return cells[cell[:, None], FACES[face]]
        kept[loose] = False


def _outer(cells):
    """(cell, number) of the faces that no other cell shares."""
    faces = np.sort(cells[:, FACES].reshape(-1, 3), axis=1)
    _, first, count = np.unique(faces, axis=0, return_index=True, return_counts=True)
    lonely = first[count == 1]
    return lonely // 4, lonely % 4


def shares(triangles, reference, positions):
    """(points, quadrilaterals, owner of each): the triangles cut where points of the reference body are as
    near to one particle as to the next, carried along by the deformation."""
    count = len(positions)
    ends = np.sort(np.stack([triangles, np.roll(triangles, -1, axis=1)], -1).reshape(-1, 2), axis=1)
    edges, number = np.unique(ends, axis=0, return_inverse=True)
    after = count + number.reshape(-1, 3)  # the middle of each corner's edge to the next corner
    before = np.roll(after, 1, axis=1)
    centre = count + len(edges) + np.repeat(np.arange(len(triangles))[:, None], 3, axis=1)
    corners = reference[triangles]
    weight, _ = _centres(np.linalg.norm(np.roll(corners, -1, axis=1) - np.roll(corners, 1, axis=1), axis=2))
    points = np.concatenate([positions, positions[edges].mean(axis=1),
                             np.einsum("tk,tkd->td", weight, positions[triangles])])
    return points, np.stack([triangles, after, centre, before], -1).reshape(-1, 4), triangles.reshape(-1)
