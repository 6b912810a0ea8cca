"""Results on stability, made by hand for tests of what a page makes of them."""

from typing import Any

from verify.scenes.results.stability import (
    LargestStepResult,
    MapCell,
    StabilityMapResult,
    StabilityResult,
)

H = {"hamiltonian": "p**2/2 + q**2/2", "parameters": {}, "q": "1", "p": "0"}


def case(**changes: Any) -> StabilityResult:
    given = H | {
        "id": "mine/some/lie2/h=0.1", "scheme": "lie2", "step_size": "0.1", "steps": 1000,
        "kind": "drifts", "rate": "1.25e-04", "exact_orbit": "closed", "detail": "bounded",
    }  # fmt: skip
    return StabilityResult(**(given | changes))


LEFT = case(kind="unstable: scheme", rate=None, step=7, step_size="2", detail="leaves at step 7")
LARGEST = LargestStepResult(
    **H, scheme="stormer-verlet", time="100", bounded="1.900e+00", unbounded="1.901e+00",
    linear="2.000e+00", h_omega="1.900e+00", exact_orbit="closed", detail="",
)  # fmt: skip
NEVER = LARGEST.model_copy(update={"scheme": "lie2", "bounded": "1.300e-01", "linear": "0"})
MAP = StabilityMapResult(
    **H, scheme="lie4", parameter="a", values=("1", "10"), step_sizes=("0.1", "1", "10"), steps=500,
    cells=(
        (MapCell(kind="stable"), MapCell(kind="drifts"), MapCell(kind="unstable: scheme", step=3)),
        (MapCell(kind="stable"), MapCell(kind="overflow", step=1), MapCell(kind="escapes")),
    ),
    linear=("2.8", None),
)  # fmt: skip
