"""From matplotlib's SVG to one that can stand inside a page: unique ids, colours and fonts of the
page, a label for screen readers, stable bytes."""

import html
import io
import re

from .palette import replacements

FONT = "var(--sans)"


def fragment(figure, ident, alt, tips=()):
    """The figure as an <svg> element. `ident` goes before every id; artists whose gid is
    "curve:KEY:..." become class="curve" data-case="KEY", and those called "tip:N" show tips[N]."""
    stream = io.StringIO()
    figure.savefig(stream, format="svg", transparent=True, metadata={"Date": None, "Creator": None})
    text = stream.getvalue()
    text = text[text.index("<svg"):]
    text = re.sub(r"<metadata>.*?</metadata>", "", text, flags=re.S)
    text = re.sub(r"<!--.*?-->\s*", "", text, flags=re.S)
    text = re.sub(r'<g id="tip:(\d+)">', lambda m: f'<g class="tip"><title>{html.escape(tips[int(m[1])])}</title>', text)
    text = _own_ids(text, ident)
    text = _page_style(text)
    view = re.search(r'viewBox="([^"]+)"', text)[1]
    wide = max(440, round(float(view.split()[2])))  # never enlarged: letters of all charts are alike
    head = (f'<svg viewBox="{view}" role="img" aria-label="{html.escape(alt, quote=True)}" '
            f'class="chart" style="max-width:{wide}px">')
    text = head + text[text.index(">") + 1:]
    return re.sub(r"\n\s*", "\n", _short(text))


def _short(text):
    """Coordinates to a hundredth of a pixel: six decimals of every point are a third of a page."""
    def rounded(match): return f"{float(match[0]):.2f}".rstrip("0").rstrip(".")
    return re.sub(r' (?:d|x|y)="[^"]+"', lambda m: re.sub(r"-?\d+\.\d{3,}", rounded, m[0]), text)


def _own_ids(text, ident):
    text = re.sub(r'<g id="curve:(-?\d+):[^"]*">', r'<g class="curve" data-case="\1">', text)
    text = re.sub(r'<g id="(front|rings)">', r'<g class="\1">', text)
    used = set(re.findall(r'(?:url\(#|href="#)([^")]+)', text))
    text = re.sub(r' id="([^"]+)"', lambda m: f' id="{ident}-{m[1]}"' if m[1] in used else "", text)
    text = re.sub(r'url\(#([^)]+)\)', rf"url(#{ident}-\1)", text)
    text = re.sub(r'(?:xlink:)?href="#([^"]+)"', rf'href="#{ident}-\1"', text)
    return text


def _page_style(text):
    text = re.sub(r"'DejaVu Sans'[^;\"]*", FONT, text)
    for old, new in replacements().items():
        text = text.replace(old, new)
    # the defaults of a path: saying them on every path costs a third of the file
    text = text.replace("; stroke-linejoin: round", "")
    return text
