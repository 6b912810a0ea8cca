"""Files of tables: every kind is read and judged, and what is none is told with its line."""

import random
import tomllib
from fractions import Fraction
from typing import Any

import pytest

from tests.helpers.tables.by_series import gap
from tests.helpers.tables.mistakes import judged, outcome, places, right_tables, with_mistake
from tests.paths import ROOT
from verify.errors import InputError
from verify.integrators.tables import kinds
from verify.integrators.tables.table_claim import TableClaim
from verify.schemes.printed.condition_set import ConditionSet
from verify.schemes.printed.judgement import Judgement, judge
from verify.schemes.printed.printed_numbers import PrintedNumbers
from verify.verdict import Verdict

RIGHT = {table["name"]: table for table in right_tables()}
ORDER_8 = tomllib.loads(
    (ROOT / "tests" / "helpers" / "tables" / "order_8.toml").read_text(encoding="utf-8")
)
OF_FILE = [name for name in RIGHT if "read" not in RIGHT[name]]  # those of right.toml


def claims(table: dict[str, Any]) -> dict[str, TableClaim]:
    return {claim.kind: claim for claim in judged(table)}


def changed(name: str, **keys: Any) -> dict[str, Any]:
    return {**RIGHT[name], **keys}


# -- right and wrong ------------------------------------------------------------------------------


@pytest.mark.parametrize("name", OF_FILE)
def test_no_claim_of_a_right_table_is_refuted(name: str) -> None:
    found = judged(RIGHT[name])
    assert found
    assert {claim.verdict for claim in found} <= {
        Verdict.PROVED, Verdict.ENCLOSED, Verdict.MEASURED,
    }  # fmt: skip
    assert all(claim.severity is claim.nearest is claim.cost is None for claim in found)


@pytest.mark.left_to_ci
@pytest.mark.sample(11)
@pytest.mark.parametrize("name", OF_FILE)
def test_an_order_that_is_one_too_high_is_refuted(name: str) -> None:
    table = RIGHT[name]
    found = claims({**table, "order": table["order"] + 1})["order"]
    assert found.verdict is Verdict.REFUTED
    assert found.cost is not None
    assert found.cost.order == table["order"]
    assert found.severity == "wrong order"
    assert gap(table, table["order"] + 1, seeds=1) > 1, "a power series of the step agrees"


def test_exact_numbers_are_shown_with_more_digits_than_the_printed_ones_have() -> None:
    """1/(2 − 2^(1/3)) = 1.35120719195965763…, of whose double half an ulp is 1.11·10⁻¹⁶."""
    w, middle = "1.3512071919596578", "-1.7024143839193153"
    yoshida = {"name": "Y", "kind": "composition", "order": 4, "sizes": [w, middle, w]}
    found = claims(yoshida)
    assert "printed to 16 decimals" in str(found["order"].evidence)
    unit = "units of the last digit (half an ulp where that is more)"
    assert f"up to 1.5 {unit} away" in str(found["digits"].evidence)
    (head, row) = found["digits"].details
    assert head[-1] == f"off, in {unit}"
    assert row == ("w1", w, "1.351207191959657634", "1.49e+00")
    shorter = claims(
        {**yoshida, "sizes": ["1.35120719195967", "-1.70241438391932", "1.35120719195967"]}
    )
    assert "up to 1.2 units of the last digit away" in str(shorter["digits"].evidence)
    assert shorter["digits"].details[1][2:] == ("1.3512071919596576", "1.24e+00")


def test_numbers_do_not_use_each_other() -> None:
    numbers = {"g": "1-1/sqrt(2)", "d": "1-1/(2*g)"}
    with pytest.raises(
        InputError, match=r"d=1-1/\(2\*g\): .*unknown name 'g'; allowed: numbers alone$"
    ):
        claims(
            {
                "name": "N",
                "kind": "composition",
                "order": 2,
                "sizes": ["g", "d"],
                "numbers": numbers,
            }
        )


def test_every_kind_has_a_right_table() -> None:
    assert {table["kind"] for table in RIGHT.values()} == set(kinds.names())


