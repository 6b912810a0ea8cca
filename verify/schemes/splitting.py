"""Compositions of the two shears of H = T(p) + V(q): kicks p − a h V'(q), drifts q + a h T'(p)."""

from collections.abc import Iterable, Sequence
from itertools import cycle

import sympy

from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.schemes.scheme import Scheme
from verify.schemes.splitting_conditions import LETTERS, Part, Splitting
from verify.schemes.step_map import StepMap, Substep


def splitting(
    name: str, parts: Sequence[Part], *, order: int, symmetric: bool, source: str
) -> Scheme:
    """The scheme that kicks and drifts by these parts of h in turn; every one preserves area."""
    return Scheme(
        name=name,
        order=order,
        area_preserving=True,
        explicit=True,
        symmetric=symmetric,
        source=source,
        build=lambda hamiltonian: shears(hamiltonian, name, parts),
        every_h=Splitting(tuple(parts)),
    )


def alternating(first: str, sizes: Iterable[sympy.Expr]) -> tuple[Part, ...]:
    """Kicks and drifts in turn, `first` one of them, of these parts of h."""
    kinds = cycle([first, *(kind for kind in LETTERS if kind != first)])
    return tuple((kind, sympy.sympify(size)) for kind, size in zip(kinds, sizes, strict=False))


def palindrome(first: str, half: Sequence[sympy.Expr]) -> tuple[Part, ...]:
    """As `alternating`, forth and back again; the last of `half` stands once, in the middle."""
    return alternating(first, [*half, *half[-2::-1]])


def composed(first: str, steps: Sequence[sympy.Expr]) -> tuple[Part, ...]:
    """Störmer–Verlet steps of these parts of h, each half a `first`, the other, half a `first`.

    Neighbouring halves are one part.
    """
    inner = [
        size
        for step, after in zip(steps, [*steps[1:], None], strict=True)
        for size in (step, (step + after) / 2 if after is not None else step / 2)
    ]
    return alternating(first, [steps[0] / 2, *inner])


def shears(hamiltonian: Hamiltonian, scheme: str, parts: Sequence[Part]) -> StepMap:
    """The map that kicks and drifts by these parts of h in turn, `scheme` being its name.

    Raises InputError unless H = T(p) + V(q).
    """
    field, sizes = hamiltonian.field(*(size for _, size in parts))
    ring = field.ring
    if not field.separable():
        raise InputError(
            "hamiltonian",
            str(hamiltonian.expression),
            f"{scheme} is explicit only for H = T(p) + V(q)",
        )
    p, q, h = (ring.variable(name) for name in ("p", "q", "h"))
    steps = []
    for (kind, _), size in zip(parts, sizes, strict=True):
        kicked, drifted = p - size * h * field.h_q, q + size * h * field.h_p
        step = Substep(field, kicked, q) if kind == "kick" else Substep(field, p, drifted)
        steps.append(step)
    return StepMap(hamiltonian, tuple(steps))
