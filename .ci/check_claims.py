"""Prints the claims of report.json and compares them with those that passed before.

check_claims.py REPORT_JSON LIST: LIST holds STUDY/CLAIM lines; exit 1 if one of them is missing or does not pass.
"""

import json
import sys
from pathlib import Path


def main(report, known):
    claims = {}
    for study in json.loads(Path(report).read_text(encoding="utf-8"))["studies"]:
        for claim in study["claims"]:
            claims[f"{study['name']}/{claim['id']}"] = claim
    for name, claim in claims.items():
        measured = "-" if claim["measured"] is None else f"{claim['measured']:.4g}"
        print(f"{claim['verdict']:>16}  {name:<52} {measured:>11}  {claim['bound']}")
    lines = (line.split("#")[0].strip() for line in Path(known).read_text(encoding="utf-8").splitlines())
    before = [line for line in lines if line]
    lost = [name for name in before if claims.get(name, {}).get("verdict") != "pass"]
    for name in lost:
        print(f"passed before, now {claims[name]['verdict'] if name in claims else 'gone'}: {name}")
    for name in sorted(n for n, c in claims.items() if c["verdict"] == "pass" and n not in before):
        print(f"passes and is not in {known} yet: {name}")
    return 1 if lost else 0


if __name__ == "__main__":
    try:
        sys.exit(main(*sys.argv[1:3]))
    except (OSError, ValueError, KeyError) as error:
        sys.exit(f"check_claims: {error!r}")
