"""What stands below pictures and beside them: captions, colour bars, axes, how wide they are."""

import math

from . import frames
from .balance import SIGN, WORDS, broken
from .digits import engineering, exact, pretty, text, ticks
from .kinds import is_static
from .loading import number
from .palette import stops
from .quantities import field_name

OFF = 0.01  # of an instant: a frame that is farther from it tells its own time


def caption(job):
    """The caption's factual half: method, spacing, time, exaggeration, how large the field is."""
    case = job["case"]
    parts = [case.label.removesuffix(", " + case.scene.replace("_", " ")) if job.get("one_scene") else case.label]
    if job["h"]:
        parts.append(f"h = {exact(job['h'])} m" if job["h"] >= 0.01 else f"h = {exact(job['h'] * 1e3, 3)} mm")
    if job["film"]:
        parts.append(f"{len(job['film'])} frames")
    elif job["time"] and not _as_wanted(job) and job["scale"]:
        parts.append(time_text(job["time"], job["row"]))
    if job["scale"] != 1:
        parts.append(f"displacement ×{exact(job['scale'])}" if job["scale"] else "reference body")
    if case.method == "voronoi" and job["draw"] == "body" and not job["cells"] and job["particles"]:
        parts.append("surface through the outermost particles")
    if job["whole"] is not None and job["color"] != frames.PLAIN:
        factor, unit = engineering(max(map(abs, job["limits"])), field_name(job["color"])[1])
        parts.append(f"{ends(*(v * factor for v in job['range']))} {unit}".strip())
    if job.get("how") == "scatter":
        parts.append("plain scatter plot, because VTK or xvfb is not installed")
    if job["nan"]:
        parts.append(f"{job['nan']} points without a value in grey")
    if broken(job["row"]):
        parts.append(f"{SIGN} {WORDS}")
    return case, parts


def in_rows(whole):
    """True for a figure with a row of panels for each instant; instants of one body stand side by side."""
    several = whole and (whole.get("panels") or (whole["variant"] if isinstance(whole.get("variant"), list) else []))
    return bool(whole and whole.get("times")) and len(several) > 1


def _as_wanted(job):
    """True for a panel in a row of an instant, which the row tells, when its frame is of that instant."""
    wanted = number(job["picture"].get("time"))
    return in_rows(job["whole"]) and abs(job["time"] - wanted) <= OFF * abs(wanted)


def time_text(time, row):
    factor, unit = (1, "") if is_static(row) else engineering(time, "s") if time < 0.1 else (1, "s")
    return f"t = {exact(time * factor)} {unit}".strip()


def row_text(time, jobs):
    """What stands above a row of an instant: the time and, of bodies that are followed, where they are."""
    words = time_text(time, jobs[0]["row"])
    if not jobs[0]["followed"]:
        return words
    middle = [sum(j["middle"][k] for j in jobs) / len(jobs) for k in range(3)]
    reach = max(map(abs, middle))
    places = [f"{axis} = {text(v)} m" for axis, v in zip("xyz", middle) if abs(v) > 0.01 * reach]
    return f"{words}; bodies about {', '.join(places)}"


def triad():
    """[(axis, right, up)]: the unit vectors of pictures in three dimensions, as seen."""
    length = math.hypot(*frames.EYE)
    away = [v / length for v in frames.EYE]
    flat = math.hypot(away[0], away[1])
    right = (-away[1] / flat, away[0] / flat, 0.0)
    up = (-away[2] * right[1], away[2] * right[0], away[0] * right[1] - away[1] * right[0])
    return [(name, round(right[k], 3), round(up[k], 3)) for k, name in enumerate("xyz")]


