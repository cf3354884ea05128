"""Numbers as people read them: significant digits, powers of ten, units, and a dash for nothing."""

import math
import re

from .loading import number

DASH = "–"
MINUS = "−"
FIGURE_SPACE = "\u2007"  # as wide as a digit
POINT_SPACE = "\u2008"  # as wide as a full stop
THIN_SPACE = "\u202f"
SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def split(value, digits):
    """(mantissa text, exponent) of a value rounded to `digits` significant digits."""
    mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
    return mantissa, int(exponent)


def plain(value, digits=3):
    """Without an exponent: 0.0315, 12.5, 1340. Digits before the point are never rounded away."""
    if value == 0:
        return "0"
    _, exponent = split(value, digits)
    return f"{value:.{max(0, digits - 1 - exponent)}f}"


def needs_power(value):
    return value != 0 and not 1e-2 <= abs(value) < 1e5


def text(value, digits=3, missing=DASH):
    """For sentences and plain-text files: 0.0315, 2.23e-3; a dash when missing."""
    if isinstance(value, int) and not isinstance(value, bool) and abs(value) < 1e5:
        return str(value).replace("-", MINUS)  # counted, not measured
    value = number(value)
    if value is None:
        return missing
    if needs_power(value):
        mantissa, exponent = split(value, digits)
        return f"{mantissa}e{exponent}".replace("-", MINUS)
    return plain(value, digits).replace("-", MINUS)


def pretty(value, digits=3, missing=DASH):
    """As `text`, with a Unicode power of ten: 2.23×10⁻³."""
    out = text(value, digits, missing)
    match = re.fullmatch(r"(.*\d)e(.+)", out)
    if not match:
        return out
    power = match[2].replace(MINUS, "-").translate(SUPERSCRIPTS)
    return f"{match[1]}×10{power}"


def exact(value, digits=4, missing=DASH):
    """For values that were chosen, not measured (spacings, settings, ticks): no trailing zeros."""
    value = number(value)
    if value is None:
        return missing
    if value != 0 and not 1e-4 <= abs(value) < 1e5:
        mantissa, exponent = split(value, digits)
        mantissa = mantissa.rstrip("0").rstrip(".") if "." in mantissa else mantissa
        power = f"10{str(exponent).translate(SUPERSCRIPTS)}"
        out = power if mantissa == "1" else f"{mantissa}×{power}"
        return out.replace("-", MINUS)
    return f"{value:.{digits}g}".replace("-", MINUS) if abs(value) < 1000 else f"{value:.10g}".replace("-", MINUS)


def exact_column(values, digits=4):
    """`exact` texts, padded so that their points stand in one line."""
    texts = [None if number(v) is None else exact(v, digits) for v in values]
    if any(t and "×" in t for t in texts):
        return [t or DASH for t in texts]
    places = max((len(t.partition(".")[2]) for t in texts if t), default=0)
    return [DASH if t is None else _padded(t, places) for t in texts]


def between(low, high, powers, digits=3):
    """"(1.47 to 1.70)×10⁻²": both ends of a spread in the larger one's power."""
    size = max(abs(low), abs(high))
    if not powers or min(abs(low), abs(high)) < size / 100:
        return f"{pretty(low, digits)} to {pretty(high, digits)}"
    _, exponent = split(size, digits)
    scale = 10.0 ** -exponent
    ends = [f"{v * scale:.{digits - 1}f}".replace("-", MINUS) for v in (low, high)]
    return f"({ends[0]} to {ends[1]})×10{str(exponent).translate(SUPERSCRIPTS)}"


def takes_powers(values):
    """True when a column of these numbers is set with powers of ten."""
    known = [v for v in map(number, values) if v]
    return any(map(needs_power, known)) and not all(v.is_integer() for v in known)


def column(values, digits=3):
    """One text a value, all in one notation and padded so that right-aligned cells line up."""
    if takes_powers(values):
        return _powers(values, digits)
    counted = [v for v in values if number(v) is not None]
    if all(isinstance(v, int) or number(v).is_integer() and abs(v) >= 1000 for v in counted):
        return [DASH if number(v) is None else grouped(int(number(v))) for v in values]
    texts = [None if number(v) is None else plain(number(v), digits) for v in values]
    places = max(len(t.partition(".")[2]) for t in texts if t)
    return [DASH if t is None else _padded(t, places) for t in texts]


def _padded(out, places):
    whole, point, fraction = out.partition(".")
    pad = FIGURE_SPACE * (places - len(fraction)) + ("" if point or not places else POINT_SPACE)
    return whole.replace("-", MINUS) + point + fraction + pad


def _powers(values, digits):
    parts = [None if number(v) is None else split(number(v), digits) for v in values]
    width = max(len(str(e)) for _, e in filter(None, parts))
    out = []
    for part, value in zip(parts, values):
        if part is None:
            out.append(DASH)
        elif number(value) == 0:
            out.append("0")
        else:
            power = str(part[1])
            pad = FIGURE_SPACE * (width - len(power))
            out.append(f"{part[0].replace('-', MINUS)}×10{power.translate(SUPERSCRIPTS)}{pad}")
    return out


def grouped(value):
    """12 345: thin spaces between thousands from five digits on."""
    out = f"{abs(value):,}".replace(",", THIN_SPACE) if abs(value) >= 10000 else str(abs(value))
    return (MINUS if value < 0 else "") + out


def duration(seconds, digits=2):
    """Wall time for people: 0.41 ms, 3.2 s, 4.1 min."""
    seconds = number(seconds)
    if seconds is None:
        return DASH
    for limit, factor, unit in ((1e-3, 1e6, "µs"), (1, 1e3, "ms"), (120, 1, "s"), (7200, 1 / 60, "min")):
        if seconds < limit:
            return f"{plain(seconds * factor, digits)} {unit}"
    return f"{plain(seconds / 3600, digits)} h"


PREFIXES = ((1e-9, "n"), (1e-6, "µ"), (1e-3, "m"), (1, ""), (1e3, "k"), (1e6, "M"), (1e9, "G"))


def engineering(span, unit):
    """(factor, unit text) such that span*factor is a readable number: 2.4e6 Pa -> 1e-6, "MPa"."""
    if unit not in ("m", "Pa", "N", "J", "m/s", "s") or not span:
        return 1.0, unit
    best = 1.0, unit
    for scale, prefix in PREFIXES:
        if span / scale >= 0.999:
            best = 1 / scale, prefix + unit
    return best


def ticks(low, high, count=4):
    """Round numbers inside [low, high], about `count` of them."""
    if not high > low:
        return [low]
    raw = (high - low) / count
    base = 10 ** math.floor(math.log10(raw))
    step = next(m * base for m in (1, 2, 2.5, 5, 10) if m * base >= raw * 0.999)
    first = math.ceil(low / step - 1e-9)
    last = math.floor(high / step + 1e-9)
    return [k * step for k in range(first, last + 1)]
