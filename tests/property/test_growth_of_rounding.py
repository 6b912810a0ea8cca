"""The growth of rounding, crossovers, and what a chain says of its parts, on drawn values."""

import math
from fractions import Fraction
from itertools import accumulate, pairwise

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from verify.errors import InputError
from verify.exact import magnitude
from verify.hamiltonian import Hamiltonian
from verify.separation import as_grid, grid, separate
from verify.separation_chain import PARTS, QUANTITIES, Chain, Kind
from verify.separation_growth import crossover, envelope, growth, log, log_spaced
from verify.separation_working import Link, marks_of

quick = settings(deadline=None, max_examples=40)
values = st.builds(Fraction, st.integers(-50, 50), st.integers(1, 10**6))
sizes = st.builds(lambda n, k: Fraction(n) / 10**k, st.integers(1, 99), st.integers(0, 30))


@quick
@given(st.lists(values, max_size=12))
def test_an_envelope_is_the_greatest_size_so_far(given_: list[Fraction]) -> None:
    assert envelope(given_) == list(accumulate(map(abs, given_), max))


@quick
@given(st.integers(1, 10**9), st.integers(1, 10**9), st.integers(0, 3000))
def test_a_logarithm_is_that_of_numbers_beyond_float64_too(n: int, d: int, k: int) -> None:
    true = math.log(n) - math.log(d) - k * math.log(10)
    assert math.isclose(log(Fraction(n, d * 10**k)), true, abs_tol=1e-9)


@quick
@given(st.lists(st.integers(1, 10**6), unique=True, min_size=1, max_size=80).map(sorted), st.integers(2, 20))  # fmt: skip
def test_log_spaced_marks_hold_the_ends_and_the_first_beyond_each_goal(
    at: list[int], most: int
) -> None:
    indices = [3 * k for k in range(len(at))]
    chosen = log_spaced(indices, at, most)
    if len(at) <= most:
        assert chosen == indices
        return
    assert chosen == sorted(set(chosen))
    assert len(chosen) <= most
    assert (chosen[0], chosen[-1]) == (indices[0], indices[-1])
    goals = [math.log(at[0]) + math.log(at[-1] / at[0]) * k / (most - 1) for k in range(most)]
    wanted = {next((i for i, x in zip(indices, at, strict=True) if math.log(x) >= g - 1e-9), indices[-1]) for g in goals}  # fmt: skip
    assert set(chosen) == wanted


# -- growth ---------------------------------------------------------------------------------------

MARKS = [5 * k for k in range(1, 601)]
exponents = st.sampled_from([Fraction(k, 4) for k in range(13)])


def power(n: int, exponent: Fraction) -> Fraction:
    return Fraction(round(2**40 * n ** float(exponent)), 2**140)


@quick
@given(exponents, st.booleans(), st.integers(20, 600))
def test_a_power_of_n_has_its_exponent_and_the_name_of_what_the_error_holds(
    exponent: Fraction, sign: bool, count: int
) -> None:
    marks = MARKS[:count]
    found = growth(marks, [power(n, exponent) * (-1) ** (n * sign) for n in marks], Fraction(0))
    reach = math.log10(marks[-1] / marks[7])
    assert (found.first, found.last) == (marks[7], marks[-1])
    assert found.points == len(log_spaced(range(7, count), marks[7:], 32))
    if reach < 1.5:
        assert (found.exponent, found.standard_error, found.name) == (None, None, "undecided")
        assert f"over {reach:.1f} decades" in found.reason
        return
    assert found.exponent is not None
    assert found.standard_error is not None
    assert abs(found.exponent - float(exponent)) < 1e-3
    error = 1.65 * math.log(marks[-1] / marks[7]) ** -1.5
    assert math.isclose(found.standard_error, error, rel_tol=1e-6)
    held = [x for x in (0.0, 0.5, 1.0) if abs(found.exponent - x) <= 2.5 * error]
    names = {0.5: "random walk", 1.0: "drift"}
    assert found.name == (names.get(held[0], "undecided") if len(held) == 1 else "undecided")
    said = " and ".join({0.0: "0", 0.5: "½", 1.0: "1"}[x] for x in held) or "neither ½ nor 1"
    assert found.reason.endswith(f"holds {said}")
    assert f"{found.exponent:.3f} ± {2.5 * error:.3f}" in found.reason


