"""`verify export`: code on standard output, in a file, in JSON."""

from pathlib import Path

import pytest

from tests.end_to_end.test_command_line import here, json_of

OPTIONS = ("export", "--system", "duffing", "--scheme", "ruth3")


def test_the_code_is_told_written_and_in_json(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    code = here(capsys, *OPTIONS)[1]
    file = tmp_path / "step.py"
    assert here(capsys, *OPTIONS, "-o", str(file))[:2] == (0, f"{file}\n")
    assert file.read_text() == code
    found = json_of(here(capsys, *OPTIONS, "--json")[1])
    assert found["code"] == code
    assert (found["area_preserving"], found["arguments"]) == (True, ["p", "q", "h", "delta"])
    constants = {c["exact"]: c["literal"] for c in found["constants"]}
    assert constants["7/24"] == repr(7 / 24)
    for c in found["constants"]:
        assert f"{c['name']} = {c['literal']}  # {c['exact']}" in code


@pytest.mark.parametrize(
    ("more", "said"),
    [
        (("--language", "pyton"), "--language=pyton: unknown; is python meant?"),
        (("--name", "a b"), "--name=a b: is no name for a function"),
        (("-o", "/"), "is a folder"),
    ],
)
def test_a_mistake_is_one_line(
    capsys: pytest.CaptureFixture[str], more: tuple[str, ...], said: str
) -> None:
    status, out, err = here(capsys, *OPTIONS, *more)
    assert (status, out, said in err, err.count("\n")) == (2, "", True, 1)
