"""Assertions for pytest on what a step function of one's own preserves.

    from verify.testing import assert_area_preserving, assert_convergence_order

    def step(p, q, h):
        p = p - h * math.sin(q)
        return p, q + h * p

    def test_step():
        assert_area_preserving(step, "pendulum")
        assert_convergence_order(step, "pendulum", 1)

`assert_keeps` is for any structure: volume, reversibility, energy, 2-forms of one's own.

If the code of the step works with symbols, the assertion is proved, otherwise measured; see
`verify.integrators.step_check`. The step is called, also with p, q and h that are not floats.
"""

import inspect
from collections.abc import Callable
from functools import partial
from typing import Any

from verify.calls.check import check, check_map, request_of
from verify.calls.inputs import hamiltonian_from
from verify.errors import NOT_GIVEN, InputError, unknown_name
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.results import MOST_CLAIMED, Claims, Finding
from verify.integrators.step_check import check_step
from verify.integrators.user_code.loading import callee_from
from verify.integrators.user_code.step import TIME_LIMIT
from verify.verdict import Verdict

__all__ = [
    "assert_area_order", "assert_area_preserving", "assert_convergence_order", "assert_keeps",
    "assert_symplectic",
]  # fmt: skip

StepFunction = Callable[..., Any]
_REFINEMENTS = "form", "density", "poisson", "casimirs", "reverses", "factor"
# Arguments of `verify.check` that are claims of another kind, or are given otherwise.
_NO_OPTIONS = "system", "step", "function", "keeps", "order", "area_preserving", "symplectic"


def assert_area_preserving(
    step: StepFunction, hamiltonian: Hamiltonian | str, **options: Any
) -> Finding:
    """Assert that det J ≡ 1 for the map (p, q) ↦ step(p, q, h), and that it is a scheme for H.

    `step(p, q, h)` returns p' and q', numbers or arrays of one entry; if its arguments are named
    q, p, h or x, v, dt, it gets and returns the values in that order. `hamiltonian`: a Hamiltonian,
    a formula such as "p**2/2 - cos(q)", or the name of a system. `options`: `parameters`, a mapping
    of names to exact values; `arguments`, their order, such as "q,p,h"; `p` and `q`, the first
    state to try; `step_size`, the largest to try; `within`, a defect that is allowed; `time_limit`,
    the seconds for all calls.

    Returns the Finding with its verdict: PROVED, or MEASURED with `probe_error`. Raises
    AssertionError, whose message has the counterexample: initial value, h, det J − 1. An undecided
    claim fails too, and the message says UNDECIDED. Raises InputError for a bad argument.
    """
    # pytest then shows the line of the test, and not this one.
    __tracebackhide__ = True
    return _assert_claims(step, hamiltonian, Claims(area_preserving=True), options)


def assert_symplectic(
    step: StepFunction, hamiltonian: Hamiltonian | str, **options: Any
) -> Finding:
    """Assert that JᵀΩJ ≡ Ω for the map z ↦ step(z, h), and that it is a scheme for H.

    In n degrees of freedom `step(p, q, h)` takes and returns arrays of n numbers, and the message
    has the entry of S = JᵀΩJ − Ω that is not 0. In one degree of freedom it is the same as
    `assert_area_preserving`, whose options and errors are those of this function too.
    """
    __tracebackhide__ = True
    return _assert_claims(step, hamiltonian, Claims(symplectic=True), options)


def assert_area_order(
    step: StepFunction, hamiltonian: Hamiltonian | str, order: int, **options: Any
) -> Finding:
    """Assert that ΔJ = det J − 1 is O(h^order), or 0; options as `assert_area_preserving`.

    The scheme lie2 has ΔJ = O(h³), so that `assert_area_order(lie2, H, 3)` passes.
    """
    __tracebackhide__ = True
    return _assert_claims(step, hamiltonian, Claims(area_order=_check_order(order)), options)


def assert_convergence_order(
    step: StepFunction, hamiltonian: Hamiltonian | str, order: int, **options: Any
) -> Finding:
    """Assert that one step agrees with the exact flow up to h^order, at least.

    Then the global error is O(h^order). The options are those of `assert_area_preserving`.
    """
    __tracebackhide__ = True
    return _assert_claims(step, hamiltonian, Claims(order=_check_order(order)), options)


def assert_keeps(
    step: StepFunction, *structures: str, system: Hamiltonian | str | None = None, **options: Any
) -> Finding:
    """Assert that a step, or without a `system` a map, keeps all of these structures.

        def test_boris():
            assert_keeps(push, "volume", coordinates="v1,v2,v3,x1,x2,x3", parameters={"h": 0.1})

        def test_step():
            assert_keeps(step, "area", "reversible", "energy: 3", system="pendulum")

    `structures`, and the options `form`, `density`, `poisson`, `casimirs`, `reverses` and `factor`,
    which refine them, are those of `verify.prove`; `system`: a Hamiltonian, a formula, the name of
    a system, or equations "u_dot = …; v_dot = …". The other options are those of `verify.check`,
    or of `verify.check_map`. Nothing but the structures is judged.

    Returns the Finding, whose `keeps` has the verdict on each. Raises AssertionError with the
    counterexample, also if a structure is UNDECIDED, and InputError for a bad argument.
    """
    __tracebackhide__ = True
    if not callable(step):
        raise InputError("step", step, "is no function")
    call = check_map if system is None else partial(check, system)
    allowed = inspect.signature(call).parameters
    for name in options:
        if name not in allowed or name in _NO_OPTIONS:
            raise unknown_name(name, options[name], sorted({*allowed} - {*_NO_OPTIONS}))
    if not structures and not {*options} & {*_REFINEMENTS}:
        raise InputError("structures", NOT_GIVEN, "name one at least, such as 'volume'")
    finding = call(step, keeps=structures, **options)
    assert isinstance(finding, Finding)  # noqa: S101 - of a function
    if not finding.verdict.holds:
        raise AssertionError(_format_message(finding))
    return finding


def _check_order(order: int) -> int:
    if isinstance(order, bool) or not isinstance(order, int) or not 1 <= order <= MOST_CLAIMED:
        raise InputError("order", order, f"is no whole number from 1 to {MOST_CLAIMED}")
    return order


def _assert_claims(
    step: StepFunction, hamiltonian: Hamiltonian | str, claims: Claims, options: dict[str, Any]
) -> Finding:
    __tracebackhide__ = True
    option_names = {"parameters", "arguments", "p", "q", "step_size", "within", "time_limit"}
    for name in options:
        if name not in option_names:
            raise unknown_name(name, options[name], sorted(option_names))
    if not callable(step):
        raise InputError("step", step, "is no function")
    system = hamiltonian_from(hamiltonian, options.get("parameters"))
    places = {name: options.get(name) for name in ("p", "q", "step_size", "within")}
    callee = callee_from(
        step, system.coordinates, arguments=options.get("arguments"),
        parameters=dict(system.values), time_limit=options.get("time_limit", TIME_LIMIT),
    )  # fmt: skip
    finding = check_step(callee, system, claims, (), request_of(system, **places))
    # UNDECIDED counts as a failure: an assertion that nothing decides must not pass.
    if not finding.verdict.holds:
        raise AssertionError(_format_message(finding))
    return finding


def _format_message(finding: Finding) -> str:
    lines = [f"{finding.verdict}: {finding.reason}"]
    if finding.verdict is Verdict.UNDECIDED:
        lines[0] = f"UNDECIDED, which is neither yes nor no: {finding.reason}"
    if finding.counterexample is not None:
        lines.append(str(finding.counterexample))
    return "\n".join([*lines, *finding.notes])
