"""The combinations of Lyndon words that count where T = p²/(2m).

Then D_n is m_n p²/2, with 1/m = Σ m_n tⁿ, and the bracket of letters is a polynomial in p, in the
m_n and in the derivatives of the functions V_n(q), which are all free. Some are 0, as
{V, {V', {V'', p²}}}, and some are equal. A Lie polynomial is Σ y_b b over brackets b of which the
leading words are the Lyndon words, and its Hamiltonian Σ y_b H_b: that vanishes where so many
combinations of its coefficients of Lyndon words do as the H_b have rank. The letters of a word go
with it everywhere, those of D as the powers of the m_n and those of K as the functions V_n; so that
is linear algebra among the words of the same letters.
"""

from collections import defaultdict
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from math import lcm

import flint

from verify.algebra.series.jets import JetsInDegrees, Poly
from verify.schemes.conditions.words.words import Letter, Word, bracket, lyndon

Combination = tuple[tuple[int, Word], ...]
_MOST = 8  # the weight of words


@cache
def combinations(kinds: str, weight: int) -> tuple[Combination, ...]:
    """Return the combinations of that weight that vanish exactly where a Lie polynomial's
    Hamiltonian does.

    `kinds`: those whose time counts, "KD" where m depends on t, "K" where it does not.
    """
    of_letters: dict[Word, list[Word]] = defaultdict(list)
    for word in lyndon(kinds, weight):
        of_letters[tuple(sorted(word))].append(word)
    return tuple(x for item in of_letters.items() for x in _of_letters(*item))


def _of_letters(letters: Word, leading: list[Word]) -> Iterator[Combination]:
    brackets = _brackets(letters)
    hamiltonians = [dict(b.hamiltonian.to_dict()) for b in brackets]
    monomials = sorted({m for h in hamiltonians for m in h})
    if not monomials:
        return
    # With C the brackets' coefficients of the words, c = y C; y M = c C⁻¹ M must vanish.
    coefficients = flint.fmpq_mat([[b.words.get(w, 0) for w in leading] for b in brackets])
    values = flint.fmpq_mat([[h.get(m, 0) for m in monomials] for h in hamiltonians])
    echelon, rank = (coefficients.inv() * values).transpose().rref()
    for i in range(rank):
        row = [echelon[i, j] for j in range(len(leading))]
        denominator = lcm(*(int(x.q) for x in row))
        yield tuple(
            (int(x.p) * (denominator // int(x.q)), w)
            for x, w in zip(row, leading, strict=True)
            if x
        )


@dataclass(frozen=True)
class _Bracket:
    """A bracket of letters: its words, each with its coefficient, and its Hamiltonian."""

    words: Mapping[Word, int]
    hamiltonian: Poly

    def with_letter(self, letter: Letter) -> "_Bracket":
        """Return [letter, this one]."""
        return _Bracket(bracket(letter, self.words), _poisson(letter, self.hamiltonian))


@cache
def _brackets(letters: Word) -> tuple[_Bracket, ...]:
    """Return a basis of the brackets of these letters, each used as often as it occurs."""
    if len(letters) == 1:
        return (_Bracket({letters: 1}, _of_letter(letters[0])),)
    spanning = []
    for letter in dict.fromkeys(letters):
        others = list(letters)
        others.remove(letter)
        # Brackets nested to the right span all brackets, with each letter in turn as the outermost.
        spanning += [b.with_letter(letter) for b in _brackets(tuple(others))]
    words = sorted({w for b in spanning for w in b.words})
    if not words:
        return ()
    matrix = flint.fmpq_mat([[b.words.get(w, 0) for b in spanning] for w in words])
    # The pivot columns are the first independent brackets.
    echelon, rank = matrix.rref()
    columns = range(len(spanning))
    return tuple(spanning[next(j for j in columns if echelon[i, j])] for i in range(rank))


def _of_letter(letter: Letter) -> Poly:
    """Return the Hamiltonian of a letter, in jets: those of ∂_q ∂_tⁿ V by q are as free as those of
    V_n."""
    kind, n = letter
    return _jets().variable("p") ** 2 / 2 if kind == "D" else _jets().derivative((0, 1, n))


def _poisson(letter: Letter, x: Poly) -> Poly:
    """Return {letter, x} with {a, b} = a_p b_q − a_q b_p."""
    kind, n = letter
    if kind == "K":
        return -_jets().derivative((0, 2, n)) * x.derivative(0)
    return _jets().variable("p") * _jets().diff(x, "q")


@cache
def _jets() -> JetsInDegrees:
    return JetsInDegrees(("p", "q"), _MOST, separable=True, timed=True)
