"""A rigorous bound for a long run, from its tangent map and records, in n degrees of freedom.

Let z_{k+1} = Φ(z_k) be the exact orbit of the exact step map, ẑ_k the computed one, and
e_k = ẑ_k − z_k, A_k = DΦ(ẑ_k). Then ẑ_{k+1} = Φ(ẑ_k) + r_k with ‖r_k‖ ≤ ε, the rounding of one
step, a bound counted from the kernel's operations over the box that the orbit has visited
(`verify.runs.step_bounds`), and by Taylor's theorem

    e_{k+1} = A_k e_k + s_k,   ‖s_k‖ ≤ ε + ½ B ‖e_k‖²,

B a bound of the second derivatives of Φ over that box, widened by the error. Ball arithmetic would
multiply norms of A_k here and lose digits like e^(cT). Instead take any matrices M_k, M_0 = 1, that
nearly follow the tangent map: M_{k+1} = A_k M_k + R_k with ‖R_k‖ ≤ ρ ‖M_k‖
(`verify.kernels.step.tangent_map` carries them in float64; ρ is counted as ε is). With
e_k = M_k x_k, ‖M⁻¹‖ = ‖M‖/|det M| for 2 × 2 (for more, `matrix_growth.least_of`),

    x_{k+1} = x_k + M_{k+1}⁻¹ (s_k − R_k x_k),

and by Gronwall's lemma, with d = min |det M_k|, S = Σ ‖M_k‖, Q = (ρ/d) Σ ‖M_k‖²,

    ‖x_k‖ ≤ X := e^Q (‖x_0‖ + (S/d) (ε + ½ B E²)),   ‖e_k‖ ≤ E := max ‖M_k‖ X.

For integrable motion ‖M_k‖ grows linearly in time, so E grows like N T² ε, and a run of 2·10⁷ steps
loses some 20 digits and not thousands. The quadratic term is closed by a bootstrap: E* is taken as
twice the bound without it; if with E* in it the bound is at most E*, then by induction over k it
holds for all k, and so does the bound with E* in it. Φ must be defined all over the box.

Norms are Euclidean: the run carries the sum and the greatest of F_k² = ‖M_k‖² in
Frobenius' norm, and ‖M_k‖² ≤ g(F_k²), g(y) = (y + (y² − 4d²)^½)/2, as the eigenvalues of MᵀM have
the sum F² and a product of at least d². g is concave, so that Σ g(F_k²) over N + 1 matrices is at
most (N + 1) g(Σ F_k²/(N + 1)), and S ≤ (N Σ ‖M_k‖²)^½. Near the identity g(F²) is half of F²: where
nothing grows the bound is the sum of the roundings, and nothing is lost to norms.

Where a flow contracts volume, M is soon singular to float64. There it begins anew with 1 at each
note of the run: the bound above holds in each section, and ‖M‖ X of its last matrix takes the place
of ‖x_0‖ in the next one (`verify.runs.restarted_certificate`).

Observables: |D̂_k − D(z_k)| ≤ G ‖e_k‖ + η, with G the greatest gradient of D = 2^s ΔJ over the box
and η its rounding; their sum bounds how log(1 + Λ) moves. The product itself is computed as
P_{k+1} = P_k (1 + ΔĴ_k) + τ_k, so that 1 + ΔĴ_k = P_{k+1}/P_k · (1 − τ_k/P_{k+1}): the
product of the first k factors is P_k but for a factor within exp(± N max |τ|/min P).
"""

from fractions import Fraction
from functools import cached_property

import flint

from verify import observables
from verify.arithmetic.arb import bounds, is_representable, rational_ball
from verify.arithmetic.flint_precision import working_precision
from verify.arithmetic.number_system import Arithmetic
from verify.kernels.rounding import PRECISION_BITS, Ball
from verify.kernels.statements import integrals_of, needs_of
from verify.kernels.stepping import KernelRun, RunOutcome
from verify.runs import matrix_growth
from verify.runs.orbit_bound import OrbitBound
from verify.runs.step_bounds import StepDerivatives, norm

METHOD = "a-posteriori bound with the tangent map carried along"


def certify(
    run: KernelRun, arithmetic: Arithmetic, outcome: RunOutcome, note: int = -1
) -> dict[str, Fraction] | None:
    """Return rigorous bounds of the errors of a run's final values; None if there is none.

    With `note` the values are those at the checkpoint of that index. The run must have carried the
    tangent map. Errors are measured from the exact orbit of the exact map for the exact h,
    parameters and initial values.
    """
    with working_precision(PRECISION_BITS):
        return _Certificate(run, arithmetic, outcome, note).bounds()


