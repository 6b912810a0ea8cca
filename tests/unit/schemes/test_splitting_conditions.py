"""Order, area and symmetry of splittings by their coefficients; planted errors are found.

The oracles: products in the free algebra written out word by word, the series over the jets, and
coefficients printed in the literature.
"""

from fractions import Fraction
from itertools import product
from math import factorial

import flint
import pytest
import sympy

from tests.helpers.lie_derivatives import lie_derivatives
from tests.helpers.planted.splittings import (
    SPLITTINGS,
    coefficient,
    made,
    parts_of,
    with_error,
    with_hidden_error,
    with_swapped_stages,
)
from tests.helpers.symmetry import prove_symmetry, symmetry_conditions
from verify import schemes
from verify.algebra.embedding import embed
from verify.algebra.jets import Jets
from verify.errors import InputError
from verify.exploration.properties.plane.order_by_jets import delta_j
from verify.proof.order_conditions import prove_by_conditions
from verify.proof.order_for_every_h import prove_for_every_h
from verify.schemes.conditions.splitting_conditions import (
    LETTERS,
    MOST_ORDER,
    Splitting,
)
from verify.schemes.conditions.words.words import lyndon, text
from verify.schemes.methods.splitting import blanes_moan4
from verify.schemes.scheme import Scheme
from verify.schemes.splitting import alternating, compose, palindrome
from verify.verdict import Verdict

TINY, SMALL = sympy.Rational(1, 10**11), sympy.Rational(1, 10**6)


def proof_of(scheme: Scheme):
    return prove_by_conditions(scheme, scheme.every_h)


def residues(scheme: Scheme) -> list[float]:
    return [abs(float(c.residue)) for c in proof_of(scheme).conditions if not c.holds]


# -- words ----------------------------------------------------------------------------------------


def test_lyndon_words_are_those_smaller_than_their_proper_ends() -> None:
    found = [[text(word) for word in lyndon("", n)] for n in range(1, 9)]
    for n, own in enumerate(found, 1):
        words = map("".join, product("DK", repeat=n))
        assert own == sorted(w for w in words if all(w < w[k:] for k in range(1, n)))
    assert [len(own) for own in found] == [2, 1, 2, 3, 6, 9, 18, 30]


def in_the_free_algebra(parts, most: int) -> dict[str, Fraction]:
    """Π exp(a X), multiplied out: {word: coefficient}."""
    total = {"": Fraction(1)}
    for letter, size in parts:
        after: dict[str, Fraction] = {}
        for word, x in total.items():
            for n in range(most - len(word) + 1):
                longer = word + letter * n
                after[longer] = after.get(longer, Fraction(0)) + x * size**n / factorial(n)
        total = after
    return total


def test_a_coefficient_is_that_of_the_product_of_exponentials() -> None:
    sizes = [Fraction(n, 7) for n in (3, -2, 5, 1, 4, -1)]
    parts = list(zip("KDKDDK", sizes, strict=True))
    expected = in_the_free_algebra(parts, 5)
    ring, _ = embed([], ())
    exact = [(letter, ring.constant(size)) for letter, size in parts]
    words = ["".join(w) for n in range(1, 6) for w in product("KD", repeat=n)]
    for word in words:
        assert coefficient(ring, exact, word) == ring.constant(expected.get(word, Fraction(0)))
    assert coefficient(ring, exact[::-1], "KKD") != ring.constant(expected["KKD"])


@pytest.mark.parametrize("name", SPLITTINGS)
def test_where_the_lyndon_words_are_right_all_words_are(name: str) -> None:
    order = min(schemes.get(name).order, 4)
    ring, sizes = embed([size for _, size in parts_of(name)], ())
    letters = [LETTERS[kind] for kind, _ in parts_of(name)]
    parts = list(zip(letters, sizes, strict=True))
    for n in range(1, order + 1):
        for word in map("".join, product("DK", repeat=n)):
            gap = coefficient(ring, parts, word) - ring.constant(Fraction(1, factorial(n)))
            assert ring.decide(gap).zero is True, word


# -- in the plane ---------------------------------------------------------------------------------


