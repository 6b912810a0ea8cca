"""Functions over arrays by LLVM: the bits of Python in all of the language, and what is kept."""

from math import sqrt
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from verify.arithmetic.compiled import loops, native
from verify.code_cache import OFF, VARIABLE

MOST, SHARE = 5, 0.75


def _larger(x: Any, y: Any) -> Any:
    """The larger one, and whether it is the second."""
    if x >= y:
        return x, 0
    return y, 1


def everything(rows: Any, counts: Any, row: Any, start: float, steps: int) -> Any:
    total, found, k = start, 0, 0
    while k < len(rows):
        k += 1
        if k % 2 == 1 and row[0] > 0.0:
            continue
        x, y, z = rows[k - 1]
        total = total + (x * y - z) / (1.0 + x * x) + SHARE * k
        rows[k - 1, 2] = total
    for j in range(1, steps):
        larger, second = _larger(rows[j % 3, 0], sqrt(max(0.0, total, rows[j % 3, 1])))
        counts[j % 3] = (j // 2 ^ 3) + second
        if larger == 0.0 or j > MOST:
            break
        elif j != 2:
            found += min(j, MOST, 4) * 2 - 1
        else:
            found = found + len(counts)
    for j in range(2):
        total -= row[j]
    return total, found, k


def given(seed: int) -> tuple[Any, ...]:
    random = np.random.default_rng(seed)
    counts = np.zeros(3, dtype=np.int64)
    return random.normal(size=(7, 3)), counts, random.normal(size=3), 0.1, 4 + seed


@pytest.fixture
def kernels(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv(VARIABLE, str(tmp_path))
    return tmp_path / "kernels"


@pytest.mark.parametrize("seed", range(5))
def test_it_gives_and_writes_what_python_does(seed: int) -> None:
    here, there = given(seed), given(seed)
    wanted = everything(*here)
    assert loops.compile_function(everything)(*there) == wanted
    for one, other in zip(here[:3], there[:3], strict=True):
        assert one.tobytes() == other.tobytes()


def _unknown(x: Any) -> Any:
    return x**3, x


def _no_integer(x: float) -> Any:
    k = 0
    k = x
    return k, x


def _of_numbers(x: Any) -> Any:
    return x // 2, x


def _with_a_list(x: Any) -> Any:
    return [x][0], x


@pytest.mark.parametrize("function", [_unknown, _no_integer, _of_numbers, _with_a_list])
def test_what_is_not_in_the_language_is_refused(function: Any) -> None:
    with pytest.raises((NotImplementedError, KeyError)):
        loops.compile_function(function)(1.5)


def test_it_is_compiled_once_for_each_kind_of_arguments(
    kernels: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    compilations: list[int] = []
    make = native.machine_code

    def noting(module: Any) -> bytes:
        compilations.append(1)
        return make(module)

    monkeypatch.setattr(native, "machine_code", noting)
    for _ in range(2):  # as two processes would
        assert loops.compile_function(_larger)(1.0, 2.0) == (2.0, 1)
        assert loops.compile_function(_larger)(3, 2) == (3, 0)
    assert len(compilations) == len(list(kernels.iterdir())) == 2
    monkeypatch.setenv(VARIABLE, OFF)
    assert loops.compile_function(_larger)(3, 2) == (3, 0)
    assert len(compilations) == 3


def test_a_number_of_its_module_is_in_its_name(
    kernels: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for share in (0.75, 0.5):
        monkeypatch.setitem(everything.__globals__, "SHARE", share)
        here, there = given(1), given(1)
        assert loops.compile_function(everything)(*there) == everything(*here)
    assert len(list(kernels.iterdir())) == 2
