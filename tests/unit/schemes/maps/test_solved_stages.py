"""Implicit stages that are linear in turn are written out: what such a step keeps is decided."""

from fractions import Fraction

import pytest
import sympy

from tests.helpers.stepping.kept_structures import SCHEMES, Field, mp
from verify import schemes
from verify.algebra.enclosure import enclose
from verify.hamiltonians.equations import read_system
from verify.proof.structures.structure_order import prove_structure
from verify.schemes.maps.solved_stages import write_out
from verify.structures.reading import KeepsRequest, read_structures

TURNED = "x_dot = y*z + z; y_dot = -x*z; z_dot = 2*z - 1"


@pytest.mark.parametrize("name", ["implicit-midpoint", "gauss4"])
def test_stages_that_are_linear_one_after_the_other_are_solved(name: str) -> None:
    """The stages of z first, then those of x and y, which are as an iteration has them."""
    names, place = ("x", "y", "z"), {"x": "3/7", "y": "2/5", "z": "5/11", "h": "1/9"}
    x, y, z = sympy.symbols(names)
    step = SCHEMES[name](Field(names, (y * z + z, -x * z, 2 * z - 1)))
    numbers = {k: mp.mpf(Fraction(v).numerator) / Fraction(v).denominator for k, v in place.items()}
    wanted = step([numbers[k] for k in names], mp.mpf(0), numbers["h"])
    step_map = schemes.get(name).step_map(read_system(TURNED))
    closed = write_out(step_map)
    assert step_map.closed is None
    assert closed is not None
    at = {k: Fraction(v) for k, v in place.items()}
    for element, end in zip(closed.elements, wanted, strict=True):
        ball = enclose(closed.ring, element, at, 256)
        assert abs(mp.mpf(ball.mid().str(60, radius=False)) - end) < mp.mpf(10) ** -50


def test_other_stages_have_no_closed_form() -> None:
    for text in ("p**2/2 + q**2/2 + q**4/4", "x_dot = y; y_dot = x*y", "x_dot = sin(x)"):
        assert write_out(schemes.get("gauss4").step_map(read_system(text))) is None


@pytest.mark.parametrize(
    ("text", "request_", "verdict"),
    [
        ("u_dot = 2*u; v_dot = -3*u**2 - 2*u", KeepsRequest(form="du^dv/u"), "PROVED"),
        ("x_dot = 2*x; y_dot = -y; z_dot = -z", KeepsRequest(("volume",)), "REFUTED"),
    ],
)
def test_what_solved_stages_keep_is_decided(
    text: str, request_: KeepsRequest, verdict: str
) -> None:
    """By hand: u' = R u divides out of du∧dv/u, and the volume is R(2h) R(−h)² ≠ 1."""
    system, scheme = read_system(text), schemes.get("implicit-midpoint")
    (claim,) = read_structures(request_, system)
    assert prove_structure(scheme.step_map(system), claim.structure, scheme).verdict == verdict
