"""Formula text → MathML: exact snapshots, and the value of the markup against the formula's."""

import math
import re
from collections.abc import Callable, Iterator
from unicodedata import numeric
from xml.etree import ElementTree

import pytest
import sympy

from verify.algebra.formula import parse
from verify.pages.text import mathml

TIMES = "<mo>\u2062</mo>"
BEFORE_NAME = '<mo lspace="0.17em" rspace="0">\u2062</mo>'
APPLY = '<mo lspace="0" rspace="0">\u2061</mo>'
APPLY_THIN = '<mo lspace="0" rspace="0.17em">\u2061</mo>'
OPEN, CLOSE = '<mo stretchy="false">(</mo>', '<mo stretchy="false">)</mo>'
H2 = "<msup><mi>h</mi><mn>2</mn></msup>"
Q2 = "<msup><mi>q</mi><mn>2</mn></msup>"
WORD = '<mi mathvariant="normal">{}</mi>'  # a letter alone slants
SIN, COS, LN, ARCTAN, MAX, MASS = (
    WORD.format(word) for word in ("sin", "cos", "ln", "arctan", "max", "mass")
)
SIN_Q = f"<mrow>{SIN}{APPLY_THIN}<mi>q</mi></mrow>"

SNAPSHOTS = {
    "0": "<mn>0</mn>",
    "-3/7": "<mrow><mo>−</mo><mfrac><mn>3</mn><mn>7</mn></mfrac></mrow>",
    "q**2 - 1": f"<mrow>{Q2}<mo>−</mo><mn>1</mn></mrow>",
    "3*q**2 + 1": f"<mrow><mn>1</mn><mo>+</mo><mrow><mn>3</mn>{TIMES}{Q2}</mrow></mrow>",
    "-p*sin(q)/2": (
        f"<mrow><mo>−</mo><mrow><mfrac><mi>p</mi><mn>2</mn></mfrac>{BEFORE_NAME}{SIN_Q}</mrow></mrow>"
    ),
    "h**2*(-3*q**2/2 - 1/2) + 1": (
        f"<mrow><mn>1</mn><mo>−</mo><mrow><mfrac>{H2}<mn>2</mn></mfrac>{TIMES}<mrow>{OPEN}<mrow>"
        f"<mn>1</mn><mo>+</mo><mrow><mn>3</mn>{TIMES}{Q2}</mrow></mrow>{CLOSE}</mrow></mrow></mrow>"
    ),
    "cos(q)**2": f"<mrow><msup>{COS}<mn>2</mn></msup>{APPLY_THIN}<mi>q</mi></mrow>",
    "(q - 1)**2": (
        f"<msup><mrow>{OPEN}<mrow><mi>q</mi><mo>−</mo><mn>1</mn></mrow>{CLOSE}</mrow><mn>2</mn></msup>"
    ),
    "sin(2*q)": (
        f"<mrow>{SIN}{APPLY}"
        f"<mrow>{OPEN}<mrow><mn>2</mn>{TIMES}<mi>q</mi></mrow>{CLOSE}</mrow></mrow>"
    ),
    "exp(-q)": "<msup><mi>e</mi><mrow><mo>−</mo><mi>q</mi></mrow></msup>",
    "sqrt(q**2 + 1)": f"<msqrt><mrow><mn>1</mn><mo>+</mo>{Q2}</mrow></msqrt>",
    "1/(q + 1)": "<mfrac><mn>1</mn><mrow><mn>1</mn><mo>+</mo><mi>q</mi></mrow></mfrac>",
    "1/(2*q + 2)": (
        f"<mfrac><mn>1</mn><mrow><mn>2</mn>{TIMES}<mrow>{OPEN}<mrow><mn>1</mn><mo>+</mo><mi>q</mi>"
        f"</mrow>{CLOSE}</mrow></mrow></mfrac>"
    ),
    "omega0**2*q": (
        f"<mrow><msubsup><mi>ω</mi><mn>0</mn><mn>2</mn></msubsup>{TIMES}<mi>q</mi></mrow>"
    ),
    "k_max*mass": f"<mrow><msub><mi>k</mi>{MAX}</msub>{TIMES}{MASS}</mrow>",
    "log(q) + atan(p)": (
        f"<mrow><mrow>{ARCTAN}{APPLY_THIN}<mi>p</mi></mrow><mo>+</mo>"
        f"<mrow>{LN}{APPLY_THIN}<mi>q</mi></mrow></mrow>"
    ),
}  # fmt: skip


