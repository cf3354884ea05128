"""What a method looks like, everywhere: one hue a method (Okabe and Ito, 2008, darkened where a
line would fall below 3:1 on white), a marker and a dash for each variant."""

# method: (name in print, CSS variable, colour on white, colour on black)
METHODS = {
    "delaunay": ("Delaunay", "--m-delaunay", "#0072b2", "#58aee6"),
    "tlsph": ("TLSPH", "--m-tlsph", "#d55e00", "#f58b3c"),
    "fem": ("FEM", "--m-fem", "#3d4248", "#d4d8dd"),
    "calculix": ("CalculiX", "--m-calculix", "#85623f", "#cfa981"),
    "voronoi": ("Voronoi", "--m-voronoi", "#00916a", "#2ec79c"),
    "cbm": ("CBM", "--m-cbm", "#b9578f", "#e093bf"),
    "mpm": ("MPM", "--m-mpm", "#2b8fc9", "#7cc8f2"),
    "sph": ("SPH", "--m-sph", "#b07900", "#e8ad2d"),
    "dem": ("DEM", "--m-dem", "#877c00", "#e3d845"),
}
OTHER = ("", "--m-other", "#6b5fb5", "#ada3ee")

# role: (CSS variable, the colour that charts are drawn with and that is replaced by it)
ROLES = {
    "ink": ("--ink", "#1b1f25"),
    "muted": ("--muted", "#59616b"),
    "grid": ("--grid", "#e4e7eb"),
    "paper": ("--panel", "#fefefe"),
}

COLUMNS = ("delaunay", "tlsph", "voronoi", "cbm", "sph", "", "calculix")  # whose hues several columns of a run take
BALANCES = "fem"  # and of the column that ought to stay as it is

MARKERS = ("o", "s", "^", "D", "v", "p", "X", "P", "h", "<")
DASHES = ("", "6 2.5", "2 2", "7 2 1.5 2", "10 3", "4 1.5 1.5 1.5 1.5 1.5")

# Seventeen stops each, from matplotlib's viridis and its RdBu reversed.
VIRIDIS = ("#440154 #48186a #472d7b #424086 #3b528b #33638d #2c728e #26828e #21918c #1fa088 "
           "#28ae80 #3fbc73 #5ec962 #84d44b #addc30 #d8e219 #fde725").split()
RED_BLUE = ("#053061 #175290 #2a71b2 #3f8ec0 #6bacd1 #9bc9e0 #c2ddec #e0ecf3 #f7f6f6 #fbe5d8 "
            "#fbccb4 #f5aa89 #e48066 #d05548 #ba2832 #930e26 #67001f").split()
# Whole is pale, broken is dark: cracks are what one looks for.
BROKEN = ("#2d0a1f #440e22 #5c1325 #731828 #8a1c2b #9c2b2c #af3a2d #c2492e #d4582f "
          "#db6f43 #e28656 #e89c6a #efb37e #eac7a7 #e5dbd0 #dce2e5 #cfdfed").split()
WHOLE_OR_BROKEN = "intact_share"


def stops(color, diverging):
    """The colours of a field, from its low end to its high end."""
    return BROKEN if color == WHOLE_OR_BROKEN else RED_BLUE if diverging else VIRIDIS


def look(method):
    return METHODS.get(method, OTHER)


def method_name(method):
    return METHODS[method][0] if method in METHODS else method


def colour(method):
    return look(method)[2]


def marker(style):
    return MARKERS[style % len(MARKERS)]


def dash(style):
    return DASHES[style % len(DASHES)]


def hollow(style):
    """Every second variant has an open marker."""
    return style % 2 == 1


def css_variables(dark):
    """The methods' colours as CSS declarations."""
    looks = list(METHODS.values()) + [OTHER]
    return " ".join(f"{variable}: {night if dark else day};" for _, variable, day, night in looks)


def replacements():
    """{colour in the drawing: CSS var() with that colour to fall back on}."""
    table = {day: f"var({variable}, {day})" for _, variable, day, _ in [*METHODS.values(), OTHER]}
    table.update({hue: f"var({variable}, {hue})" for variable, hue in ROLES.values()})
    return table


SHAPES = {
    "o": '<circle cx="16" cy="7" r="3.4"/>',
    "s": '<rect x="12.9" y="3.9" width="6.2" height="6.2"/>',
    "^": '<path d="M16 3.1 20 10.2H12z"/>',
    "v": '<path d="M16 10.9 20 3.8H12z"/>',
    "<": '<path d="M11.9 7 19 3V11z"/>',
    "D": '<path d="M16 2.6 20.4 7 16 11.4 11.6 7z"/>',
    "p": '<path d="M16 3.2 19.8 6 18.3 10.4H13.7L12.2 6z"/>',
    "h": '<path d="M16 3 19.5 5V9L16 11 12.5 9V5z"/>',
    "X": '<path d="M12.6 3.6 16 7 19.4 3.6M12.6 10.4 16 7 19.4 10.4" stroke-width="2.6"/>',
    "P": '<path d="M16 2.9V11.1M11.9 7H20.1" stroke-width="2.8"/>',
}


def swatch(method, style):
    """A small decorative SVG of the curve's line and marker for keys and tables."""
    hue = f"var({look(method)[1]})"
    fill = "var(--panel)" if hollow(style) else hue
    dashes = f' stroke-dasharray="{dash(style)}"' if dash(style) else ""
    return (f'<svg class="swatch" viewBox="0 0 32 14" width="32" height="14" aria-hidden="true" '
            f'style="stroke:{hue};fill:{fill};stroke-width:1.6">'
            f'<path d="M1 7H31"{dashes} fill="none"/>{SHAPES[marker(style)]}</svg>')
