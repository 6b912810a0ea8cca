"""The checks of fixed_checks.py, held against wide numbers with a small loss planted in them.

Each loss is caught, and without it the same checks pass: a check that cannot fail shows nothing.
"""

from collections.abc import Callable
from fractions import Fraction
from itertools import product
from operator import itemgetter
from typing import Any

import flint
import pytest
from llvmlite import ir

from tests.helpers import fixed_checks
from tests.helpers.fixed_checks import FRACTION_OF, HARD, Format, Near
from verify.arithmetic.compiled import engine
from verify.arithmetic.compiled.translation import Source
from verify.arithmetic.systems import fixed
from verify.arithmetic.wide import limbs, newton, products, table_series
from verify.arithmetic.wide.limbs import constant, limb, resize, shifted_up
from verify.arithmetic.wide.size import WORD
from verify.arithmetic.wide.table_series import Functions

WIDTH = 256
# Steps of the tables: of a turn, whose table is of a quarter, and of a factor 2.
TURN, OCTAVE = table_series._STEPS_PER_TURN, table_series._STEPS_PER_OCTAVE


def fresh() -> Format:
    """A format whose functions are compiled anew, with what is planted."""

    def compiled(source: str, fraction: int, names: dict[str, Any]) -> Any:
        found = tuple(sorted(names.items(), key=itemgetter(0)))
        return engine.NativeFunction(Source(source, fraction, found), anew=True)

    return Format(WIDTH, compiled)


def operations(form: Format) -> None:
    raws = sorted({shape.raw(form.width) for shape in HARD})
    for x, y in product(raws[::3], raws):
        fixed_checks.check_operations(form, x, y)


def function(kind: str) -> Callable[[Format], None]:
    """Its check at every entry of a table, and over the sizes of the arguments."""

    def check(form: Format) -> None:
        turns = kind in ("sin", "cos")
        step, most, stride = ("angle", 2 * TURN, 7) if turns else ("octave", 2 * OCTAVE, 1)
        for j, k in enumerate(range(1, most, stride)):
            near = Near(step, k + Fraction((-1) ** j * k, 2 * most), Fraction(0))
            fixed_checks.check_function(form, kind, near.raw(form.width))
        for k in range(200):
            raw = round((1 + Fraction(k, 301)) * 2 ** (form.bits + k % 40 - 26))
            fixed_checks.check_function(form, kind, raw)

    return check


def sums(form: Format) -> None:
    for x, y in product(HARD, HARD[::4]):
        fixed_checks.check_sums(form, x.raw(form.width + 64), y.raw(form.width))


CHECKS = [operations, sums, *map(function, fixed_checks.CALLS)]


def assert_caught(check: Callable[[Format], None]) -> None:
    with pytest.raises(AssertionError):
        check(fresh())


@pytest.mark.sample(3)
@pytest.mark.parametrize("check", CHECKS)
def test_without_a_loss_every_check_passes(check: Callable[[Format], None]) -> None:
    check(fresh())


