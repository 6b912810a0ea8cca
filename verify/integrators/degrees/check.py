"""Whether a step of arrays is a scheme for H, and symplectic: proved, else measured at points.

Where its code lets no symbols through S is measured for some step sizes, and the order by the
distance from the exact flow, as the step size falls.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from fractions import Fraction

from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.degrees.called import StepAt, StepOfArrays
from verify.integrators.degrees.distance import distance_of
from verify.integrators.degrees.no_step import judged_without_call
from verify.integrators.degrees.results import StepFinding, held_to
from verify.integrators.degrees.traced import traced_map
from verify.integrators.maps.check import (
    Called,
    MapFinding,
    called_at,
    measured,
    must_agree,
    points_of,
)
from verify.integrators.maps.probes import DualProbe, FloatProbe
from verify.integrators.probe import LADDERS
from verify.integrators.results import Claims
from verify.integrators.step import Step, StepError, why, within
from verify.integrators.tracing.domain import domain_of
from verify.integrators.tracing.readings_of_floats import readings
from verify.integrators.tracing.rounded_order import Compared, agreement
from verify.integrators.wrapped import periods_told
from verify.proof.symplectic.defect import series_of
from verify.proof.symplectic.order import Claimed, prove_map
from verify.prose import Prose, prose, read_prose
from verify.schemes.degrees.canonical_map import CanonicalMap
from verify.verdict import Verdict

_SECONDS = 40.0  # for a proof
_SIZES = (Fraction(1, 8), Fraction(1, 64))
_TIME = Fraction(1, 4)
Points = Sequence[tuple[Fraction, ...]]
_MOST = 8  # orders that are looked at but for rounding


def check_step(step: Step, hamiltonian: Hamiltonian, claims: Claims) -> StepFinding:
    """Runs the user's code. Raises InputError where a parameter of H has no value."""
    if hamiltonian.symbols:
        raise InputError("parameter", hamiltonian.symbols[0], "has no value; a step needs one")

    def examined(own: StepOfArrays, points: Points, called: Called) -> StepFinding:
        try:
            if step.foreign:
                raise StepError("it is of another language")
            with within(_SECONDS, "its proof takes too long"):
                found = _proved(own, hamiltonian, called)
        except Exception as error:  # the user's code may raise anything
            found = _measured(own, hamiltonian, points, called).noting("no proof: ", why(error))
        return held_to(claims, found)

    return _tried(step, hamiltonian, examined, judged_without_call)


def measure_step(
    step: Step, hamiltonian: Hamiltonian, ladder: Sequence[Fraction] = ()
) -> StepFinding:
    """With floats alone, as a step needs of which nothing but its numbers is known. `ladder`: the
    step sizes for the order, falling; else the usual."""
    return _tried(
        step,
        hamiltonian,
        lambda own, points, called: _measured(own, hamiltonian, points, called, ladder),
        # How a library is driven says nothing of its method.
        lambda here, hamiltonian, points, error: (Verdict.UNDECIDED, prose(why(error))),
    )


def _tried(
    step: Step,
    hamiltonian: Hamiltonian,
    examined: Callable[[StepOfArrays, Points, Called], StepFinding],
    failed: Callable[[StepAt, Hamiltonian, Points, Exception], tuple[Verdict, Prose]],
) -> StepFinding:
    """What is found of it where it can be called at the points, and what is said where not."""
    step.moving = hamiltonian.time_dependent
    own, degrees = StepOfArrays(step, hamiltonian.coordinates), hamiltonian.degrees
    at, points = own.at(_SIZES[0], _TIME), points_of(2 * degrees)
    try:
        called = called_at(FloatProbe(at), points)
    except Exception as error:  # the user's code may raise anything
        return StepFinding(*failed(at, hamiltonian, points, error), "calls", degrees)
    return examined(own, points, called)


# -- proved ---------------------------------------------------------------------------------------


def _proved(own: StepOfArrays, hamiltonian: Hamiltonian, called: Called) -> StepFinding:
    tape, made = traced_map(own, hamiltonian)
    must_agree(DualProbe(own.at(_SIZES[0], _TIME)), called)
    proof = prove_map(made, Claimed())
    found = StepFinding(
        proof.verdict,
        proof.reason,
        "proof",
        hamiltonian.degrees,
        proof=proof,
        symplectic=proof.symplectic,
        area_preserving=proof.area_preserving,
        convergence_order=proof.convergence_order,
        order_known=True,
        domain=proof.domain & domain_of(tape),
        notes=(prose("traced with symbols"), *readings(tape)),
    )
    return _but_for_rounding(found, own, made) if tape.rounded else found


