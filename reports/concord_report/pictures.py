"""Field pictures of a study: which frame, which colours, which scale. Drawn by render.py in a
process of its own (VTK needs an X display), plane bodies by matplotlib, and cached by content."""

import base64
import json
import os
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from . import cache, films, frames, voronoi_cells
from .cases import chosen
from .loading import number
from .palette import stops

SHARED_UP_TO = 8.0  # pictures share a scale while their largest values differ by at most this factor
SIGNS = 0.3  # of the larger end: a smaller one of the other sign does not make a scale that is white at 0
FOLLOW_FROM = 1.5  # bodies that move by more of their own size from row to row are followed
CODE = ("render", "render_vtk", "render_lines", "render_plane", "render_scatter", "render_cells", "plane_cells", "solid_cells",
        "voronoi_cells", "films", "frames", "palette")
TALL = 0.5  # width over height of the narrowest drawing (render_vtk)
WIDE = (1760, 1320)  # pixels of a solid body's drawing, alone and as a panel; the picture has half of it
LONG = 1720  # pixels of a plane drawing's longer side; the picture has half of it


def entries(study):
    """The study's pictures one by one: [(entry, None)], and for each panel of a [[picture]] with panels
    or instants (entry with the panel's keys over the picture's, the picture as it stands); an entry's
    `instant` is the number of its row."""
    out = []
    for picture in study.listed("pictures"):
        panels, times = picture.get("panels"), picture.get("times")
        if not panels and isinstance(picture.get("variant"), list) and len(picture["variant"]) > 1:
            panels = [{"variant": one, "caption": one} for one in picture["variant"]]
        if not panels and not times and films.wanted(picture) is None:
            out.append((picture, None))
            continue
        shared = {k: v for k, v in picture.items() if k not in ("panels", "caption", "times")}
        panels = [{**shared, **panel} for panel in panels or [{}]]
        for instant, time in enumerate(times or [None]):
            at = {} if time is None else {"time": time, "instant": instant}
            out += [({**panel, **at}, picture) for panel in panels]
    return out


def _run_of(study, cases, picture, color):
    """(case, row, time, path, field) of the first run that the picture's selection has frames of, times and
    paths of an animation; or a text: why not."""
    wanted = number(picture.get("resolution"))
    for case in chosen(cases, picture):
        levels = [l for l in case.levels if wanted is None or abs(l.resolution - wanted) <= 1e-4 * wanted]
        for level in reversed(levels):
            for row in level.rows:
                folder = study.folder / row["run"] if row.get("run") else None
                if folder is None:
                    continue
                if picture.get("difference"):
                    path = folder / "difference.hdf"
                    named = color.endswith(("_difference", "_reference"))
                    if path.is_file():
                        return case, row, None, path, color if named else f"{color}_difference"
                elif found := frames.series(folder):
                    told = films.wanted(picture)
                    if told and (film := films.instants(found, told)):
                        return case, row, [t for t, _ in film], [str(path) for _, path in film], color
                    return (case, row, *frames.at_time(found, picture.get("time")), color)
    if not chosen(cases, picture):
        return "this report has no such run"
    return "the run left no difference.hdf" if picture.get("difference") else "the run left no frames"


def prepare(study, cases, store, warnings):
    """The study's pictures as jobs: {picture, case, caption, ... , or "missing": reason}."""
    jobs = []
    for picture, whole in entries(study):
        color = picture.get("color") or "displacement"
        scale = number(picture.get("scale_displacement"))
        job = {"picture": picture, "color": color, "scale": 1.0 if scale is None else scale, "film": None,
               "whole": whole, "crop": picture.get("crop")}
        found = _run_of(study, cases, picture, color)
        if isinstance(found, str):
            job["missing"] = found
        else:
            case, row, job["time"], path, job["color"] = found
            paths = path if isinstance(path, list) else [path]
            if isinstance(path, list):
                job["film"], job["times"], job["time"] = paths, job["time"], job["time"][-1]
            job.update(case=case, h=number(row.get("h")), scene=case.scene, path=str(paths[-1]), row=row,
                       resolution=number(row.get("resolution")), file=[cache.file_digest(p) for p in paths])
            job.update(films.together([_facts(job, p, digest, store) for p, digest in zip(paths, job["file"])]))
            _how(job, picture, study.folder / row["run"])
        if "missing" in job:
            who = " ".join(" or ".join(map(str, v)) if isinstance(v := picture[k], list) else str(v)
                           for k in ("method", "variant", "resolution") if picture.get(k))
            job["label"] = who
            remark = f"{study.name}: no picture of {who or 'the study'}: {job['missing']}"
            warnings += [] if remark in warnings else [remark]  # once for all instants
        jobs.append(job)
    drawn = [j for j in jobs if "missing" not in j]
    _share_scales(drawn)
    for job in drawn:
        job["clipped"] = max(_clipped(job, store)) if any(job["beyond"]) else 0.0
    return jobs


