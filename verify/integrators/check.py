"""Whether a user's step is a scheme for H, and whether a step or a map keeps Ω: proved, else
measured.

One way leads to every answer: the layout of the function, the places that fit its Hamiltonian or
the map, a trace and a proof where its code lets symbols through, else readings at the places.

Which layout a user's function takes its state in: tried, and held against the exact flow.

Where names do not tell p from q, or h from t, the order that fits H is taken, and said. A function
that takes its state in no layout is no step: that is an error of the call, and nothing is refuted.
"""

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction

from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.claims import counterexample, of_reading, with_claims
from verify.integrators.examination import examine
from verify.integrators.measured import finding_of
from verify.integrators.measures.other_forms import digits_noted, masses_noted, masses_of
from verify.integrators.measures.survey import (
    NOWHERE,
    Request,
    check_request,
    places_of_field,
    places_of_map,
    shortened,
    unit_of_map,
)
from verify.integrators.places.place import USER, Place
from verify.integrators.places.units import Field
from verify.integrators.results import NOTHING, Claims, Finding
from verify.integrators.trial import Trial
from verify.integrators.user_code.faults import Fault, changed_since, examined
from verify.integrators.user_code.layout import Layout
from verify.integrators.user_code.loading import Callee
from verify.integrators.user_code.repeated import repeated
from verify.integrators.user_code.step import StepError, last_line, unless_it_fails
from verify.integrators.user_code.user_map import UserMap
from verify.prose import prose
from verify.verdict import Verdict

_PART = 64  # of the largest step size
_FITS = 0.2  # of the way that the flow goes
_BETTER = 10  # times as near, another layout has to be


def settle_layout(callee: Callee, places: Sequence[Place], field: Field | None) -> list[str]:
    """Sets the layout, and returns notes on how the arguments are understood.

    Raises InputError where no call returns a state.
    """
    step, lost = callee.step, list[Exception]()
    misfits = dict[Layout, float]()
    for layout in callee.layouts:
        step.layout = layout
        for place in places[:3]:
            try:
                misfits[layout] = _misfit(step, place, field)
                break
            except Exception as error:  # the user's code may raise anything
                lost.append(error)
            if step.left <= 0:
                break
        if misfits and field is None:
            break
    if not misfits:
        step.layout = callee.layouts[0]
        raise no_state(step, lost[0], places[0])
    first, best = next(iter(misfits)), min(misfits, key=lambda layout: misfits[layout])
    fits = misfits[best] < _FITS and misfits[best] * _BETTER < misfits[first]
    step.layout = best if fits else first
    return _understood(callee, step, misfits[step.layout])


def _understood(callee: Callee, step: UserMap, misfit: float) -> list[str]:
    usual = ("p", "q", "h"), ("p", "q", "t", "h"), ("p", "q"), ("z",)
    layout = step.layout
    if step.foreign or (layout.roles in usual and callee.named):
        return []
    names = ", ".join(callee.arguments)
    why = "" if callee.named or misfit == 0 else ", the order that fits"
    if not callee.named and misfit >= _FITS:
        why = ", as no order of them fits"
    if layout.roles in usual and not why:
        return []
    return [f"its arguments ({names}) are taken as ({layout}){why}"]


def _misfit(step: UserMap, place: Place, field: Field | None) -> float:
    """How far a small step ends from where the field leads, in parts of that way."""
    h = float(place.step) / _PART
    z, t = [float(x) for x in place.z], float(place.t)
    end = step.at(z, h, t)
    if field is None:
        return 0.0
    slopes = field(z, t)
    if slopes is None:
        return 1.0
    units = [float(u) for u in place.units]
    middle = field([x + h / 2 * f for x, f in zip(z, slopes, strict=True)], t + h / 2) or slopes
    way = max(abs(h * f) / u for f, u in zip(middle, units, strict=True))
    gap = max(abs(y - x - h * f) / u for x, y, f, u in zip(z, end, middle, units, strict=True))
    return gap / way if way else gap


def no_state(step: UserMap, error: Exception, place: Place) -> InputError:
    """The error of a call that returns no state at any place: it says what came and what to do."""
    kind = "integrator" if step.stepped else "map"
    name = getattr(step.function, "__name__", None) or getattr(
        getattr(step.function, "program", None), "called", "the program"
    )
    if isinstance(error, StepError):
        return InputError(kind, name, str(error.said))
    said = f"raises {last_line(error)}{step.place(place.z, place.step / 8)}"
    n = step.degrees
    if n > 1:
        said += f"; it was given p and q as arrays of {n} numbers, and in other shapes"
    return InputError(kind, name, said)


UNDEFINED = "H has no exact solution from any of the places that are tried"


