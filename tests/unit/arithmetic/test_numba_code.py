"""What numba has compiled in one process is loaded in the next, and is the same."""

import json
import math
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from verify.arithmetic import numba_code
from verify.arithmetic.systems import float64
from verify.code_cache import OFF, VARIABLE

SOURCE = """\
def kernel(steps, x):
    y = x
    for k in range(steps):
        x = x * x - c
        y = y + sin(x) + root(x * x + 1.0, 3) + sinh(x)
    return steps, x, y
"""
NAMES = {"sin": math.sin, "sinh": math.sinh, "root": float64._root, "c": 0.7}


@pytest.fixture
def kernels(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv(VARIABLE, str(tmp_path))
    return tmp_path / "kernels"


def call(source: str = SOURCE, start: Any = 0.25, **names: object) -> tuple[object, int]:
    """What a new dispatcher gives, and how much of that it did not compile."""
    dispatcher: Any = float64._by_numba(source, "kernel", NAMES | names)
    return dispatcher(50, start), sum(dispatcher.stats.cache_hits.values())


def test_the_second_one_is_loaded_and_gives_the_same_bits(
    kernels: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with monkeypatch.context() as patched:
        patched.setenv(VARIABLE, OFF)
        (alone, _) = call()
    assert call() == (alone, 0)
    assert call() == (alone, 1)
    assert len(list(kernels.iterdir())) == 1


@pytest.mark.left_to_ci
def test_another_source_constant_function_or_type_is_compiled(kernels: Path) -> None:
    first, _ = call()
    others = [
        call(SOURCE.replace("- c", "+ c")),
        call(c=math.nextafter(0.7, 1)),
        call(sin=math.cos),
        call(start=1),
    ]
    assert all(hits == 0 and found != first for found, hits in others)


def test_another_version_or_setting_is_compiled(
    kernels: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    import numba

    first = call()
    with monkeypatch.context() as patched:
        patched.setattr(numba, "__version__", "0.0.1")
        assert call() == first
    with monkeypatch.context() as patched:
        patched.setenv("NUMBA_OPT", "1")
        assert call() == first
    with monkeypatch.context() as patched:
        patched.setattr(numba_code, "_processor", lambda target: "another")
        assert call() == first
    assert call() == (first[0], 1)


def test_a_damaged_entry_is_compiled_anew(kernels: Path) -> None:
    first = call()
    (entry,) = kernels.iterdir()
    raw = bytearray(entry.read_bytes())
    raw[len(raw) // 2] ^= 1
    entry.write_bytes(raw)
    assert call() == first
    assert call() == (first[0], 1)


def test_nothing_is_kept_where_that_is_off(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(VARIABLE, OFF)
    assert call() == call()


@pytest.mark.left_to_ci
def test_a_process_that_has_loaded_kernels_compiles_others(kernels: Path) -> None:
    """Loading prepares less of numba than compiling does; arrays need the most of it."""
    work = (
        "import json, numpy as np\n"
        "from verify.arithmetic.systems import float64\n"
        "from verify.arithmetic import numba_code\n"
        "def halves(rows):\n"
        "    found = np.empty(len(rows))\n"
        "    for k in range(len(rows)):\n"
        "        found[k] = rows[k] / 2\n"
        "    return found\n"
        "of_arrays = numba_code.compiled(halves, 'halves')\n"
        "far = of_arrays(np.array([1.0, 3]))\n"
        "new = float64._compiled('def f(x):\\n    return x * c\\n', 'f', {'c': CONSTANT})\n"
        "found = [far.tolist(), new(3.0) / CONSTANT]\n"
        "hits = [sum(each.stats.cache_hits.values()) for each in (of_arrays, new)]\n"
        "print(json.dumps([found, hits]))\n"
    )
    answers = [
        json.loads(subprocess.check_output([sys.executable, "-c", work.replace("CONSTANT", x)]))
        for x in ("1.0", "2.0")
    ]
    (first, none), (second, hits) = answers
    assert first == second
    assert first == [[0.5, 1.5], 3]
    assert (none, hits) == ([0, 0], [1, 0])
