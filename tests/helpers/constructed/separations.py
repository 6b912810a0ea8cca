"""Separations made up for the page: truncation goes like h², rounding is as a test wants it."""

from decimal import Decimal
from typing import Any

from verify.scenes.results.bounded_value import Value
from verify.scenes.results.separation import SeparationGrid, SeparationResult
from verify.scenes.results.separation_parts import EvaluationResult, GrowthResult, Parts
from verify.studies.separation.truncation_and_rounding import as_grid

PARTS = ("input", "trajectory", "determinant", "product")


def value(text: str) -> Value:
    return Value(value=text, bound="1.00e-40")


def evaluation(
    truncation: str, total: str, parts: dict[str, str] | None = None, **changes: Any
) -> EvaluationResult:
    shown = dict.fromkeys(PARTS, "1.000e-33") | {"determinant": total} | (parts or {})
    growth = GrowthResult(
        exponent="0.962", standard_error="0.127", name="drift", reason="0.962 ± 0.318 holds 1",
        first=8, last=2000, points=32,
    )  # fmt: skip
    own: dict[str, Any] = {
        "parts": Parts(
            lambda_working=value("-3.668e-08"), truncation=value(truncation), total=value(total),
            **{name: value(text) for name, text in shown.items()},
        ),
        "largest": {"truncation": truncation, "total": total},
        "growth": {"total": growth}, "series": (), "error_kind": "enclosed",
    }  # fmt: skip
    return EvaluationResult.model_validate(own | changes)


def point(h: str, plain: EvaluationResult | None, closed: Any, **changes: Any) -> SeparationResult:
    own: dict[str, Any] = {
        "hamiltonian": "p**2/2", "parameters": {}, "scheme": "lie2", "arithmetic": "mpfr",
        "digits": 6, "step_size": h, "steps": int(2 / Decimal(h)), "q": "1.5", "p": "0",
        "status": "finished", "failed_step": None, "reason": "", "plain": plain,
        "closed_form": closed, "error_method": "rounding counted", "seconds": 0.1,
    }  # fmt: skip
    return SeparationResult.model_validate(own | changes)


def grid(plain: list[str], closed: list[str]) -> SeparationGrid:
    """Truncation h² over three step sizes, with these roundings."""
    sizes = zip(("0.1", "0.01", "0.001"), ("1.000e-02", "1.000e-04", "1.000e-06"), strict=True)
    return as_grid(
        [
            point(h, evaluation(size, a), evaluation(size, b))
            for (h, size), a, b in zip(sizes, plain, closed, strict=True)
        ]
    )


LOW = ["1.000e-12", "1.000e-12", "1.000e-13"]
BELOW = grid(["1.000e-07", "1.000e-07", "1.000e-08"], LOW)
CROSSING = grid(["1.000e-05", "1.000e-05", "1.000e-05"], LOW)
BOTH = grid(["1.000e-05", "1.000e-05", "1.000e-05"], ["1.000e-06", "2.000e-06", "3.000e-06"])
