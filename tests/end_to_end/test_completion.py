"""A shell that completes a line is told schemes, systems, files, and nothing else."""

import pytest

from tests.end_to_end.test_command_line import here
from verify import schemes

TOLD = {
    "a system": ("run --system du", ["plain,duffing"]),
    "systems in any case": ("run --system Double_W", ["plain,double-well"]),
    "a scheme": ("prove --scheme gaus", ["plain,gauss4", "plain,gauss6"]),
    "a scheme in any case": ("prove --scheme RK", ["plain,rk4"]),
    "an alias": ("separate --scheme verl", ["plain,verlet"]),
    "a second scheme": ("bench --scheme lie1 --scheme stor", ["plain,stormer-verlet"]),
    "the scheme of a table": ("reference compare --scheme rk", ["plain,rk4"]),
    "a scene": ("report pap", ["plain,paper", "file,pap"]),
    "a suite": ("plan sti", ["plain,stiff", "file,sti"]),
    "claims": ("check cl", ["file,cl"]),
    "a file": ("explore cl", ["file,cl"]),
    "a command": ("stab", ["plain,stability"]),
    "after a mistake": ("run --q 1 --q 2 --system du", ["plain,duffing"]),
    "what is not there": ("run --system nosuch", []),
}  # fmt: skip


@pytest.mark.parametrize(("line", "told"), TOLD.values(), ids=TOLD)
def test_a_line_is_completed(
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    line: str,
    told: list[str],
) -> None:
    words = ["verify", *line.split()]
    monkeypatch.setenv("_VERIFY_COMPLETE", "bash_complete")
    monkeypatch.setenv("COMP_WORDS", " ".join(words))
    monkeypatch.setenv("COMP_CWORD", str(len(words) - 1))
    status, out, err = here(capsys)
    assert (status, err) == (0, "")
    assert out.split() == told


def test_with_nothing_begun_all_names_are_told_and_no_aliases(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("_VERIFY_COMPLETE", "bash_complete")
    monkeypatch.setenv("COMP_WORDS", "verify prove --scheme ")
    monkeypatch.setenv("COMP_CWORD", "3")
    _, out, _ = here(capsys)
    assert out.split() == [f"plain,{name}" for name in schemes.names()]


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_a_shell_is_given_its_script(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, shell: str
) -> None:
    monkeypatch.setenv("_VERIFY_COMPLETE", f"{shell}_source")
    status, out, err = here(capsys)
    assert (status, err) == (0, "")
    assert f"_VERIFY_COMPLETE={shell}_complete" in out
