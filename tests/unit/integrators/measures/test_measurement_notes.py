"""How near a symplectic matrix lies to one that is not, by cases that are known."""

import numpy as np
import pytest

from verify.integrators.measures.measurement_notes import _smallest_change


def omega(size: int) -> np.ndarray:
    half = size // 2
    unit, zero = np.eye(half), np.zeros((half, half))
    return np.block([[zero, unit], [-unit, zero]])


def symplectic(size: int, seed: int) -> np.ndarray:
    """A product of shears, of entries of about 1."""
    random, half = np.random.default_rng(seed), size // 2
    made = np.eye(size)
    for turn in range(4):
        shear = random.normal(size=(half, half)) / 3
        block = np.eye(size)
        rows, columns = ((half, 0), (0, half))[turn % 2]
        block[rows : rows + half, columns : columns + half] = shear + shear.T
        made = block @ made
    return np.asarray(made)


@pytest.mark.parametrize("size", [2, 4, 6])
def test_of_a_multiple_of_the_identity_the_diagonal_has_to_change(size: int) -> None:
    """MᵀΩδ + δᵀΩM = −S with M = c 1 and S = (c² − 1) Ω: δ_pp + δ_qq = −(c² − 1)/c of each pair."""
    for c in (1 + 1e-3, 1 - 1e-5):
        assert _smallest_change(c * np.eye(size)) == pytest.approx(
            abs(c * c - 1) / (2 * c), rel=1e-6
        )


@pytest.mark.parametrize("size", [2, 4, 6])
@pytest.mark.parametrize("seed", range(4))
def test_a_rounded_symplectic_matrix_is_within_half_a_unit_of_one(size: int, seed: int) -> None:
    made = symplectic(size, seed)
    assert np.abs(made.T @ omega(size) @ made - omega(size)).max() < 1e-12
    assert _smallest_change(made) < 1e-12
    for digits in (3, 6):
        assert _smallest_change(np.round(made, digits)) <= 0.5 * 10.0**-digits * (1 + 1e-6)


@pytest.mark.parametrize("size", [2, 4, 6])
@pytest.mark.parametrize("seed", range(4))
def test_what_is_changed_by_so_much_is_symplectic_to_second_order(size: int, seed: int) -> None:
    """An entry that is off by ε needs a change of some of them by a part of ε, and no more."""
    made, random = symplectic(size, seed), np.random.default_rng(seed)
    off = made.copy()
    off[tuple(random.integers(0, size, 2))] += 1e-6
    found = _smallest_change(off)
    assert 0 <= found <= 1e-6 * (1 + 1e-6)
    defect = np.abs(off.T @ omega(size) @ off - omega(size)).max()
    # Each entry of S moves by at most 2n products of an entry of M and one of δ, twice.
    assert defect <= 2 * size * np.abs(off).max() * found * (1 + 1e-6)
