"""`verify check`: exit statuses, JSON, people's text, light imports, and what is kept."""

import json
import os
import re
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import pytest

from tests.end_to_end.test_command_line import IMPORTED, here, json_of
from tests.end_to_end.test_report_command import interrupt, started
from tests.helpers.processes.processor_time import of_children_below
from tests.helpers.sampled.identities.drawn import HIDDEN
from tests.paths import ROOT

SYMBOLIC = """
[defaults]
scheme = "lie2"
hamiltonian = "p**2/2 + q**2/2 + delta*q**4/4"

[[claim]]
id = "map"
source = "Eq. 19"
statement = "The scheme is this map."
kind = "step_map"
p_next = "p - h*(q + delta*q**3) - h**2/2*p*(1 + 3*delta*q**2)"
q_next = "q + h*p - h**2/2*(q + delta*q**3)"

[[claim]]
id = "first-term"
kind = "delta_j"
formula = "3*h**3*delta*p*q"
up_to = 4

[[claim]]
id = "order"
kind = "defect_order"
defect_order = 3

[[claim]]
id = "convergence"
kind = "convergence_order"
convergence_order = 2

[[claim]]
id = "area"
kind = "area_preserving"
area_preserving = false
"""
WRONG = SYMBOLIC.replace("defect_order = 3", "defect_order = 4")
OPEN = SYMBOLIC.replace('"3*h**3*delta*p*q"', f'"3*h**3*delta*p*q + h*({HIDDEN})"')
NUMBERS = """
[defaults]
scheme = "lie2"
system = "duffing"
parameters = { delta = 1 }
step_size = 0.001
steps = 20000
q = 1.5
p = 0

[[claim]]
id = "lambda"
kind = "lambda"
printed = "-2.666e-06"

[[claim]]
id = "mse"
kind = "mse"
lg_printed = "-16.8154"

[[claim]]
id = "bound"
kind = "bounded"
bound = "6e-6"
"""
LONG = NUMBERS.replace("20000", "30000000")


@pytest.fixture
def claims(tmp_path: Path) -> Any:
    """Writes the claims, and returns the file's name."""

    def write(content: str) -> str:
        path = tmp_path / "claims.toml"
        path.write_text(content)
        return str(path)

    return write


@pytest.mark.parametrize(
    ("content", "status"),
    [(SYMBOLIC, 0), (WRONG, 1), (OPEN, 1), (NUMBERS, 0), (NUMBERS.replace("2.666", "2.667"), 1)],
    ids=["true", "wrong", "undecided", "numbers", "wrong-number"],
)
def test_the_exit_status_says_whether_a_claim_is_refuted_or_undecided(
    capsys: pytest.CaptureFixture[str], claims: Any, content: str, status: int
) -> None:
    found, out, err = here(capsys, "check", claims(content))
    assert (found, err) == (status, "")
    assert ("REFUTED" in out) == (status == 1 and content is not OPEN)
    assert ("UNDECIDED" in out) == (content is OPEN)
    count = content.count("[[claim]]")
    assert len(out.splitlines()) == count + 1, "one line a claim, and one that counts them"
    assert f"{count} claims: " in out


def test_json_is_one_object_with_the_claims(
    capsys: pytest.CaptureFixture[str], claims: Any
) -> None:
    status, out, err = here(capsys, "check", claims(WRONG), "--json")
    assert (status, err) == (1, "")
    told = json_of(out)
    found = told["claims"]
    assert set(told) == {"claims", "statements"}
    assert told["statements"] == []
    assert [c["id"] for c in found] == ["map", "first-term", "order", "convergence", "area"]
    assert [c["verdict"] for c in found] == ["PROVED", "PROVED", "REFUTED", "PROVED", "PROVED"]
    keys = {"id", "kind", "source", "statement", "verdict", "evidence", "domain"}
    keys |= {"statement_id", "reading", "standing", "checked_by"}
    assert all(set(c) == keys for c in found)
    assert [len(c["checked_by"]) > 0 for c in found] == [c["id"] != "map" for c in found]
    assert (found[0]["source"], found[0]["statement"]) == ("Eq. 19", "The scheme is this map.")
    assert all(c["evidence"] for c in found)


def test_a_bare_order_is_warned_of_where_it_is_checked(
    capsys: pytest.CaptureFixture[str], claims: Any
) -> None:
    path = claims(SYMBOLIC.replace("defect_order", "order"))
    status, out, err = here(capsys, "check", path)
    assert status == 0
    assert err.startswith("verify: claims.toml:22: claim order: ")
    for text in (err, next(line for line in out.splitlines() if "PROVED     order" in line)):
        assert "defect_order" in text
        assert "convergence_order" in text
    assert here(capsys, "check", path, "--only", "map")[2] == ""


def test_only_the_claims_that_are_named_are_checked(
    capsys: pytest.CaptureFixture[str], claims: Any
) -> None:
    path = claims(WRONG)
    assert here(capsys, "check", path, "--only", "order")[0] == 1
    status, out, _ = here(capsys, "check", path, "--only", "area", "--only", "m*", "--json")
    assert (status, [c["id"] for c in json_of(out)["claims"]]) == (0, ["map", "area"])


