"""What machines and CI read: summary.md, junit.xml, report.json."""

import json
import math
import xml.etree.ElementTree as ET

from .balance import SIGN
from .claims import bound_text, measured_text, source_text
from .digits import DASH, pretty
from .loading import study_verdict, verdict

MARKS = {"pass": "✓ pass", "fail": "✗ FAIL", "open": "○ not judged"}


def count(studies):
    """{"pass": n, "fail": n, "open": n} over all claims."""
    out = {"pass": 0, "fail": 0, "open": 0}
    for study in studies:
        for claim in study.claims:
            out[verdict(claim)] += 1
    return out


def headline(studies):
    """One sentence: how many claims hold."""
    counts = count(studies)
    judged = counts["pass"] + counts["fail"]
    if not judged:
        return "No claim was judged."
    claims = "claim" if judged == 1 else "claims"
    if counts["fail"]:
        words = f"{counts['fail']} of {judged} {claims} failed."
    elif judged == 1:
        words = "The one claim that was judged holds."
    else:
        words = f"All {judged} claims hold."
    if counts["open"]:
        words += f" {counts['open']} not judged in this mode."
    return words


def _cell(words):
    return str(words).replace("|", "\\|").replace("\n", " ")


def summary(studies, warnings):
    """Markdown for a CI job summary: failures first, then every claim by study."""
    lines = ["# Concord report", "", f"**{headline(studies)}**", ""]
    failed = [(s, c) for s in studies for c in s.claims if verdict(c) == "fail"]
    if failed:
        lines += ["## Failed", "", *_claims(failed), ""]
    for study in studies:
        lines += [f"## {study.title}: {MARKS[study_verdict(study)]}", ""]
        lines += [*_claims([(study, c) for c in study.claims]), ""] if study.claims else ["No claims.", ""]
        lines += [*_fits(study), *_found(study)]
    if warnings:
        lines += ["## Remarks", "", *[f"- {_cell(w)}" for w in warnings], ""]
    return "\n".join(lines)


def _claims(pairs):
    out = ["| claim | source’s value | ours | bound | verdict |", "|---|---:|---:|---:|---|"]
    for _, claim in pairs:
        out.append("| " + " | ".join(map(_cell, (
            claim["statement"], source_text(claim), measured_text(claim), bound_text(claim),
            MARKS[verdict(claim)]))) + " |")
    return out


def _fits(study):
    fits = study.listed("fits")
    if not fits:
        return []
    out = ["| fitted order | quantity | slope | R² |", "|---|---|---:|---:|"]
    for fit in fits:
        who = " ".join(filter(None, (fit.get("method"), fit.get("variant"))))
        out.append("| " + " | ".join(map(_cell, (who, fit.get("quantity") or DASH, pretty(fit.get("slope")),
                                                 pretty(fit.get("r2"), 4)))) + " |")
    return out + [""]


def _found(study):
    """What is fastest at one error, and the heat maps."""
    out = [f"- {_cell(words)}" for entry in study.listed("matched") for words in entry.get("sentences") or []]
    out += [""] if out else []
    for entry in study.listed("heatmap"):
        columns = [c.get("label") or c.get("method") or "" for c in entry.get("columns") or []]
        out += [f"| {_cell(entry.get('title') or 'heat map')} | " + " | ".join(map(_cell, columns)) + " |",
                "|---|" + "---:|" * len(columns)]
        for row in entry.get("rows") or []:
            unit = f" [{row['unit']}]" if row.get("unit") not in ("", "1", None) else ""
            cells = [pretty(c.get("value"), int(row.get("digits") or 3))
                     + (f" {SIGN}" if c.get("balance") == "does not close" else "") for c in row.get("cells") or []]
            out.append(f"| {_cell(row.get('label') or '')}{unit} | " + " | ".join(cells) + " |")
        out.append("")
    return out


def junit(studies):
    """JUnit XML: a suite a study, a test case a claim."""
    root = ET.Element("testsuites", name="concord")
    for study in studies:
        counts = count([study])
        suite = ET.SubElement(root, "testsuite", name=study.name, tests=str(len(study.claims)),
                              failures=str(counts["fail"]), errors="0", skipped=str(counts["open"]))
        for claim in study.claims:
            case = ET.SubElement(suite, "testcase", classname=study.name, name=claim["id"], time="0")
            ours, bound = measured_text(claim), bound_text(claim)
            told = f"{claim['statement']}: measured {ours}, bound {bound}"
            if verdict(claim) == "fail":
                ET.SubElement(case, "failure", message=told).text = claim.get("note") or claim.get("reason") or told
            elif verdict(claim) == "open":
                ET.SubElement(case, "skipped", message=f"not judged: {told}")
    ET.indent(root)
    return ET.tostring(root, encoding="unicode", xml_declaration=True) + "\n"


def _finite(value):
    """JSON knows no NaN: missing becomes null."""
    if isinstance(value, dict):
        return {k: _finite(v) for k, v in value.items()}
    if isinstance(value, list):
        return [_finite(v) for v in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def report_json(studies, warnings):
    """Everything that the page was made from."""
    failed = any(study_verdict(s) == "fail" for s in studies)
    data = {"format": "concord-report", "format_version": 1, "verdict": "fail" if failed else "pass",
            "claims": count(studies), "warnings": warnings, "studies": [s.data for s in studies]}
    return json.dumps(_finite(data), ensure_ascii=False, indent=1) + "\n"
