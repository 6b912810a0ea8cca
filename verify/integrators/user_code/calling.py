"""Which layout a user's function takes its state in: tried, and held against the exact flow.

Where names do not tell p from q, or h from t, the order that fits H is taken, and said. A function
that takes its state in no layout is no step: that is an error of the call, and nothing is refuted.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from verify.errors import InputError
from verify.integrators.places.place import Place
from verify.integrators.places.units import Field
from verify.integrators.user_code.layout import Layout
from verify.integrators.user_code.loading import Callee
from verify.integrators.user_code.step import StepError, last_line
from verify.integrators.user_code.user_map import UserMap

_PART = 64  # of the largest step size
_FITS = 0.2  # of the way that the flow goes
_BETTER = 10  # times as near, another layout has to be


@dataclass(frozen=True)
class _Trial:
    layout: Layout
    misfit: float


def settle_layout(callee: Callee, places: Sequence[Place], field: Field | None) -> list[str]:
    """Sets the layout, and returns notes on how the arguments are understood.

    Raises InputError where no call returns a state.
    """
    step, lost = callee.step, list[Exception]()
    trials = list[_Trial]()
    for layout in callee.layouts:
        step.layout = layout
        for place in places[:3]:
            try:
                trials.append(_Trial(layout, _misfit(step, place, field)))
                break
            except Exception as error:  # the user's code may raise anything
                lost.append(error)
            if step.left <= 0:
                break
        if trials and field is None:
            break
    if not trials:
        step.layout = callee.layouts[0]
        raise no_state(step, lost[0], places[0])
    best = min(trials, key=lambda x: x.misfit)
    if best.misfit < _FITS and best.misfit * _BETTER < trials[0].misfit:
        step.layout = best.layout
    else:
        best = trials[0]
        step.layout = best.layout
    return _understood(callee, step, best)


def _understood(callee: Callee, step: UserMap, best: _Trial) -> list[str]:
    usual = ("p", "q", "h"), ("p", "q", "t", "h"), ("p", "q"), ("z",)
    layout = step.layout
    if step.foreign or (layout.roles in usual and callee.named):
        return []
    names = ", ".join(callee.arguments)
    why = "" if callee.named or best.misfit == 0 else ", the order that fits"
    if not callee.named and best.misfit >= _FITS:
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
