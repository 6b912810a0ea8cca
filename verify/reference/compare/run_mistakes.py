"""Mistakes that somebody's run may contain: each changes the right setting into another.

Adding a mistake is adding a line. In n degrees of freedom fewer are tried, as runs take longer.
Mistakes in a column other than the state are in `verify.reference.compare.setting`.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import chain, combinations
from math import isfinite
from typing import Any

from verify import schemes
from verify.algebra.expressions.formula_text import to_text
from verify.arithmetic.exact import short
from verify.arithmetic.systems.float64 import nearest_double
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.reference.compare.setting import Setting
from verify.reference.compare.table_agreement import nearest_single
from verify.runs.run_start import Start
from verify.schemes.conditions.splitting_conditions import Part, Splitting
from verify.structures import AREA, SYMPLECTIC, CanonicalForm

_MAX_SUBSET_INPUTS = 4  # all subsets are tried of at most so many inexact inputs
_SCHEME_PREFIX = "scheme "  # of names of mistakes
_OTHER_SCHEME_TEXT = "your scheme is "
_OTHER_EULER = "symplectic Euler of the other kind"
_CLOCKS = {
    "frozen": "your force is read at the step's beginning, in every stage",
    "at the end": "your force is read at the step's end, in every stage",
    "exchanged": "your kicks and drifts read each other's clock",
}
# q, p and h that no symmetry of H is expected to distinguish.
_TEST_POINT = Fraction(1, 3), Fraction(2, 7), Fraction(1, 5)
_TEST_DIGITS = 40
_LEAPFROG_PARTS = 3  # a/2; b; a/2


@dataclass(frozen=True)
class Mistake:
    """A mistake; `says` describes it to the author of the numbers."""

    name: str
    says: str
    setting: Setting


Change = tuple[str, str, dict[str, Any]]  # a mistake's name, what it says, and what it changes
Changes = Callable[[Setting], Iterable[Change]]  # the argument is the right setting


def input_mistakes(right_setting: Setting) -> Iterator[Mistake]:
    """Yield mistakes of inputs rounded to doubles; programs that use doubles make them all."""
    return _mistakes(
        right_setting, _OF_INPUTS[right_setting.orbit.hamiltonian.structure](right_setting)
    )


def state_mistakes(right_setting: Setting) -> Iterator[Mistake]:
    """Yield all mistakes that can be seen in doubles."""
    return _mistakes(
        right_setting, _OF_STATES[right_setting.orbit.hamiltonian.structure](right_setting)
    )


def _mistakes(right_setting: Setting, changes: Iterable[Change]) -> Iterator[Mistake]:
    for name, says, change in changes:
        yield Mistake(name, says, replace(right_setting, **change))


def _changes_in_plane(right_setting: Setting) -> Iterator[Change]:
    orbit = right_setting.orbit
    first = chain(_column_changes(orbit), _clock_changes(orbit), _scheme_changes(orbit))
    return chain(first, _staggered_starts(right_setting, orbit), _step_changes(orbit))


def _doubles_for_inputs(right_setting: Setting) -> Iterator[Change]:
    orbit = right_setting.orbit
    starts = {"q0": orbit.point["q"], "p0": orbit.point["p"]}
    exact = {"h": orbit.step_size, **starts, **dict(orbit.hamiltonian.values)}
    if orbit.hamiltonian.time_dependent:
        exact["t0"] = orbit.t0
    doubles = {n: nearest_double(x) for n, x in exact.items()}
    inexact = [n for n, x in doubles.items() if isfinite(x) and x != exact[n]]
    # A program may read some inputs exactly (0.5) and round others, or compute h as a quotient: all
    # combinations are tried while they are few.
    subsets = [c for k in range(1, len(inexact) + 1) for c in combinations(inexact, k)]
    ones = [(name,) for name in inexact]
    for names in subsets if len(inexact) <= _MAX_SUBSET_INPUTS else [tuple(inexact), *ones]:
        rounded = {n: Fraction(doubles[n]) for n in names}
        names_in_words = " and ".join(
            f"{n} is the double nearest to {short(exact[n])}" for n in names
        )
        says = f"your {names_in_words}, and not exactly that"
        yield f"double-{'-'.join(names)}", says, {"orbit": _with_numbers(orbit, rounded)}


def _changes_in_degrees(right_setting: Setting) -> Iterator[Change]:
    """Yield changes in n degrees of freedom.

    Other schemes are those that the reference data have, which need not be run.
    """
    degrees = range(1, right_setting.orbit.hamiltonian.degrees + 1)
    pairs = tuple((f"p{k}", f"q{k}") for k in degrees)
    yield "swapped", "your columns of p and q are in each other's place", {"swaps": pairs}
    for i, j in combinations(degrees, 2):
        says = f"your degrees of freedom {i} and {j} are in each other's place"
        yield f"degrees-{i}-{j}", says, {"swaps": tuple((f"{x}{i}", f"{x}{j}") for x in "pq")}
    yield "sign-of-p", "your p has the other sign", {"negates_p": True}
    for delay, when in ((1, "later"), (-1, "earlier")):
        yield f"late{delay:+d}", f"your rows are those of one step {when}", {"delay": delay}
    for other in right_setting.points.of_other_schemes(right_setting.orbit):
        says = f"your numbers are those of {other.scheme}, and not of {right_setting.orbit.scheme}"
        yield f"scheme-{other.scheme}", says, {"orbit": other}


_OF_INPUTS: Mapping[CanonicalForm, Changes] = {AREA: _doubles_for_inputs, SYMPLECTIC: lambda _: ()}
_OF_STATES = {AREA: _changes_in_plane, SYMPLECTIC: _changes_in_degrees}


def _column_changes(orbit: Start) -> Iterator[Change]:
    p, q, swap = orbit.point["p"], orbit.point["q"], (("p", "q"),)
    swapped_start = _with_numbers(orbit, {"p0": q, "q0": p})
    reversed_start = _with_numbers(orbit, {"p0": -p})
    energy = Hamiltonian(-orbit.hamiltonian.expression, orbit.hamiltonian.values)
    backwards = replace(orbit, hamiltonian=energy)
    yield "swapped-columns", "your columns p and q are swapped", {"swaps": swap}
    yield "swapped-start", "your initial p and q are swapped", {"orbit": swapped_start}
    says = "p and q are swapped, in your columns and at the start"
    yield "swapped-throughout", says, {"orbit": swapped_start, "swaps": swap}
    yield "negated-p", "your p has the other sign", {"negates_p": True}
    yield "negated-start", "your initial p has the other sign", {"orbit": reversed_start}
    says = "your time runs backwards: p' = +∂H/∂q, q' = −∂H/∂p"
    yield "backwards", says, {"orbit": backwards}
    yield "late+1", "your step index is too low by one", {"delay": 1}
    yield "late-1", "your step index is too high by one", {"delay": -1}


def _clock_changes(orbit: Start) -> Iterator[Change]:
    if not orbit.hamiltonian.time_dependent:
        return
    for clock, says in _CLOCKS.items():
        name = f"{orbit.scheme}, clock {clock}"
        with suppress(InputError):  # the scheme has no variant with such a clock
            wrong = replace(orbit, scheme=schemes.get(name).name)
            yield f"{_SCHEME_PREFIX}{name}", says, {"orbit": wrong}
    t0, h = orbit.t0, orbit.step_size
    zero = f"your time begins at 0, and not at {short(t0)}"
    begins = [("zero-t0", zero, Fraction(0))] if t0 else []
    begins += [("clock+1", "your clock is a step ahead", t0 + h),
               ("clock-1", "your clock is a step behind", t0 - h)]  # fmt: skip
    for name, says, begin in begins:
        yield name, says, {"orbit": replace(orbit, t0=begin)}


def _step_changes(orbit: Start) -> Iterator[Change]:
    h, values = orbit.step_size, orbit.hamiltonian.values
    changes = [
        ("half-step", "your h is half what it should be", {"h": h / 2}),
        ("double-step", "your h is twice what it should be", {"h": 2 * h}),
    ]
    single = nearest_single(h)
    if single and Fraction(float(single)) != h:
        says = "your h is the single-precision number nearest to it"
        changes.append(("single-h", says, {"h": Fraction(float(single))}))
    for name, value in values:
        for change_name, other in (("minus", -value), ("no", Fraction(0))):
            if other != value:
                changes.append(
                    (f"{change_name}-{name}", f"your {name} is {short(other)}", {name: other})
                )
    for name, says, change in changes:
        yield name, says, {"orbit": _with_numbers(orbit, change)}


def _scheme_changes(orbit: Start) -> Iterator[Change]:
    """Yield the scheme's relatives by name, then all other schemes."""
    description_by_name = dict(_relatives(orbit.scheme))
    names = sorted(schemes.names(), key=lambda x: x.startswith("implicit") - x.startswith("lie"))
    for name in names:
        description_by_name.setdefault(name, f"{_OTHER_SCHEME_TEXT}{name}")
    description_by_name.pop(orbit.scheme, None)
    for name, says in description_by_name.items():
        yield f"{_SCHEME_PREFIX}{name}", says, {"orbit": replace(orbit, scheme=name)}


