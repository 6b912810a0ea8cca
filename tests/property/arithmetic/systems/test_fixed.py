"""Wide fixed-point numbers against exact rationals and balls, at every width.

The checks are in fixed_checks.py; every operand is tried at all widths.
"""

from fractions import Fraction
from itertools import product

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from tests.examples import drawn
from tests.helpers import fixed_checks
from tests.helpers.fixed_checks import HARD, WIDEST, WIDTHS, Near, Shape, format_of
from verify.arithmetic.systems import fixed
from verify.arithmetic.wide import table_series

FORMATS = [format_of(width) for width in WIDTHS]
ALL_FORMATS = [*FORMATS, format_of(WIDEST)]  # whose functions take long to compile
KINDS = tuple(fixed_checks.CALLS)

limbs = st.one_of(
    st.sampled_from(fixed_checks.LIMBS),
    st.integers(0, fixed_checks.ONES),
    st.builds(lambda a, b: max(0, 2**a - 2**b), st.integers(0, 63), st.integers(0, 63)),
)
shapes = st.builds(
    Shape,
    st.lists(limbs, min_size=1, max_size=16).map(tuple),
    st.sampled_from([0, fixed_checks.ONES, 0x5555555555555555]),
    st.one_of(st.just(0), st.integers(0, 1023)),
    st.integers(-2, 2),
)
tiny = st.builds(
    lambda sign, e: sign * Fraction(1, 2**e), st.sampled_from([-1, 0, 1]), st.integers(1, 600)
)


def near(step: str, most: int) -> st.SearchStrategy[Near]:
    """Multiples of a table's step, halfway between them, and where its floor is taken."""
    between = st.sampled_from([Fraction(0), Fraction(1, 2), Fraction(1, 2**20)])
    ks = st.builds(lambda k, part: k + part, st.integers(-most, most), between)
    return st.builds(Near, st.just(step), ks, tiny, st.integers(-2, 2))


