"""A rigorous bound for a long run, from what was carried along with it, in any number of degrees.

Let z_{k+1} = Φ(z_k) be the exact orbit of the exact step map, ẑ_k the computed one, and
e_k = ẑ_k − z_k, A_k = DΦ(ẑ_k). Then ẑ_{k+1} = Φ(ẑ_k) + r_k with ‖r_k‖ ≤ ε, the rounding of one
step, counted from the kernel's operations over the box that the orbit has visited
(`verify.kernels.rounding`), and by Taylor's theorem

    e_{k+1} = A_k e_k + s_k,   ‖s_k‖ ≤ ε + ½ B ‖e_k‖²,

B a bound of the second derivatives of Φ over that box, widened by the error. Ball arithmetic would
multiply norms of A_k here and lose digits like e^(cT). Instead take any matrices M_k, M_0 = 1, that
nearly follow the tangent map: M_{k+1} = A_k M_k + R_k with ‖R_k‖ ≤ ρ ‖M_k‖
(`verify.kernels.step.tangent_map` carries them in float64; ρ is counted as ε is). With
e_k = M_k x_k, ‖M⁻¹‖ = ‖M‖/|det M| for 2 × 2 (for more, `verify.runs.inverse_norm`),

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
from verify.kernels.kernel import CLOSED_FORM
from verify.kernels.rounding import FLOAT, PRECISION, Ball, Rounded, analyse, rounding_of
from verify.kernels.stepping import KernelRun, Outcome
from verify.runs import form_bound
from verify.runs.derivatives import Derivatives, norm
from verify.runs.derivatives_in_degrees import DerivativesInDegrees
from verify.runs.inverse_norm import least_of, square_of_norm
from verify.scenes.observables import OF_FORM

_MOST_GROWTH = 50  # of Q: beyond it e^Q says nothing
METHOD = "a-posteriori bound with the tangent map carried along"


@dataclass(frozen=True)
class _Steps:
    """One step's rounding: of the state, of D, of the tangent map relative to its size."""

    state: Ball
    delta_j: Ball
    tangent: Ball
    size: Ball  # a bound of |D|
    defect: Ball  # of an entry of S
    values: Mapping[str, Rounded]  # the kernel's outputs


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
        self.names = self.kernel.coordinates

    # -- the orbit ----------------------------------------------------------------------------

    def bounds(self) -> dict[str, Fraction] | None:
        derivatives = self.derivatives()
        steps = self.one_step()
        if derivatives is None or steps is None:
            return None
        orbit = self.orbit(steps, derivatives)
        if orbit is None:
            return None
        error, summed = orbit
        found = dict.fromkeys(self.names, error)
        found |= self.observables(steps, derivatives, error, summed)
        if isinstance(derivatives, DerivativesInDegrees):
            found |= self.of_form(steps, derivatives, error, summed)
        return {name: bounds(x)[1] for name, x in found.items() if in_reach(x)}

    def derivatives(self) -> Derivatives | DerivativesInDegrees | None:
        """Those of the step."""
        exact, scheme, asked = self.run.hamiltonian, self.run.scheme, self.run.observables
        if exact.planar:
            return Derivatives.of(exact, scheme)
        volume, form = bool(asked & CLOSED_FORM), bool(asked & {*OF_FORM})
        return DerivativesInDegrees.of(exact, scheme, volume=volume, form=form)

    def box(self, margin: Ball) -> dict[str, Ball]:
        """The states visited, widened; float64's rounding of them is within 2^−50."""
        around = flint.arb(0, 1)
        found = {}
        for n in self.names:
            low, high = self.seen[f"{n}_low"], self.seen[f"{n}_high"]
            rounded = flint.arb(2) ** -50 * (1 + abs(low) + abs(high))
            found[n] = low.union(high) + around * (margin + rounded)
        return found

    def one_step(self) -> _Steps | None:
        kernel, program = self.kernel, self.kernel.lowering.program
        if kernel.tangent is None or self.arithmetic.rounding is None:
            return None
        live = kernel.lowering.live(kernel.roots)
        found = analyse(program, live, self.inputs() | self.matrix(), rounding_of(self.arithmetic))
        if found is None:
            return None
        values = {name: found[index] for name, index in kernel.outputs.items()}
        tangent = self.one_tangent(found)
        if tangent is None:
            return None
        # ε is Euclid's norm of what both components lose.
        sizes = self.box(flint.arb(0))
        added = norm(self.adding(sizes[n].abs_upper(), values[f"d{n}"]) for n in self.names)
        changed, defect = values["dj"], flint.arb(0)
        for index in kernel.defect.values():
            defect = defect.max(found[index].error)
        return _Steps(added, changed.error, tangent, changed.magnitude, defect, values)

    def matrix(self) -> dict[str, Rounded]:
        """The entries of M where it is carried: data too, within the box of `form_bound`."""
        most = form_bound.MOST * self.seen["growth_top"].abs_upper().sqrt()
        box = flint.arb(0, 1) * most * (1 + flint.arb(2) ** -10)
        return {name: Rounded(box, flint.arb(0)) for name in self.kernel.matrix}

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

    def adding(self, size: Ball, increment: Rounded) -> Ball:
        """The error of an increment, and of adding it to what is of that size."""
        if self.arithmetic.absolute:
            return increment.error
        return increment.error + (size + increment.magnitude) * self.unit

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
        # 2n products, their sum, and its sum with M's rest are rounded; the rest is left out of the
        # products. That is 2n + 2 times half a unit, and what is of second order.
        units = len(self.names) // 2 + 2
        return ((error + units * unit * size) * (1 + unit) + unit * unit).abs_upper()

    def motion(self, steps: _Steps) -> form_bound.Motion | None:
        """How M has grown; None where nothing follows from it."""
        seen, count, size = self.seen, self.steps, len(self.names)
        # Of float64's own sums, over the steps and in each sum of squares.
        slack = 1 + flint.arb(count + size - 2) * flint.arb(2) ** -50
        growth, highest = seen["growth"] * slack, seen["growth_top"] * slack
        least = least_of(size, seen)
        if not (growth.is_finite() and least > 0):
            return None
        # Q: it multiplies every bound by e^Q, so that a large one says nothing.
        rate = steps.tangent * growth / least
        if not rate < _MOST_GROWTH:
            return None
        top = square_of_norm(size, highest, least).sqrt()
        mean = square_of_norm(size, growth / (count + 1), least)
        return form_bound.Motion(count, least, rate, top, (count * (count + 1) * mean).sqrt())

    def orbit(
        self, steps: _Steps, derivatives: Derivatives | DerivativesInDegrees
    ) -> tuple[Ball, Ball] | None:
        """(a bound of ‖e_k‖ for all k, one of Σ ‖e_k‖)."""
        motion = self.motion(steps)
        if motion is None:
            return None
        least, rate, top, path = motion.least, motion.rate, motion.top, motion.path
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
        lost = [rational_ball(exact(number(start[n])) - start[n]) for n in self.names]
        return norm(lost)

    def values_of_inputs(self) -> dict[str, Ball]:
        named = {n: rational_ball(x) for n, x in self.run.parameters.items()}
        time = {"t": self.times()} if self.kernel.timed else {}
        return {"h": self.h, **named, **time}

    # -- the observables ----------------------------------------------------------------------

    def of_form(
        self, steps: _Steps, derivatives: DerivativesInDegrees, error: Ball, summed: Ball
    ) -> dict[str, Ball]:
        """S and W; see `verify.runs.form_bound`."""
        asked, scale = self.run.observables, flint.arb(2) ** -self.shift
        if not asked & {*OF_FORM}:
            return {}
        fixed, box = self.values_of_inputs(), self.box(error)
        size, slope = derivatives.form(fixed, box)
        result = {}
        if "symplectic_defect_max" in asked:
            result["symplectic_defect_max"] = slope * error + scale * steps.defect
        motion = self.motion(steps)
        if "symplectic_defect" in asked and motion is not None:
            most = form_bound.MOST * motion.top
            matrix = (self.adding(most, steps.values[f"d{x}"]) for x in self.kernel.matrix)
            entries = [x for name, x in steps.values.items() if name.startswith("dw_")]
            largest = flint.arb(0)
            for x in entries:
                largest = largest.max(self.adding(most * most / scale, x))
            result["symplectic_defect"] = form_bound.of_form(
                motion,
                summed=summed,
                second=derivatives.second(fixed, box),
                size=size,
                slope=slope,
                of_matrix=norm(matrix),
                of_entry=scale * largest,
            )
        return {name: x.abs_upper() for name, x in result.items()}

    def observables(
        self,
        steps: _Steps,
        derivatives: Derivatives | DerivativesInDegrees,
        error: Ball,
        summed: Ball,
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
