"""Conversion of a matplotlib figure to SVG inside a page: fluid, themed by CSS, with unique ids.

matplotlib draws in fixed colours, which are replaced by CSS here: the ink by `currentColor`, the
colours of series by custom properties, with the light theme's colour as their fallback.

matplotlib's settings do not suffice: `svg.id` names the root alone, and all other ids (`axes_1`)
are the same in each figure; a style for `*` and paths with six decimals cannot be switched off.
"""

import hashlib
import io
import re
from collections.abc import Callable, Sequence
from itertools import groupby
from typing import Any
from xml.etree import ElementTree

from markupsafe import Markup
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure
from matplotlib.text import Text

from verify.pages.figures.sheet import FONT_SIZE, INK, SERIES, page_style
from verify.pages.text.typography import NBSP

_SVG = "http://www.w3.org/2000/svg"
_HREF = "{http://www.w3.org/1999/xlink}href"
# The decimals of a coordinate: a tenth of a point is less than a pixel.
_DECIMALS = 1
_UNITS_PER_POINT: int = 10**_DECIMALS
# The attributes that differ between equal marks; their group has all others.
_PLACE_ATTRIBUTES = ("x", "y", "href")
_NUMBER = re.compile(r"-?\d+\.?\d*(?:e-?\d+)?")
_FONT_PROPERTIES = {
    "font",
    "font-family",
    "font-style",
    "font-variant",
    "font-weight",
    "font-stretch",
}


def render_svg(draw: Callable[[], Figure], *, name: str, label: str) -> Markup:
    """Return the figure that `draw` makes as an inline SVG image.

    `name` prefixes every id, so it must be unique on the page; `label` is the text alternative.
    matplotlib's settings are restored afterwards.
    """
    with page_style():
        stream = io.StringIO()
        figure = draw()
        for text in figure.findobj(Text):
            text.set_text(_printable(text.get_text()))
        _lay_out(figure)
        figure.savefig(stream, format="svg", metadata={"Date": None})
    root = ElementTree.fromstring(stream.getvalue())  # noqa: S314 - matplotlib's own output
    return _inline(root, name, _printable(label))


def _lay_out(figure: Figure) -> None:
    """Compute the layout, for which `savefig` would draw the whole figure a second time."""
    engine = figure.get_layout_engine()
    if engine is not None:
        FigureCanvasSVG(figure)  # its renderer measures the texts
        engine.execute(figure)
        figure.set_layout_engine(None)


def _printable(text: str) -> str:
    """Replace characters that are not printable, which XML may not allow, but no-break spaces."""
    return "".join(
        c if c.isprintable() or c in ("\n", NBSP) else "\N{REPLACEMENT CHARACTER}" for c in text
    )


def _inline(root: Any, name: str, label: str) -> Markup:
    _drop_superfluous(root)
    for attribute in ("width", "height", "version"):
        root.attrib.pop(attribute)
    used_ids: set[str] = set()
    # The prefix of ids is a short hash, as a figure may have thousands of marks.
    prefix = f"f{hashlib.sha256(name.encode()).hexdigest()[:8]}"
    for element in root.iter():
        element.tag = element.tag.removeprefix(f"{{{_SVG}}}")
        element.text, element.tail = _blank_to_none(element.text), _blank_to_none(element.tail)
        _tidy(element, prefix, used_ids)
    for element in root.iter():
        if element.get("id", "") not in used_ids:
            element.attrib.pop("id", None)
    _unwrap(root)
    _group_marks(root)
    root.set("role", "img")
    root.set("aria-label", label)
    root.set("font-size", str(FONT_SIZE))
    title = ElementTree.Element("title")
    title.text = label
    root.insert(0, title)
    return Markup(ElementTree.tostring(root, encoding="unicode"))  # noqa: S704 - serialised XML


def _drop_superfluous(root: Any) -> None:
    """Remove metadata, global styles (which would affect the whole page) and invisible paths."""
    for parent in list(root.iter()):
        for child in list(parent):
            tag = child.tag.removeprefix(f"{{{_SVG}}}")
            is_invisible = tag == "path" and child.get("style") == "fill: none"
            if tag in ("metadata", "style") or is_invisible:
                parent.remove(child)


def _unwrap(root: Any) -> None:
    """Replace groups without attributes, and empty definitions, by their content."""
    # From the leaves upwards, as an element may become empty when its children are unwrapped.
    for parent in reversed(list(root.iter())):
        for index, child in reversed(list(enumerate(parent))):
            if (child.tag == "g" and not child.attrib) or (child.tag == "defs" and not len(child)):
                parent[index : index + 1] = list(child)


def _group_marks(root: Any) -> None:
    """Group consecutive equal marks, so that their common attributes are written once."""
    for parent in list(root.iter()):
        children: list[Any] = []
        for common, equal_marks in groupby(list(parent), key=_common_attributes):
            marks = list(equal_marks)
            if common is not None and len(marks) > 1:
                group = ElementTree.Element("g", dict(common))
                for mark in marks:
                    mark.attrib = {k: mark.attrib[k] for k in _PLACE_ATTRIBUTES if k in mark.attrib}
                group.extend(marks)
                marks = [group]
            children += marks
        parent[:] = children


