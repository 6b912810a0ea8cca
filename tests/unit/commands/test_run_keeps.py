"""`verify run` with --keeps and with --field: what it measures is shown, and judged by nobody."""

from fractions import Fraction

import pytest

from tests.end_to_end.test_command_line import here, json_of

TWO = ["run", "--hamiltonian", "(p1**2 + p2**2)/2 + (q1**2 + q2**2)**2/4", "--q", "1,0",
       "--p", "0,1.1", "--step-size", "0.1", "--steps", "20", "--scheme"]  # fmt: skip
PREY = ["run", "--field", "u_dot = u*(v - 2); v_dot = v*(1 - u)", "--scheme", "rk4",
        "--step-size", "0.1", "--steps", "20"]  # fmt: skip
START = ["--start", "u=1,v=2.5"]


def keeps(*texts: str) -> list[str]:
    return [word for text in texts for word in ("--keeps", text)]


def test_a_wrong_integral_is_shown_and_not_judged(capsys: pytest.CaptureFixture[str]) -> None:
    asked = keeps("angular-momentum", "q1*p2 + q2*p1", "energy", "symplectic", "reversible")
    status, out, err = here(capsys, *TWO, "lie2", *asked, "--json")
    assert (status, err) == (0, "")
    found = json_of(out)
    right, wrong, energy, form, back = found["keeps"]
    assert abs(Fraction(right["largest"])) < Fraction(1, 50) < abs(Fraction(wrong["largest"]))
    assert (energy["at_end"], energy["largest"]) == (
        found["energy_error"], found["energy_error_max"])  # fmt: skip
    assert form["at_end"] == found["symplectic_defect"]
    assert back["largest"] is None
    assert back["error_bound"].keys() == {"at_end"}


def test_what_is_proved_is_0_and_said_to_be_exact(capsys: pytest.CaptureFixture[str]) -> None:
    found = json_of(here(capsys, *TWO, "stormer-verlet", *keeps("angular-momentum"), "--json")[1])
    assert found["keeps"][0]["exact"] is True
    assert (found["keeps"][0]["at_end"], found["keeps"][0]["largest"]) == ("0", "0")


def test_people_read_it_below_the_other_values(capsys: pytest.CaptureFixture[str]) -> None:
    _, out, _ = here(capsys, *TWO, "lie2", *keeps("q1*p2 - q2*p1", "energy"))
    lines = out.splitlines()
    at = lines.index("q1*p2 - q2*p1")
    assert lines[at + 1].startswith("  at end")
    assert lines[at + 2].startswith("  largest")
    assert "energy" not in lines  # its lines stand above, as in every run
    assert sum(line.startswith("max |H − H₀|") for line in lines) == 1


def test_equations_have_their_state_by_name(capsys: pytest.CaptureFixture[str]) -> None:
    found = json_of(here(capsys, *PREY, *START, *keeps("volume"), "--json")[1])
    assert list(found["state"]) == ["u", "v"]
    assert found["error_bound"]["state"].keys() == {"u", "v"}
    assert not {"p", "q", "energy_error", "symplectic_defect"} & found.keys()
    assert found["keeps"][0]["at_end"] == found["lambda"]


def test_forms_density_and_bracket_accumulate_and_a_wrong_one_is_seen(
    capsys: pytest.CaptureFixture[str],
) -> None:
    options = ["--form", "du^dv/(u*v)", "--density", "1/(u*v)", "--poisson", "0, u*v; -u*v, 0"]
    found = json_of(here(capsys, *PREY, *START, *options, *keeps("symmetric"), "--json")[1])
    assert found["error_kind"] == "enclosed"
    back, form, volume, bracket = found["keeps"]
    assert [x["structure"] for x in (back, form, volume, bracket)] == [
        "symmetric", "symplectic", "volume", "poisson"]  # fmt: skip
    # In the plane they are one number, in units of 1/(u v), 1, and u v at the start.
    for x, size in ((form, Fraction("0.4")), (volume, 1)):
        assert 0 < abs(Fraction(x["at_end"])) < Fraction(1, 10**4)
        off = abs(Fraction(x["at_end"]) - size * Fraction(volume["at_end"]))
        assert off < Fraction(1, 10**14)
    assert Fraction(back["at_end"]) < Fraction(1, 1000)
    wrong = json_of(here(capsys, *PREY, *START, "--form", "du^dv", "--json")[1])["keeps"]
    assert abs(Fraction(wrong[0]["at_end"])) > Fraction(1, 20)


def test_a_bracket_has_its_casimirs_beside_it(capsys: pytest.CaptureFixture[str]) -> None:
    body = ["run", "--field", "x_dot = -y*z/6; y_dot = z*x/3; z_dot = -x*y/6", "--scheme", "rk4",
            "--start", "x=1,y=1/2,z=-3/4", "--step-size", "0.1", "--steps", "20",
            "--poisson", "0, z, -y; -z, 0, x; y, -x, 0"]  # fmt: skip
    casimir = ["--casimir", "x**2 + y**2 + z**2"]
    bracket, length = json_of(here(capsys, *body, *casimir, "--json")[1])["keeps"]
    assert (bracket["largest"], length["structure"]) == (None, "casimir")
    assert 0 < abs(Fraction(length["largest"])) < Fraction(1, 10**6)
    _, out, _ = here(capsys, *body)
    lines = out.splitlines()
    assert lines[lines.index("the Poisson structure") + 1].startswith("  at end")


@pytest.mark.parametrize(
    "words",
    [
        [*TWO, "lie2", *keeps("area")],
        [*TWO, "lie2", *keeps("q3")],
        [*TWO, "lie2", *keeps("conformal")],
        [*TWO, "lie2", *keeps("poisson")],
        [*TWO, "lie2", "--poisson", "0, 1; -1, 0"],
        [*TWO, "lie2", "--reverses", "p1, p2"],
        [*TWO, "lie2", "--reverses", "-p1, p2 + q1, q1, q2"],
        [*TWO, "lie2", "--form", "2*dp1^dq1 + q1*dp2^dq2"],
        [*TWO, "lie2", "--form", "dp1^dq1"],
        [*TWO, "lie2", "--start", "u=1"],
        PREY,
        [*PREY, "--q", "1", "--p", "0"],
        [*PREY, "--start", "u=1"],
        [*PREY, "--start", "u=1,v=2,w=3"],
        [*PREY, "--start", "u=1,v"],
        [*PREY, "--start", "u=1,u=2"],
        [*PREY, *START, *keeps("energy")],
        [*PREY, *START, *keeps("reversible")],
        [*PREY, *START, "--density", "1/(u*w)"],
        [*PREY, *START, "--density", "0*u"],
        [*PREY, *START, "--factor", "exp(-h)"],
        [*PREY, *START, "--factor", "1 - h", "--form", "du^dv"],
        [*PREY, "--start", "u=0,v=1", "--density", "1/(u*v)"],
    ],
    ids=lambda words: " ".join(words[-2:]),
)
def test_a_bad_request_is_one_line_before_anything_runs(
    capsys: pytest.CaptureFixture[str], words: list[str]
) -> None:
    status, out, err = here(capsys, *words)
    assert (status, out) == (2, "")
    assert len(err.splitlines()) == 1