@quick
@given(st.integers(1, 4000), st.integers(2, 12))
def test_what_is_within_ten_times_the_noise_is_left_out(noise: int, spread: int) -> None:
    values = [Fraction(n) for n in MARKS]
    found = growth(MARKS, values, Fraction(noise, 7))
    above = [n for k, n in enumerate(MARKS) if k >= 7 and 7 * n > 10 * noise]
    assert (found.first, found.last) == ((above[0], above[-1]) if above else (0, 0))
    jumps = [Fraction((7 * k) % spread) ** 3 for k in range(len(MARKS))]
    scattered = growth(MARKS, [n + 3000 * x for n, x in zip(MARKS, jumps, strict=True)], Fraction(0))
    assert scattered.standard_error is not None
    assert scattered.standard_error >= 1.65 * math.log(MARKS[-1] / MARKS[7]) ** -1.5 * (1 - 1e-9)


@quick
@given(st.integers(1, 40))
def test_scatter_that_is_more_than_a_walks_is_told(size: int) -> None:
    """One leap in a straight line: the regression's own error is the greater."""
    values = [Fraction(n) * (10 ** (8 * size) if n > 1500 else 1) for n in MARKS]
    found = growth(MARKS, values, Fraction(0))
    assert found.standard_error is not None
    assert found.standard_error > 1.65 * math.log(MARKS[-1] / MARKS[7]) ** -1.5


def test_five_checkpoints_are_fitted_and_four_are_not() -> None:
    marks = [*range(1, 8), 100, 1000, 10_000, 100_000, 1_000_000]
    for count, fitted in ((11, False), (12, True)):
        found = growth(marks[:count], [Fraction(n) for n in marks[:count]], Fraction(0))
        assert found.points == count - 7
        assert (found.exponent is not None) == fitted


# -- crossovers -----------------------------------------------------------------------------------

points = st.lists(st.tuples(sizes, sizes, sizes), max_size=6, unique_by=lambda x: x[0])


@settings(deadline=None, max_examples=100)
@given(points, st.randoms(use_true_random=False))
def test_a_crossover_lies_between_the_last_small_and_the_first_large_step(
    given_: list[tuple[Fraction, Fraction, Fraction]], mixed: object
) -> None:
    found, ordered = crossover(given_), sorted(given_)
    assert crossover(given_[::-1]) == found
    rounding = [r > t for _, t, r in ordered]
    if len(ordered) < 2:
        said = "one step size"
    elif all(rounding):
        said = "rounding is larger at every"
    elif not any(rounding):
        said = "truncation is larger at every"
    elif not rounding[0]:
        said = "truncation is larger at the smallest"
    elif rounding[-1]:
        said = "rounding is larger at the largest"
    else:
        low = next(k for k, x in enumerate(rounding) if not x) - 1
        high = max(k for k, x in enumerate(rounding) if x) + 1
        (h1, t1, r1), (h2, t2, r2) = ordered[low], ordered[high]
        assert found.bracket == (h1, h2)
        assert found.step_size is not None
        assert ("neighbours" in found.reason) == (high - low == 1)
        y1, y2 = (math.log10(t / r) for t, r in ((t1, r1), (t2, r2)))
        at = math.log10(h1) + (0 - y1) / (y2 - y1) * math.log10(h2 / h1) if y2 != y1 else None
        if at is not None:
            assert math.isclose(found.step_size, 10**at, rel_tol=1e-6)
        return
    assert (found.step_size, found.bracket) == (None, None)
    assert said in found.reason


