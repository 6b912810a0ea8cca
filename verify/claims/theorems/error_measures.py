"""What ΔJ, MSE and Λ of Eq. 14–16 measure, and what Criteria 2, 3 and 4 make of them."""

from fractions import Fraction

import sympy

from verify.arithmetic.exact import decimal, text
from verify.claims.theorems.argument import Argument, Check, concluded, vanishes
from verify.claims.theorems.consistency import consistent_map
from verify.claims.theorems.criteria import inequalities_of
from verify.claims.theorems.criteria_examples import (
    FRICTION,
    NOT_UNIFORM,
    TO_AND_FRO,
    ExampleMap,
)
from verify.claims.theorems.differential import flow_of_every_hamiltonian
from verify.claims.theorems.exact_maps import Point, areas, jacobian, next_point, value
from verify.hamiltonians import systems
from verify.schemes.methods.taylor.lie import lie_map
from verify.schemes.step_map import P, Q, StepMap
from verify.verdict import Verdict

_H = Fraction(1, 10)
_START = Point(Fraction(1, 2), Fraction(1))
_ETAS = range(1, 4)


def _duffing() -> StepMap:
    return lie_map(systems.get("duffing").hamiltonian().with_values({"delta": 1}), 2)


# -- what they measure -----------------------------------------------------------------------------


def exact_determinant(most: int = 5, eta: int = 5) -> Argument:
    """det of the exact flow is 1 for a generic H up to h^most; `eta` is of what stands for it."""
    flow = flow_of_every_hamiltonian(most + 1)
    powers = flow.delta_j(*flow.lie(eta))
    zero = flow.ring.zero
    return concluded(
        "eq-14",
        Verdict.PROVED,
        "the exact flow has det = 1 over every step, so det `J_k` − 1 is by how much one step’s "
        "determinant is off, a local error, and the relative change of a small region’s area",
        """Eq. 1 has no divergence, so by Liouville’s theorem the exact flow has determinant 1 at
        every point and over every step. Hence `ΔJ_k` = det `J_k` − 1 is the difference, in step k
        alone, from what is exact; it is 0 up to `h^η` for lieη, whose step agrees with the flow so
        far. By the change of variables a small region around `z_k` of area A has an image of area A
        (1 + `ΔJ_k`) + o(A). ∎""",
        [
            vanishes(
                f"the coefficients of h … `h^{most}` in ΔJ of the flow of a generic H",
                *(powers.get(n, zero) for n in range(1, most + 1)),
            )
        ],
    )


def mean_square(true: int = 1, steps: int = 3) -> Argument:
    """MSE is the mean of (det J − 1)², and 1 is the true value; `true`: what is taken for it."""
    step, point, dets = _duffing(), _START, []
    for _ in range(steps):
        a, b, c, d = jacobian(step, point, _H)
        dets.append(a * d - b * c)
        point = next_point(step, point, _H)
    mean = sum(((x - true) ** 2 for x in dets), Fraction(0)) / steps
    mse = areas(step, _START, _H, steps).mse
    flow = flow_of_every_hamiltonian(4)
    powers = flow.delta_j(*flow.lie(3))
    return concluded(
        "eq-15",
        Verdict.PROVED,
        "Eq. 15 is the mean of the squares of det `J_k` − 1, and 1 is the true value of the "
        "determinant",
        """By Liouville’s theorem the exact flow has determinant 1, so `ΔJ_k` is the calculated
        value less the true one, and Eq. 15 the mean of its squares over the N steps of [t₀,
        `t_end`]. ∎""",
        [
            vanishes(
                "the coefficients of h, h², h³ in ΔJ of the flow of a generic H",
                *(powers.get(n, flow.ring.zero) for n in (1, 2, 3)),
            ),
            Check(
                f"Duffing, δ = 1, lie2, h = {text(_H)}, (p, q) = {_START}, N = {steps}: the mean "
                f"of (det J − {true})², det J from its entries, and the MSE by the closed form",
                mean == mse,
                f"`{decimal(mean, 4)}` and `{decimal(mse, 4)}`",
            ),
        ],
    )