DRAW = random.Random(11)  # noqa: S311
SOME = [DRAW.choice([x for x in RIGHT.values() if places(x)]) for _ in range(40)]
MISTAKES = [(table, *with_mistake(table, DRAW)) for table in SOME]


@pytest.mark.sample(3)
@pytest.mark.parametrize(("right", "wrong", "what"), MISTAKES, ids=[m[2] for m in MISTAKES])
def test_one_mistake_is_refuted_or_below_the_digits(
    right: dict[str, Any], wrong: dict[str, Any], what: str
) -> None:
    found = outcome(right, wrong, what)
    assert not found.problem
    assert found.refuted


def test_a_mistake_that_is_not_seen_would_be_told() -> None:
    """The control of the test above: of a table that is called right and is not, it is told."""
    right = RIGHT["Bogacki–Shampine 3(2)"]
    assert not outcome(right, right, "nothing").refuted
    other = {**right, "order": 2, "embedded_order": 1}
    wrong = {**other, "embedded": ["7/24", "1/4", "1/3", "1/9"]}
    claimed_less = outcome(other, wrong, "an embedded weight")
    assert (claimed_less.refuted, claimed_less.problem) == (True, "")


# -- each kind of mistake -------------------------------------------------------------------------


def test_the_suzuki_yoshida_weights_in_several_libraries_are_refuted() -> None:
    wrong = {
        "name": "n = 3", "kind": "composition", "order": 4,
        "sizes": ["0.8289815435887510", "−0.6579630871775020", "0.8289815435887510"],
    }  # fmt: skip
    (found,) = judged(wrong)
    assert found.verdict is Verdict.REFUTED
    assert found.cost is not None
    assert (found.cost.order, found.cost.double, found.severity) == (2, True, "wrong order")
    assert found.nearest is not None
    root = 1 / (2 - 2 ** (1 / 3))
    assert abs(float(found.nearest["w1"]) - root) < 1e-15
    assert abs(float(found.nearest["w2"]) - (1 - 2 * root)) < 1e-15


def test_a_lost_sign_of_an_exact_tableau_is_named_with_what_it_would_be() -> None:
    table = {"name": "Kutta 3", "kind": "runge-kutta", "order": 3,
             "a": [[], ["1/2"], ["1", "2"]], "b": ["1/6", "2/3", "1/6"]}  # fmt: skip
    found = claims(table)["order"]
    assert (found.verdict, found.nearest) == (Verdict.REFUTED, {"a31": "-1"})
    assert "a31" in found.evidence
    assert claims({**table, "a": [[], ["1/2"], ["-1", "2"]]})["order"].verdict is Verdict.PROVED


def test_a_wrong_node_is_a_wrong_clock_and_not_a_wrong_order() -> None:
    found = claims(changed("Dormand–Prince 5(4)", c=[0, "1/5", "3/10", "4/5", "7/9", 1, 1]))
    assert found["order"].verdict is Verdict.PROVED
    assert found["order in time"].verdict is found["row sums"].verdict is Verdict.REFUTED
    assert found["row sums"].severity == found["order in time"].severity == "wrong clock"
    assert found["row sums"].nearest == {"c5": "8/9"}
    assert found["embedded order"].verdict is Verdict.PROVED


def test_times_that_are_no_row_sums_may_keep_the_order() -> None:
    """Two stages with weights 1/2 at times whose mean is 1/2 keep order 2, whatever they are."""
    own = {"name": "x", "kind": "runge-kutta", "order": 2, "a": [[], ["1"]], "b": ["1/2", "1/2"],
           "c": ["1/4", "3/4"]}  # fmt: skip
    found = claims({**own, "row_sums": False})
    assert found["order in time"].verdict is Verdict.PROVED
    assert "row sums" not in found
    assert gap(own, 2, timed=True) == 0
    assert claims(own)["row sums"].verdict is Verdict.REFUTED


def test_a_wrong_embedded_weight_is_one() -> None:
    wrong = ["7/24", "1/4", "1/3", "1/9"]
    found = claims(changed("Bogacki–Shampine 3(2)", embedded=wrong))["embedded order"]
    assert found.verdict is Verdict.REFUTED
    assert found.severity == "embedded or step weights"


