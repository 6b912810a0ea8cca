"""A matplotlib figure → SVG that stands inside a page: fluid, themed by CSS, with ids of its own.

matplotlib colours are written as fixed marks that become CSS here: the ink is `currentColor`, the
series colours are custom properties with the light theme's colour as their fallback.

matplotlib's own settings do not go so far: `svg.id` names the root alone, all other ids (`axes_1`)
are the same in each figure; a style for `*` and paths of six decimals stay whatever is set.
"""

import hashlib
import io
import re
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from itertools import groupby
from typing import Any
from xml.etree import ElementTree

import matplotlib
from markupsafe import Markup
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure
from matplotlib.text import Text

from verify.pages.text.typography import NBSP

INK = "#010203"
# Okabe and Ito's colours, darkened where they would fade on white; style.css has the dark theme's.
SERIES = ("#0072b2", "#c44e00", "#00805c", "#a5407f", "#7a6200", "#2f6fd0", "#8a3ffc", "#5b6670")

_SVG = "http://www.w3.org/2000/svg"
_HREF = "{http://www.w3.org/1999/xlink}href"
_PLACES = 1  # decimals of a coordinate: a tenth of a point is less than a pixel
_UNITS: int = 10**_PLACES
_OWN = ("x", "y", "href")  # of a mark
_NUMBER = re.compile(r"-?\d+\.?\d*(?:e-?\d+)?")
_UNWANTED = {"font", "font-family", "font-style", "font-variant", "font-weight", "font-stretch"}
_RC: Any = {
    "svg.fonttype": "none",
    "svg.hashsalt": "areaproof",
    "font.family": "DejaVu Sans",
    "font.size": 12,
    "axes.titlesize": 12,
    "axes.titlelocation": "left",
    "axes.labelsize": 12,
    "legend.fontsize": 11,
    "text.color": INK,
    "axes.edgecolor": INK,
    "axes.labelcolor": INK,
    "xtick.color": INK,
    "ytick.color": INK,
    "axes.linewidth": 0.7,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.unicode_minus": True,
    "axes.facecolor": "none",
    "figure.facecolor": "none",
    "legend.frameon": False,
    "mathtext.default": "regular",
    "text.usetex": False,
    "text.parse_math": False,  # a name or a source with dollar signs stays text
    "path.simplify": False,
}


@contextmanager
def styled(**changes: object) -> Iterator[None]:
    """matplotlib under this page's settings, and as it was before afterwards."""
    with matplotlib.rc_context():
        matplotlib.rcdefaults()
        matplotlib.rcParams.update(_RC | changes)
        yield


def drawing(draw: Callable[[], Figure], *, name: str, label: str) -> Markup:
    """The figure that `draw` makes, as an inline SVG image.

    `name` prefixes every id, so it must be unique on the page; `label` is the text alternative.
    matplotlib's settings are as before afterwards.
    """
    with styled():
        stream = io.StringIO()
        figure = draw()
        for text in figure.findobj(Text):
            text.set_text(_printable(text.get_text()))
        _lay_out(figure)
        figure.savefig(stream, format="svg", metadata={"Date": None})
    root = ElementTree.fromstring(stream.getvalue())  # noqa: S314 - matplotlib's own output
    return _inline(root, name, _printable(label))


def _lay_out(figure: Figure) -> None:
    """Places what is in the figure. Left to it, `savefig` first draws the whole figure for that."""
    engine = figure.get_layout_engine()
    if engine is not None:
        FigureCanvasSVG(figure)  # by whose letters it is measured
        engine.execute(figure)
        figure.set_layout_engine(None)


def _printable(text: str) -> str:
    """Without control characters, which no XML may hold; a number's own blanks stay."""
    return "".join(
        c if c.isprintable() or c in ("\n", NBSP) else "\N{REPLACEMENT CHARACTER}" for c in text
    )


def _inline(root: Any, name: str, label: str) -> Markup:
    _drop(root)
    for attribute in ("width", "height", "version"):
        root.attrib.pop(attribute)
    used: set[str] = set()
    name = f"f{hashlib.sha256(name.encode()).hexdigest()[:8]}"  # short: of thousands of marks
    for element in root.iter():
        element.tag = element.tag.removeprefix(f"{{{_SVG}}}")
        element.text, element.tail = _stripped(element.text), _stripped(element.tail)
        _tidy(element, name, used)
    for element in root.iter():
        if element.get("id", "") not in used:
            element.attrib.pop("id", None)
    _unwrap(root)
    _group_marks(root)
    root.set("role", "img")
    root.set("aria-label", label)
    root.set("font-size", str(_RC["font.size"]))
    title = ElementTree.Element("title")
    title.text = label
    root.insert(0, title)
    return Markup(ElementTree.tostring(root, encoding="unicode"))  # noqa: S704 - serialised XML


def _drop(root: Any) -> None:
    """Remove metadata, global styles (they would reach the whole page) and invisible paths."""
    for parent in list(root.iter()):
        for child in list(parent):
            tag = child.tag.removeprefix(f"{{{_SVG}}}")
            invisible = tag == "path" and child.get("style") == "fill: none"
            if tag in ("metadata", "style") or invisible:
                parent.remove(child)


def _unwrap(root: Any) -> None:
    """Put the content of groups that say nothing in their place, from the leaves upwards."""
    for parent in reversed(list(root.iter())):
        for index, child in reversed(list(enumerate(parent))):
            if (child.tag == "g" and not child.attrib) or (child.tag == "defs" and not len(child)):
                parent[index : index + 1] = list(child)


