"""Voronoi cells of particles that lie inside their body: the polygons that a run wrote beside its frames, and how they
deform. A corner of cells moves with the mean of x_a + F_a (X - X_a) over the particles a whose cells meet there, F_a
fitted to the neighbours by least squares: exact where the deformation is affine, and without gaps elsewhere."""

import numpy as np

from .loading import InputError

FILES = ("cells.vtkhdf", "cells.hdf")
MERGED = 1e-5  # spacings: corners of two cells that are nearer to each other are one


def path_in(folder):
    """The file of the cells in a run's folder, or None."""
    return next((folder / name for name in FILES if (folder / name).is_file()), None)


def read(path):
    """{points, corners, begin, particle, neighbour, wall} of the polygons, lines in the plane."""
    import h5py
    try:
        with h5py.File(path, "r") as file:
            root = file["VTKHDF"]
            data = root["CellData"]
            out = {"points": root["Points"][()].reshape(-1, 3), "corners": root["Connectivity"][()].astype(int),
                   "begin": root["Offsets"][()].astype(int), "particle": data["particle"][()].astype(int)}
            out["wall"] = data["wall"][()].astype(int) if "wall" in data else None
            out["neighbour"] = data["neighbour"][()].astype(int) if "neighbour" in data else None
    except (OSError, KeyError, ValueError, TypeError) as error:
        raise InputError(f"{path}: not readable as Voronoi cells: {error}") from error
    if out["neighbour"] is None:
        raise InputError(f"{path}: CellData/neighbour is missing")
    if len(out["begin"]) != len(out["particle"]) + 1:
        raise InputError(f"{path}: {len(out['begin'])} offsets for {len(out['particle'])} polygons")
    out["wall"] = out["neighbour"] < 0
    return out


def gradients(X, u, pairs):
    """H_a of the affine fit u_b - u_a = H_a (X_b - X_a) over the neighbours in `pairs` (a, b); none across directions
    in which there are no neighbours."""
    a, b = np.concatenate([pairs, pairs[:, ::-1]]).T
    branch, jump = X[b] - X[a], u[b] - u[a]
    weight = 1 / np.maximum((branch ** 2).sum(1), 1e-300)
    moment, mixed = np.zeros((len(X), 3, 3)), np.zeros((len(X), 3, 3))
    np.add.at(moment, a, weight[:, None, None] * branch[:, :, None] * branch[:, None, :])
    np.add.at(mixed, a, weight[:, None, None] * jump[:, :, None] * branch[:, None, :])
    return mixed @ np.linalg.pinv(moment, rcond=1e-6, hermitian=True)


def _merged(points, near):
    """(number of the corner that each point is, how many corners)."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import KDTree
    pairs = KDTree(points).query_pairs(near, output_type="ndarray")
    graph = coo_matrix((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(len(points),) * 2)
    count, label = connected_components(graph, directed=False)
    return label, count


def polygons(cells, X, x, h, chosen=None):
    """(corners moved, those of each polygon in turn, begin, particle, neighbour) of the polygons `chosen` (a mask; default
    all), for particles at X in the reference body, now at x."""
    if max(cells["particle"].max(), cells["neighbour"].max()) >= len(X):
        raise InputError(f"the cells are of more than the frame's {len(X)} particles")
    inner = ~cells["wall"]
    H = gradients(X, x - X, np.stack([cells["particle"][inner], cells["neighbour"][inner]], -1))
    chosen = np.ones(len(inner), bool) if chosen is None else chosen
    size = np.diff(cells["begin"])
    mine = np.repeat(chosen, size)
    corner = cells["points"][cells["corners"][mine]]
    particle, neighbour, size = cells["particle"][chosen], cells["neighbour"][chosen], size[chosen]
    label, count = _merged(corner, MERGED * h)
    meets = np.stack([np.concatenate([label, label]), np.concatenate([np.repeat(particle, size), np.repeat(neighbour, size)])], -1)
    meets = np.unique(meets[meets[:, 1] >= 0], axis=0)
    place = np.zeros((count, 3))
    place[label] = corner
    at, a = meets.T
    moved = x[a] + (place[at] - X[a]) + np.einsum("nij,nj->ni", H[a], place[at] - X[a])
    out = np.zeros((count, 3))
    np.add.at(out, at, moved)
    return (out / np.bincount(at, minlength=count)[:, None], label, np.concatenate([[0], np.cumsum(size)]), particle, neighbour)


def skin(cells, X, x, h):
    """(points, corners of each polygon in turn, begin, owner): the body's surface, a particle's pieces of it each."""
    points, corners, begin, owner, _ = polygons(cells, X, x, h, cells["wall"])
    return points, corners, begin, owner


def plane(cells, X, x, h):
    """(triangles (n, 3, 2), owner of each, segments between cells, segments on the body's edge): cells in the plane, cut
    into triangles about their particles."""
    points, corners, begin, particle, neighbour = polygons(cells, X, x, h)
    ends = points[np.stack([corners[begin[:-1]], corners[begin[1:] - 1]], -1)][:, :, :2]
    both = neighbour >= 0
    owner = np.concatenate([particle, neighbour[both]])
    side = np.concatenate([ends, ends[both]])
    return np.concatenate([x[owner, None, :2], side], axis=1), owner, ends[both], ends[~both]
