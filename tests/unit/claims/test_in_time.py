"""Claims of an H that depends on time: true ones hold, planted errors are refuted."""

from pathlib import Path

import pytest

from verify.claims.claims_file import load_claims
from verify.claims.verdicts import prepare
from verify.errors import InputError
from verify.execution.execute import Store
from verify.execution.executors import THIS_PROCESS
from verify.verdict import Verdict

H = 'hamiltonian = "p**2/2 - (1 + cos(2*t)/2)*cos(q)"'
FROZEN = "kick 1/2 at 0; drift 1; kick 1/2 at 0; order 2"
RUN = 'scheme = "lie2"\nt0 = "1/3"\nq = 1.5\np = 0\nstep_size = 0.1\nsteps = 20\n'
LEADING = "h**3*(-p*sin(q)*cos(2*t)/4 - p*sin(q)/2 - sin(2*t)*cos(q)/2)"
PROVED, REFUTED = Verdict.PROVED, Verdict.REFUTED
EVERY, SEPARABLE = 'every = "hamiltonian in time"', 'every = "separable hamiltonian in time"'


def verdict(folder: Path, keys: str) -> Verdict:
    path = folder / "claims.toml"
    path.write_text(f'[[claim]]\nid = "c"\n{keys}\n')
    (found,) = prepare(load_claims(path)).run(Store(None), where=THIS_PROCESS)
    return found.verdict


@pytest.mark.parametrize(
    ("keys", "expected"),
    [
        (f'{H}\nscheme = "lie2"\nkind = "order"\norder = 3', PROVED),
        (f'{H}\nscheme = "lie2"\nkind = "order"\norder = 4', REFUTED),
        (f'{H}\nscheme = "stormer-verlet"\nkind = "area_preserving"\narea_preserving = true',
         PROVED),
        (f'{H}\nscheme = "{FROZEN}"\nkind = "convergence_order"\nconvergence_order = 1', PROVED),
        (f'{H}\nscheme = "{FROZEN}"\nkind = "convergence_order"\nconvergence_order = 2', REFUTED),
        (f'{H}\nscheme = "lie2"\nkind = "delta_j"\nup_to = 4\nformula = "{LEADING}"', PROVED),
        (f'{H}\nscheme = "lie2"\nkind = "delta_j"\nup_to = 4\n'
         f'formula = "{LEADING.replace("sin(2*t)", "sin(t)")}"', REFUTED),
        (f'{EVERY}\nscheme = "lie2"\nkind = "order"\norder = 3', PROVED),
        (f'{EVERY}\nscheme = "lie2"\nkind = "order"\norder = 2', REFUTED),
        (f'{EVERY}\nscheme = "rk4"\nkind = "convergence_order"\nconvergence_order = 4', PROVED),
        (f'{SEPARABLE}\nscheme = "{FROZEN}"\nkind = "convergence_order"\nconvergence_order = 2',
         REFUTED),
        (f'{SEPARABLE}\nscheme = "{FROZEN}"\nkind = "area_preserving"\narea_preserving = true',
         PROVED),
    ],
)  # fmt: skip
def test_a_claim_in_time(tmp_path: Path, keys: str, expected: Verdict) -> None:
    assert verdict(tmp_path, keys) is expected


def test_a_claim_on_a_run_has_its_t0(tmp_path: Path) -> None:
    from verify.hamiltonians.hamiltonian import Hamiltonian
    from verify.runs.requested_run import run

    exact = Hamiltonian.parse("p**2/2 - (1 + cos(2*t)/2)*cos(q)")
    found = run(exact, "lie2", q=1.5, p=0, step_size="0.1", steps=20, t0="1/3", digits=12,
                arithmetic="mpfr")  # fmt: skip
    printed = f"{float(found.values['lambda'].value):.6e}"
    claim = f'kind = "lambda"\n{H}\n{RUN}printed = "{printed}"'
    assert verdict(tmp_path, claim).holds
    assert verdict(tmp_path, claim.replace('"1/3"', '"1/4"')) is REFUTED


def test_the_distance_from_the_exact_solution_is_that_from_its_t0(tmp_path: Path) -> None:
    claim = f'kind = "solution_error"\n{H}\n{RUN}'
    assert verdict(tmp_path, f'{claim}within = "1/100"') is Verdict.MEASURED
    assert verdict(tmp_path, f'{claim}within = "1/100000"') is REFUTED
    still = claim.replace('"lie2"', f'"{FROZEN}"')
    assert verdict(tmp_path, f'{still}within = "1/100"') is REFUTED


LESS = '{ kind = "less", quantity = "mse", than = "abs_lambda" }'


@pytest.mark.parametrize(
    ("keys", "problem"),
    [
        (f'kind = "delta_j"\n{EVERY}\nscheme = "lie2"\nup_to = 4\nformula = "h**3"',
         "a printed ΔJ has no derivatives by t"),
        (f'kind = "order"\norder = 3\n{EVERY}\nscheme = "stormer-verlet"',
         "say 'separable hamiltonian in time'"),
        (f'kind = "order"\norder = 3\n{SEPARABLE}\nscheme = "lie2"', "say 'hamiltonian in time'"),
        (f'kind = "shifted"\nagain = [{LESS}]\n{H}\n{RUN}', "and so of no H that depends on t"),
        (f'kind = "lambda"\n{H}\n{RUN}printed = "1"'.replace('"1/3"', '"soon"'), "soon"),
    ],
)  # fmt: skip
def test_what_no_claim_says_is_refused(tmp_path: Path, keys: str, problem: str) -> None:
    with pytest.raises(InputError) as error:
        verdict(tmp_path, keys)
    assert problem in str(error.value)
    assert "\n" not in str(error.value)
