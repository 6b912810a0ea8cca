"""The paper's four criteria for a scheme in a scene, each with its evidence.

1. det J ≡ 1 ("exactly preserves the area"). 2. |ΔJ| = o(h). 3. MSE = o(h). 4. Λ = o(1), h → 0.

From the proved order r of ΔJ, on any fixed [0, T] on which the exact solution exists and for a
consistent map: its points stay in a compact set K for small h, |ΔJ| ≤ C h^r on K, so MSE ≤ C² h^2r,
and |Λ| ≤ exp(N C h^r) − 1 = O(h^(r−1)) with N = T/h. These are upper bounds: Λ may be smaller.
Where there is no proof the slope over the grid of step sizes decides, from the points above the
rounding plateau; where that cannot, the answer is UNDECIDED.
"""

from collections.abc import Sequence
from fractions import Fraction
from math import log10

from verify.balls import ball, precision, slope
from verify.results import CriterionResult, ProofResult, RunResult
from verify.verdict import Verdict

NAMES = {
    1: "det J ≡ 1",
    2: "|ΔJ| is of higher order than h",
    3: "the MSE is of higher order than h",
    4: "Λ vanishes with h",
}
_MIN_POINTS = 4
_MARGIN = 0.1
_PLATEAU = Fraction(1, 100)  # a point is above it where its error bound is below 1 %


def judge(number: int, proof: ProofResult, runs: Sequence[RunResult]) -> CriterionResult:
    """The verdict on one criterion; `runs`: the grid's runs of this scheme, if there are any."""
    verdict, evidence = _judge(number, proof, runs)
    return CriterionResult(number=number, scheme=proof.scheme, verdict=verdict, evidence=evidence)


def _judge(number: int, proof: ProofResult, runs: Sequence[RunResult]) -> tuple[Verdict, str]:
    if proof.convergence_order is not None and proof.convergence_order < 1:
        if proof.verdict is Verdict.REFUTED:
            return Verdict.REFUTED, proof.reason
        return Verdict.UNDECIDED, proof.reason
    if proof.area_preserving:
        return Verdict.PROVED, "ΔJ ≡ 0 is proved, so ΔJ, MSE and Λ are exactly 0"
    if proof.order is None:
        return _measured(number, runs) if number > 2 else (Verdict.UNDECIDED, proof.reason)
    return _from_order(number, proof, runs)


def _from_order(number: int, proof: ProofResult, runs: Sequence[RunResult]) -> tuple[Verdict, str]:
    r = proof.order
    assert r is not None  # noqa: S101 - the caller's condition
    at = ", ".join(f"{name} = {value}" for name, value in proof.witness.items())
    where = f"; at {at} its coefficient is {proof.enclosure}" if at else ""
    match number:
        case 1:
            return Verdict.REFUTED, f"ΔJ has order exactly h^{r}{where}"
        case 2:
            verdict = Verdict.PROVED if r >= 2 else Verdict.REFUTED
            return verdict, f"ΔJ = O(h^{r}), exactly of that order{where}"
        case 3 if r >= 1:
            return Verdict.PROVED, f"MSE = O(h^{2 * r}) on every fixed [0, T]{_seen('mse', runs)}"
        case 4 if r >= 2:
            seen = _seen("lambda", runs)
            return Verdict.PROVED, f"Λ = O(h^{r - 1}) on every fixed [0, T]{seen}"
    return _measured(number, runs)


def _measured(number: int, runs: Sequence[RunResult]) -> tuple[Verdict, str]:
    """By the slopes: criterion 3 asks for more than 1, criterion 4 for more than 0."""
    name, least = ("mse", 1) if number == 3 else ("lambda", 0)
    slopes = measured_slopes(name, runs)
    if not slopes:
        return Verdict.UNDECIDED, (
            f"no proof, and fewer than {_MIN_POINTS} step sizes above the rounding plateau"
        )
    text = f"measured slope {_range(slopes)} over the step sizes"
    # A slope of exactly `least` is what fails; a margin keeps it from passing by its noise.
    if all(s - 2 * e > least + _MARGIN for s, e in slopes):
        return Verdict.MEASURED, text
    if any(s + 2 * e < least + _MARGIN for s, e in slopes):
        return Verdict.REFUTED, f"{text}, where more than {least} is asked for"
    return Verdict.UNDECIDED, f"{text}, too uncertain to tell it from {least}"


def _seen(name: str, runs: Sequence[RunResult]) -> str:
    slopes = measured_slopes(name, runs)
    return f"; measured slope {_range(slopes)} over the grid" if slopes else ""


def _range(slopes: Sequence[tuple[float, float]]) -> str:
    low, high = min(slopes), max(slopes)
    if len(slopes) == 1:
        return f"{low[0]:.2f} ± {low[1]:.2f}"
    return f"{low[0]:.2f} … {high[0]:.2f}"


def measured_slopes(name: str, runs: Sequence[RunResult]) -> list[tuple[float, float]]:
    """Slope and standard error of lg |value| over lg h, for each initial value that allows it."""
    groups: dict[tuple[str, str], list[tuple[float, float]]] = {}
    with precision():
        for run in runs:
            value = run.values.get(name)
            if value is None or Fraction(value.value) == 0:
                continue
            size = abs(ball(value))
            if Fraction(value.bound) <= _PLATEAU * abs(Fraction(value.value)):
                point = log10(Fraction(run.step_size)), float(size.log() / 2.302585092994046)
                groups.setdefault((run.q, run.p), []).append(point)
    usable = [g for g in groups.values() if len({x for x, _ in g}) >= _MIN_POINTS]
    return [slope(points) for points in usable]
