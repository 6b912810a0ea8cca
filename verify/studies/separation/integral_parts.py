"""Truncation and rounding in the change of a function I of the state, I − I₀ after N float64 steps.

What a program prints is made of four values, each with one thing more that is rounded:

0. the change along the exact orbit from the exact inputs: truncation alone;
1. along the exact orbit from the inputs as float64 rounds them: `input` is the difference;
2. along the orbit of float64, with I as it is at its states: `trajectory`;
3. with I as float64 evaluates it at both ends, and their difference rounded: `evaluation`.

So the parts add up exactly to what is printed.
"""

from collections.abc import Mapping, Sequence
from fractions import Fraction
from itertools import pairwise, starmap
from typing import Any

from verify import observables as kinds
from verify.algebra.formula import parse, symbol
from verify.arithmetic.arb import midpoint_and_radius
from verify.arithmetic.exact import text
from verify.arithmetic.flint_precision import working_precision
from verify.arithmetic.systems import float64
from verify.kernels.run_changes import UndefinedError
from verify.kernels.stepping import KernelRun
from verify.lazy_sympy import sympy
from verify.lockstep import Course, run_alone
from verify.observables.observable import ENERGY
from verify.runs.digits_on_demand import choose, measure
from verify.runs.run_start import Start
from verify.scenes.results.bounded_value import Value
from verify.scenes.results.integral_parts import PARTS, IntegralParts
from verify.scenes.values import AUTO
from verify.studies.separation.mixed_run import round_inputs

_MORE_DIGITS = 20
_GUARD_BITS = 64
Bounded = tuple[Fraction, Fraction]


def separate_change(
    start: Start, steps: int, observable: str, *, digits: int, arithmetic: str = AUTO
) -> IntegralParts:
    """Split I − I₀ at the end of a float64 run; `observable`: its name, as `energy_error`."""
    return run_alone(_separate(start, steps, observable, digits, arithmetic))


def _separate(
    start: Start, steps: int, name: str, digits: int, arithmetic: str
) -> Course[IntegralParts]:
    exact = KernelRun(start.hamiltonian, start.scheme, start.inputs, steps, frozenset({name}), 0)
    fields: dict[str, Any] = {
        "observable": name, "step_size": text(start.step_size), "steps": steps,
    }  # fmt: skip
    rounded = round_inputs(exact)
    outcome = rounded.with_observables(frozenset()).run(float64.make(17))
    links = []
    for run in (exact, rounded):
        system = choose(run, digits) if arithmetic == AUTO else arithmetic
        # The difference of two links has fewer digits than each.
        links.append((yield from measure(run, system, digits + _MORE_DIGITS)).bounds)
    if outcome.done < steps or any(name not in link.values for link in links):
        return IntegralParts(**fields, status="unresolved")
    states = [rounded.in_user_names(x) for x in (rounded.start, outcome.values)]
    times = rounded.span if rounded.hamiltonian.time_dependent else (Fraction(0),) * 2
    points = [
        {**rounded.parameters, **state, "t": t} for state, t in zip(states, times, strict=True)
    ]
    formula = kinds.select({name})[0].integral
    chain = [link.values[name] for link in links]
    chain += [
        _change(rounded, formula, points, 4 * digits),
        (_in_floats(rounded, formula, points), Fraction(0)),
    ]
    parts = [
        chain[0],
        *starmap(_difference, pairwise(chain)),
        chain[-1],
        _difference(chain[0], chain[-1]),
    ]
    values = {part: Value.from_bound(*x, digits) for part, x in zip(PARTS, parts, strict=True)}
    fields["error_kind"] = "enclosed" if all(x.rigorous for x in links) else "estimated"
    return IntegralParts(**fields, values=values, status="finished")


def _difference(before: Bounded, after: Bounded) -> Bounded:
    return after[0] - before[0], after[1] + before[1]


def _change(
    run: KernelRun, formula: str, points: Sequence[Mapping[str, Fraction]], bits: int
) -> Bounded:
    """Return I at the last point minus I at the first, of the numbers as they are."""
    balls = [run.integral(formula).evaluate(point, bits + _GUARD_BITS) for point in points]
    if balls[0] is None or balls[1] is None:
        raise UndefinedError("integral", formula, "is not defined at an end of the run")
    with working_precision(bits + 2 * _GUARD_BITS):
        return midpoint_and_radius(balls[1] - balls[0])


def _in_floats(run: KernelRun, formula: str, points: Sequence[Mapping[str, Fraction]]) -> Fraction:
    """Return the same as Python's floats give it."""
    system = run.hamiltonian
    expression = system.expression if formula == ENERGY else parse(formula, source="integral")
    names = sorted(x.name for x in expression.free_symbols)
    function = sympy.lambdify(list(map(symbol, names)), expression, modules="math")
    first, last = (float(function(*(float(point[n]) for n in names))) for point in points)
    return Fraction(last - first)
