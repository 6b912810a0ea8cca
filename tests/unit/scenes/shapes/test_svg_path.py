"""SVG's path data: what it draws, against points got another way, and what is refused."""

from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise
from typing import Any

import mpmath
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.helpers.svg_reader import PLACES, by_de_casteljau, by_the_centre, drawn
from verify.arithmetic.float_context import FLOAT
from verify.errors import InputError
from verify.scenes.shapes.outline import EllipticalArc, Outline
from verify.scenes.shapes.svg_path import MAX_LENGTH, MAX_SEGMENTS, subpaths
from verify.scenes.shapes.user_outline import svg_path


def agree(outline: Outline, expected: Sequence[Any]) -> bool:
    assert len(outline.arcs) == len(expected)
    return all(
        np.allclose(drawn(arc), curve, rtol=0, atol=1e-12)
        for arc, curve in zip(outline.arcs, expected, strict=True)
    )


def closes(outline: Outline) -> bool:
    pairs = zip(outline.arcs, (*outline.arcs[1:], outline.arcs[0]), strict=True)
    return all(abs(drawn(a)[-1] - drawn(b)[0]) < 1e-13 for a, b in pairs)


LINES = [by_de_casteljau(*pair) for pair in ((1 + 2j, 4 + 2j), (4 + 2j, 4 + 6j), (4 + 6j, 1 + 2j))]
CUBICS = [
    by_de_casteljau(1 + 1j, 2 + 0j, 3 + 0.5j, 4 + 2j),
    by_de_casteljau(4 + 2j, 5 + 3.5j, 6 + 6j, 3 + 7j),  # mirrors 3 + 0.5j about 4 + 2j
    by_de_casteljau(3 + 7j, 1 + 1j),
]
QUADRATICS = [
    by_de_casteljau(0j, 1 - 2j, 3 + 0j),
    by_de_casteljau(3 + 0j, 5 + 2j, 6 + 1j),
    by_de_casteljau(6 + 1j, 7 + 0j, 8 + 3j),
    by_de_casteljau(8 + 3j, 0j),
]
ARCS = [
    by_the_centre(1 + 1j, 3, 2, 30, 0, 1, 4 + 2j),
    by_the_centre(4 + 2j, 3, 2, -20.5, 1, 0, 5 + 0j),
    by_the_centre(5 + 0j, 1, 4, 45, 1, 1, 1 + 1j),
]


@pytest.mark.parametrize(
    ("data", "expected"),
    [
        ("M 1 2 L 4 2 L 4 6 Z", LINES),
        ("m 1 2 l 3 0 l 0 4 z", LINES),
        ("M1,2H4V6Z", LINES),
        ("M1 2h3v4z", LINES),
        ("m1 2 3 0 0 4z", LINES),
        ("M1 2 4 2 4 6 1 2", LINES),
        ("M 1 2 h 1 2 l 0 0 V 3 6 z", [
            by_de_casteljau(1 + 2j, 2 + 2j), by_de_casteljau(2 + 2j, 4 + 2j),
            by_de_casteljau(4 + 2j, 4 + 3j), by_de_casteljau(4 + 3j, 4 + 6j), LINES[2],
        ]),
        ("M1 1 C 2 0 3 .5 4 2 S 6 6 3 7 Z", CUBICS),
        ("m1 1c1-1 2-.5 3 1s2 4-1 5z", CUBICS),
        ("M0 0 Q 1-2 3 0 T 6 1 8 3 Z", QUADRATICS),
        ("m0 0q1-2 3 0t3 1 2 2z", QUADRATICS),
        ("M1 1 A 3 2 30 0 1 4 2 A 3 2 -20.5 1 0 5 0 A 1 4 45 1 1 1 1 Z", ARCS),
        ("m1 1a3 2 30 013 1 3 2-20.5 101-2 1 4 45 11-4 1", ARCS),
        ("M1 1 A -3 2 30 0 1 4 2 A 3,-2,-20.5,1,0,5,0 A 1 4 405 1 1 1 1 Z", ARCS),
    ],
)  # fmt: skip
def test_every_command_draws_what_the_specification_says(data: str, expected: list[Any]) -> None:
    (outline,) = svg_path(data).outlines
    assert agree(outline, expected)
    assert closes(outline)


