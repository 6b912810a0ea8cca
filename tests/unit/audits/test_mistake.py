"""Findings: what a person has described is shown again before it is told."""

import importlib.util
import shutil
from pathlib import Path

import pytest

from tests.paths import ROOT
from verify.audits import libraries as others
from verify.audits.mistake import (
    Description,
    NotConfirmedError,
    TableCorrection,
    _confirm_table,
    change_entries,
    confirm,
    descriptions,
    entry_of,
    read,
    run,
)
from verify.audits.mistake_note import note
from verify.errors import InputError
from verify.scenes.results.claim import ClaimResult
from verify.verdict import Verdict

EVERY = descriptions()
OF_LIBRARIES = {name: x for name, x in EVERY.items() if x.language == "python"}
# The first of each; the command tells a finding only where all of them show it.
TABLES = [(name, table) for name, x in EVERY.items() for table in x.table[:1]]


def claim(id_: str, verdict: Verdict = Verdict.REFUTED) -> ClaimResult:
    return ClaimResult(
        id=id_, kind="order", source="m", section="s", statement="order 4", scene="",
        verdict=verdict, evidence="its order is 1",
    )  # fmt: skip


def test_every_description_is_read_and_has_plain_words() -> None:
    assert len(EVERY) >= 15
    for name, found in EVERY.items():
        for words in (found.title, found.holds, found.mend):
            assert not {"refuted", "kick", "kicks", "ΔJ"} & set(words.lower().split()), (
                name,
                words,
            )
        assert found.language == "python" or found.ran, f"{name}: run by whom, or why not"


@pytest.mark.parametrize(
    ("name", "table"), TABLES, ids=[f"{n}-{k}" for k, (n, _) in enumerate(TABLES)]
)
def test_each_table_shows_the_mistake_and_the_mend(name: str, table: TableCorrection) -> None:
    shown = _confirm_table(table)
    assert all(x.is_below(shown.claimed) for x in shown.printed)
    assert bool(shown.mended) is bool(table.changes)


@pytest.mark.parametrize("name", OF_LIBRARIES)
def test_each_program_of_a_library_that_is_installed_shows_it(name: str) -> None:
    described = OF_LIBRARIES[name]
    (module,) = (
        others.get(x) for x in others.names() if described.library.split()[0] == others.get(x).TITLE
    )
    if importlib.util.find_spec(module.LIBRARY) is None:
        pytest.skip(f"{module.TITLE} is not installed")
    judged = {x.name for x in module.integrators()}
    for id_ in described.claims:
        assert id_.split("/", 1)[1].rpartition("/")[0] in judged, id_
    own = [claim(id_) for id_ in described.claims]
    found = confirm(name, described, own)
    text = note(found, "Judged here.")
    assert described.quote.split()[0] in text
    assert "It prints:" in text


MINE = """\
title = "m is of order 1"
library = "mine"
claims = ["mine/*/order"]
quote = "order 4"
where = "its documentation"
holds = "It is of order 1."
blame = "line 1"
mend = "line 2"
language = "python"
program = '''print("order on a pendulum: 1.00")'''
mended = '''print("order on a pendulum: 4.00")'''
"""


def mine(tmp_path: Path, text: str = MINE) -> Description:
    path = tmp_path / "mine.toml"
    path.write_text(text, encoding="utf-8")
    return read(path)


def test_a_note_is_for_a_maintainer(tmp_path: Path) -> None:
    found = confirm("mine", mine(tmp_path), [claim("mine/[m]/order")])
    text = note(found, "Judged here: mine 1.0.")
    assert text.startswith("# m is of order 1\n")
    for part in ("## What is claimed", "> order 4", "```python", "order on a pendulum: 1.00",
                 "## A mend", "order on a pendulum: 4.00"):  # fmt: skip
        assert part in text


