"""All commands have one style of options, and one that stands once may stand once."""

from collections.abc import Iterator

import click
import pytest

from tests.end_to_end.test_command_line import here
from verify.commands.main import cli


def all_commands(
    group: click.Group, names: tuple[str, ...] = ()
) -> Iterator[tuple[str, click.Command]]:
    for name, command in group.commands.items():
        if isinstance(command, click.Group):
            yield from all_commands(command, (*names, name))
        else:
            yield " ".join((*names, name)), command


COMMANDS = dict(all_commands(cli))
OPTIONS = [
    (name, option)
    for name, command in COMMANDS.items()
    for option in command.params
    if isinstance(option, click.Option)
]


def test_they_are_all_there() -> None:
    assert {"prove", "run", "certificate check", "reference compare"} <= set(COMMANDS)
    assert len(OPTIONS) > 100


@pytest.mark.parametrize(("name", "option"), OPTIONS, ids=lambda x: str(getattr(x, "name", x)))
def test_an_option_is_told_in_one_style(name: str, option: click.Option) -> None:
    assert option.help, "says nothing"
    assert option.help.rstrip(")]").endswith((".", "or:", "…")) or "[default" in option.help
    told = option.metavar or option.type.name in {"choice", "text"}
    assert told or option.is_flag
    assert ("repeatable" in option.help) == option.multiple
    if "--output" in option.opts:
        assert option.opts == ["-o", "--output"]
        assert str(option.metavar).startswith(("DIR", "FILE"))


def test_commands_that_check_claims_may_allow_undecided() -> None:
    having = {name for name, option in OPTIONS if "--allow-undecided" in option.opts}
    assert having == {"check", "check-integrator", "check-map", "check-table"}


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ("prove --scheme lie2 --system pendulum --system=duffing",
         "--system=pendulum, duffing: verify prove takes one; call it once for each"),
        ("reference check --seed 1 --seed 2",
         "--seed=1, 2: verify reference check takes one; call it once for each"),
        ("report paper -o here --output there",
         "--output=here, there: verify report takes one; call it once for each"),
    ],
)  # fmt: skip
def test_an_option_that_stands_once_is_not_given_twice(
    capsys: pytest.CaptureFixture[str], given: str, said: str
) -> None:
    assert here(capsys, *given.split()) == (2, "", f"verify: {said}\n")


def test_who_compares_schemes_is_told_the_commands_that_take_several(
    capsys: pytest.CaptureFixture[str],
) -> None:
    given = "run --scheme lie2 --scheme lie3 --system pendulum --step-size 1 --steps 1 --q 1 --p 0"
    status, _, err = here(capsys, *given.split())
    assert (status, err.count("\n")) == (2, 1)
    said, _, several = err.strip().partition("; several go with ")
    assert said == "verify: --scheme=lie2, lie3: verify run takes one"
    having = {f"verify {n}" for n, x in OPTIONS if "--scheme" in x.opts and x.multiple}
    assert set(several.split(", ")) == having
    assert "verify bench" in having


def test_what_is_repeatable_and_what_is_refused_anyhow_are_as_before(
    capsys: pytest.CaptureFixture[str],
) -> None:
    given = "prove --scheme lie2 --hamiltonian a*p**2+b*q**2 --param a=1 --param b=2"
    assert here(capsys, *given.split())[0] == 0
    assert "no such option" in here(capsys, "run", "--nonsense")[2]
