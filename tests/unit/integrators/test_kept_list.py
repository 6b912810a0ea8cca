"""Whoever asks nothing is told what is kept; the verdict is what it was."""

import math
from typing import Any

import pytest

import verify
from tests.helpers.programs import kept_steps as steps
from tests.helpers.programs import user_steps

NOTES = {
    "verlet": "keeps area (det J = 1), energy to h^2; reversible by p ↦ −p",
    "euler_a": "keeps area (det J = 1), energy to h^1; not reversible by p ↦ −p",
    "rk4": "keeps area to h^5, energy to h^4; not reversible by p ↦ −p",
}


@pytest.mark.parametrize("name", NOTES)
def test_a_step_is_told_what_it_keeps(name: str) -> None:
    found = verify.check("pendulum", getattr(user_steps, name))
    assert NOTES[name] in found.notes
    assert [x.structure.name for x in found.keeps] == ["area", "reversible", "energy"]
    # Nothing is refuted of which nothing is claimed.
    assert all(x.verdict is None or x.verdict.holds for x in found.keeps)
    assert found.counterexample is None


def test_a_map_in_velocities_is_told_that_volume_is_kept() -> None:
    found = verify.check_map(steps.two, 2)
    assert found.verdict == "REFUTED"
    text = "keeps volume (det J = 1), not the symplectic form; reversible by p ↦ −p"
    assert text in found.notes


def test_energy_is_kept_where_it_is() -> None:
    def turned(p: Any, q: Any, h: Any) -> Any:
        c, s = math.cos(h), math.sin(h)
        return c * p - s * q, s * p + c * q

    found = verify.check("p**2/2 + q**2/2", turned)
    assert "keeps area (det J = 1), energy; reversible by p ↦ −p" in found.notes


def test_an_h_that_is_not_even_in_p_has_no_way_back_of_this_kind() -> None:
    found = verify.check("p**2/2 + p*q + q**2/2 + q**4/4", lambda p, q, h: (p - h * q, q + h * p))
    assert all(x.structure.name != "reversible" for x in found.keeps)
