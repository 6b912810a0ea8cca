"""Truncation and rounding in W, n degrees of freedom, against an oracle that shares no code."""

from fractions import Fraction
from itertools import pairwise
from typing import Any

import pytest

from tests.helpers.sampled.separations import Remembering
from tests.helpers.stepping import form_separation as oracle
from tests.helpers.stepping.form_separation import MP, Float64Step
from verify import arithmetic as number_systems
from verify.errors import InputError
from verify.hamiltonians import systems
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.stepping import KernelRun
from verify.lockstep import run_alone
from verify.studies.separation.chain import Chain
from verify.studies.separation.links import Chains, separate_chains
from verify.studies.separation.matrix_products import Matrices
from verify.studies.separation.mixed_run import MixedRun
from verify.studies.separation.truncation_and_rounding import separate

DIGITS = 30
TINY = MP.mpf(10) ** -70  # of the oracle itself
HENON = systems.get("henon-heiles").hamiltonian({})
FPUT = systems.get("fput").hamiltonian({"n": 3, "alpha": "1/4", "beta": "1/10"})
DRIVEN = systems.get("driven-henon-heiles").hamiltonian({"epsilon": "1/10", "omega": "7/5"})


def real(x: Any) -> Any:
    exact = Fraction(x)
    return MP.mpf(exact.numerator) / exact.denominator


CASES: dict[str, tuple[Hamiltonian, Any, list[str], str, int]] = {
    "henon-heiles": (
        HENON, lambda of: oracle.henon_heiles(), ["0.1", "0.2", "0.3", "-0.1"], "0.1", 40,
    ),
    "fput": (
        FPUT, lambda of: oracle.chain(of("1/4"), of("1/10"), 3),
        ["0.1", "0", "-0.2", "0.5", "0.7", "0.4"], "0.07", 24,
    ),
    "driven-henon-heiles": (
        DRIVEN, lambda of: oracle.henon_heiles(of("1/10"), of("7/5")),
        ["0.1", "0.2", "0.3", "-0.1"], "0.1", 30,
    ),
}  # fmt: skip
T0 = "1/3"


def made(name: str) -> tuple[Chains, dict[str, list[dict[tuple[int, int], Any]]]]:
    """The chains, and the links of each way by the oracle."""
    exact, potential, z, h, steps = CASES[name]
    start = dict(zip(exact.coordinates, map(Fraction, z), strict=True)) | {"h": Fraction(h)}
    timed = exact.time_dependent
    start |= {"t": Fraction(T0)} if timed else {}
    found = run_alone(separate_chains(exact, "lie2", start, steps, DIGITS))
    rounded = [float(Fraction(x)) for x in z]
    step = Float64Step(exact, "lie2", float(h))
    run = step.run(rounded, float(Fraction(T0)), steps)
    exactly, binary = potential(real), potential(lambda x: real(float(Fraction(x))))
    first, size, size_1 = real(Fraction(T0)), real(h), real(float(h))
    links = [
        oracle.exact_w(exactly, list(map(real, z)), size, [first + k * size for k in range(steps)])
    ]
    first = real(float(Fraction(T0)))
    times = [first + k * size_1 for k in range(steps)]
    links.append(oracle.exact_w(binary, list(map(real, rounded)), size_1, times))
    clock = list(map(real, run.times))
    if timed:
        links.append(oracle.exact_w(binary, list(map(real, rounded)), size_1, clock))
    links.append(oracle.exact_w(binary, rounded, size_1, clock, run.states))
    plain = [*links, run.plain(exactly=True), run.plain(exactly=False)]
    return found, {"plain": plain, "closed_form": [*links, run.closed_exactly(), run.closed]}


def as_mpf(x: Any) -> Any:
    return real(x) if isinstance(x, float | Fraction | int) else x


def wrong_parts(
    chains: tuple[Chain, ...], links: list[dict[tuple[int, int], Any]]
) -> list[tuple[tuple[int, int], str]]:
    """The entries and parts that differ from the oracle in their first 30 digits."""
    found = []
    for chain, place in zip(chains, links[0], strict=True):
        own = [as_mpf(link[place]) for link in links]
        parts = dict(zip(chain.parts, pairwise(own), strict=True))
        expected = {n: b - a for n, (a, b) in parts.items()}
        expected |= {"truncation": own[0], "lambda_working": own[-1], "total": own[-1] - own[0]}
        for name, x in expected.items():
            value, bound = chain.final(name)
            apart = abs(real(value) - x)
            if apart > abs(x) / MP.mpf(10) ** DIGITS or apart > real(bound) + TINY:
                found.append((place, name))
    return found


