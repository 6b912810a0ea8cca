"""Links of a separation: against an oracle that shares no code, their sums, their bounds."""

from fractions import Fraction
from itertools import pairwise
from typing import Any

import pytest

from tests.helpers.sampled.separations import Remembering
from tests.helpers.stepping import lie2_separation as oracle
from tests.helpers.stepping.lie2_separation import MP, Float64Step
from verify import arithmetic as number_systems
from verify.arithmetic.number_system import Arithmetic
from verify.arithmetic.systems import fixed, mpfr
from verify.hamiltonians import systems
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.stepping import KernelRun
from verify.lockstep import run_alone
from verify.studies.separation.chain import QUANTITIES, Chain
from verify.studies.separation.links import Chains, separate_chains, way_for
from verify.studies.separation.mixed_run import MixedRun

DIGITS = 30
TINY = MP.mpf(10) ** -70  # of the oracle itself
HENON = systems.get("henon-heiles").hamiltonian({})
DUFFING = Hamiltonian.parse("p**2/2 + q**2/2 + delta*q**4/4", {"delta": 1})
PENDULUM = Hamiltonian.parse("p**2/2 - cos(q)")
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
PLANE = {"p": "1/3", "q": "3/2", "h": "1/50"}
START = {"p1": "0.1", "p2": "0.2", "q1": "0.3", "q2": "-0.1", "h": "0.1"}
CHAOTIC = {"p1": "0.5277", "p2": "0", "q1": "0", "q2": "-0.15", "h": "0.2"}


def exactly(start: dict[str, str]) -> dict[str, Fraction]:
    return {name: Fraction(x) for name, x in start.items()}


# -- against the oracle, in n degrees of freedom --------------------------------------------------


def start_of(name: str) -> dict[str, Fraction]:
    exact, _, z, h, _ = CASES[name]
    start = exactly(dict(zip(exact.coordinates, z, strict=True)) | {"h": h})
    return start | ({"t": Fraction(T0)} if exact.time_dependent else {})


def chains_and_oracle(name: str) -> tuple[Chains, dict[str, list[dict[tuple[int, int], Any]]]]:
    """The chains, and the links of each way by the oracle."""
    exact, potential, z, h, steps = CASES[name]
    chains = run_alone(separate_chains(exact, "lie2", start_of(name), steps, DIGITS))
    rounded = [float(Fraction(x)) for x in z]
    step = Float64Step(exact, "lie2", float(h))
    run = step.run(rounded, float(Fraction(T0)), steps)
    unrounded, binary = potential(real), potential(lambda x: real(float(Fraction(x))))
    first, size, size_1 = real(Fraction(T0)), real(h), real(float(h))
    links = [
        oracle.exact_w(
            unrounded, list(map(real, z)), size, [first + k * size for k in range(steps)]
        )
    ]
    first = real(float(Fraction(T0)))
    times = [first + k * size_1 for k in range(steps)]
    links.append(oracle.exact_w(binary, list(map(real, rounded)), size_1, times))
    clock = list(map(real, run.times))
    if exact.time_dependent:
        links.append(oracle.exact_w(binary, list(map(real, rounded)), size_1, clock))
    links.append(oracle.exact_w(binary, rounded, size_1, clock, run.states))
    plain = [*links, run.plain(exactly=True), run.plain(exactly=False)]
    return chains, {"plain": plain, "closed_form": [*links, run.closed_exactly(), run.closed]}


def as_mpf(x: Any) -> Any:
    return real(x) if isinstance(x, float | Fraction | int) else x


def wrong_parts(
    chains: tuple[Chain, ...], links: list[dict[tuple[int, int], Any]]
) -> list[tuple[tuple[int, int], str]]:
    """The entries and parts that differ from the oracle in their first 30 digits."""
    wrong = []
    for chain, place in zip(chains, links[0], strict=True):
        entries = [as_mpf(link[place]) for link in links]
        first, last = entries[0], entries[-1]
        parts = dict(zip(chain.parts, pairwise(entries), strict=True))
        expected = {n: b - a for n, (a, b) in parts.items()}
        expected |= {"truncation": first, "lambda_working": last, "total": last - first}
        for name, x in expected.items():
            value, bound = chain.final(name)
            apart = abs(real(value) - x)
            if apart > abs(x) / MP.mpf(10) ** DIGITS or apart > real(bound) + TINY:
                wrong.append((place, name))
    return wrong


@pytest.mark.left_to_ci
@pytest.mark.parametrize("name", CASES)
def test_every_part_of_every_entry_agrees_with_the_oracle_to_30_digits(name: str) -> None:
    chains, links = chains_and_oracle(name)
    assert wrong_parts(chains.plain, links["plain"]) == []
    assert wrong_parts(chains.closed_form, links["closed_form"]) == []


def test_a_planted_wrong_part_is_noticed() -> None:
    chains, links = chains_and_oracle("henon-heiles")
    for k in range(1, 4):
        planted = [dict(link) for link in links["plain"]]
        planted[k][0, 1] = as_mpf(planted[k][0, 1]) * (1 + MP.mpf(10) ** -12)
        assert len(wrong_parts(chains.plain, planted)) == 2, "the parts on both sides of a link"


