"""Runs in ball arithmetic through points where all digits cancel."""

from fractions import Fraction

from hypothesis import given
from hypothesis import strategies as st

from tests.examples import drawn
from verify import arithmetic as number_systems
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.runs.requested_run import run

sizes = st.builds(Fraction, st.integers(1, 20), st.sampled_from([3, 7, 11, 15]))


@drawn(12)
@given(sizes, sizes, st.integers(1, 6), st.integers(1, 6), st.integers(3, 30))
def test_an_orbit_of_balls_goes_on_from_where_it_is_zero(
    q: Fraction, h: Fraction, before: int, after: int, digits: int
) -> None:
    """p is k h q and loses h q at a step: after k of them no bit of its ball is known, and yet p.

    With a point kept of every step each state is looked at.
    """
    steps = before + after
    found = run(
        Hamiltonian.parse("p**2/2 + q**2/2"), "p_next = p - h*q; q_next = q", q=q, p=before * h * q,
        step_size=h, steps=steps, arithmetic="ball", digits=digits, points=steps,
    )  # fmt: skip
    assert (found.status, found.error_kind) == ("finished", "enclosed")
    for name, true in (("p", -after * h * q), ("q", q), ("lambda", Fraction(0))):
        value = found.values[name]
        assert abs(Fraction(value.value) - true) <= Fraction(value.bound)
        assert Fraction(value.bound) <= abs(true) / 10 ** (digits - 2)
    # As h/n + … + h/n − h: about 0, and of no relative accuracy. What is astronomical is not known.
    ball = number_systems.get("ball", digits)
    with ball.context():
        rest = sum((ball.number(h / before) for _ in range(before)), -ball.number(h))
        assert ball.finite(rest)
        assert not ball.finite(rest + ball.number(Fraction(2)) ** 10**7)
