"""Bounds of runs are what their formulas say, term by term, of drawn sizes of everything.

Where a bound is loose, a term that is missing shows in no orbit. Here each term is a part of the
bound that counts, in one of the draws at least: the formulas in `tests/helpers/run_bounds.py` are
worked out apart, and where one of what stands in them is left out, another number comes out.
"""

import random
from collections.abc import Callable, Mapping
from dataclasses import replace
from fractions import Fraction
from types import SimpleNamespace
from typing import Any

import flint
import pytest

from tests.helpers import run_bounds
from tests.helpers.run_bounds import CLOSE, Noted, Real, ball, ctx, drawn, number
from verify.arithmetic.arb import rational_ball
from verify.arithmetic.exact import of_mpf
from verify.arithmetic.flint_precision import working_precision
from verify.kernels.rounding import PRECISION_BITS, RoundedValue
from verify.observables import by_name
from verify.runs import matrix_growth
from verify.runs.a_posteriori_bound import _Certificate
from verify.runs.step_bounds import StepDerivatives, StepErrors, norm

SEEDS = range(40)
SIZES = 2, 4, 6, 8
ALL = {name: each.bound for name, each in by_name().items() if each.bound}


class Told(StepDerivatives):
    """Derivatives of a step as they were drawn; how far the box was widened stands in it."""

    def __init__(self, noted: Noted) -> None:
        object.__setattr__(self, "noted", noted)

    def _at(self, function: Callable[[Real], Any], box: Mapping[str, Any]) -> Any:
        return function(number(box["widened"]))

    def second(self, _: Any, box: Mapping[str, Any]) -> flint.arb:
        return ball(self._at(self.noted.second, box))  # type: ignore[attr-defined]

    def gradient(self, _: Any, box: Mapping[str, Any]) -> flint.arb:
        noted: Noted = self.noted  # type: ignore[attr-defined]
        return ball(self._at(noted.slope, box) * noted.scale)

    def form(self, _: Any, box: Mapping[str, Any]) -> tuple[flint.arb, flint.arb]:
        size, slope = self._at(self.noted.form, box)  # type: ignore[attr-defined]
        return ball(size), ball(slope)


class Energy:
    """H over a box: how steep it is there, and how large."""

    def __init__(self, noted: Noted) -> None:
        self.noted = noted

    def slopes(self, box: Mapping[str, Any]) -> list[flint.arb]:
        assert box["last"]
        steep = self.noted.steep(number(box["widened"]))
        return [ball(steep * 3 / 5), ball(steep * 4 / 5)]  # of two coordinates

    def enclose(self, box: Mapping[str, Any]) -> flint.arb:
        assert box["last"]
        return ball(-self.noted.energy(number(box["widened"])))


def certificate(noted: Noted) -> _Certificate:
    """A certificate of a run that noted this."""
    made = object.__new__(_Certificate)
    zero = RoundedValue(flint.arb(0), flint.arb(0))
    # The rounding of the matrix is of one entry alone, and the greatest of an entry of two.
    values = {"dm": zero, "dw_1": zero, "dw_2": zero}

    def adding(size: flint.arb, x: RoundedValue) -> flint.arb:
        if x is values["dm"]:
            assert size.overlaps(3 * motion.top)
            return ball(noted.of_matrix)
        assert size.overlaps(9 * motion.top**2 / ball(noted.scale))
        part = ball(noted.of_entry / noted.scale)
        return part if x is values["dw_2"] else part / 3

    names = tuple("pq") if noted.size == 2 else tuple(f"z{k}" for k in range(noted.size))
    for k, name in enumerate(("dm", "dw_1"), start=1):
        values[name] = RoundedValue(flint.arb(k), flint.arb(0))
    values["e0"] = RoundedValue(flint.arb(0), ball(noted.of_energy))
    # The first error, as two coordinates that are off by 3/5 and 4/5 of it.
    off = dict(zip(names, (Fraction(3, 5), Fraction(-4, 5)), strict=False))
    seen = {name: of_mpf(x) for name, x in noted.seen.items()} | {"done": Fraction(noted.steps)}
    start, first = {n: Fraction(k) for k, n in enumerate(names)}, of_mpf(noted.start)
    rounded = {Fraction(k): k + first * off.get(n, Fraction(0)) for k, n in enumerate(names)}
    vars(made).update(
        run=SimpleNamespace(
            start=start,
            observables={"energy_error_max"},
            integral=lambda _: Energy(noted),
            start_radii={},
            restarts=False,
            in_user_names=lambda box: box,
        ),
        arithmetic=SimpleNamespace(
            absolute=noted.absolute, number=rounded.__getitem__, exact=lambda x: x
        ),
        values={"mse": of_mpf(noted.squares)},
        rounding=SimpleNamespace(
            constants=dict,
            box=lambda margin, last=False: {"widened": margin, "last": last},
            error_of_addition=adding,
            kernel=SimpleNamespace(matrix=["m"]),
        ),
        steps=noted.steps,
        records={name: ball(x) for name, x in noted.seen.items()},
        notes=(seen,),
        noted=seen,
        names=names,
        unit=ball(noted.unit),
        scale=ball(noted.scale),
    )
    made.rounded = StepErrors(
        state=ball(noted.state), delta_j=ball(noted.delta_j), tangent=ball(noted.tangent),
        size=ball(noted.largest), defect=ball(noted.defect), values=values,
    )  # fmt: skip
    made.derivatives = Told(noted)
    found = made.motion
    assert found is not None
    motion = found
    return made


