"""Printed tables: true ones hold to their digits, a flipped digit or a higher order is refuted."""

import math
from dataclasses import replace
from fractions import Fraction

import pytest

from verify.audits.libraries import literature
from verify.audits.library_claims import claims_of
from verify.errors import InputError
from verify.schemes.conditions.splitting_conditions import Splitting
from verify.schemes.conditions.words.equations import (
    LETTERS_BY_KIND,
    MOST_ORDER_BY_KIND,
    logarithm_equations,
)
from verify.schemes.conditions.words.step_words import PlainNumbers, StepWords
from verify.schemes.printed.printed_numbers import PrintedNumbers, evaluate
from verify.schemes.printed.splitting_table import PrintedTable, judge_order
from verify.verdict import Verdict

TABLES = {integrator.name: integrator for integrator in literature.integrators()}
S6, YOSHIDA = "Blanes–Moan S6", "Yoshida 6, solution A, 40 digits"

NONE = PrintedNumbers({})


EXCHANGED = ", exchanged"  # of a table whose kicks and drifts are


def table(name: str) -> PrintedTable:
    method = TABLES[name.removesuffix(EXCHANGED)].method
    assert isinstance(method, PrintedTable)
    if not name.endswith(EXCHANGED):
        return method
    other = {"kick": "drift", "drift": "kick"}
    return replace(method, parts=tuple((other[kind], size) for kind, size in method.parts))


def printed(name: str, **numbers: str) -> PrintedTable:
    own = table(name)
    assert set(numbers) <= set(own.printed.numbers)
    return own.read(PrintedNumbers({**own.printed.numbers, **numbers}))


@pytest.mark.left_to_ci
@pytest.mark.parametrize("name", sorted(TABLES))
def test_the_printed_tables_hold_but_for_those_that_are_known_to_be_wrong(name: str) -> None:
    order = TABLES[name].order
    assert order is not None
    found = judge_order(table(name), order)
    assert found.verdict is not Verdict.REFUTED, found
    assert found.verdict is not Verdict.UNDECIDED


@pytest.mark.sample(3)
@pytest.mark.parametrize("name", sorted(TABLES))
def test_an_order_that_is_one_too_high_is_refuted(name: str) -> None:
    order = TABLES[name].order
    assert order is not None
    if order < MOST_ORDER_BY_KIND[table(name).kind]:
        found = judge_order(table(name), order + 1)
        assert found.verdict is Verdict.REFUTED
        assert found.order == order


def test_a_flipped_digit_is_refuted_and_found() -> None:
    right = table(S6).printed.numbers["a2"]
    flipped = printed(S6, a2=right.replace("8517", "8577", 1))
    assert flipped.printed.numbers["a2"] != right
    found = judge_order(flipped, 4)
    assert found.verdict is Verdict.REFUTED
    assert found.order == 2
    misprinted = printed(YOSHIDA, a1="0.2355732133593581336847931829785347016865")
    found = judge_order(misprinted, 6)
    assert found.digits is False


def test_one_misprinted_number_is_named_with_what_it_would_be() -> None:
    own = table("Yoshida 6, solution A")
    found = judge_order(
        own.read(PrintedNumbers({**own.printed.numbers, "w2": "0.235578213359357E0"})), 6
    )
    assert found.verdict is Verdict.REFUTED
    assert found.misprint is not None
    assert found.misprint.name == "w2"
    assert abs(found.misprint.value - Fraction("0.235573213359357")) < Fraction(1, 10**13)


def test_one_wrong_late_digit_costs_the_digits_and_is_named() -> None:
    late = judge_order(printed(YOSHIDA, a1="0.2355732133593591336847931829785346016865"), 6)
    assert late.verdict is Verdict.ENCLOSED
    assert late.digits is False
    assert late.misprint is not None
    assert late.misprint.name == "a1"


def test_a_wrong_last_digit_costs_the_digits_and_not_the_order() -> None:
    last = printed("Kahan–Li 6, nine stages", a1="0.39216144400731413927925060")
    found = judge_order(last, 6)
    assert found.verdict is Verdict.ENCLOSED
    assert found.digits is False
    assert judge_order(table("Kahan–Li 6, nine stages"), 6).digits is True


