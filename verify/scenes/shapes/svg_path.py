"""SVG's path data, read exactly: the closed curves that it draws.

The grammar is that of SVG 2 (section 9.3), with the numbers that SVG 1.1 also allows (`1.`): the
commands M L H V C S Q T A Z and m l h v c s q t a z, numbers that need no separator (`1.5.5`,
`-1-2`), flags of arcs run together (`a1 1 0 01 1 1`). SVG's y points downwards: here y is −y.

svgelements reads to floats (0.1 is not 1/10, 1e400 is inf), takes open curves and `L 1 1 z` without
a moveto, and does not say where text is wrong: coordinates here are exact, and errors have a place.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from fractions import Fraction

from verify.errors import InputError
from verify.scenes.shapes.elliptical_arc import EllipticalArc
from verify.scenes.shapes.outline import Point

MAX_LENGTH = 100_000
MAX_SEGMENTS = 2_000
MAX_NUMBER = 50  # characters
MAX_EXPONENT = 50

Bezier = tuple[Point, ...]  # 2 control points: a line; 3, 4: of degree 2, 3
Segment = Bezier | EllipticalArc

_NUMBER = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE]([+-]?[0-9]+))?")
_SPACE = re.compile(r"[ \t\n\f\r]*")
_ARGUMENTS = {"M": 2, "L": 2, "H": 1, "V": 1, "C": 6, "S": 4, "Q": 4, "T": 2, "A": 7, "Z": 0}
_FLAGS = (3, 4)  # of the arguments of A
_COMMANDS = "M L H V C S Q T A Z, or small"


def subpaths(text: str, name: str = "path") -> list[tuple[Segment, ...]]:
    """The segments of each closed subpath, those of no length left out; y points upwards.

    Raises InputError, which says at which character, for what is not path data, a subpath that is
    not closed, and beyond the limits on length.
    """
    if len(text) > MAX_LENGTH:
        raise InputError(name, text, f"longer than {MAX_LENGTH} characters")
    reader, pen = _Reader(text, name), _Pen()
    while reader.more():
        at = reader.at
        command = reader.command(first=at == reader.begin)
        if command in "Mm":
            _finish(reader, pen)
            pen.opened = at
        for k, values in enumerate(reader.groups(command)):
            # Further pairs of a moveto are lines.
            letter = {"M": "L", "m": "l"}.get(command, command) if k else command
            pen.draw(letter, values)
            if pen.count > MAX_SEGMENTS:
                raise reader.wrong(f"more than {MAX_SEGMENTS} segments", at)
        if command in "Zz" and reader.more():
            pen.opened = reader.at
    _finish(reader, pen)
    if not pen.done:
        raise InputError(name, text, "draws no curve; allowed: closed curves, as M 0 0 h 1 v 1 z")
    return pen.done


def _finish(reader: "_Reader", pen: "_Pen") -> None:
    if not pen.finish():
        raise reader.wrong("this subpath is not closed; end it with Z or at its start", pen.opened)


class _Reader:
    """The text and the place in it."""

    def __init__(self, text: str, name: str) -> None:
        self.text, self.name, self.at = text, name, 0
        self._skip()
        self.begin = self.at

    def wrong(self, problem: str, at: int | None = None) -> InputError:
        at = self.at if at is None else at
        found = self.text[at : at + 20] or "(the end)"
        return InputError(self.name, found, f"at character {at + 1}: {problem}")

    def more(self) -> bool:
        self._skip()
        return self.at < len(self.text)

    def command(self, first: bool) -> str:
        letter = self.text[self.at]
        if letter.upper() not in _ARGUMENTS or not letter.isascii():
            raise self.wrong(f"not a command; allowed: {_COMMANDS}")
        if first and letter not in "Mm":
            raise self.wrong("path data begins with M or m")
        self.at += 1
        return letter

    def groups(self, command: str) -> list[list[Fraction]]:
        """The arguments of each repetition of a command."""
        wanted = _ARGUMENTS[command.upper()]
        found = [self._group(command, wanted)]
        while wanted and self._another():
            found.append(self._group(command, wanted))
            if len(found) > MAX_SEGMENTS:
                raise self.wrong(f"more than {MAX_SEGMENTS} segments")
        return found

    def _group(self, command: str, wanted: int) -> list[Fraction]:
        values: list[Fraction] = []
        for k in range(wanted):
            self._skip()
            if k and self._comma():
                self._skip()
            flag = command in "Aa" and k in _FLAGS
            values.append(self._flag() if flag else self._number(f"{command} takes {wanted}"))
        return values

    def _skip(self) -> None:
        space = _SPACE.match(self.text, self.at)
        self.at = space.end() if space else self.at

    def _comma(self) -> bool:
        if self.text.startswith(",", self.at):
            self.at += 1
            return True
        return False

    def _another(self) -> bool:
        """Whether numbers follow, after a comma or not."""
        self._skip()
        return self._comma() or _NUMBER.match(self.text, self.at) is not None

    def _flag(self) -> Fraction:
        digit = self.text[self.at : self.at + 1]
        if digit not in ("0", "1"):
            raise self.wrong("an arc's flag; allowed: 0, 1")
        self.at += 1
        return Fraction(int(digit))

    def _number(self, why: str) -> Fraction:
        match = _NUMBER.match(self.text, self.at)
        if match is None:
            raise self.wrong(f"a number is missing: {why}")
        if len(match[0]) > MAX_NUMBER:
            raise self.wrong(f"a number of more than {MAX_NUMBER} characters")
        if abs(int(match[1] or 0)) > MAX_EXPONENT:
            raise self.wrong(f"an exponent beyond ±{MAX_EXPONENT}")
        self.at = match.end()
        return Fraction(match[0])


@dataclass
class _Pen:
    """Where the drawing stands, and what is drawn. Its coordinates are SVG's, y downwards."""

    here: Point = (Fraction(0), Fraction(0))
    start: Point = (Fraction(0), Fraction(0))
    control: tuple[str, Point] | None = None  # the last curve's: for S and T, which mirror it
    drawn: list[Segment] = field(default_factory=list)
    done: list[tuple[Segment, ...]] = field(default_factory=list)
    count: int = 0
    opened: int = 0  # the character where the subpath begins

    def finish(self) -> bool:
        """Ends the subpath; False where it is not closed."""
        if self.here != self.start:
            return False
        if self.drawn:
            self.done.append(tuple(self.drawn))
        self.drawn = []
        return True

    def draw(self, letter: str, values: Sequence[Fraction]) -> None:
        """One command with one group of its arguments."""
        self.count += 1
        kind = letter.upper()
        before, self.control = self.control, None
        if kind == "A":
            self._arc(values, self._points(letter, values[5:])[0])
            return
        if kind in "HV":
            offset = self.here if letter.islower() else (Fraction(0), Fraction(0))
            x, y = (offset[0] + values[0], self.here[1]), (self.here[0], offset[1] + values[0])
            self._curve(x if kind == "H" else y)
            return
        points = self._points(letter, values)
        if kind == "M":
            self.here = self.start = points[0]
        elif kind == "Z":
            self._curve(self.start)
            self.finish()
        elif kind in "ST":
            family = "C" if kind == "S" else "Q"
            self._curve(self._mirrored(before, family), *points, family=family)
        else:
            self._curve(*points, family=kind)

    def _points(self, letter: str, values: Sequence[Fraction]) -> list[Point]:
        x, y = self.here if letter.islower() else (Fraction(0), Fraction(0))
        return [(x + a, y + b) for a, b in zip(values[::2], values[1::2], strict=True)]

    def _mirrored(self, before: tuple[str, Point] | None, family: str) -> Point:
        if before is None or before[0] != family:
            return self.here
        (x, y), (a, b) = self.here, before[1]
        return 2 * x - a, 2 * y - b

    def _curve(self, *points: Point, family: str = "L") -> None:
        if any(point != self.here for point in points):
            self.drawn.append(tuple(_upwards(point) for point in (self.here, *points)))
        if family in "CQ":
            self.control = family, points[-2]
        self.here = points[-1]

    def _arc(self, values: Sequence[Fraction], end: Point) -> None:
        radii, turn = (abs(values[0]), abs(values[1])), values[2]
        if 0 in radii:  # a line, by the specification
            self._curve(end)
            return
        if end != self.here:
            start, self.here = _upwards(self.here), end
            large, clockwise = bool(values[3]), bool(values[4])
            arc = EllipticalArc(start, _upwards(end), radii, -turn, large, not clockwise)
            self.drawn.append(arc)


def _upwards(point: Point) -> Point:
    return point[0], -point[1]
