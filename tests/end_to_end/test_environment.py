"""VERIFY_LANES that is no way is refused by every command; `test_cache.py` is of VERIFY_CACHE."""

import pytest

from tests.end_to_end.test_closed_streams import COMMANDS
from tests.end_to_end.test_command_line import here
from verify.arithmetic.compiled import paths


@pytest.mark.parametrize("command", COMMANDS)
def test_a_value_that_is_none_is_refused_by_every_command(
    command: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("VERIFY_LANES", "bogus")
    status, out, err = here(capsys, *command.split(), *COMMANDS[command].split())
    said = "verify: VERIFY_LANES=bogus: allowed: avx512, avx2, portable, off\n"
    assert (status, out, err) == (2, "", said)


@pytest.mark.parametrize("value", ["", paths.OFF, *paths.PATHS])
def test_a_value_that_is_one_is_taken(
    value: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("VERIFY_LANES", value)
    assert here(capsys, "systems")[0] == 0


def test_help_is_given_whatever_it_is(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("VERIFY_LANES", "bogus")
    assert here(capsys, "--help")[0] == 0
