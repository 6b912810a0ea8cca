"""Unknowns that are given by equations, as generators of a ring.

A system F(Z; p, q, h) = 0 of as many equations as unknowns defines Z near h = 0, where ∂F/∂Z is
the unit matrix. A kernel finds Z by Newton's method, Z ← Z − (∂F/∂Z)⁻¹ F; the derivatives of Z are
those of implicit differentiation, ∂Z/∂z = −(∂F/∂Z)⁻¹ ∂F/∂z. Both solve with the same matrix, in
blocks of one or two rows: blocks are eliminated in their order, a block's own inverse is Cramer's.
On the diagonal the blocks are 1 + O(h), and of a stage of a Runge–Kutta method 1 − h a_ii f', with
the determinant 1 + h² a_ii² det Hess H: where H is convex it does not vanish for any h. Where one
does, Newton's method fails, and the kernel says so.
"""

from collections.abc import Callable, Mapping, Sequence

from verify.algebra.generator import System
from verify.algebra.ring import Poly, Ring
from verify.errors import InputError

Column = list[Poly]
Matrix = Sequence[Sequence[Poly]]


def unknowns(ring: Ring, count: int) -> list[Poly]:
    """New generators, which `define` gives their equations."""
    return [ring.add("solved", None, k) for k in range(count)]


def define(
    ring: Ring,
    own: Sequence[Poly],
    residuals: Sequence[Poly],
    matrix: Matrix,
    partials: Mapping[str, Callable[[], Column]],
    starts: Sequence[Poly],
    added_to: Sequence[Poly],
) -> None:
    """Makes the unknowns `own` the solution of residuals = 0; see `System`.

    `matrix`: ∂F/∂Z, row by row. `partials`: ∂F/∂name with Z held, for p, q and h. Of more unknowns
    than one, every two make a block.
    """
    block = min(2, len(own))
    elimination = Elimination(ring, matrix, block)
    solve = elimination.solve
    columns: dict[str, Column] = {}

    def rule(k: int) -> Callable[[str], Poly]:
        def partial(name: str) -> Poly:
            if name not in partials:
                raise InputError("map", name, "of a map given by equations ∂/∂p, ∂/∂q, ∂/∂h only")
            if name not in columns:
                columns[name] = [-x for x in solve(partials[name]())]
            return columns[name][k]

        return partial

    made = [
        ring.define(unknown, residual, rule(k))
        for k, (unknown, residual) in enumerate(zip(own, residuals, strict=True))
    ]
    system = System(
        tuple(made),
        tuple(starts),
        tuple(added_to),
        tuple(solve(residuals)),
        tuple(elimination.determinants),
    )
    ring.systems |= {generator.index: system for generator in made}


class Elimination:
    """Solves with one matrix of ring elements, in blocks, every intermediate result by a name."""

    def __init__(self, ring: Ring, matrix: Matrix, block: int) -> None:
        self.ring, self.block, count = ring, block, len(matrix) // block
        rows = [range(block * i, block * (i + 1)) for i in range(count)]
        left: list[list[Matrix]] = [
            [[[matrix[r][c] for c in rows[j]] for r in rows[i]] for j in range(count)]
            for i in range(count)
        ]
        self.inverses: list[Matrix] = []
        self.determinants: Column = []
        self.factors: dict[tuple[int, int], Matrix] = {}
        # Gauß by blocks without pivoting: diagonal blocks are 1 + O(h), which is never 0 at h = 0.
        for k in range(count):
            self.inverses.append(self._inverse(left[k][k]))
            for i in range(k + 1, count):
                factor = self.factors[i, k] = self._product(left[i][k], self.inverses[k])
                for j in range(k + 1, count):
                    left[i][j] = self._minus(left[i][j], self._product(factor, left[k][j]))
        self.upper = left

    def solve(self, right: Sequence[Poly]) -> Column:
        count, block = len(self.inverses), self.block
        parts: list[Matrix] = [[[x] for x in right[block * i : block * (i + 1)]]
                               for i in range(count)]  # fmt: skip
        # Forwards by columns, in the order of the elimination; then backwards.
        for (i, k), factor in sorted(self.factors.items(), key=lambda at: at[0][1]):
            parts[i] = self._minus(parts[i], self._product(factor, parts[k]))
        for k in reversed(range(count)):
            for j in range(k + 1, count):
                parts[k] = self._minus(parts[k], self._product(self.upper[k][j], parts[j]))
            parts[k] = self._product(self.inverses[k], parts[k])
        return [x for part in parts for (x,) in part]

    def _inverse(self, x: Matrix) -> Matrix:
        if self.block == 1:
            self.determinants.append(x[0][0])
            return [[self._one_over(x[0][0])]]
        (a, b), (c, d) = x
        self.determinants.append(self.ring.reduce(a * d - b * c))
        below = self._one_over(self.determinants[-1])
        return [[self._named(y * below) for y in row] for row in ((d, -b), (-c, a))]

    def _one_over(self, x: Poly) -> Poly:
        """1/x, with x = 1 at h = 0."""
        ring = self.ring
        if x.is_one():
            return x
        found = ring.find("inverse", x)
        if found is None:
            found = ring.add("inverse", x)
            ring.set_chain(found, [(-(found**2), x)])
        return found

    def _product(self, x: Matrix, y: Matrix) -> Matrix:
        total = self.ring.zero
        return [
            [
                self._named(sum((a * row[j] for a, row in zip(line, y, strict=True)), total))
                for j in range(len(y[0]))
            ]
            for line in x
        ]

    def _minus(self, x: Matrix, y: Matrix) -> Matrix:
        pairs = zip(x, y, strict=True)
        return [[self._named(a - b) for a, b in zip(*rows, strict=True)] for rows in pairs]

    def _named(self, x: Poly) -> Poly:
        return self.ring.named(self.ring.reduce(x))
