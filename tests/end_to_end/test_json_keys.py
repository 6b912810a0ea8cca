"""The JSON of each command has the keys that the manual lists, all of them and no other."""

import re
from pathlib import Path
from typing import Any

import pytest

from tests.end_to_end.test_command_line import here, json_of

PAGE = Path(__file__).parents[2] / "docs" / "reference" / "json-keys.md"
START = ["--step-size", "0.1", "--steps", "3"]
PLANE, TWO = ["--q", "1", "--p", "0"], ["--q", "0, 1/10", "--p", "1/10, 0"]
PENDULUM = ["--system", "pendulum", "--scheme", "lie2"]
HENON = ["--system", "henon-heiles", "--scheme", "lie2"]
FILES = {
    "made.toml": 'hamiltonian = "p**2/2 + q**4/4"\nschemes = ["lie1"]\n[[reference]]\n'
    "step_sizes = [0.1]\ninitial_values = [{ q = 1, p = 0 }]\nsteps = [0, 1, 2]\ndigits = 9\n"
    "flow = false\n",
    "theirs.csv": "step,p,q\n0,0,1\n1,-0.1,1\n",
    "code.py": "def step(p, q, h):\n    p = p - h*q\n    return p, q + h*p\n\n\n"
    "def turn(p, q):\n    return p, q + p\n",
    "table.toml": '[[table]]\nname = "verlet"\nkind = "splitting"\nfirst = "kick"\n'
    'sizes = ["1/2", "1", "1/2"]\norder = 2\n',
    "claims.toml": '[[claim]]\nid = "a"\nkind = "convergence_order"\nconvergence_order = 2\n'
    'every = "hamiltonian"\nscheme = "lie2"\n',
}
COMMANDS = {
    "prove": ["prove", *PENDULUM],
    "prove, several degrees": ["prove", *HENON],
    "prove --every-hamiltonian": ["prove", "--every-hamiltonian", "--scheme", "lie2"],
    "prove --every-hamiltonian, several degrees": ["prove", "--every-hamiltonian", "--degrees", "2",
                                                   "--scheme", "lie2"],
    "prove --keeps": ["prove", *PENDULUM, "--keeps", "energy: 3"],
    "prove --every-hamiltonian --keeps": ["prove", "--every-hamiltonian", "--scheme", "lie2",
                                          "--keeps", "energy: 3"],
    "modified": ["modified", *PENDULUM, "--order", "1"],
    "run": ["run", *PENDULUM, *START, *PLANE],
    "run, several degrees": ["run", *HENON, *START, *TWO],
    "run --keeps": ["run", *PENDULUM, *START, *PLANE, "--keeps", "energy", "--keeps", "reversible"],
    "run --field": ["run", "--field", "u_dot = v; v_dot = -u", "--start", "u=1,v=0", *START,
                    "--scheme", "lie2"],
    "separate": ["separate", *PENDULUM, *START, *PLANE],
    "separate, several degrees": ["separate", *HENON, *START, *TWO],
    "check-integrator": ["check-integrator", "code.py:step", "--hamiltonian", "p**2/2 + q**2/2"],
    "check-map": ["check-map", "code.py:turn"],
    "check-table": ["check-table", "table.toml"],
    "check": ["check", "claims.toml"],
    "stability": ["stability", *PENDULUM, *START, *PLANE],
    "stability --linear": ["stability", "--linear", "--scheme", "lie2"],
    "flow": ["flow", *PENDULUM, *START, "--q", "1"],
    "explore": ["explore", "--property", "order-by-jets", "--examples", "2"],
    "explore --maximise": ["explore", "--maximise", "defect", "--examples", "2", "--steps", "5"],
    "bench": ["bench", *PENDULUM, *START[:2], "--step-size", "0.05", "--time", "1", *PLANE],
    "certificate check": ["certificate", "check", "proof.json"],
    "export": ["export", *PENDULUM, "--language", "c"],
    "reference make": ["reference", "make", "made.toml", "-o", "data"],
    "reference check": ["reference", "check", "data"],
    "reference compare": ["reference", "compare", "theirs.csv", "--data", "data", "--scene", "made",
                          "--scheme", "lie1", *START[:2], *PLANE],
    "init": ["init", "scene"],
    "plan": ["plan", "paper"],
    "schemes": ["schemes"],
    "systems": ["systems"],
}  # fmt: skip
ENTRIES = {
    "check-table, a claim": ("check-table", "claims"),
    "check, a claim": ("check", "claims"),
    "stability, a case": ("stability", "cases"),
    "run --keeps, a structure": ("run --keeps", "keeps"),
    "prove --keeps, a structure": ("prove --keeps", "keeps"),
    "prove --every-hamiltonian --keeps, a structure": (
        "prove --every-hamiltonian --keeps",
        "keeps",
    ),
    "modified, a term": ("modified", "terms"),
    "flow, an image": ("flow", "images"),
    "explore, a property": ("explore", "properties"),
    "reference make, a file": ("reference make", "files"),
    "reference compare, a column": ("reference compare", "columns"),
}


def listed() -> dict[str, set[str]]:
    """The keys by row of the page, `those of` another row put in."""
    rows: dict[str, set[str]] = {}
    for line in PAGE.read_text(encoding="utf-8").splitlines():
        found = re.fullmatch(r"\| (`[^|]+) \| (.+) \|", line)
        if found:
            names = set(re.findall(r"`([^`]+)`", found[2]))
            if found[2].startswith("those of"):
                names = names - {"run"} | rows["run"]
            rows[found[1].replace("`", "")] = names
    return rows


LISTED = listed()


def test_each_row_is_tried() -> None:
    assert set(LISTED) == set(COMMANDS) | set(ENTRIES)


@pytest.mark.parametrize("name", COMMANDS)
def test_a_command_prints_the_keys_that_are_listed(
    capsys: pytest.CaptureFixture[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    name: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    for file, text in FILES.items():
        Path(file).write_text(text, encoding="utf-8")
    if name == "certificate check":
        assert here(capsys, *COMMANDS["prove"], "--certificate", "proof.json")[0] == 0
    if name in ("reference check", "reference compare"):
        assert here(capsys, *COMMANDS["reference make"])[0] == 0
    status, out, _ = here(capsys, *COMMANDS[name], "--json")
    found = json_of(out)
    assert (status, set(found)) == (0, LISTED[name])
    for entry, (command, key) in ENTRIES.items():
        if command == name:
            assert {frozenset(x) for x in found[key]} == {frozenset(LISTED[entry])}


@pytest.mark.parametrize(
    ("changes", "status"),
    [
        ({}, "finished"),
        ({"--hamiltonian": "p**2/2 - q**4", "--step-size": "1", "--steps": "90"}, "left range"),
        ({"--q": "3.1415926535897932", "--step-size": "0.002", "--steps": "25000"}, "unresolved"),
    ],
)
def test_a_run_that_does_not_finish_ends_with_1(
    capsys: pytest.CaptureFixture[str], changes: dict[str, str], status: str
) -> None:
    given: dict[str, Any] = {"--system": "pendulum", "--scheme": "lie2", "--step-size": "0.1",
                             "--steps": "3", "--q": "1", "--p": "0", **changes}  # fmt: skip
    if "--hamiltonian" in given:
        del given["--system"]
    ended, out, _ = here(capsys, "run", *(x for pair in given.items() for x in pair), "--json")
    assert (json_of(out)["status"], ended) == (status, int(status != "finished"))
