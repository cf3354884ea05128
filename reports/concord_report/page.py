"""Puts a page together from studies: one self-contained HTML file."""

import re
from datetime import datetime, timezone
from pathlib import Path

from . import (balance, captions, case_tables, claims, films, frames, fronts, heatmaps, histories, matched, outputs, pictures, plots, quantities,
               signals, tables)
from .cases import cases_of, variant_text
from .loading import study_verdict, verdict
from .palette import css_variables, method_name, swatch

TEMPLATES = Path(__file__).resolve().parent.parent / "template"
WORDS = {"pass": "pass", "fail": "fail", "open": "not judged"}
SYMBOLS = {"pass": "✓", "fail": "✗", "open": "○"}


def slug(name):
    """A name that can be an id."""
    return re.sub(r"[^a-z0-9]+", "-", name.lower()).strip("-") or "study"


def _claim_view(claim):
    return {"id": claim["id"], "statement": claim["statement"], "source": claim.get("source") or "",
            "source_value": claims.source_text(claim),
            "note": claims.typeset(claim.get("note") or claim.get("reason") or ""),
            "measured": claims.measured_text(claim),
            "bound": claims.bound_text(claim), "verdict": verdict(claim)}


def _plots(study, cases, store, warnings):
    out = []
    for number, (plot, spec) in enumerate(plots.plot_specs(study, cases)):
        if isinstance(spec, str):
            what = f"{plot.get('kind')} plot of {plot.get('quantity') or plot.get('y') or ' and '.join(plot.get('columns') or [])}"
            warnings.append(f"{study.name}: no {what}: {spec}")
            out.append({"kind": "missing", "title": f"No {what}", "why": spec})
            continue
        drawing = plots.drawn(spec, f"{slug(study.name)}-p{number}", store)
        out.append({"kind": plot["kind"], "title": variant_text(spec["title"]), "svg": drawing, "labelled": plots.labelled(spec),
                    "note": spec.get("note", ""), "statement": plot.get("statement") or "", "source": plot.get("source") or ""})
    return out


def _said_once(shown):
    """The sentences that the notes of three or more have all in common, taken out of each of them."""
    if len(shown) < 3:
        return ""
    told = [re.split(r"(?<=\.) (?=\S)", s["note"]) for s in shown]
    common = [words for words in told[0] if words and all(words in one for one in told)]
    for one, words in zip(shown, told):
        one["note"] = " ".join(w for w in words if w not in common)
    return " ".join(common)


def _pictures(jobs, name):
    """Pictures by shared scale, each group with its colour bar; those that are missing apart, but where
    they would leave a hole in a table of instants."""
    groups, missing = {}, []
    for job in jobs:
        if "missing" in job:
            job["group"] = next((k for k, g in groups.items() if k[0] == id(job["whole"])), None) or \
                next((j["group"] for j in jobs if "missing" not in j and j["whole"] is job["whole"]), None)
            if job["group"] is None or "instant" not in job["picture"]:
                missing.append({"label": job.get("label") or name, "why": job["missing"]})
                continue
        group = groups.setdefault(job["group"], {"jobs": [], "whole": job["whole"]})
        group["jobs"].append(job)
    return [_group(g) for g in groups.values()], missing


