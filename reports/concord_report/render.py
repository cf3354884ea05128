"""Draws pictures in a process of its own: render.py JOBS.json vtk|plane|scatter. A job names a frame,
its colours and the view; the result is one line of JSON and the image's bytes."""

import io
import json
import sys
from pathlib import Path

sys.path = [p for p in sys.path if Path(p or ".").resolve() != Path(__file__).resolve().parent]
sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from concord_report import frames  # noqa: E402  (needs the path above)

QUALITY = 86  # of WebP: no visible loss on smooth shading


def encode(pixels):
    """(format, bytes, size) size of an RGBA array, as WebP where PIL can."""
    from PIL import Image, features
    image = Image.fromarray(pixels, "RGBA").convert("RGBa")  # averaging wants premultiplied alpha
    image = image.reduce(2).convert("RGBA")
    stream = io.BytesIO()
    if features.check("webp"):
        image.save(stream, "WEBP", quality=QUALITY, method=5)
        return "webp", stream.getvalue(), image.size
    image.save(stream, "PNG", optimize=True)
    return "png", stream.getvalue(), image.size


def main():
    jobs = json.loads(Path(sys.argv[1]).read_text())
    if sys.argv[2] == "vtk":
        from concord_report.render_vtk import draw
    elif sys.argv[2] == "plane":
        from concord_report.render_plane import draw
    else:
        from concord_report.render_scatter import draw
    for job in jobs:
        frame = frames.read(job["path"])
        pixels = draw(frame, job)
        if not pixels[..., 3].any():
            raise RuntimeError(f"the picture of {job['path']} came out empty")
        kind, data, size = encode(pixels)
        head = {"format": kind, "how": sys.argv[2], "width": size[0], "height": size[1]}
        Path(job["out"]).write_bytes(json.dumps(head).encode() + b"\n" + data)


if __name__ == "__main__":
    main()
