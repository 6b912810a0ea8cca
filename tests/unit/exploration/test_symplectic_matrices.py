"""The matrices of equivariance are canonical, in the plane as in n degrees of freedom."""

from collections.abc import Callable

import pytest

from verify.exploration.equivariance import (
    RationalMatrix,
    coordinate_change,
    cyclic_shift,
    exchange_of_p_and_q,
    symplectic,
)

every_n = pytest.mark.parametrize("n", [1, 2, 3])


def omega(n: int) -> RationalMatrix:
    return RationalMatrix(
        [[(b == a + n) - (a == b + n) for b in range(2 * n)] for a in range(2 * n)]
    )


def form_of(matrix: RationalMatrix) -> RationalMatrix:
    """MᵀΩM."""
    return matrix.transpose() * omega(matrix.nrows() // 2) * matrix


@every_n
@pytest.mark.parametrize("make", [symplectic, coordinate_change])
def test_what_a_seed_chooses_is_symplectic(
    make: Callable[[int, int], RationalMatrix], n: int
) -> None:
    chosen = [make(seed, n) for seed in range(40)]
    assert all(form_of(matrix) == omega(n) for matrix in chosen)
    assert len({str(matrix) for matrix in chosen}) > 5
    one = RationalMatrix([[int(a == b) for b in range(2 * n)] for a in range(2 * n)])
    assert one not in chosen


@every_n
def test_places_are_moved_by_places_alone(n: int) -> None:
    for seed in range(40):
        matrix = coordinate_change(seed, n)
        assert not any(matrix[a, n + b] or matrix[n + a, b] for a in range(n) for b in range(n))


def test_two_shears_mix_p_and_q_in_the_plane() -> None:
    assert all(symplectic(seed, 1)[a, 1 - a] != 0 for seed in range(40) for a in range(2))


@every_n
def test_degrees_are_put_in_order_and_p_and_q_exchanged(n: int) -> None:
    assert form_of(cyclic_shift(n)) == omega(n)
    assert form_of(exchange_of_p_and_q(n)) == omega(n) * -1
    assert cyclic_shift(3)[1, 0] == cyclic_shift(3)[0, 2] == cyclic_shift(3)[4, 3] == 1
