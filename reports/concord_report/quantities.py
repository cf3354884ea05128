"""What a quantity is called in print, and its unit."""

import re

from .cases import GREEK

UNITS = (  # the ends of names, as in history.csv and summary.json
    ("_kg_m2_s", "kg m²/s"), ("_kg_m_s", "kg m/s"), ("_m_s2", "m/s²"), ("_rad_s2", "rad/s²"),
    ("_rad_s", "rad/s"), ("_m_s", "m/s"), ("_m2", "m²"), ("_m3", "m³"), ("_Nm", "N m"),
    ("_MPa", "MPa"), ("_kPa", "kPa"), ("_Pa", "Pa"), ("_mm", "mm"), ("_ms", "ms"), ("_kg", "kg"),
    ("_J", "J"), ("_N", "N"), ("_W", "W"), ("_K", "K"), ("_m", "m"), ("_s", "s"),
)

NAMES = {  # name: (text, unit); norms.hpp defines the errors
    "displacement_l2": ("relative L2 error of displacement", ""),
    "displacement_max": ("largest displacement error", "m"),
    "velocity_l2": ("relative L2 error of velocity", ""),
    "gradient_l2": ("relative L2 error of displacement gradient", ""),
    "displacement_l2_common": ("relative L2 error of displacement, common points", ""),
    "gradient_l2_common": ("relative L2 error of displacement gradient, common points", ""),
    "linear_momentum_drift": ("drift of linear momentum", ""),
    "angular_momentum_drift": ("drift of angular momentum", ""),
    "energy_drift": ("drift of energy", ""),
    "wall_s": ("run time of the time loop or solve", "s"),
    "setup_s": ("set-up time", "s"),
    "ns_per_particle_step": ("time a particle a step", "ns"),
    "peak_rss_mb": ("peak memory", "MB"),
    "h": ("mean spacing h", "m"),
    "t_s": ("time", "s"),
    "nonaffine_energy_share": ("non-affine share of energy", ""),
    "nonaffine_energy_share_max": ("largest non-affine share of energy", ""),
    "nonaffine_energy_share_mean": ("mean non-affine share of energy", ""),
    "checkerboard": ("checkerboard", ""),
    "checkerboard_max": ("largest checkerboard", ""),
    "perturb": ("perturbation of the particles", "h"),
    "dt": ("time step", "s"),
}

FIELDS = {  # point fields of the frames: (text, unit)
    "displacement": ("displacement", "m"),
    "displacement_error": ("displacement error", "m"),
    "velocity": ("velocity", "m/s"),
    "von_mises": ("von Mises stress", "Pa"),
    "pressure": ("pressure", "Pa"),
    "plastic_strain": ("equivalent plastic strain", ""),
    "kirchhoff_mises": ("equivalent Kirchhoff stress", "Pa"),
    "energy_density": ("strain energy density", "J/m³"),
    "damage": ("damage", ""),
    "intact_share": ("share of the averaging volume left", ""),
}

COMPARED = ("plastic_strain", "kirchhoff_mises", "von_mises", "pressure", "energy_density", "damage")

ERRORS = set()  # names of [[error]] entries in the studies: "tip_peak"
SEEN = {}  # units that history.csv headers tell of scene quantities: "tip_z" -> "m"


def learn(header):
    """Keeps the units of a history.csv's columns: summary.json has the same names without them."""
    for column in header:
        for end, unit in UNITS:
            if column.endswith(end) and len(column) > len(end):
                SEEN[column[: -len(end)]] = unit
                break


def learned_unit(column):
    """Of a column of history.csv, named with or without its unit's ending."""
    return name_and_unit(f"quantities.{column}")[1]


def name_and_unit(path):
    """("tip z", "m") for "quantities.tip_z_m"; the unit is empty when there is none or unknown."""
    last = path.split(".")[-1]
    if last in NAMES:
        return NAMES[last]
    compared = next((f for f in COMPARED if path.startswith("errors.") and last.startswith(f + "_")), None)
    if compared:  # by [[compare]] of a study: errors.FIELD_NAME
        name = last.removeprefix(compared + "_")
        return (f"relative L2 difference of {FIELDS[compared][0]}"
                + ("" if name == "difference" else f", {words(name)}"), "")
    if path.startswith("errors.") and last in ERRORS:
        return f"error of {words(last)}", ""
    for end, unit in UNITS:
        if last.endswith(end) and len(last) > len(end):
            return words(last[: -len(end)]), unit
    return words(last), SEEN.get(last, "") if path.startswith("quantities.") else ""


def words(name):
    """"tip_peak" -> "tip peak", "psi" -> "ψ"."""
    return " ".join(GREEK.get(word, word) for word in re.split(r"[_\s]+", name) if word)


def axis(path):
    """"tip z [m]": the label of an axis or a column."""
    name, unit = name_and_unit(path)
    return f"{name} [{unit}]" if unit else name


def field_name(color):
    """(text, unit) of a point field; "displacement_z" is the component of "displacement"."""
    for end, told in (("_difference", "difference in {}"), ("_reference", "{} of the reference")):
        if color.endswith(end):
            name, unit = field_name(color.removesuffix(end))
            return told.format(name), unit
    base, component = split_component(color)
    name, unit = FIELDS.get(base, (words(base), ""))
    return (f"{name}, {'xyz'[component]}" if component is not None else name), unit


def split_component(color):
    """("displacement", 2) for "displacement_z" and (color, None) for a plain name."""
    match = re.fullmatch(r"(displacement|velocity)_([xyz])", color)
    return (match[1], "xyz".index(match[2])) if match else (color, None)
