"""Runs whose energy balance does not close: marked wherever their numbers enter."""

SIGN = "⊗"
WORDS = "energy balance does not close"
NOTE = (f"{SIGN} Energy balance does not close: the numbers of such a run are not to be relied upon, "
        "whatever they look like.")


def broken(row):
    """True for a run that the study found not to balance. A run without a balance is not marked."""
    return row.get("balance") == "does not close"


def any_broken(rows):
    return any(broken(row) for row in rows)


def how_many(rows):
    """"", "⊗ does not close" or "⊗ does not close in 2 of 5": a cell below "energy balance"."""
    count = sum(map(broken, rows))
    if not count:
        return ""
    return f"{SIGN} does not close" + (f" in {count} of {len(rows)}" if len(rows) > 1 else "")


def state(rows):
    """The same for a table of single runs, which also says "closes"; nothing without a balance."""
    return how_many(rows) or str(rows[0].get("balance") or "")