@pytest.mark.parametrize(
    ("name", "number", "wrong"),
    [
        ("McLachlan–Atela 3, optimal", "a1", "0.9196615236173998571"),
        ("McLachlan–Atela 3, optimal", "a1", "0.9196615230173998671"),
        ("McLachlan SB3A 4", "a1", "0.18819521776883521787"),
    ],
)
def test_wrong_digits_show_where_there_are_more_conditions_than_numbers(
    name: str, number: str, wrong: str
) -> None:
    own = TABLES[name]
    found = [c.verdict for c in claims_of(own, "tables", "tables")]
    assert found == [Verdict.MEASURED, Verdict.MEASURED]
    order, digits = claims_of(replace(own, method=printed(name, **{number: wrong})), "x", "x")
    assert (order.verdict, digits.verdict) == (Verdict.MEASURED, Verdict.REFUTED)
    assert "of wrong digits" in order.evidence
    assert "nearest exact" in digits.reproduction
    compile(digits.reproduction, name, "exec")


def test_a_zero_that_a_copy_appends_is_a_wrong_digit() -> None:
    """Of Calvo and Sanz-Serna's 18 decimals some print 14 and some 15, the last of these a 0."""
    own = table("Calvo–Sanz-Serna 4")
    assert judge_order(own, 4).digits is True
    short = {name: f"{float(x):.14f}" for name, x in own.printed.values.items()}
    assert judge_order(own.read(PrintedNumbers(short)), 4).digits is True
    assert (
        judge_order(own.read(PrintedNumbers({n: f"{x}0" for n, x in short.items()})), 4).digits
        is False
    )


def test_nearest_coefficients_satisfy_the_conditions() -> None:
    found = judge_order(table("Yoshida 6, solution A"), 6)
    assert found.nearest is not None
    exact = {
        n: Fraction(table(YOSHIDA).printed.numbers[m]) for n, m in (("w1", "a2"), ("w3", "a0"))
    }
    for name, value in exact.items():
        assert abs(found.nearest[name] - value) < Fraction(1, 10**38)
    assert found.digits is False, "Yoshida's 15 digits are off by up to 2.7 units of the last"


def test_two_prints_of_one_method_lead_to_the_same_coefficients() -> None:
    """Yoshida's 15 digits of solution A are wrong from the 13th; Principia's 21 are right."""
    short, long = table("Yoshida 8, solution A"), table("Yoshida 8, solution A, as in Principia")
    found, other = judge_order(short, 8), judge_order(long, 8)
    assert found.digits is False
    assert other.digits is True
    assert found.nearest is not None
    for k in range(1, 8):  # the one numbers them from the middle, the other from the end
        assert abs(found.nearest[f"w{k}"] - long.printed.values[f"w{8 - k}"]) < Fraction(2, 10**20)
        assert abs(short.printed.values[f"w{k}"] - long.printed.values[f"w{8 - k}"]) < Fraction(
            1, 10**11
        )


def test_a_table_for_quadratic_kinetic_energy_is_refuted_for_every_other() -> None:
    for name, order in (
        ("McLachlan–Atela 4, for quadratic T", 4),
        ("McLachlan–Atela 5, for quadratic T", 5),
        ("Blanes–Moan SRKN11b", 6),
    ):
        found = judge_order(replace(table(name), kind="splitting"), order)
        assert found.verdict is Verdict.REFUTED
        assert judge_order(table(name), order).verdict is Verdict.ENCLOSED


def test_exact_tables_are_proved_or_refuted() -> None:
    verlet = PrintedTable("splitting", (("kick", "1/2"), ("drift", "1"), ("kick", "1/2")), NONE)
    assert judge_order(verlet, 2).verdict is Verdict.PROVED
    found = judge_order(verlet, 3)
    assert (found.verdict, found.order) == (Verdict.REFUTED, 2)
    assert found.failing is not None
    assert found.failing.order == 3


@pytest.mark.parametrize("parts", [(("jump", "1"),), ()])
def test_parts_that_are_none_are_bad_input(parts: tuple[tuple[str, str], ...]) -> None:
    with pytest.raises(InputError):
        PrintedTable("splitting", parts, NONE)


def test_an_order_beyond_those_looked_at_is_bad_input() -> None:
    with pytest.raises(InputError, match="order"):
        judge_order(table(S6), 9)