def test_a_wrong_clock_of_a_kick_is_refuted_and_the_right_one_told() -> None:
    right = RIGHT["Forest–Ruth 4, with clocks"]
    times = right["times"].replace("1.3512071919596576340", "0.6756035959798288170")
    found = claims({**right, "times": times})["order in time"]
    assert (found.verdict, found.severity) == (Verdict.REFUTED, "wrong clock")
    assert "time of kick 3" in found.evidence
    assert gap({**right, "times": times}, 4, timed=True) > 1


def test_a_clock_that_is_not_the_right_one_may_keep_the_order() -> None:
    """Verlet with both kicks at the middle of the step is of order 2 all the same."""
    verlet = {"name": "x", "kind": "splitting", "order": 2, "first": "kick",
              "sizes": ["1/2", "1", "1/2"]}  # fmt: skip
    middle = {**verlet, "times": ["1/2", "-", "1/2"]}
    assert claims(middle)["order in time"].verdict is Verdict.PROVED
    assert claims({**verlet, "times": ["0", "-", "1"]})["order in time"].verdict is Verdict.PROVED
    late = claims({**verlet, "times": ["0", "-", "0"]})["order in time"]
    assert late.verdict is Verdict.REFUTED
    assert gap({**middle, "times": ["1/2", "0", "1/2"]}, 2, timed=True) == 0


def test_a_clock_of_drifts_counts_where_t_depends_on_time() -> None:
    wrong = changed("Ruth 3, with clocks", times=["0", "0", "2/3", "0", "0", "0"])
    assert claims(wrong)["order in time"].verdict is Verdict.REFUTED
    of_v = {key: x for key, x in wrong.items() if key != "time_dependent"}
    assert claims(of_v)["order in time"].verdict is Verdict.PROVED


def test_a_quadratic_t_with_a_mass_that_depends_on_time_asks_for_more() -> None:
    """Right clocks keep the order of a Nyström splitting for V(q, t), and not for p²/(2 m(t))."""
    own = dict(RIGHT["McLachlan–Atela 4, for quadratic T"])
    numbers = {name: Fraction(x) for name, x in own["numbers"].items()}
    kicks = [sum((numbers[f"a{j}"] for j in range(1, k)), Fraction(0)) for k in range(1, 5)]
    drifts = [sum((numbers[f"b{j}"] for j in range(1, k + 1)), Fraction(0)) for k in range(1, 5)]
    texts = [f"{float(x):.16f}" for pair in zip(kicks, drifts, strict=True) for x in pair]
    timed = {**own, "times": texts}
    assert claims(timed)["order in time"].verdict in (Verdict.ENCLOSED, Verdict.MEASURED)
    both = claims({**timed, "time_dependent": "T and V"})["order in time"]
    assert both.verdict is Verdict.REFUTED


def test_a_splitting_is_run_either_way() -> None:
    ruth = {key: x for key, x in RIGHT["Ruth 3, with clocks"].items()
            if key not in ("times", "time_dependent")}  # fmt: skip
    found = claims({**ruth, "first": "both"})
    assert found["order, kick first"].verdict is found["order, drift first"].verdict
    calvo = claims({**RIGHT["Calvo–Sanz-Serna 4"], "first": "both"})
    assert calvo["order, kick first"].verdict is Verdict.ENCLOSED
    assert calvo["order, drift first"].verdict is Verdict.REFUTED, "of quadratic T it is not alike"


# -- symplectic, symmetric ------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("name", "keys"),
    [
        ("Radau IIA 3", {}),
        ("Kutta 4", {}),
        ("Crouzeix SDIRK 3", {}),
        ("Nyström 4", {}),
    ],
)
def test_what_is_not_symplectic_or_symmetric_is_refuted(name: str, keys: dict[str, Any]) -> None:
    found = claims(changed(name, symplectic=True, symmetric=True, **keys))
    for kind, severity in (("symplectic", "not symplectic as claimed"),
                           ("symmetric", "documentation")):  # fmt: skip
        assert found[kind].verdict is Verdict.REFUTED, kind
        assert found[kind].severity == severity