def sum_of_squares(steps: int = 2) -> Argument:
    """The sum of the squares is N times Eq. 15, and another number for N > 1."""
    found = areas(_duffing(), _START, _H, steps)
    total = sum((x * x for x in found.delta_j), Fraction(0))
    return concluded(
        "eq-15-sum",
        Verdict.REFUTED,
        "Eq. 15 is the mean: the sum of the squares is N times as much",
        """Eq. 15 has the factor 1/N. For two steps of lie2 on the Duffing oscillator the sum of the
        squares is twice the MSE. ∎""",
        [
            Check(
                f"Duffing, δ = 1, lie2, h = {text(_H)}, (p, q) = {_START}, N = {steps}: Σ `ΔJ_k`² "
                "and MSE",
                total != found.mse,
                f"`{decimal(total, 4)}` and `{decimal(found.mse, 4)}`",
            )
        ],
    )


def chain_rule(stray: Fraction = Fraction(0)) -> Argument:
    """1 + Λ is the determinant of the map of all N steps; `stray` is added to it."""
    check = _composed(2, stray)
    return concluded(
        "criterion-4",
        Verdict.PROVED,
        "by the chain rule 1 + Λ is the determinant of the map of all N steps at the initial "
        "value, so that Λ → 0, uniformly on a region of initial values, says that areas within it "
        "change by o(1) over the whole of [t₀, `t_end`]",
        """The map of N steps is Φ∘…∘Φ, whose Jacobian at `z_0` is the product of the J at `z_0` …
        `z_{N−1}`; its determinant is Π det `J_k` = 1 + Λ(`z_0`). By the change of variables the
        area of a region’s image after N steps is the integral of 1 + Λ over the region. If |Λ| ≤ ε
        for all of its initial values, then the area changes by ε of it at most. (From one initial
        value alone Λ tells of small regions around that one.) ∎""",
        [check],
    )


def _composed(steps: int, stray: Fraction = Fraction(0)) -> Check:
    step, p_next, q_next = _duffing(), P, Q
    for _ in range(steps):
        put = {P: p_next, Q: q_next}
        p_next, q_next = (x.subs(put, simultaneous=True) for x in (step.p_next, step.q_next))
    entries = [sympy.diff(x, z) for x in (p_next, q_next) for z in (P, Q)]
    a, b, c, d = (value(x, _START, _H) for x in entries)
    det, lam = a * d - b * c + stray, areas(step, _START, _H, steps).lam
    return Check(
        f"Duffing, δ = 1, lie2, h = {text(_H)}, (p, q) = {_START}: the determinant of {steps} "
        "steps, composed and then differentiated, and 1 + Λ",
        det == 1 + lam,
        f"`{decimal(det, 8)}` and `{decimal(1 + lam, 8)}`, exactly equal",
    )


# -- Criteria 2 and 3 ------------------------------------------------------------------------------


def criterion_2(not_small: ExampleMap = NOT_UNIFORM) -> Argument:
    """Criterion 2, uniformly, makes Λ tend to 0."""
    return concluded(
        "criterion-2",
        Verdict.PROVED,
        "if max |`ΔJ_k`| = o(h), then |Λ| ≤ exp(T max |`ΔJ_k`|/h) − 1 → 0 on [t₀, `t_end`]: areas "
        "change by a part of them that vanishes with h; and lieη of a smooth H does satisfy it",
        """With m = max |`ΔJ_k`| and N = T/h, |Λ| ≤ `(1 + m)^N` − 1 ≤ exp(T m/h) − 1, which tends to
        0 if m = o(h); by the chain rule 1 + Λ is the determinant of all N steps. For lieη, of which
        the criterion speaks, `ΔJ_k` = `O(h^(η+1))` uniformly on compact sets. The maximum over k is
        meant: that each single `ΔJ_k` is o(h) is not enough for other maps, such as p' = p(1 + q²),
        q' = q + h, whose Λ over [0, 1] grows beyond all bounds. ∎""",
        [
            *(inequalities_of(each) for each in (FRICTION, TO_AND_FRO)),
            _vanishing(),
            not_small.check(),
        ],
    )


def _vanishing() -> Check:
    flows = {eta: flow_of_every_hamiltonian(eta + 1) for eta in _ETAS}
    low = [
        flow.delta_j(*flow.lie(eta)).get(n, flow.ring.zero)
        for eta, flow in flows.items()
        for n in range(1, eta + 1)
    ]
    return vanishes("the coefficients of h … `h^η` in ΔJ of lieη, η = 1, 2, 3, generic H", *low)