def rank_of_brackets(length: int) -> tuple[int, int]:
    """How many standard brackets of Lyndon words there are, and their rank over all T and V."""
    jets = Jets(length + 1, separable=True)
    words = {text(w) for n in range(1, length + 1) for w in lyndon("", n)}
    known = {"D": sympy.S.Zero, "K": sympy.S.Zero}  # T(p) and V(q) occur by derivatives only

    def gradient(word: str):
        """(∂_p, ∂_q) of the bracket of a word."""
        if word in known:
            return (jets.h(1, 0), jets.zero) if word == "D" else (jets.zero, jets.h(0, 1))
        x = bracket(word)
        return jets.diff(x, "p"), jets.diff(x, "q")

    def bracket(word: str):
        cut = next(k for k in range(1, len(word)) if word[k:] in words)
        (a, b), (c, d) = gradient(word[:cut]), gradient(word[cut:])
        return a * d - b * c

    rows = [bracket(w).to_dict() for w in sorted(words) if len(w) == length]
    columns = sorted({m for row in rows for m in row})
    matrix = flint.fmpq_mat([[row.get(m, flint.fmpq(0)) for m in columns] for row in rows])
    return len(rows), matrix.rank()


@pytest.mark.parametrize("length", range(2, MOST_ORDER + 1))
def test_brackets_in_the_plane_are_independent(length: int) -> None:
    count, rank = rank_of_brackets(length)
    assert rank == count


def test_with_nine_letters_they_no_longer_are_and_the_order_is_refused() -> None:
    assert rank_of_brackets(MOST_ORDER + 1) == (56, 54)
    with pytest.raises(InputError, match=r"^order=9"):
        Splitting(alternating("kick", (1, 1))).order_conditions(9)


# -- orders ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", SPLITTINGS)
def test_every_splitting_has_its_order_and_area_exactly(name: str) -> None:
    scheme, proof = schemes.get(name), prove_for_every_h(name)
    assert (proof.verdict, proof.convergence_order) == (Verdict.PROVED, scheme.order)
    assert (proof.area_preserving, proof.separable) == (True, True)
    assert {c.residue for c in proof.conditions} == {"0"}
    counts = [sum(c.order == n for c in proof.conditions) for n in range(scheme.order + 1)]
    assert counts == [2, 2, 1, 2, 3, 6, 9][: scheme.order + 1]
    assert f"of h^{scheme.order + 1}" in proof.checked[-1]


@pytest.mark.parametrize("name", SPLITTINGS)
def test_no_splitting_has_a_higher_order_than_it_claims(name: str) -> None:
    scheme = schemes.get(name)
    other = Scheme(**{**vars(scheme), "order": scheme.order + 1})
    proof = proof_of(other)
    assert (proof.verdict, proof.convergence_order) == (Verdict.REFUTED, scheme.order)


RATIONAL = [n for n in SPLITTINGS if schemes.get(n).every_h.stages is not None]


@pytest.mark.parametrize("name", RATIONAL)
def test_the_series_over_the_jets_has_the_same_order(name: str) -> None:
    scheme = schemes.get(name)
    jets = Jets(scheme.order + 3, separable=True)
    series = scheme.every_h.stages.taylor(jets, scheme.order + 1)
    flow = [lie_derivatives(jets, x, scheme.order + 1) for x in ("p", "q")]
    for n in range(scheme.order + 2):
        agree = [s[n] * factorial(n) == x[n] for s, x in zip(series, flow, strict=True)]
        assert all(agree) is (n <= scheme.order)
    assert all(x == 0 for x in delta_j(jets, *series))


def test_the_rational_splittings_are_found() -> None:
    assert {"stormer-verlet", "symplectic-euler", "ruth3"} <= set(RATIONAL)


# -- the literature -------------------------------------------------------------------------------

PRINTED = {
    "yoshida4": {0: "0.6756035959798289", 1: "1.3512071919596578", 2: "-0.1756035959798288",
                 3: "-1.7024143839193153"},
    "forest-ruth": {0: "0.6756035959798289", 3: "-1.7024143839193153"},
    "ruth3": {0: "0.2916666666666667", 3: "-0.6666666666666667"},
    "suzuki4": {1: "0.4144907717943757", 5: "-0.6579630871775028"},
    "mclachlan-atela2": {1: "0.7071067811865475", 0: "0.2928932188134525"},
    "blanes-moan4": {0: "0.0792036964311957", 1: "0.209515106613362", 2: "0.353172906049774",
                     3: "-0.143851773179818", 4: "-0.0420650803577195", 5: "0.434336666566456",
                     6: "0.219376955753500"},
}  # fmt: skip


