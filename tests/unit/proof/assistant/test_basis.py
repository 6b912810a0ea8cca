"""Polynomials as sums of multiples of relations."""

import pytest
from flint import Ordering, fmpq_mpoly, fmpq_mpoly_ctx

from verify.proof.assistant.factors import Basis

RING = fmpq_mpoly_ctx.get(["w", "u", "q"], Ordering.lex)
W, U, Q = RING.gens()
RELATIONS = {3: W * Q**2 - 1, 5: U * Q - 1}


@pytest.mark.parametrize(
    "x", [W - U**2, W * U - U**3, (W - U**2) ** 2 + U * Q - 1, 2 * W * Q - 2 * U, RING.constant(0)]
)
def test_a_sum_of_multiples_is_found(x: fmpq_mpoly) -> None:
    found = Basis(RING, RELATIONS.items()).find_sum(x)
    assert found is not None
    assert sum((f * RELATIONS[k] for k, f in found.items()), RING.constant(0)) == x


@pytest.mark.parametrize("x", [W - U, W + U**2, Q, RING.constant(1)])
def test_what_is_none_is_not(x: fmpq_mpoly) -> None:
    assert Basis(RING, RELATIONS.items()).find_sum(x) is None
    assert Basis(RING, []).find_sum(x) is None
