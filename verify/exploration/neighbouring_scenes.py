"""Scenes that differ from one in a single number, a little: where a local search looks next."""

from collections.abc import Iterator
from contextlib import suppress
from fractions import Fraction
from itertools import chain

import sympy

from verify.algebra.expressions.formula_text import to_text
from verify.arithmetic.exact import text
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.scenes.scene import Scene, scene_from
from verify.scenes.values import InitialState, InitialValue

_FACTORS = (Fraction(1, 2), Fraction(4, 5), Fraction(5, 4), Fraction(2))
_MOVES = tuple(sign * Fraction(1, 10**k) for k in (1, 2) for sign in (1, -1))
Coordinates = tuple[Fraction, ...]
_PLACES = 3  # decimals of a coefficient or a step size


def neighbours(
    scene: Scene,
    *,
    reach: Fraction,
    steps: tuple[Fraction, Fraction],
    coefficients: tuple[Fraction, Fraction],
) -> Iterator[Scene]:
    """Each once: with another initial value in reach, step size within `steps`, or |coefficient| of
    H within `coefficients`; without that last bound a search would only make H ever larger."""
    assert scene.grid is not None  # noqa: S101 - the caller's scenes are drawn
    start, h = scene.grid.initial_values[0], scene.grid.step_sizes[0]
    formula, at = scene.hamiltonian or "", _coordinates(start)
    moved = [_moved(at, k, move) for move in _MOVES for k in range(len(at))]
    sizes = [min(max(_rounded(h * factor), steps[0]), steps[1]) for factor in _FACTORS]
    others = chain(
        ((formula, at, size) for size in sizes),
        ((formula, other, h) for other in moved if max(map(abs, other)) <= reach),
        ((other, at, h) for other in _formulas(scene.exact_hamiltonian(), coefficients)),
    )
    seen = {(formula, at, h)}
    for other in others:
        if other not in seen:
            seen.add(other)
            with suppress(InputError):  # such as an H that is not defined there
                yield _scene(scene, *other)


def _coordinates(start: InitialValue | InitialState) -> Coordinates:
    """q, then p."""
    if isinstance(start, InitialValue):
        return start.q, start.p
    return *start.q, *start.p


def _moved(at: Coordinates, k: int, move: Fraction) -> Coordinates:
    return *at[:k], at[k] + move, *at[k + 1 :]


def _scene(scene: Scene, formula: str, at: Coordinates, h: Fraction) -> Scene:
    assert scene.grid is not None  # noqa: S101 - as above
    numbers, half = list(map(text, at)), len(at) // 2
    q, p = (numbers[0], numbers[1]) if half == 1 else (numbers[:half], numbers[half:])
    grid = {
        "steps": scene.grid.steps,
        "step_sizes": [text(h)],
        "initial_values": [{"q": q, "p": p}],
    }
    whole = {"hamiltonian": formula, "t0": text(scene.t0), "schemes": scene.schemes, "grid": grid}
    return scene_from(whole, "neighbour")


def _formulas(hamiltonian: Hamiltonian, within: tuple[Fraction, Fraction]) -> Iterator[str]:
    """H with one coefficient of its sum changed."""
    least, most = within
    terms = sympy.Add.make_args(hamiltonian.exact)
    for k, term in enumerate(terms):
        content, primitive = term.as_content_primitive()  # 1/(2*p**2 + 2) has a factor of ½
        sign, rest = primitive.as_coeff_Mul()
        coefficient = content * sign
        if not coefficient.is_Rational or rest.is_number:
            continue
        for factor in (*_FACTORS, Fraction(-1)):
            value = _rounded(Fraction(int(coefficient.p), int(coefficient.q)) * factor)
            if least <= abs(value) <= most:
                changed = sympy.Rational(value) * rest
                yield to_text(sympy.Add(*terms[:k], changed, *terms[k + 1 :]))


def _rounded(x: Fraction) -> Fraction:
    """To so few decimals that the scene stays readable."""
    return round(x, _PLACES)
