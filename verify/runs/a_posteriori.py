"""A rigorous bound for a long run, from what was carried along with it.

Let z_{k+1} = Φ(z_k) be the exact orbit of the exact step map, ẑ_k the computed one, and
e_k = ẑ_k − z_k, A_k = DΦ(ẑ_k). Then ẑ_{k+1} = Φ(ẑ_k) + r_k with ‖r_k‖ ≤ ε, the rounding of one
step, counted from the kernel's operations over the box that the orbit has visited
(`verify.kernels.rounding`), and by Taylor's theorem

    e_{k+1} = A_k e_k + s_k,   ‖s_k‖ ≤ ε + ½ B ‖e_k‖²,

B a bound of the second derivatives of Φ over that box, widened by the error. Ball arithmetic would
multiply norms of A_k here and lose digits like e^(cT). Instead take any matrices M_k, M_0 = 1, that
nearly follow the tangent map: M_{k+1} = A_k M_k + R_k with ‖R_k‖ ≤ ρ ‖M_k‖
(`verify.kernels.tangent_map` carries them in float64; ρ is counted as ε is). With e_k = M_k x_k,
‖M⁻¹‖ = ‖M‖/|det M| for 2 × 2,

    x_{k+1} = x_k + M_{k+1}⁻¹ (s_k − R_k x_k),

and by Gronwall's lemma, with d = min |det M_k|, S = Σ ‖M_k‖, Q = (ρ/d) Σ ‖M_k‖²,

    ‖x_k‖ ≤ X := e^Q (‖x_0‖ + (S/d) (ε + ½ B E²)),   ‖e_k‖ ≤ E := max ‖M_k‖ X.

For integrable motion ‖M_k‖ grows linearly in time, so E grows like N T² ε, and a run of 2·10⁷ steps
loses some 20 digits and not thousands. The quadratic term is closed by a bootstrap: E* is taken as
twice the bound without it; if with E* in it the bound is at most E*, then by induction over k it
holds for all k, and so does the bound with E* in it. Φ must be defined all over the box.

Norms are those of Euclid: what is carried are the sum and the greatest of F_k² = ‖M_k‖² in
Frobenius' norm, and ‖M_k‖² ≤ g(F_k²), g(y) = (y + (y² − 4d²)^½)/2, as the eigenvalues of MᵀM have
the sum F² and a product of at least d². g is concave, so that Σ g(F_k²) over N + 1 matrices is at
most (N + 1) g(Σ F_k²/(N + 1)), and S ≤ (N Σ ‖M_k‖²)^½. Near the identity g(F²) is half of F²: where
nothing grows the bound is the sum of the roundings, and nothing is lost to norms.

Observables: |D̂_k − D(z_k)| ≤ G ‖e_k‖ + η, with G the greatest gradient of D = 2^s ΔJ over the box
and η its rounding; their sum bounds how log(1 + Λ) moves. The product itself is computed as
P_{k+1} = P_k (1 + ΔĴ_k) + τ_k, so that 1 + ΔĴ_k = P_{k+1}/P_k · (1 − τ_k/P_{k+1}): the
product of the first k factors is P_k but for a factor within exp(± N max |τ|/min P).
"""

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction

import flint

from verify.arithmetic.arb import bounds, in_reach, rational_ball
from verify.arithmetic.flint_precision import working_precision
from verify.arithmetic.number_system import Arithmetic
from verify.kernels.clock import error_of_time
from verify.kernels.rounding import FLOAT, PRECISION, Ball, Rounded, analyse, rounding_of
from verify.kernels.stepping import KernelRun, Outcome
from verify.runs.derivatives import Derivatives, norm

_MOST_GROWTH = 50  # of Q: beyond it e^Q says nothing
METHOD = "a-posteriori bound with the tangent map carried along"


@dataclass(frozen=True)
class _Steps:
    """One step's rounding: of the state, of D, of the tangent map relative to its size."""

    state: Ball
    delta_j: Ball
    tangent: Ball
    size: Ball  # a bound of |D|


def certify(
    run: KernelRun, arithmetic: Arithmetic, outcome: Outcome, note: int = -1
) -> dict[str, Fraction] | None:
    """Bounds of the errors of a run's final values, rigorous; None where there is none.

    Or of those at the checkpoint of index `note`. The run must have carried the tangent map. Errors
    are those against the exact orbit of the exact map for the exact h, parameters and initial
    values.
    """
    with working_precision(PRECISION):
        return _Certificate(run, arithmetic, outcome, note).bounds()


