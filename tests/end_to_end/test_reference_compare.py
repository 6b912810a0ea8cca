"""`verify reference compare`: the example programs, what is printed, JSON's keys, statuses."""

import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.end_to_end.test_command_line import here, json_of
from tests.paths import ROOT

README = ROOT / "reference" / "README.md"
GIVEN = ["--scene", "duffing", "--scheme", "lie2", "--step-size", "0.001", "--q", "1.5", "--p", "0"]
EXAMPLES = ROOT / "reference" / "examples"
LANGUAGES = {".c": "c", ".f90": "fortran", ".py": "python", ".jl": "julia"}


def examples() -> dict[str, str]:
    return {path.name: path.read_text(encoding="utf-8") for path in EXAMPLES.glob("*.*")}


def quoted(page: str) -> list[tuple[str, str]]:
    """(language, text) of each program on a page."""
    languages = "|".join(LANGUAGES.values())
    return re.findall(rf"^```({languages})\n(.*?)^```$", page, re.DOTALL | re.MULTILINE)


def quotes(page: str, programs: dict[str, str]) -> bool:
    """Whether a page has these programs, each once, word for word, and no others."""
    wanted = [(LANGUAGES[Path(name).suffix], text) for name, text in programs.items()]
    return sorted(quoted(page)) == sorted(wanted)


def test_the_readme_quotes_the_example_programs_word_for_word() -> None:
    page, programs = README.read_text(encoding="utf-8"), examples()
    assert {Path(name).suffix for name in programs} == set(LANGUAGES)
    assert quotes(page, programs)
    assert all(f"reference/examples/{name}" in page for name in programs), "says where they lie"


@pytest.mark.parametrize("name", sorted(examples()))
def test_a_quotation_that_is_not_word_for_word_is_seen(name: str) -> None:
    page, programs = README.read_text(encoding="utf-8"), examples()
    text = programs.pop(name)
    assert not quotes(page, programs), "a program that is in no file"
    for changed in (text.replace("3", "2", 1), text + "\n", text.replace("\n", " \n", 1)):
        assert changed != text
        assert not quotes(page, programs | {name: changed})
        assert not quotes(page.replace(text, changed), programs | {name: text})
    assert not quotes(page.replace(text, ""), programs | {name: text})
    assert quotes(page, programs | {name: text})


def by_c(folder: Path, source: str) -> str:
    return compiled(folder, source, "mine.c", "cc", "gcc", "clang")


def by_fortran(folder: Path, source: str) -> str:
    return compiled(folder, source, "mine.f90", "gfortran", "flang")


def compiled(folder: Path, source: str, file: str, *compilers: str) -> str:
    compiler = next(filter(None, map(shutil.which, compilers)), None)
    if compiler is None:
        pytest.skip(f"no {compilers[0]}")
    (folder / file).write_text(source)
    subprocess.run([compiler, "-O2", file, "-o", "mine"], cwd=folder, check=True)
    return subprocess.run(["./mine"], cwd=folder, check=True, capture_output=True, text=True).stdout


def by_python(folder: Path, source: str) -> str:
    (folder / "mine.py").write_text(source)
    command = [sys.executable, "mine.py"]
    return subprocess.run(command, cwd=folder, check=True, capture_output=True, text=True).stdout


@pytest.mark.left_to_ci
@pytest.mark.sample(2)
@pytest.mark.parametrize(
    ("name", "run"), [("lie2.c", by_c), ("lie2.f90", by_fortran), ("lie2.py", by_python)]
)
def test_an_example_program_differs_by_rounding(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, name: str, run: object
) -> None:
    table = tmp_path / "mine.csv"
    assert callable(run)
    table.write_text(run(tmp_path, examples()[name]))
    status, out, _ = here(capsys, "reference", "compare", str(table), *GIVEN)
    assert status == 0
    assert out.startswith("6 rows of 1 run compared; 5,001 rows read\n")
    assert "DIFFERS" not in out
    assert "float64 rounding explains" in out
    assert ("determinant" in out) == (name == "lie2.py")


