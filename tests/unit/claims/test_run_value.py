"""Printed numbers of one run, held against a leapfrog of two bodies in mpmath."""

from functools import cache
from pathlib import Path

import mpmath
import pytest

from tests.unit.claims.test_check import check_file
from verify.errors import InputError
from verify.verdict import Verdict

HEAD = """
[defaults]
scheme = "stormer-verlet"
hamiltonian = "(p1**2 + p2**2)/2 - 1/sqrt(q1**2 + q2**2)"
step_size = "0.05"
time = 5
q = [1, 0]
p = [0, "1.1"]
kind = "run_value"
"""


@cache
def computed() -> dict[str, mpmath.mpf]:
    """The numbers of 100 steps by other code, to 40 digits."""
    mp = mpmath.mp.clone()
    mp.dps = 40
    h, q, p = mp.mpf("0.05"), [mp.mpf(1), mp.mpf(0)], [mp.mpf(0), mp.mpf("1.1")]

    def kick(momenta: list[mpmath.mpf], at: list[mpmath.mpf]) -> list[mpmath.mpf]:
        cube = mp.sqrt(at[0] ** 2 + at[1] ** 2) ** 3
        return [a - h / 2 * x / cube for a, x in zip(momenta, at, strict=True)]

    def energy() -> mpmath.mpf:
        return (p[0] ** 2 + p[1] ** 2) / 2 - 1 / mp.sqrt(q[0] ** 2 + q[1] ** 2)

    first, greatest = energy(), mp.mpf(0)
    for _ in range(100):
        p = kick(p, q)
        q = [a + h * b for a, b in zip(q, p, strict=True)]
        p = kick(p, q)
        greatest = max(greatest, abs(energy() - first))
    return {
        "q1": q[0],
        "p2": p[1],
        "energy_error": energy() - first,
        "|energy_error|": abs(energy() - first),
        "energy_error_max": greatest,
        "relative": greatest / abs(first),
        "lg": mp.log10(greatest),
        "lg q1": mp.log10(abs(q[0])),
    }


def printed(name: str, digits: int = 6, *, off: bool = False) -> str:
    """The number to so many digits; or 1 off in the last of them."""
    value = computed()[name]
    unit = mpmath.mpf(10) ** (mpmath.floor(mpmath.log10(abs(value))) - digits + 1)
    value = value + unit if off else value
    return mpmath.nstr(value, digits, strip_zeros=False, min_fixed=0, max_fixed=0)


TRUE = {
    "q1": ('of = "q1"\nprinted = "{}"', "q1"),
    "p2": ('of = " p2 "\nprinted = "{}"', "p2"),
    "energy": ('of = "energy_error"\nprinted = "{}"', "energy_error"),
    "size": ('of = "|energy_error|"\nprinted = "{}"', "|energy_error|"),
    "greatest": ('of = "energy_error_max"\nprinted = "{}"', "energy_error_max"),
    "formula": (
        'of = "integral_error_max: (p1**2 + p2**2)/2 - 1/sqrt(q1**2 + q2**2)"\nprinted = "{}"',
        "energy_error_max",
    ),
    "relative": ('of = "energy_error_max"\nrelative = true\nprinted = "{}"', "relative"),
    "lg": ('of = "energy_error_max"\nlg_printed = "{}"', "lg"),
    "lg-negative": ('of = "q1"\nlg_printed = "{}"', "lg q1"),
}


@pytest.fixture(scope="module")
def verdicts(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Verdict]:
    claims = []
    for name, (keys, number) in TRUE.items():
        claims += [(name, keys.format(printed(number)))]
        claims += [(f"{name}-off", keys.format(printed(number, off=True)))]
    size = computed()["energy_error_max"]
    for key, sides in (("at_most", (1.001, 0.999)), ("at_least", (0.999, 1.001))):
        for what, factor in zip(("", "-off"), sides, strict=True):
            keys = f'of = "energy_error_max"\n{key} = "{mpmath.nstr(size * factor, 8)}"'
            claims.append((f"{key}{what}", keys))
    content = "".join(f'\n[[claim]]\nid = "{name}"\n{keys}\n' for name, keys in claims)
    results = check_file(tmp_path_factory.mktemp("claims"), HEAD + content)
    return {name: result.verdict for name, result in results.items()}


