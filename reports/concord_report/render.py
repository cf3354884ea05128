"""Draws pictures in a process of its own: render.py JOBS.json vtk|plane|scatter. A job names a frame,
its colours and the view; the result is one line of JSON and the image's bytes."""

import io
import json
import sys
from pathlib import Path

sys.path = [p for p in sys.path if Path(p or ".").resolve() != Path(__file__).resolve().parent]
sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from concord_report import films, frames  # noqa: E402  (needs the path above)

QUALITY = 86  # of WebP: no visible loss on smooth shading
COARSER = (78, 66, 54, 42, 30, 20)  # of the sheet of an animation, until it is light enough


def encode(pixels, qualities=(QUALITY,), budget=None):
    """(format, bytes, size) size of an RGBA array, as WebP where PIL can: at the first quality that `budget` bytes hold."""
    from PIL import Image, features
    image = Image.fromarray(pixels, "RGBA").convert("RGBa")  # averaging wants premultiplied alpha
    image = image.reduce(2).convert("RGBA")
    stream = io.BytesIO()
    if features.check("webp"):
        for quality in qualities:
            stream = io.BytesIO()
            image.save(stream, "WEBP", quality=quality, method=5 if budget is None else 4)
            if budget is None or stream.tell() <= budget:
                break
        return "webp", stream.getvalue(), image.size
    image.save(stream, "PNG", optimize=True)
    return "png", stream.getvalue(), image.size


def picture(job, draw):
    """(what is known of the job's picture, its bytes)."""
    drawings = []
    for path in job.get("film") or [job["path"]]:
        drawings.append(draw(frames.read(path), job))
        if not drawings[-1][..., 3].any():
            raise RuntimeError(f"the picture of {path} came out empty")
    if not job.get("film"):
        kind, data, size = encode(drawings[0])
        return {"format": kind, "width": size[0], "height": size[1]}, data
    kind, data, size = encode(films.sheet(drawings), COARSER, job["budget"])
    across = films.columns(len(drawings))
    return {"format": kind, "width": size[0] // across, "height": size[1] // -(-len(drawings) // across),
            "across": across, "down": -(-len(drawings) // across)}, data


def main():
    jobs = json.loads(Path(sys.argv[1]).read_text())
    if sys.argv[2] == "vtk":
        from concord_report.render_vtk import draw
    elif sys.argv[2] == "plane":
        from concord_report.render_plane import draw
    else:
        from concord_report.render_scatter import draw
    for job in jobs:
        head, data = picture(job, draw)
        Path(job["out"]).write_bytes(json.dumps({**head, "how": sys.argv[2]}).encode() + b"\n" + data)


if __name__ == "__main__":
    main()
