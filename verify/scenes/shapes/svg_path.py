"""Exact reading of SVG path data as the closed curves that it draws.

The grammar is that of SVG 2 (section 9.3), with the numbers that SVG 1.1 also allows (`1.`): the
commands M L H V C S Q T A Z and m l h v c s q t a z, numbers that need no separator (`1.5.5`,
`-1-2`), flags of arcs run together (`a1 1 0 01 1 1`). SVG's y points downwards: here y is −y.

The library svgelements is not used: it reads floats (0.1 is not 1/10, 1e400 is inf), accepts open
curves and `L 1 1 z` without a moveto, and does not say where a text is wrong.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from fractions import Fraction

from verify.errors import InputError
from verify.scenes.shapes.outline import EllipticalArc, Point

MAX_LENGTH = 100_000
MAX_SEGMENTS = 2_000
# Limits on a number's characters and exponent, since exact arithmetic with huge ones is slow.
MAX_NUMBER = 50
MAX_EXPONENT = 50

Bezier = tuple[Point, ...]  # 2 control points: a line; 3, 4: of degree 2, 3
Segment = Bezier | EllipticalArc

_NUMBER = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE]([+-]?[0-9]+))?")
_SPACE = re.compile(r"[ \t\n\f\r]*")
_ARGUMENTS = {"M": 2, "L": 2, "H": 1, "V": 1, "C": 6, "S": 4, "Q": 4, "T": 2, "A": 7, "Z": 0}
# The positions of the flags among the arguments of A.
_FLAGS = (3, 4)
_COMMANDS = "M L H V C S Q T A Z, or small"


def subpaths(text: str, name: str = "path") -> list[tuple[Segment, ...]]:
    """Return the segments of each closed subpath, without those of no length; y points upwards.

    Raises InputError, which names the character, for a text that is not path data, for a subpath
    that is not closed, and beyond the limits on length.
    """
    if len(text) > MAX_LENGTH:
        raise InputError(name, text, f"longer than {MAX_LENGTH} characters")
    reader, pen = _PathReader(text, name), _Pen()
    while reader.has_more():
        place = reader.position
        command = reader.read_command(first=place == reader.begin)
        if command in "Mm":
            _finish_subpath(reader, pen)
            pen.subpath_start = place
        for k, values in enumerate(reader.read_groups(command)):
            # Further pairs of a moveto are lines.
            letter = {"M": "L", "m": "l"}.get(command, command) if k else command
            pen.draw(letter, values)
            if pen.count > MAX_SEGMENTS:
                raise reader.error(f"more than {MAX_SEGMENTS} segments", place)
        # After Z a new subpath may begin at the old start without a moveto.
        if command in "Zz" and reader.has_more():
            pen.subpath_start = reader.position
    _finish_subpath(reader, pen)
    if not pen.finished:
        raise InputError(name, text, "draws no curve; allowed: closed curves, as M 0 0 h 1 v 1 z")
    return pen.finished


def _finish_subpath(reader: "_PathReader", pen: "_Pen") -> None:
    if not pen.finish():
        raise reader.error(
            "this subpath is not closed; end it with Z or at its start", pen.subpath_start
        )


class _PathReader:
    """A text of path data, and the position of the reader in it."""

    def __init__(self, text: str, name: str) -> None:
        self.text, self.name, self.position = text, name, 0
        self._skip_spaces()
        self.begin = self.position

    def error(self, problem: str, place: int | None = None) -> InputError:
        place = self.position if place is None else place
        excerpt = self.text[place : place + 20] or "(the end)"
        return InputError(self.name, excerpt, f"at character {place + 1}: {problem}")

    def has_more(self) -> bool:
        self._skip_spaces()
        return self.position < len(self.text)

    def read_command(self, first: bool) -> str:
        letter = self.text[self.position]
        if letter.upper() not in _ARGUMENTS or not letter.isascii():
            raise self.error(f"not a command; allowed: {_COMMANDS}")
        if first and letter not in "Mm":
            raise self.error("path data begins with M or m")
        self.position += 1
        return letter

    def read_groups(self, command: str) -> list[list[Fraction]]:
        """Return the arguments of each repetition of a command."""
        count = _ARGUMENTS[command.upper()]
        argument_groups = [self._read_group(command, count)]
        while count and self._has_another_group():
            argument_groups.append(self._read_group(command, count))
            if len(argument_groups) > MAX_SEGMENTS:
                raise self.error(f"more than {MAX_SEGMENTS} segments")
        return argument_groups

    def _read_group(self, command: str, count: int) -> list[Fraction]:
        values: list[Fraction] = []
        for k in range(count):
            self._skip_spaces()
            if k and self._take_comma():
                self._skip_spaces()
            is_flag = command in "Aa" and k in _FLAGS
            values.append(
                self._read_flag() if is_flag else self._read_number(f"{command} takes {count}")
            )
        return values

    def _skip_spaces(self) -> None:
        space = _SPACE.match(self.text, self.position)
        self.position = space.end() if space else self.position

    def _take_comma(self) -> bool:
        if self.text.startswith(",", self.position):
            self.position += 1
            return True
        return False

    def _has_another_group(self) -> bool:
        """Return True if more numbers follow, after a comma or not."""
        self._skip_spaces()
        return self._take_comma() or _NUMBER.match(self.text, self.position) is not None

    def _read_flag(self) -> Fraction:
        digit = self.text[self.position : self.position + 1]
        if digit not in ("0", "1"):
            raise self.error("an arc's flag; allowed: 0, 1")
        self.position += 1
        return Fraction(int(digit))

    def _read_number(self, purpose: str) -> Fraction:
        match = _NUMBER.match(self.text, self.position)
        if match is None:
            raise self.error(f"a number is missing: {purpose}")
        if len(match[0]) > MAX_NUMBER:
            raise self.error(f"a number of more than {MAX_NUMBER} characters")
        if abs(int(match[1] or 0)) > MAX_EXPONENT:
            raise self.error(f"an exponent beyond ±{MAX_EXPONENT}")
        self.position = match.end()
        return Fraction(match[0])


@dataclass
class _Pen:
    """The state of the drawing, in SVG's coordinates (y downwards), and the finished subpaths."""

    position: Point = (Fraction(0), Fraction(0))
    start: Point = (Fraction(0), Fraction(0))
    control: tuple[str, Point] | None = None  # the last curve's: for S and T, which mirror it
    segments: list[Segment] = field(default_factory=list)
    finished: list[tuple[Segment, ...]] = field(default_factory=list)
    count: int = 0
    subpath_start: int = 0  # the character where the subpath begins

    def finish(self) -> bool:
        """End the subpath; return False if it is not closed."""
        if self.position != self.start:
            return False
        if self.segments:
            self.finished.append(tuple(self.segments))
        self.segments = []
        return True

    def draw(self, letter: str, values: Sequence[Fraction]) -> None:
        """Draw one command with one group of its arguments."""
        self.count += 1
        kind = letter.upper()
        before, self.control = self.control, None
        if kind == "A":
            self._add_arc(values, self._points(letter, values[5:])[0])
            return
        if kind in "HV":
            offset = self.position if letter.islower() else (Fraction(0), Fraction(0))
            x, y = (
                (offset[0] + values[0], self.position[1]),
                (self.position[0], offset[1] + values[0]),
            )
            self._add_curve(x if kind == "H" else y)
            return
        points = self._points(letter, values)
        if kind == "M":
            self.position = self.start = points[0]
        elif kind == "Z":
            self._add_curve(self.start)
            self.finish()
        elif kind in "ST":
            family = "C" if kind == "S" else "Q"
            self._add_curve(self._mirror_control(before, family), *points, family=family)
        else:
            self._add_curve(*points, family=kind)

    def _points(self, letter: str, values: Sequence[Fraction]) -> list[Point]:
        x, y = self.position if letter.islower() else (Fraction(0), Fraction(0))
        return [(x + a, y + b) for a, b in zip(values[::2], values[1::2], strict=True)]

    def _mirror_control(self, last_curve: tuple[str, Point] | None, family: str) -> Point:
        if last_curve is None or last_curve[0] != family:
            return self.position
        (x, y), (a, b) = self.position, last_curve[1]
        return 2 * x - a, 2 * y - b

    def _add_curve(self, *points: Point, family: str = "L") -> None:
        # Segments of no length are left out: they do not change the curve.
        if any(point != self.position for point in points):
            self.segments.append(tuple(_flip(point) for point in (self.position, *points)))
        if family in "CQ":
            self.control = family, points[-2]
        self.position = points[-1]

    def _add_arc(self, values: Sequence[Fraction], end: Point) -> None:
        radii, turn = (abs(values[0]), abs(values[1])), values[2]
        if 0 in radii:  # a line, by the specification
            self._add_curve(end)
            return
        if end != self.position:
            start, self.position = _flip(self.position), end
            large, clockwise = bool(values[3]), bool(values[4])
            arc = EllipticalArc(start, _flip(end), radii, -turn, large, not clockwise)
            self.segments.append(arc)


def _flip(point: Point) -> Point:
    return point[0], -point[1]
