"""asinh, which is all in its own file: values at the extremes, proofs, runs, traces, texts."""

import math
from fractions import Fraction
from typing import Any

import flint
import numpy as np
import pytest

from tests.helpers.function_values import off, true
from verify import arithmetic
from verify.algebra.embedding import embed
from verify.algebra.enclosure import BALLS
from verify.algebra.formula import parse
from verify.algebra.positivity import sign_everywhere
from verify.arithmetic.compiled import native
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.tracing.function_copy import copy_function
from verify.integrators.tracing.trace import Tape
from verify.pages.markdown.inline_text import tex
from verify.pages.markdown.markup import tree
from verify.pages.text import mathml
from verify.proof.order_for_one_h import prove
from verify.reference.check.tape import FormulaTape as CheckersTape
from verify.reference.check.taylor import TapeExpansion
from verify.runs.requested_run import run
from verify.schemes import export, get
from verify.schemes.export.program import program_of
from verify.verdict import Verdict

H = "p**2/2 + asinh(q)**2"
SIZES = [
    Fraction(1, 10**290), Fraction(1, 3 * 10**20), Fraction(1, 10**8), Fraction(1), Fraction(181),
    Fraction(10**8), Fraction(10**290),
]  # fmt: skip
EXTREMES = [sign * x for x in SIZES for sign in (1, -1)]


# -- values ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("system", ["float64", "mpmath", "mpfr", "ball"])
@pytest.mark.parametrize("x", EXTREMES)
def test_it_keeps_its_relative_precision_everywhere(system: str, x: Fraction) -> None:
    numbers = arithmetic.get(system, 50)
    assert off(numbers, "asinh", x) <= abs(true("asinh", x)) * Fraction(4, 2**numbers.bits)


@pytest.mark.parametrize("digits", [30, 40, 53, 72, 200])
def test_in_fixed_point_it_is_the_nearest_number_or_the_next(digits: int) -> None:
    """Also around 0, where a unit is as large as x, and at the ends of the range."""
    numbers = arithmetic.get("fixed", digits)
    unit, end = Fraction(1, 2**numbers.bits), Fraction(2**15) - Fraction(1, 2**numbers.bits)
    called = numbers.compile("def f(x): return asinh(x)\n", "f", numbers.functions)
    for n in (0, 1, 2, 3, 2**20, 2 ** (numbers.bits // 2)):
        assert numbers.exact(called(numbers.number(n * unit))) == n * unit, "no digit is lost"
    near_1 = [1 + k * unit for k in (-1, 0, 1)]
    for x in (*near_1, end, Fraction(181), Fraction(182), Fraction(1, 3), Fraction(1, 10**9)):
        assert off(numbers, "asinh", x) <= Fraction(501, 1000) * unit
        plus, minus = (numbers.exact(called(numbers.number(sign * x))) for sign in (1, -1))
        assert plus == -minus


@pytest.mark.parametrize(("low", "high"), [(-3, 3), (-1, 8), (1, 200), (-9, -8)])
def test_a_wide_ball_of_it_lies_between_its_ends_values(low: int, high: int) -> None:
    """Arb's own is NaN there, and a run has no bound then."""
    ball = BALLS["asinh"](flint.arb(low).union(flint.arb(high)), 1)
    ends = [flint.arb(math.asinh(end)) for end in (low, high)]
    assert all(ball.contains(end) for end in ends)
    assert ball.rad() <= (ends[1] - ends[0]) / 2 + flint.arb(2) ** -20


def test_what_is_kept_of_machine_code_depends_on_how_it_is_composed() -> None:
    assert any(path.name == "asinh.py" for path in native._COMPILER_FILES)


# -- algebra --------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("formula", "zero"),
    [
        ("asinh(q) - log(q + sqrt(q**2 + 1))", True),
        ("asinh(q) - log(q + sqrt(q**2 + 2))", False),
        ("asinh(sinh(q)) - q", True),
        ("asinh(sinh(q)) - 2*q", False),
        ("asinh(2*q*sqrt(q**2 + 1)) - 2*asinh(q)", True),
        ("asinh(3/4) - log(2)", True),
    ],
)
def test_its_identities_are_decided(formula: str, zero: bool) -> None:
    ring, (x,) = embed([parse(formula)], ["p", "q"])
    assert ring.decide(x).zero is zero


@pytest.mark.parametrize(
    ("scheme", "area_preserving", "order"), [("lie2", False, 3), ("stormer-verlet", True, None)]
)
def test_it_is_proved_with(scheme: str, area_preserving: bool, order: int | None) -> None:
    proof = prove(get(scheme).step_map(Hamiltonian.parse(H)))
    assert (proof.verdict, proof.order) == (Verdict.PROVED, order)
    assert proof.area_preserving is area_preserving
    assert not proof.domain.texts, "it is defined everywhere"


def test_it_is_positive_where_its_argument_is() -> None:
    ring, (x, y) = embed([parse("asinh(1 + q**2)"), parse("asinh(q)")], ["p", "q"])
    assert sign_everywhere(ring, x, strict=True) == 1
    assert sign_everywhere(ring, y) is None


# -- runs, traces, texts --------------------------------------------------------------------------


def test_runs_agree_in_all_number_systems() -> None:
    runs = {
        name: run(Hamiltonian.parse(H), "lie2", q="1.5", p="0", step_size="1/100", steps=100,
                  arithmetic=name, digits=25)
        for name in ("fixed", "mpfr", "mpmath", "ball")
    }  # fmt: skip
    for name, result in runs.items():
        assert result.arithmetic == name, "not what it falls back on"
        for observable in ("q", "p", "lambda"):
            value, other = result.values[observable], runs["ball"].values[observable]
            gap = abs(Fraction(value.value) - Fraction(other.value))
            assert gap <= Fraction(value.bound) + Fraction(other.bound)


def test_code_that_calls_it_is_traced_as_it() -> None:
    def step(p: Any, q: Any, h: Any) -> Any:
        return p - h * math.asinh(q), q + h * np.arcsinh(p)

    tape = Tape()
    p, q = copy_function(step, tape)(*(tape.symbol(name) for name in "pqh"))
    assert {"asinh"} == {node.operation for node in tape.nodes} - {
        "symbol", "number", "multiply", "subtract", "add",
    }  # fmt: skip
    assert p.node is not q.node


def test_pages_and_markdown_call_it_arsinh() -> None:
    markup = mathml.formula("asinh(q)**2")
    assert "arsinh" in markup
    assert tex(tree(markup)) == r"{\operatorname{arsinh} }^{2}q"


@pytest.mark.parametrize("language", ["c", "julia", "python", "latex"])
def test_it_is_exported(language: str) -> None:
    writer = export.get(language)
    program = program_of(
        get("lie2").step_map(Hamiltonian.parse(H)), "lie2", "step", writer.RESERVED
    )
    text = writer.render(program)
    assert {"python": "math.asinh(q)", "latex": r"\operatorname{asinh}"}.get(
        language, "asinh(q)"
    ) in text


def test_the_checker_of_reference_data_has_it_by_its_own_rule() -> None:
    checker = CheckersTape({})
    node = checker.diff(checker.read("asinh(q)**2"), "q")
    expansion = TapeExpansion(checker, [node])
    expansion.begin(_balls("0", "-7/3", "0"))
    expected = 2 * math.asinh(-7 / 3) / math.hypot(1, 7 / 3)
    assert abs(float(expansion.value(node)) - expected) < 1e-14


def _balls(*numbers: str) -> list[Any]:
    return [flint.arb(flint.fmpq(*Fraction(x).as_integer_ratio())) for x in numbers]