class _Certificate:
    def __init__(self, run: KernelRun, arithmetic: Arithmetic, outcome: Outcome, note: int) -> None:
        assert outcome.kernel is not None  # noqa: S101 - the caller's condition
        self.run, self.arithmetic, self.kernel = run, arithmetic, outcome.kernel
        self.shift = outcome.shift
        self.steps = int(outcome.tangents[note]["done"])
        self.values = outcome.trail[note]
        self.seen = {n: rational_ball(x) for n, x in outcome.tangents[note].items()}
        self.h = rational_ball(run.start["h"])
        self.unit = flint.arb(2) ** -arithmetic.bits

    # -- the orbit ----------------------------------------------------------------------------

    def bounds(self) -> dict[str, Fraction] | None:
        derivatives = Derivatives.of(self.run.hamiltonian, self.run.scheme)
        steps = self.one_step()
        if derivatives is None or steps is None:
            return None
        orbit = self.orbit(steps, derivatives)
        if orbit is None:
            return None
        error, summed = orbit
        found = {"p": error, "q": error} | self.observables(steps, derivatives, error, summed)
        return {name: bounds(x)[1] for name, x in found.items() if in_reach(x)}

    def box(self, margin: Ball) -> dict[str, Ball]:
        """The states visited, widened; float64's rounding of them is within 2^−50."""
        around = flint.arb(0, 1)
        found = {}
        for n in ("p", "q"):
            low, high = self.seen[f"{n}_low"], self.seen[f"{n}_high"]
            rounded = flint.arb(2) ** -50 * (1 + abs(low) + abs(high))
            found[n] = low.union(high) + around * (margin + rounded)
        return found

    def one_step(self) -> _Steps | None:
        kernel, program = self.kernel, self.kernel.lowering.program
        if kernel.tangent is None or self.arithmetic.rounding is None:
            return None
        live = kernel.lowering.live(kernel.roots)
        found = analyse(program, live, self.inputs(), rounding_of(self.arithmetic))
        if found is None:
            return None
        values = {name: found[index] for name, index in kernel.outputs.items()}
        tangent = self.one_tangent(found)
        if tangent is None:
            return None
        # ε is Euclid's norm of what both components lose.
        added = [self.adding(name, values[f"d{name}"]) for name in ("p", "q")]
        return _Steps(norm(added), values["dj"].error, tangent, values["dj"].magnitude)

    def times(self) -> Ball:
        """All times at which a step is made."""
        turns = self.run.turns(self.arithmetic)
        if turns:
            first, last = map(rational_ball, turns.times)
            return first.union(last)
        begun = rational_ball(self.run.start.get("t", Fraction(0)))
        return begun.union(begun + self.steps * self.h)

    def inputs(self) -> dict[str, Rounded]:
        """The state, which is data and has no error, and h, t and the parameters as rounded."""
        given = {n: Rounded(x, flint.arb(0)) for n, x in self.box(flint.arb(0)).items()}
        for name, exact in self.run.inputs(self.kernel, self.shift).items():
            lost = self.arithmetic.exact(self.arithmetic.number(exact)) - exact
            given[name] = Rounded(rational_ball(exact), rational_ball(abs(lost)))
        if self.kernel.timed:
            latest = abs(self.run.start["t"]) + self.steps * self.run.start["h"]
            given["t"] = Rounded(
                self.times(), rational_ball(error_of_time(self.arithmetic, latest))
            )
        return given

    def adding(self, name: str, increment: Rounded) -> Ball:
        """The error of a component's increment, and of adding it."""
        if self.arithmetic.absolute:
            return increment.error
        size = self.box(flint.arb(0))[name].abs_upper() + increment.magnitude
        return increment.error + size * self.unit

    def one_tangent(self, main: Mapping[int, Rounded]) -> Ball | None:
        """ρ: the error of one step of the tangent map, relative to ‖M‖."""
        tangent = self.kernel.tangent
        assert tangent is not None  # noqa: S101 - the caller's condition
        # A's entries come from wide numbers turned into float64, each with an error of its own.
        unit = flint.arb(2) ** -52
        inputs = {}
        for at in tangent.needed:
            x = main[at]
            lost = x.magnitude * unit + flint.arb(2) ** -96
            inputs[f"approx(v{at})"] = Rounded(x.interval, x.error + lost)
        live = tangent.lowering.live(tangent.change)
        found = analyse(tangent.program, live, inputs, FLOAT)
        if found is None:
            return None
        entries = [found[index] for index in tangent.change]
        size, error = norm(x.magnitude for x in entries), norm(x.error for x in entries)
        # Two products, their sum, and its sum with M's rest are rounded; the rest is left out of
        # the products. That is 4 times half a unit, and what is of second order.
        return ((error + 3 * unit * size) * (1 + unit) + unit * unit).abs_upper()

    def orbit(self, steps: _Steps, derivatives: Derivatives) -> tuple[Ball, Ball] | None:
        """(a bound of ‖e_k‖ for all k, one of Σ ‖e_k‖)."""
        seen, count = self.seen, self.steps
        slack = 1 + flint.arb(count) * flint.arb(2) ** -50  # of float64's own sums
        growth, highest = seen["growth"] * slack, seen["growth_top"] * slack
        least = seen["det_low"] - flint.arb(2) ** -48 * seen["growth_top"]
        if not (growth.is_finite() and least > 0):
            return None
        # Q: it multiplies every bound by e^Q, so that a large one says nothing.
        rate = steps.tangent * growth / least
        if not rate < _MOST_GROWTH:
            return None
        top = _square_of_norm(highest, least).sqrt()
        path = (count * (count + 1) * _square_of_norm(growth / (count + 1), least)).sqrt()
        # X without its quadratic term. Twice the error that it gives is E*, over which B is taken.
        alone = rate.exp() * (self.first_error() + path / least * steps.state)
        error = (2 * top * alone).abs_upper()
        second = derivatives.second(self.values_of_inputs(), self.box(error))
        start = (alone + rate.exp() * path / least * second * error * error / 2).abs_upper()
        # The bootstrap: with E* in the quadratic term the bound must stay within E*.
        if not top * start <= error:
            return None
        return (top * start).abs_upper(), (start * path).abs_upper()

    def first_error(self) -> Ball:
        start, number, exact = self.run.start, self.arithmetic.number, self.arithmetic.exact
        lost = [rational_ball(exact(number(start[n])) - start[n]) for n in ("p", "q")]
        return norm(lost)

    def values_of_inputs(self) -> dict[str, Ball]:
        named = {n: rational_ball(x) for n, x in self.run.parameters.items()}
        time = {"t": self.times()} if self.kernel.timed else {}
        return {"h": self.h, **named, **time}

    # -- the observables ----------------------------------------------------------------------

    def observables(
        self, steps: _Steps, derivatives: Derivatives, error: Ball, summed: Ball
    ) -> dict[str, Ball]:
        asked, count = self.run.observables, self.steps
        if not asked & {"delta_j_max", "mse", "lambda", "lambda_max"}:
            return {}
        scale = flint.arb(2) ** -self.shift
        slope = derivatives.gradient(self.values_of_inputs(), self.box(error)) / scale
        moved = slope * summed + count * steps.delta_j  # Σ |D̂_k − D(z_k)|
        # A square differs by at most |x − y| (|x| + |y|), each at most `size`.
        size = steps.size + slope * error
        result = {}
        if "delta_j_max" in asked:
            result["delta_j_max"] = scale * (slope * error + steps.delta_j)
        if "mse" in asked:
            added = self.added(
                rational_ball(self.values["mse"]) * count / scale / scale, size * size
            )
            result["mse"] = scale * scale * (2 * size * moved / count + added)
        if asked & {"lambda", "lambda_max"}:
            # What bounds the error of the last Λ bounds that of each before it: all sums are to N.
            bound = self.of_lambda(moved, size)
            result |= {name: bound for name in ("lambda", "lambda_max") if name in asked}
        return {name: x.abs_upper() for name, x in result.items()}

    def added(self, total: Ball, term: Ball) -> Ball:
        """The rounding of one term and of its addition to a sum of non-negative terms."""
        return self.unit if self.arithmetic.absolute else self.unit * (total + term) * 2

    def of_lambda(self, moved: Ball, size: Ball) -> Ball:
        scale, count = flint.arb(2) ** -self.shift, self.steps
        low, high = self.seen["least"], self.seen["most"]
        largest, jump = abs(low).max(abs(high)), scale * size
        # Logarithms of the factors and of the product are taken: both must stay positive.
        if not (jump < 1 and low > -1):
            return flint.arb.nan()
        drift = count * self.of_product(scale, jump, largest) / (1 + low)
        shift = (scale * moved / (1 - jump)).expm1() * drift.exp() * (1 + high)
        apart = drift.expm1() * (1 + high)  # of 1 + Λ and the product of the computed factors
        if self.arithmetic.absolute:
            return shift + scale * count * (size * apart + self.unit)
        return shift + apart

    def of_product(self, scale: Ball, jump: Ball, largest: Ball) -> Ball:
        """The rounding of one step of Λ ← Λ + ΔJ + Λ ΔJ."""
        if self.arithmetic.absolute:
            # D Λ is rounded in D + D Λ, which is summed, and 2^−s (D + D Λ), which Λ adds, is cut.
            return self.unit * (1 + scale)
        return self.unit * (1 + self.unit) * (largest + 2 * jump * (1 + largest))


def _square_of_norm(squares: Ball, least: Ball) -> Ball:
    """A bound of ‖M‖², from those of the sum of its entries' squares and of its determinant; or one
    of the mean of ‖M‖² over several M, from that of those sums."""
    return ((squares + (squares * squares - 4 * least * least).abs_upper().sqrt()) / 2).abs_upper()
