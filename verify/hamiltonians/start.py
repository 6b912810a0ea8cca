"""The points at which a run may start: where H is defined and smooth."""

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any

from verify.arithmetic.exact import Exact, rational, text
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian

Given = Exact | Sequence[Exact]  # one number, or one for each degree of freedom


def point_of(hamiltonian: Hamiltonian, q: Given, p: Given) -> dict[str, Fraction]:
    """Return each coordinate's value by its name, exactly, from q and p as they are given, a list
    each.

    In the plane a number will do. InputError for too few or too many.

    >>> point_of(Hamiltonian.parse("p1**2/2 + p2**2/2 + q1*q2"), ["0.5", 0], p=[1, 2])["q1"]
    Fraction(1, 2)
    """
    degrees, point = hamiltonian.degrees, {}
    for letter, numbers in (("p", p), ("q", q)):
        values: Sequence[Exact]
        if isinstance(numbers, Sequence) and not isinstance(numbers, str):
            values = numbers
            if hamiltonian.planar:
                raise InputError(letter, values, "is a list; H is of p and q: give one number")
        else:
            values = [numbers]
        names = [name for name in hamiltonian.coordinates if name[0] == letter]
        if len(values) != degrees:
            values_text = ", ".join(text(x) if isinstance(x, Fraction) else str(x) for x in values)
            problem = f"has {len(values)} of {degrees} numbers; H is of {', '.join(names)}"
            raise InputError(letter, values_text, problem)
        for name, value in zip(names, values, strict=True):
            point[name] = rational(value, name)
    return {name: point[name] for name in hamiltonian.coordinates}


def shown_of(
    hamiltonian: Hamiltonian, point: Mapping[str, Fraction], letter: str
) -> str | tuple[str, ...]:
    """Return q or p of a point as text: a number, or a list in n degrees of freedom."""
    p, q = hamiltonian.halves(tuple(text(point[name]) for name in hamiltonian.coordinates))
    half: str | tuple[str, ...] = {"p": p, "q": q}[letter]
    return half


def start_texts(
    hamiltonian: Hamiltonian, point: Mapping[str, Fraction], t0: Fraction | None
) -> dict[str, Any]:
    """Return the start of a run as results have it: q, p and t0, which is None where H has no
    time."""
    return {
        "q": shown_of(hamiltonian, point, "q"),
        "p": shown_of(hamiltonian, point, "p"),
        "t0": None if t0 is None else text(t0),
    }


def check_start(hamiltonian: Hamiltonian, q: Given, p: Given, t0: Exact = 0) -> None:
    """Raise InputError where H is not defined, or not smooth, at (q, p), and at t0 where it depends
    on time.

    >>> check_start(Hamiltonian.parse("p**2/2 + log(q)"), -1, 0)
    Traceback (most recent call last):
    verify.errors.InputError: q, p=-1, 0: H is not smooth there; it is where q > 0
    """
    values = point_of(hamiltonian, q, p)
    # q comes first in messages, as in the arguments.
    point = {name: values[name] for name in sorted(values, key=lambda name: name[0] != "q")}
    if hamiltonian.time_dependent:
        point["t"] = rational(t0, "t0")
    domain = hamiltonian.domain
    if domain.names <= set(point) and domain.contains(point) is False:
        values_text = ", ".join(map(text, point.values()))
        problem = f"H is not smooth there; it is where {', '.join(domain.texts)}"
        raise InputError(", ".join(point), values_text, problem)
