"""The command `verify`: exit statuses, bad input in one line, JSON keys, and light imports."""

import json
import os
import re
import subprocess
import sys
from decimal import Decimal
from pathlib import Path
from typing import Any

import pytest

from verify.commands.main import main

RUN = {"--system": "pendulum", "--scheme": "lie2", "--step-size": "0.01", "--steps": "10",
       "--q": "1.5", "--p": "-0.5"}  # fmt: skip
PROVE = {"--system": "duffing", "--scheme": "lie2"}
SCENE = """
title = "Mine <script>alert(1)</script>"
hamiltonian = "p**2/2 + q**4/4"
schemes = ["lie2", "symplectic-euler"]
criteria = [1, 2, 3, 4]
[grid]
steps = 200
step_sizes = [0.01, "1/30", 0.05, 0.1]
initial_values = [{ q = 1.5, p = 0 }, { q = 0.5, p = "1/3" }]
[[series]]
step_size = 0.05
steps = 100
initial_value = { q = 1.5, p = 0 }
"""


def arguments(command: str, options: dict[str, Any], **changes: Any) -> list[str]:
    """The command line with some options changed, or left out where they are None."""
    merged = {**options, **{f"--{n.replace('_', '-')}": v for n, v in changes.items()}}
    found = [command]
    for name, given in merged.items():
        for value in given if isinstance(given, list) else [given]:
            found += [] if value is None else [name, value]
    return found


def here(capsys: pytest.CaptureFixture[str], *given: str) -> tuple[int, str, str]:
    """Exit status, standard output and standard error of the command, in this process."""
    try:
        main(list(given))
        status = 0
    except SystemExit as exit_:
        status = int(str(exit_.code))
    return status, *capsys.readouterr()


def apart(*given: str, cwd: Path | None = None) -> subprocess.CompletedProcess[str]:
    """The installed command in a process of its own."""
    command = Path(sys.executable).with_name("verify")
    return subprocess.run([command, *given], capture_output=True, text=True, cwd=cwd, timeout=120)


def json_of(output: str) -> Any:
    """The one JSON object that the output is; a binary float in it fails."""

    def no_float(text: str) -> None:
        raise AssertionError(f"{text} is not a decimal string")

    assert output.endswith("}\n")
    assert output.count("\n") == 1
    return json.loads(output, parse_float=no_float, parse_constant=no_float)


# -- bad input ------------------------------------------------------------------------------------