@pytest.mark.parametrize(
    ("content", "more", "named"),
    [
        (
            SYMBOLIC.replace("order = 3", "order = 0"),
            [],
            "claims.toml:23: claim order: defect_order=",
        ),
        (SYMBOLIC.replace("delta*p*q", "eps"), [], "claims.toml:17: claim first-term: formula="),
        (SYMBOLIC, ["--only", "none"], "--only=none: no claim has this id"),
        ("[[claim]", [], "is not TOML"),
        (NUMBERS, ["--keep", "/dev/null"], "/dev/null"),
        (NUMBERS, ["--workers", "0"], "--workers"),
    ],
)
def test_bad_input_is_one_line_and_status_2(
    capsys: pytest.CaptureFixture[str], claims: Any, content: str, more: list[str], named: str
) -> None:
    status, out, err = here(capsys, "check", claims(content), *more)
    assert (status, out) == (2, "")
    assert err.startswith("verify: ")
    assert err.count("\n") == 1
    assert named in err


def test_a_file_that_is_not_there_is_bad_input(capsys: pytest.CaptureFixture[str]) -> None:
    assert here(capsys, "check", "no-such.toml")[0] == 2
    assert here(capsys, "check")[0] == 2


# -- what is imported, and how long it takes ------------------------------------------------------


def imported(*given: str) -> set[str]:
    done = subprocess.run([sys.executable, "-c", IMPORTED, *given], capture_output=True, text=True,
                          env={**os.environ, "COLUMNS": "80"}, check=True)  # fmt: skip
    modules = set(done.stderr.rpartition("IMPORTED")[2].split())
    assert "click" in modules, "the modules were read"
    return modules


HEAVY = {"llvmlite", "matplotlib", "numpy", "jinja2", "rich", "reports"}


@pytest.mark.left_to_ci
def test_symbolic_claims_import_no_compiler_and_no_plots(claims: Any) -> None:
    assert not imported("check", claims(SYMBOLIC)) & HEAVY
    assert not imported("check", claims(NUMBERS), "--only", "lambda") & (HEAVY - {"numpy"})
    assert not imported("check", "--help") & (HEAVY | {"sympy", "flint", "pydantic"})


PRINTED = ("--only", "eq-19", "--only", "eq-2?", "--only", "eq-3?")  # equations 19–24 and 27–32


@pytest.mark.left_to_ci
def test_the_papers_equations_are_checked_in_seconds() -> None:
    """Measured: 1.1 s."""
    with of_children_below(5):
        modules = imported("check", "paper", *PRINTED)
    assert not modules & (HEAVY - {"reports"})


def test_the_paper_is_also_a_file_like_any_other(capsys: pytest.CaptureFixture[str]) -> None:
    path = ROOT / "reports" / "paper" / "claims.toml"
    by_path = here(capsys, "check", str(path), *PRINTED, "--json")
    by_name = here(capsys, "check", "paper", *PRINTED, "--json")
    assert by_path == by_name
    assert {c["verdict"] for c in json_of(by_path[1])["claims"]} == {"PROVED"}


# -- what is kept ---------------------------------------------------------------------------------


def test_what_is_finished_is_kept_and_taken_up(
    capsys: pytest.CaptureFixture[str], claims: Any, tmp_path: Path
) -> None:
    path, kept = claims(NUMBERS), tmp_path / "kept"
    first = here(capsys, "check", path, "--keep", str(kept), "--json")
    written = {f.name: f.stat().st_mtime_ns for f in kept.iterdir()}
    assert len(written) == 3
    assert here(capsys, "check", path, "--keep", str(kept), "--json") == first
    assert {f.name: f.stat().st_mtime_ns for f in kept.iterdir()} == written


@pytest.mark.left_to_ci
def test_an_interrupted_check_ends_with_130_and_says_what_is_kept(
    claims: Any, tmp_path: Path
) -> None:
    path, kept = claims(LONG), tmp_path / "kept"
    with started("check", path, "--keep", str(kept), "--workers", "1") as process:
        until = time.monotonic() + 60
        while not kept.exists():
            assert time.monotonic() < until
            assert process.poll() is None, "it is done before it is interrupted"
            time.sleep(0.02)
        status, out, err = interrupt(process)
    assert (status, out) == (130, "")
    assert re.fullmatch(r"interrupted: \d of 3 tasks are kept in \S+; the same command goes on "
                        r"from there", err.strip())  # fmt: skip


# -- documentation --------------------------------------------------------------------------------


def test_the_example_of_the_help_is_a_claims_file(
    capsys: pytest.CaptureFixture[str], claims: Any
) -> None:
    status, out, _ = here(capsys, "check", "--help")
    assert status == 0
    example = out[out.index("[defaults]") : out.index("Options:")]
    lines = [line.strip() for line in example.splitlines()]
    one_h = "\n".join(lines).replace('every = "hamiltonian"', "")
    status, out, err = here(capsys, "check", claims(one_h), "--json")
    assert (status, err) == (0, "")
    assert {c["verdict"] for c in json.loads(out)["claims"]} == {"PROVED", "ENCLOSED"}