def _common_attributes(element: Any) -> tuple[tuple[str, str], ...] | None:
    """Return the attributes of a mark except its place; None if the element is no mark."""
    if element.tag != "use":
        return None
    return tuple(sorted((k, v) for k, v in element.attrib.items() if k not in _PLACE_ATTRIBUTES))


def _blank_to_none(text: str | None) -> str | None:
    return text if text and text.strip() else None


def _tidy(element: Any, prefix: str, used_ids: set[str]) -> None:
    """Give the element a unique id, short coordinates, themed colours and no fonts of its own."""
    attributes = element.attrib
    if "id" in attributes:
        attributes["id"] = f"{prefix}-{attributes['id']}"
    if _HREF in attributes:
        target = f"{prefix}-{attributes.pop(_HREF).removeprefix('#')}"
        attributes["href"] = f"#{target}"
        used_ids.add(target)
    if "clip-path" in attributes:
        target = f"{prefix}-{attributes['clip-path'][len('url(#') : -1]}"
        attributes["clip-path"] = f"url(#{target})"
        used_ids.add(target)
    if "d" in attributes:
        attributes["d"] = _short_path(attributes["d"])
    for key in ("x", "y", "width", "height"):
        if key in attributes:
            attributes[key] = _round_decimal(attributes[key])
    if "transform" in attributes:
        attributes["transform"] = _NUMBER.sub(
            lambda m: _round_decimal(m[0]), attributes["transform"]
        )
        if attributes["transform"].startswith("rotate(0 "):
            del attributes["transform"]
    if "style" in attributes:
        _set_style(element)


def _set_style(element: Any) -> None:
    pairs = (part.partition(":") for part in element.attrib.pop("style").split(";"))
    style = {key.strip(): text.strip() for key, _, text in pairs}
    properties = {k: _apply_theme(v) for k, v in style.items() if k not in _FONT_PROPERTIES}
    # The join of such thin strokes is not visible, and would be repeated for every mark.
    if element.tag in ("path", "use"):
        properties.pop("stroke-linejoin", None)
    for key, text in properties.items():
        if "var(" not in text:
            element.set(key, text)
    css = "; ".join(f"{k}: {v}" for k, v in properties.items() if "var(" in v)
    if css:
        element.set("style", css)


def _apply_theme(text: str) -> str:
    if text == INK:
        return "currentColor"
    if text in SERIES:
        return f"var(--series-{SERIES.index(text) + 1}, {text})"
    return text.removesuffix("px") if re.fullmatch(r"[\d.]+px", text) else text


def _round_decimal(text: str) -> str:
    digits = f"{float(text):.{_DECIMALS}f}".rstrip("0").rstrip(".")
    return "0" if digits == "-0" else digits


def _short_path(path: str) -> str:
    """Return the path with rounded coordinates, relative straight steps, and no empty steps.

    Points are rounded, and rounded points subtracted, so that no errors accumulate.
    """
    commands: list[str] = []
    x = y = 0
    start = [0, 0]  # the point to which `z` leads back
    for command, arguments in re.findall(r"([MLCQz])([^MLCQz]*)", path):
        numbers = [_to_units(n) for n in _NUMBER.findall(arguments)]
        if command == "L":
            commands.append(_format_straight(numbers[0] - x, numbers[1] - y))
        else:
            commands.append(command + _join_numbers(numbers))
        x, y = numbers[-2:] or start
        if command == "M":
            start = [x, y]
    return "".join(commands)


def _to_units(text: str) -> int:
    """Return a coordinate in units of the last decimal that is written."""
    return round(float(text) * _UNITS_PER_POINT)


def _format_straight(right: int, down: int) -> str:
    if not right:
        return f"v{_format_units(down)}" if down else ""
    return f"l{_join_numbers([right, down])}" if down else f"h{_format_units(right)}"


def _join_numbers(numbers: Sequence[int]) -> str:
    """Join numbers by spaces, except before a minus sign, which separates as well."""
    return " ".join(_format_units(n) for n in numbers).replace(" -", "-")


def _format_units(units: int) -> str:
    integer_part, part = divmod(abs(units), _UNITS_PER_POINT)
    digits = f".{part:0{_DECIMALS}d}".rstrip("0").rstrip(".")
    text = f"{integer_part or ''}{digits}" or "0"
    return f"-{text}" if units < 0 else text


def document(figures: Sequence[Markup]) -> str:
    """Return inline figures below one another as one SVG document, on white."""
    boxes = [ElementTree.fromstring(str(svg)) for svg in figures]  # noqa: S314 - our own
    sizes = [[float(x) for x in box.get("viewBox", "0 0 0 0").split()[2:]] for box in boxes]
    width, height = max((w for w, _ in sizes), default=1.0), sum(h for _, h in sizes)
    root = ElementTree.Element(
        "svg", xmlns=_SVG, viewBox=f"0 0 {width:g} {height:g}", width=f"{width:g}pt",
        height=f"{height:g}pt", style='font-family: "DejaVu Sans", Verdana, sans-serif',
    )  # fmt: skip
    ElementTree.SubElement(root, "rect", width="100%", height="100%", fill="#fff")
    y = 0.0
    for box, (w, h) in zip(boxes, sizes, strict=True):
        box.set("y", f"{y:g}")
        box.set("width", f"{w:g}")
        box.set("height", f"{h:g}")
        root.append(box)
        y += h
    return ElementTree.tostring(root, encoding="unicode") + "\n"
