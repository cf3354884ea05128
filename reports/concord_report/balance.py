"""Runs whose energy balance does not close: marked wherever their numbers enter."""

SIGN = "⊗"
WORDS = "energy balance does not close"
NOTE = f"{SIGN} Energy balance does not close: the numbers of such a run are not to be relied upon, whatever they look like."


def broken(row):
    """True for a run that the study found not to balance. A run without a balance is not marked."""
    return row.get("balance") == "does not close"


def any_broken(rows):
    return any(broken(row) for row in rows)


def how_many(rows):
    """"", "⊗ energy balance does not close" or the same with "2 of 5 runs"."""
    count = sum(map(broken, rows))
    if not count:
        return ""
    return f"{SIGN} {WORDS}" + (f", {count} of {len(rows)} runs" if len(rows) > 1 else "")


def state(row):
    """What a table of single runs says: the mark, "closes", or nothing where there is no balance."""
    return f"{SIGN} {WORDS.removeprefix('energy balance ')}" if broken(row) else str(row.get("balance") or "")
