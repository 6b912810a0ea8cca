"""Lies that are compiled into a run's tangent map: its bounds are then broken, as a test sees."""

from collections.abc import Iterator, Sequence
from math import isqrt
from typing import Any

import pytest

from tests.unit.runs.test_a_posteriori_controls import (
    COUPLED,
    SADDLE,
    SADDLE_FLOATING,
    SQUEEZED,
    Orbit,
    Patch,
)
from verify.kernels.kernel import kernel_for
from verify.kernels.step import tangent_map as tangent


@pytest.fixture
def afresh() -> Iterator[None]:
    """Kernels are made anew, and forgotten afterwards."""
    kernel_for.cache_clear()
    yield
    kernel_for.cache_clear()


_statements = tangent.statements


def without_rows(patch: Patch, *rows: int) -> None:
    """These rows of the tangent map stay those of the identity."""

    def lying(change: Sequence[str], *names: Any) -> list[str]:
        size = isqrt(len(change))
        return _statements(["0" if i // size in rows else c for i, c in enumerate(change)], *names)

    patch.setattr(tangent, "statements", lying)


@pytest.mark.parametrize(
    ("orbit", "rows", "names"),
    [(SADDLE, (0, 1), "p q"), (SADDLE_FLOATING, (0, 1), "p q"), (COUPLED, range(4), "p1 q1"),
     (SADDLE, (0,), "p q"), (SADDLE, (1,), "p q"), (COUPLED, (0,), "p1 q1")],
    ids=["fixed", "mpfr", "two-degrees", "no-row-of-p", "no-row-of-q", "no-row-of-p1"],
)  # fmt: skip
@pytest.mark.usefixtures("afresh")
def test_a_tangent_map_without_some_of_its_rows_is_caught(
    orbit: Orbit, rows: Sequence[int], names: str, monkeypatch: Patch
) -> None:
    without_rows(monkeypatch, *rows)
    assert orbit.outside(orbit.again()) >= set(names.split())


@pytest.mark.usefixtures("afresh")
def test_a_determinant_that_is_not_looked_at_is_caught(monkeypatch: Patch) -> None:
    """Areas shrink to 10⁻⁸, and the errors made there are then magnified as much again."""
    lying = lambda change, *_: [x for x in _statements(change) if "det_low" not in x]  # noqa: E731
    monkeypatch.setattr(tangent, "statements", lying)
    assert "q" in SQUEEZED.outside(SQUEEZED.again())
