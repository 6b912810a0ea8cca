"""`verify check-integrator` and the examples of its how-to page, as users run them."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from tests.end_to_end.test_command_line import apart, here, json_of
from tests.helpers.pages.blocks import PAGES, blocks
from tests.helpers.processes.processor_time import of_children_below
from tests.paths import ROOT

FILES = {block.file: block.text for block in blocks(PAGES["docs/how-to/check-integrator.md"])}
EXAMPLE, TESTED = FILES["mine.py"], FILES["test_mine.py"]
KEYS = {"verdict", "order", "defect_order", "leading", "delta_j", "area_preserving",
        "convergence_order", "telescopes", "potential", "seconds", "reason", "witness"}  # fmt: skip


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The page's `mine.py`, in the current folder; it is imported anew."""
    (tmp_path / "mine.py").write_text(EXAMPLE, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", list(sys.path))
    monkeypatch.delitem(sys.modules, "mine", raising=False)
    return tmp_path


@pytest.mark.left_to_ci
def test_a_plain_function_is_checked_in_under_five_seconds(folder: Path) -> None:
    with of_children_below(5):
        done = apart("check-integrator", "mine:step", "--system", "pendulum", "--json", cwd=folder)
    assert done.returncode == 0, done.stderr
    found = json_of(done.stdout)
    assert set(found) >= KEYS
    assert (found["verdict"], found["area_preserving"]) == ("PROVED", True)


def test_json_of_a_refuted_claim_has_the_counterexample(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    given = ["check-integrator", "mine.py:step", "--system", "pendulum", "--order", "3", "--json"]
    status, out, err = here(capsys, *given)
    found = json_of(out)
    assert (status, err, found["verdict"]) == (1, "", "REFUTED")
    assert set(found["counterexample"]) == {"p", "q", "h", "quantity", "found", "expected"}


BAD = [
    ("nowhere_at_all:step", [], "does not import: ModuleNotFoundError"),
    ("broken:step", [], "does not import: ZeroDivisionError: division by zero"),
    ("quits:step", [], "does not import: SystemExit: 3"),
    ("leaves:step", [], "does not import: SystemExit: 0"),
    ("spelt:step", [], "does not import: SyntaxError"),
    ("mine:other", [], "mine has no other; it has: step"),
    ("many:setp", [], "is step meant? it has: step, f0, f1, f10, f11, f2, f3, f4, and 5 more"),
    ("many:nothing_like_it", [], "many has no nothing_like_it; it has: f0, f1, f10"),
    ("mine:math", [], "is no function but module"),
    ("mine", [], "MODULE:FUNCTION"),
    ("no.py:step", [], "there is no file no.py"),
    ("two:step", [], "wanted: step(p, q, h)"),
    ("mine:step", ["--arguments", "q,p"], "is no order of p, q and h"),
    ("mine:step", ["--p", "1"], "give both or none"),
    ("mine:step", ["--system", "pendulum", "--hamiltonian", "p"], "give one of the two"),
    ("mine:step", ["--system", "duffing"], "has no value"),
]


@pytest.mark.parametrize(("target", "more", "said"), BAD)
def test_what_cannot_be_called_is_bad_input_in_one_line(
    folder: Path, capsys: pytest.CaptureFixture[str], target: str, more: list[str], said: str
) -> None:
    (folder / "broken.py").write_text("print('about to')\n1 / 0\n")
    (folder / "quits.py").write_text("import sys\nsys.exit(3)\n")
    (folder / "leaves.py").write_text("import os\nos._exit(0)\n")
    (folder / "spelt.py").write_text("def step(:\n")
    many = [*(f"f{k}" for k in range(12)), "step"]
    (folder / "many.py").write_text("".join(f"def {name}(p, q, h): ...\n" for name in many))
    (folder / "two.py").write_text("def step(p, q):\n    return p, q\n")
    system = [] if "--system" in more else ["--system", "pendulum"]
    status, out, err = here(capsys, "check-integrator", target, *system, *more)
    assert (status, out) == (2, "")
    assert said in err
    assert len([line for line in err.splitlines() if line != "about to"]) == 1
    for name in ("broken", "quits", "leaves", "spelt", "many", "two"):
        sys.modules.pop(name, None)


EULER = {
    "n = 1": (
        "def step(p, q, h):\n    return p - h*q, q + h*p\n",
        ["--system", "harmonic", "--param", "omega=1"],
        ["--q", "1", "--p", "0"],
        {"leading": "1"},
        "det J ≡ 1 is claimed; ΔJ has order 2",
    ),
    "n = 2": (
        "def step(p, q, h):\n"
        "    return [p[0] - h*q[0], p[1] - h*q[1]], [q[0] + h*p[0], q[1] + h*p[1]]\n",
        ["--hamiltonian", "(p1**2 + p2**2 + q1**2 + q2**2)/2"],
        ["--q", "1,0", "--p", "0,1"],
        {"degrees": 2, "leading": "dp1∧dq1 + dp2∧dq2"},
        "that it is symplectic is claimed; S has order 2",
    ),
}


@pytest.mark.parametrize("name", EULER)
def test_explicit_euler_is_proved_to_be_of_order_1_and_not_symplectic(
    folder: Path, capsys: pytest.CaptureFixture[str], name: str
) -> None:
    source, system, place, expected, refuted = EULER[name]
    (folder / "mine.py").write_text(source)
    typed = ["check-integrator", "mine.py:step", *system]
    status, out, _ = here(capsys, *typed, "--json")
    found = json_of(out)
    assert (status, found["verdict"], found["how"]) == (0, "PROVED", "proof")
    assert (found["symplectic"], found["order"], found["convergence_order"]) == (False, 2, 1)
    assert {key: found[key] for key in expected} == expected
    status, out, _ = here(capsys, *typed, "--symplectic")
    assert (status, f"REFUTED: {refuted}" in out) == (1, True)
    assert here(capsys, *typed, *place, "--step-size", "0.01")[0] == 0
    for wrong in (["--q", "1,2"], ["--scale", "q=0"], ["--scale", "r=1"], ["--within", "-1"],
                  ["--step-size", "0"], ["--q", "1,2,3", "--p", "1,2,3"]):  # fmt: skip
        status, _, err = here(capsys, *typed, *wrong)
        assert (status, err.count("\n")) == (2, 1)


def test_one_number_is_no_place_of_two_degrees(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    system = EULER["n = 2"][1]
    status, _, err = here(capsys, "check-integrator", "mine:step", *system, "--q", "1", "--p", "1")
    assert (status, err.count("\n")) == (2, 1)


def test_the_help_says_that_it_runs_the_users_code(capsys: pytest.CaptureFixture[str]) -> None:
    status, out, _ = here(capsys, "check-integrator", "--help")
    assert status == 0
    assert "RUNS YOUR CODE" in out


# Three programs, by one pytest: as the page prints it, with a flipped sign, with a higher order.
PLANTED = {
    "right": ("", "", ""),
    "flipped": ("p = p - h / 2", "p = p + h / 2", "not a scheme for this H"),
    "higher": ("step, PENDULUM, 2", "step, PENDULUM, 3", "order 3 is claimed"),
}


@pytest.mark.left_to_ci
def test_the_pytest_example_passes_and_fails_with_an_error(tmp_path: Path) -> None:
    for name, (old, new, _) in PLANTED.items():
        assert not old or (EXAMPLE + TESTED).count(old) == 1
        test = TESTED.replace(old, new).replace("from mine", f"from {name}")
        (tmp_path / f"{name}.py").write_text(EXAMPLE.replace(old, new), encoding="utf-8")
        (tmp_path / f"test_{name}.py").write_text(test, encoding="utf-8")
    command = [sys.executable, "-m", "pytest", "-v", "-p", "no:cacheprovider", "--rootdir=."]
    paths = os.pathsep.join(filter(None, (str(ROOT), os.environ.get("PYTHONPATH"))))
    environment = {**os.environ, "PYTHONPATH": paths}
    done = subprocess.run(command, capture_output=True, text=True, cwd=tmp_path, env=environment)
    assert done.returncode == 1, done.stdout
    assert "2 failed, 1 passed" in done.stdout
    assert "test_right.py::test_step PASSED" in done.stdout
    for name in ("flipped", "higher"):
        # What is said of a failure begins with the test's source and ends with file and line.
        told = re.split(rf"\ntest_{name}\.py:\d", done.stdout)[0].rpartition("def test_step")[2]
        assert PLANTED[name][2] in told