def _group(group):
    """One colour bar and its pictures. What all panels of a figure have in common is said once."""
    jobs, whole = group["jobs"], group["whole"]
    drawn = [job for job in jobs if "missing" not in job]
    bar = captions.bar(drawn[0])
    told = [captions.caption(job)[1] for job in drawn]
    common = [p for p in told[0] if all(p in parts for parts in told)] if whole and len(drawn) > 1 else []
    columns = captions.columns(whole, len(jobs)) if whole else 0
    view = {"bar": bar, "pictures": [_view(job, whole, bar, common) for job in jobs], "columns": columns,
            "plain": drawn[0]["color"] == frames.PLAIN, "film": _film(drawn) if drawn[0]["film"] else None,
            "title": variant_text((whole or {}).get("caption") or ""),
            "common": [*common, captions.extent(drawn[0], len(drawn))] if whole else [],
            "panel_width": captions.panel_width(max(drawn, key=lambda j: j["height"] / j["width"]), -(-len(jobs) // (columns or 1))),
            "triad": [] if drawn[0]["view"]["front"] else captions.triad(), "note": captions.note(drawn)}
    for k in range(0, len(jobs), columns) if captions.in_rows(whole) else ():
        there = [job for job in jobs[k:k + columns] if "missing" not in job]
        time = whole["times"][k // columns]
        view["pictures"][k]["instant"] = captions.row_text(time, there) if there else f"t = {time:g} s"
    return view


def _film(drawn):
    """What the page needs to play a figure's sheets: how many pictures, for how long, the instants in words."""
    longest = max(drawn, key=lambda job: len(job["film"]))
    return {"count": len(longest["film"]), "seconds": films.wanted(longest["picture"])["seconds"],
            "times": [captions.time_text(t, longest["row"]) for t in longest["times"]]}


def _sheet(job):
    """(pictures on the sheet, across, down, place of the last one [per cent])."""
    count, across, down = len(job["film"]), job["across"], job["down"]
    row, column = divmod(count - 1, across)
    return {"count": count, "across": across, "down": down, "left": -100 * column, "top": -100 * row}


def _view(job, whole, bar, common):
    caption = variant_text(job["picture"].get("caption") or "")
    if "missing" in job:
        return {"why": job["missing"], "caption": caption, "instant": ""}
    case, parts = captions.caption(job)
    parts = [p.replace(" ", "\u00a0") if len(p) < 20 else p for p in parts if p not in common]
    at = f", {captions.time_text(job['time'], job['row'])}" if "instant" in job["picture"] else ""
    return {"uri": pictures.data_uri(job), "width": job["width"], "height": job["height"], "instant": "",
            "sheet": _sheet(job) if job["film"] else None, "caption": caption, "parts": parts, "swatch": swatch(case.method, case.style) if whole is None else "",
            "alt": _alt(job, at, bar)}


def _alt(job, at, bar):
    what = {"cells": "its Voronoi cells", "spheres": "its particles"}.get(job["draw"], "body")
    if job["film"]:
        at = f", {len(job['film'])} instants from {captions.time_text(job['times'][0], job['row'])} to " \
             f"{captions.time_text(job['times'][-1], job['row'])}"
    if job["color"] == frames.PLAIN:
        return f"{job['case'].label}{at}: {what}"
    return f"{job['case'].label}{at}: {what} coloured by {bar['name']}, from {bar['low']} to {bar['high']} {bar['unit']}".strip()


def _tables(study, cases):
    def label(entry):
        return " ".join(filter(None, (method_name(entry.get("method") or ""),
                                      variant_text(entry.get("variant") or ""))))
    made = [tables.convergence_table(study, cases, q) for q in tables.quantities_with_levels(study)]
    made += [signals.signals_table(cases), tables.results_table(study, cases), tables.invariants_table(cases),
             tables.references_table(study, label)]
    return [t for t in made if t]


def _study_view(study, cases, jobs, store, warnings, out):
    drawn = _plots(study, cases, store, warnings)
    groups, missing = _pictures(jobs, study.title)
    shown = {int(k) for p in drawn if "svg" in p and not p["labelled"] for k in re.findall(r'data-case="(\d+)"', p["svg"])}
    same = {p["kind"] for p in drawn}
    compared = matched.tables_of(study, cases)
    return {
        "id": slug(study.name), "name": study.name, "title": study.title,
        "question": study.data.get("question") or "", "source": study.data.get("source") or "",
        "paper_statement": study.data.get("paper_statement") or "", "mode": study.data.get("mode") or "",
        "verdict": study_verdict(study), "counts": outputs.count([study]),
        "claims": sorted(map(_claim_view, study.claims), key=lambda c: c["verdict"] != "fail"), "plots": drawn,
        "key": [{"case": c.index, "label": c.label, "swatch": swatch(c.method, c.style)}
                for c in cases if c.index in shown],
        "chosen": case_tables.tables_of(study), "heatmaps": heatmaps.maps_of(study, slug(study.name), out), "matched": compared,
        "plot_note": " ".join(filter(None, (_said_once([p for p in drawn if p["kind"] == k]) for k in sorted(same - {"missing"})))),
        "matched_note": _said_once(compared),
        "groups": groups, "missing": missing, "tables": _tables(study, cases),
        "runs": tables.runs_table(study, cases), "run_count": len(study.rows),
        "fem": fronts.fem_note(cases),
    }


def _failed_runs(study, cases):
    """Remarks: a study that was interrupted, a run that did not reach its end or does not balance."""
    out = []
    if study.data.get("interrupted"):
        out.append(f"{study.name}: the study was interrupted; this is what it had by then")
    for case in cases:
        for level in case.levels:
            for row in level.rows:
                if row.get("error"):
                    seed = f", seed {row['seed']}" if row.get("seed") is not None else ""
                    out.append(f"{study.name}: {case.label} at resolution {level.resolution:g}{seed} "
                               f"failed: {row['error']}")
    open_runs = sum(map(balance.broken, study.rows))
    if open_runs:
        out.append(f"{study.name}: {balance.WORDS} in {open_runs} of "
                   f"{len(study.rows)} runs, marked {balance.SIGN}")
    return out


def _newest(studies):
    times = [(s.folder / "study.json").stat().st_mtime for s in studies]
    return datetime.fromtimestamp(max(times), timezone.utc).strftime("%Y-%m-%d %H:%M UTC")


def build(studies, store, warnings, out=None):
    """The page as text. Adds to `warnings` what could not be shown. `out` is the page's folder, for links."""
    from jinja2 import Environment, FileSystemLoader, StrictUndefined
    ordered = [(s, cases_of(s)) for s in studies]
    for study, cases in ordered:
        quantities.learn(histories.header_of(study))
        quantities.ERRORS.update(name for row in study.rows for name in row.get("error_sources") or ())
        warnings += _failed_runs(study, cases)
    jobs = {s.name: pictures.prepare(s, c, store, warnings) for s, c in ordered}
    pictures.render_missing([j for js in jobs.values() for j in js], store, warnings)
    views = [_study_view(s, c, jobs[s.name], store, warnings, out) for s, c in ordered]
    for view in views:
        same = [v for v in views if v["id"] == view["id"]]
        for number, twin in enumerate(same[1:], 2):
            twin["id"] += f"-{number}"
    environment = Environment(loader=FileSystemLoader(TEMPLATES), autoescape=True, trim_blocks=True,
                              lstrip_blocks=True, undefined=StrictUndefined)
    rows = [r for s in studies for r in s.rows]
    return environment.get_template("page.html.j2").render(
        headline=outputs.headline(studies), counts=outputs.count(studies), studies=views,
        verdict="fail" if any(v["verdict"] == "fail" for v in views) else
                "pass" if any(v["verdict"] == "pass" for v in views) else "open",
        modes=sorted({v["mode"] for v in views if v["mode"]}), when=_newest(studies),
        machine=tables.machine_facts(rows), warnings=warnings, words=WORDS, symbols=SYMBOLS,
        fem=any(v["fem"] for v in views), day=css_variables(False), night=css_variables(True),
        style=(TEMPLATES / "style.css").read_text(encoding="utf-8"),
        script=(TEMPLATES / "page.js").read_text(encoding="utf-8"))