BAD = {
    "h-zero": (arguments("run", RUN, step_size="0"), "--step-size=0"),
    "h-negative": (arguments("run", RUN, step_size="-0.1"), "--step-size=-0.1"),
    "h-nan": (arguments("run", RUN, step_size="nan"), "--step-size=nan"),
    "h-word": (arguments("run", RUN, step_size="small"), "--step-size=small"),
    "h-missing": (arguments("run", RUN, step_size=None), "--step-size"),
    "n-zero": (arguments("run", RUN, steps="0"), "steps=0"),
    "n-negative": (arguments("run", RUN, steps="-3"), "steps=-3"),
    "n-fraction": (arguments("run", RUN, steps="1.5"), "--steps"),
    "n-exponent": (arguments("run", RUN, steps="1e3"), "--steps"),
    "n-huge": (arguments("run", RUN, steps="1" + "0" * 30), "steps="),
    "n-missing": (arguments("run", RUN, steps=None), "--steps"),
    "q-nan": (arguments("run", RUN, q="nan"), "q=nan"),
    "q-inf": (arguments("run", RUN, q="inf"), "q=inf"),
    "p-minus-inf": (arguments("run", RUN, p="-inf"), "p=-inf"),
    "p-over-zero": (arguments("run", RUN, p="1/0"), "p=1/0: division by zero"),
    "q-formula": (arguments("run", RUN, q="pi/2"), "q=pi/2"),
    "q-other-script": (arguments("run", RUN, q="١"), "q="),
    "q-missing": (arguments("run", RUN, q=None), "--q"),
    "digits-zero": (arguments("run", RUN, digits="0"), "digits=0"),
    "digits-negative": (arguments("run", RUN, digits="-1"), "digits=-1"),
    "digits-huge": (arguments("run", RUN, digits="1000000"), "digits=1000000"),
    "digits-word": (arguments("run", RUN, digits="many"), "--digits"),
    "arithmetic": (arguments("run", RUN, arithmetic="float32"), "arithmetic=float32"),
    "scheme-unknown": (arguments("run", RUN, scheme="rk5"), "scheme=rk5: unknown; is rk4 meant"),
    "scheme-lie0": (arguments("run", RUN, scheme="lie0"), "scheme=lie0"),
    "scheme-huge": (arguments("run", RUN, scheme="lie" + "9" * 50), "scheme=lie999"),
    "scheme-empty": (arguments("run", RUN, scheme=""), "scheme="),
    "scheme-missing": (arguments("prove", PROVE, scheme=None), "--scheme"),
    "scheme-half": (arguments("prove", PROVE, scheme="p_next = p"), "scheme=p_next = p"),
    "scheme-code": (
        arguments("prove", PROVE, scheme="p_next = open('x'); q_next = q"), "unknown function"),
    "scheme-pole": (
        arguments("prove", PROVE, scheme="p_next = p + 1/h; q_next = q"), "h = 0"),
    "scheme-not-separable": (
        arguments("prove", PROVE, system=None, hamiltonian="p*q**2", scheme="symplectic-euler"),
        "hamiltonian=p*q**2: symplectic-euler"),
    "system-unknown": (arguments("prove", PROVE, system="lorenz"), "system=lorenz: unknown"),
    "system-missing": (arguments("prove", PROVE, system=None), "--system, --hamiltonian"),
    "system-and-hamiltonian": (arguments("prove", PROVE, hamiltonian="p**2"), "give one of"),
    "parameter-missing": (arguments("run", RUN, system="duffing"), "parameter=delta: has no value"),
    "parameter-no-value": (
        arguments("run", RUN, system="duffing", param="delta"), "--param=delta: has no value"),
    "parameter-unknown": (arguments("run", RUN, param="eps=1"), "parameter=eps"),
    "parameter-nan": (arguments("prove", PROVE, param="delta=nan"), "delta=nan"),
    "parameter-empty": (arguments("prove", PROVE, param="delta="), "delta="),
    "parameter-nameless": (arguments("prove", PROVE, param="=1"), "parameter="),
    "parameter-twice": (arguments("prove", PROVE, param=["delta=1", "delta=2"]), "given twice"),
    "option-unknown": (arguments("run", RUN, speed="9"), "--speed"),
    "argument-extra": ([*arguments("prove", PROVE), "more"], "more"),
    "command-unknown": (["improve"], "improve"),
    "scene-missing": (["plan", "no-such.toml"], "file=no-such.toml: No such file"),
    "scene-a-folder": (["plan", "."], "file=."),
    "scene-not-given": (["report"], "SCENE"),
    "report-of-nothing": (["report", "no-such.toml"], "file=no-such.toml"),
    "workers-zero": (["report", "paper", "--workers", "0"], "--workers"),
    "output-a-file": (["report", "paper", "-o", "/dev/null"], "/dev/null"),
    "output-nowhere": (["report", "paper", "-o", "/proc/none/x"], "/proc/none"),
}  # fmt: skip
FORMULAS = {
    "empty": ("", "empty"),
    "code": ("__import__('os').system('true')", "unknown function"),
    "attribute": ("p.real", "not allowed"),
    "subscript": ("p[0]", "not allowed"),
    "lambda": ("lambda: 1", "not allowed"),
    "comparison": ("p < q", "not allowed"),
    "two-lines": ("p**2\nq**2", "not a formula"),
    "syntax": ("p**2/2 +", "not a formula"),
    "unicode": ("p² + δ", "ASCII"),
    "not-smooth": ("abs(q)", "not smooth"),
    "hidden-abs": ("sqrt(q**2)", "not smooth"),
    "unknown-function": ("gamma(q)", "unknown function"),
    "over-zero": ("p/0", "division by zero"),
    "over-hidden-zero": ("1/(q - q)", "zero"),
    "nan": ("q*nan", "nan"),
    "infinity": ("p + 1e999999", "exponent"),
    "imaginary": ("sqrt(-1)*q", "not real"),
    "huge-power": ("p**9999", "exponent"),
    "tower": ("9**9**9**9", "exponent"),
    "symbolic-power": ("q**p", "exponent"),
    "long": ("p + " * 4000 + "q", "longer than"),
    "deep": ("(" * 300 + "q" + ")" * 300, "not a formula"),
    "nested-calls": ("sin(" * 80 + "q" + ")" * 80, "nested deeper"),
    "many-terms": ("(p + q + a + b + c + d)**64", "terms"),
}
BAD |= {
    f"h-formula-{name}": (arguments("prove", PROVE, system=None, hamiltonian=text), named)
    for name, (text, named) in FORMULAS.items()
}


