"""A scheme's orbit in balls, with the sums and products over its steps that a row has."""

from collections.abc import Iterable
from fractions import Fraction

import flint

from verify.reference.check.taylor import Number, number
from verify.reference.check.textbook import Field, Matrix, Step, Vector, defect, identity, product
from verify.reference.make.models_in_degrees import AnyRun


class TooWideError(Exception):
    """A ball too wide to tell."""


def orbit_of(known: Field, step: Step, run: AnyRun) -> "Orbit":
    """The run's, at its start."""
    return (_OrbitOfPlane if known.degrees == 1 else _OrbitOfSeveral)(known, step, run)


class Orbit:
    """A scheme's orbit in balls, with the product of det J over its steps."""

    def __init__(self, known: Field, step: Step, run: AnyRun) -> None:
        start, self._size = run.start, Fraction(run.step_size)
        self.known, self.step, self.h = known, step, flint.arb(number(self._size))
        self.z: Vector = [flint.arb(number(start[name])) for name in known.names]
        self._t0 = start.get("t", Fraction(0))
        self.done, self.lam = 0, flint.arb(0)
        self._next: tuple[Vector, Matrix] | None = None

    @property
    def t(self) -> Number:
        """When it is."""
        return flint.arb(number(self._t0 + self.done * self._size))

    def ahead(self) -> tuple[Vector, Matrix]:
        """The state after the next step, and that step's Jacobian."""
        if self._next is None:
            self._next = self.step(self.z, self.h, self.t)
        return self._next

    def to(self, count: int) -> None:
        """Goes on to the state after so many steps; TooWideError where a ball is not finite."""
        while self.done < count:
            self.z, jacobian = self.ahead()
            change = self._taken(jacobian)
            self.lam += change + self.lam * change
            self.done, self._next = self.done + 1, None
            if not _finite(self.z):
                raise TooWideError

    def _taken(self, jacobian: Matrix) -> Number:
        """det J − 1 of a step, of which the sums have been taken."""
        raise NotImplementedError

    def values(self) -> dict[str, Number]:
        """The state, and what is defined beside it, by the names of their columns."""
        return dict(zip(self.known.names, self.z, strict=True)) | {"lambda": self.lam}


class _OrbitOfPlane(Orbit):
    """One with the sum of the squares of ΔJ."""

    def __init__(self, known: Field, step: Step, run: AnyRun) -> None:
        super().__init__(known, step, run)
        self.squares = flint.arb(0)

    def _taken(self, jacobian: Matrix) -> Number:
        change = _delta_j(jacobian)
        self.squares += change * change
        return change

    def values(self) -> dict[str, Number]:
        mean = self.squares / self.done if self.done else self.squares
        after, jacobian = self.ahead()
        begins = {"delta_j": _delta_j(jacobian)} if _finite(after) else {}
        return super().values() | begins | {"mse": mean}


def _delta_j(jacobian: Matrix) -> Number:
    a, b, c, d = jacobian
    return a * d - b * c - 1


class _OrbitOfSeveral(Orbit):
    """One with the Jacobian of all steps, and the greatest |entry of S| of any of them."""

    def __init__(self, known: Field, step: Step, run: AnyRun) -> None:
        super().__init__(known, step, run)
        self.largest, self.matrix = flint.arb(0), identity(len(known.names))

    def _taken(self, jacobian: Matrix) -> Number:
        size = len(self.z)
        self.largest = _greatest((self.largest, *defect(jacobian, self.known.degrees).values()))
        self.matrix = product(jacobian, self.matrix, size)
        return flint.arb_mat(size, size, jacobian).det() - 1

    def values(self) -> dict[str, Number]:
        form = defect(self.matrix, self.known.degrees)
        values = super().values() | {
            "symplectic_defect_max": self.largest,
            "symplectic_defect": _greatest(form.values()),
        }
        energy = self.known.energy(self.z, self.t)
        return values | ({"energy": energy} if energy.is_finite() else {})


def _greatest(balls: Iterable[Number]) -> Number:
    total = flint.arb(0)
    for x in balls:
        total = total.max(abs(x))
    return total


def _finite(z: Vector) -> bool:
    return all(x.is_finite() for x in z)