def tree(markup: str) -> ElementTree.Element:
    return ElementTree.fromstring(markup)  # noqa: S314 - our own markup


@pytest.mark.parametrize("text", SNAPSHOTS)
def test_a_formula_has_this_markup(text: str) -> None:
    assert inside(stacked(text)) == SNAPSHOTS[text]


def stacked(text: str) -> str:
    """As it stands in a display."""
    markup = mathml.matrix("", [[text]])
    assert markup is not None
    return re.search("<mtd>(.*)</mtd>", markup)[1]  # type: ignore[index]


def inside(markup: str) -> str:
    return markup.removeprefix("<math><mrow>").removesuffix("</mrow></math>")


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("-h**3*p*q/2", "−½\u2062h3\u2062p\u2062q"),
        ("3*q**2/2", "3\u2062q2/2"),
        ("2*q/3 - 5/6", "⅔\u2062q−⅚"),
        ("p*(1 + q)*h/24", "(h/24)\u2062p\u2062(1+q)"),
        ("(1 + q)/(2*p)", "(1+q)/(2\u2062p)"),
        ("p*sin(q/2)", "p\u2062sin\u2061(½\u2062q)"),
    ],
)
def test_within_a_line_no_fraction_is_stacked(text: str, expected: str) -> None:
    assert "".join(tree(mathml.formula(text)).itertext()) == expected


# -- the markup means what the formula means ------------------------------------------------------

FORMULAS = [
    *SNAPSHOTS,
    "h**4*(3*q**2 + 1)**2/4 + 3*h**3*p*q",
    "-h**2*p*(3*q**2 + 1)/2 - h*q*(q**2 + 1) + p",
    "h**4*cos(q)**2/4 - h**3*p*sin(q)/2",
    "-3*h**2*p*q + h*(-3*q**2 - 1)",
    "(p - q)*(p + q)/(1 + q**2)",
    "-(p - q)/(1 + q)**2",
    "p/(q*(2 - 4*q))",
    "(-p - q)**3",
    "q**(3/2)/(1 + p**2)**(1/2)",
    "(1 + q)**(1/3)*sqrt(2)/3",
    "exp(p*q)**2*sin(p + q)*tan(q)**2/7",
    "asinh(q)**2*asinh(p + 1)",
    "-(-(p - 1))*(1 - q)",
    "1/q**2 - 1/(1 + exp(q))",
    "pi*q/2 + exp(1)",
    "sinh(p)*cosh(-q)/tanh(p*q)",
    "-h*(-p - 2*q)",
    "2*p - 3*(q - 4*(p - 5))",
]
AT = {"p": 0.7, "q": 0.3, "h": 0.11, "omega0": 1.3, "k_max": 2.1, "mass": 0.4}


def value(element: ElementTree.Element) -> float:
    """The number that a presentation stands for, read as a person reads it."""
    children = list(element)
    match element.tag:
        case "math" | "mrow":
            return row(children)
        case "msqrt":
            return row(children) ** 0.5
        case "mroot":
            return value(children[0]) ** (1 / value(children[1]))
        case "mfrac":
            return value(children[0]) / value(children[1])
        case "msup":
            return value(children[0]) ** value(children[1])
        case "msub":
            return indexed(children)
        case "msubsup":
            return indexed(children[:2]) ** value(children[2])
        case "mn":
            digits = element.text or ""
            return numeric(digits) if len(digits) == 1 else float(digits)
    constants = {"e": math.e, "π": math.pi}
    return (constants | AT)[element.text or ""]


def indexed(children: list[ElementTree.Element]) -> float:
    return AT[{"ω0": "omega0", "kmax": "k_max"}["".join(x.text or "" for x in children)]]


def row(children: list[ElementTree.Element]) -> float:
    """A row of signed products; a bracket is a row of three, a function stands before ⁡."""
    if children[0].text == "(":
        assert children[-1].text == ")"
        return row(children[1:-1])
    if len(children) > 1 and children[1].text == "/":
        return value(children[0]) / value(children[2])
    total, sign, product = 0.0, 1.0, None
    rest = iter(children)
    for child in rest:
        if child.tag == "mo" and child.text in "+−":
            total += sign * (product or 0.0)
            sign, product = (1.0 if child.text == "+" else -1.0), None
        elif child.tag == "mo" and child.text == "\u2061":
            raise AssertionError("a function without a name")
        elif child.tag != "mo":
            factor = called(child, rest) if is_name(child) else value(child)
            product = factor if product is None else product * factor
    assert product is not None
    return total + sign * product


