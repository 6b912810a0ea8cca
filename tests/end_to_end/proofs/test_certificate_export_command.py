"""`verify certificate export` and `… theory`: what they write, and what they refuse."""

import json
import os
from pathlib import Path

import pytest

from tests.end_to_end.test_command_line import here, json_of
from tests.helpers.rocq.assumptions import without_comments

ONE = ["prove", "--system", "duffing", "--scheme", "lie2"]
EVERY = ["prove", "--every-hamiltonian", "--scheme", "stormer-verlet"]


@pytest.fixture
def certificate(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> Path:
    path = tmp_path / "c.json"
    assert here(capsys, *ONE, "--certificate", str(path))[0] == 0
    return path


def export(
    capsys: pytest.CaptureFixture[str], certificate: Path, out: Path | str, *more: str
) -> tuple[int, str, str]:
    return here(capsys, "certificate", "export", str(certificate), "--coq", str(out), *more)


def refused(answer: tuple[int, str, str], *words: str) -> None:
    """With status 2 and one line."""
    status, out, err = answer
    assert (status, out, err.count("\n")) == (2, "", 1)
    assert all(word in err for word in words), err


def test_an_export_says_what_it_proves_and_how_it_is_checked(
    capsys: pytest.CaptureFixture[str], certificate: Path, tmp_path: Path
) -> None:
    out = tmp_path / "lie2.v"
    status, told, err = export(capsys, certificate, out)
    assert (status, err) == (0, "")
    first, proves, check = told.splitlines()
    assert first.startswith(f"{out}: det J")
    assert "determinant_has_its_order, first_coefficient_telescopes" in proves
    assert check.split() == ["check", "coqc", str(out)]
    assert "AreaPreservation" not in without_comments(out.read_text())
    told = export(capsys, certificate, out, "--beside-theory")[1]
    assert "coqc -Q THEORY AreaPreservation" in told
    assert "From AreaPreservation Require Import" in out.read_text()


@pytest.mark.parametrize("beside", [False, True])
@pytest.mark.parametrize("command", [ONE, EVERY])
def test_the_keys_of_an_export(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, command: list[str], beside: bool
) -> None:
    path, out = tmp_path / "c.json", tmp_path / "x.v"
    here(capsys, *command, "--certificate", str(path))
    more = ["--beside-theory"] * beside
    status, told, _ = export(capsys, path, out, "--json", *more)
    found = json_of(told)
    assert status == 0
    assert set(found) == {"written", "statement", "theorems", "stands_alone"}
    assert found["written"] == str(out)
    assert found["stands_alone"] is not beside
    assert found["statement"].startswith("det J")
    text = out.read_text()
    assert found["theorems"]
    assert all(f"\nTheorem {name} :" in text for name in found["theorems"])


@pytest.mark.parametrize("name", ["lie2-a.v", "1.v", "forall.v", "lie2", "lie 2.v", "é.v"])
def test_a_name_that_coqc_does_not_take_is_refused(
    capsys: pytest.CaptureFixture[str], certificate: Path, tmp_path: Path, name: str
) -> None:
    before = sorted(tmp_path.iterdir())
    refused(export(capsys, certificate, tmp_path / name), "coq", "lie2.v")
    assert sorted(tmp_path.iterdir()) == before


def test_a_folder_is_no_file_to_write(
    capsys: pytest.CaptureFixture[str], certificate: Path, tmp_path: Path
) -> None:
    refused(export(capsys, certificate, tmp_path), "--coq", "is a folder")


def test_what_is_refused_or_is_no_certificate_is_not_exported(
    capsys: pytest.CaptureFixture[str], certificate: Path, tmp_path: Path
) -> None:
    data, out = json.loads(certificate.read_text()), tmp_path / "x.v"
    for key, value, said in (
        ("order", 4, "is refused"),
        ("scheme", "*) Axiom a : False. (*", "is refused"),
        ("convergence_order", "2", "is refused"),
        ("format", "areaproof certificate 9", "format"),
    ):
        certificate.write_text(json.dumps({**data, key: value}))
        refused(export(capsys, certificate, out), said)
    for text in ("", "[]", "{", "\x00"):
        certificate.write_text(text)
        refused(export(capsys, certificate, out))
    refused(export(capsys, tmp_path / "none.json", out), "No such file")
    assert not out.exists()


def test_nothing_is_written_where_nothing_may_be(
    capsys: pytest.CaptureFixture[str], certificate: Path, tmp_path: Path
) -> None:
    (tmp_path / "folder.v").mkdir()
    kept = tmp_path / "kept.v"
    kept.write_text("mine")
    kept.chmod(0o444)
    os.mkfifo(tmp_path / "pipe.v")
    (tmp_path / "link.v").symlink_to(tmp_path / "nowhere.v")
    places = ["folder.v", "kept.v", "pipe.v", "link.v"]
    refused(export(capsys, certificate, certificate / "x.v"), "c.json")
    for place in [*(tmp_path / name for name in places), Path("/proc/x.v")]:
        refused(export(capsys, certificate, place), place.name)
    assert kept.read_text() == "mine"


def test_a_certificate_may_lie_at_an_end_of_a_pipe_no_more_than_elsewhere(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    os.mkfifo(tmp_path / "pipe")
    for place in (tmp_path / "pipe", tmp_path, Path("/dev/zero")):
        refused(export(capsys, place, tmp_path / "x.v"))


def test_the_theory_is_written_with_its_project_file(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    folder = tmp_path / "theory"
    status, told, err = here(capsys, "certificate", "theory", str(folder))
    assert (status, err) == (0, "")
    assert "coq_makefile -f _CoqProject" in told
    found = json_of(here(capsys, "certificate", "theory", str(folder), "--json")[1])
    assert set(found) == {"written", "logical_name"}
    assert found["logical_name"] == "AreaPreservation"
    assert sorted(found["written"]) == sorted(map(str, folder.rglob("*.v")))
    options, *listed = (folder / "_CoqProject").read_text().splitlines()
    assert options == "-Q . AreaPreservation"
    assert [str(folder / line) for line in listed] == found["written"]


def test_the_theory_is_not_written_over_a_file(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    (tmp_path / "file").write_text("mine")
    refused(here(capsys, "certificate", "theory", str(tmp_path / "file")), "file")
    refused(here(capsys, "certificate", "theory", "/proc/theory"), "/proc/theory")
    assert (tmp_path / "file").read_text() == "mine"