@pytest.mark.left_to_ci
@pytest.mark.parametrize("name", CASES)
def test_every_part_of_every_entry_agrees_with_the_oracle_to_30_digits(name: str) -> None:
    found, links = made(name)
    assert wrong_parts(found.plain, links["plain"]) == []
    assert wrong_parts(found.closed_form, links["closed_form"]) == []


def test_a_planted_wrong_part_is_noticed() -> None:
    found, links = made("henon-heiles")
    for k in range(1, 4):
        planted = [dict(link) for link in links["plain"]]
        planted[k][0, 1] = as_mpf(planted[k][0, 1]) * (1 + MP.mpf(10) ** -12)
        assert len(wrong_parts(found.plain, planted)) == 2, "the parts on both sides of a link"


@pytest.mark.parametrize("scheme", ["lie2", "rk4", "stormer-verlet"])
def test_parts_add_up_exactly_at_every_checkpoint(scheme: str) -> None:
    start = {"p1": "0.1", "p2": "0.2", "q1": "0.3", "q2": "-0.1", "h": "0.1"}
    found = run_alone(
        separate_chains(HENON, scheme, {n: Fraction(x) for n, x in start.items()}, 50, 17)
    )
    for chain in (*found.plain, *found.closed_form):
        trails = [chain.trail(name)[0] for name in ("truncation", *chain.parts)]
        sums = [sum(each) for each in zip(*trails, strict=True)]
        assert sums == list(chain.trail("lambda_working")[0])


def test_what_is_symplectic_by_proof_has_no_truncation_and_is_not_run() -> None:
    found = separate(
        HENON, "stormer-verlet", q=["0.3", "-0.1"], p=["0.1", "0.2"], step_size="0.1", steps=60
    )
    assert found.plain is not None
    assert found.closed_form is not None
    for part in ("truncation", "input", "trajectory"):
        assert not any(map(any, getattr(found.plain.parts, part).exact))
    assert any(map(any, found.plain.parts.total.exact)), "float64 rounds its Jacobians"
    assert not any(map(any, found.closed_form.parts.w_working.exact))
    assert found.closed_form.error_kind == "enclosed"


def test_the_working_w_of_the_closed_form_is_that_of_a_float64_run_bit_for_bit() -> None:
    given = {"p1": "0.1", "p2": "0.2", "q1": "0.3", "q2": "-0.1", "h": "0.1"}
    start = {n: Fraction(x) for n, x in given.items()}
    found = run_alone(separate_chains(HENON, "lie2", start, 300, 17))
    run = KernelRun(HENON, "lie2", start, 300, frozenset({"symplectic_defect"}), 0)
    ran = run.run(number_systems.get("float64", 17)).values["symplectic_defect"]
    assert max(abs(chain.final("lambda_working")[0]) for chain in found.closed_form) == ran


def test_an_orbit_that_escapes_says_at_which_step() -> None:
    found = separate(
        HENON, "lie2", q=["0.9", "0.9"], p=["0.1", "0.2"], step_size="0.05", steps=2000
    )
    assert (found.status, found.failed_step, found.plain) == ("left range", 121, None)
    before = separate(
        HENON, "lie2", q=["0.9", "0.9"], p=["0.1", "0.2"], step_size="0.05", steps=100
    )
    assert before.status == "finished"


@pytest.mark.left_to_ci
@pytest.mark.sample(2)
@pytest.mark.parametrize(
    ("system", "parameters", "scheme", "q", "p"),
    [
        ("kepler", {"mu": 1}, "lie2", ["2/5", "0"], ["0", "2"]),
        ("magnetic", {"b": 1, "k": 1, "c": 1}, "lie4", ["0", "3/4"], ["1/2", "0"]),
        ("fput", {"n": 4, "alpha": "1/4", "beta": "1/2"}, "rk4", ["0.1", "0", "0", "0"], ["0"] * 4),
    ],
)
def test_named_systems_are_separated(
    system: str, parameters: dict[str, Any], scheme: str, q: list[str], p: list[str]
) -> None:
    exact = systems.get(system).hamiltonian(parameters)
    found = separate(exact, scheme, q=q, p=p, step_size="0.01", steps=15)
    assert found.status == "finished"
    assert found.closed_form is not None
    parts = found.closed_form.parts
    assert abs(parts.truncation.largest) > abs(parts.total.largest)
    entry = parts.truncation.entry(0, 1)
    assert -entry == parts.truncation.entry(1, 0)