def bar(job):
    """The colour bar of a job: name, unit, stops and ticks at fractions of its length."""
    name, unit = field_name(job["color"])
    low, high = job["limits"]
    factor, unit = engineering(max(abs(low), abs(high)), unit)
    scale_text = ""
    if not unit and 0 < max(abs(low), abs(high)) < 1e-2:
        power = math.floor(math.log10(max(abs(low), abs(high))))
        factor, scale_text = 10.0 ** -power, pretty(10.0 ** power, 1).removeprefix("1×")
    marks = []
    for value in ticks(low * factor, high * factor, 5):
        marks.append((round((value - low * factor) / ((high - low) * factor), 4),
                      exact(float(f"{value:.6g}") + 0.0)))
    return {"name": name, "unit": unit or scale_text, "marks": marks,
            "stops": stops(job["color"], job["diverging"]),
            "low": pretty(low * factor), "high": pretty(high * factor), "beyond": job["beyond"]}


def note(jobs):
    """The sentences below a group of pictures."""
    count, bar_ = len(jobs), jobs[0]["beyond"]
    out, plain = [], jobs[0]["color"] == frames.PLAIN
    if count > 1:
        which = "both" if count == 2 else f"all {count}"
        out.append(f"One {'' if plain else 'colour scale and one '}view for {which} pictures"
                   + (", each instant centred on its bodies." if any(j["followed"] for j in jobs) else "."))
    if any(bar_):
        ends_ = "The scale ends at the 1st and 99th percentile of all pictures together. " if jobs[0]["picture"].get("range") == "robust" else ""
        out.append(f"{ends_}Values beyond an end of the scale, where it has a tip, have that end’s colour: "
                   f"{share(max(j['clipped'] for j in jobs))} of the points{' of a picture' if count > 1 else ''}.")
    if jobs[0]["view"]["front"] and not jobs[0]["view"]["flat"]:
        out.append("Seen along z: x to the right, y upwards.")
    if any(j["plate"] for j in jobs):
        out.append("The grey plate is where the body is held.")
    if in_rows(jobs[0]["whole"]):
        out.append("Frames nearest to the instants; one that is more than 1 % off tells its own time.")
    return " ".join(out)


def share(part):
    """"up to 2.1 %"; less than a tenth is not told more exactly."""
    return "less than 0.1 %" if part < 1e-3 else f"up to {exact(100 * part, 2)} %"


def ends(low, high):
    """"0.018 to 0.673": both with the decimals of the larger one, which has three digits."""
    size = max(abs(low), abs(high))
    if not 1e-3 <= size < 1e5:
        return f"{pretty(low)} to {pretty(high)}"
    places = max(0, 2 - math.floor(math.log10(size)))
    def text(v): return f"{v:.{places}f}".replace("-", "−") if round(v, places) else "0"
    return f"{text(low)} to {text(high)}"


def extent(job, count):
    """How large a part of space each of the panels shows."""
    if not job["plane"]:
        return ""
    wide, high = (job["view"]["high"][k] - job["view"]["low"][k] for k in (0, 1))
    factor, unit = (1e3, "mm") if max(wide, high) < 1 else (1, "m")
    return f"{'each picture' if count > 1 else 'picture'} {exact(wide * factor, 3)} {unit} × {exact(high * factor, 3)} {unit}"


WIDEST, TALLEST = 330, 460  # of a panel on the page [CSS pixels]


def panel_width(job, rows):
    """How wide a panel stands on the page at most: tall bodies take less, rows of them still less."""
    tall = TALLEST if rows == 1 else 0.75 * TALLEST if rows < 4 else 0.6 * TALLEST
    return round(min(WIDEST, max(150, tall * job["width"] / job["height"])))  # `job`: the tallest


def columns(whole, count):
    """How many panels stand side by side: those of an instant; the author's number; one row up to four,
    else whole rows of three or four where there are."""
    if in_rows(whole):
        return max(1, count // len(whole["times"]))
    wanted = number(whole.get("columns"))
    if wanted and wanted >= 1 and count != 3:
        return min(int(wanted), count)
    if count <= 4:
        return count
    return next((n for n in (3, 4, 5) if count % n == 0), 4)