@pytest.mark.parametrize("as_json", [False, True], ids=["text", "json"])
@pytest.mark.parametrize(("given", "named"), BAD.values(), ids=BAD)
def test_bad_input_is_one_line_on_standard_error_and_status_2(
    capsys: pytest.CaptureFixture[str], given: list[str], named: str, as_json: bool
) -> None:
    status, out, err = here(capsys, *given, *(["--json"] if as_json else []))
    assert (status, out) == (2, "")
    assert err.startswith("verify: ")
    assert err.count("\n") == 1
    assert named in err
    assert "Traceback" not in err
    assert len(err) < 600


def test_bad_input_is_the_same_in_a_process_of_its_own(tmp_path: Path) -> None:
    (tmp_path / "bad.toml").write_bytes(b"\xff\xfe")
    done = apart("plan", "bad.toml", cwd=tmp_path)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == "verify: file=bad.toml: is not UTF-8 text, at byte 0; save it as UTF-8\n"


# -- what is printed ------------------------------------------------------------------------------

DECIMAL = re.compile(r"-?\d+(\.\d+)?(e[+-]\d+)?")


@pytest.mark.parametrize(
    ("digits", "asked", "arithmetic", "kind"),
    [
        (None, None, "float64", "enclosed"),
        ("30", None, "mpfr", "enclosed"),
        ("30", "mpmath", "mpmath", "enclosed"),
        ("30", "ball", "ball", "enclosed"),
    ],
)
def test_run_prints_its_json_keys_with_decimal_strings(
    capsys: pytest.CaptureFixture[str],
    digits: str | None,
    asked: str | None,
    arithmetic: str,
    kind: str,
) -> None:
    given = arguments("run", RUN, digits=digits, arithmetic=asked)
    status, out, err = here(capsys, *given, "--json")
    found = json_of(out)
    assert (status, err) == (0, "")
    values = ("lambda", "mse", "delta_j_max", "q", "p")
    assert {*values, "steps", "digits", "arithmetic", "error_bound", "error_kind",
            "seconds"} <= set(found)  # fmt: skip
    for name in values:
        assert DECIMAL.fullmatch(found[name]), name
        assert 0 < Decimal(found["error_bound"][name]) < abs(Decimal(found[name])) / 10**6
        if digits:
            assert len(Decimal(found[name]).as_tuple().digits) in (29, 30)
    assert (int(found["steps"]), found["arithmetic"]) == (10, arithmetic)
    assert found["error_kind"] == kind
    assert Decimal(found["seconds"]) >= 0