def test_a_partitioned_method_for_separable_h_alone_is_not_symplectic_for_every_h() -> None:
    euler = {"name": "x", "kind": "partitioned", "order": 1, "symplectic": True,
             "p": {"a": [["1"]], "b": ["1"]}, "q": {"a": [["0"]], "b": ["1"]}}  # fmt: skip
    assert claims(euler)["symplectic"].verdict is Verdict.PROVED
    two = {**euler, "p": {"a": [["1/2", 0], ["1/2", "1/2"]], "b": ["1/2", "1/2"]},
           "q": {"a": [["0", 0], ["1", "0"]], "b": ["1", "0"]}}  # fmt: skip
    assert claims(two)["symplectic"].verdict is Verdict.REFUTED


def test_a_method_with_stages_twice_is_not_refuted_though_what_suffices_fails() -> None:
    """The midpoint rule with its stage written twice, and unlike weights that add up."""
    doubled = {"name": "x", "kind": "runge-kutta", "order": 2, "symplectic": True,
               "a": [["1/2", 0], ["1/2", 0]], "b": ["1/2", "1/2"]}  # fmt: skip
    assert claims(doubled)["symplectic"].verdict is Verdict.UNDECIDED


def test_a_partitioned_method_is_of_the_order_that_it_has_for_what_it_claims_to_take() -> None:
    """Ruth's third order as two tableaus: for T(p) + V(q), and of a lower one otherwise."""
    kicks, drifts = ["7/24", "3/4", "-1/24"], ["2/3", "-2/3", "1"]
    rows_p = [kicks[: k + 1] + [0] * (2 - k) for k in range(3)]
    rows_q = [drifts[:k] + [0] * (3 - k) for k in range(3)]
    table = {"name": "x", "kind": "partitioned", "order": 3, "p": {"a": rows_p, "b": kicks},
             "q": {"a": rows_q, "b": drifts}}  # fmt: skip
    assert claims({**table, "separable": True})["order"].verdict is Verdict.PROVED
    assert claims(table)["order"].verdict is Verdict.REFUTED


@pytest.mark.parametrize("kind", ["runge-kutta", "partitioned", "runge-kutta-nystrom"])
def test_a_table_that_claims_nothing_is_asked_for_its_order(kind: str) -> None:
    one = {"a": [["1/2"]], "b": ["1"]}
    tables = {"runge-kutta": one, "partitioned": {"p": one, "q": one},
              "runge-kutta-nystrom": {**one, "c": ["1/2"], "b_bar": ["1/2"]}}  # fmt: skip
    with pytest.raises(InputError, match="order"):
        claims({"name": "x", "kind": kind, **tables[kind]})


@pytest.mark.parametrize("split", [("1/4", "0"), ("3/8", "-1/8"), ("1/5", "1/20")])
def test_nor_is_a_nystrom_method_with_a_stage_twice(split: tuple[str, str]) -> None:
    """Two position-Verlet steps of h/2, the first stage twice; what it puts into p, into q and into
    the other stage is divided otherwise than Suris's conditions want."""
    first, second = split
    doubled = {
        "name": "x", "kind": "runge-kutta-nystrom", "order": 2, "symplectic": True,
        "c": ["1/4", "1/4", "3/4"], "a": [[0, 0, 0], [0, 0, 0], [first, second, 0]],
        "b": ["1/3", "1/6", "1/2"], "b_bar": ["1/2", "-1/8", "1/8"],
    }  # fmt: skip
    assert claims(doubled)["symplectic"].verdict is Verdict.UNDECIDED
    once = {**doubled, "c": ["1/4", "3/4"], "a": [[0, 0], ["1/4", 0]], "b": ["1/2", "1/2"],
            "b_bar": ["3/8", "1/8"]}  # fmt: skip
    assert claims(once)["symplectic"].verdict is Verdict.PROVED
    for wrong in ({"b_bar": ["1/2", "-1/8", "1/7"]}, {"b": ["1/3", "1/7", "1/2"]},
                  {"a": [[0, 0, 0], [0, 0, 0], ["1/5", "1/10", 0]]}):  # fmt: skip
        assert claims({**doubled, **wrong})["symplectic"].verdict is Verdict.REFUTED


# -- digits ---------------------------------------------------------------------------------------