TURN, OCTAVE = table_series._STEPS_PER_TURN, table_series._STEPS_PER_OCTAVE  # table steps
BEYOND = 2**15 * TURN // 6  # the range
angles = near("angle", BEYOND) | near("angle", TURN * 5 // 4) | shapes
powers = near("octave", OCTAVE * 70) | near("octave", 3 * OCTAVE) | shapes
POINTS = {"sin": angles, "cos": angles, "exp": powers, "sinh": powers, "cosh": powers}


@pytest.mark.left_to_ci
@pytest.mark.sample(3)
@pytest.mark.parametrize("form", ALL_FORMATS, ids=lambda form: form.width)
def test_operations_are_right_where_carries_run_through_all_limbs(
    form: fixed_checks.Format,
) -> None:
    raws = sorted({shape.raw(form.width) for shape in HARD})
    for x, y in product(raws[::6], raws):
        fixed_checks.check_operations(form, x, y)


@drawn(400)
@given(x=shapes, y=shapes)
def test_operations_are_right(x: Shape, y: Shape) -> None:
    for form in ALL_FORMATS:
        fixed_checks.check_operations(form, x.raw(form.width), y.raw(form.width))


@drawn(100)
@given(x=shapes, y=shapes, more=st.integers(-(2**63), 2**63 - 1))
def test_sums_are_exact(x: Shape, y: Shape, more: int) -> None:
    for form in FORMATS:
        total = (more << form.width) + x.raw(form.width) % (1 << form.width)
        fixed_checks.check_sums(form, total, y.raw(form.width))


@drawn(200)
@given(x=st.floats() | st.floats(-(2.0**15), 2.0**15))
@example(x=-(2.0**-60) * (1 + 2.0**-52))
@example(x=-(2.0**-110))
@example(x=2.0**15)
@example(x=float("nan"))
def test_a_float64_is_taken_exactly_or_refused(x: float) -> None:
    for form in FORMATS:
        fixed_checks.check_wide(form, x)


@drawn(200)
@given(x=shapes)
def test_back_in_float64_a_number_is_as_near_as_is_promised(x: Shape) -> None:
    for form in FORMATS:
        fixed_checks.check_approx(form, x.raw(form.width))


@drawn(100)
@given(x=st.fractions(min_value=-(2**15), max_value=2**15))
def test_a_rational_is_rounded_to_the_nearest_number(x: Fraction) -> None:
    for form in ALL_FORMATS:
        assert abs(form.made.exact(form.made.number(x)) - x) <= form.value(1) / 2


def test_what_is_not_in_the_format_is_refused() -> None:
    for form in FORMATS:
        for beyond in (2**15, -(2**15) - form.value(1), 10**40):
            with pytest.raises(OverflowError):
                form.call("def f(x): return x\n", form.made.number(Fraction(beyond)))


# -- functions ------------------------------------------------------------------------------------


def test_every_function_that_is_compiled_is_checked() -> None:
    sources = " ".join(fixed_checks.CALLS.values())
    assert all(f"{name}(" in sources for name in fixed.functions() if name != "cos_sin")


@pytest.mark.left_to_ci
@pytest.mark.sample(3)
@pytest.mark.parametrize("kind", KINDS)
@drawn(150)
@given(data=st.data())
def test_functions_are_within_what_is_stated_or_refused(kind: str, data: st.DataObject) -> None:
    x = data.draw(POINTS.get(kind, shapes))
    for form in FORMATS:
        fixed_checks.check_function(form, kind, x.raw(form.width))


@pytest.mark.left_to_ci
@pytest.mark.parametrize("kind", KINDS)
def test_functions_are_right_at_the_ends_of_the_format_and_around_0(kind: str) -> None:
    """Each place at every second width."""
    for k, form in enumerate(FORMATS):
        for raw in sorted({shape.raw(form.width) for shape in HARD[k % 2 :: 2]}):
            fixed_checks.check_function(form, kind, raw)


@pytest.mark.left_to_ci
@pytest.mark.parametrize("sign", [-1, 1])
@pytest.mark.parametrize("away", [Fraction(0), *(Fraction(1, 2**e) for e in (20, 30, 60, 100))])
def test_functions_are_given_up_to_their_borders_and_refused_beyond(
    sign: int, away: Fraction
) -> None:
    octave = OCTAVE * fixed_checks.step_of("octave")
    borders = {
        "exp": [15 * octave], "sinh": [14 * octave, -14 * octave], "log": [Fraction(0)],
        "cosh": [14 * octave, -14 * octave], "root": [Fraction(1, 2**26), Fraction(0)],
        "inverse": [Fraction(1, 2**14), -Fraction(1, 2**14), Fraction(0)],
    }  # fmt: skip
    for form in FORMATS:
        for kind, places in borders.items():
            for place in places:
                for add in (-2, -1, 0, 1, 2):
                    raw = round((place + sign * away) * 2**form.bits) + add
                    fixed_checks.check_function(form, kind, raw)


@pytest.mark.left_to_ci
def test_every_entry_of_the_tables_is_right() -> None:
    """Those of sines are of a quarter of a turn, and each gives cosines too."""
    for form in FORMATS:
        for k in range(TURN // 4 + 1):
            inside = Near("angle", Fraction(k), Fraction(1, 50_000)).raw(form.width)
            fixed_checks.check_function(form, "sin", inside)
        for k in range(TURN // 4, TURN, 7):
            inside = Near("angle", Fraction(k), Fraction(1, 50_000)).raw(form.width)
            fixed_checks.check_function(form, ("sin", "cos")[k % 2], inside)
        for k in range(OCTAVE):
            inside = Near("octave", Fraction(k), Fraction(1, 10_000)).raw(form.width)
            fixed_checks.check_function(form, "exp", inside)


def test_the_logarithm_is_right_just_beside_every_power_of_two() -> None:
    for form in FORMATS:
        for j in range(-form.bits + 1, 15, 3):
            for e in (20, 28, 29, 30, 45, 53, 54, 60, 100, 300):
                for sign in (-1, 1):
                    x = Fraction(2) ** j * (1 + Fraction(sign, 2**e))
                    fixed_checks.check_function(form, "log", round(x * 2**form.bits))


@pytest.mark.left_to_ci
def test_cos_sin_is_cos_and_sin() -> None:
    for form in (FORMATS[0], FORMATS[-1]):
        for shape in HARD:
            x = form.number(shape.raw(form.width))
            both = form.call("def f(x): return cos_sin(x)\n", x)
            alone = [form.call(f"def f(x): return {name}(x)\n", x) for name in ("cos", "sin")]
            assert list(both) == alone
