"""The exact flow keeps H, comes back with time reversed, and moves G by the leading term X·G.

G is the potential of the leading coefficient of ΔJ, which is X·G if it telescopes. The flow is
followed by extrapolation, to 40 digits over a short time. If H depends on time, it changes along
the flow at the rate ∂H/∂t.
"""

from collections.abc import Mapping
from contextlib import suppress
from fractions import Fraction
from operator import attrgetter

from verify.algebra.enclosure import enclose
from verify.algebra.ring import Poly, Ring
from verify.arithmetic.arb import Ball, format_ball, rational_ball
from verify.arithmetic.flint_precision import working_precision
from verify.exploration.property import Silent, Violation, only_if, require_value, silent_at
from verify.exploration.sample import Sample
from verify.flows.extrapolation import NoFlowError, NumericalFlow
from verify.structures import AREA, SYMPLECTIC

# In n degrees of freedom neither the proof nor G is needed, which take long for a long map.
_APPLIES = {AREA: attrgetter("ordinary"), SYMPLECTIC: attrgetter("short")}
_DIGITS, _BITS = 40, 220
_TIME, _INSTANT = Fraction(1, 1000), Fraction(1, 2**60)
_MAX_FLOW_STEPS = 100  # over _TIME; a field that needs more is left out
_STATE_TOLERANCE = Fraction(1, 10**30)  # relative, after _TIME and back
# Relative to 1 + |L|: (G(φ_t z) − G(z))/t differs from the derivative by O(t).
_RATE_TOLERANCE = Fraction(1, 2**20)
Point = Mapping[str, Fraction]
Element = tuple[Ring, Poly]


def holds(sample: Sample) -> None:
    """Check that the flow is reversible and conserves H, and how it moves the potential G."""
    only_if(sample.is_turn(one_in=3))
    only_if(_APPLIES[sample.hamiltonian.structure](sample))
    flow = sample.flow(_DIGITS)
    start = sample.start
    after = _flow_to(flow, start, _TIME)
    back = _flow_to(flow, after, -_TIME)
    for name in sample.point:
        x, y = start[name], back[name]
        if abs(x - y) > _STATE_TOLERANCE * (1 + abs(x)):
            raise Violation(f"{name} comes back as {float(y)!r}, from {float(x)!r}")
    _energy_must_be_kept(sample, after)
    if sample.is_turn(one_in=6):
        with suppress(Silent):  # the property applies even if G cannot be computed
            _potential_must_move(sample)


def _energy_must_be_kept(sample: Sample, after: Point) -> None:
    field = sample.field
    ring, element = field.ring, field.energy
    if sample.depends_on_time:
        _must_grow(sample, "H", (ring, element), "∂H/∂t", (ring, ring.diff(element, "t")))
        return
    energy, later_energy = (_value((ring, element), point) for point in (sample.start, after))
    with working_precision(_BITS):
        # The energy may be steep, so that its change is allowed a million times the state's error.
        if abs(later_energy - energy) > rational_ball(_STATE_TOLERANCE) * 10**6 * (1 + abs(energy)):
            raise Violation(
                f"H is {format_ball(energy, 12)}, and after {_TIME} {format_ball(later_energy, 12)}"
            )


def _potential_must_move(sample: Sample) -> None:
    """Compare the change of G over an instant with L = X·G; Silent if there is no G."""
    only_if(sample.polynomial)
    potential = require_value(sample.potential)
    only_if(bool(potential.holds))
    _must_grow(
        sample,
        "G",
        require_value(potential.element),
        "L",
        require_value(sample.proof.first.element),
    )


def _must_grow(sample: Sample, name: str, x: Element, rate: str, expected_rate: Element) -> None:
    """Raise Violation unless the rate of change of an element is the other element."""
    start = sample.start
    end = _flow_to(sample.flow(2 * _DIGITS), start, _INSTANT)
    ends = [_value(x, point) for point in (start, end)]
    expected = _value(expected_rate, start)
    with working_precision(_BITS):
        # Over an instant, the quotient is the derivative to 20 bits.
        rate_of_change = (ends[1] - ends[0]) / rational_ball(_INSTANT)
        is_wrong = abs(rate_of_change - expected) > (1 + abs(expected)) * rational_ball(
            _RATE_TOLERANCE
        )
    if is_wrong:
        message = f"{name} grows by {format_ball(rate_of_change, 12)} a time"
        raise Violation(f"{message}, and {rate} is {format_ball(expected, 12)}")


def _flow_to(flow: NumericalFlow, start: Point, time: Fraction) -> dict[str, Fraction]:
    """Return the state of the flow after the time, with t if H depends on it."""
    with silent_at(NoFlowError):
        z = flow.follow(flow.state(start), time, _MAX_FLOW_STEPS)
    end = dict(zip(flow.names, map(flow.arithmetic.exact, z), strict=False))
    return end | {"t": start["t"] + time} if flow.timed else end


def _value(element: Element, point: Point) -> Ball:
    ring, x = element
    return require_value(enclose(ring, x, point, _BITS))
