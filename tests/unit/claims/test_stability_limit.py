"""Claims on the step size up to which a scheme is stable on the oscillator."""

from pathlib import Path

import pytest

from tests.unit.claims.test_check import check_file
from verify.errors import InputError
from verify.verdict import Verdict


def verdict(folder: Path, scheme: str, keys: str) -> Verdict:
    content = f'[[claim]]\nid = "a"\nkind = "stability_limit"\nscheme = "{scheme}"\n{keys}\n'
    return check_file(folder, content)["a"].verdict


@pytest.mark.parametrize(
    ("scheme", "keys", "planted"),
    [
        ("rk4", 'printed = "2.83"', 'printed = "2.82"'),
        ("rk4", 'formula = "2*sqrt(2)"', 'formula = "2.8284271247461903"'),
        ("stormer-verlet", "printed = 2", 'printed = "2.1"'),
        ("forest-ruth", 'printed = "1.5734"', 'formula = "1.5734"'),
        ("mine: kick 1/2; drift 1; kick 1/2", 'formula = "2"', 'printed = "1.99"'),
    ],
)
def test_a_right_limit_is_proved_and_another_refuted(
    scheme: str, keys: str, planted: str, tmp_path: Path
) -> None:
    assert verdict(tmp_path, scheme, keys) is Verdict.PROVED
    assert verdict(tmp_path, scheme, planted) is Verdict.REFUTED


@pytest.mark.parametrize("scheme", ["euler", "implicit-midpoint"])
def test_a_limit_of_what_is_stable_never_or_always_is_refuted(scheme: str, tmp_path: Path) -> None:
    assert verdict(tmp_path, scheme, "printed = 2") is Verdict.REFUTED


def test_one_number_is_asked_for(tmp_path: Path) -> None:
    for keys in ("", 'printed = "2"\nformula = "2"'):
        with pytest.raises(InputError, match="give one of the two"):
            verdict(tmp_path, "rk4", keys)
