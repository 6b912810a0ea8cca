"""Growth laws built by hand, that say what a test wants them to say."""

from typing import Any

from verify.scenes.results.bounded_value import Value
from verify.scenes.results.growth import AverageResult, GrowthLawResult, PredictionResult


def value(text: str) -> Value:
    return Value(value=text, bound="1.00e-30")


def law(**changes: Any) -> AverageResult:
    own: dict[str, Any] = {
        "hamiltonian": "p**2/2 - cos(q)", "parameters": {}, "scheme": "lie2", "digits": 30,
        "q": "1", "p": "-0.5", "power": 3, "g": "cos(q)**2/4", "potential": "cos(q)/2",
        "telescopes": True, "by_potential": True,
        "orbit": "libration", "reason": "", "average": value("2.50000e-01"),
        "period": value("6.28318e+00"), "error_kind": "estimated", "error_method": "once more",
        "seconds": 0.1,
    }  # fmt: skip
    return AverageResult.model_validate(own | changes)


def prediction(h: str, difference: str | None = "1.0000e-03", **changes: Any) -> PredictionResult:
    own: dict[str, Any] = {
        "step_size": h, "steps": 2000, "boundary": value("1.0000e-06"),
        "secular": value("1.0000e-05"), "predicted": value("1.1000e-05"),
        "measured": value("1.0900e-05"), "difference": value(difference) if difference else None,
    }  # fmt: skip
    return PredictionResult.model_validate(own | changes)


def of(*predictions: PredictionResult, **changes: Any) -> GrowthLawResult:
    return GrowthLawResult(law=law(**changes), predictions=predictions)


TWO = of(prediction("0.01"), prediction("0.02", "-5.0000e-03"))
LOST = of(q="0", p="2", orbit="undecided", reason="on a separatrix", average=None, period=None)
