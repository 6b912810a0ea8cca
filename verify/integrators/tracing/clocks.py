"""The mistake that the clock of a traced step looks like.

With t held still at a moment s of the step, H(p, q, s) is autonomous. A step that reads its force
at one moment is a scheme for that H of an order that it may not have for the motion in time.
"""

from collections.abc import Sequence
from fractions import Fraction

from verify.algebra.formula import symbol
from verify.algebra.ring import Ring
from verify.errors import InputError
from verify.hamiltonians.canonical_field import CanonicalField
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.tracing.number import UntraceableError
from verify.integrators.tracing.readings import NoReadingsError, Read, Readings
from verify.integrators.tracing.step_map import traced_map
from verify.integrators.tracing.trace import Node, in_order, write_expressions
from verify.proof.order import convergence_of, size_of
from verify.schemes.conditions.timed.mistakes import Reading, name_of
from verify.schemes.maps.by_formulas import map_from_expressions
from verify.schemes.steps.step_algebra import State

_MOST_WRITTEN = 3000  # operations of p' and q' as trees
MOMENTS = {"t": Fraction(0), "t + h": Fraction(1), "t + h/2": Fraction(1, 2)}  # as parts of h
_STILL = symbol("still")
_MOST_NODES = 2000
_SAME = Fraction(1, 2**40)  # two times whose parts are added in floats
_MOST_TOLD = 4
_ROUNDING = Fraction(1, 2**44)
_SIMPLE = 1000  # the largest denominator that is shown


def clock_mistakes(hamiltonian: Hamiltonian, roots: Sequence[Node], order: int | None) -> list[str]:
    """Return one sentence, where the step of these p' and q' has a higher order than `order` with
    the force held still, or with H read at other times."""
    if order is None or not hamiltonian.time_dependent or "still" in hamiltonian.parameters:
        return []
    p_next, q_next = roots
    still = _find_still_clock(hamiltonian, p_next, q_next, order)
    return still or misread(hamiltonian, p_next, q_next, order)


def _find_still_clock(
    hamiltonian: Hamiltonian, p_next: Node, q_next: Node, order: int
) -> list[str]:
    t, h = symbol("t"), symbol("h")
    # t + part·h becomes the constant `still`, a parameter of an autonomous H, for which the step is
    # then a scheme of an order of its own.
    still_hamiltonian = Hamiltonian(hamiltonian.exact.subs(t, _STILL))
    for words, part in MOMENTS.items():
        formulas = write_expressions((p_next, q_next), _MOST_WRITTEN, {"t": _STILL - part * h})
        if formulas is None:
            return []
        try:
            step = map_from_expressions(still_hamiltonian, formulas)
            reached = convergence_of(step).order
        except InputError:  # too long, or not smooth
            continue
        if reached is None or reached > order:
            return [stands_still("exact" if reached is None else f"of order {reached}", words)]
    return []


def stands_still(reached: str, words: str) -> str:
    """Describe a clock that stands still: `reached` is the order that the step then has, `words`
    the moment."""
    return (
        f"it is {reached} as if the force were read at {words} in every stage: its clock stands "
        "still"
    )


# -- readings at wrong times ----------------------------------------------------------------------


def misread(hamiltonian: Hamiltonian, p_next: Node, q_next: Node, order: int) -> list[str]:
    """Return one sentence, where the step is proved to have a higher order than `order` with each
    reading at the time when it is due."""
    if len(in_order(p_next, q_next)) > _MOST_NODES:
        return []
    try:
        readings = Readings(hamiltonian, p_next, q_next)
        reads = _alike(readings.reads)
        wrong = [read for read in reads if abs(read.time - read.due) >= _SAME]
        mended = _order(hamiltonian, *readings.with_due_times()) if wrong else order
    except (ArithmeticError, ValueError, NoReadingsError, UntraceableError, InputError):
        return []
    if mended is not None and mended <= order:
        return []
    reached = "exact" if mended is None else f"of order {mended}"
    pairs = list(dict.fromkeys((read.due, read.time) for read in wrong))
    moments = ", ".join(
        f"{moment(due)} in place of {moment(time)}" for due, time in pairs[:_MOST_TOLD]
    )
    more = ", …" * (len(pairs) > _MOST_TOLD)
    name = _name(reads)
    return [f"{name}: " * bool(name) + f"it is {reached} with H read at {moments}{more}"]


def _order(hamiltonian: Hamiltonian, p_next: Node, q_next: Node) -> int | None:
    """Return the order of that map but for the rounding of its coefficients; None where it is
    exact."""
    traced = traced_map(hamiltonian, (p_next, q_next))
    order = convergence_of(traced.step_map).order
    if order is None or traced.series is None:
        return order
    rounded = _rounded_order(*traced.series)
    return order if rounded is None else max(order, rounded)


def _rounded_order(field: CanonicalField, step: State) -> int | None:
    """Return the power of h up to which the map agrees with the flow, with residuals below 2⁻⁴⁴ of
    the coefficients taken for 0; None where it does in all that are looked at.

    Yoshida's 1.3512071919596578 is not 1/(2 − 2^(1/3)): taken by its exact value it gives a map of
    order 0, whose first Taylor coefficients miss those of the flow by 10⁻¹⁶. Such residuals are
    distinguished from errors by their size beside the coefficients that they belong to.
    """
    scale = Fraction(0)
    for n in range(step[0].most + 1):
        gap = Fraction(0)
        for series, y in zip(step, field.term(n), strict=True):
            x = series.coefficients[n]
            gap = max(gap, size_of(field.ring.reduce(x - y)))
            scale = max(scale, size_of(x), size_of(y))
        if gap > _ROUNDING * scale:
            return n - 1
    return None


def _alike(reads: Sequence[Read]) -> list[Read]:
    """Merge readings of the same times into one, at the place of the first."""
    sizes: dict[tuple[Fraction, Fraction, bool], Fraction] = {}
    for read in reads:
        key = read.time, read.due, read.of_p
        sizes[key] = sizes.get(key, Fraction(0)) + read.size
    return [Read(time, due, size, of_p) for (time, due, of_p), size in sizes.items()]


def _name(reads: Sequence[Read]) -> str | None:
    """Name the mistake in what is read for p', or for q', where it has a name."""
    ring = Ring((), 0)
    for of_p, what in ((True, "force"), (False, "velocity")):
        own_reads = [read for read in reads if read.of_p is of_p and read.size]
        sizes_before = [
            sum((x.size for x in own_reads[:k]), Fraction(0)) for k in range(len(own_reads))
        ]
        numbers = [
            [ring.constant(x) for x in column]
            for column in ([x.time for x in own_reads], [x.due for x in own_reads], sizes_before,
                           [x.size for x in own_reads])
        ]  # fmt: skip
        mistake = name_of(Reading(ring, what, "stage", *numbers), _SAME) if own_reads else None
        if mistake:
            return mistake
    return None


def moment(time: Fraction) -> str:
    """Format a time in parts of h after t.

    >>> [moment(Fraction(x)) for x in ("0", "1", "-1/2", "3/4", "0.3512071919596578")]
    ['t', 't + h', 't - h/2', 't + 3h/4', 't + 0.35120719h']
    """
    simple = time.limit_denominator(_SIMPLE)
    if simple == 0:
        return "t"
    sign, size = ("-", -simple) if time < 0 else ("+", simple)
    if abs(simple - time) >= _SAME:
        return f"t {sign} {abs(float(time)):.8g}h"
    many = "" if size.numerator == 1 else str(size.numerator)
    return f"t {sign} {many}h" + (f"/{size.denominator}" if size.denominator > 1 else "")
