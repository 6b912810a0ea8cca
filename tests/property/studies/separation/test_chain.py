"""What a chain says of its parts, checkpoints and grids, on drawn values."""

import math
from fractions import Fraction
from itertools import pairwise
from typing import Any

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from tests.examples import drawn
from verify.arithmetic.exact import magnitude
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.studies.separation.chain import PARTS, QUANTITIES, Chain, Kind, Link, Trail
from verify.studies.separation.determinants import POINTS
from verify.studies.separation.growth_fits import find_crossover, select_log_spaced
from verify.studies.separation.mixed_run import marks_of
from verify.studies.separation.truncation_and_rounding import (
    as_grid,
    count_steps,
    separate,
    separate_grid,
)

quick = drawn(40)
values = st.builds(Fraction, st.integers(-50, 50), st.integers(1, 10**6))
sizes = st.builds(lambda n, k: Fraction(n) / 10**k, st.integers(1, 99), st.integers(0, 30))

# -- chains ---------------------------------------------------------------------------------------

kinds: st.SearchStrategy[Kind] = st.sampled_from(["enclosed", "enclosed", "estimated"])


@st.composite
def chains(draw: st.DrawFn) -> Chain:
    count = draw(st.integers(1, 4))
    made = [
        Link(
            Trail.from_values(draw(st.lists(values, min_size=count, max_size=count))),
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
    assert chain.kind == (
        "enclosed" if {x.kind for x in chain.links} == {"enclosed"} else "estimated"
    )
    assert set(chain.methods) == {x.method for x in chain.links[:4]}
    assert len(set(chain.methods)) == len(chain.methods)


@quick
@given(sizes, st.integers(1, 20), st.booleans())
def test_a_bound_that_just_suffices_lacks_nothing(size: Fraction, digits: int, more: bool) -> None:
    none = Link(Trail((0,), 1), Fraction(0), "enclosed", "")
    bound = size / (4 * 10**digits) * (1 + more * Fraction(1, 10**6))
    last = Link(Trail.from_values([size]), bound, "enclosed", "")
    found = Chain((1,), (none, none, none, none, last)).lacking(digits)
    assert found == [0, 0, 0, 0, 1 if more else 0] or (more and found[4] in (1, 2))
    assert found[:4] == [0] * 4


@quick
@given(st.one_of(st.integers(1, 10**5), st.integers(1, 9)))
def test_checkpoints_are_equidistant_and_end_with_the_run(steps: int) -> None:
    marks = marks_of(steps, POINTS)
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
            count_steps(given_, size, None)
        return
    if by_time:
        assert count_steps(given_, None, size) == [(h, math.floor(size / h)) for h in given_]
        with pytest.raises(InputError, match="shorter"):
            count_steps(given_, None, max(given_) * Fraction(9, 10))
        assert count_steps(given_, None, max(given_))[given_.index(max(given_))][1] == 1
    else:
        assert count_steps(given_, size, None) == [(h, size) for h in given_]
    for steps, time in ((None, None), (size, size)):
        with pytest.raises(InputError, match="one of the two"):
            count_steps(given_, steps, time)
    with pytest.raises(InputError):
        count_steps([], size, None)


@drawn(6)
@given(
    st.lists(
        st.sampled_from(["1/64", "1/100", "1e-3", "1e-5", "1e-7"]),
        min_size=1,
        max_size=3,
        unique=True,
    ),
    st.sampled_from(["lie1", "lie2", "symplectic-euler"]),
    st.integers(1, 40) | st.sampled_from([32, 33, 80]),
)
def test_what_is_printed_of_a_separation_is_its_chain(
    given_: list[str], scheme: str, steps: int
) -> None:
    hamiltonian = Hamiltonian.parse("p**2/2 + q**2/2 + q**4/7")
    at: dict[str, Any] = {"q": "6/5", "p": "1/3", "steps": steps, "arithmetic": "mpfr"}
    found = separate_grid(hamiltonian, scheme, step_sizes=given_, **at)
    alone = separate(hamiltonian, scheme, step_size=given_[0], **at)
    unlike = {"seconds"}
    assert found.points[0].model_dump(exclude=unlike) == alone.model_dump(exclude=unlike)
    assert found == as_grid(found.points)
    assert [Fraction(p.step_size) for p in found.points] == list(map(Fraction, given_))
    for point in found.points:
        assert (point.status, point.failed_step, point.reason) == ("finished", None, "")
        assert (point.digits, point.steps, point.arithmetic) == (17, steps, "mpfr")
        assert Fraction(point.q) == Fraction(6, 5)
        for one in (point.plain, point.closed_form):
            assert one is not None
            parts = {n: Fraction(getattr(one.parts, n).value) for n in QUANTITIES}
            slack = sum(Fraction(getattr(one.parts, n).bound) for n in QUANTITIES)
            whole = sum(parts[n] for n in ("truncation", *PARTS))
            assert abs(whole - parts["lambda_working"]) <= slack
            assert set(one.growth) == {"total", *PARTS}
            assert [x.steps for x in one.series][-1] == steps
            shown = select_log_spaced(range(steps), range(1, steps + 1), 32)
            assert [x.steps for x in one.series] == [k + 1 for k in shown]
            for n in ("truncation", "total"):
                tops = [abs(Fraction(getattr(x, n))) for x in one.series]
                assert Fraction(one.largest[n]) >= max(tops) * (1 - Fraction(1, 10**5))
                if steps <= 32:
                    assert Fraction(one.largest[n]) <= max(tops) * (1 + Fraction(1, 10**5))
    for name in ("plain", "closed_form"):
        at_ = getattr(found, name)
        tops_ = [
            (
                Fraction(p.step_size),
                *(Fraction(getattr(p, name).largest[n]) for n in ("truncation", "total")),
            )
            for p in found.points
        ]
        true = find_crossover(tops_)  # type: ignore[arg-type]
        assert at_.reason == true.reason
        assert (at_.step_size is None) == (true.step_size is None)
        if true.step_size is not None:
            assert math.isclose(float(at_.step_size), true.step_size, rel_tol=1e-3)


@quick
@given(st.sampled_from(["float64", "float32", "auto ", ""]))
def test_what_is_examined_is_no_reference(name: str) -> None:
    with pytest.raises(InputError, match="examined" if name == "float64" else "unknown"):
        separate(
            Hamiltonian.parse("p**2/2"), "lie1", q=1, p=1, step_size=1, steps=1, arithmetic=name
        )
    assume(name)


@quick
@given(st.integers(-3, 0), st.integers(-3, 0))
def test_no_step_and_no_digit_is_refused_before_anything_runs(steps: int, digits: int) -> None:
    hamiltonian = Hamiltonian.parse("p**2/2")
    at: dict[str, Any] = {"q": 1, "p": 1, "step_size": 1}
    for wrong in ({"steps": steps}, {"steps": 1, "digits": digits}):
        with pytest.raises(InputError):
            separate(hamiltonian, "lie1", **at | wrong)
    with pytest.raises(InputError):
        separate(Hamiltonian.parse("p**2/2 + a*q"), "lie1", steps=1, **at)
