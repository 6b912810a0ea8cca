"""How far a coordinate is followed to look beyond comparisons: as a run of 1,000 steps leads; and
whether S is within what is allowed, or hidden."""

from fractions import Fraction
from types import SimpleNamespace
from typing import Any

import pytest

from verify.integrators.measures.measurement import farthest_of
from verify.integrators.measures.structure_measurement import StructureMeasurement

NAMES = ("q", "p")


def place(z: tuple[float, float], units: tuple[float, float], t: float = 0.0) -> Any:
    return SimpleNamespace(z=z, units=units, step=0.01, t=t)


def followed(step: Any, *places: Any, moving: bool = True) -> dict[str, float]:
    return farthest_of(SimpleNamespace(names=NAMES, evaluate=step, time_dependent=moving), places)


def test_a_force_that_grows_in_time_is_read_at_the_time_of_each_step() -> None:
    """p' = p + h t, q' = q + h p': after 1,000 steps p is h² Σ k, and q is h Σ p."""

    def step(z: list[float], h: float, t: float) -> tuple[float, float]:
        p = z[1] + h * t
        return z[0] + h * p, p

    found = followed(step, place((0.0, 0.0), (1e-6, 1e-6)))
    h, p, q = 0.01, 0.0, 0.0
    for k in range(1000):
        p += h * (k * h)
        q += h * p
    assert found["p"] == pytest.approx(p)
    assert found["q"] == pytest.approx(q)
    still = followed(step, place((0.0, 0.0), (1e-6, 1e-6), t=2.0), moving=False)
    assert still["p"] == pytest.approx(1000 * h * 2.0)


def test_an_orbit_that_stays_near_is_followed_to_100_units() -> None:
    found = followed(lambda z, *_: tuple(z), place((3.0, 0.5), (1.0, 2.0)), place((0, 0), (4.0, 0)))
    assert found == {"q": 400.0, "p": 200.0}


def test_what_runs_away_is_left_where_it_is_beyond_all_units() -> None:
    """And what fails has led as far as it has."""
    found = followed(lambda z, *_: (10 * z[0], z[1]), place((1.0, 0.5), (1.0, 1.0)))
    assert 1e12 < found["q"] <= 1e14

    def failing(z: list[float], *_: float) -> tuple[float, float]:
        if z[0] > 1e5:
            raise ValueError("too far")
        return 10 * z[0], z[1]

    assert followed(failing, place((1.0, 0.5), (1.0, 1.0)))["q"] == 1e6


@pytest.mark.parametrize(
    ("defect", "blur", "kept"),
    [
        (1e-5, 1e-8, True),
        (9e-4, 1e-6, True),
        (2e-3, 1e-6, False),
        (2e-3, 5e-4, False),
        (1e-5, 2e-3, None),
        (2.5e-3, 2e-3, None),
        (0.0, 1.1e-3, None),
        (1.2e-3, 5e-4, None),  # more than is allowed, and by less than the noise
    ],
)
def test_what_the_user_allows_is_kept_only_where_so_little_would_be_seen(
    defect: float, blur: float, kept: bool | None
) -> None:
    """Within a thousandth; beside a place at which all is known, and in either order."""
    here, clear = SimpleNamespace(defect=defect, blur=blur), SimpleNamespace(defect=0.0, blur=1e-12)
    for readings in ((here,), (here, clear), (clear, here)):
        structure = StructureMeasurement("floats", readings)  # type: ignore[arg-type]
        assert structure.is_kept(Fraction(1, 1000)) is kept
