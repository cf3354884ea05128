#!/usr/bin/python3
"""Makes index.html, summary.md, junit.xml and report.json from a folder of studies.

Reads files only. Exit status: 0 the report was made (whatever the verdicts), 2 bad input."""

import argparse
import sys
from pathlib import Path

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).resolve().parent))

from concord_report import outputs, page  # noqa: E402  (needs the path above)
from concord_report.cache import Cache  # noqa: E402
from concord_report.loading import InputError, load_studies  # noqa: E402


def _write(path, text):
    part = path.with_name(path.name + ".part")
    part.write_text(text, encoding="utf-8")
    part.replace(path)


def make(studies_folder, out, cache_folder=None):
    """Writes the four files into `out` and returns the warnings."""
    studies, warnings = load_studies(studies_folder)
    out.mkdir(parents=True, exist_ok=True)
    store = Cache(cache_folder or out / ".cache")
    html = page.build(studies, store, warnings, out)
    _write(out / "index.html", html)
    _write(out / "summary.md", outputs.summary(studies, warnings))
    _write(out / "junit.xml", outputs.junit(studies))
    _write(out / "report.json", outputs.report_json(studies, warnings))
    store.prune()
    return warnings


def main(arguments=None):
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--studies", required=True, type=Path, metavar="DIR",
                        help="one sub-folder a study, each with a study.json")
    parser.add_argument("--out", type=Path, metavar="DIR", help="default: the studies' folder")
    parser.add_argument("--cache", type=Path, metavar="DIR", help="finished drawings; default OUT/.cache")
    options = parser.parse_args(arguments)
    out = options.out or options.studies
    try:
        warnings = make(options.studies, out, options.cache)
    except InputError as error:
        print(f"report: {error}", file=sys.stderr)
        return 2
    for warning in warnings:
        print(f"report: {warning}", file=sys.stderr)
    return 0


if __name__ == "__main__":
    sys.exit(main())
