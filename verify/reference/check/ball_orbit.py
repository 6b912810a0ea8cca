"""A scheme's orbit in balls, with the sums and products over its steps that a row contains."""

from fractions import Fraction
from functools import reduce

import flint

from verify.reference.check.taylor import Number, number
from verify.reference.check.textbook import Field, Step, Vector, defect, identity
from verify.reference.make.models import AnyRun


class TooWideError(Exception):
    """A ball is too wide to decide a question."""


class Orbit:
    """The orbit of a run, from its start: with det J and S of its steps, and the product of all
    Jacobians."""

    def __init__(self, field: Field, step: Step, run: AnyRun) -> None:
        start, self._size = run.start, Fraction(run.step_size)
        self.field, self.step, self.h = field, step, flint.arb(number(self._size))
        self.z: Vector = [flint.arb(number(start[name])) for name in field.names]
        self._t0 = start.get("t", Fraction(0))
        self.done, self.lam, self.squares, self.largest = 0, *(flint.arb(0) for _ in range(3))
        self._square = len(field.names), len(field.names)
        self.matrix = flint.arb_mat(*self._square, identity(len(field.names)))
        self._next: tuple[Vector, flint.arb_mat] | None = None

    @property
    def t(self) -> Number:
        """The time of the present state."""
        return flint.arb(number(self._t0 + self.done * self._size))

    def look_ahead(self) -> tuple[Vector, flint.arb_mat]:
        """Return the state after the next step, and that step's Jacobian."""
        if self._next is None:
            after, jacobian = self.step(self.z, self.h, self.t)
            self._next = after, flint.arb_mat(*self._square, jacobian)
        return self._next

    def advance_to(self, count: int) -> None:
        """Advance to the state after `count` steps; TooWideError where a ball is not finite."""
        while self.done < count:
            self.z, jacobian = self.look_ahead()
            change = jacobian.det() - 1
            self.squares += change * change
            # Λ = Π (1 + ΔJ_k) − 1 by the recurrence Λ ← Λ + ΔJ + Λ ΔJ: forming the product first
            # would lose the digits of a small Λ.
            self.lam += change + self.lam * change
            self.largest = self.largest.max(self._greatest_defect(jacobian))
            # The chain rule: the newest Jacobian stands on the left.
            self.matrix = jacobian * self.matrix
            self.done, self._next = self.done + 1, None
            if not _finite(self.z):
                raise TooWideError

    def _greatest_defect(self, jacobian: flint.arb_mat) -> Number:
        entries = defect(jacobian.entries(), self.field.degrees).values()
        return reduce(flint.arb.max, map(abs, entries), flint.arb(0))

    def values(self) -> dict[str, Number]:
        """Return the state, and what is computed from it, by the names of their columns."""
        values = dict(zip(self.field.names, self.z, strict=True)) | {
            "lambda": self.lam,
            "mse": self.squares / max(self.done, 1),
            "symplectic_defect_max": self.largest,
            "symplectic_defect": self._greatest_defect(self.matrix),
        }
        after, jacobian = self.look_ahead()
        extra = {"energy": self.field.energy(self.z, self.t)}
        if _finite(after):
            extra["delta_j"] = jacobian.det() - 1
        return values | {name: x for name, x in extra.items() if x.is_finite()}


def _finite(z: Vector) -> bool:
    return all(x.is_finite() for x in z)
