"""The second look: right methods are never shown to be wrong by it, wrong ones are."""

import math
from fractions import Fraction
from typing import Any

import pytest

from verify.audits.library_claims import claims_of, files
from verify.audits.methods.driver import (
    PROBLEMS,
    SECOND_PROBLEMS,
    Driver,
    ScriptedProblem,
    drive_problems,
)
from verify.audits.methods.integrator import FloatStep, ReleasedIntegrator, table_integrator, text
from verify.audits.second_look import look_at_step, look_at_table
from verify.integrators.tables.entry import TableEntry
from verify.integrators.tables.table_file import read_tables
from verify.verdict import Verdict

SOME = (
    40  # of the right tables of all files one in so many; all of them in tests/campaigns/audit.py
)


def right_tables() -> list[tuple[TableEntry, int]]:
    """Tables with an order of 5 at most, few stages, and nothing known against them."""
    wrong = ("RKM", "BPR3", "TableauRK42", "Lobatto", "documented", "splitting.md", "McAte",
             "Calvo", "MCLACHLAN", "weights", "Fine1987RKNG")  # fmt: skip
    found = []
    for path in files():
        for entry, _ in read_tables(path).entries:
            order = getattr(entry, "order", None)
            plain = entry.kind in ("splitting", "composition", "runge-kutta", "additive")
            if plain and order and order <= 5 and not any(x in entry.name for x in wrong):
                found.append((entry, order))
    return found


def test_a_right_table_is_not_shown_to_be_wrong() -> None:
    some = right_tables()[::SOME]
    assert some
    for entry, order in some:
        second_look = look_at_table(entry, "order", order)
        assert not second_look.confirms, (entry.name, second_look.sentence)
        assert all(x.order is None or x.order >= order for x in second_look.slopes), entry.name


# Splittings of Nielsen for nearly harmonic systems, arXiv:1501.04345: of order 6 and 7 for the
# harmonic oscillator, and of order 4 for others.
NEAR_HARMONIC = {
    6: ("0.15585935917621682 -0.6859195549562167 -0.007025499091957318 0.9966295909529364 "
        "0.351166139915740498 0.3785799280065606 0.351166139915740498 0.9966295909529364 "
        "-0.007025499091957318 -0.6859195549562167 0.15585935917621682"),
    7: ("0.04649290043965892 0.1289555065927298 0.154901012702888 0.10907642985488271 "
        "0.31970548287359174 -0.013886035680471514 -0.19292000881571322 0.18375497456418036 "
        "0.17182061279957458 0.18419824933735726 0.17182061279957458 0.18375497456418036 "
        "-0.19292000881571322 -0.013886035680471514 0.31970548287359174 0.10907642985488271 "
        "0.154901012702888 0.1289555065927298 0.04649290043965892"),
}  # fmt: skip


@pytest.mark.parametrize("order", NEAR_HARMONIC)
def test_a_method_that_is_right_on_the_harmonic_oscillator_alone_is_caught(order: int) -> None:
    sizes = NEAR_HARMONIC[order].split()
    made = table_integrator(
        "near", "splitting", "", "nowhere", order=order, first="kick", sizes=sizes
    )
    (claim,) = (c for c in claims_of(made, "mine", "mine") if c.kind == "order")
    assert claim.verdict is Verdict.REFUTED
    assert claim.severity == "wrong order"
    assert "its order is 4" in claim.evidence
    assert "a second look, by steps at 60 digits, shows order 4" in claim.evidence
    matrix = [[1.0, 0.0], [0.0, 1.0]]  # of a step of the harmonic oscillator, in p and q
    h = 0.25
    for k, size in enumerate(map(float, sizes)):
        one, other = (0, 1) if k % 2 == 0 else (1, 0)
        sign = -1 if k % 2 == 0 else 1
        matrix[one] = [
            x + sign * size * h * y for x, y in zip(matrix[one], matrix[other], strict=True)
        ]
    flow = [[math.cos(h), -math.sin(h)], [math.sin(h), math.cos(h)]]
    error = max(abs(matrix[i][j] - flow[i][j]) for i in (0, 1) for j in (0, 1))
    assert error < 30 * 0.1 ** (order - 1) * h ** (order + 1), "there it has the higher order"