def check_integrator(
    callee: Callee, hamiltonian: Hamiltonian, claims: Claims = NOTHING, request: Request = NOWHERE
) -> Finding:
    """Runs the user's code: a step for H, held to what is claimed of it.

    Raises InputError where a parameter of H has no value, H has no motion where the user asks, or
    no call returns a state.
    """
    if hamiltonian.symbols:
        raise InputError("parameter", hamiltonian.symbols[0], "has no value; a step needs one")
    step, field = callee.step, Field(hamiltonian)
    check_request(step.names, request)
    step.moving = hamiltonian.time_dependent
    places = places_of_field(field, step.moving, request)
    if request.z is not None and not any(x.source == USER for x in places):
        raise InputError("--q, --p", _shown(step, request.z), "H has no motion there")
    if not places:
        return Finding(Verdict.UNDECIDED, prose(UNDEFINED), "calls", hamiltonian.degrees)
    notes = settle_layout(callee, places, field)
    if request.step_size is None:
        places = shortened(step, places)
    finding = _checked(Trial(step, hamiltonian, places, claims, request))
    return finding.noting(*notes, *_of_time(step))


def check_map(callee: Callee, request: Request = NOWHERE) -> Finding:
    """Runs the user's code: a map without an H, and whether it is symplectic.

    Raises InputError where no call returns a state.
    """
    step = callee.step
    check_request(step.names, request)
    notes = settle_layout(callee, places_of_map(step.names, Fraction(1), request), None)
    places = places_of_map(step.names, unit_of_map(step), request)
    claims = Claims(symplectic=True)
    return _checked(Trial(step, None, places, claims, request)).noting(*notes)


def _shown(step: UserMap, z: Sequence[Fraction]) -> str:
    return ", ".join(f"{name} = {x}" for name, x in zip(step.names, z, strict=True))


def _checked(trial: Trial) -> Finding:
    step = trial.step
    faults, first = examined(step, trial.places)
    if not any(fault.fatal for fault in faults):
        faults += repeated(step, trial.places)
    if any(fault.fatal for fault in faults):
        return _no_step(trial, faults)
    provable = all(fault.allows is Verdict.PROVED for fault in faults)
    finding = examine(trial, provable)
    later = changed_since(step, first)
    if later:
        return _no_step(trial, [*faults, *later])
    finding = replace(finding, faults=tuple(fault.name for fault in faults))
    finding = _but_for(faults, finding.noting(*(fault.text for fault in faults)))
    finding = finding.noting(*_otherwise(finding, trial))
    if trial.hamiltonian is None:
        return _of_map(finding, trial)
    finding = with_claims(finding, trial)
    return finding.noting(*_elsewhere(finding, trial.request))


def _elsewhere(finding: Finding, request: Request) -> list[str]:
    """What is said where a verdict rests on another place than the user's."""
    example = finding.counterexample
    if request.z is None or example is None or tuple(example.z.values()) == request.z:
        return []
    return ["it is shown at another place than the one that you gave"]


def _otherwise(finding: Finding, trial: Trial) -> list[str]:
    """What a map that is refuted may be all the same."""
    step = trial.step
    if trial.hamiltonian is None:
        measured = trial.evidence if finding.symplectic is False else None
        readings = measured[0].readings if measured else ()
        return [*digits_noted(readings), *masses_noted(readings, step.names)] if readings else []
    masses = masses_of(trial.hamiltonian)
    if finding.verdict is not Verdict.REFUTED or not masses or step.masses or step.left <= 0:
        return []
    other = replace(trial, step=replace(step, masses=masses), claims=NOTHING)
    seen = unless_it_fails(lambda: finding_of(other, *other.measure(step.ways[0])))
    if seen is None or not seen.scheme:
        return []
    kept = " and symplectic" if seen.symplectic else ""
    shown = ", ".join(map(str, masses))
    return [f"in momenta p = m·v, m = ({shown}), it is of order {seen.convergence_order}{kept}"]


def _of_map(finding: Finding, trial: Trial) -> Finding:
    """A map is asked whether it is symplectic, by whoever gives it."""
    if finding.symplectic is not False:
        return finding
    claim, seen = "that it is symplectic", finding.against
    example = of_reading(trial.step, seen, claim) if seen else counterexample(claim, trial)
    return replace(finding, counterexample=example)


def _but_for(faults: Sequence[Fault], finding: Finding) -> Finding:
    """UNDECIDED where a fault lets no more stand; what is refuted stays so."""
    in_the_way = [fault for fault in faults if fault.allows is Verdict.UNDECIDED]
    if not in_the_way or finding.verdict is Verdict.REFUTED:
        return finding
    reason = prose(in_the_way[0].text, " (", finding.reason, ")")
    return replace(finding, verdict=Verdict.UNDECIDED, reason=reason, order_decided=False,
                   symplectic=finding.symplectic and None,
                   area_preserving=finding.area_preserving and None)  # fmt: skip


def _of_time(step: UserMap) -> list[str]:
    """What is said where H or the step does not depend on time."""
    if step.timed and not step.moving:
        return ["H does not depend on time: it is called with t = 0"]
    if step.moving and not step.timed:
        return ["it takes no t, and H depends on it: its force stands still"]
    return [] if step.timed else ["it takes no t: it is judged for a force without time alone"]


def _no_step(trial: Trial, faults: Sequence[Fault]) -> Finding:
    """What is no scheme, or no map, by a fault that ends it."""
    fault = next(fault for fault in faults if fault.fatal)
    names = tuple(each.name for each in faults)
    return Finding(fault.allows if fault.allows is not Verdict.PROVED else Verdict.UNDECIDED,
                   prose(fault.text), "calls", trial.step.degrees, faults=names)  # fmt: skip
