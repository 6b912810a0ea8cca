"""Tasks, points and lines of error against run time that say what a test wants."""

from fractions import Fraction
from typing import Any

from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.run_domain import point_of
from verify.scenes.results.bounded_value import Value
from verify.scenes.results.work_precision import (
    CostResult,
    SlopeResult,
    SystemPoint,
    WorkLine,
    WorkPoint,
    WorkPrecisionResult,
)
from verify.studies.kinds.work_precision import WorkPrecisionTask
from verify.studies.work_precision.problem import ReferenceProblem, reference
from verify.studies.work_precision.work_lines import error_slope, lambda_slope


def work_task(**changes: Any) -> WorkPrecisionTask:
    """Four step sizes of two schemes for the pendulum."""
    own: dict[str, Any] = {
        "hamiltonian": "p**2/2 - cos(q)", "parameters": {}, "schemes": ("lie2", "stormer-verlet"),
        "time": 1, "step_sizes": ("0.02", "0.01", "0.005", "0.0025"), "q": 1, "p": 0,
        "repeats": 2, "number_systems": (), "digits": (), "number_systems_scheme": "lie2",
        "number_systems_step_size": "0.01", "peers": (), "peers_left_out": (),
    }  # fmt: skip
    return WorkPrecisionTask(**own | changes)


def reference_problem(
    hamiltonian: Hamiltonian, time: Fraction, t0: Fraction = Fraction(0), **start: Any
) -> ReferenceProblem:
    """From q and p, a list each in n degrees of freedom."""
    point = point_of(hamiltonian, **start)
    solution = reference(hamiltonian, point, time, t0)
    return ReferenceProblem(hamiltonian, point, time, t0, solution)


def value(text: str | None, bound: str = "1e-30") -> Value | None:
    text = text if text is None or "e" not in text else f"{float(text):.12e}"
    return None if text is None else Value(value=text, bound="0" if text == "0" else bound)


def point(
    *, error: str | None = "1e-3", rounding: str | None = "1e-15", lam: str | None = "1e-4",
    lam_plain: str | None = "1e-4", seconds: float | None = 1e-5, **changes: Any,
) -> WorkPoint:  # fmt: skip
    failed = changes.get("limited_by") == "failed"
    own: dict[str, Any] = {
        "scheme": "lie2", "step_size": "0.1", "tolerance": None, "steps": 10,
        "error": value(error), "truncation": value(error), "rounding": value(rounding),
        "energy": value("1e-5"), "lam": value(lam), "lam_plain": value(lam_plain),
        "limited_by": "truncation", "lambda_limited_by": "truncation", "failed_step": None,
        "reason": "", "seconds_min": seconds, "seconds_median": seconds, "evaluations": None,
    }  # fmt: skip
    if failed:
        own |= dict.fromkeys(("error", "truncation", "rounding", "energy", "lam", "lam_plain"))
    return WorkPoint(**own | changes)


def line(
    *points: WorkPoint, name: str = "lie2", claimed: int | None = 2, peer: bool = False,
    area_preserving: bool = False,
) -> WorkLine:  # fmt: skip
    none = SlopeResult(value=None, standard_error=None, points=0, reason="")
    named = tuple(each.model_copy(update={"scheme": name}) for each in points)
    cost = CostResult(additions=3, multiplications=4, divisions=0, functions={}, gradient=None)
    return WorkLine(
        name=name, peer=peer, order=claimed, area_preserving=area_preserving,
        error_slope=none if peer else error_slope(named),
        lambda_slope=none if peer else lambda_slope(named, area_preserving),
        cost=None if peer else cost, compile_seconds=0.5, points=named,
    )  # fmt: skip


def ladder(name: str = "lie2", **more: Any) -> WorkLine:
    """Three points of exact order 2."""
    sizes = ("0.1", "0.05", "0.025")
    points = (
        point(step_size=h, steps=int(1 / float(h)), error=repr(float(h) ** 2),
              seconds=1e-6 / float(h))
        for h in sizes
    )  # fmt: skip
    return line(*points, name=name, **more)


def system(**changes: Any) -> SystemPoint:
    own: dict[str, Any] = {
        "arithmetic": "mpfr", "digits": 33, "certified": "32.7", "error_kind": "enclosed",
        "error_method": "balls", "seconds_min": 1e-3, "seconds_median": 2e-3, "reason": "",
    }  # fmt: skip
    return SystemPoint(**own | changes)


def result(*lines: WorkLine, **changes: Any) -> WorkPrecisionResult:
    own: dict[str, Any] = {
        "hamiltonian": "p**2/2 - cos(q)", "parameters": {}, "time": "1", "q": "1", "p": "0",
        "repeats": 5, "clock": "processor time", "overhead": 1e-8, "rounding_share": "0.05",
        "scale": "1",
        "reference": "a flow", "reference_bound": "1e-40", "machine": "Linux x86_64, 2 cores",
        "lines": lines, "comparisons": (),
        "systems": (), "systems_scheme": "lie2", "systems_step_size": "0.1", "left_out": (),
        "seconds": 1.0,
    }  # fmt: skip
    return WorkPrecisionResult(**own | changes)
