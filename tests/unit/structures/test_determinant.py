"""The determinant by minors: right with entries that are 0, and refused where it is too large."""

import time

import pytest
import sympy

from verify.errors import LimitError
from verify.hamiltonians import systems
from verify.proof.structures.structure_order import prove_structure
from verify.schemes import get
from verify.structures import PLAIN_VOLUME
from verify.structures.volume import determinant
from verify.verdict import Verdict


@pytest.mark.parametrize("seed", range(12))
def test_it_is_that_of_sympy(seed: int) -> None:
    size = 1 + seed % 5
    entries = [(7 * seed + 11 * i * i + 5 * j * i + 3 * j) % 6 - 2 for i in range(size)
               for j in range(size)]  # fmt: skip
    rows = [entries[size * k : size * (k + 1)] for k in range(size)]
    rows = [[x if x > -1 else 0 for x in row] for row in rows]
    assert determinant(rows) == sympy.Matrix(rows).det()


def test_of_many_rows_with_few_entries_it_takes_no_time() -> None:
    size = 60
    rows = [[2 if i == j else -1 if abs(i - j) == 1 else 0 for j in range(size)]
            for i in range(size)]  # fmt: skip
    begun = time.process_time()
    assert determinant(rows) == size + 1
    assert time.process_time() - begun < 1
    assert determinant([[0, 0], [1, 2]]) == 0


def test_of_many_full_rows_it_is_refused() -> None:
    with pytest.raises(LimitError, match="coordinates are too many"):
        determinant([[pow(i + 2, 3 * j + 1, 1009) for j in range(20)] for i in range(20)])


def test_volume_of_a_long_chain_needs_no_determinant() -> None:
    hamiltonian = systems.get("fput").hamiltonian({"n": 20})
    scheme = get("stormer-verlet")
    proof = prove_structure(scheme.step_map(hamiltonian), PLAIN_VOLUME, scheme)
    assert proof.verdict is Verdict.PROVED