# -- the conditions -------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("kind", "counts"),
    [
        ("splitting", [2, 1, 2, 3, 6, 9, 18, 30]),  # Hairer, Lubich, Wanner, III.5
        ("nystrom", [2, 1, 2, 2, 4, 5, 10]),  # Blanes, Casas, Murua 2008
        ("composition", [1, 0, 1, 1, 2, 2, 4, 5]),  # the same, of symmetric steps
    ],
)
def test_there_are_as_many_conditions_as_the_lie_algebras_have_dimensions(
    kind: str, counts: list[int]
) -> None:
    assert kind in LETTERS_BY_KIND
    found = [c.order for c in logarithm_equations(kind, len(counts))]
    assert [found.count(n) for n in range(1, len(counts) + 1)] == counts


@pytest.mark.parametrize(
    "sizes",
    [
        ("1/2", "1", "1/2"),
        ("7/24", "2/3", "3/4", "-2/3", "-1/24", "1"),
        ("1/6", "1/2", "2/3", "1/2", "1/6"),
        ("1/4", "1/3", "1/2", "2/3", "1/4"),
    ],
)
def test_orders_are_those_of_the_words_of_the_step_itself(sizes: tuple[str, ...]) -> None:
    import sympy

    kinds = ["kick", "drift"] * 3
    own = PrintedTable("splitting", tuple(zip(kinds, sizes, strict=False)), NONE)
    other = Splitting(tuple(zip(kinds, map(sympy.Rational, sizes), strict=False)))
    wrong = [c.order for c in other.order_conditions(5) if not c.holds]
    assert judge_order(own, 1).order == min(min(wrong) - 1, 3)


def test_the_logarithm_of_one_exponential_is_its_exponent() -> None:
    one = StepWords(PlainNumbers(Fraction(1)), [("K", Fraction(1), Fraction(0))])
    values = {c.name: c.residual(one) for c in logarithm_equations("splitting", 4)}
    assert values.pop("Σ drifts = 1") == -1
    assert set(values.values()) == {0}


# -- what no algebra is needed for ----------------------------------------------------------------


def _slope(name: str) -> float:
    """By how much one step's error on the pendulum shrinks when h is halved, as a power of 2."""
    numbers = {n: float(x) for n, x in table(name).printed.values.items()}
    sizes = [evaluate(size, numbers, float) for size in table(name).sizes]
    parts = list(zip([kind for kind, _ in table(name).parts], sizes, strict=True))

    def one(p: float, q: float, h: float) -> tuple[float, float]:
        for kind, a in parts:
            if kind == "kick":
                p -= a * h * math.sin(q)
            else:
                q += a * h * p
        return p, q

    def error(h: float) -> float:
        coarse, fine = one(1.0, 0.5, h), (1.0, 0.5)
        for _ in range(200):
            fine = one(*fine, h / 200)
        return max(abs(x - y) for x, y in zip(coarse, fine, strict=True))

    return math.log2(error(0.1) / error(0.05))


@pytest.mark.parametrize(
    ("name", "order"),
    [
        ("McLachlan–Atela 5, for quadratic T", 5),
        ("McLachlan–Atela 5, for quadratic T, exchanged", 3),
        ("McLachlan–Atela 4, for quadratic T", 4),
        ("McLachlan–Atela 4, for quadratic T, exchanged", 3),
        ("Calvo–Sanz-Serna 4", 4),
        ("Calvo–Sanz-Serna 4, exchanged", 3),
    ],
)
def test_floats_show_the_orders_that_are_found(name: str, order: int) -> None:
    assert abs(_slope(name) - (order + 1)) < 0.45
    claimed = TABLES[name.removesuffix(EXCHANGED)].order
    assert claimed is not None
    assert min(judge_order(table(name), claimed).order, claimed) == order


def test_a_reproduction_is_code_that_prints_the_slope() -> None:
    for integrator in TABLES.values():
        compile(integrator.reproduction, integrator.name, "exec")
    ours = TABLES["McLachlan–Atela 4, for quadratic T"]
    for_any = replace(table(ours.name), kind="splitting")
    claim = next(claims_of(replace(ours, method=for_any), "tables", "tables"))
    assert claim.verdict is Verdict.REFUTED, "T is not quadratic there"
    assert claim.reproduction == ours.reproduction
