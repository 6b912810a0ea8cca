"""Oscillators, whose orbits are cosines, for tests of orbits and averages."""

from fractions import Fraction
from typing import Any

import mpmath
from hypothesis import strategies as st

from verify.algebra.embedding import embed
from verify.algebra.formula import parse
from verify.flows.closed_orbit import Element
from verify.hamiltonians.hamiltonian import Hamiltonian

numbers = st.builds(Fraction, st.integers(-12, 12), st.integers(4, 9))
rates = st.integers(1, 6)
digits_of = st.integers(8, 40)


def element(text: str) -> Element:
    ring, (x,) = embed([parse(text)], ("p", "q"))
    return ring, x


def mpf(x: Any) -> Any:
    if isinstance(x, Fraction):
        return mpmath.mpf(x.numerator) / x.denominator
    n, d = x.as_integer_ratio()
    return mpmath.mpf(int(n)) / int(d)


def oscillator(a: int, b: int, q0: Fraction) -> Hamiltonian:
    return Hamiltonian.parse(f"{a}*p**2/2 + {b}*(q - ({q0}))**2/2")


def turned(a: int, b: int, p: Any, q: Any, time: Any) -> tuple[Any, Any]:
    """p' = −b q, q' = a p."""
    rate = mpmath.sqrt(a * b)
    c, s = mpmath.cos(rate * time), mpmath.sin(rate * time)
    return p * c - q * s * b / rate, q * c + p * s * a / rate
