"""The step map of an implicit Runge–Kutta method, for any H.

The unknowns are Z_i = Y_i − z, Y_i the points at which the stages' slopes are taken: they are of
the size of h, so that their rounding is h times smaller than that of Y_i (Hairer, Nørsett, Wanner,
Solving Ordinary Differential Equations I, II.8, and II, IV.8). Z_i = h Σ a_ij f(z + Z_j), and
z' = z + h Σ b_i f(z + Z_i). Newton's method begins at Z_i = h c_i f(z); of several solutions, which
there may be where h is large, it finds one, and that is the map. For a quadratic H the equations
are linear, and the map is written in closed form. Where H depends on time, stage i is taken at
t + c_i h, c_i = Σ_j a_ij.
"""

from collections.abc import Sequence
from functools import lru_cache

import sympy

from verify.algebra.implicit_unknowns import Matrix, define, unknowns
from verify.algebra.ring import Poly
from verify.algebra.symbols import H_STEP, P, Q
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.schemes.conditions import ByConditions
from verify.schemes.every_hamiltonian import BySeries
from verify.schemes.implicit_tableau import ImplicitTableau, implicit_step
from verify.schemes.scheme import Scheme
from verify.schemes.stages import Point, Stages
from verify.schemes.step_algebra import series_in_plane
from verify.schemes.step_map import Expanded, StepMap, Substep
from verify.schemes.tree_order import order_of

_NAMES_PER_STAGE = 100
_MU, _SQUARE = sympy.symbols("mu square")  # an eigenvalue of hM, and its square


def implicit(
    name: str,
    tableau: ImplicitTableau,
    every_h: BySeries | ByConditions,
    *,
    order: int,
    source: str,
) -> Scheme:
    """The scheme of these coefficients, those of a Gauss method: symmetric, and of det J ≡ 1."""
    return Scheme(
        name=name,
        order=order,
        area_preserving=True,
        explicit=False,
        symmetric=True,
        source=source,
        build=lambda hamiltonian: implicit_map(hamiltonian, tableau),
        every_h=every_h,
    )


@lru_cache(maxsize=64)
def implicit_map(hamiltonian: Hamiltonian, tableau: ImplicitTableau) -> StepMap:
    """The map: in closed form where H is quadratic, else by its equations."""
    closed = None if hamiltonian.time_dependent else _linear(hamiltonian, tableau)
    return closed or _Equations(hamiltonian, tableau).step_map()


class _Equations:
    def __init__(self, hamiltonian: Hamiltonian, tableau: ImplicitTableau) -> None:
        self.hamiltonian, self.tableau, self.count = hamiltonian, tableau, tableau.stages
        numbers = [x for row in (*tableau.rows, tableau.weights) for x in row]
        self.source, self.numbers = hamiltonian.field(*numbers)
        self.stages = Stages(self.source, self.count, _NAMES_PER_STAGE * self.count)
        at = self.stages.at(self.stages.start)
        exact = [at(x) for x in self.numbers]
        rows = [exact[self.count * i : self.count * (i + 1)] for i in range(self.count + 1)]
        self.a, self.b = rows[:-1], rows[-1]
        self.clocks = [sum(row, self.stages.ring.zero) for row in self.a]  # of the stages

    def step_map(self) -> StepMap:
        stages, ring, count = self.stages, self.stages.ring, self.count
        h = ring.variable("h")
        own = unknowns(ring, 2 * count)
        slopes, gradients, drifts = self._at_stages(own)
        pairs = [(i, part) for i in range(count) for part in (0, 1)]

        def mean(weights: Sequence[Poly], part: int) -> Poly:
            """Σ w_j f_part(Y_j)."""
            terms = zip(weights, slopes, strict=True)
            return ring.reduce(sum((w * slope[part] for w, slope in terms), ring.zero))

        means = [mean(self.a[i], part) for i, part in pairs]
        # h A ⊗ f': ∂F/∂Z is 1 less it, and ∂F/∂z the sum of its columns with the sign changed.
        change = [
            [ring.reduce(h * self.a[i][j] * gradients[j][r][c]) for j, c in pairs] for i, r in pairs
        ]
        force = [ring.named(x) for x in (-stages.field.h_q, stages.field.h_p)]

        def later(i: int, part: int, clocks: Sequence[Poly]) -> Poly:
            """h Σ a_ij f_part,t(Y_j) by what the stages' times move."""
            terms = zip(self.a[i], drifts, clocks, strict=True)
            return ring.reduce(h * sum((a * x[part] * c for a, x, c in terms), ring.zero))

        def by_h() -> list[Poly]:
            if not drifts:
                return [-y for y in means]
            late = [later(i, part, self.clocks) for i, part in pairs]
            return [-y - x for y, x in zip(means, late, strict=True)]

        by_t = {"t": lambda: [-later(i, part, [ring.one] * count) for i, part in pairs]}
        define(
            ring,
            own,
            residuals=[x - h * y for x, y in zip(own, means, strict=True)],
            matrix=[[int(k == m) - x for m, x in enumerate(row)] for k, row in enumerate(change)],
            partials={
                "p": lambda: [-sum(row[0::2], ring.zero) for row in change],
                "q": lambda: [-sum(row[1::2], ring.zero) for row in change],
                "h": by_h,
                **(by_t if drifts else {}),
            },
            starts=[h * sum(self.a[i], ring.zero) * force[part] for i, part in pairs],
            added_to=list(stages.start[:2]) * count,
        )
        p_next, q_next = (x + h * mean(self.b, part) for part, x in enumerate(stages.start[:2]))
        step = Substep(stages.field, p_next, q_next, self.tableau.area_conditions())
        return StepMap(self.hamiltonian, (step,), self.taylor, self._known_order)

    def _known_order(self) -> int | None:
        """By rooted trees, which are those of an autonomous H."""
        return None if self.source.timed else order_of(self.tableau, self.source)

    def _at_stages(self, own: Sequence[Poly]) -> tuple[list[Point], list[Matrix], list[Point]]:
        """f and f' at each Y_j, and ∂f/∂t where H depends on time."""
        ring, source = self.stages.ring, self.source
        diff = source.ring.diff
        second = diff(source.h_p, "p"), diff(source.h_q, "p"), diff(source.h_q, "q")
        slopes: list[Point] = []
        gradients: list[Matrix] = []
        drifts: list[Point] = []
        for *z, clock in zip(own[0::2], own[1::2], self.clocks, strict=True):
            change = [*z, ring.variable("h") * clock][: len(self.stages.names)]
            point = [x + y for x, y in zip(self.stages.start, change, strict=True)]
            at = self.stages.at(self.stages.named(tuple(point)))
            slopes.append((ring.named(at(-source.h_q)), ring.named(at(source.h_p))))
            pp, pq, qq = (ring.named(at(x)) for x in second)
            gradients.append([[-pq, -qq], [pp, pq]])
            if source.timed:
                p_t, q_t = (ring.named(at(diff(x, "t"))) for x in (source.h_p, source.h_q))
                drifts.append((-q_t, p_t))
        return slopes, gradients, drifts

    def taylor(self, most: int) -> Expanded:
        """p' and q' up to h^most."""
        count, zero = self.count, self.source.ring.zero
        rows = [self.numbers[count * i : count * (i + 1)] for i in range(count + 1)]
        clocks = [sum(row, zero) for row in rows[:-1]]
        return series_in_plane(self.source, implicit_step(rows[:-1], rows[-1], clocks), most)