def _known(store, make, *parts):
    """What `make` returns, from the cache where it is there."""
    key = cache.digest(*parts, cache.source_digest("frames", "plane_cells"))
    known = store.get(key, ".json")
    if known is None:
        known = json.dumps(make()).encode()
        store.put(key, ".json", known)
    return json.loads(known)


def _facts(job, path, digest, store):
    what = job["color"], job["scale"], job["crop"]
    return _known(store, lambda: frames.facts(path, *what), digest, *what)


def _clipped(job, store):
    """The shares of points beyond the scale's ends, a number a frame."""
    what = job["color"], job["scale"], job["crop"], job["limits"]
    return [_known(store, lambda p=path: frames.beyond(p, *what), digest, *what)
            for path, digest in zip(job["film"] or [job["path"]], job["file"])]


def _how(job, picture, folder):
    """How the body is drawn, and the file of its Voronoi cells where the run left one."""
    job["draw"] = picture.get("draw") or "body"
    cells = voronoi_cells.path_in(folder) if job.get("particles") else None
    job["cells"], job["cells_file"] = (str(cells), cache.file_digest(cells)) if cells else (None, None)
    if job["draw"] == "cells" and not cells and "missing" not in job:
        job["missing"] = "the run left no cells.vtkhdf"


def _together(job, other):
    """True when two pictures share their view: panels of one picture, or the same part of a scene."""
    if bool(job["film"]) != bool(other["film"]):
        return False
    if job["whole"] is not None or other["whole"] is not None:
        return job["whole"] is other["whole"]
    return job["scene"] == other["scene"] and job["crop"] == other["crop"]


def _share_scales(jobs):
    """Gives every job its group, colour limits and view: panels of one picture share both; other
    pictures of one scene share the view, and of one field the colours as well, unless a common
    scale would leave some of them in one hue."""
    for job in jobs:
        alike = [j for j in jobs if _together(job, j)]
        flat = all(j["flat"] for j in alike)
        job["plane"] = flat and all(j["plane"] for j in alike)
        job["view"] = _view(job, alike, flat)
        if job["cells"] and not job["plate"] and job["draw"] == "body":  # no particle of it lies on the face that is held
            job["plate"] = next((j["plate"] for j in alike if j["plate"] and j["scene"] == job["scene"]), None)
        job["one_scene"] = job["whole"] is not None and len({j["scene"] for j in alike}) == 1
        wanted = job["picture"].get("range")
        job["budget"] = films.BUDGET // len([j for j in alike if j["film"]] or [job])
        same = [j for j in alike if j["color"] == job["color"] and j["picture"].get("range") == wanted]
        sizes = [max(map(abs, j["range"])) for j in same]
        shared = wanted is not None or job["whole"] is not None or \
            (min(sizes) > 0 and max(sizes) / min(sizes) <= SHARED_UP_TO)
        job["shared"] = shared and len(same) > 1
        job["group"] = (id(job["whole"]), job["scene"], job["color"], str(wanted), str(job["crop"]), bool(job["film"]),
                        "" if shared else jobs.index(job))
        span = _tails(same) if wanted == "robust" else [e(j["range"][k] for j in (same if shared else [job])) for k, e in ((0, min), (1, max))]
        job["limits"], job["diverging"] = _limits(*span, wanted, job["color"].endswith("_difference"))
        low, high = (e(j["range"][k] for j in same) for k, e in ((0, min), (1, max)))
        job["beyond"] = [low < job["limits"][0], high > job["limits"][1]]
        job["long"] = LONG if len(same) <= 2 else LONG * 3 // 4 if len(same) <= 4 else LONG * 3 // 5


def _view(job, alike, flat):
    """What is seen: the extent of all bodies, or the crop. The rows of a figure with instants have one width and each the
    height that it needs. Where the bodies travel, each row has its own middle."""
    front = flat or all(j["thin"] for j in alike)
    room = max((0.6 if j["cells"] else 0.5) * (j["h"] or 0) if j["particles"] else 0.0 for j in alike)
    def extent(jobs):
        seen = [j["seen_flat" if front else "seen"] for j in jobs]
        return ([min(s[0][k] for s in seen) - room for k in range(3)],
                [max(s[1][k] for s in seen) + room for k in range(3)])
    low, high = extent(alike)
    rows = {}
    for other in alike:
        rows.setdefault(other["picture"].get("instant"), []).append(other)
    ends = {row: extent(jobs) for row, jobs in rows.items()}
    size = [max(e[1][k] - e[0][k] for e in ends.values()) for k in range(3)]
    job["followed"] = any(high[k] - low[k] > FOLLOW_FROM * max(size[:2]) for k in (0, 1)) and not job["crop"]
    if job["followed"]:
        a, b = ends[job["picture"].get("instant")]
        low = [(a[k] + b[k] - size[k]) / 2 for k in range(3)]
        high = [(a[k] + b[k] + size[k]) / 2 for k in range(3)]
    a, b = ends[job["picture"].get("instant")]
    if high[0] - low[0] > TALL * (b[1] - a[1]):  # a drawing has at least this shape: narrower, its scale would differ
        low[1], high[1] = a[1], b[1]
    view = {"flat": flat, "front": front, "low": low, "high": high}
    for k, along in enumerate("xy"):
        if flat and (job["crop"] or {}).get(along):
            view["low"][k], view["high"][k] = map(float, job["crop"][along])
    return view