def bounds_of(noted: Noted) -> dict[str, Real]:
    """What the certificate says of a run that noted this."""
    with working_precision(PRECISION_BITS):
        made = certificate(noted)
        orbit = made.orbit()
        assert orbit is not None
        made.error, made.error_sum = orbit
        found = {"state": orbit[0], "path": orbit[1]}
        found |= {name: bound(made).abs_upper() for name, bound in ALL.items()}
        return {name: number(x) for name, x in found.items()}


def by_formulas(noted: Noted) -> dict[str, Real]:
    """The same by formulas that are worked out apart."""
    state, path = run_bounds.of_state(noted)
    product = run_bounds.of_lambda(noted)
    return {
        "state": state,
        "path": path,
        "delta_j_max": run_bounds.of_delta_j_max(noted),
        "mse": run_bounds.of_mse(noted),
        "lambda": product,
        "lambda_max": product,
        "symplectic_defect_max": run_bounds.of_defect_max(noted),
        "symplectic_defect": run_bounds.of_defect(noted),
        "energy_error": run_bounds.of_energy_error(noted),
        "energy_error_max": run_bounds.of_energy_error(noted) + noted.of_energy,
    }


@pytest.mark.parametrize("size", SIZES)
def test_every_bound_of_a_run_is_what_its_formula_says(size: int) -> None:
    for seed in SEEDS:
        noted = drawn(seed, size)
        found, true = bounds_of(noted), by_formulas(noted)
        assert found.keys() == true.keys()
        for name, value in true.items():
            assert abs(found[name] / value - 1) < CLOSE, (name, seed, size)


TERMS: dict[str, Callable[[Noted], Noted]] = {
    name: lambda noted, name=name: replace(noted, **{name: ctx.mpf(0)})  # type: ignore[misc]
    for name in ("start", "state", "delta_j", "tangent", "largest", "defect", "of_matrix",
                 "of_entry", "of_energy", "squares", "unit")
} | {
    "second": lambda noted: replace(noted, second=lambda _: ctx.mpf(0)),
    "steep": lambda noted: replace(noted, steep=lambda _: ctx.mpf(0)),
    "energy": lambda noted: replace(noted, energy=lambda _: ctx.mpf(0)),
    "slope": lambda noted: replace(noted, slope=lambda _: ctx.mpf(0)),
    "form's size": lambda noted: replace(noted, form=lambda x: (ctx.mpf(0), noted.form(x)[1])),
    "form's slope": lambda noted: replace(noted, form=lambda x: (noted.form(x)[0], ctx.mpf(0))),
}  # fmt: skip


@pytest.mark.parametrize("term", TERMS)
def test_a_term_that_is_left_out_of_a_formula_shows(term: str) -> None:
    """The negative control: a bound without the term is another, by a part in 10⁴ at least, in a
    third of the draws."""
    moved = []
    for seed in SEEDS:
        noted = drawn(seed, 4)
        right, lacking = by_formulas(noted), by_formulas(TERMS[term](noted))
        moved.append(max(abs(lacking[name] / right[name] - 1) for name in right))
    assert sum(x > ctx.mpf(10) ** -4 for x in moved) > len(SEEDS) // 3


def test_where_the_quadratic_term_grows_beyond_twice_the_linear_one_nothing_is_certified() -> None:
    for seed in SEEDS:
        noted = drawn(seed, 2)
        with working_precision(PRECISION_BITS):
            made = certificate(noted)
            _, reach = made.orbit() or (None, None)
            assert reach is not None
            steep = replace(noted, second=lambda _, noted=noted: 10**9 * noted.second(0))
            made.derivatives = Told(steep)
            assert made.orbit() is None


