"""A kernel that was compiled before is loaded and not compiled, and is the same; else compiled."""

from collections.abc import Callable
from fractions import Fraction
from pathlib import Path

import pytest

from verify.arithmetic.compiled import engine, native
from verify.arithmetic.compiled.engine import Fixed
from verify.arithmetic.compiled.translation import Source
from verify.arithmetic.systems import fixed
from verify.arithmetic.wide.translator import Translator
from verify.code_cache import OFF, VARIABLE

BITS = 176
SOURCE = """\
def kernel(steps: 'int', x, s: 'sum', f: 'float'):
    for k in range(steps):
        x = x * x + c
        s = s + sin(x)
        f = f + f_sin(f)
    return steps, x, s, f
"""
NAMES = {"sin": "sin", "f_sin": "f_sin", "c": Fixed(round(Fraction(1, 5) * 2**BITS), BITS)}
GIVEN = (7, Fixed(3 << 170, BITS), Fixed(0, BITS), 0.5)


@pytest.fixture
def kernels(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv(VARIABLE, str(tmp_path))
    return tmp_path / "kernels"


@pytest.fixture
def compilations(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """A list that grows by the source of each kernel that is translated from now on."""
    found: list[str] = []
    translate = Translator.translate

    def noted(self: Translator) -> object:
        found.append(self.definition.name)
        return translate(self)

    monkeypatch.setattr(Translator, "translate", noted)
    return found


def call(source: str = SOURCE, fraction: int = BITS, **names: object) -> object:
    """What the kernel gives in a process that has not compiled anything yet."""
    engine._cached_function.cache_clear()
    return engine.compile_source(source, fraction, NAMES | names)(*GIVEN)


def expected() -> object:
    source = Source(SOURCE, BITS, tuple(sorted(NAMES.items())))
    return engine.NativeFunction(source, anew=True)(*GIVEN)


def test_the_second_process_compiles_nothing_and_gets_the_same(
    kernels: Path, compilations: list[str]
) -> None:
    first = call()
    assert len(compilations) == 1
    assert call() == first
    assert len(compilations) == 1
    assert len(list(kernels.iterdir())) == 1
    assert first == expected()


def test_the_second_process_needs_no_ir(kernels: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    first = call()

    def never(*_: object) -> None:
        raise AssertionError

    monkeypatch.setattr(native, "machine_code", never)
    assert call() == first


def test_what_is_not_called_is_not_compiled_and_not_kept(kernels: Path) -> None:
    engine._cached_function.cache_clear()
    engine.compile_source(SOURCE, BITS, NAMES)
    assert not kernels.exists()


CHANGES: dict[str, Callable[[], object]] = {
    "source": lambda: call(SOURCE.replace("x + c", "x - c")),
    "format": lambda: call(fraction=BITS - 1),
    "constant": lambda: call(c=Fixed(round(Fraction(1, 7) * 2**BITS), BITS)),
}


@pytest.mark.parametrize("change", CHANGES)
def test_another_kernel_is_compiled(kernels: Path, compilations: list[str], change: str) -> None:
    first = call()
    assert CHANGES[change]() != first
    assert len(compilations) == 2


def test_another_version_or_processor_compiles_anew(
    kernels: Path, compilations: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    first = call()
    monkeypatch.setattr(native.llvmlite, "__version__", "0.0.1")
    native.versions.cache_clear()
    assert call() == first
    assert len(compilations) == 2
    name, features = native._processor()
    assert features  # of which one that is lacking makes another processor
    monkeypatch.setattr(native, "_processor", lambda: (name, features.rpartition(",")[0]))
    native.versions.cache_clear()
    assert call() == first
    assert len(compilations) == 3
    monkeypatch.undo()
    native.versions.cache_clear()


def test_our_own_compiler_and_its_libraries_are_in_the_key() -> None:
    said = native.versions()
    for part in ("Python 3.", "llvmlite 0.", "LLVM (", *native._processor()):
        assert part in said
    assert native._COMPILER_HASH.hexdigest() in said


def test_a_damaged_entry_is_compiled_anew_and_replaced(
    kernels: Path, compilations: list[str]
) -> None:
    first = call()
    (entry,) = kernels.iterdir()
    whole = entry.read_bytes()
    for at in (0, 40, len(whole) // 2, len(whole) - 1):
        damaged = bytearray(whole)
        damaged[at] ^= 255
        entry.write_bytes(damaged)
        compilations.clear()
        assert call() == first
        assert len(compilations) == 1
        assert entry.read_bytes() == whole


def test_the_kernel_of_another_is_not_taken_up(kernels: Path, compilations: list[str]) -> None:
    """As it would be, were a file renamed: both are whole."""
    first = call()
    (entry,) = kernels.iterdir()
    other = CHANGES["constant"]()
    (changed,) = set(kernels.iterdir()) - {entry}
    changed.replace(entry)
    compilations.clear()
    assert call() == first != other
    assert len(compilations) == 1


def test_where_nothing_is_kept_it_is_compiled_every_time(
    monkeypatch: pytest.MonkeyPatch, compilations: list[str]
) -> None:
    monkeypatch.setenv(VARIABLE, OFF)
    assert call() == call() == expected()
    assert len(compilations) == 3


def test_the_arithmetic_itself_keeps_its_kernels(kernels: Path, compilations: list[str]) -> None:
    made = fixed.at_bits(112)
    for _ in range(2):
        engine._cached_function.cache_clear()
        square = made.compile("def f(x):\n    return x * x\n", "f", {})
        assert made.exact(square(made.number(Fraction(3, 2)))) == Fraction(9, 4)
    assert len(compilations) == 1