def test_run_says_where_an_orbit_left_the_range(capsys: pytest.CaptureFixture[str]) -> None:
    changes = {"system": None, "hamiltonian": "p**2/2 - q**4", "step_size": "1", "steps": "90"}
    status, out, _ = here(capsys, *arguments("run", RUN, **changes), "--json")
    found = json_of(out)
    assert (status, found["status"], found["lambda"]) == (1, "left range", None)
    assert 1 < int(found["failed_step"]) < 90
    assert found["failed_step"] == json_of(
        here(capsys, *arguments("run", {**RUN, "--steps": "90"}, **{**changes, "steps": "80"}),
             "--json")[1])["failed_step"]  # fmt: skip


@pytest.mark.parametrize(
    ("command", "keys", "name"),
    [
        ("schemes", {"name", "order", "symplectic", "cost", "aliases", "hamiltonian"}, "lie2"),
        ("systems", {"name", "hamiltonian", "regimes", "exact_flow"}, "duffing"),
    ],
)
def test_what_there_is_is_listed(
    capsys: pytest.CaptureFixture[str], command: str, keys: set[str], name: str
) -> None:
    status, out, err = here(capsys, command, "--json")
    found = {row["name"]: row for row in json_of(out)[command]}
    assert (status, err) == (0, "")
    assert keys <= set(found[name])
    status, out, err = here(capsys, command)
    assert (status, err) == (0, "")
    assert all(f"{each} " in out for each in found)


def test_plan_prints_its_json_keys(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    (tmp_path / "mine.toml").write_text(SCENE)
    status, out, err = here(capsys, "plan", str(tmp_path / "mine.toml"), "--json")
    found = json_of(out)
    assert (status, err, set(found)) == (0, "", {"seconds", "tasks", "left_out"})
    assert len(found["tasks"]) == 2 + 8 + 1
    assert all(task["reasons"] for task in found["tasks"])
    assert {t["step_size"] for t in found["tasks"] if t["kind"] == "run"} >= {"0.01", "1/30"}
    assert all(item["what"] and item["why"] for item in found["left_out"])


@pytest.mark.parametrize("given", [["prove", *arguments("", PROVE)[1:]], arguments("run", RUN),
                                   ["plan", "paper"]], ids=["prove", "run", "plan"])  # fmt: skip
def test_people_are_shown_text(capsys: pytest.CaptureFixture[str], given: list[str]) -> None:
    status, out, err = here(capsys, *given)
    assert (status, err) == (0, "")
    assert len(out.splitlines()) >= 4
    with pytest.raises(json.JSONDecodeError):
        json.loads(out)


# -- light imports --------------------------------------------------------------------------------

IMPORTED = """
import sys
from verify import schemes
from verify.commands.main import main
try:
    main(sys.argv[1:])
except SystemExit as exit_:
    assert not exit_.code, exit_.code
roots = {name.partition(".")[0] for name in sys.modules}
print("IMPORTED", *sorted(roots), file=sys.stderr)
"""


@pytest.mark.left_to_ci
@pytest.mark.parametrize(
    ("given", "absent"),
    [
        (
            ["--help"],
            {"matplotlib", "numpy", "sympy", "flint", "mpmath", "pydantic", "difflib"},
        ),
        (["report", "--help"], {"matplotlib", "numpy", "sympy", "jinja2", "reports"}),
        (arguments("prove", PROVE), {"matplotlib", "numpy", "jinja2", "rich", "reports"}),
        (["plan", "paper"], {"matplotlib", "numpy", "jinja2"}),
        (
            arguments("run", RUN, digits="20"),
            {
                "matplotlib",
                "numpy",
                "jinja2",
                "difflib",
                "concurrent",
                "multiprocessing",
                "tomllib",
            },
        ),
    ],
    ids=["help", "report-help", "prove", "plan", "run-in-mpmath"],
)
def test_a_command_imports_nothing_heavy_that_it_does_not_use(
    given: list[str], absent: set[str]
) -> None:
    done = subprocess.run([sys.executable, "-c", IMPORTED, *given], capture_output=True, text=True,
                          env={**os.environ, "COLUMNS": "80"}, check=True)  # fmt: skip
    modules = set(done.stderr.rpartition("IMPORTED")[2].split())
    assert "click" in modules, "the modules were read"
    assert not modules & absent
