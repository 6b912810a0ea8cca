"""`--keeps` of check-integrator and check-map: what is printed, the keys, and the exit status."""

import json
from pathlib import Path

import pytest

from tests.end_to_end.test_command_line import here, json_of
from tests.helpers.programs import kept_steps

FILE = str(Path(kept_steps.__file__))
PENDULUM = ("--hamiltonian", kept_steps.PENDULUM)
LOTKA = ("--field", kept_steps.LOTKA)


def checked(capsys: pytest.CaptureFixture[str], *arguments: str) -> tuple[int, dict[str, object]]:
    status, out, _ = here(capsys, *arguments, "--json")
    return status, json_of(out)


def test_a_push_that_keeps_volume_has_the_status_0(capsys: pytest.CaptureFixture[str]) -> None:
    command = ("check-integrator", f"{FILE}:push", "--field", kept_steps.PUSH, "--keeps", "volume")
    status, found = checked(capsys, *command)
    assert (status, found["verdict"]) == (0, "PROVED")
    (kept,) = found["keeps"]  # type: ignore[misc]
    assert (kept["structure"], kept["verdict"], kept["exact"]) == ("volume", "PROVED", True)
    assert set(kept) >= {"label", "defect", "reason", "order", "claimed", "how", "counterexample"}


def test_the_worst_verdict_stands_at_the_top(capsys: pytest.CaptureFixture[str]) -> None:
    command = ("check-integrator", f"{FILE}:verlet", *PENDULUM)
    status, found = checked(capsys, *command, "--keeps", "area", "--keeps", "energy: 4")
    assert (status, found["verdict"]) == (1, "REFUTED")
    area, energy = found["keeps"]  # type: ignore[misc]
    assert (area["verdict"], energy["verdict"]) == ("PROVED", "REFUTED")
    assert (energy["order"], energy["claimed"]) == (3, 4)
    assert set(energy["counterexample"]) == {"p", "q", "h", "quantity", "found", "expected"}
    status, found = checked(capsys, *command, "--keeps", "area", "--order", "3")
    assert (status, found["verdict"], found["keeps"][0]["verdict"]) == (1, "REFUTED", "PROVED")  # type: ignore[index]


def test_a_form_of_its_own_is_printed(capsys: pytest.CaptureFixture[str]) -> None:
    command = ("check-integrator", f"{FILE}:lotka", *LOTKA, "--form", kept_steps.LOTKA_FORM)
    status, out, _ = here(capsys, *command)
    assert status == 0
    assert "proved   S = Jᵀω(z')J − ω(z) is 0 at every step" in out
    status, out, _ = here(capsys, *command[:1], f"{FILE}:lotka_wrong", *command[2:])
    assert status == 1
    assert "against  at u = " in out


def test_what_is_undecided_fails_unless_it_is_allowed(capsys: pytest.CaptureFixture[str]) -> None:
    command = ("check-integrator", f"{FILE}:midpoint", *PENDULUM, "--keeps", "area")
    assert checked(capsys, *command)[0] == 1
    assert checked(capsys, *command, "--allow-undecided")[0] == 0
    assert checked(capsys, *command, "--within", "1e-6")[0] == 0


def test_a_map_names_its_coordinates(capsys: pytest.CaptureFixture[str]) -> None:
    command = ("check-map", f"{FILE}:two", "--coordinates", "v1,v2,x1,x2")
    status, found = checked(capsys, *command, "--form", "dv1^dx1 + 3*dv2^dx2", "--keeps", "volume")
    assert (status, [x["verdict"] for x in found["keeps"]]) == (0, ["PROVED", "PROVED"])  # type: ignore[attr-defined]
    status, found = checked(capsys, *command, "--form", "dv1^dx1 + dv2^dx2", "--point", "1,2,3,4")
    assert status == 1
    assert set(json.loads(json.dumps(found["counterexample"]))) >= {"v1", "v2", "x1", "x2", "found"}
    assert found["places"][0]["chosen_by"] == "user"  # type: ignore[index]
    assert checked(capsys, "check-map", f"{FILE}:flow_of_abc", "--coordinates", "x,y,w")[0] == 0


def test_whoever_asks_nothing_gets_the_list(capsys: pytest.CaptureFixture[str]) -> None:
    status, found = checked(capsys, "check-integrator", f"{FILE}:verlet", *PENDULUM)
    assert (status, found["verdict"]) == (0, "PROVED")
    assert [x["structure"] for x in found["keeps"]] == ["area", "reversible", "energy"]  # type: ignore[attr-defined]
    _, out, _ = here(capsys, "check-integrator", f"{FILE}:verlet", *PENDULUM)
    assert "note     keeps area (det J = 1), energy to h^2; reversible by p ↦ −p" in out


@pytest.mark.parametrize(
    ("arguments", "problem"),
    [
        (("check-map", "two", "--keeps", "symmetric"), "is of steps"),
        (("check-map", "two", "--coordinates", "a,b", "--arguments", "p,q"), "goes without"),
        (("check-map", "two", "--point", "1,2,3"), "allowed: 2 numbers, p, q"),
        (("check-integrator", "lotka", *LOTKA, "--arguments", "u,v,h"), "without --arguments"),
        (("check-integrator", "lotka", *LOTKA, "--area-preserving"), "claim --keeps volume"),
        (("check-integrator", "lotka", *LOTKA, "--q", "1", "--p", "1"), "use --point"),
        (("check-integrator", "lotka", *LOTKA, "--keeps", "u"), "is not kept by the exact flow"),
        (("check-integrator", "verlet", *PENDULUM, "--keeps", "casimir"), "unknown"),
    ],
)
def test_bad_input_is_one_line(
    capsys: pytest.CaptureFixture[str], arguments: tuple[str, ...], problem: str
) -> None:
    command, name, *options = arguments
    status, out, error = here(capsys, command, f"{FILE}:{name}", *options)
    assert (status, out, error.count("\n")) == (2, "", 1)
    assert problem in error