def test_short_decimals_are_exact_and_rounded_ones_are_taken_so() -> None:
    """0.5 is 1/2; of 1/6 to five digits it is said that exact numbers lie within them."""
    rk4 = {"name": "x", "kind": "runge-kutta", "order": 4,
           "a": [["0.5"], [0, "0.5"], [0, 0, "1.0"]]}  # fmt: skip
    exact = claims({**rk4, "b": ["1/6", "1/3", "1/3", "1/6"]})["order"]
    assert exact.verdict is Verdict.PROVED
    rounded = claims({**rk4, "b": ["0.16667", "0.33333", "0.33333", "0.16667"]})["order"]
    assert rounded.verdict in (Verdict.ENCLOSED, Verdict.MEASURED)
    assert "5 decimals" in rounded.evidence
    wrong = claims({**rk4, "b": ["0.16667", "0.33333", "0.33433", "0.16667"]})
    assert Verdict.REFUTED in {claim.verdict for claim in wrong.values()}
    other = {**rk4, "a": [["0.6"], [0, "0.5"], [0, 0, "1.0"]], "b": ["1/6", "1/3", "1/3", "1/6"]}
    assert claims(other)["order"].verdict is Verdict.REFUTED


def test_decimals_that_a_program_printed_are_known_to_half_an_ulp() -> None:
    third, sixth = repr(1 / 3), repr(1 / 6)
    rows = [["0.5"], [0, "0.5"], [0, 0, "1"]]
    table = {"name": "x", "kind": "runge-kutta", "order": 4, "a": rows,
             "b": [sixth, third, third, sixth]}  # fmt: skip
    found = claims(table)
    assert found["digits"].verdict in (Verdict.ENCLOSED, Verdict.MEASURED)
    off = repr(1 / 3 + 4e-16)
    wrong = claims({**table, "b": [sixth, third, off, sixth]})["digits"]
    assert wrong.verdict is Verdict.REFUTED
    assert wrong.severity == "digits that a double notices"


def test_digits_below_a_double_are_told_apart_and_cost_nothing() -> None:
    table = RIGHT["Yoshida 6, solution A, 40 digits"]
    late = {**table["numbers"]}
    name = next(iter(late))
    late[name] = late[name][:-12] + ("1" if late[name][-12] != "1" else "2") + late[name][-11:]
    found = claims({**table, "numbers": late})["digits"]
    assert (found.verdict, found.severity) == (Verdict.REFUTED, "digits below that")
    assert found.cost is not None
    assert found.cost.double is False


def test_a_wrong_digit_of_order_2_says_how_far_off_it_is_and_below_which_h_it_is_seen() -> None:
    """a = 2/3 + 10⁻¹⁰, b = (1/4, 3/4): b·c − 1/2 is 0.75·10⁻¹⁰, which counts as h²; and of the
    trees of order 3 the tall one leaves 1/6 and the other 0."""
    found = claims(
        {"name": "Ralston", "kind": "runge-kutta", "order": 2, "a": [[], ["0.66666666676667"]],
         "b": ["1/4", "3/4"]}
    )  # fmt: skip
    assert str(found["order"].evidence) == (
        "all 2 conditions hold but for residues up to 7.50e-11, of wrong digits; "
        "the nearest exact ones are up to 1.0e-10 away"
    )
    cost = found["digits"].cost
    assert cost is not None
    assert cost.below == pytest.approx(0.75e-10 * 6, rel=1e-3, abs=0)
    assert "below h = 4.5e-10 it is wrong digits that make the error" in str(cost.sentence)


@pytest.mark.left_to_ci
def test_an_order_8_tableau_of_doubles_is_judged_and_its_wrong_digit_named() -> None:
    table = dict(ORDER_8)
    found = claims(table)
    assert found["order"].verdict is Verdict.MEASURED
    assert "200 conditions" in found["order"].evidence
    wrong = claims({**table, "b": [x.replace("5.8012039600", "5.8012039800") for x in table["b"]]})
    assert wrong["order"].verdict is Verdict.REFUTED
    assert wrong["order"].nearest is not None
    assert wrong["order"].nearest["b8"].startswith("-5.80120396001")