def criterion_3(hamiltonian: bool = True) -> Argument:
    """For lieη, and every smoothly consistent scheme, MSE = o(h) and Λ → 0, both."""
    powers = consistent_map(hamiltonian)
    zero = flow_of_every_hamiltonian(1).ring.zero
    return concluded(
        "criterion-3",
        Verdict.PROVED,
        "for the Lie derivative algorithm of a smooth H both sides of the implication hold: MSE = "
        "`O(h^(2η+2))`, and Λ = `O(h^η)` → 0, so that areas change by o(1)",
        """lieη is smoothly consistent with Eq. 1, so that `ΔJ_k` = `O(h^(η+1))` uniformly on
        compact sets; hence MSE = `O(h^(2η+2))` = o(h), and |Λ| ≤ exp(T `O(h^η)`) − 1 → 0. So
        whenever criterion 3 is satisfied the algorithm is nearly area-preserving; it always is, and
        the criterion excludes nothing. ∎""",
        [
            vanishes(
                "the coefficients of h⁰ and h¹ in ΔJ of a generic smoothly consistent map of a "
                "generic H",
                *(powers.get(n, zero) for n in (0, 1)),
            ),
            _vanishing(),
        ],
    )


def criterion_3_of_any_map(friction: ExampleMap = FRICTION) -> Argument:
    """MSE = o(h), and every area shrinks to a fraction 1/e."""
    return concluded(
        "criterion-3-any-map",
        Verdict.REFUTED,
        "for p' = p − h(q + p), q' = q + hp MSE = h²(1 − h)² = o(h), and over [0, 1] every area "
        "shrinks to a fraction that tends to 1/e",
        """The explicit Euler step of an oscillator with friction has ΔJ = −h + h² at every point,
        so MSE = h²(1 − h)², which is o(h), while 1 + Λ = `(1 − h + h²)^(1/h)` → 1/e over [0, 1]. It
        is no scheme for Eq. 1, of which alone the criterion speaks. ∎""",
        [friction.check()],
    )


# -- “the system with a smaller cumulative error” --------------------------------------------------


def smaller_is_better() -> Argument:
    """|Λ| is by which part areas change after all steps."""
    return concluded(
        "smaller-lambda",
        Verdict.PROVED,
        "after all N steps a small region’s area has changed by |Λ| of it, by the chain rule, so "
        "the smaller |Λ|, the less",
        """1 + Λ is the determinant of the map of all N steps at the initial value, so a small
        region of area A around it ends with the area A (1 + Λ) + o(A). ∎""",
        [_composed(2)],
    )


def smaller_in_each_step(
    to_and_fro: ExampleMap = TO_AND_FRO, friction: ExampleMap = FRICTION
) -> Argument:
    """Of two maps the one with the smaller |Λ| may change areas more in every step."""
    both = [(one.run(n), other.run(n)) for n in to_and_fro.steps
            for one, other in [(to_and_fro, friction)]]  # fmt: skip
    worse = [
        abs(a.lam) < abs(b.lam) and min(map(abs, a.delta_j)) > b.largest and a.mse > b.mse
        for a, b in both
    ]
    return concluded(
        "smaller-lambda-each-step",
        Verdict.REFUTED,
        "a Λ may be small because changes cancel: p' = −p (1 − √h q)/(1 + √h q), q' = −q has Λ = "
        "0 and changes areas more in every single step than p' = p − h(q + p), q' = q + hp, whose "
        "|Λ| tends to 1 − 1/e",
        """Λ is a number at the end. The one map shrinks areas by a factor (1 − √h)/(1 + √h) and
        blows them up by its reciprocal in turn, so Λ = 0 for even N; the other shrinks them by h −
        h² in each step. By criteria 2 and 3 the one is the worse, by criterion 4 the better. ∎""",
        [
            to_and_fro.check(),
            friction.check(),
            Check(
                f"N = {', '.join(map(str, to_and_fro.steps))}: |Λ| is smaller, the least |`ΔJ_k`| "
                "and the MSE are greater",
                all(worse),
                "exactly",
            ),
        ],
    )


THEOREMS = {
    "eq-14": exact_determinant,
    "eq-15": mean_square,
    "eq-15-sum": sum_of_squares,
    "criterion-2": criterion_2,
    "criterion-3": criterion_3,
    "criterion-3-any-map": criterion_3_of_any_map,
    "criterion-4": chain_rule,
    "smaller-lambda": smaller_is_better,
    "smaller-lambda-each-step": smaller_in_each_step,
}