@pytest.mark.parametrize(
    ("old", "new", "verdict", "said"),
    [
        ("", "", None, "none of its claims was judged"),
        ("", "", Verdict.PROVED, "not refuted"),
        ("4.00", "1.50", Verdict.REFUTED, "does not raise the order"),
        ('print("order on a pendulum: 1.00")', "raise SystemExit('no')", Verdict.REFUTED, "no"),
    ],
)  # fmt: skip
def test_what_is_not_shown_again_is_not_told(
    tmp_path: Path, old: str, new: str, verdict: Verdict | None, said: str
) -> None:
    claims = [] if verdict is None else [claim("mine/m/order", verdict)]
    described = mine(tmp_path, MINE.replace(old, new) if old else MINE)
    with pytest.raises(NotConfirmedError, match=said):
        confirm("mine", described, claims)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('title = "m is of order 1"\n', "", "title"),
        ('"python"', '"cobol"', "language"),
        ("title =", "title", "not TOML"),
        ('quote = "order 4"', "quote = 4", "quote"),
    ],
)
def test_a_description_that_is_none_is_named(tmp_path: Path, old: str, new: str, said: str) -> None:
    with pytest.raises(InputError, match=said):
        mine(tmp_path, MINE.replace(old, new))


def test_a_right_table_and_a_mend_that_mends_nothing_are_not_told() -> None:
    right = TableCorrection(id="GSL/gsl_odeiv2_step_rk4", kind="order")
    with pytest.raises(NotConfirmedError, match="do not show it"):
        _confirm_table(right)
    wrong = TableCorrection(
        id="GeometricIntegrators.jl/TableauRK42", kind="order", changes={"a.4.3": "3"}
    )
    with pytest.raises(NotConfirmedError, match="its order is not 4"):
        _confirm_table(wrong)
    for changes in ({"a.4.9": "2"}, {"nonsense": "1"}, {"times": "right"}):
        other = TableCorrection(
            id="GeometricIntegrators.jl/TableauRK42", kind="order", changes=changes
        )
        with pytest.raises(NotConfirmedError):
            _confirm_table(other)
    with pytest.raises(InputError, match="none of the printed tables"):
        entry_of("GSL/nothing")


def test_changes_are_made_in_a_copy() -> None:
    entry = entry_of("GeometricIntegrators.jl/TableauRK42")
    other = change_entries(entry, {"a.4.3": "2"})
    assert entry != other
    assert entry == entry_of("GeometricIntegrators.jl/TableauRK42")


def test_a_program_that_does_not_end_is_ended(monkeypatch: pytest.MonkeyPatch) -> None:
    from verify.audits import mistake

    monkeypatch.setattr(mistake, "_PROGRAM_SECONDS", 0.5)
    assert "does not end" in run("while True:\n    pass\n").failed


def test_the_notes_in_the_repository_are_those_of_the_descriptions() -> None:
    notes = {path.stem for path in (ROOT / "reports" / "audits").glob("*.md")}
    assert notes == set(EVERY)


@pytest.mark.parametrize("name", [name for name, x in EVERY.items() if x.language in ("c", "c++")])
def test_a_program_in_c_that_needs_no_library_runs(name: str, tmp_path: Path) -> None:
    """Those that copy a table's numbers are compiled and run; the others need their library."""
    import subprocess

    described = EVERY[name]
    standard = {
        "math.h",
        "stdio.h",
        "cmath",
        "cstdio",
        "vector",
        "algorithm",
        "array",
        "iostream",
        "iomanip",
        "functional",
        "string",
        "utility",
    }
    included = {
        line.split("<")[1].split(">")[0]
        for line in described.program.splitlines()
        if line.startswith("#include <")
    }
    if not included <= standard:
        pytest.skip(f"{described.library} is not installed")
    compiler = shutil.which("g++" if described.language == "c++" else "gcc")
    if compiler is None:
        pytest.skip("no compiler is installed")
    source = tmp_path / ("program.cpp" if described.language == "c++" else "program.c")
    source.write_text(described.program, encoding="utf-8")
    subprocess.run([compiler, str(source), "-o", str(tmp_path / "program"), "-lm"], check=True)
    printed = subprocess.run(
        [str(tmp_path / "program")], check=True, capture_output=True, text=True
    )
    assert "order on " in printed.stdout