@pytest.mark.parametrize("name", PRINTED)
def test_coefficients_are_those_printed(name: str) -> None:
    parts = parts_of(name)
    for k, written in PRINTED[name].items():
        places = len(written.partition(".")[2])
        assert abs(parts[k][1] - sympy.Rational(written)).evalf(30) < 2 * 10.0**-places, (
            k,
            written,
        )


def test_the_printed_digits_of_blanes_and_moan_alone_have_order_4_to_15_digits_only() -> None:
    a, b = ([sympy.Rational(x) for x in blanes_moan4.PRINTED[k]] for k in "ab")
    half = [a[0], b[0], a[1], b[1], a[2], sympy.S.Half - sum(b), 1 - 2 * sum(a)]
    proof = proof_of(made("blanes-moan4", list(palindrome("drift", half))))
    assert (proof.verdict, proof.convergence_order) == (Verdict.REFUTED, 2)
    wrong = [abs(float(c.residue)) for c in proof.conditions if not c.holds]
    assert all(1e-19 < x < 1e-14 for x in wrong)


@pytest.mark.parametrize("steps", [(1, -1, 1), (sympy.Rational(1, 3),) * 3])
def test_other_compositions_of_three_verlet_steps_have_order_2(steps) -> None:
    proof = proof_of(made("yoshida4", list(compose("kick", sympy.sympify(list(steps))))))
    assert (proof.verdict, proof.convergence_order) == (Verdict.REFUTED, 2)


# -- planted errors -------------------------------------------------------------------------------


@pytest.mark.left_to_ci
@pytest.mark.sample(8)
@pytest.mark.parametrize("error", [TINY, SMALL, -TINY], ids=["1e-11", "1e-6", "-1e-11"])
@pytest.mark.parametrize("name", SPLITTINGS)
def test_an_error_in_any_coefficient_is_found_with_its_residue(name: str, error) -> None:
    for at in range(len(parts_of(name))):
        scheme = with_error(name, at, error)
        first = scheme.every_h.order_conditions(1)
        assert [c.holds for c in first].count(False) == 1
        wrong = next(c for c in first if not c.holds)
        assert Fraction(wrong.residue) == Fraction(int(error.p), int(error.q))
        proof = proof_of(scheme)
        assert (proof.verdict, proof.convergence_order) == (Verdict.REFUTED, 0)
        assert wrong.residue in proof.reason
        assert proof.area_preserving is True, "shears preserve area whatever they are"


@pytest.mark.parametrize("error", [TINY, SMALL], ids=["1e-11", "1e-6"])
@pytest.mark.parametrize("name", SPLITTINGS)
def test_an_error_that_keeps_sums_and_symmetry_is_found(name: str, error) -> None:
    scheme = with_hidden_error(name, error)
    if scheme is None:
        assert schemes.get(name).order <= 2
        return
    proof = proof_of(scheme)
    assert proof.verdict is Verdict.REFUTED
    assert 1 <= proof.convergence_order < scheme.order
    found = residues(scheme)
    assert error / 100 < max(found) <= 2 * error
    symmetric = prove_symmetry(scheme).verdict is Verdict.PROVED
    assert symmetric is scheme.symmetric


@pytest.mark.parametrize("name", SPLITTINGS)
def test_swapped_stages_are_found(name: str) -> None:
    scheme = with_swapped_stages(name)
    if scheme is None:
        assert len(parts_of(name)) <= 3
        return
    assert proof_of(scheme).verdict is Verdict.REFUTED
    assert max(residues(scheme)) > 1e-4
    assert prove_symmetry(scheme).verdict is Verdict.REFUTED


@pytest.mark.parametrize("name", [n for n in SPLITTINGS if schemes.get(n).symmetric])
def test_an_error_of_one_coefficient_breaks_the_symmetry(name: str) -> None:
    scheme = with_error(name, 0, TINY)
    found = prove_symmetry(scheme)
    assert found.verdict is Verdict.REFUTED
    assert [c.residue for c in symmetry_conditions(scheme.every_h) if not c.holds] == [
        "1.00000000000e-11"
    ]


def test_parts_that_make_no_difference_make_none() -> None:
    half = sympy.S.Half
    plain = palindrome("kick", (half, sympy.S.One))
    padded = [*plain[:1], ("drift", half), ("kick", sympy.S.Zero), ("drift", half), *plain[2:]]
    scheme = made("stormer-verlet", padded)
    assert proof_of(scheme).verdict is Verdict.PROVED
    assert prove_symmetry(scheme).verdict is Verdict.PROVED
