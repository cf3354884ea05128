"""Checks the rules of the house; prints every breach and exits 1 if there is one.

house_rules.py TOP PROGRAM: TOP is the top folder of the sources, PROGRAM the built concord.
"""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

ROOMS = ("scene", "particle", "sph_reference", "fem_reference", "studies", "reports")
# Which rooms, folders or headers a room may include; of particle, SPH sees the core alone; of the finite elements,
# studies see what evaluates nodal fields.
MAY_INCLUDE = {
    "scene": {"scene"},
    "particle": {"scene", "particle"},
    "sph_reference": {"scene", "particle/core", "sph_reference"},
    "fem_reference": {"scene", "fem_reference"},
    "studies": {"scene", "studies", "fem_reference/field.hpp", "fem_reference/shape.hpp"},
}
# Libraries that stay in one room.
OWNER = {"deal.II/": "fem_reference", "CGAL/": "particle", "gmsh.h": "scene", "muParser": "scene", "toml++/": "scene"}
# Libraries that are loaded when they are needed: linked, the loader spends a quarter of a second on each at every start.
NOT_AT_START = ("libgmsh", "libdeal")
# Formulations do not include each other, but for this pair.
FORMULATION_EXCEPTIONS = {("cbm", "delaunay")}
MAX_LINES = 400
SOURCE_SUFFIXES = {".cpp", ".hpp", ".h", ".cc", ".py"}
INCLUDE = re.compile(r'^\s*#\s*include\s*[<"](?:concord/)?([^>"]+)[>"]', re.M)


def include_breaches(path, text):
    """Includes of one file (path relative to the top) against the direction."""
    room = path.split("/")[0]
    if room not in MAY_INCLUDE:
        return
    for included in INCLUDE.findall(text):
        for library, owner in OWNER.items():
            if included.startswith(library) and room != owner:
                yield f"{path}: includes <{included}>, which stays in {owner}"
        target = included.split("/")[0]
        if target not in ROOMS:
            continue
        if not any(included == allowed or included.startswith(allowed + "/") for allowed in MAY_INCLUDE[room]):
            yield f"{path}: includes {included}; {room} may include {', '.join(sorted(MAY_INCLUDE[room]))}"
        yield from _between_formulations(path, included)


def _between_formulations(path, included):
    """particle/core includes no formulation, and a formulation no other one."""
    a, b = path.split("/"), included.split("/")
    if a[0] == b[0] == "particle" and len(a) > 2 and len(b) > 2 and a[1] != b[1] and b[1] != "core":
        if (a[1], b[1]) not in FORMULATION_EXCEPTIONS:
            yield f"{path}: {a[1]} includes {included}"


def source_files(top):
    """Sources under the rooms and tests, relative to the top."""
    for room in (*ROOMS, "tests"):
        for folder, names, files in os.walk(top / room):
            names[:] = [n for n in names if n not in ("node_modules", "__pycache__")]
            for name in files:
                if Path(name).suffix in SOURCE_SUFFIXES:
                    yield (Path(folder) / name).relative_to(top).as_posix()


def size_breaches(path, text):
    lines = text.count("\n")
    if lines > MAX_LINES:
        yield f"{path}: {lines} lines; at most {MAX_LINES}"


def folders(top, *parts):
    return {p.name for p in top.joinpath(*parts).iterdir() if p.is_dir() and not p.name.startswith((".", "__"))}


def registry_breaches(top, listed):
    """Folders against what the program lists. A formulation's folder names its method in its sources."""
    for kind, on_disk in (("scenes", folders(top, "scene", "library")), ("studies", folders(top, "studies") - {"driver", "probes"})):
        there = {item["name"] for item in listed[kind]}
        for name in on_disk ^ there:
            yield f"{kind}: {name} is {'a folder that the program does not list' if name in on_disk else 'listed without a folder'}"
    methods = {item["name"] for item in listed["methods"]}
    registering = {}
    for path in source_files(top):
        if path.startswith("tests/") or path.startswith("scene/"):
            continue
        text = (top / path).read_text(encoding="utf-8")
        if re.search(r"\bRegisterMethod\s*<", text):
            registering.setdefault(str(Path(path).parent), []).append(path)
    homes = {f"particle/{f}" for f in folders(top, "particle") - {"core"}}
    homes |= {f"sph_reference/{f}" for f in folders(top, "sph_reference")}
    homes |= {"fem_reference"} | {f"fem_reference/{f}" for f in folders(top, "fem_reference")}
    for home in homes - registering.keys():
        yield f"{home}: registers no method"
    for place in registering.keys() - homes:
        yield f"{place}: registers a method outside the formulations' folders"
    count = sum(len(files) for files in registering.values())
    if count != len(methods):
        yield f"methods: {count} registrations in the sources, {len(methods)} in the program ({', '.join(sorted(methods))})"


def readme_breaches(top):
    wanted = [top / room for room in ROOMS]
    wanted += [top / "scene/library" / name for name in folders(top, "scene", "library")]
    wanted += [top / "studies" / name for name in folders(top, "studies") - {"driver", "probes"}]
    wanted += [top / "particle" / name for name in folders(top, "particle")]
    for room in ("sph_reference", "fem_reference"):
        wanted += [top / room / name for name in folders(top, room)]
    for folder in wanted:
        readme = folder / "README.md"
        if not readme.exists() or len(readme.read_text(encoding="utf-8")) < 100:
            yield f"{folder.relative_to(top)}: no README.md that says something"


def start_breaches(libraries):
    """libraries: what ldd prints of the program."""
    for library in NOT_AT_START:
        if library in libraries:
            yield f"the program links {library}, which a module of its own has to load"


def main():
    top, program = Path(sys.argv[1]), sys.argv[2]
    breaches = []
    for path in source_files(top):
        text = (top / path).read_text(encoding="utf-8")
        breaches += [*include_breaches(path, text), *size_breaches(path, text)]
    breaches += readme_breaches(top)
    environment = dict(os.environ, CONCORD_HOME=str(top))
    listed = json.loads(subprocess.run([program, "list", "--json"], check=True, capture_output=True, env=environment).stdout)
    breaches += registry_breaches(top, listed)
    breaches += start_breaches(subprocess.run(["ldd", program], check=True, capture_output=True, text=True).stdout)
    print("\n".join(breaches) or "the house is in order")
    return 1 if breaches else 0


if __name__ == "__main__":
    sys.exit(main())
