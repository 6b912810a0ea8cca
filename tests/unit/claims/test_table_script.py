"""The program that computes a printed table anew: it runs in plain Python, and prints the table."""

import ast
import subprocess
import sys
from fractions import Fraction
from pathlib import Path

import pytest

from verify.claims.claims_file import load_claims
from verify.claims.table_script import table_script
from verify.claims.verdicts import prepare
from verify.execution.execute import Store
from verify.execution.executors import THIS_PROCESS
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.scenes.results.claim import ClaimResult
from verify.verdict import Verdict

# Of the paper, over a shorter time; from the second start q and p are no short decimals.
FILE = """
[[claim]]
id = "table"
kind = "table"
quantity = "{quantity}"
scheme = "{scheme}"
{hamiltonian}
time = 3
step_sizes = [0.1, "1/30", 0.05]
initial_values = [{{ q = 1.5, p = 0 }}, {{ q = "1/3", p = "-2/7" }}]
printed = ["-1.0000", "-2.0000", "-3.0000"]
"""
HAMILTONIANS = {
    "duffing": 'system = "duffing"\nparameters = { delta = 1 }',
    "pendulum": 'system = "pendulum"',
}
QUANTITIES = ["lg_mse", "mse", "lambda", "lg_abs_lambda"]
SIZES = [(Fraction(1, 10), 30), (Fraction(1, 30), 90)]
STARTS = [(Fraction(3, 2), Fraction(0))]


def judge(folder: Path, hamiltonian: str, **keys: str) -> ClaimResult:
    """The result of a table that is wrong."""
    path = folder / "claims.toml"
    fields = {"quantity": "lg_mse", "scheme": "lie2"} | keys
    path.write_text(FILE.format(hamiltonian=hamiltonian, **fields))
    (result,) = prepare(load_claims(path)).run(Store(None), where=THIS_PROCESS)
    return result


def run(script: str, folder: Path) -> list[list[float]]:
    """The numbers that the program prints in a Python that sees no package but its own."""
    path = folder / "table.py"
    path.write_text(script)
    done = subprocess.run(
        [sys.executable, "-I", "-S", path.name], cwd=folder, capture_output=True, text=True,
        timeout=60,
    )  # fmt: skip
    assert (done.returncode, done.stderr) == (0, "")
    return [[float(x) for x in line.partition(":")[2].split()] for line in done.stdout.splitlines()]


@pytest.mark.parametrize("quantity", QUANTITIES)
@pytest.mark.parametrize("hamiltonian", HAMILTONIANS.values(), ids=HAMILTONIANS)
def test_the_program_prints_the_numbers_that_the_claim_computes(
    tmp_path: Path, hamiltonian: str, quantity: str
) -> None:
    result = judge(tmp_path, hamiltonian, quantity=quantity)
    assert result.verdict is Verdict.REFUTED
    _, _, *computed = result.details
    numbers = [[float(cell) for cell in row[1:]] for row in computed]
    # Five digits of the program, beside four decimals of a logarithm in the claim.
    places = {"abs": 6e-4} if quantity.startswith("lg") else {"rel": 6e-5}
    printed = run(result.reproduction, tmp_path)
    assert len(printed) == 2
    for row, cells in zip(printed, numbers, strict=True):
        assert row == pytest.approx(cells, **places)


@pytest.mark.parametrize("hamiltonian", HAMILTONIANS.values(), ids=HAMILTONIANS)
def test_a_table_of_the_numbers_that_the_program_prints_is_right(
    tmp_path: Path, hamiltonian: str
) -> None:
    """From one start, to four digits."""
    script = judge(tmp_path, hamiltonian).reproduction
    (row, _) = run(script, tmp_path)
    path = tmp_path / "claims.toml"
    text = path.read_text().replace(', { q = "1/3", p = "-2/7" }', "")
    numbers = ", ".join(f'"{x:.3f}"' for x in row)
    path.write_text(text.replace('"-1.0000", "-2.0000", "-3.0000"', numbers))
    (result,) = prepare(load_claims(path)).run(Store(None), where=THIS_PROCESS)
    assert result.verdict.holds
    assert result.reproduction == "", "what is right needs no program"