def test_a_form_that_may_be_larger_than_was_counted_has_no_bound() -> None:
    """Y > 1, E > max ‖M‖, and an error of W of more than 3 max ‖M‖², each alone."""
    zero, one = flint.arb(0), flint.arb(1)
    motion = matrix_growth.MatrixGrowth(steps=10, least=one, rate=zero, top=one, path=one, end=one)
    small = dict.fromkeys(
        ("error_sum", "second", "size", "slope", "matrix_rounding", "entry_rounding"), zero
    )

    def bound(**more: Any) -> flint.arb:
        return matrix_growth.bound_total_defect(
            motion, **small | {n: flint.arb(x) for n, x in more.items()}
        )

    assert bound() == 0
    assert bound(error_sum=0.49, second=1).is_finite()
    assert not bound(error_sum=0.51, second=1).is_finite()
    assert bound(matrix_rounding=0.99).is_finite()
    assert not bound(matrix_rounding=1.01).is_finite()
    assert bound(entry_rounding=0.29).is_finite()
    assert not bound(entry_rounding=0.31).is_finite()
    fast = replace(motion, rate=flint.arb(0.6))  # e^Q Q > 1
    assert not matrix_growth.bound_total_defect(fast, **small).is_finite()


# -- the inverse of M --------------------------------------------------------------------------


def matrix(draw: random.Random, size: int) -> list[list[Fraction]]:
    """Far from symplectic: nearly singular, or long in a direction."""
    rows = [[Fraction(draw.randint(-9, 9), 4) for _ in range(size)] for _ in range(size)]
    stretched, factor = draw.randrange(size), draw.choice([Fraction(1, 50), 1, 20])
    rows[stretched] = [x * factor for x in rows[stretched]]
    return rows


def noted_by(rows: list[list[Fraction]]) -> dict[str, flint.arb]:
    """What a run would note of one M: with the sign of its determinant left out, as the sign of
    a Pfaffian that has not passed 0."""
    size, n = len(rows), len(rows) // 2
    columns = [[row[k] for row in rows] for k in range(size)]
    form = [
        [sum(u[i] * v[n + i] - u[n + i] * v[i] for i in range(n)) for v in columns] for u in columns
    ]
    above = [form[a][b] for a in range(size) for b in range(a + 1, size)]
    entries = [flint.fmpq(x.numerator, x.denominator) for row in rows for x in row]
    det = flint.fmpq_mat(size, size, entries).det()
    return {
        "growth_top": rational_ball(sum((x * x for row in rows for x in row), Fraction(0))),
        "det_low": rational_ball(abs(Fraction(int(det.p), int(det.q)))),
        "form_top": rational_ball(sum((x * x for x in above), Fraction(0))),
    }


@pytest.mark.left_to_ci
@pytest.mark.parametrize("size", SIZES)
def test_the_inverse_is_no_larger_than_is_said(size: int) -> None:
    """‖M‖/‖M⁻¹‖ ≥ d in Frobenius' norms, up to the n that these two may differ by."""
    draw = random.Random(f"inverse {size}")  # noqa: S311 - no secret
    nearest = ctx.inf
    for _ in range(300):
        rows = matrix(draw, size)
        seen = noted_by(rows)
        if not seen["det_low"] > 0:
            continue
        with working_precision(PRECISION_BITS):
            least = matrix_growth.least_of(size, seen)
        if not least > 0:
            continue
        exact_rows = ctx.matrix([[ctx.mpf(x.numerator) / x.denominator for x in r] for r in rows])
        singular = ctx.svd_r(exact_rows, compute_uv=False)
        share = singular[0] * singular[size - 1] / number(least)
        assert share >= 1 - ctx.mpf(10) ** -12, rows
        nearest = min(nearest, share)
    assert nearest < 2 * size  # and the bound is near what it bounds, for one of them


@pytest.mark.parametrize("size", SIZES)
def test_the_inverses_bound_is_what_its_formula_says(size: int) -> None:
    for seed in SEEDS:
        seen = drawn(seed, size).seen
        with working_precision(PRECISION_BITS):
            found = matrix_growth.least_of(size, {n: ball(x) for n, x in seen.items()})
        assert abs(number(found) / run_bounds.least(size, seen) - 1) < CLOSE


def test_the_norm_is_euclids() -> None:
    with working_precision(PRECISION_BITS):
        assert norm([flint.arb(-3), flint.arb(4)]).overlaps(flint.arb(5))
