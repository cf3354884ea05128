"""Field pictures of a study: which frame, which colours, which scale. Drawn by render.py in a
process of its own (VTK needs an X display) and cached by content."""

import base64
import json
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from . import cache, frames
from .cases import chosen
from .digits import engineering, exact, pretty, ticks
from .loading import number
from .palette import RED_BLUE, VIRIDIS
from .quantities import field_name

SHARED_UP_TO = 8.0  # pictures share a scale while their largest values differ by at most this factor
CODE = ("render", "render_vtk", "render_scatter", "frames", "palette")


def _run_of(study, cases, picture):
    """(case, row, time, frame path) of the first run that the picture's selection has frames of;
    or a text: why not."""
    wanted = number(picture.get("resolution"))
    for case in chosen(cases, picture):
        levels = [l for l in case.levels if wanted is None or l.resolution == wanted]
        for level in reversed(levels):
            for row in level.rows:
                found = frames.series(study.folder / row["run"]) if row.get("run") else []
                if found:
                    return (case, row, *frames.at_time(found, picture.get("time")))
    if not chosen(cases, picture):
        return "this report has no such run"
    return "the run left no frames"


def prepare(study, cases, store, warnings):
    """The study's pictures as jobs: {picture, case, caption, ... , or "missing": reason}."""
    jobs = []
    for picture in study.listed("pictures"):
        color = picture.get("color") or "displacement"
        job = {"picture": picture, "color": color, "scale": number(picture.get("scale_displacement")) or 1.0}
        found = _run_of(study, cases, picture)
        if isinstance(found, str):
            job["missing"] = found
        else:
            case, row, job["time"], path = found
            job.update(case=case, h=number(row.get("h")), scene=case.scene, path=str(path),
                       resolution=number(row.get("resolution")), file=cache.file_digest(path))
            job.update(_facts(job, path, store))
        if "missing" in job:
            who = " ".join(str(picture[k]) for k in ("method", "variant", "resolution") if picture.get(k))
            job["label"] = who
            warnings.append(f"{study.name}: no picture of {who or 'the study'}: {job['missing']}")
        jobs.append(job)
    _share_scales([j for j in jobs if "missing" not in j])
    return jobs


def _facts(job, path, store):
    key = cache.digest(job["file"], job["color"], job["scale"], cache.source_digest("frames"))
    known = store.get(key, ".json")
    if known is None:
        known = json.dumps(frames.facts(path, job["color"], job["scale"])).encode()
        store.put(key, ".json", known)
    return json.loads(known)


def _share_scales(jobs):
    """Gives every job its group, colour limits and view: pictures of one scene share the view, and
    of one field the colours as well, unless a common scale would leave some of them in one hue."""
    for job in jobs:
        alike = [j for j in jobs if j["scene"] == job["scene"]]
        flat = all(j["flat"] for j in alike)
        room = max(0.5 * (j["h"] or 0) if j["particles"] else 0.0 for j in alike)
        seen = [j["seen_flat" if flat else "seen"] for j in alike]
        job["view"] = {"flat": flat, "low": [min(s[0][k] for s in seen) - room for k in range(3)],
                       "high": [max(s[1][k] for s in seen) + room for k in range(3)]}
        same = [j for j in alike if j["color"] == job["color"]]
        sizes = [max(map(abs, j["range"])) for j in same]
        shared = min(sizes) > 0 and max(sizes) / min(sizes) <= SHARED_UP_TO
        job["shared"] = shared and len(same) > 1
        job["group"] = (job["scene"], job["color"], "" if shared else jobs.index(job))
        ranges = [j["range"] for j in (same if shared else [job])]
        job["limits"], job["diverging"] = _limits(min(r[0] for r in ranges), max(r[1] for r in ranges))


def _limits(low, high):
    """Colour limits: symmetric about 0 when the field changes sign, from 0 when it nearly touches
    it, else its own range."""
    if low < 0 < high and min(-low, high) > 0.05 * max(-low, high):
        size = max(-low, high)
        return [-size, size], True
    if 0 <= low < 0.3 * high:
        low = 0.0
    if low == high:
        high = low + (abs(low) or 1.0)
    return [low, high], False


def _render_job(job):
    stops = RED_BLUE if job["diverging"] else VIRIDIS
    return {k: job[k] for k in ("path", "color", "scale", "limits", "view", "h", "particles", "flat")} \
        | {"stops": stops}


def _key(job):
    content = {k: v for k, v in _render_job(job).items() if k != "path"}
    return cache.digest(job["file"], content, cache.source_digest(*CODE))


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
    return data is not None and json.loads(data.partition(b"\n")[0])["how"] == "vtk"


def _render(wanted, store, warnings):
    """Under xvfb-run with VTK; with matplotlib alone where that is not to be had."""
    script = Path(__file__).with_name("render.py")
    with tempfile.TemporaryDirectory() as folder:
        todo = Path(folder) / "jobs.json"
        todo.write_text(json.dumps([{**j, "out": str(store.path(k, ".pic"))} for k, j in wanted.items()]))
        python = [sys.executable, str(script), str(todo)]
        attempts = [python + ["scatter"]]
        if shutil.which("xvfb-run"):
            attempts.insert(0, ["xvfb-run", "-a", "-s", "-screen 0 1600x1200x24", *python, "vtk"])
        else:
            warnings.append("xvfb-run is missing: field pictures are plain scatter plots")
        for attempt in attempts:
            env = {**os.environ, "PYTHONDONTWRITEBYTECODE": "1", "LIBGL_ALWAYS_SOFTWARE": "1"}
            done = subprocess.run(attempt, capture_output=True, text=True, env=env, check=False)
            if done.returncode == 0:
                return
            last = (done.stderr or done.stdout).strip().splitlines() or [f"status {done.returncode}"]
            warnings.append(f"pictures with {attempt[-1]} failed: {last[-1]}")


def data_uri(job):
    return f"data:image/{job['format']};base64,{base64.b64encode(job['image']).decode()}"


def caption(job):
    """The caption's factual half: method, spacing, time, exaggeration."""
    case, parts = job["case"], [job["case"].label]
    if job["h"]:
        parts.append(f"h = {exact(job['h'])} m")
    if job["time"]:
        factor, unit = engineering(job["time"], "s")
        parts.append(f"t = {exact(job['time'] * factor)} {unit}")
    if job["scale"] != 1:
        parts.append(f"displacement ×{exact(job['scale'])}")
    if job.get("how") == "scatter":
        parts.append("plain scatter plot, because VTK or xvfb is not installed")
    if job["nan"]:
        parts.append(f"{job['nan']} points without a value in grey")
    return case, parts


def bar(job):
    """The colour bar of a job: name, unit, stops and ticks at fractions of its length."""
    name, unit = field_name(job["color"])
    low, high = job["limits"]
    factor, unit = engineering(max(abs(low), abs(high)), unit)
    scale_text = ""
    if not unit and 0 < max(abs(low), abs(high)) < 1e-2:
        import math
        power = math.floor(math.log10(max(abs(low), abs(high))))
        factor, scale_text = 10.0 ** -power, pretty(10.0 ** power, 1).removeprefix("1×")
    marks = []
    for value in ticks(low * factor, high * factor, 5):
        marks.append((round((value - low * factor) / ((high - low) * factor), 4),
                      exact(float(f"{value:.6g}") + 0.0)))
    return {"name": name, "unit": unit or scale_text, "marks": marks,
            "stops": RED_BLUE if job["diverging"] else VIRIDIS,
            "low": pretty(low * factor), "high": pretty(high * factor)}
