"""What precedes the examination of a user's step or map: its places, and the layout of its calls.

With a system, each layout is tried by a step that is compared with one explicit midpoint step along
its equations; the likeliest layout is kept unless another fits far better, and a note reports an
order that the arguments' names do not tell. Without one, the first layout is kept in which a call
returns a state. If no layout returns a state, the call is in error, and nothing is refuted.
"""

from collections.abc import Sequence
from fractions import Fraction

from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.measures.map_units import find_map_units
from verify.integrators.measures.survey import (
    Request,
    check_request,
    places_of_field,
    places_of_map,
    shorten_steps,
)
from verify.integrators.places.trial_places import USER, TrialPlace
from verify.integrators.places.units import FloatField
from verify.integrators.user_code.coordinate_layout import CoordinateLayout
from verify.integrators.user_code.layout import CallLayout
from verify.integrators.user_code.loading import Callee
from verify.integrators.user_code.step import StepError, last_line
from verify.integrators.user_code.user_map import UserMap

_STEP_DIVISOR = 64  # a layout is tried with the largest step size divided by this number
_LARGEST_MISFIT = 0.2  # a layout fits H if its step is off by less, relative to the distance moved
_TIMES_BETTER = 10  # the ratio of misfits at which another layout replaces the likeliest
_MAX_LAYOUT_PLACES = 3  # more than one, since a step may be undefined at a place


def prepare_step(
    callee: Callee, hamiltonian: Hamiltonian, request: Request
) -> tuple[list[TrialPlace], list[str]]:
    """Settle the layout of a step; return the places, none where there is no motion, and notes.

    Raises InputError as `check_step` does.
    """
    if hamiltonian.symbols:
        raise InputError("parameter", hamiltonian.symbols[0], "has no value; a step needs one")
    step, field = callee.step, FloatField(hamiltonian)
    check_request(step.names, request)
    step.time_dependent = hamiltonian.time_dependent
    places = places_of_field(field, step.time_dependent, request)
    if request.z is not None and not any(x.source == USER for x in places):
        raise InputError("--q, --p", _format_state(step, request.z), "H has no motion there")
    if not places:
        return [], []
    notes = settle_layout(callee, places, field)
    # The user's step size is kept; steps of our choice that throw the state far away are shortened.
    return (places if request.step_size is not None else shorten_steps(step, places)), notes


def prepare_map(callee: Callee, request: Request) -> tuple[list[TrialPlace], list[str]]:
    """Settle the layout of a map, and return the places and notes; InputError as `check_map`."""
    step = callee.step
    check_request(step.names, request)
    # The map's unit of length is measured by calls, which need the layout: here the unit is 1.
    ones = [Fraction(1)] * len(step.names)
    notes = settle_layout(callee, places_of_map(step.names, ones, request), None)
    return places_of_map(step.names, find_map_units(step), request), notes


def settle_layout(
    callee: Callee, places: Sequence[TrialPlace], field: FloatField | None
) -> list[str]:
    """Set the layout, and return notes on how the arguments are understood.

    Raises InputError if no call returns a state.
    """
    step, errors = callee.step, list[Exception]()
    # The misfit of each layout in which a call returns a state, at the first place where one does.
    misfits = dict[CallLayout, float]()
    for layout in callee.layouts:
        step.layout = layout
        for place in places[:_MAX_LAYOUT_PLACES]:
            try:
                misfits[layout] = measure_misfit(step, place, field)
                break
            except Exception as error:  # the user's code may raise anything
                errors.append(error)
            if step.seconds_left <= 0:
                break
        # Without an H nothing tells the layouts apart, and the first one that works is kept.
        if misfits and field is None:
            break
    if not misfits:
        step.layout = callee.layouts[0]
        raise no_state_error(step, errors[0], places[0])
    # `callee.layouts` begins with the likeliest, and `misfits` keeps that order.
    likeliest, best = next(iter(misfits)), min(misfits, key=lambda layout: misfits[layout])
    # Another layout must fit, and far better: otherwise a bad scheme would be mistaken for one with
    # its arguments exchanged.
    is_far_better = misfits[best] * _TIMES_BETTER < misfits[likeliest]
    replaces = misfits[best] < _LARGEST_MISFIT and is_far_better
    step.layout = best if replaces else likeliest
    return _describe_layout(callee, step, misfits[step.layout])


def _describe_layout(callee: Callee, step: UserMap, misfit: float) -> list[str]:
    """Return a note on how the arguments are understood, unless this is as usual; the misfit is 0
    if the layout was not compared with an H."""
    usual = ("p", "q", "h"), ("p", "q", "t", "h"), ("p", "q"), ("z",)
    layout = step.layout
    if step.foreign or (layout.roles in usual and callee.named):
        return []
    names = ", ".join(callee.arguments)
    if names == str(layout):
        return []
    reason = "" if callee.named or misfit == 0 else ", the order that fits"
    if not callee.named and misfit >= _LARGEST_MISFIT:
        reason = ", as no order of them fits"
    if layout.roles in usual and not reason:
        return []
    return [f"its arguments ({names}) are taken as ({layout}){reason}"]


def measure_misfit(step: UserMap, place: TrialPlace, field: FloatField | None) -> float:
    """Return the distance of a small step's end from that of an explicit midpoint step, in parts of
    the distance moved; 0 without a field, and 1 if the field is undefined at the place."""
    h = float(place.step) / _STEP_DIVISOR
    z, t = [float(x) for x in place.z], float(place.t)
    end = step.evaluate(z, h, t)
    if field is None:
        return 0.0
    slopes = field(z, t)
    if slopes is None:
        return 1.0
    units = [float(u) for u in place.units]
    # The distance moved is O(h). The midpoint step is off by O(h³), and a consistent step by O(h²),
    # so that the misfit of a consistent step is O(h), and small for a small step.
    middle = field([x + h / 2 * f for x, f in zip(z, slopes, strict=True)], t + h / 2) or slopes
    moved = max(abs(h * f) / u for f, u in zip(middle, units, strict=True))
    gap = max(abs(y - x - h * f) / u for x, y, f, u in zip(z, end, middle, units, strict=True))
    return gap / moved if moved else gap


def no_state_error(step: UserMap, error: Exception, place: TrialPlace) -> InputError:
    """Return the error of a function that returns no state at any place: what came instead.

    `error`: the first one that was raised, at the first place and in the likeliest layout.
    """
    kind = "integrator" if step.takes_step_size else "map"
    # A step of another language is an object with a program, which has the user's name for it.
    name = getattr(step.function, "__name__", None) or getattr(
        getattr(step.function, "program", None), "display_name", "the program"
    )
    if isinstance(error, StepError):
        return InputError(kind, name, str(error.clause))
    message = f"raises {last_line(error)}{step.describe_call(place.z, place.step / 8)}"
    n = step.degrees
    if n > 1 and not isinstance(step.layout, CoordinateLayout):
        message += f"; it was given p and q as arrays of {n} numbers, and in other shapes"
    return InputError(kind, name, message)


def _format_state(step: UserMap, z: Sequence[Fraction]) -> str:
    return ", ".join(f"{name} = {x}" for name, x in zip(step.names, z, strict=True))


def note_time(step: UserMap) -> list[str]:
    """Return a note if H or the step does not depend on time."""
    if step.takes_time and not step.time_dependent:
        return ["H does not depend on time: it is called with t = 0"]
    if step.time_dependent and not step.takes_time:
        return ["it takes no t, and H depends on it: its force stands still"]
    return [] if step.takes_time else ["it takes no t: it is judged for a force without time alone"]
