"""Claims on numbers in files that stand alone, with the runs that they need."""

import math
from pathlib import Path

import pytest

from verify.claims.claims_file import load_claims
from verify.claims.verdicts import prepare
from verify.execution.execute import Store
from verify.execution.executors import THIS_PROCESS
from verify.scenes.results.claim import ClaimResult
from verify.verdict import Verdict

MEASURED, REFUTED, UNDECIDED = Verdict.MEASURED, Verdict.REFUTED, Verdict.UNDECIDED
ENCLOSED, PROVED = Verdict.ENCLOSED, Verdict.PROVED

ONE_RUN = """
[defaults]
scheme = "lie2"
system = "duffing"
parameters = { delta = 1 }
step_size = 0.001
steps = 2000
q = 1.5
p = 0

"""


def check_file(folder: Path, content: str) -> dict[str, ClaimResult]:
    path = folder / "claims.toml"
    path.write_text(content)
    return {
        found.id: found for found in prepare(load_claims(path)).run(Store(None), where=THIS_PROCESS)
    }


def test_numbers_of_one_run_are_enclosed_or_refuted_in_a_file_that_stands_alone(
    tmp_path: Path,
) -> None:
    mse, lam, largest = plain_run(2000)
    claims = {
        "mse": ('kind = "mse"', f'printed = "{mse:.11e}"', f'printed = "{mse * 1.0000001:.11e}"'),
        "lg": ('kind = "mse"', f"lg_printed = {lg(mse)}", f"lg_printed = {lg(mse * 1.01)}"),
        "lam": ('kind = "lambda"', f'printed = "{lam:.9e}"', f'printed = "{-lam:.9e}"'),
        "bound": ('kind = "bounded"', f'bound = "{largest * 1.000001:.12e}"',
                  f'bound = "{largest * 0.999999:.12e}"'),
    }  # fmt: skip
    content = ONE_RUN
    for name, (kind, true, wrong) in claims.items():
        content += f'[[claim]]\nid = "{name}"\n{kind}\n{true}\n'
        content += f'[[claim]]\nid = "{name}-wrong"\n{kind}\n{wrong}\n'
    found = check_file(tmp_path, content)
    assert {n: r.verdict for n, r in found.items()} == {
        n + tail: verdict for n in claims for tail, verdict in (("", ENCLOSED), ("-wrong", REFUTED))
    }


def lg(x: float) -> str:
    return f"{math.log10(x):.4f}"


def plain_run(steps: int) -> tuple[float, float, float]:
    """MSE, Λ and max |Λ| of Eq. 19 by plain floats, δ = 1, h = 0.001 from (1.5, 0)."""
    h, p, q = 0.001, 0.0, 1.5
    squares, lam, largest = 0.0, 0.0, 0.0
    for _ in range(steps):
        a, d = q + q**3, 1 + 3 * q * q
        delta_j = 3 * h**3 * p * q + h**4 * d * d / 4
        squares, lam = squares + delta_j**2, lam + delta_j + lam * delta_j
        largest = max(largest, abs(lam))
        p, q = p - h * a - h * h / 2 * p * d, q + h * p - h * h / 2 * a
    return squares / steps, lam, largest


def test_where_a_proof_gives_the_numbers_nothing_is_run(tmp_path: Path) -> None:
    content = (
        ONE_RUN.replace("lie2", "symplectic-euler").replace("2000", "900000000000")
        + """
[[claim]]
id = "zero"
kind = "lambda"
printed = 0
[[claim]]
id = "not-zero"
kind = "mse"
printed = "1e-17"
[[claim]]
id = "bounded"
kind = "bounded"
bound = 0
[[claim]]
id = "stays"
kind = "growth"
growth = "bounded"
[[claim]]
id = "grows"
kind = "growth"
growth = "linear"
[[claim]]
id = "constant"
kind = "lambda"
scheme = "lie2"
system = "harmonic"
parameters = { omega = 1 }
printed = "0.2523"
"""
    )
    path = tmp_path / "claims.toml"
    path.write_text(content)
    prepared = prepare(load_claims(path))
    assert prepared.plan.tasks == {}
    assert prepared.plan.left_out
    found = {r.id: r.verdict for r in prepared.run(Store(None))}
    assert found == {"zero": ENCLOSED, "not-zero": REFUTED, "bounded": ENCLOSED, "stays": PROVED,
                     "grows": REFUTED, "constant": ENCLOSED}  # fmt: skip


def test_growth_of_an_odd_and_of_an_even_scheme_is_seen_in_runs(tmp_path: Path) -> None:
    content = """
[defaults]
kind = "growth"
system = "pendulum"
step_size = 0.05
time = 400
q = 1.5
p = 0
[[claim]]
id = "odd-linear"
scheme = "lie3"
growth = "linear"
[[claim]]
id = "odd-bounded"
scheme = "lie3"
growth = "bounded"
"""
    found = check_file(tmp_path, content)
    assert found["odd-linear"].verdict is MEASURED
    assert found["odd-bounded"].verdict is REFUTED


def test_a_chaotic_or_escaping_orbit_decides_nothing(tmp_path: Path) -> None:
    content = """
[[claim]]
id = "escapes"
kind = "lambda"
scheme = "lie2"
hamiltonian = "p**2/2 - q**4"
step_size = 1
steps = 60
q = 1.5
p = 0
printed = "1.0"
"""
    found = check_file(tmp_path, content)["escapes"]
    assert found.verdict is UNDECIDED
    assert "left the range" in found.evidence


def test_more_digits_are_computed_where_more_are_printed(tmp_path: Path) -> None:
    digits = "-2.6663912864100748882473012881433962680021897177896e-06"
    content = ONE_RUN.replace("2000", "20000") + (
        f'[[claim]]\nid = "a"\nkind = "lambda"\nprinted = "{digits}"\n'
        f'[[claim]]\nid = "b"\nkind = "lambda"\nprinted = "{digits.replace("896e", "897e")}"\n'
    )
    found = check_file(tmp_path, content)
    assert (found["a"].verdict, found["b"].verdict) == (ENCLOSED, REFUTED)


IN_DEGREES = """
[[claim]]
id = "a"
scheme = "lie2"
system = "henon-heiles"
"""
RUN = "step_size = 0.01\nsteps = 500\nq = [0.3, -0.1]\np = [0.1, 0.2]\n"


@pytest.mark.parametrize(
    ("claim", "verdict"),
    [
        ('kind = "order"\norder = 4', PROVED),  # of det J − 1, where S is of order 3
        ('kind = "order"\norder = 3', REFUTED),
        ('kind = "defect_order"\ndefect_order = 3', PROVED),
        ('kind = "symplectic"\nsymplectic = true', REFUTED),
        ('kind = "symplectic"\nsymplectic = false', PROVED),
        (f'kind = "bounded"\nbound = 0.001\n{RUN}', ENCLOSED),
        (f'kind = "bounded"\nbound = 1e-9\n{RUN}', REFUTED),
        (f'kind = "magnitude"\nexponents = {{ symplectic_defect_max = -6 }}\n'
         f'quantifier = "every"\n{RUN}', ENCLOSED),
    ],
)  # fmt: skip
def test_a_claim_on_lists_in_degrees_is_judged(
    tmp_path: Path, claim: str, verdict: Verdict
) -> None:
    found = check_file(tmp_path, IN_DEGREES + claim)["a"]
    assert found.verdict is verdict, found.evidence