@pytest.mark.parametrize("quantity", QUANTITIES)
@pytest.mark.parametrize("hamiltonian", HAMILTONIANS.values(), ids=HAMILTONIANS)
def test_the_program_has_at_most_20_lines_and_imports_only_math(
    tmp_path: Path, hamiltonian: str, quantity: str
) -> None:
    script = judge(tmp_path, hamiltonian, quantity=quantity).reproduction
    assert 0 < len(script.splitlines()) <= 20
    imports = [x for x in ast.walk(ast.parse(script)) if isinstance(x, ast.Import | ast.ImportFrom)]
    assert [ast.unparse(x) for x in imports] == ["import math"]


def test_the_first_line_says_what_is_computed(tmp_path: Path) -> None:
    first = judge(tmp_path, HAMILTONIANS["pendulum"]).reproduction.partition("\n")[0]
    assert first == "# lg mse of lie2 for H = p**2/2 - cos(q), in doubles"


def test_numbers_stand_in_it_as_they_were_given(tmp_path: Path) -> None:
    script = judge(tmp_path, HAMILTONIANS["pendulum"]).reproduction
    assert "for q0, p0 in [(1.5, 0), (1/3, -2/7)]:" in script
    assert "for h, steps in [(0.1, 30), (1/30, 90), (0.05, 60)]:" in script


@pytest.mark.parametrize(
    ("hamiltonian", "scheme"),
    [
        ("p**2/2 - cos(q)", "implicit-midpoint"),
        ("p**2/2 + q**2/2 + q*cos(t)", "lie2"),
        ("p1**2/2 + p2**2/2 + q1**2*q2**2", "lie2"),
        ("p**2/2 + q**2/2 + delta*q**4/4", "lie2"),
    ],
    ids=["implicit", "timed", "two-degrees", "free-parameter"],
)
def test_there_is_no_program_where_the_step_is_no_formula_in_p_q_and_h(
    hamiltonian: str, scheme: str
) -> None:
    parsed = Hamiltonian.parse(hamiltonian)
    assert table_script(parsed, scheme, "lg_mse", STARTS, SIZES) == ""


def test_there_is_one_where_it_is(tmp_path: Path) -> None:
    parsed = Hamiltonian.parse("p**2/2 - cos(q)")
    script = table_script(parsed, "lie2", "lg_mse", STARTS, SIZES)
    assert len(run(script, tmp_path)) == len(STARTS)


def test_a_map_with_a_wrong_sign_prints_other_numbers(tmp_path: Path) -> None:
    """So that what is compared above tells one map from another."""
    right = table_script(Hamiltonian.parse("p**2/2 - cos(q)"), "lie2", "lg_mse", STARTS, SIZES)
    wrong = table_script(Hamiltonian.parse("p**2/2 + cos(q)"), "lie2", "lg_mse", STARTS, SIZES)
    ((one, _),), ((other, _),) = run(right, tmp_path), run(wrong, tmp_path)
    assert abs(one - other) > 0.05


# -- of claims ------------------------------------------------------------------------------------


def test_a_table_whose_mse_is_0_has_no_program(tmp_path: Path) -> None:
    """Its logarithm is no number."""
    result = judge(tmp_path, HAMILTONIANS["pendulum"], scheme="symplectic-euler")
    assert (result.verdict, result.reproduction) == (Verdict.REFUTED, "")


def test_a_table_in_two_degrees_of_freedom_is_refuted_without_a_program(tmp_path: Path) -> None:
    path = tmp_path / "claims.toml"
    path.write_text(
        '[[claim]]\nid = "table"\nkind = "table"\nquantity = "mse"\nscheme = "lie2"\n'
        'hamiltonian = "p1**2/2 + p2**2/2 + q1**2/2 + q2**2"\nsteps = 20\nstep_sizes = [0.1]\n'
        'initial_values = [{ q = [1, 0], p = [0, 1] }]\nprinted = ["1.0"]\n'
    )
    (result,) = prepare(load_claims(path)).run(Store(None), where=THIS_PROCESS)
    assert (result.verdict, result.reproduction) == (Verdict.REFUTED, "")