def _staggered_starts(right_setting: Setting, orbit: Start) -> Iterator[Change]:
    """Yield the staggered variants of a splitting a/2; b; a/2: p between its q's, or q between p's.

    They are the splitting b; a from a start after half an a, or a; b from a start before it.
    """
    generic = schemes.get(orbit.scheme).every_h
    parts = generic.parts if isinstance(generic, Splitting) else ()
    if len(parts) != _LEAPFROG_PARTS or parts[0] != parts[-1]:
        return
    (first, half), (second, full), _ = parts
    name = "p" if first == "kick" else "q"
    # Two half parts of adjacent steps make one full part.
    parts_of_step = ((first, 2 * half), (second, full))
    for sign, order, when in ((1, parts_of_step[::-1], "ahead"), (-1, parts_of_step, "behind")):
        start = _start_after_half_part(right_setting, name, _name_of_parts(parts_of_step), sign)
        if start is not None:
            other = _with_numbers(replace(orbit, scheme=_name_of_parts(order)), {f"{name}0": start})
            says = f"your {name} is half a step {when}: leapfrog"
            yield f"half-{name}-{when}", says, {"orbit": other}


def _start_after_half_part(
    right_setting: Setting, name: str, scheme: str, sign: int
) -> Fraction | None:
    """Return the initial `name` after half of the scheme's first part, which changes it alone."""
    start = right_setting.orbit.point[name]
    after = replace(right_setting, orbit=replace(right_setting.orbit, scheme=scheme)).numbers(
        1, _TEST_DIGITS
    )
    return start + sign * (after[name][0] - start) / 2 if name in after else None