@pytest.mark.left_to_ci
def test_products_that_are_called_are_those_that_are_inline(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(products, "_MAX_KERNEL_COST", 0)
    monkeypatch.setattr(products, "_MIN_CALLED_LIMBS", 1)
    for check in CHECKS:
        check(fresh())


# -- products -------------------------------------------------------------------------------------


def columns(b: Any, x: Any, y: Any, lowest: int, below: int, ripple: int, **options: Any) -> Any:
    """`limbs._columns` the plain way: whole products added in their columns.

    With `below` 0 the column below the lowest is left out, carry and all; a carry goes over no
    more than `ripple` limbs.
    """
    count, signed = x.type.width // 64, options["signed"]
    width = 64 * (2 * count - lowest)
    total = constant(options.get("start", 0), width)
    for i, j in product(range(count), range(count)):
        if i + j < lowest - below:
            continue
        one, two = (
            resize(b, limb(b, v, k), 128, signed=signed and k == count - 1)
            for v, k in ((x, i), (y, j))
        )
        part, negative = b.mul(one, two), signed and count - 1 in (i, j)
        if i + j < lowest:
            part = (b.ashr if negative else b.lshr)(part, constant(64, 128))
        at = 64 * max(0, i + j - lowest)
        moved = shifted_up(b, resize(b, part, width, signed=negative), at)
        reached = width if negative else min(width, at + 64 * (2 + ripple))
        low = constant((1 << reached) - 1, width)
        total = b.or_(b.and_(b.add(total, moved), low), b.and_(total, b.not_(low)))
    return total


def plant_columns(monkeypatch: pytest.MonkeyPatch, below: int = 1, ripple: int = 99) -> None:
    def with_loss(b: Any, x: Any, y: Any, lowest: int, **options: Any) -> Any:
        return columns(b, x, y, lowest, below, ripple, **options)

    monkeypatch.setattr(limbs, "_columns", with_loss)


def test_the_plain_way_without_a_loss_passes(monkeypatch: pytest.MonkeyPatch) -> None:
    plant_columns(monkeypatch)
    operations(fresh())


def test_a_dropped_column_below_the_lowest_is_caught(monkeypatch: pytest.MonkeyPatch) -> None:
    plant_columns(monkeypatch, below=0)
    assert_caught(operations)
    assert_caught(function("sin"))


def test_a_carry_that_is_dropped_at_a_second_limb_is_caught(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """One in 2^64 of random operands would show it."""
    plant_columns(monkeypatch, ripple=1)
    assert_caught(operations)


@pytest.mark.parametrize("name", ["_columns", "_square_columns"])
def test_a_product_that_is_cut_and_not_rounded_is_caught(
    monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    true = getattr(limbs, name)

    def cut(*arguments: Any, **options: Any) -> Any:
        return true(*arguments, **{**options, "start": 0})

    monkeypatch.setattr(limbs, name, cut)
    assert_caught(operations)


def test_a_mixed_product_that_is_not_doubled_in_a_square_is_caught(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    true = ir.IRBuilder.add
    monkeypatch.setattr(ir.IRBuilder, "add", lambda b, x, y: x if x is y else true(b, x, y))
    assert_caught(operations)


@pytest.mark.parametrize("bits", [1, 2])
def test_numbers_with_bits_less_than_promised_are_caught(
    monkeypatch: pytest.MonkeyPatch, bits: int
) -> None:
    true = limbs.product

    def coarse(b: Any, x: Any, y: Any, fraction: int) -> Any:
        near = true(b, x, y, fraction)
        mask = constant(-(1 << bits), near.value.type.width)
        return near._replace(value=b.and_(near.value, mask))

    monkeypatch.setattr(limbs, "product", coarse)
    assert_caught(operations)


# -- functions ------------------------------------------------------------------------------------


@pytest.mark.sample(3)
@pytest.mark.parametrize(
    ("table", "entry", "kind"),
    [
        ("sines", 1, "sin"),
        ("sines", TURN // 4 - 1, "sin"),
        ("sines", TURN // 4, "cos"),
        ("powers", OCTAVE - 1, "exp"),
    ],
)
def test_a_table_with_one_entry_a_little_off_is_caught(
    monkeypatch: pytest.MonkeyPatch, table: str, entry: int, kind: str
) -> None:
    true, made = table_series._table_of, getattr(table_series, f"_{table}").__wrapped__

    def wrong(values: list[int], width: int) -> Any:
        return true([v + (k == entry) * 2**20 for k, v in enumerate(values)], width)

    monkeypatch.setattr(table_series, "_table_of", wrong)
    monkeypatch.setattr(table_series, f"_{table}", made)  # which is kept for other tests
    assert_caught(function(kind))


@pytest.mark.sample(3)
@pytest.mark.parametrize("kind", ["sin", "cos", "exp", "log"])
def test_a_series_that_ends_a_term_too_early_is_caught(
    monkeypatch: pytest.MonkeyPatch, kind: str
) -> None:
    # The series' greatest argument, and the bits by which what it gives is shifted down.
    greatest, down = {"sin": (0.61, 12), "cos": (0.61, 24)}.get(kind, (0.48, 24))
    true = Functions._series

    def ended(terms: list[Fraction], shift: int) -> list[Fraction]:
        bits = WIDTH - FRACTION_OF - down
        worth = [c * Fraction(greatest) ** (j + 2) / 2 ** (j * shift) for j, c in enumerate(terms)]
        last = max(j for j, x in enumerate(worth) if x * 2**bits > 4)  # it matters, in units
        return terms[:last]

    def short(
        self: Any, b: Any, t: Any, series: list[list[Fraction]], shift: int, sign: int
    ) -> Any:
        one = 1 if kind == "cos" else 0  # two are side by side
        series = [ended(x, shift) if i == one else x for i, x in enumerate(series)]
        return true(self, b, t, series, shift, sign)

    monkeypatch.setattr(Functions, "_series", short)
    assert_caught(function(kind))


def test_a_reduced_argument_without_its_further_bits_is_caught(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A step to the format's last place: right for small arguments, and wrong for large ones."""
    true = table_series.arb_integer

    def short(value: Any, shift: int) -> int:
        if shift == WIDTH:  # that many steps which are added
            return (
                true(value / table_series._POSITIVE_OFFSET, shift) * table_series._POSITIVE_OFFSET
            )
        lost = WORD if shift == WIDTH + WORD else 0
        return true(value, shift - lost) << lost

    monkeypatch.setattr(table_series, "arb_integer", short)
    assert_caught(function("sin"))


@pytest.mark.parametrize(("kind", "steps"), [("inverse", 1), ("root", 2)])
def test_an_iteration_that_ends_too_early_is_caught(
    monkeypatch: pytest.MonkeyPatch, kind: str, steps: int
) -> None:
    true = newton.iterations

    def fewer(width: int, *, quadratic: bool) -> int:
        return true(width, quadratic=quadratic) - steps

    monkeypatch.setattr(newton, "iterations", fewer)
    assert_caught(function(kind))


# -- bounds ---------------------------------------------------------------------------------------


@pytest.mark.left_to_ci
@pytest.mark.parametrize("kind", ["mul", *fixed_checks.CALLS])
def test_a_bound_that_is_half_of_what_it_should_be_is_caught(
    monkeypatch: pytest.MonkeyPatch, kind: str
) -> None:
    true = fixed._units()
    name = "sqrt" if kind == "root" else kind
    halved = true | {name: lambda size: true[name](size) / flint.arb(2)}
    monkeypatch.setattr(fixed, "_units", lambda: halved)
    assert_caught(operations if kind == "mul" else function(kind))
