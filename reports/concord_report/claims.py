"""How a claim's numbers are set: the source's value, ours, and the bound between them."""

import re

from .digits import DASH, SUPERSCRIPTS, pretty
from .loading import number

NUMBER = re.compile(r"(?<![\w.])[-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?(?!\w)")
MOST_DIGITS = 6


def source_text(claim):
    """The source's value in the source's own words."""
    value = claim.get("source_value")
    return with_unit(pretty(value)) if number(value) is not None else typeset(str(value or DASH))


def with_unit(out, unit=""):
    return out if out == DASH or unit in ("", "1", None) else f"{out}\u00a0{unit}"


def measured_text(claim):
    """Ours with its unit: as many digits as the source and the bound have, three at least, and so
    many that rounding does not put it on the other side of a bound."""
    value = number(claim.get("measured"))
    if value is None:
        return DASH
    bounds = [float(t) for t in NUMBER.findall(_bound_words(claim))]
    told = NUMBER.findall(f"{claim.get('source_value') or ''} {_bound_words(claim)}")
    digits = max([3, *map(_significant, told)])
    digits = min(digits, 5)
    while digits < MOST_DIGITS and any(_hides(value, bound, digits) for bound in bounds):
        digits += 1
    return with_unit(pretty(value, digits), claim.get("unit"))


def _significant(words):
    mantissa = re.split("[eE]", words)[0].lstrip("+-0.").replace(".", "")
    return len(mantissa)


def _hides(value, bound, digits):
    rounded = float(f"{value:.{digits - 1}e}")
    return value != bound and (value < bound) != (rounded < bound)


def _bound_words(claim):
    """">= 1.8 and <= 2.6 mm" from whichever form the bound has."""
    bound, unit = claim.get("bound"), claim.get("unit") or ""
    unit = "" if unit in ("", "1") else f" {unit}"
    if isinstance(bound, list) and len(bound) == 2:
        bound = dict(zip(("min", "max"), bound))
    if isinstance(bound, dict):
        ends = ((">=", number(bound.get("min"))), ("<=", number(bound.get("max"))))
        return " and ".join(f"{sign} {end:g}{unit}" for sign, end in ends if end is not None)
    if number(bound) is not None:
        return f"{bound:g}{unit}"
    return str(bound or "")


def bound_text(claim):
    """"≥ 1.8", "1.8 to 2.6 mm" or the study's own words."""
    words = _bound_words(claim)
    both = re.fullmatch(r">= (\S+)((?: .+)?) and <= (\S+)((?: .+)?)", words)
    if both:
        words = f"{both[1]} to {both[3]}{both[4] or both[2]}"
    return typeset(words) if words else DASH


def typeset(words):
    """">= 1e-10 N" -> "≥ 10⁻¹⁰ N": as the numbers beside it are set."""
    words = words.replace(">=", "≥").replace("<=", "≤")
    def power(match):
        exponent = str(int(match[2])).translate(SUPERSCRIPTS)
        return f"10{exponent}" if match[1] == "1" else f"{match[1]}×10{exponent}"
    words = re.sub(r"(?<![\w.])(\d+(?:\.\d+)?)[eE]([-+]?\d+)\b", power, words)
    words = re.sub(r"(?<!\w)-(?=\d)", "−", words)
    return re.sub(r"([≥≤]) (?=\S)", "\\1\u00a0", words)
