"""What is told of a result on the terminal, where least is known of it."""

import json

import click
import pytest
from click.testing import CliRunner

from tests.end_to_end.test_command_line import here
from verify.commands.shared.option import flag, option, options
from verify.commands.shared.output import CommandAnswer, answering


def test_where_float64_has_lost_every_digit_none_is_printed(
    capsys: pytest.CaptureFixture[str],
) -> None:
    orbit = ("--step-size", "1.8", "--steps", "300", "--q", "3.1", "--p", "0")
    status, out, err = here(capsys, "run", "--system", "pendulum", "--scheme", "lie2", *orbit)
    assert (status, err) == (0, "")
    names = ("Λ  ", "Λ, plain", "MSE", "max |ΔJ|", "max |H − H₀|", "H − H₀", "q", "p")
    lines = out.splitlines()[: len(names)]
    assert all(x.startswith(name) and "|·| ≤ " in x for x, name in zip(lines, names, strict=True))


@pytest.mark.parametrize("timed", [True, False])
def test_json_ends_with_the_seconds_of_a_command_that_is_timed(
    timed: bool, capsys: pytest.CaptureFixture[str]
) -> None:
    @answering
    def command() -> CommandAnswer:
        return CommandAnswer(lambda: {"a": 1}, lambda: None, timed=timed)

    command(as_json=True)
    data = json.loads(capsys.readouterr().out)
    assert [*data] == (["a", "seconds"] if timed else ["a"])
    assert float(data.get("seconds", 0)) >= 0


def test_an_option_has_its_names_its_placeholder_and_its_help() -> None:
    @click.command()
    @options(option("--size sizes", "H", "The size.", multiple=True), flag("--all every", "All."))
    def command(sizes: tuple[str, ...], every: bool) -> None:
        click.echo(f"{sizes} {every}")

    result = CliRunner().invoke(command, ["--size", "1", "--size", "2", "--all"])
    assert result.output == "('1', '2') True\n"
    told = CliRunner().invoke(command, ["--help"]).output.split()
    assert told.index("--size") < told.index("--all")
    assert "H" in told[told.index("--size") + 1]
