"""Tables that a study asks for: a line a case, a column a quantity of its runs, as the study pooled them."""

from .balance import NOTE
from .cases import variant_text
from .digits import DASH, column
from .loading import number
from .tables import number_column, table, text_column

UNITS = {"us": "µs"}  # as they are typed: as they are read


def tables_of(study):
    """One for each [[table]] of the study, as plain data for the template."""
    return [_table(entry) for entry in study.listed("tables")]


def _table(entry):
    rows = entry.get("rows") or []
    columns = [text_column("", [variant_text(r.get("label") or "") for r in rows], head=True)]
    if any(r.get("source_value") for r in rows):
        columns.append(text_column("source", [r.get("source_value") for r in rows]))
    columns += [_numbers(told, [_cell(r, k) for r in rows]) for k, told in enumerate(entry.get("columns") or [])]
    columns.append(_runs(rows))
    broken = any(c.get("balance") == "does not close" for r in rows for c in r.get("cells") or [])
    return table(variant_text(entry.get("title") or ""), columns, " ".join(filter(None, (entry.get("note"), NOTE if broken else ""))))


def _cell(row, k):
    cells = row.get("cells") or []
    return cells[k] if k < len(cells) else {}


def _numbers(told, cells):
    values = [number(c.get("value")) for c in cells]
    if not any(v is not None for v in values):
        return None
    texts = column(values, int(told.get("digits") or 3))
    if told.get("difference"):
        texts = [f"+{t.lstrip()}" if v is not None and v > 0 and t != DASH else t for t, v in zip(texts, values)]
    unit = UNITS.get(told.get("unit"), told.get("unit"))
    label = told.get("label") or ""
    return number_column(f"{label} [{unit}]" if unit not in ("", "1", None) else label, values, texts=texts)


def _runs(rows):
    """How many runs a line pools, where lines differ in that."""
    counts = [max((c.get("runs") or 0 for c in r.get("cells") or []), default=0) for r in rows]
    return number_column("runs", counts) if len(set(counts)) > 1 else None