class _Certificate(OrbitBound):
    """The quantities that bound observables; see `verify.observables.observable.Certificate`.

    `error` is E of the module's text, and `error_sum` a bound of Σ ‖e_k‖.
    """

    error: Ball
    error_sum: Ball

    def bounds(self) -> dict[str, Fraction] | None:
        """Return the bounds by name, of each value that has one; None if the orbit has none."""
        derivatives, rounding_errors = self._derivatives(), self.rounding.errors()
        if derivatives is None or rounding_errors is None:
            return None
        self.derivatives, self.rounded = derivatives, rounding_errors
        orbit = self.orbit()
        if orbit is None:
            return None
        self.error, self.error_sum = orbit
        balls = dict.fromkeys(self.names, self.error)
        for observable in observables.select(self.run.observables):
            bound = observable.bound(self) if observable.bound else None
            if bound is not None:
                balls[observable.name] = bound.abs_upper()
        return {name: bounds(x)[1] for name, x in balls.items() if is_representable(x)}

    def _derivatives(self) -> StepDerivatives | None:
        """Return the derivatives of the step; None if they are not available."""
        hamiltonian, scheme, needs = (
            self.run.hamiltonian,
            self.run.scheme,
            needs_of(self.run.observables),
        )
        volume, form = "delta_j" in needs, bool(needs & {"symplectic", "carried"})
        return StepDerivatives.from_scheme(hamiltonian, scheme, volume=volume, form=form)

    # -- the observables ----------------------------------------------------------------------

    @cached_property
    def _box(self) -> tuple[dict[str, Ball], dict[str, Ball]]:
        """The constants of the run, and the box of the states it visited, widened by the error."""
        return self.rounding.constants(), self.rounding.box(self.error)

    @cached_property
    def slope(self) -> Ball:
        """A bound of the gradient of D = 2^s ΔJ, where `scale` is 2^−s."""
        return self.derivatives.gradient(*self._box) / self.scale

    @cached_property
    def size(self) -> Ball:
        """A bound of |D|, at computed and at true states."""
        return self.rounded.size + self.slope * self.error

    @cached_property
    def sum_of_shifts(self) -> Ball:
        """A bound of Σ |D̂_k − D(z_k)|."""
        return self.slope * self.error_sum + self.steps * self.rounded.delta_j

    def total(self, name: str) -> Ball:
        """Return the computed value of an observable."""
        return rational_ball(self.values[name])

    def adding(self, total: Ball, term: Ball) -> Ball:
        """Return a bound of the rounding of a term ≥ 0 and of its addition to a sum ≥ 0."""
        return self.unit if self.arithmetic.absolute else self.unit * (total + term) * 2

    # -- S and W: see `verify.runs.matrix_growth` ---------------------------------------------

    @cached_property
    def _form(self) -> tuple[Ball, Ball]:
        return self.derivatives.form(*self._box)

    def slope_of_form(self) -> Ball:
        """Return a bound of the gradients of S."""
        return self._form[1]

    def bound_of_form(self) -> Ball | None:
        """Return a bound of the error of W."""
        motion, rounding, values = self.motion, self.rounding, self.rounded.values
        if motion is None:
            return None
        size, slope = self._form
        most = matrix_growth.MOST * motion.top
        entries = [x for name, x in values.items() if name.startswith("dw_")]
        largest = flint.arb(0)
        for x in entries:
            largest = largest.max(rounding.error_of_addition(most * most / self.scale, x))
        return matrix_growth.bound_total_defect(
            motion,
            error_sum=self.error_sum,
            second=self.derivatives.second(*self._box),
            size=size,
            slope=slope,
            matrix_rounding=self._matrix_rounding(motion.top),
            entry_rounding=self.scale * largest,
        )

    def _matrix_rounding(self, top: Ball) -> Ball:
        """Return a bound of the rounding of one step of Ĵ; `top`: max ‖M‖."""
        rounding, most = self.rounding, matrix_growth.MOST * top
        names = (f"d{name}" for name in rounding.kernel.matrix)
        return norm(rounding.error_of_addition(most, self.rounded.values[n]) for n in names)

    @cached_property
    def error_of_matrix(self) -> Ball:
        """A bound of the error of M at the end."""
        motion, second = self.motion, self.derivatives.second(*self._box)
        if motion is not None:
            rounding = self._matrix_rounding(motion.top)
            return matrix_growth.bound_matrix(motion, self.error_sum, second, rounding)
        top, rounding = self.rounding.top, self._matrix_rounding(self.rounding.top)
        return matrix_growth.bound_matrix_in_sections(
            self.sections or [], top, second * self.error, rounding
        )

    def bound_of_defect(self, name: str) -> Ball:
        """Return a bound of the error of an accumulated defect: the distance of its value from the
        defects of all z_N, and M or Λ, that are within their bounds."""
        (observable,), around = observables.select({name}), flint.arb(0, 1)
        of_volume = observable.carried == "lam"
        other = self.bound_of_product() if of_volume else self.error_of_matrix
        if not other.is_finite():
            return other

        def read(number: str) -> Ball:
            if number in self.names:
                return rational_ball(self.values[number]) + around * self.error
            scale = self.scale if of_volume else 1  # Λ was carried as 2^s Λ
            return scale * rational_ball(self.noted[number]) + around * other

        # W = MᵀΩM − Ω cancels: the balls need the digits of the run.
        with working_precision(self.arithmetic.bits + PRECISION_BITS):
            return self.run.accumulate(observable, self.steps, read) - self.total(name)

    # -- functions of the state -------------------------------------------------------------------

    def bound_of_change(self, integral: str) -> Ball:
        """Return a bound of the error of I − I₀ at the end: G E, G the greatest gradient of I.

        I is evaluated at the computed state; it and I₀ are off by their last bits alone, also where
        I₀ is rounded for the loop.
        """
        function, constants = self.run.integral(integral), self.rounding.constants()
        box = constants | self.run.in_user_names(self.rounding.box(self.error, last=True))
        slopes, value = function.slopes(box), function.enclose(box)
        if slopes is None or value is None:
            return flint.arb.nan()
        last_bits = 4 * self.unit * (1 + value.abs_upper())
        return norm(slopes) * self.error + last_bits

    def bound_of_greatest_change(self, integral: str) -> Ball:
        """Return a bound of the error of max |I − I₀|: G E and the rounding of I in the loop."""
        name = f"e{integrals_of(self.run.observables).index(integral)}"
        return self.bound_of_change(integral) + self.rounded.values[name].error

    # -- Λ ----------------------------------------------------------------------------------------

    def bound_of_product(self) -> Ball:
        """Return a bound of the error of Λ."""
        scale, count = self.scale, self.steps
        low, high = self.records["least"], self.records["most"]
        largest, jump = abs(low).max(abs(high)), scale * self.size
        rounding, least = self.of_product(scale, jump, largest), self.least_product
        shift = apart = flint.arb.nan()
        # The bound takes logarithms of the factors and of the product: both must be positive.
        if jump < 1 and least > 0:
            drift = count * rounding / least
            shift = (scale * self.sum_of_shifts / (1 - jump)).expm1() * drift.exp() * (1 + high)
            # The distance of 1 + Λ from the product of the computed factors.
            apart = drift.expm1() * (1 + high)
        if not shift + apart < least:
            # Volume is almost nothing, or far from 1. Without logarithms the distance δ of the
            # products obeys δ_{k+1} = δ_k (1 + ΔJ_k) + P_k (ΔĴ_k − ΔJ_k) + τ_k.
            shift = scale * self.sum_of_shifts * abs(1 + low).max(1 + high)
            apart = self.largest_factor**count * (shift + count * rounding)
        if self.arithmetic.absolute:
            return shift + scale * count * (self.size * apart + self.unit)
        return shift + apart

    @property
    def least_product(self) -> Ball:
        """The least 1 + Λ, which may be far below the last bit of 1."""
        return rational_ball(1 + self.noted["least"])

    @property
    def largest_factor(self) -> Ball:
        """A bound of |1 + ΔJ| at the true states; 1 where it is less."""
        around = flint.arb(0, 1) * (self.slope * self.error)
        delta_j = self.scale * (self.rounded.values["dj"].interval + around)
        return abs(1 + delta_j).abs_upper().max(flint.arb(1))

    def of_product(self, scale: Ball, jump: Ball, largest: Ball) -> Ball:
        """Return the rounding of one step of Λ ← Λ + ΔJ + Λ ΔJ."""
        if self.arithmetic.absolute:
            # Two roundings: of D Λ in the sum D + D Λ, and of 2^−s (D + D Λ), which is added to Λ.
            return self.unit * (1 + scale)
        return self.unit * (1 + self.unit) * (largest + 2 * jump * (1 + largest))
