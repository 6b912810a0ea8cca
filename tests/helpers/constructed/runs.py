"""Results built by hand: runs and proofs that say what a test wants them to say."""

from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Any

from verify.arithmetic.exact import decimal, text
from verify.claims.base_claim import Claim, Findings
from verify.scenes.results.bounded_value import Value
from verify.scenes.results.claim import ClaimResult
from verify.scenes.results.proof_result import ProofResult
from verify.scenes.results.run import RunResult
from verify.scenes.scene import Scene, scene_from
from verify.studies.kinds.grid import grid_task
from verify.studies.kinds.proofs import proof_task
from verify.verdict import Verdict

STEP_SIZES = ("0.001", "0.002", "0.004", "0.006", "0.008", "0.01")
STARTS = (("0.1", "0"), ("1.5", "0"), ("0", "1.5"))
CLAIM = {"id": "c", "source": "s", "statement": "t", "scene": "made", "scheme": "lie2"}
Given = str | int | Fraction | tuple[Any, Any]  # a value, or a value with its bound
Values = Callable[[Fraction, int], dict[str, Given]]  # of a step size and the index of a start
FLAT: dict[str, Given] = {"mse": "1e-20", "lambda": "-1e-5", "delta_j_max": "1e-9"}


def value(given: Given, bound: Any = 0) -> Value:
    """A reported value; without a bound it is exact."""
    middle, radius = given if isinstance(given, tuple) else (given, bound)

    def shown(x: Any) -> str:
        return x if isinstance(x, str) else decimal(Fraction(x), 40)

    return Value(value=shown(middle), bound=shown(radius))


def made_run(h: Any, values: dict[str, Given], **changes: Any) -> RunResult:
    """A finished float64 run with these values."""
    fields: dict[str, Any] = {
        "hamiltonian": "p**2/2 - cos(q)", "parameters": {}, "scheme": "lie2",
        "arithmetic": "float64", "digits": 17, "step_size": text(Fraction(h)),
        "steps": 20000 // Fraction(h), "q": "1", "p": "0", "status": "finished",
        "failed_step": None, "values": {n: value(v) for n, v in values.items()},
        "error_kind": "estimated", "error_method": "by hand", "exact": (), "series": (),
        "seconds": 0.0,
    }  # fmt: skip
    return RunResult(**{**fields, **changes})


def made_proof(**changes: Any) -> ProofResult:
    """A proof that decided neither ΔJ nor whether the map is consistent."""
    fields: dict[str, Any] = {
        "hamiltonian": "p**2/2 - cos(q)", "parameters": {}, "scheme": "lie2",
        "verdict": Verdict.UNDECIDED, "reason": "left open by hand", "order": None,
        "leading": "1", "delta_j": "1", "area_preserving": None, "convergence_order": 0,
        "witness": {}, "enclosure": "", "p_next": "p", "q_next": "q",
        "jacobian": (("1", "0"), ("0", "1")), "seconds": 0.0,
    }  # fmt: skip
    return ProofResult(**{**fields, **changes})


def made_scene(
    step_sizes: Sequence[str] = STEP_SIZES, starts: Sequence[tuple[str, str]] = STARTS
) -> Scene:
    """A pendulum scene with a grid over [0, 20000]."""
    data = {
        "name": "made", "system": "pendulum", "schemes": ["lie2"],
        "grid": {
            "time": 20000, "step_sizes": list(step_sizes),
            "initial_values": [{"q": q, "p": p} for q, p in starts],
        },
    }  # fmt: skip
    return scene_from(data, "by hand")


def made_findings(
    scene: Scene,
    values: Values,
    proof: ProofResult | None = None,
    **changes: Any,
) -> Findings:
    """Findings whose grid run at step size h and start k has `values(h, k)`."""
    assert scene.grid is not None
    results: dict[str, Any] = {proof_task(scene, "lie2").key: proof or made_proof()}
    for k, start in enumerate(scene.grid.initial_values):
        for h in scene.grid.step_sizes:
            at = {"q": text(start.q), "p": text(start.p), **changes}
            results[grid_task(scene, "lie2", h, k).key] = made_run(h, values(h, k), **at)
    return Findings({scene.name: scene}, results)


def check(claim: Claim, values: Values, **scene: Any) -> ClaimResult:
    """The claim's result on a made scene whose runs have these values."""
    (found,) = [claim.judge(made_findings(made_scene(**scene), values))]
    return found


def one_changed(at: tuple[Fraction, int], name: str, given: Given, base: Values) -> Values:
    """`base` with one value of one run changed."""

    def values(h: Fraction, k: int) -> dict[str, Given]:
        return {**base(h, k), name: given} if (h, k) == at else base(h, k)

    return values


def growing(h: Fraction, k: int) -> dict[str, Given]:
    """Like lie2's: MSE and Λ grow with h, and from start to start."""
    size = k + 1
    return {"mse": h**6 * size, "lambda": -(h**3) * size, "delta_j_max": h**3 * size}
