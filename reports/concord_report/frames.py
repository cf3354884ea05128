"""VTKHDF UnstructuredGrid frames and their series, read with h5py."""

from pathlib import Path

from .loading import InputError, number, read_json

EYE = (0.62, -1.0, 0.55)  # direction to the eye in three dimensions
THIN = 0.3  # of its other extents: a body that is thinner along z is seen along z
HELD = 0.9  # of a face's points: fewer do not hold it
PLAIN = "none"  # instead of a field: the shape alone
TAILS = (1, 99)  # percentiles at the ends of a robust scale
QUANTILES = [k / 2 for k in range(201)]  # that stand for a picture's values
POINT_CELL = 1  # VTK_VERTEX: the frame of a particle method


def series(folder):
    """[(time, path)] of the frames in a run's folder, in time's order; [] when it has none."""
    index = Path(folder) / "fields.hdf.series"
    if not index.is_file():
        return []
    data = read_json(index)
    try:
        frames = [(float(f["time"]), index.parent / f["name"]) for f in data["files"]]
    except (KeyError, TypeError, ValueError) as error:
        raise InputError(f"{index}: expected \"files\": [{{\"name\", \"time\"}}]; {error!r}") from error
    return sorted((f for f in frames if f[1].is_file()), key=lambda f: f[0])


def at_time(frames, time=None):
    """The frame nearest to `time` [s]; the last one when no time is given."""
    if not frames:
        return None
    time = number(time)
    return frames[-1] if time is None else min(frames, key=lambda f: abs(f[0] - time))


def read(path):
    """{points, connectivity, offsets, types, fields} as numpy arrays; InputError when broken."""
    import h5py
    try:
        with h5py.File(path, "r") as file:
            root = file["VTKHDF"]
            kind = root.attrs["Type"]
            kind = kind.decode() if isinstance(kind, bytes) else str(kind)
            if kind != "UnstructuredGrid":
                raise InputError(f"{path}: Type is {kind}, expected UnstructuredGrid")
            points = root["Points"][()].reshape(-1, 3)
            fields = {name: data[()] for name, data in root.get("PointData", {}).items()}
            mesh = {key.lower(): root[key][()] for key in ("Connectivity", "Offsets", "Types")}
    except (OSError, KeyError, ValueError, TypeError) as error:
        raise InputError(f"{path}: not a readable VTKHDF frame: {error}") from error
    for name, data in fields.items():
        if len(data) != len(points):
            raise InputError(f"{path}: PointData/{name} has {len(data)} values for {len(points)} points")
    return {"points": points, "fields": fields, **mesh}


def values(frame, color):
    """The point field to colour by, as one number a point: vectors by their length, components by
    "displacement_x". None when the frame lacks it."""
    import numpy as np
    from .quantities import split_component
    if color == PLAIN:
        return np.zeros(len(frame["points"]))
    base, component = split_component(color)
    if color in frame["fields"]:
        base, component = color, None
    data = frame["fields"].get(base)
    if data is None:
        return None
    if data.ndim == 1 or data.shape[1] == 1:
        return np.asarray(data, float).reshape(-1)
    return np.linalg.norm(data, axis=1) if component is None else np.asarray(data[:, component], float)


def deformed(frame, scale):
    """(positions with the displacement exaggerated by `scale`, reference positions or None)."""
    displacement = frame["fields"].get("displacement")
    if displacement is None:
        return frame["points"], None
    reference = frame["points"] - displacement
    return reference + scale * displacement, reference


def is_particles(frame):
    return len(frame["types"]) == 0 or bool((frame["types"] == POINT_CELL).all())