@pytest.mark.parametrize(
    ("data", "expected"),
    [
        ("M1 2H4V7Z", LINES),
        ("M1 1 C 2 0 3 .5 4 2 C 4 2 6 6 3 7 Z", CUBICS),
        ("M1 1 A 3 2 30 0 0 4 2 A 3 2 -20.5 1 0 5 0 A 1 4 45 1 1 1 1 Z", ARCS),
        ("M1 1 A 3 2 30 1 1 4 2 A 3 2 -20.5 1 0 5 0 A 1 4 45 1 1 1 1 Z", ARCS),
        ("M1 1 A 3 2 -30 0 1 4 2 A 3 2 -20.5 1 0 5 0 A 1 4 45 1 1 1 1 Z", ARCS),
    ],
)
def test_another_path_is_seen_to_differ(data: str, expected: list[Any]) -> None:
    assert not agree(svg_path(data).outlines[0], expected)


def test_a_mirrored_control_point_needs_a_curve_of_the_same_kind_before() -> None:
    for data, first in (("M0 0 h 2 S 4 4 0 4 Z", 2), ("M0 0 Q 1 1 2 0 S 4 4 0 4 Z", 2)):
        cubic = svg_path(data).outlines[0].arcs[1]
        assert np.allclose(drawn(cubic), by_de_casteljau(first, first, 4 + 4j, 4j))
    quadratic = svg_path("M0 0 C 1 1 1 1 2 0 T 4 4 Z").outlines[0].arcs[1]
    assert np.allclose(drawn(quadratic), by_de_casteljau(2, 2, 4 + 4j))


def test_subpaths_are_outlines_and_begin_where_the_one_before_was_closed() -> None:
    shape = svg_path("M 1 1 h 2 v 2 z m 10 0 h 1 v 1 z l 0 2 2 0 z M 9 9 z", "mine")
    assert [outline.name for outline in shape.outlines] == ["mine 1", "mine 2", "mine 3"]
    starts = [drawn(outline.arcs[0])[0] for outline in shape.outlines]
    assert starts == [1 + 1j, 11 + 1j, 11 + 1j]
    assert drawn(shape.outlines[2].arcs[1])[-1] == 13 + 3j


def test_y_points_downwards_in_svg() -> None:
    """Clockwise on the screen is clockwise in the plane: the y of SVG is −p."""
    (outline,) = svg_path("M 0 0 h 1 v 1 z").outlines
    _, y = outline.arcs[1](FLOAT, np.array([1.0]))
    assert y == -1


def test_segments_of_no_length_are_dropped() -> None:
    path = "M0 0 l 0 0 h 0 c 0 0 0 0 0 0 a 1 1 0 0 1 0 0 q 0 0 0 0 h 1 v 1 L 0 0 z z"
    assert len(subpaths(path)) == 1
    assert len(subpaths(path)[0]) == 3
    assert len(subpaths("M 0 0 c 1 1 -1 1 0 0 z")[0]) == 1, "a loop has a length"


def test_an_arc_without_a_radius_is_a_line() -> None:
    (segments,) = subpaths("M0 0 a 0 1 0 0 1 1 0 v 1 z")
    assert not any(isinstance(segment, EllipticalArc) for segment in segments)


def test_arcs_drawn_at_random_are_those_of_the_specification() -> None:
    random = np.random.default_rng(3)
    for _ in range(300):
        x1, y1, x2, y2, rx, ry = random.integers(-40, 40, size=6) / 8
        if (x1, y1) == (x2, y2) or rx * ry == 0:
            continue
        degrees, large, sweep = random.integers(-400, 400) / 2, *random.integers(0, 2, size=2)
        data = f"M {x1} {y1} A {rx} {ry} {degrees} {large} {sweep} {x2} {y2} Z"
        arc = svg_path(data).outlines[0].arcs[0]
        expected = by_the_centre(
            complex(x1, y1), rx, ry, degrees, large, sweep, complex(x2, y2)
        )  # fmt: skip
        # Where the ellipse only just reaches, its own formula keeps half of the digits.
        assert np.allclose(drawn(arc), expected, rtol=0, atol=1e-6), data