@quick
@given(sizes, sizes, sizes, st.booleans())
def test_a_part_that_is_exactly_0_gives_a_bracket_and_no_number(
    h: Fraction, t: Fraction, r: Fraction, first: bool
) -> None:
    small = (h, Fraction(0), r) if first else (h, min(t, r) / 2, max(t, r))
    large = (2 * h, max(t, r), min(t, r) / 2) if first else (2 * h, t, Fraction(0))
    found = crossover([large, small])
    assert (found.step_size, found.bracket) == (None, (h, 2 * h))
    assert "exactly 0" in found.reason


# -- chains ---------------------------------------------------------------------------------------

kinds: st.SearchStrategy[Kind] = st.sampled_from(["enclosed", "enclosed", "estimated"])


@st.composite
def chains(draw: st.DrawFn) -> Chain:
    count = draw(st.integers(1, 4))
    made = [
        Link(
            tuple(draw(st.lists(values, min_size=count, max_size=count))),
            draw(st.one_of(st.just(Fraction(0)), sizes.map(lambda x: x / 10**6))),
            draw(kinds),
            draw(st.sampled_from(["a", "b", "c"])),
        )
        for _ in range(5)
    ]
    for k in range(1, 5):
        if draw(st.integers(0, 3)) == 0:
            made[k] = made[k - 1]
    return Chain(tuple(range(1, count + 1)), (made[0], made[1], made[2], made[3], made[4]))


ENDS = {"truncation": (None, 0), "total": (0, 4), "lambda_working": (None, 4)}
ENDS |= {name: (k, k + 1) for k, name in enumerate(PARTS)}


@quick
@given(chains(), st.integers(1, 20))
def test_a_chains_quantities_are_differences_of_its_links_and_lack_digits_where_bounds_are_wide(
    chain: Chain, digits: int
) -> None:
    assert set(QUANTITIES) == set(ENDS)
    needed = [0] * 5
    for name, (before, after) in ENDS.items():
        last = chain.links[after]
        first = None if before is None else chain.links[before]
        trail, bound = chain.trail(name)
        assert len(trail) == len(chain.marks)
        if first is last:
            assert (set(trail), bound) == ({0}, 0)
        else:
            low = first.trail if first else [0] * len(trail)
            assert list(trail) == [b - a for a, b in zip(low, last.trail, strict=True)]
            assert bound == last.bound + (first.bound if first else 0)
        assert chain.final(name) == (trail[-1], bound)
        if trail[-1] and bound:
            allowed = abs(trail[-1]) / (4 * 10**digits)
            for k in (before, after):
                if k is not None and chain.links[k].bound > allowed:
                    more = magnitude(chain.links[k].bound / allowed) + 1
                    assert more >= 1
                    assert chain.links[k].bound <= allowed * 10**more
                    needed[k] = max(needed[k], more)
    assert chain.lacking(digits) == needed
    whole = sum(chain.final(n)[0] for n in ("truncation", *PARTS))
    assert whole == chain.final("lambda_working")[0]
    assert chain.kind == ("enclosed" if {x.kind for x in chain.links} == {"enclosed"} else "estimated")  # fmt: skip
    assert set(chain.methods) == {x.method for x in chain.links[:4]}
    assert len(set(chain.methods)) == len(chain.methods)


@quick
@given(st.one_of(st.integers(1, 10**5), st.integers(1, 9)))
def test_checkpoints_are_equidistant_and_end_with_the_run(steps: int) -> None:
    marks = marks_of(steps)
    assert marks[-1] == steps
    assert len(marks) <= 2048
    assert len(marks) > 1024 or len(marks) == steps
    apart = [b - a for a, b in pairwise((0, *marks))]
    assert set(apart[:-1]) <= {apart[0]}
    assert 0 < apart[-1] <= apart[0]


# -- grids ----------------------------------------------------------------------------------------

steps_of = st.fractions(min_value="1/9", max_value=1, max_denominator=9)


