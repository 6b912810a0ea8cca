"""One number alone that is misprinted: which it can be, and what it would have to be."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

import flint

from verify.algebra.formula import symbol
from verify.arithmetic.arb import Ball, middle_and_radius
from verify.arithmetic.flint_precision import working_precision
from verify.schemes.printed.asked import BITS, Asked
from verify.schemes.printed.nearby import AnyNumbers, Nearby, small

_TURNS = 9
_FEW = 8  # failing conditions by which one number is looked for; then all are looked at
_HELD = flint.arb(2) ** -150  # a residue that is 0, where no number is rounded
_CLOSE, _LARGEST = Fraction(1, 10**40), 10**12  # to a quotient, and its denominator at most
_MOST = 200  # entries of which one is looked for


@dataclass(frozen=True)
class Misprint:
    """One number alone that, were it `value`, would make the conditions hold to the digits."""

    name: str
    printed: str
    value: Fraction


def misprints(near: Nearby, rows: Sequence[int], single: bool = False) -> tuple[Misprint, ...]:
    """The numbers of which the change of each alone would do; `single`: none where several would.

    Where only last digits are wrong, several seem to do: the digits of the others leave room.
    """
    failing = [i for i in rows if not _is_small(near, i, near.value[i])]
    few, every = failing[:_FEW] or list(rows[:_FEW]), range(len(near.names))
    each = tuple(m for k in every if (m := _single(near, k, rows, few)) is not None)
    return () if single and len(each) > 1 else each


def _single(near: Nearby, k: int, rows: Sequence[int], few: Sequence[int]) -> Misprint | None:
    """By Newton's method for one unknown, in the sense of least squares."""
    at, value = list(near.start), near.value
    largest = max(abs(value[i]) for i in few)
    slope = [near.slope[i][k].mid() for i in few]
    for turn in range(_TURNS):
        if turn:
            there = near.moved(at, k, few)
            slope = [((there[i] - value[i]) / small()).mid() for i in few]
        change = _least_squares(slope, [value[i] for i in few])
        if change is None:
            return None
        at[k] = (at[k] - change).mid()
        value = near.residues(at, few)
        if turn == 0 and not all(abs(value[i]) < largest for i in few):
            return None  # no change of this number alone brings them down
    if not all(_is_small(near, i, value[i]) for i in few):
        return None
    value = near.residues(at, rows)
    if not all(_is_small(near, i, value[i]) for i in rows):
        return None
    name = near.names[k]
    return Misprint(name, near.numbers.numbers[name], middle_and_radius(at[k])[0])


def _is_small(near: Nearby, i: int, value: Ball) -> bool:
    """Whether a residue is what the digits leave of it."""
    pairs = zip(near.slope[i], near.unit, strict=True)
    return bool(abs(value) < sum((abs(d) * u for d, u in pairs), _HELD))


def _least_squares(slope: Sequence[Ball], value: Sequence[Ball]) -> Ball | None:
    square = sum((d * d for d in slope), flint.arb(0))
    if square == 0:
        return None
    return sum((d * v for d, v in zip(slope, value, strict=True)), flint.arb(0)) / square


# -- of exact tables ------------------------------------------------------------------------------


def exact_misprints(asked: Asked, order: int) -> tuple[Misprint, ...]:
    """Of rational entries that are not 0: each that alone would do, with the quotient for it."""
    labels = asked.labels
    if not labels or len(labels) > _MOST or not all(x.is_Rational for x in asked.entries):
        return ()
    names = [f"x{k}" for k in range(len(labels))]
    values = {n: Fraction(int(x.p), int(x.q)) for n, x in zip(names, asked.entries, strict=True)}
    texts = dict(zip(names, map(str, asked.entries), strict=True))
    unknowns = AnyNumbers(texts, values, dict.fromkeys(names, _CLOSE**2))
    free = replace(asked, entries=tuple(map(symbol, names)))
    with working_precision(BITS):
        near = misprints(Nearby(unknowns, free), asked.up_to(order))
    each = (_by_quotient(asked, order, names.index(m.name), m.value) for m in near)
    return tuple(m for m in each if m is not None)


def _by_quotient(asked: Asked, order: int, k: int, near: Fraction) -> Misprint | None:
    """Entry k with the quotient near that value; None where the conditions do not hold with it."""
    value = near.limit_denominator(_LARGEST)
    if abs(value - near) > _CLOSE or value == asked.entries[k]:
        return None
    entries = [flint.fmpq(int(x.p), int(x.q)) for x in asked.entries]
    entries[k] = flint.fmpq(value.numerator, value.denominator)
    residues = asked.residues(entries, flint.fmpq(1))
    if any(residues[i] != 0 for i in asked.up_to(order)):
        return None
    return Misprint(asked.labels[k], str(asked.entries[k]), value)