def test_long_quotients_may_stand_for_irrational_numbers() -> None:
    """As in tables of additive methods: taken for exact they have no order."""
    near = "2744210/9369319", "6625109/9369319"  # (2 − √2)/2 and its rest, to 14 digits
    table = {"name": "x", "kind": "runge-kutta", "order": 2, "a": [[near[0], 0], near[::-1]],
             "b": [near[1], near[0]], "c": [near[0], 1]}  # fmt: skip
    found = claims(table)
    assert found["order"].verdict in (Verdict.ENCLOSED, Verdict.MEASURED), found["order"].evidence
    wrong = {**table, "b": [near[1], "2744310/9369319"]}
    assert claims(wrong)["order"].verdict is Verdict.REFUTED


def test_wrong_digits_of_a_lower_order_are_told_beside_the_order() -> None:
    """Σ w is off by 7e-11, of 18 digits: the weights have no order at all as they stand."""
    outer = "1.351207191959657634"
    yoshida = {"name": "x", "kind": "composition", "order": 6,
               "sizes": [outer, "-1.702414383919315268", outer]}  # fmt: skip
    right = claims(yoshida)["order"].evidence
    wrong = claims({**yoshida, "sizes": [outer, "-1.702414383849315268", outer]})["order"].evidence
    assert right.startswith("its order is 4: of h^5")
    said = "its order is 4, but for wrong digits (of h^1, Σ w = 1 fails by 7.00e-11): of h^5"
    assert wrong.startswith(said)


# -- hints ----------------------------------------------------------------------------------------

FEHLBERG = {
    "name": "Fehlberg", "kind": "runge-kutta", "order": 5,
    "a": [[], ["1/4"], ["3/32", "9/32"], ["1932/2197", "-7200/2197", "7296/2197"],
          ["439/216", "-8", "3680/513", "-845/4104"],
          ["-8/27", "2", "-3544/2565", "1859/4104", "-11/40"]],
    "b": ["16/135", "0", "6656/12825", "28561/56430", "-9/50", "2/55"],
    "c": ["0", "1/4", "3/8", "12/13", "1", "1/2"],
}  # fmt: skip
KUTTA = {
    "name": "Kutta 4", "kind": "runge-kutta", "order": 4,
    "a": [["0"] * 4, ["1/2", "0", "0", "0"], ["0", "1/2", "0", "0"], ["0", "0", "1", "0"]],
    "b": ["1/6", "1/3", "1/3", "1/6"], "c": ["0", "1/2", "1/2", "1"],
}  # fmt: skip


def hints(table: dict[str, Any]) -> set[tuple[str, str]]:
    return {pair for claim in judged(table) for pair in (claim.nearest or {}).items()}


@pytest.mark.parametrize(
    ("table", "row", "column", "wrong"),
    [(FEHLBERG, 5, 2, "-3554/2565"), (FEHLBERG, 4, 1, "-7"), (KUTTA, 3, 3, "1"),
     (KUTTA, 2, 1, "1/3")],
)  # fmt: skip
def test_one_wrong_entry_is_the_one_hint_of_all_claims(
    table: dict[str, Any], row: int, column: int, wrong: str
) -> None:
    a = [list(each) for each in table["a"]]
    right, a[row][column] = a[row][column], wrong
    found = claims({**table, "a": a})
    assert found["order"].verdict is found["row sums"].verdict is Verdict.REFUTED
    assert hints({**table, "a": a}) == {(f"a{row + 1}{column + 1}", right)}
    assert found["row sums"].severity == "wrong order", "it is not the clock's mistake"


def test_a_wrong_time_is_still_the_clocks_mistake() -> None:
    wrong = {**FEHLBERG, "c": [*FEHLBERG["c"][:5], "1/3"]}
    assert hints(wrong) == {("c6", "1/2")}
    assert claims(wrong)["row sums"].severity == "wrong clock"


@pytest.mark.parametrize("order", [2, None])
def test_a_hint_that_breaks_another_claim_is_not_given(order: int | None) -> None:
    """b2 = 0 would make the explicit midpoint rule symplectic, and no method at all."""
    midpoint = {"name": "x", "kind": "runge-kutta", "symplectic": True,
                "a": [[], ["1/2"]], "b": ["0", "1"]}  # fmt: skip
    table = midpoint if order is None else {**midpoint, "order": order}
    assert claims(table)["symplectic"].verdict is Verdict.REFUTED
    assert hints(table) == set()
    assert "alone" not in claims(table)["symplectic"].evidence