def _but_for_rounding(found: StepFinding, own: StepOfArrays, made: CanonicalMap) -> StepFinding:
    """Where coefficients are rounded: the order, with residues of their size taken for 0, and S at
    points, of which such rounding is allowed."""
    order = _rounded_order(made)
    points = points_of(len(own.names))
    here = own.at(_SIZES[0], _TIME)
    seen = measured(here, DualProbe(here), points)
    exact = found.convergence_order
    same = seen.symplectic == found.symplectic and (exact is None or order == exact)
    if same:
        return found
    told = (
        f"but for the rounding of its coefficients it agrees with the exact flow up to `h^{order}`"
    )
    verdict = seen.verdict if order >= 1 else Verdict.REFUTED
    return replace(
        found,
        verdict=verdict,
        reason=prose(read_prose(told), "; ", seen.reason),
        how="duals",
        proof=None,
        symplectic=seen.symplectic,
        area_preserving=seen.area_preserving,
        convergence_order=order,
        measured=seen,
        h=here.h,
    )


def _rounded_order(made: CanonicalMap) -> int:
    """Up to which power of h the map agrees with the flow, but for residues of rounding."""
    series = series_of(made, 3)

    def compared(n: int) -> Iterator[Compared]:
        own, flow = series.coefficient(n), series.flow
        for x, y in zip(own, flow.term(n), strict=True):
            yield x, y, flow.ring.reduce(x - y)

    order = agreement(map(compared, range(_MOST + 1))).order
    return _MOST if order is None else order


# -- measured -------------------------------------------------------------------------------------


def _measured(
    own: StepOfArrays,
    hamiltonian: Hamiltonian,
    points: Points,
    called: Called,
    ladder: Sequence[Fraction] = (),
) -> StepFinding:
    """S at the points for some step sizes, and the order."""
    notes, degrees = list[Prose](), len(own.names) // 2
    for how in own.step.ways:
        try:
            if how == "duals":
                must_agree(DualProbe(own.at(_SIZES[0], _TIME)), called)
            each = [(h, _at(own, h, how, points)) for h in _SIZES]
        except Exception as error:  # the user's code may raise anything
            notes.append(prose(f"not measured with {how}: ", why(error)))
            continue
        h, worst = next((x for x in each if x[1].symplectic is not True), each[0])
        found = StepFinding(
            worst.verdict,
            prose(read_prose(f"with h = `{h}`, "), worst.reason),
            how,
            degrees,
            symplectic=worst.symplectic,
            area_preserving=worst.area_preserving,
            measured=worst,
            h=h,
            notes=(*notes, *worst.notes),
        )
        return _with_order(found, own, hamiltonian, how, points, ladder)
    neither = prose("it can be neither traced nor measured")
    return StepFinding(Verdict.UNDECIDED, neither, "calls", degrees, notes=tuple(notes))


def _with_order(
    found: StepFinding,
    own: StepOfArrays,
    hamiltonian: Hamiltonian,
    how: str,
    points: Points,
    ladder: Sequence[Fraction] = (),
) -> StepFinding:
    """The same with the order that is seen; REFUTED where it is none of a scheme for this H."""
    try:
        with within(_SECONDS, "its order takes too long to be measured"):
            seen = distance_of(own, hamiltonian, how, points, _TIME, ladder or LADDERS[how])
    except Exception as error:  # the user's code may raise anything
        return found.noting("its order is not measured: ", why(error))
    for note in reversed(periods_told(own.names, seen.periods)):
        found = found.noting(note)
    if seen.exact:
        reason = prose("the map is the exact flow to its last digits; ", found.reason)
        return replace(found, reason=reason, order_known=True)
    if seen.order is None:
        return found.noting("its error follows no power of h")
    first, last = Fraction(seen.fit.first), seen.fit.last
    said = f"the map's order is {seen.order}, as seen for h = {first} … `{last:.1e}`; "
    verdict = found.verdict
    if seen.order < 1:
        said, verdict = (
            "not a scheme for this H: its error after one step is of order h or 1; ",
            (Verdict.REFUTED),
        )
    reason = prose(read_prose(said), found.reason)
    known = replace(found, verdict=verdict, reason=reason)
    return replace(known, convergence_order=seen.order, order_known=True)


def _at(
    own: StepOfArrays, h: Fraction, how: str, points: Sequence[tuple[Fraction, ...]]
) -> MapFinding:
    here = own.at(h, _TIME)
    return measured(here, DualProbe(here) if how == "duals" else FloatProbe(here), points)