def _tails(jobs):
    """The low and the high percentile of the values in all pictures, each picture with the same weight."""
    pooled = sorted((value, 1 / len(job["quantiles"])) for job in jobs for value in job["quantiles"])
    ends, at, whole = [], 0.0, float(len(jobs))
    for value, weight in pooled:
        at += weight
        while len(ends) < 2 and at >= whole * frames.TAILS[len(ends)] / 100 - 1e-9:
            ends.append(value)
    return ends


def _limits(low, high, wanted=None, difference=False):
    """Colour limits: what the author wants; symmetric about 0 for a difference and when the field
    changes sign; from 0 when it nearly touches it; else its own range."""
    if difference:
        size = max(map(abs, wanted if isinstance(wanted, list) else (low, high))) or 1.0
        return [-size, size], True
    if isinstance(wanted, list):
        return wanted, wanted[0] == -wanted[1]
    if low < 0 < high and min(-low, high) > SIGNS * max(-low, high):
        size = max(-low, high)
        return [-size, size], True
    if 0 <= low < 0.3 * high:
        low = 0.0
    if low == high:
        high = low + (abs(low) or 1.0)
    return [low, high], False


def _render_job(job):
    more = {"long": job["long"]} if job["plane"] else {"wide": WIDE[job["whole"] is not None]}
    if job["film"]:
        more = {"film": job["film"], "long" if job["plane"] else "wide": 2 * films.WIDE, "budget": job["budget"]}
    return {k: job[k] for k in ("path", "color", "scale", "limits", "view", "h", "particles", "flat", "plate", "draw", "cells")} \
        | {"stops": stops(job["color"], job["diverging"]), **more}


def _key(job):
    content = {k: v for k, v in _render_job(job).items() if k not in ("path", "film", "cells")}
    return cache.digest(job["file"], job["cells_file"], content, cache.source_digest(*CODE))


def render_missing(jobs, store, warnings):
    """Draws, in one process, every picture that the cache lacks. Sets job["image"] to its bytes
    and job["how"] to what drew it."""
    wanted = {}
    for job in jobs:
        if "missing" not in job:
            job["key"] = _key(job)
            if not _finished(store.get(job["key"], ".pic")):
                wanted[job["key"]] = _render_job(job)
    if wanted:
        _render(wanted, store, warnings)
    for job in jobs:
        if "key" in job:
            data = store.get(job["key"], ".pic")
            if data is None:
                job["missing"] = "drawing failed"
                continue
            head, _, job["image"] = data.partition(b"\n")
            job.update(json.loads(head))


def _finished(data):
    """True for a picture that need not be drawn again; a scatter plot only stands in for one."""
    return data is not None and json.loads(data.partition(b"\n")[0])["how"] in ("vtk", "plane")


def _render(wanted, store, warnings):
    """Plane bodies with matplotlib, beside them others with VTK under xvfb-run; with matplotlib
    alone, as a scatter plot, where that is not to be had."""
    plane = {k: j for k, j in wanted.items() if "long" in j}
    solid = {k: j for k, j in wanted.items() if "long" not in j}
    ways = [("scatter", [])]
    if shutil.which("xvfb-run"):
        ways.insert(0, ("vtk", ["xvfb-run", "-a", "-s", "-screen 0 1600x1200x24"]))
    elif solid:
        warnings.append("xvfb-run is missing: field pictures are plain scatter plots")
    with ThreadPoolExecutor() as beside:
        drawn = [beside.submit(_attempts, jobs, how, store)
                 for jobs, how in ((plane, [("plane", [])]), (solid, ways)) if jobs]
    for failures in drawn:
        warnings += failures.result()


def _attempts(wanted, ways, store):
    """Draws with the first of the ways that succeeds; returns warnings about those that did not."""
    warnings = []
    script = Path(__file__).with_name("render.py")
    with tempfile.TemporaryDirectory() as folder:
        todo = Path(folder) / "jobs.json"
        todo.write_text(json.dumps([{**j, "out": str(store.path(k, ".pic"))} for k, j in wanted.items()]))
        for way, before in ways:
            env = {**os.environ, "PYTHONDONTWRITEBYTECODE": "1", "LIBGL_ALWAYS_SOFTWARE": "1"}
            done = subprocess.run([*before, sys.executable, str(script), str(todo), way], capture_output=True,
                                  text=True, env=env, check=False)
            if done.returncode == 0:
                break
            last = (done.stderr or done.stdout).strip().splitlines() or [f"status {done.returncode}"]
            warnings.append(f"pictures with {way} failed: {last[-1]}")
    return warnings


def data_uri(job):
    return f"data:image/{job['format']};base64,{base64.b64encode(job['image']).decode()}"
