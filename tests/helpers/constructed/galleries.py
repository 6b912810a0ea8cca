"""Galleries made up for the page: each scene says what a test wants it to say."""

from typing import Any

from tests.helpers.constructed.separations import evaluation, point
from verify.scenes.results.bounded_value import Value
from verify.scenes.results.exploration import Gallery, GalleryScene
from verify.scenes.results.separation_parts import EvaluationResult, PartsAt

SCENE = 'hamiltonian = "p**2/2 + q**4/4"\nschemes = ["lie2"]\n'


def at(steps: int, truncation: str, total: str) -> PartsAt:
    zero = dict.fromkeys(("input", "trajectory", "product"), "0")
    return PartsAt(
        steps=steps, truncation=truncation, total=total, determinant=total, **zero
    )  # fmt: skip


def split(*series: PartsAt, **changes: Any) -> EvaluationResult:
    last = series[-1]
    largest = {
        name: max((getattr(x, name) for x in series), key=lambda size: abs(float(size)))
        for name in ("truncation", "total")
    }
    return evaluation(last.truncation, last.total, series=series, largest=largest, **changes)


KEPT = split(at(5, "1e-06", "-1e-16"), at(100, "-4e-05", "2e-15"), at(10_000, "1e-05", "4e-12"))
CROSSED = split(at(5, "1e-12", "1e-16"), at(100, "2e-12", "-3e-12"), at(10_000, "2e-12", "9e-10"))
NOTHING = split(
    at(5, "0", "0"), at(10_000, "0", "0")
).model_copy(
    update={"parts": evaluation("0", "0").parts.model_copy(
        update={n: Value(value="0", bound="0") for n in ("truncation", "total")}
    )}
)  # fmt: skip


def shown(plain: EvaluationResult | None = KEPT, **changes: Any) -> GalleryScene:
    """One scene, whose `separation` may be changed by the names of its fields."""
    of = {n: changes.pop(n) for n in ("hamiltonian", "scheme", "status", "reason") if n in changes}
    separation = point("0.001", plain, None, **{"steps": 10_000, "q": "-2", "p": "0.1"} | of)
    own: dict[str, Any] = {
        "value": 3.7, "scene": SCENE, "separation": separation, "meaningless_after": None,
        "orbit": (("-2", "0.1"), ("-1.5", "0.4"), ("-1.2", "1")),
    }  # fmt: skip
    return GalleryScene.model_validate(own | changes)


def gallery(*scenes: GalleryScene, **changes: Any) -> Gallery:
    own: dict[str, Any] = {
        "measure": "rounding-share", "sentence": "greatest rounding part over truncation",
        "seed": 7, "examples": 1200, "steps": 100, "reach": "2", "step_sizes": ("0.001", "0.1"),
        "coefficients": ("1/7", "7"), "scenes": scenes,
    }  # fmt: skip
    return Gallery.model_validate(own | changes)