MIDPOINT = {"name": "x", "kind": "runge-kutta", "order": 2,
            "a": [[], ["1/2"]], "b": ["0", "1"], "c": ["0", "1/2"]}  # fmt: skip
KUTTA_ROW = {**KUTTA, "a": [*KUTTA["a"][:3], ["0", "0", "1", "1"]]}
WITHOUT_ORDER = {"name": "x", "kind": "runge-kutta", "a": [[], ["1/3"]], "b": ["0", "1"],
                 "c": ["0", "1/2"]}  # fmt: skip
KICKS = {"name": "x", "kind": "splitting", "first": "kick", "sizes": ["1/2", "1", "1/3"]}


@pytest.mark.parametrize(
    ("table", "kind", "each"),
    [
        ({**MIDPOINT, "order": 1, "a": [[], ["1/3"]]}, "row sums", {"a21": "1/2", "c2": "1/3"}),
        (WITHOUT_ORDER, "row sums", {"a21": "1/2", "c2": "1/3"}),
        ({**MIDPOINT, "order": 1, "b": ["1/2", "1"]}, "order", {"b1": "0", "b2": "1/2"}),
        ({**KUTTA_ROW, "order": 1}, "row sums", {"a43": "0", "a44": "0", "c4": "2"}),
        ({**KUTTA_ROW, "order": 2}, "order", {"a43": "0", "a44": "0"}),
        ({**KUTTA_ROW, "order": 2}, "row sums", {"a43": "0", "a44": "0"}),
        ({**KICKS, "order": 1}, "order", {"kick 1": "2/3", "kick 3": "1/2"}),
    ],
)
def test_where_each_of_several_entries_would_do_none_is_blamed(
    table: dict[str, Any], kind: str, each: dict[str, str]
) -> None:
    claim = claims(table)[kind]
    assert claim.verdict is Verdict.REFUTED
    assert (claim.nearest, "One number alone" in claim.evidence) == (None, False)
    said = f"Each of {len(each)} numbers alone would explain it, and none is singled out: "
    listed = ", ".join(f"{name} = {text}" for name, text in each.items())
    assert str(claim.evidence).endswith(said + listed)
    for name, text in each.items():
        assert all(x.verdict.holds for x in judged(with_entry(table, name, text))), name


def with_entry(table: dict[str, Any], name: str, text: str) -> dict[str, Any]:
    """The table with that text for one entry, such as a21, c2 or kick 3."""
    key, i = name.rstrip("0123456789 "), int(name[-1]) - 1
    if key == "a":
        a, row = [list(each) for each in table["a"]], int(name[1]) - 1
        a[row][i] = text
        return {**table, "a": a}
    numbers = list(table[key if key in table else "sizes"])
    numbers[i] = text
    return {**table, (key if key in table else "sizes"): numbers}


def test_of_a_row_with_one_wrong_entry_the_time_is_not_blamed() -> None:
    """Of order 1 nothing tells which of the row is wrong, and the right one is among them."""
    a = [*FEHLBERG["a"][:5], ["-8/27", "2", "-3554/2565", "1859/4104", "-11/40"]]
    claim = claims({**FEHLBERG, "order": 1, "a": a})["row sums"]
    assert "Each of 6 numbers alone" in claim.evidence
    assert "a63 = -3544/2565" in claim.evidence
    assert "c6 = 509/1026" in claim.evidence
    assert claim.nearest is None


def test_another_claim_tells_which_of_several_entries_is_wrong() -> None:
    """Kick 1 or kick 3 for the order; for an equal first and last kick, kick 3."""
    table = {**KICKS, "order": 1, "symmetric": True}
    found = claims(table)
    for kind in ("order", "symmetric"):
        assert "One number alone explains it: kick 3, printed 1/3, would be 1/2" in (
            found[kind].evidence
        )
    assert hints(table) == {("kick 3", "1/2")}