@pytest.mark.parametrize("name", [*TRUE, "at_most", "at_least"])
def test_a_right_number_holds_and_one_digit_off_is_refuted(
    name: str, verdicts: dict[str, Verdict]
) -> None:
    assert verdicts[name] in (Verdict.MEASURED, Verdict.ENCLOSED)
    assert verdicts[f"{name}-off"] is Verdict.REFUTED


def test_what_a_step_keeps_has_no_error(tmp_path: Path) -> None:
    keys = 'of = "integral_error: q1*p2 - q2*p1"\nprinted = "0"'
    kept = check_file(tmp_path, f'{HEAD}\n[[claim]]\nid = "a"\n{keys}\n')["a"]
    assert kept.verdict is Verdict.ENCLOSED


WRONG = {
    'of = "q1"': "printed, lg_printed, at_most, at_least.*give one of the four",
    'of = "q1"\nprinted = "1"\nat_most = "2"': "give one of the four",
    'of = "energie_error"\nprinted = "1"': "unknown; is energy_error meant",
    'of = "q1"\nrelative = true\nprinted = "1"': "is of the energy or of an integral",
    'of = "q3"\nprinted = "1"': "q3",
    'of = "integral_error: q1*"\nprinted = "1"': "not a formula",
    'of = "integral_error: q1*q2"\nrelative = true\nprinted = "1"': "initial value, which is 0",
}


@pytest.mark.parametrize("keys", WRONG)
def test_what_is_wrong_is_said_in_a_line(keys: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=WRONG[keys]):
        check_file(tmp_path, f'{HEAD}\n[[claim]]\nid = "a"\n{keys}\n')


# -- ratios of two runs ---------------------------------------------------------------------------

RATIOS = """
[defaults]
system = "pendulum"
time = 5
q = 1
p = 0
step_sizes = [0.1, 0.05]
kind = "run_ratio"

[[claim]]
id = "{}"
scheme = "{}"
of = "{}"
{}
"""


@pytest.mark.parametrize(
    ("scheme", "keys", "planted"),
    [
        ("stormer-verlet", 'printed = "4.0"', 'printed = "4.1"'),
        ("stormer-verlet", 'order = true\nprinted = "2.00"', 'order = true\nprinted = "2.02"'),
        ("rk4", "order = true\nat_least = 4", "order = true\nat_least = 5"),
        ("rk4", 'lg_printed = "1.4"', 'lg_printed = "1.5"'),
    ],
)
def test_a_ratio_of_two_runs_and_the_order_that_it_measures(
    scheme: str, keys: str, planted: str, tmp_path: Path
) -> None:
    results = [
        check_file(tmp_path, RATIOS.format("a", scheme, "energy_error_max", x))["a"].verdict
        for x in (keys, planted)
    ]
    assert results == [Verdict.ENCLOSED, Verdict.REFUTED]


def test_where_both_are_0_there_is_no_ratio(tmp_path: Path) -> None:
    content = RATIOS.format("a", "stormer-verlet", "lambda", "at_least = 1")
    result = check_file(tmp_path, content)["a"]
    assert result.verdict is Verdict.UNDECIDED
    assert "a value is 0" in str(result.evidence)


def test_a_ratio_is_of_two_runs(tmp_path: Path) -> None:
    content = RATIOS.format("a", "rk4", "lambda", "at_least = 1").replace(", 0.05", "")
    with pytest.raises(InputError, match="speaks of two runs; give two step_sizes"):
        check_file(tmp_path, content)
