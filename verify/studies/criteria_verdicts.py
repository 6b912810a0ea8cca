"""The paper's four criteria for a scheme in a scene, each with its evidence.

1. det J ≡ 1 ("exactly preserves the area"). 2. |ΔJ| = o(h). 3. MSE = o(h). 4. Λ = o(1), h → 0.

A map that agrees with the exact flow up to h^m has det J = 1 + O(h^(m+1)), for the flow has det 1;
so ΔJ = O(h^r) with r = m + 1 at least, and r ≥ 2 for a consistent map. On any fixed [0, T] on which
the exact solution exists its points stay in a compact set K for small h, |ΔJ| ≤ C h^r on K, so
MSE ≤ C² h^2r, and |Λ| ≤ exp(N C h^r) − 1 = O(h^(r−1)) with N = T/h. These are upper bounds: Λ may
be smaller. Where consistency itself is not decided, the slope over the grid of step sizes decides
criteria 3 and 4, from the points above the rounding plateau; where that cannot, the answer is
UNDECIDED.
"""

from collections.abc import Sequence
from fractions import Fraction
from math import log10

from verify.arithmetic.arb import ball, precision, slope
from verify.proof.expansion import MOST_ORDERS
from verify.prose import Formula, Number, Prose, join_prose, prose, read_prose
from verify.scenes.results.claim import CriterionResult
from verify.scenes.results.proof_result import ProofResult
from verify.scenes.results.run import RunResult
from verify.verdict import Verdict

NAMES = {
    1: "det J ≡ 1",
    2: "|ΔJ| is of higher order than h",
    3: "the MSE is of higher order than h",
    4: "Λ vanishes with h",
}
_MIN_POINTS = 4
_MARGIN = 0.1  # a slope that passes lies clear of the one that just fails
_NOISE = 1e-6  # of a slope fitted in floats
_PLATEAU = Fraction(1, 100)  # a point is above it where its error bound is below 1 %


def judge(number: int, proof: ProofResult, runs: Sequence[RunResult]) -> CriterionResult:
    """Return the verdict on one criterion; `runs`: the grid's runs of this scheme, if any."""
    verdict, evidence = _judge(number, proof, runs)
    return CriterionResult(number=number, scheme=proof.scheme, verdict=verdict, evidence=evidence)


def _judge(number: int, proof: ProofResult, runs: Sequence[RunResult]) -> tuple[Verdict, Prose]:
    agreement = proof.convergence_order
    if agreement is not None and agreement < 1:
        if proof.verdict is Verdict.REFUTED:
            return Verdict.REFUTED, proof.reason
        if number <= 2 or proof.area_preserving:  # det J ≡ 1 alone makes no scheme
            return Verdict.UNDECIDED, proof.reason
        return _judge_by_slopes(number, runs)
    if proof.area_preserving:
        return Verdict.PROVED, prose("ΔJ ≡ 0 is proved, so ΔJ, MSE and Λ are exactly 0")
    if proof.order is not None:
        witness = join_prose(
            ", ", (prose(Formula(n), " = ", Number(x)) for n, x in proof.witness.items())
        )
        value = prose("; at ", witness, " its coefficient is ", Formula(proof.enclosure))
        evidence = value if witness else Prose()
        if number == 1:
            power = Formula(f"h^{proof.order}")
            return Verdict.REFUTED, prose("ΔJ has order exactly ", power, evidence)
        return _from_order(number, proof.order, prose(", exactly of that order", evidence), runs)
    if number == 1:
        open_ = proof.area_preserving is None
        return Verdict.UNDECIDED if open_ else Verdict.REFUTED, proof.reason
    # A map that agrees with the flow up to h^m has ΔJ = O(h^(m+1)); None: it agrees as far as terms
    # were looked at.
    least = (MOST_ORDERS if agreement is None else agreement) + 1
    so_far = prose(", as the map agrees with the exact flow so far")
    return _from_order(number, least, so_far, runs)


def _from_order(
    number: int, r: int, how: Prose, runs: Sequence[RunResult]
) -> tuple[Verdict, Prose]:
    """Judge criteria 2–4 by ΔJ = O(h^r) with r ≥ 2, which every consistent map has."""
    if number == 2:
        return Verdict.PROVED, prose("ΔJ = O(", Formula(f"h^{r}"), ")", how)
    name, order = ("mse", 2 * r) if number == 3 else ("lambda", r - 1)
    quantity = "MSE" if number == 3 else "Λ"
    bound = read_prose(f"{quantity} = O(`h^{order}`), an upper bound")
    out_of_range = [run for run in runs if run.status == "left range"]
    if out_of_range:
        return Verdict.UNDECIDED, prose(
            bound,
            " on every [0, T] on which the exact solution exists; whether it does on the "
            f"scene's is open, as {len(out_of_range)} of {len(runs)} runs leave the range",
        )
    domain = " on every fixed [0, T] on which the exact solution exists"
    return Verdict.PROVED, prose(bound, domain, _slopes_sentence(name, runs))


def _judge_by_slopes(number: int, runs: Sequence[RunResult]) -> tuple[Verdict, Prose]:
    """Judge by the slopes: criterion 3 requires more than 1, criterion 4 more than 0."""
    name, least = ("mse", 1) if number == 3 else ("lambda", 0)
    slopes = measured_slopes(name, runs)
    if not slopes:
        return Verdict.UNDECIDED, prose(
            f"no proof, and fewer than {_MIN_POINTS} step sizes above the rounding plateau"
        )
    text = prose("measured slope ", _range(slopes), " over the step sizes")
    # Two standard errors each way, and a margin towards the slope that just fails.
    if all(s - 2 * e > least + _MARGIN for s, e in slopes):
        return Verdict.MEASURED, text
    if any(s + 2 * e <= least + _NOISE for s, e in slopes):
        return Verdict.REFUTED, prose(text, f", where more than {least} is asked for")
    return Verdict.UNDECIDED, prose(text, f", too close to {least} to tell")


def _slopes_sentence(name: str, runs: Sequence[RunResult]) -> Prose:
    slopes = measured_slopes(name, runs)
    return prose("; measured slope ", _range(slopes), " over the grid") if slopes else Prose()


def _range(slopes: Sequence[tuple[float, float]]) -> Prose:
    low, high = min(slopes), max(slopes)
    end, between = (low[1], " ± ") if len(slopes) == 1 else (high[0], " … ")
    return prose(Number(f"{low[0]:.2f}"), between, Number(f"{end:.2f}"))


def measured_slopes(name: str, runs: Sequence[RunResult]) -> list[tuple[float, float]]:
    """Return the slope of lg |value| over lg h with its standard error, for each initial value.

    Initial values with too few points above the rounding plateau are left out.
    """
    groups: dict[tuple[str, str], list[tuple[float, float]]] = {}
    with precision():
        for run in runs:
            value = run.values.get(name)
            if value is None or Fraction(value.value) == 0:
                continue
            size = abs(ball(value))
            # Below the plateau of rounding a value says nothing of the power of h.
            if Fraction(value.bound) <= _PLATEAU * abs(Fraction(value.value)):
                point = log10(Fraction(run.step_size)), float(size.log() / 2.302585092994046)
                groups.setdefault((run.start_text("q"), run.start_text("p")), []).append(point)
    usable = [g for g in groups.values() if len({x for x, _ in g}) >= _MIN_POINTS]
    return [slope(points) for points in usable]