@quick
@given(st.lists(steps_of, min_size=1, max_size=4), st.integers(1, 20), st.booleans())
def test_a_grid_gives_each_step_size_its_number_of_steps(
    given_: list[Fraction], size: int, by_time: bool
) -> None:
    if len(set(given_)) < len(given_):
        with pytest.raises(InputError, match="twice"):
            grid(given_, size, None)
        return
    if by_time:
        assert grid(given_, None, size) == [(h, math.floor(size / h)) for h in given_]
        with pytest.raises(InputError, match="shorter"):
            grid(given_, None, max(given_) * Fraction(9, 10))
        assert grid(given_, None, max(given_))[given_.index(max(given_))][1] == 1
    else:
        assert grid(given_, size, None) == [(h, size) for h in given_]
    for steps, time in ((None, None), (size, size)):
        with pytest.raises(InputError, match="one of the two"):
            grid(given_, steps, time)
    with pytest.raises(InputError):
        grid([], size, None)


@settings(deadline=None, max_examples=6)
@given(st.lists(st.sampled_from(["1/4", "1/10", "1e-3", "1e-5", "1e-7"]), min_size=1, max_size=3, unique=True), st.sampled_from(["lie1", "lie2", "symplectic-euler"]), st.integers(1, 40))  # fmt: skip
def test_what_is_printed_of_a_separation_is_its_chain(
    given_: list[str], scheme: str, steps: int
) -> None:
    hamiltonian = Hamiltonian.parse("p**2/2 + q**2/2 + q**4/7")
    at = {"q": "6/5", "p": "1/3", "steps": steps, "digits": 12, "arithmetic": "mpfr"}
    found = as_grid(
        [separate(hamiltonian, scheme, step_size=h, **at) for h in given_]  # type: ignore[arg-type]
    )
    assert [Fraction(p.step_size) for p in found.points] == list(map(Fraction, given_))
    for point in found.points:
        assert (point.status, point.failed_step, point.reason) == ("finished", None, "")
        assert (point.digits, point.steps, point.arithmetic) == (12, steps, "mpfr")
        assert Fraction(point.q) == Fraction(6, 5)
        for one in (point.plain, point.closed_form):
            assert one is not None
            parts = {n: Fraction(getattr(one.parts, n).value) for n in QUANTITIES}
            slack = sum(Fraction(getattr(one.parts, n).bound) for n in QUANTITIES)
            whole = sum(parts[n] for n in ("truncation", *PARTS))
            assert abs(whole - parts["lambda_working"]) <= slack
            assert set(one.growth) == {"total", *PARTS}
            assert [x.steps for x in one.series][-1] == steps
            assert len(one.series) == min(32, steps) or steps > 32
            for n in ("truncation", "total"):
                tops = [abs(Fraction(getattr(x, n))) for x in one.series]
                assert Fraction(one.largest[n]) >= max(tops) * (1 - Fraction(1, 10**5))
                if steps <= 32:
                    assert Fraction(one.largest[n]) <= max(tops) * (1 + Fraction(1, 10**5))
    for name in ("plain", "closed_form"):
        at_ = getattr(found, name)
        tops_ = [
            (Fraction(p.step_size), *(Fraction(getattr(p, name).largest[n]) for n in ("truncation", "total")))
            for p in found.points
        ]  # fmt: skip
        true = crossover(tops_)  # type: ignore[arg-type]
        assert at_.reason == true.reason
        assert (at_.step_size is None) == (true.step_size is None)
        if true.step_size is not None:
            assert math.isclose(float(at_.step_size), true.step_size, rel_tol=1e-3)


@quick
@given(st.sampled_from(["float64", "float32", "auto ", ""]))
def test_what_is_examined_is_no_reference(name: str) -> None:
    with pytest.raises(InputError, match="examined" if name == "float64" else "unknown"):
        separate(Hamiltonian.parse("p**2/2"), "lie1", q=1, p=1, step_size=1, steps=1, arithmetic=name)
    assume(name)