def facts(path, color, scale, crop=None):
    """What the choice of colours and view needs: range, bounds, flatness, fields, or the reason
    why there is no picture. `crop` {x: [low, high], y: [low, high]} [m] limits range and bounds to what
    is seen of a plane body."""
    import numpy as np

    from . import plane_cells
    frame = read(path)
    data = values(frame, color)
    if data is None:
        return {"missing": f"the frame has no point field '{color}'; it has: "
                           + (", ".join(sorted(frame["fields"])) or "none")}
    positions, reference = deformed(frame, scale)
    there = _inside(positions, crop)
    if not there.any():
        return {"missing": "nothing of the body lies inside the crop" if crop else "no point has a place"}
    good = data[there & np.isfinite(data)]
    good_positions = positions[there]
    if not len(good):
        return {"missing": f"every value of '{color}' is NaN"}
    low, high = good_positions.min(axis=0), good_positions.max(axis=0)
    flat = bool(high[2] - low[2] < 1e-9 * max((high - low).max(), 1e-300))
    middle = good_positions.mean(axis=0).tolist()
    plate = None if flat or crop else held(frame)
    if plate:
        good_positions = np.concatenate([good_positions, plate])
    def seen(axes):
        along = good_positions @ np.array(axes).T
        return [along.min(axis=0).tolist(), along.max(axis=0).tolist()]
    particles = is_particles(frame)
    return {"seen": seen(view_axes(False)), "seen_flat": seen(view_axes(True)),
            "range": [float(good.min()), float(good.max())], "quantiles": np.percentile(good, QUANTILES).tolist(), "flat": flat,
            "thin": _thin(positions if reference is None else reference), "points": len(positions),
            "particles": particles, "plate": plate, "middle": middle, "nan": int(len(data) - np.isfinite(data).sum()),
            "plane": flat and (particles or plane_cells.supported(frame))}


def beyond(path, color, scale, crop, limits):
    """The share of the points seen whose values lie beyond the limits."""
    import numpy as np
    frame = read(path)
    data, there = values(frame, color), _inside(deformed(frame, scale)[0], crop)
    good = data[there & np.isfinite(data)]
    return float(((good < limits[0]) | (good > limits[1])).mean()) if len(good) else 0.0


def _inside(positions, crop):
    """Which points have a place, inside the crop."""
    import numpy as np
    there = np.isfinite(positions).all(axis=1)
    for k, along in enumerate("xy"):
        if crop and crop.get(along):
            there &= (positions[:, k] >= crop[along][0]) & (positions[:, k] <= crop[along][1])
    return there


def _thin(reference):
    """True for a body that is seen best along z: a strip or a plate in the plane of x and y."""
    import numpy as np
    size = np.ptp(reference[np.isfinite(reference).all(axis=1)], axis=0)
    return bool(size[2] < THIN * size[:2].min())


def held(frame):
    """Corners of a plate behind the face of a body at which most points were held while others moved; None when
    there is no such face, or when the plate would hide the body. Corner 4 i + 2 j + k: ends i, j, k along x, y, z."""
    import numpy as np
    moved = frame["fields"].get("displacement")
    if moved is None or not np.abs(moved).max() > 0:
        return None
    reference = frame["points"] - moved
    points = reference[(np.abs(moved) <= 1e-12 * np.abs(moved).max()).all(axis=1)]
    if len(points) < 3:
        return None
    low, high = points.min(axis=0), points.max(axis=0)
    size = (high - low).max()
    thin = np.flatnonzero(high - low < 1e-6 * size)
    if len(thin) != 1:
        return None
    across = thin[0]
    whole = reference.mean(axis=0)
    face = np.abs(reference[:, across] - low[across]) < 1e-6 * size
    towards_eye = (low - whole)[across] * EYE[across] > 0
    if towards_eye or len(points) < HELD * face.sum():
        return None
    grown = np.where(np.arange(3) == across, 0.0, 0.22 * size)
    low, high = low - grown, high + grown
    if whole[across] > low[across]:
        low[across] -= 0.1 * size
    else:
        high[across] += 0.1 * size
    ends = np.array([low, high])
    return [[float(ends[i, 0]), float(ends[j, 1]), float(ends[k, 2])] for i in (0, 1) for j in (0, 1) for k in (0, 1)]


def view_axes(front):
    """Rows: the unit vectors to the right, upwards, and towards the eye, of every picture."""
    import numpy as np
    if front:
        return np.eye(3)
    away = np.array(EYE) / np.linalg.norm(EYE)
    right = np.cross((0.0, 0.0, 1.0), away)
    right /= np.linalg.norm(right)
    return np.array([right, np.cross(away, right), away])