def test_a_mistake_is_told_to_people_and_to_programs(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    table = tmp_path / "mine.csv"
    table.write_text(by_python(tmp_path, examples()["lie2.py"]))
    lines = table.read_text().splitlines()
    swapped = [",".join([x[0], x[2], x[1]]) for x in (line.split(",") for line in lines)]
    table.write_text("\n".join(["step,p,q", *swapped[1:]]))
    status, out, _ = here(capsys, "reference", "compare", str(table), *GIVEN)
    assert status == 1
    assert "in 1 run: your columns p and q are swapped\n" in out
    status, out, _ = here(capsys, "reference", "compare", str(table), *GIVEN, "--json")
    shown = json_of(out)
    assert status == 1
    assert shown["agrees"] is False
    assert [x["column"] for x in shown["columns"]] == ["p", "q"]
    assert {x["verdict"] for x in shown["columns"]} == {"more than rounding"}
    assert [x["parts_at"] for x in shown["columns"]] == [0, 0]
    (diagnosis,) = shown["diagnoses"]
    assert diagnosis["certain"]
    assert diagnosis["mistakes"][0]["id"] == "swapped-columns"
    assert shown["rows"] == 6
    assert shown["other_steps"] == 4995


@pytest.mark.left_to_ci
@pytest.mark.parametrize(
    ("content", "options", "told"),
    [
        ("", GIVEN, "is empty"),
        ("step,p\n0,zero\n", GIVEN, "line 2, p=zero: not a finite number"),
        ("step,p\n7,1\n", GIVEN, "has no row of these data"),
        ("step,p\n0,\n1,\n", GIVEN, "are empty"),
        ("step,p\n0,1\n", [*GIVEN[:3], "lie37", *GIVEN[4:]], "scheme = lie37, step_size = 0.001"),
        ("step,p\n0,1\n", [], "--scene"),
        ("step,p\n0,1\n", [*GIVEN, "--column", "p"], "OURS=THEIRS"),
        ("step,p\n0,1\n", ["--scene", "nowhere"], "scene=nowhere: unknown; allowed: driven-"),
        ("step,p\n0,1\n", ["--scene", "dufing", *GIVEN[2:]], "is duffing meant? allowed: driven-"),
        ("step,p\n0,1\n", [*GIVEN, "--data", "nowhere"], "is no folder"),
    ],
)
def test_bad_input_is_one_line_and_status_2(
    capsys: pytest.CaptureFixture[str],
    tmp_path: Path,
    content: str,
    options: list[str],
    told: str,
) -> None:
    table = tmp_path / "mine.csv"
    table.write_text(content)
    status, out, err = here(capsys, "reference", "compare", str(table), *options)
    assert (status, out) == (2, "")
    assert told in err
    assert err.count("\n") == 1
    assert "Traceback" not in err


def test_what_rounding_leaves_no_digit_of_is_not_said_to_have_0_digits(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    """q starts 10⁻²² from an unstable equilibrium, on which doubles stay; its number is long."""
    table = tmp_path / "mine.csv"
    given = ["--scene", "extreme-soft-duffing", "--scheme", "lie2"]
    given += ["--q", "0.9999999999999999999999", "--p", "0"]
    table.write_text("step,p,q\n0,0,1.0\n1,0.0,1.0\n4000,0.0,1.0\n")
    status, out, _ = here(capsys, "reference", "compare", str(table), *given)
    assert status == 0
    run = "extreme-soft-duffing: lie2, h = 0.01, (q, p) = (9.999999999999999999999e-01, 0)"
    explained = "differs by what float64 rounding explains, which leaves no digit at step 1"
    assert f"  p  {explained} ({run})\n" in out
    assert "  q   22.0 digits" in out
    assert f"{run}: from step 4000 on rounding may have taken every digit; not judged\n" in out
    table.write_text("step,p,q\n4000,0.0,1.0\n")
    status, out, _ = here(capsys, "reference", "compare", str(table), *given)
    assert status == 0
    assert "  p  says nothing: rounding may have taken every digit\n" in out
    shown = json_of(here(capsys, "reference", "compare", str(table), *given, "--json")[1])
    assert [(x["verdict"], x["digits"], x["rows"]) for x in shown["columns"]] == [
        ("lost", None, 0)
    ] * 2


@pytest.mark.parametrize(("kick", "status"), [(1.0, 0), (1.0 + 1e-9, 1)])
def test_a_table_of_two_degrees_of_freedom_is_held_against_the_published_data(
    kick: float, status: int, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Störmer and Verlet's method on Hénon and Heiles's H, in doubles; and with a wrong kick."""
    h, p1, p2, q1, q2 = 0.1, 0.4, 0.0, 0.0, 0.1
    rows = ["step,p1,p2,q1,q2"]
    for n in range(101):
        rows.append(f"{n},{p1!r},{p2!r},{q1!r},{q2!r}")
        p1, p2 = p1 - kick * h / 2 * (q1 + 2 * q1 * q2), p2 - h / 2 * (q2 + q1**2 - q2**2)
        q1, q2 = q1 + h * p1, q2 + h * p2
        p1, p2 = p1 - h / 2 * (q1 + 2 * q1 * q2), p2 - h / 2 * (q2 + q1**2 - q2**2)
    table = tmp_path / "mine.csv"
    table.write_text("\n".join(rows) + "\n")
    given = ["--scene", "several-henon-heiles", "--scheme", "stormer-verlet", "--step-size", "0.1"]
    start = ["--q", "0,0.1", "--p", "0.4,0"]
    found, out, _ = here(capsys, "reference", "compare", str(table), *given, *start)
    assert found == status
    assert out.startswith("4 rows of 1 run compared; 101 rows read\n")
