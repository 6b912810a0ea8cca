"""Splittings with planted errors, and all the splittings there are."""

from collections.abc import Sequence

import sympy

from verify import schemes
from verify.algebra.ring import Poly, Ring
from verify.schemes.conditions.splitting_conditions import Part, Splitting
from verify.schemes.conditions.words.step_words import StepWords
from verify.schemes.scheme import Scheme
from verify.schemes.splitting import splitting

SPLITTINGS = tuple(n for n in schemes.names() if isinstance(schemes.get(n).every_h, Splitting))


def parts_of(name: str) -> list[Part]:
    generic = schemes.get(name).every_h
    assert isinstance(generic, Splitting)
    return list(generic.parts)


def coefficient(ring: Ring, parts: Sequence[tuple[str, Poly]], word: str) -> Poly:
    """The coefficient of the word in Π exp(a_i X_i), X_i the letters of the parts."""
    step = StepWords(ring, [(letter, size, ring.zero) for letter, size in parts])
    return step.coefficient(tuple((letter, 0) for letter in word))


def made(name: str, parts: list[Part]) -> Scheme:
    """The scheme of that name, with its claims, but of other parts."""
    scheme = schemes.get(name)
    return splitting(
        name, parts, order=scheme.order, symmetric=scheme.symmetric, source="a planted error"
    )


def with_error(name: str, at: int, error: sympy.Rational) -> Scheme:
    """One coefficient is off."""
    parts = parts_of(name)
    kind, size = parts[at]
    parts[at] = (kind, size + error)
    return made(name, parts)


def with_hidden_error(name: str, error: sympy.Rational) -> Scheme | None:
    """Two of its kicks or of its drifts are off, with their mirror images if it is a palindrome.

    Their sum and the symmetry stay as they are; None where it has too few parts for that.
    """
    parts = parts_of(name)
    mirrored = schemes.get(name).symmetric
    for wanted in ("drift", "kick"):
        places = [k for k, (kind, _) in enumerate(parts) if kind == wanted]
        if len(places) < (4 if mirrored else 2):
            continue
        for k, sign in ((places[0], 1), (places[1], -1)):
            for at in {k, len(parts) - 1 - k} if mirrored else {k}:
                parts[at] = (wanted, parts[at][1] + sign * error)
        return made(name, parts)
    return None


def with_swapped_stages(name: str) -> Scheme | None:
    """The first two different neighbours of one kind are exchanged; None where there are none."""
    parts = parts_of(name)
    for k in range(len(parts) - 2):
        if parts[k] != parts[k + 2]:
            parts[k], parts[k + 2] = parts[k + 2], parts[k]
            return made(name, parts)
    return None