@pytest.mark.parametrize("name", CASES)
def test_rounding_is_counted_and_the_bounds_hold(name: str) -> None:
    chains, links = chains_and_oracle(name)
    for way, exact_links in links.items():
        for chain, place in zip(getattr(chains, way), exact_links[0], strict=True):
            assert chain.links[-2].kind == "enclosed"
            for link, exact in zip(chain.links, exact_links, strict=True):
                assert abs(real(link.trail[-1]) - as_mpf(exact[place])) <= real(link.bound) + TINY


# -- sums and bounds ------------------------------------------------------------------------------


@pytest.mark.parametrize("scheme", ["lie2", "rk4", "stormer-verlet"])
def test_parts_add_up_exactly_at_every_checkpoint(scheme: str) -> None:
    chains = run_alone(separate_chains(HENON, scheme, exactly(START), 50, 17))
    for chain in (*chains.plain, *chains.closed_form):
        trails = [chain.trail(name)[0] for name in ("truncation", *chain.parts)]
        sums = [sum(each) for each in zip(*trails, strict=True)]
        assert sums == list(chain.trail("lambda_working")[0])


@pytest.mark.parametrize(
    ("hamiltonian", "start", "steps", "coarse", "times"),
    [
        (DUFFING, PLANE, 600, mpfr.at_bits(60), 10**5),
        (DUFFING, PLANE, 600, fixed.at_bits(112), 10**5),
        (PENDULUM, PLANE, 600, mpfr.at_bits(60), 10**5),
        (PENDULUM, PLANE, 600, fixed.at_bits(112), 10**5),
        (HENON, START, 400, number_systems.get("mpfr", 20), 10**8),
    ],
    ids=["duffing-mpfr", "duffing-fixed", "pendulum-mpfr", "pendulum-fixed", "henon-heiles-mpfr"],
)
def test_counted_bounds_hold_for_few_bits_and_are_not_far_off(
    hamiltonian: Hamiltonian, start: dict[str, str], steps: int, coarse: Arithmetic, times: int
) -> None:
    """Where wide numbers are hardly wider than float64, their error is seen, and is within."""
    way = way_for(hamiltonian)
    run = KernelRun(hamiltonian, "lie2", exactly(start), steps, way.observables, 0)
    beside = MixedRun(way, run, follow=True)
    few, many = (
        run_alone(beside.step_through(x, lambda _: None)) for x in (coarse, mpfr.at_bits(300))
    )
    for name in ("trajectory", "factors", "closed_factors"):
        errors = []
        for x, y in zip(getattr(few, name), getattr(many, name), strict=True):
            assert x.kind == y.kind == "enclosed"
            errors.append(max(abs(a - b) for a, b in zip(x.trail, y.trail, strict=True)))
            assert errors[-1] <= x.bound
        bound = max(x.bound for x in getattr(few, name))
        assert 0 < max(errors) <= bound <= times * max(errors), "it says something"


@pytest.mark.parametrize(
    ("hamiltonian", "scheme", "start", "steps", "digits", "finer"),
    [
        pytest.param(DUFFING, "lie1", {"p": "1/3", "q": "3/2", "h": "1/20"}, 100, 17, 40,
                     id="duffing"),
        pytest.param(HENON, "rk4", CHAOTIC, 700, 8, None, id="henon-heiles",
                     marks=pytest.mark.left_to_ci),
    ],
)  # fmt: skip
def test_where_rounding_cannot_be_counted_a_rerun_estimates_it(
    hamiltonian: Hamiltonian, scheme: str, start: dict[str, str], steps: int, digits: int,
    finer: int | None,
) -> None:  # fmt: skip
    """Λ, or W, grows beyond ½ here, and the counted bound speaks of less."""
    run = hamiltonian, scheme, exactly(start), steps
    chains = run_alone(separate_chains(*run, digits))
    assert chains.closed_form is not None
    for chain in (*chains.plain, *chains.closed_form):
        assert max(map(abs, chain.links[2].trail)) > Fraction(1, 2)
        assert chain.links[2].kind == chain.links[3].kind == "estimated"
        assert chain.kind == "estimated"
        assert "rerun with 15 more digits" in chain.methods
    if finer:
        (chain,), (other,) = chains.plain, run_alone(separate_chains(*run, finer)).plain
        for name in QUANTITIES:
            (x, dx), (y, dy) = chain.final(name), other.final(name)
            assert abs(x - y) <= dx + dy, name


@pytest.mark.left_to_ci
@pytest.mark.sample(1)
@pytest.mark.parametrize("name", ["henon-heiles", "driven-henon-heiles"])
def test_an_interrupted_run_goes_on_with_the_same_bits(name: str) -> None:
    exact, *_, steps = CASES[name]
    start, keeper = start_of(name), Remembering()
    whole = run_alone(separate_chains(exact, "lie2", start, steps, 17, keeper=keeper))
    beside = [label for label in keeper.kept if label.startswith("beside ")]
    assert beside
    for label in beside:
        keeper.kept[label] = {"found": keeper.kept[label]["found"][: steps // 2]}
    again = run_alone(separate_chains(exact, "lie2", start, steps, 17, keeper=keeper))
    for a, b in zip(whole.plain + whole.closed_form, again.plain + again.closed_form, strict=True):
        assert [link.trail for link in a.links] == [link.trail for link in b.links]