def is_name(element: ElementTree.Element) -> bool:
    letters = element[0] if element.tag == "msup" else element
    return letters.tag == "mi" and (letters.text or "") in NAMES


NAMES = {"sin", "cos", "tan", "sinh", "cosh", "tanh", "ln", "arctan", "arsinh"}
OURS = {"ln": "log", "arctan": "atan", "arsinh": "asinh"}


def called(head: ElementTree.Element, rest: Iterator[ElementTree.Element]) -> float:
    apply, argument = next(rest), next(rest)
    assert apply.text == "\u2061"
    name = (head[0] if head.tag == "msup" else head).text or ""
    power = value(head[1]) if head.tag == "msup" else 1.0
    function = getattr(sympy, OURS.get(name, name))
    return float(function(value(argument))) ** power


@pytest.mark.parametrize("set_as", [mathml.formula, lambda text: stacked(text)])
@pytest.mark.parametrize("text", FORMULAS)
def test_the_markup_has_the_value_of_the_formula(text: str, set_as: Callable[[str], str]) -> None:
    names = set(AT) | {"p", "q", "h"}
    expected = float(
        parse(text, names).subs({sympy.Symbol(n, real=True): x for n, x in AT.items()})
    )
    assert math.isclose(value(tree(set_as(text))), expected, rel_tol=1e-12)


@pytest.mark.parametrize("text", FORMULAS)
def test_fractions_powers_and_indices_have_two_parts(text: str) -> None:
    for element in tree(stacked(text)).iter():
        if element.tag in ("mfrac", "msup", "msub", "mroot"):
            assert len(element) == 2, element.tag
        if element.tag == "msubsup":
            assert len(element) == 3


# -- displays, long formulas, and text that is no formula -----------------------------------------


def test_a_long_sum_is_stacked_one_term_a_line() -> None:
    terms = [f"h**{k}*p*(1 + {k}*q**2)" for k in range(1, 6)]
    markup = mathml.equation(mathml.NAMED["p′"], " + ".join(terms))
    assert str(markup).count("<mtr>") == 5
    assert "display" in markup


def test_what_fits_a_line_is_one_however_many_its_terms() -> None:
    henon_heiles = "p1**2/2 + p2**2/2 + q1**2/2 + q1**2*q2 + q2**2/2 - q2**3/3"
    markup = mathml.equation(mathml.NAMED["H"], henon_heiles)
    assert "<mtr>" not in markup
    assert "display" in markup


def test_a_matrix_has_its_entries_by_rows() -> None:
    markup = mathml.matrix(mathml.NAMED["J"], [["1", "-h*q"], ["h", "1 - h**2"]])
    assert markup is not None
    root = tree(markup)
    assert [len(r) for r in root.iter("mtr")] == [2, 2]
    assert mathml.matrix(mathml.NAMED["J"], [["1", "no formula!"]]) is None


def test_the_leading_term_comes_with_its_order() -> None:
    markup = mathml.order_equation("3*p*q", 3)
    assert markup is not None
    assert "".join(tree(markup).itertext()) == "ΔJ=3\u2062h3\u2062p\u2062q+O(h4)"


@pytest.mark.parametrize("text", ["<script>alert(1)</script>", "p & q", '"p" + <b>q</b>', "__a(1)"])
def test_what_is_no_formula_stays_text(text: str) -> None:
    markup = mathml.formula(text)
    assert tree(markup).tag == "code"
    assert "".join(tree(markup).itertext()) == text


def test_a_formula_too_long_to_read_is_cut_and_says_so() -> None:
    text = " + ".join(f"x{n}*q**2" for n in range(2000))
    markup = mathml.formula(text)
    assert len(markup) < 2 * mathml.LONGEST_SHOWN
    assert f"{len(text):,} characters" in markup


def test_parameters_are_the_names_that_are_not_coordinates_or_functions() -> None:
    assert mathml.free_names("delta*q**4/4 + sin(omega0*p) + pi*h") == ("delta", "omega0")