def _group_marks(root: Any) -> None:
    """What equal marks in a row have in common is said once, by a group around them."""
    for parent in list(root.iter()):
        found: list[Any] = []
        for look, alike in groupby(list(parent), key=_look):
            marks = list(alike)
            if look is not None and len(marks) > 1:
                group = ElementTree.Element("g", dict(look))
                for mark in marks:
                    mark.attrib = {k: mark.attrib[k] for k in _OWN if k in mark.attrib}
                group.extend(marks)
                marks = [group]
            found += marks
        parent[:] = found


def _look(element: Any) -> tuple[tuple[str, str], ...] | None:
    """All of a mark but where it stands; None of what is none."""
    if element.tag != "use":
        return None
    return tuple(sorted((k, v) for k, v in element.attrib.items() if k not in _OWN))


def _stripped(text: str | None) -> str | None:
    return text if text and text.strip() else None


def _tidy(element: Any, name: str, used: set[str]) -> None:
    """Own ids, short coordinates, themed colours, the page's fonts."""
    attributes = element.attrib
    if "id" in attributes:
        attributes["id"] = f"{name}-{attributes['id']}"
    if _HREF in attributes:
        target = f"{name}-{attributes.pop(_HREF).removeprefix('#')}"
        attributes["href"] = f"#{target}"
        used.add(target)
    if "clip-path" in attributes:
        target = f"{name}-{attributes['clip-path'][len('url(#') : -1]}"
        attributes["clip-path"] = f"url(#{target})"
        used.add(target)
    if "d" in attributes:
        attributes["d"] = _short_path(attributes["d"])
    for key in ("x", "y", "width", "height"):
        if key in attributes:
            attributes[key] = _rounded(attributes[key])
    if "transform" in attributes:
        attributes["transform"] = _NUMBER.sub(lambda m: _rounded(m[0]), attributes["transform"])
        if attributes["transform"].startswith("rotate(0 "):
            del attributes["transform"]
    if "style" in attributes:
        _set_style(element)


def _set_style(element: Any) -> None:
    pairs = (part.partition(":") for part in element.attrib.pop("style").split(";"))
    style = {key.strip(): text.strip() for key, _, text in pairs}
    kept = {k: _themed(v) for k, v in style.items() if k not in _UNWANTED}
    if element.tag in ("path", "use"):
        kept.pop("stroke-linejoin", None)
    for key, text in kept.items():
        if "var(" not in text:
            element.set(key, text)
    themed = "; ".join(f"{k}: {v}" for k, v in kept.items() if "var(" in v)
    if themed:
        element.set("style", themed)


def _themed(text: str) -> str:
    if text == INK:
        return "currentColor"
    if text in SERIES:
        return f"var(--series-{SERIES.index(text) + 1}, {text})"
    return text.removesuffix("px") if re.fullmatch(r"[\d.]+px", text) else text


def _rounded(text: str) -> str:
    shown = f"{float(text):.{_PLACES}f}".rstrip("0").rstrip(".")
    return "0" if shown == "-0" else shown


def _short_path(path: str) -> str:
    """The path with rounded coordinates, without steps of no length, straight steps relative.

    What is rounded are the places, not the steps between them, so that nothing adds up.
    """
    out: list[str] = []
    x = y = 0
    begun = [0, 0]  # where `z` leads back to
    for command, rest in re.findall(r"([MLCQz])([^MLCQz]*)", path):
        numbers = [_units(n) for n in _NUMBER.findall(rest)]
        if command == "L":
            out.append(_straight(numbers[0] - x, numbers[1] - y))
        else:
            out.append(command + _joined(numbers))
        x, y = numbers[-2:] or begun
        if command == "M":
            begun = [x, y]
    return "".join(out)


def _units(text: str) -> int:
    """A coordinate in units of the last decimal that is kept."""
    return round(float(text) * _UNITS)


def _straight(right: int, down: int) -> str:
    if not right:
        return f"v{_decimal(down)}" if down else ""
    return f"l{_joined([right, down])}" if down else f"h{_decimal(right)}"


def _joined(numbers: Sequence[int]) -> str:
    """A minus sign sets numbers apart as well as a space."""
    return " ".join(_decimal(n) for n in numbers).replace(" -", "-")


def _decimal(units: int) -> str:
    whole, part = divmod(abs(units), _UNITS)
    digits = f".{part:0{_PLACES}d}".rstrip("0").rstrip(".")
    shown = f"{whole or ''}{digits}" or "0"
    return f"-{shown}" if units < 0 else shown


def document(figures: Sequence[Markup]) -> str:
    """Inline figures below one another as one SVG document, on white."""
    boxes = [ElementTree.fromstring(str(svg)) for svg in figures]  # noqa: S314 - our own
    sizes = [[float(x) for x in box.get("viewBox", "0 0 0 0").split()[2:]] for box in boxes]
    width, height = max((w for w, _ in sizes), default=1.0), sum(h for _, h in sizes)
    root = ElementTree.Element(
        "svg", xmlns=_SVG, viewBox=f"0 0 {width:g} {height:g}", width=f"{width:g}pt",
        height=f"{height:g}pt", style='font-family: "DejaVu Sans", Verdana, sans-serif',
    )  # fmt: skip
    ElementTree.SubElement(root, "rect", width="100%", height="100%", fill="#fff")
    top = 0.0
    for box, (w, h) in zip(boxes, sizes, strict=True):
        box.set("y", f"{top:g}")
        box.set("width", f"{w:g}")
        box.set("height", f"{h:g}")
        root.append(box)
        top += h
    return ElementTree.tostring(root, encoding="unicode") + "\n"