def circle_of_halves(degrees: str, radius: str = "1") -> Outline:
    half = f"A {radius} {radius} {degrees} 0 1"
    return svg_path(f"M 1 0 {half} -1 0 {half} 1 0 Z").outlines[0]


@pytest.mark.parametrize("degrees", ["0", "30", "45", "17.3"])
@pytest.mark.parametrize("radius", ["1", "0.2"])  # the second is too small, and scaled up
def test_halves_of_a_circle_keep_every_digit(degrees: str, radius: str) -> None:
    """The root of what rounding leaves of 0 would cost half of them, taken plainly."""
    for digits in (15, 30, 100):
        mp = mpmath.MPContext()
        mp.dps = digits
        for arc in circle_of_halves(degrees, radius).arcs:
            for k in range(9):
                x, y = arc(mp, mp.mpf(k) / 8)
                assert abs(mp.hypot(x, y) - 1) < mp.mpf(10) ** (1 - digits)
    x, y = circle_of_halves(degrees, radius).arcs[0](FLOAT, PLACES)
    assert np.abs(np.hypot(x, y) - 1).max() < 1e-15


@pytest.mark.parametrize("places", [20, 32])
def test_nearly_half_a_circle_is_not_taken_for_half(places: int) -> None:
    """The control of the test above: a radius 10⁻²⁰ longer moves the middle by some 10⁻¹⁰."""
    mp, precise = mpmath.MPContext(), mpmath.MPContext()
    mp.dps, precise.dps = 30, 90
    longer = f"1.{'0' * (places - 1)}1"
    (arc, _) = svg_path(f"M 1 0 A {longer} 1 0 0 0 -1 0 Z").outlines[0].arcs
    _, y = arc(mp, mp.mpf(1) / 2)
    true = 1 - precise.sqrt(1 - precise.mpf(longer) ** -2)
    assert abs(y - true) < 1e-29
    assert abs(true - 1) > 10.0 ** (-places / 2)


def test_an_arc_of_a_very_large_circle_keeps_its_ends() -> None:
    (arc, _) = svg_path("M 0 0 A 1e40 1e40 0 0 1 1 0 Z").outlines[0].arcs
    assert np.allclose(drawn(arc), PLACES, rtol=0, atol=1e-15)


@pytest.mark.parametrize(
    ("data", "message"),
    [
        ("", r"path='': draws no curve"),
        (" \n", r"draws no curve"),
        ("M 3 4", r"draws no curve"),
        ("L 1 1", r"path=L 1 1: at character 1: path data begins with M or m"),
        ("M 0 0 L 1 1", r"at character 1: this subpath is not closed; end it with Z"),
        ("M0 0h1v1L0 1e-50", r"at character 1: this subpath is not closed"),
        ("M0 0h1v1z M5 5h1v1 M 6 6", r"at character 11: this subpath is not closed"),
        ("M0 0h1v1z h1", r"at character 11: this subpath is not closed"),
        ("M 0 0 L 1 1 z", r"its subpath 1 lies on a line and bounds no area"),
        ("M0 0h1v1z M0 0c1 1 2 2 3 3z", r"its subpath 2 lies on a line"),
        ("M 0 0 h 1 v", r"path=\(the end\): at character 12: a number is missing: v takes 1"),
        ("M 0 0 1,,2", r"path=,2: at character 9: a number is missing"),
        ("M 0 0, z", r"at character 8: a number is missing"),
        ("M 0", r"at character 4: a number is missing: M takes 2"),
        ("M, 0 0", r"at character 2: a number is missing"),
        ("M0 0h1v1z 5", r"path=5: at character 11: not a command; allowed: M L H"),
        ("M 0 0 R 1 1", r"path=R 1 1: at character 7: not a command; allowed: M L H V"),
        ("M 0 0 h 1em", r"path=em: at character 10: not a command"),
        ("M 0 0 h nan", r"at character 9: a number is missing"),
        ("M 0 0 h .", r"at character 9: a number is missing"),
        ("M 0 0 h --1", r"at character 9: a number is missing"),
        ("M 0 0 h ٣", r"at character 9: a number is missing"),
        ("M 0 0 ſ 1 1 1 1", r"at character 7: not a command"),
        ("M 0 0 h 1e51", r"at character 9: an exponent beyond ±50"),
        ("M 0 0 h 1e-" + "9" * 30, r"an exponent beyond ±50"),
        ("M 0 0 h " + "1" * 51, r"at character 9: a number of more than 50 characters"),
        ("M 0 0 h " + "1" * 6000, r"a number of more than 50 characters"),
        ("M 0 0 a 1 1 0 2 0 1 1 z", r"path=2 0 1 1 z: at character 15: an arc's flag; allowed: 0"),
        ("M 0 0 a 1 1 0 1", r"path=\(the end\): at character 16: an arc's flag"),
        ("M 0 0 " + "h 1 " * MAX_SEGMENTS, r"more than 2000 segments"),
        ("M 0 0 h" + " 1" * (MAX_SEGMENTS + 5), r"more than 2000 segments"),
        (" " * (MAX_LENGTH + 1), r"longer than 100000 characters"),
        (17, r"path=17: not a text"),
    ],
)
def test_bad_path_data_is_refused_where_it_is_bad(data: str, message: str) -> None:
    with pytest.raises(InputError, match=message) as caught:
        svg_path(data)
    assert "\n" not in str(caught.value)