@pytest.mark.parametrize(
    ("changed", "problem"),
    [
        ({"q": ["0.3"]}, "has 1 of 2 numbers"),
        ({"step_size": 0}, "step_size=0"),
        ({"steps": 0}, "steps=0"),
        ({"arithmetic": "float64"}, "is what is examined"),
        ({"hamiltonian": systems.get("fput").hamiltonian({"n": 5, "alpha": 1, "beta": 1}),
          "q": [0] * 5, "p": [1] * 5}, "is for up to 4 degrees of freedom"),
    ],
)  # fmt: skip
def test_bad_input_is_refused_in_one_line(changed: dict[str, Any], problem: str) -> None:
    asked = {"hamiltonian": HENON, "scheme": "lie2", "q": ["0.3", "-0.1"], "p": ["0.1", "0.2"],
             "step_size": "0.1", "steps": 10}  # fmt: skip
    with pytest.raises(InputError, match=problem) as error:
        separate(**(asked | changed))
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("name", CASES)
def test_rounding_is_counted_and_the_bounds_hold(name: str) -> None:
    found, links = made(name)
    assert all(chain.links[-2].kind == "enclosed" for chain in (*found.plain, *found.closed_form))
    for chains, own in ((found.plain, links["plain"]), (found.closed_form, links["closed_form"])):
        for chain, place in zip(chains, own[0], strict=True):
            for link, exact in zip(chain.links, own, strict=True):
                assert abs(real(link.trail[-1]) - as_mpf(exact[place])) <= real(link.bound) + TINY


def test_few_digits_give_wide_bounds_that_hold_all_the_same() -> None:
    """Where wide numbers are hardly wider than float64, their error is seen, and is within."""
    exact, _, z, h, _ = CASES["henon-heiles"]
    start = dict(zip(exact.coordinates, map(Fraction, z), strict=True)) | {"h": Fraction(h)}
    run = KernelRun(exact, "lie2", start, 400, frozenset({"symplectic_defect"}), 0)
    beside = MixedRun(Matrices(4), run, follow=True)
    coarse, fine = (
        run_alone(beside.step_through(number_systems.get("mpfr", digits), lambda _: None))
        for digits in (20, 60)
    )
    for name in ("trajectory", "factors", "closed_factors"):
        pairs = list(zip(getattr(coarse, name), getattr(fine, name), strict=True))
        apart = [abs(x - y) for a, b in pairs for x, y in zip(a.trail, b.trail, strict=True)]
        bound = max(a.bound for a, _ in pairs)
        assert all(a.kind == "enclosed" for a, _ in pairs)
        assert 0 < max(apart) <= bound
        assert bound < 10**8 * max(apart), "not so wide that it says nothing"


@pytest.mark.left_to_ci
def test_where_w_is_large_nothing_is_counted_and_a_rerun_estimates() -> None:
    start = {"p1": "0.5277", "p2": "0", "q1": "0", "q2": "-0.15", "h": "0.2"}
    found = run_alone(
        separate_chains(HENON, "rk4", {n: Fraction(x) for n, x in start.items()}, 700, 8)
    )
    assert found.closed_form[0].kind == "estimated"
    assert "rerun with 15 more digits" in found.closed_form[0].methods


@pytest.mark.left_to_ci
@pytest.mark.sample(1)
@pytest.mark.parametrize("name", ["henon-heiles", "driven-henon-heiles"])
def test_an_interrupted_run_goes_on_with_the_same_bits(name: str) -> None:
    exact, _, z, h, steps = CASES[name]
    start = dict(zip(exact.coordinates, map(Fraction, z), strict=True)) | {"h": Fraction(h)}
    start |= {"t": Fraction(T0)} if exact.time_dependent else {}
    keeper = Remembering()
    whole = run_alone(separate_chains(exact, "lie2", start, steps, 17, keeper=keeper))
    beside = [label for label in keeper.kept if label.startswith("beside ")]
    assert beside
    for label in beside:
        keeper.kept[label] = {"found": keeper.kept[label]["found"][: steps // 2]}
    again = run_alone(separate_chains(exact, "lie2", start, steps, 17, keeper=keeper))
    for a, b in zip(whole.plain + whole.closed_form, again.plain + again.closed_form, strict=True):
        assert [link.trail for link in a.links] == [link.trail for link in b.links]