@pytest.mark.parametrize(
    ("table", "hint"),
    [
        ({**FEHLBERG, "c": [*FEHLBERG["c"][:5], "1/3"]}, ("c6", "1/2")),
        ({**KICKS, "order": 2, "sizes": ["1/2", "1", "1/2"], "times": ["0", "-", "1/2"]},
         ("time of kick 3", "1")),
    ],
)  # fmt: skip
def test_a_wrong_time_is_the_one_hint_of_the_order_in_time(
    table: dict[str, Any], hint: tuple[str, str]
) -> None:
    found = claims(table)
    assert found["order"].verdict is Verdict.PROVED
    assert found["order in time"].nearest == dict([hint])
    assert found["order in time"].evidence.count("alone explains it") == 1
    assert hints(table) == {hint}


def test_a_time_that_is_printed_as_0_is_the_one_hint_where_the_order_holds() -> None:
    assert hints({**MIDPOINT, "c": ["0", "0"]}) == {("c2", "1/2")}


def test_no_number_is_named_of_digits_that_several_seem_to_explain() -> None:
    """Yoshida's solution B as it is copied: the digits of the others leave room for each."""
    numbers = {"w1": "-0.213228522200144E1", "w2": "0.426068187079180E-2",
               "w3": "0.143984816797678E1"}  # fmt: skip
    table = {"name": "x", "kind": "composition", "order": 6, "numbers": numbers,
             "half": ["w3", "w2", "w1", "1-2*(w1+w2+w3)"]}  # fmt: skip
    claim = claims(table)["digits"]
    assert claim.verdict is Verdict.REFUTED
    assert "up to 22 units of the last digit away" in claim.evidence
    assert "alone" not in claim.evidence


def test_a_hint_at_a_weight_of_the_embedded_method_is_called_so() -> None:
    right = RIGHT["Bogacki–Shampine 3(2)"]
    wrong = {**right, "embedded": [*right["embedded"][:3], "1/7"]}
    assert {name for name, _ in hints(wrong)} == {"embedded4"}


def test_a_splitting_that_begins_and_ends_otherwise_is_not_symmetric() -> None:
    euler = {"name": "x", "kind": "splitting", "order": 1, "symmetric": True, "first": "kick",
             "sizes": ["1", "1"]}  # fmt: skip
    found = claims(euler)["symmetric"]
    assert found.verdict is Verdict.REFUTED
    said = "not symmetric: the first part is a kick, and the last one a drift"
    assert str(found.evidence) == said


def test_digits_of_numbers_that_the_order_leaves_free_are_not_judged() -> None:
    sizes = ["0.123456789", "0.5", "0.753086422", "0.5", "0.123456789"]
    free = {"name": "x", "kind": "splitting", "order": 2, "first": "kick", "sizes": sizes}
    found = claims(free)
    assert (found["order"].verdict, found["digits"].verdict) == (
        Verdict.ENCLOSED, Verdict.UNDECIDED,
    )  # fmt: skip
    assert "free" in found["digits"].evidence
    assert all("units" not in str(claim.evidence) for claim in found.values())
    wrong = {**free, "sizes": [*sizes[:2], "0.753086522", *sizes[3:]]}
    assert claims(wrong)["order"].verdict is Verdict.REFUTED, "of these the sum is not 1"


@pytest.mark.left_to_ci
def test_a_table_of_order_8_with_a_wrong_digit_takes_seconds(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The row sums fail by 1e-9, so that 1,540 conditions with times would be looked at."""
    a = [list(row) for row in ORDER_8["a"]]
    assert a[2][1] == "0.0591751709536137"
    a[2][1] = "0.0591751719536137"
    counts: list[int] = []

    def counted(numbers: PrintedNumbers, asked: ConditionSet, order: int) -> Judgement:
        counts.append(len(asked.equations))
        return judge(numbers, asked, order)

    monkeypatch.setattr("verify.integrators.tables.tableau_orders.judge", counted)
    found = claims({**ORDER_8, "a": a})
    assert 100 < max(counts) < 300
    assert found["row sums"].verdict is Verdict.REFUTED
    assert found["order in time"].verdict is Verdict.UNDECIDED
