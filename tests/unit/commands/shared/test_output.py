"""What is told of a result on the terminal, where least is known of it."""

import pytest

from tests.end_to_end.test_command_line import here


def test_where_float64_has_lost_every_digit_none_is_printed(
    capsys: pytest.CaptureFixture[str],
) -> None:
    orbit = ("--step-size", "1.8", "--steps", "300", "--q", "3.1", "--p", "0")
    status, out, err = here(capsys, "run", "--system", "pendulum", "--scheme", "lie2", *orbit)
    assert (status, err) == (0, "")
    names = ("Λ  ", "Λ, plain", "MSE", "max |ΔJ|", "max |H − H₀|", "H − H₀", "q", "p")
    lines = out.splitlines()[: len(names)]
    assert all(x.startswith(name) and "|·| ≤ " in x for x, name in zip(lines, names, strict=True))