def test_what_a_second_look_does_not_show_is_undecided(monkeypatch: pytest.MonkeyPatch) -> None:
    """As where our conditions were wrong: a right table, said to be of too low an order."""
    from verify.audits import second_look

    rk4: dict[str, Any] = {
        "a": [[], ["1/2"], ["0", "1/2"], ["0", "0", "1"]],
        "b": ["1/6", "1/3", "1/3", "1/6"],
    }
    right, wrong = (table_integrator("RK4", "runge-kutta", "", "", order=n, **rk4) for n in (4, 5))
    assert [c.verdict for c in claims_of(wrong, "mine", "mine")] == [Verdict.REFUTED]
    monkeypatch.setattr(second_look, "claimed_of", lambda entry, kind: 4)
    (claim,) = claims_of(wrong, "mine", "mine")
    assert claim.verdict is Verdict.UNDECIDED
    assert not claim.severity
    (claim,) = claims_of(right, "mine", "mine")
    assert claim.verdict is Verdict.PROVED


def verlet(late: float = 0.0, drop: float = 0.0) -> Driver:
    return Driver(
        "import numpy as np",
        f"""\
t = t + {late} * h
p = np.atleast_1d(p) + h / 2 * force(t, np.atleast_1d(q))
q = np.atleast_1d(q) + h * p
p = p + h / 2 * (1 - {drop}) * force(t + (1 - {late}) * h, q)
""",
        "lines of ours",
    )


def judged(driven: Driver, order: int) -> list[tuple[str, Verdict, str]]:
    made = drive_problems("mine", driven, "", "nowhere", order, None)
    return [(c.source, c.verdict, c.severity or "") for x in made for c in claims_of(x, "m", "m")]


def test_steps_of_lines_are_judged_in_the_plane_in_time_and_in_two_degrees() -> None:
    told = judged(verlet(), 2)
    assert [name for name, _, _ in told] == ["mine", "mine, driven", "mine, two degrees"]
    assert {verdict for _, verdict, _ in told} == {Verdict.MEASURED}


def test_a_late_clock_is_refuted_in_time_alone() -> None:
    told = {name: (verdict, severity) for name, verdict, severity in judged(verlet(late=0.5), 2)}
    assert told["mine, driven"] == (Verdict.REFUTED, "wrong clock")
    assert told["mine"][0] is told["mine, two degrees"][0] is Verdict.MEASURED


def test_a_small_error_in_a_weight_is_refuted_at_both_problems() -> None:
    told = judged(verlet(drop=0.01), 2)
    assert [verdict for _, verdict, _ in told[::2]] == [Verdict.UNDECIDED, Verdict.UNDECIDED], (
        "its error is of order h: no scheme, or a step that is driven in a wrong way"
    )


def test_an_order_that_is_claimed_too_high_is_refuted_of_steps() -> None:
    told = judged(verlet(), 3)
    assert {verdict for _, verdict, _ in told} == {Verdict.REFUTED}


def test_a_step_that_is_wrong_at_one_problem_alone_is_not_refuted() -> None:
    """The second problem is asked before anything is held against a library."""
    plain = next(drive_problems("mine", verlet(), "", "nowhere", 3, None, PROBLEMS[:1]))
    right = plain.method
    assert isinstance(right, FloatStep)

    def exact() -> Any:
        raise RuntimeError("no second problem can be driven")

    other = FloatStep(right.formula, exact, right.points, right.ladder)
    told = ReleasedIntegrator("mine", "", "", right, 3, None, "", other)
    assert not look_at_step(told, 3).confirms
    (claim,) = claims_of(told, "m", "m")
    assert claim.verdict is Verdict.UNDECIDED


@pytest.mark.parametrize(
    "problem", [*PROBLEMS, *SECOND_PROBLEMS.values()], ids=lambda x: x.description
)
def test_the_lines_of_a_problem_are_its_force(problem: ScriptedProblem) -> None:
    names: dict[str, Any] = {}
    exec(f"import numpy as np\n{problem.force}", names)  # noqa: S102 - our own
    import numpy as np
    import sympy

    n, t = problem.degrees, 0.7
    q = np.array([0.3, -0.45][:n])
    given = problem.hamiltonian
    symbols = {str(x): x for x in given.exact.free_symbols}
    at = {symbols[name]: value for name, value in zip(given.coordinates[n:], q, strict=True)}
    at |= {symbols["t"]: t} if "t" in symbols else {}
    found = np.atleast_1d(names["force"](t, q))
    for k, name in enumerate(given.coordinates[n:]):
        slope = -sympy.diff(given.exact, symbols[name]).subs(at)
        assert abs(float(slope) - float(found[k])) < 1e-12


@pytest.mark.parametrize(
    ("x", "told"),
    [
        (0.5, "1/2"),
        (35 / 384, "35/384"),
        (1 / 3, "1/3"),
        (math.pi, "3.141592653589793"),
        (-0.0, "0"),
    ],
)
def test_a_float_is_read_as_the_number_that_it_stands_for(x: float, told: str) -> None:
    assert text(x) == told
    assert abs(Fraction(told) - Fraction(x)) <= Fraction(1, 2**50)