numbers = st.builds(Fraction, st.integers(-(10**9), 10**9), st.sampled_from([1, 10, 1000, 10**8]))


@st.composite
def written(draw: st.DrawFn) -> tuple[Fraction, str]:
    """A number and one of the ways in which SVG writes it."""
    digits, places = draw(st.integers(0, 10**12)), draw(st.integers(0, 6))
    power = draw(st.integers(-9, 9))
    sign = draw(st.sampled_from(["", "-", "+"]))
    value = Fraction(digits, 10**places) * Fraction(10) ** power * (-1 if sign == "-" else 1)
    whole, part = divmod(digits, 10**places)
    text = f"{whole}" + (f".{part:0{places}d}" if places else draw(st.sampled_from(["", "."])))
    if whole == 0 and places and draw(st.booleans()):
        text = text[1:]
    exponent = f"{power:{draw(st.sampled_from(['d', '+d', '03d']))}}"
    return value, sign + text + (f"{draw(st.sampled_from('eE'))}{exponent}" if power else "")


def glued(texts: Sequence[str]) -> str:
    """As tightly as the grammar allows: a space only where two numbers would become one."""
    result = texts[0]
    for before, text in pairwise(texts):
        begins = text[0] in "+-" or (text[0] == "." and ("." in before or "e" in before.lower()))
        result += text if begins else " " + text
    return result


@given(st.lists(written(), min_size=2, max_size=12), st.sampled_from([" ", ",", " , ", "\n", None]))
def test_numbers_are_read_exactly_however_they_are_written(
    pairs: list[tuple[Fraction, str]], between: str | None
) -> None:
    pairs = pairs[: len(pairs) // 2 * 2]
    texts = [text for _, text in pairs]
    data = f"M{glued(texts) if between is None else between.join(texts)}z"
    points = [
        (x, -y) for (x, _), (y, _) in zip(pairs[::2], pairs[1::2], strict=True)
    ]  # fmt: skip
    wanted = [(a, b) for a, b in zip(points, [*points[1:], points[0]], strict=True) if a != b]
    if not wanted:
        with pytest.raises(InputError, match="draws no curve"):
            subpaths(data)
    else:
        assert subpaths(data) == [tuple(wanted)]


@given(st.lists(st.tuples(numbers, numbers), min_size=3, max_size=9))
def test_relative_commands_draw_what_absolute_ones_do(corners: list[tuple[Any, Any]]) -> None:
    def pairs(points: Sequence[tuple[Fraction, Fraction]]) -> str:
        return " ".join(f"{in_units(x)} {in_units(y)}" for x, y in points)

    steps = [(b[0] - a[0], b[1] - a[1]) for a, b in zip([(0, 0), *corners], corners, strict=False)]
    absolute, relative = f"M {pairs(corners)} z", f"m {pairs(steps)} z"
    if len(set(corners)) > 1:
        assert subpaths(absolute) == subpaths(relative)


def in_units(x: Fraction) -> str:
    return f"{x.numerator * 10**8 // x.denominator}e-8"