def without_synonyms(mistakes: list[Mistake]) -> list[Mistake]:
    """Return the mistakes without those whose scheme is, for this H, that of an earlier one."""
    first_by_state: dict[object, Mistake] = {}
    for mistake in mistakes:
        setting, (q, p, h) = mistake.setting, _TEST_POINT
        state = None
        if mistake.name.startswith(_SCHEME_PREFIX):
            # Two schemes are taken for one if a step from a point like no other gives the same
            # 40 digits.
            elsewhere = _with_numbers(setting.orbit, {"q0": q, "p0": p, "h": h})
            bounded = replace(setting, orbit=elsewhere).numbers(1, _TEST_DIGITS)
            state = (bounded["p"][0], bounded["q"][0]) if "p" in bounded else None
        first = first_by_state.setdefault(state or mistake.name, mistake)
        if first is not mistake and first.says.startswith(_OTHER_SCHEME_TEXT):
            synonym = mistake.name.removeprefix(_SCHEME_PREFIX)
            first_by_state[state] = replace(
                first, says=f"{first.says}, which {synonym} is for this H, too"
            )
    return list(first_by_state.values())


def _relatives(name: str) -> Iterator[tuple[str, str]]:
    if name.startswith("lie"):
        eta = int(name[3:])
        for other in (eta - 1, eta + 1):
            if other > 0:
                yield f"lie{other}", f"your η is {other}, and not {eta}"
    generic = schemes.get(name).every_h
    if isinstance(generic, Splitting):
        parts = generic.parts
        kinds = {"kick": "drift", "drift": "kick"}
        changes = {
            "its parts in the opposite order": parts[::-1],
            "kicks for drifts and drifts for kicks": tuple((kinds[k], x) for k, x in parts),
        }
        for says, parts_of_relative in changes.items():
            if parts_of_relative != parts:
                description = _OTHER_EULER if name == "symplectic-euler" else f"{name} with {says}"
                yield _name_of_parts(parts_of_relative), f"{_OTHER_SCHEME_TEXT}{description}"


def _name_of_parts(parts: tuple[Part, ...]) -> str:
    """Return the name of the scheme of these parts; the parts themselves if it has none."""
    for name in schemes.names():
        generic = schemes.get(name).every_h
        if isinstance(generic, Splitting) and generic.parts == parts:
            return name
    return "; ".join(f"{kind} {to_text(size)}" for kind, size in parts)


def _with_numbers(orbit: Start, changes: dict[str, Fraction]) -> Start:
    """Return the orbit with other numbers: h, q0, p0, t0 and parameters by their names."""
    values = {"h": orbit.step_size, "t0": orbit.t0} | {f"{n}0": x for n, x in orbit.point.items()}
    numbers = values | changes
    parameters = {name: x for name, x in changes.items() if name not in values}
    hamiltonian = orbit.hamiltonian.with_values(dict(orbit.hamiltonian.values) | parameters)
    point = {name: numbers[f"{name}0"] for name in orbit.point}
    return Start(hamiltonian, orbit.scheme, numbers["h"], point, numbers["t0"])
