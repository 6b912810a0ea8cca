"""The comparisons that a user's code makes, and places on the side of them that was not seen.

Code that compares numbers has branches. A branch that no place reaches is looked for: the numbers
that were compared are known with their derivatives, so that the state at which they change places
is solved for. What lies out of all proportion, as q > 1e300, is named and not visited.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import partial

from verify.integrators.measures.probes import DualProbe
from verify.integrators.places.trial_places import SIDE, TrialPlace
from verify.integrators.tracing.dual import Comparison
from verify.integrators.user_code.step import unless_it_fails

Line = tuple[str, int, int]  # file, line, instruction
_BEYOND = 1.25  # times the way to where the sides meet
_TRIES, _MOST_LINES = 6, 12
_ITERATED = 4  # comparisons of one line in one call are those of a loop


@dataclass(frozen=True)
class Branch:
    """One comparison of a call at a place, which took one side: `sign`. `slopes`: of the gap."""

    line: Line
    sign: int
    gap: float
    slopes: tuple[float, ...]
    limit: float | None
    place: TrialPlace
    h: Fraction


class Sides:
    """The comparisons that were made at each place. `far_conditions`: sides that are
    named and not visited, as conditions."""

    def __init__(self, names: Sequence[str]) -> None:
        self.names = names
        self.signs_at: dict[TrialPlace, dict[Line, int]] = {}
        self.branches: dict[Line, list[Branch]] = {}
        self.far_conditions: dict[str, None] = {}

    def note(self, place: TrialPlace, h: Fraction, comparisons: Sequence[Comparison]) -> None:
        """Record the comparisons of a call that belong to no loop."""
        by_line: dict[Line, list[Comparison]] = {}
        for comparison in comparisons:
            by_line.setdefault(comparison.line, []).append(comparison)
        signs = self.signs_at.setdefault(place, {})
        for line, several in by_line.items():
            # A line that compares many times in one call, or with both signs, belongs to a loop,
            # whose end is no branch of the map.
            if len({x.sign for x in several}) == 1 and len(several) < _ITERATED:
                signs[line] = several[0].sign
                branches = self.branches.setdefault(line, [])
                if len(branches) < 50:
                    branches += [_branch(x, place, h) for x in several[:2]]

    def unseen(self) -> Iterator[tuple[Line, list[Branch]]]:
        """Yield the lines of which one side was seen alone, with their branches, the nearest
        first."""
        for line, branches in list(self.branches.items())[:_MOST_LINES]:
            if len({x.sign for x in branches}) == 1 and branches[0].sign:
                yield line, sorted(branches, key=_distance)[:3]

    def separating(
        self, places: Sequence[TrialPlace], other_places: Sequence[TrialPlace]
    ) -> Branch | None:
        """Find a comparison that has one sign at all of the first places, and another at the
        second."""
        for line, branches in self.branches.items():
            first = {self.signs_at.get(x, {}).get(line, 0) for x in places}
            second = {self.signs_at.get(x, {}).get(line, 0) for x in other_places}
            if len(first) == len(second) == 1 and first != second and 0 not in first | second:
                return next(x for x in branches if x.sign in first)
        return None

    def condition(self, branch: Branch) -> str:
        """Return the side of a branch as a condition: q ≤ 50, or the line of code that compares."""
        moving = [k for k, x in enumerate(branch.slopes) if x]
        if len(moving) == 1 and branch.limit is not None:
            slope = branch.slopes[moving[0]]
            coordinate = float(branch.place.z[moving[0]])
            bound = coordinate - branch.gap / slope
            if abs(slope) == 1:
                sign = "≥" if branch.sign * slope > 0 else "≤"
                return f"{self.names[moving[0]]} {sign} `{bound:.6g}`"
        name, line, _ = branch.line
        side = "this" if branch in self.branches.get(branch.line, ()) else "the other"
        return f"{side} side of the comparison in line {line} of {name}"


def _branch(x: Comparison, place: TrialPlace, h: Fraction) -> Branch:
    slopes = tuple(map(float, x.gap.slopes)) or (0.0,) * len(place.z)
    limit = None if x.limit is None else float(x.limit)
    return Branch(x.line, x.sign, float(x.gap.value), slopes, limit, place, h)


def _distance(branch: Branch) -> float:
    """Return the distance to the other side, in units of the place, by the gap's derivatives."""
    norm = (
        sum((s * float(u)) ** 2 for s, u in zip(branch.slopes, branch.place.units, strict=True))
        ** 0.5
    )
    return abs(branch.gap) / norm if norm else float("inf")


def other_sides(probe: DualProbe, sides: Sides, farthest: Mapping[str, float]) -> list[TrialPlace]:
    """Find a place on each side that was not seen, where one can be solved for.

    `farthest`: of each coordinate, up to where it is followed.
    """
    places = []
    for line, branches in list(sides.unseen()):
        for branch in branches:
            place = _solve_for_other_side(probe, sides, branch, line, farthest)
            if place is not None:
                places.append(place)
                break
    return places


def _solve_for_other_side(
    probe: DualProbe, sides: Sides, branch: Branch, line: Line, farthest: Mapping[str, float]
) -> TrialPlace | None:
    """Solve for a place on the other side by Newton's method along the gap's gradient, in units of
    the place."""
    current = branch
    for _ in range(_TRIES):
        units = [float(u) for u in current.place.units]
        norm = sum((s * u) ** 2 for s, u in zip(current.slopes, units, strict=True))
        if norm == 0 or norm != norm:
            return None
        # Newton's step in units of the place: the state moves along u² s, s the gap's gradient, by
        # gap/Σ (s u)², and a little farther, so that it ends on the other side.
        share = _BEYOND * current.gap / norm
        new_state = [
            float(x) - share * s * u * u
            for x, s, u in zip(current.place.z, current.slopes, units, strict=True)
        ]
        if not all(abs(x) < farthest[name] for name, x in zip(sides.names, new_state, strict=True)):
            opposite = replace(branch, sign=-branch.sign)
            sides.far_conditions[sides.condition(opposite)] = None
            return None
        z = tuple(
            Fraction(x).limit_denominator(10**6) if abs(x) > 1e-3 else Fraction(x)
            for x in new_state
        )
        place = replace(current.place, z=z, source=SIDE)
        if unless_it_fails(partial(probe.reading, place, current.h)) is None:
            return None
        at_line = [x for x in probe.comparisons if x.line == line]
        if not at_line:
            return place  # the line is not reached: it is another side all the same
        if at_line[0].sign != branch.sign:
            return place
        current = _branch(at_line[0], place, current.h)
    return None
