"""Regimes of systems in several degrees of freedom, and their H against one written by hand."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any

import mpmath
import sympy

from verify.algebra.formula import symbol
from verify.hamiltonians import systems
from verify.hamiltonians.hamiltonian import Hamiltonian

_DIGITS = 60
_STEP = 20  # central differences over 10⁻²⁰ are right to some 40 digits

Textbook = Callable[..., Any]  # of the lists q and p, of t, and of the parameters by their names


@dataclass(frozen=True)
class Example:
    """A regime of a system, read by nothing of ours but its names."""

    name: str
    values: Mapping[str, Fraction]
    q: Sequence[Fraction]
    p: Sequence[Fraction]

    @cached_property
    def hamiltonian(self) -> Hamiltonian:
        return systems.get(self.name).hamiltonian(self.values)


def example(name: str, regime: str) -> Example:
    texts = dict(systems.get(name).regimes[regime])
    q, p = ([Fraction(x) for x in texts.pop(letter).split(",")] for letter in "qp")
    values = {key: Fraction(x) for key, x in texts.items()}
    return Example(name, values, q, p)


def gradients_apart(at: Example, textbook: Textbook, t: Fraction = Fraction(2, 3)) -> float:
    """The largest difference between any partial derivative of ours and of the textbook's."""
    n = len(at.q)
    with mpmath.workdps(_DIGITS):
        point = [mpmath.mpf(x.numerator) / x.denominator for x in (*at.p, *at.q)]
        time, *given = (mpmath.mpf(x.numerator) / x.denominator for x in (t, *at.values.values()))
        values = dict(zip(at.values, given, strict=True))

        def value(z: Sequence[Any]) -> Any:
            return textbook(z[n:], z[:n], time, **values)

        names = [*map(symbol, at.hamiltonian.coordinates)]
        slopes = [at.hamiltonian.exact.diff(name) for name in names]
        ours = sympy.lambdify([*names, symbol("t")], slopes, "mpmath")(*point, time)
        step = mpmath.mpf(10) ** -_STEP
        apart = []
        for k, slope in enumerate(ours):
            up, down = ([*point[:k], point[k] + s, *point[k + 1 :]] for s in (step, -step))
            apart.append(abs((value(up) - value(down)) / (2 * step) - slope))
        return float(max(apart))