def _linear(hamiltonian: Hamiltonian, tableau: ImplicitTableau) -> StepMap | None:
    """The closed form for a quadratic H; None for another.

    f(z + d) = f(z) + M d with M² = −D, D = det Hess H, and z' = z + h ρ(hM) f(z) with
    ρ(μ) = (R(μ) − 1)/μ, R the method's stability function (Hairer, Wanner, II, IV.3). With the
    denominator's product by its own at −μ, which is even, ρ(hM) = (α + β h M)/γ, where α, β and γ
    are polynomials in μ² = −h² D.
    """
    field, _ = hamiltonian.field()
    ring = field.ring
    second = [ring.diff(x, n) for x, n in ((field.h_p, "p"), (field.h_p, "q"), (field.h_q, "q"))]
    if any(ring.decide(ring.diff(x, n)).zero is not True for x in second for n in ("p", "q")):
        return None
    h_p, h_q, h_pp, h_pq, h_qq = map(ring.expression, (field.h_p, field.h_q, *second))
    square = -(H_STEP**2) * (h_pp * h_qq - h_pq**2)
    alpha, beta, gamma = (x.subs(_SQUARE, square) for x in _of_matrix(tableau))
    u, v = -h_q, h_p
    more_u, more_v = -h_pq * u - h_qq * v, h_pp * u + h_pq * v
    p_next = P + H_STEP * (alpha * u + beta * H_STEP * more_u) / gamma
    q_next = Q + H_STEP * (alpha * v + beta * H_STEP * more_v) / gamma
    return StepMap.from_expressions(hamiltonian, p_next, q_next)


@lru_cache(maxsize=64)
def _of_matrix(tableau: ImplicitTableau) -> tuple[sympy.Expr, sympy.Expr, sympy.Expr]:
    """α, β and γ as polynomials in μ²; see `_linear`."""
    count = tableau.stages
    a, b = sympy.Matrix(tableau.rows), sympy.Matrix([tableau.weights])
    left = sympy.eye(count) - _MU * a
    below = sympy.expand(left.det(method="berkowitz"))
    above = sympy.expand((left + _MU * sympy.ones(count, 1) * b).det(method="berkowitz"))
    rho = sympy.expand(sympy.expand(above - below) / _MU)
    mirrored = below.subs(_MU, -_MU)
    numerator, even = (sympy.Poly(sympy.expand(x * mirrored), _MU) for x in (rho, below))
    parts = [sympy.S.Zero] * 2
    for (n,), c in numerator.terms():
        parts[n % 2] += c * _SQUARE ** (n // 2)
    gamma = sum((c * _SQUARE ** (n // 2) for (n,), c in even.terms()), sympy.S.Zero)
    return parts[0], parts[1], gamma
