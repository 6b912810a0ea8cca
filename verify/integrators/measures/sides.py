"""The comparisons of a user's code, and places on those sides of them that no place has reached.

Code that compares numbers has branches. The gap between two compared numbers is known with its
derivatives, so that a state at which it has the other sign can be solved for. A side that is out of
all proportion, as q > 1e300, is reported and not visited.
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
_OVERSHOOT = 1.25  # a Newton step is longer by this factor, so that it ends on the other side
_MAX_NEWTON_STEPS, _MAX_LINES = 6, 12
MIN_COMPARISONS_OF_LOOP = 4  # a line with as many comparisons in one call belongs to a loop
_MAX_BRANCHES_OF_LINE = 50


@dataclass(frozen=True)
class Branch:
    """One comparison of a call at a place.

    `sign`: that of the gap, the side that the call took; `slopes`: the derivatives of the gap by
    the coordinates. `limit`: the number with which a value was compared, if it was a constant.
    """

    line: Line
    sign: int
    gap: float
    slopes: tuple[float, ...]
    limit: float | None
    place: TrialPlace
    h: Fraction


class Sides:
    """The comparisons that were made at each place.

    `far_conditions`: the conditions of sides that are reported and not visited.
    """

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
            if len({x.sign for x in several}) == 1 and len(several) < MIN_COMPARISONS_OF_LOOP:
                signs[line] = several[0].sign
                branches = self.branches.setdefault(line, [])
                if len(branches) < _MAX_BRANCHES_OF_LINE:
                    branches += [_branch(x, place, h) for x in several[:2]]

    def unseen(self) -> Iterator[tuple[Line, list[Branch]]]:
        """Yield the lines of which only one side was seen, each with its three nearest branches."""
        for line, branches in list(self.branches.items())[:_MAX_LINES]:
            if len({x.sign for x in branches}) == 1 and branches[0].sign:
                yield line, sorted(branches, key=_distance)[:3]

    def separating(
        self, places: Sequence[TrialPlace], other_places: Sequence[TrialPlace]
    ) -> Branch | None:
        """Return a comparison with one sign at all of `places`, and the other at all of
        `other_places`; None if there is none."""
        for line, branches in self.branches.items():
            signs = {self.signs_at.get(x, {}).get(line, 0) for x in places}
            others = {self.signs_at.get(x, {}).get(line, 0) for x in other_places}
            if len(signs) == len(others) == 1 and signs != others and 0 not in signs | others:
                return next(x for x in branches if x.sign in signs)
        return None

    def condition(self, branch: Branch) -> str:
        """Return the side of a branch as a condition: q ≤ 50, or the line of code that compares."""
        compared = [k for k, x in enumerate(branch.slopes) if x]
        if len(compared) == 1 and branch.limit is not None:
            slope = branch.slopes[compared[0]]
            coordinate = float(branch.place.z[compared[0]])
            bound = coordinate - branch.gap / slope
            # A slope of ±1 means that the coordinate itself is compared.
            if abs(slope) == 1:
                sign = "≥" if branch.sign * slope > 0 else "≤"
                return f"{self.names[compared[0]]} {sign} `{bound:.6g}`"
        name, line, _ = branch.line
        side = "this" if branch in self.branches.get(branch.line, ()) else "the other"
        return f"{side} side of the comparison in line {line} of {name}"


def _branch(x: Comparison, place: TrialPlace, h: Fraction) -> Branch:
    slopes = tuple(map(float, x.gap.slopes)) or (0.0,) * len(place.z)
    limit = None if x.limit is None else float(x.limit)
    return Branch(x.line, x.sign, float(x.gap.value), slopes, limit, place, h)


def _distance(branch: Branch) -> float:
    """Return the distance to the other side to first order, in units of the place."""
    norm = (
        sum((s * float(u)) ** 2 for s, u in zip(branch.slopes, branch.place.units, strict=True))
        ** 0.5
    )
    return abs(branch.gap) / norm if norm else float("inf")


def other_sides(probe: DualProbe, sides: Sides, farthest: Mapping[str, float]) -> list[TrialPlace]:
    """Return a place on each side that was not seen, if one can be solved for.

    `farthest`: the largest absolute value of each coordinate that is visited.
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
    """Return a place on the other side by Newton's method along the gradient of the gap; None if
    none is reached."""
    current = branch
    for _ in range(_MAX_NEWTON_STEPS):
        units = [float(u) for u in current.place.units]
        norm = sum((s * u) ** 2 for s, u in zip(current.slopes, units, strict=True))
        if norm == 0 or norm != norm:
            return None
        # Newton's step in units of the place: the state moves along u² s, s the gap's gradient, by
        # gap/Σ (s u)², and a little farther, so that it ends on the other side.
        share = _OVERSHOOT * current.gap / norm
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
        if unless_it_fails(partial(probe.jacobian, place, current.h)) is None:
            return None
        at_line = [x for x in probe.comparisons if x.line == line]
        if not at_line:
            return place  # the line is not reached, so that an earlier comparison took another side
        if at_line[0].sign != branch.sign:
            return place
        current = _branch(at_line[0], place, current.h)
    return None
