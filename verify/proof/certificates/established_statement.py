"""The statement that a checked certificate establishes, in self-contained formulas.

Everything here is derived from the entries that the checker has examined. Formulas are written as
`verify` reads them, with each function in place of its name.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from verify.proof.certificates.checker import check
from verify.proof.certificates.coefficients import ONE, ButcherTableau, Stages
from verify.proof.certificates.entries import Expansion, Form, NamedFunction
from verify.proof.certificates.named_numbers import AlgebraicNumber
from verify.proof.certificates.readers import PLANE, Monomial, Poly, need

_LONGEST_FORMULA = 1_000_000  # characters, with functions written out
_ALMOST_EVERYWHERE = "L does not vanish identically in p and q"
_SOLVABLE = "the stages have a solution that depends smoothly on (p, q)"
_QUANTIFIERS = {  # the class of H, by (separable, timed)
    (False, False): "every smooth H",
    (True, False): "every smooth H = T(p) + V(q)",
    (False, True): "every smooth H(p, q, t)",
    (True, True): "every smooth H = T(p, t) + V(q, t)",
}
_DEFECT = "S = JᵀΩJ − Ω"
_DEFECT_TEXTS = {  # the defect is 0, the defect; by `CoordinateLayout.single`
    True: ("det J = 1", "det J − 1"),
    False: (f"{_DEFECT} = 0", _DEFECT),
}
_TELESCOPING_TEXTS = {  # by `CoordinateLayout.single` and whether H depends on t
    (True, False): ", and L = X·G",
    (True, True): ", and L = D·G, D = ∂/∂t + X",
    (False, False): ", and L is the Lie derivative of G",
    (False, True): ", and L is the Lie derivative of G by D = ∂/∂t + X",
}


@dataclass(frozen=True)
class EstablishedStatement:
    """A statement that holds: for which H, about which map, and where.

    - `hamiltonian`: the one H, or the class of H.
    - `order`, `leading`: the order and the leading coefficient of ΔJ = det J − 1, in n `degrees` of
      freedom those of S; None if the defect is 0.
    - `area_preserving`: True if det J = 1; `symplectic`: True if S = 0.
    - `convergence_order`: the map agrees with the flow up to this power of h; None if the statement
      is not about that.
    - `scheme`: a description of the map, if it is that of a scheme.
    - `p_next`, `q_next`: a formula, in n degrees of freedom one for each coordinate.
    - `numbers`: the definition of each named number.
    """

    statement: str
    scheme: str | None
    hamiltonian: str
    p_next: str | tuple[str, ...]
    q_next: str | tuple[str, ...]
    area_preserving: bool | None
    order: int | None
    leading: str | None
    potential: str | None
    convergence_order: int | None
    domain: tuple[str, ...]
    degrees: int = 1
    symplectic: bool | None = None
    numbers: tuple[str, ...] = ()


def check_certificate(data: object) -> EstablishedStatement | str:
    """Check a certificate: return the statement it establishes, or why it is refused."""
    try:
        return state_theorem(check(data))
    except ValueError as reason:
        return str(reason)
    except RecursionError:
        return "its functions are nested too deeply"


def state_theorem(
    entries: Stages | ButcherTableau | Expansion, *, nonzero: bool = True
) -> EstablishedStatement:
    """State the theorem of `verify.proof.certificates.checker` for these entries.

    `nonzero`: True if the statement includes that L is not 0.

    Raises ValueError if a formula is too long to be written out.
    """
    if isinstance(entries, Stages):
        return _of_stages(entries)
    if isinstance(entries, ButcherTableau):
        return _of_tableau(entries)
    return _of_expansion(entries, nonzero)


def _of_stages(entries: Stages) -> EstablishedStatement:
    p, q, p_next, q_next, implicit = "p", "q", [], [], False
    for n, (kick, drift, at_p, at_q) in enumerate(entries.rows, 1):
        p_new, q_new = f"p{n}", f"q{n}"
        time = _time(entries, n - 1)
        point = f"({_between(p, p_new, at_p)}, {_between(q, q_new, at_q)}{time})"
        p_next.append(f"{p_new} = {p}" + (f" - h*({_poly(kick)})*H_q{point}" if kick else ""))
        q_next.append(f"{q_new} = {q}" + (f" + h*({_poly(drift)})*H_p{point}" if drift else ""))
        # A stage is implicit if H_q depends on p', or H_p on q', as for a general H; for H = T + V
        # only if both p and q move and both shares are not 0.
        mixed = not entries.separable and ((kick and at_p) or (drift and at_q))
        implicit |= bool(mixed or (kick and drift and at_p and at_q))  # otherwise det A is 1
        p, q = p_new, q_new
    end = f"(p, q) ↦ ({p}, {q})"
    return _symplectic(entries, "the scheme of these stages", (p_next, q_next), end, implicit)


def _of_tableau(entries: ButcherTableau) -> EstablishedStatement:
    places = [f"(P{j}, Q{j}{_time(entries, j - 1)})" for j in range(1, len(entries.weights) + 1)]
    points = [(f"P{i}", f"Q{i}") for i in range(1, len(entries.weights) + 1)]
    p_next, q_next = [], []
    for (p, q), row in zip([*points, ("p1", "q1")], [*entries.rows, entries.weights], strict=True):
        terms = [(_poly(a), point) for a, point in zip(row, places, strict=True) if a]
        p_next.append(f"{p} = p" + "".join(f" - h*({a})*H_q{point}" for a, point in terms))
        q_next.append(f"{q} = q" + "".join(f" + h*({a})*H_p{point}" for a, point in terms))
    scheme = "the Runge–Kutta scheme of these stages"
    return _symplectic(entries, scheme, (p_next, q_next), "(p, q) ↦ (p1, q1)", True)


def _symplectic(
    entries: Stages | ButcherTableau,
    scheme: str,
    formulas: tuple[Sequence[str], Sequence[str]],
    end: str,
    implicit: bool,
) -> EstablishedStatement:
    hamiltonians = _quantify(entries, entries.times is not None)
    p_next, q_next = map("; ".join, formulas)
    return EstablishedStatement(
        statement=f"{_DEFECT_TEXTS[entries.layout.single][0]} for {hamiltonians} and {scheme}",
        scheme=end,
        hamiltonian=hamiltonians,
        p_next=p_next,
        q_next=q_next,
        area_preserving=True,
        order=None,
        leading=None,
        potential=None,
        convergence_order=None,
        domain=(_SOLVABLE,) * implicit,
        degrees=entries.layout.degrees,
        symplectic=True,
        numbers=tuple(map(_number, entries.numbers)),
    )


def _quantify(entries: Stages | ButcherTableau | Expansion, timed: bool) -> str:
    layout = entries.layout
    degrees = "" if layout.single else f" in {layout.degrees} degrees of freedom"
    return f"{_QUANTIFIERS[entries.separable, timed]}{degrees}"


def _number(number: AlgebraicNumber) -> str:
    powers = enumerate(number.polynomial)
    polynomial = _poly({(number.name,) * k: Fraction(c) for k, c in powers if c})
    return f"{number.name} = the root of {polynomial} in {number.ends}"


def _time(entries: Stages | ButcherTableau, k: int) -> str:
    """Format the time of a stage, the third argument of H; empty if H has none."""
    if entries.times is None:
        return ""
    time = entries.times[k]
    return f", t + ({_poly(time)})*h" if time else ", t"


def _poly(x: Poly) -> str:
    return _FormulaWriter().poly(x)


def _between(start: str, end: str, share: Poly) -> str:
    if share in ({}, ONE):
        return end if share else start
    return f"{start} + ({_poly(share)})*({end} - {start})"


def _of_expansion(entries: Expansion, nonzero: bool) -> EstablishedStatement:
    writer, single = _FormulaWriter(entries.functions), entries.layout.single
    hamiltonians, order, degrees = (
        _quantify(entries, entries.timed),
        entries.order,
        entries.layout.degrees,
    )
    of_one, agreed = entries.hamiltonian is not None, entries.convergence_order
    # The statement is built from the checked entries alone, and claims no more than was checked.
    area, defect = _DEFECT_TEXTS[single]
    if order is not None:
        area = f"{defect} = L h^{order} + O(h^{order + 1})"
        if nonzero:
            area += f", L not zero{'' if of_one else ' for some H'}"
    telescoping = "" if entries.potential is None else _TELESCOPING_TEXTS[single, entries.timed]
    flow = f"which agrees with the flow up to h^{agreed}{telescoping}"
    formulas = tuple(writer.series(x, entries.last) for x in entries.after)

    def form(x: Form) -> str:
        return writer.poly(x.get(PLANE, {})) if single else writer.form(x)

    return EstablishedStatement(
        statement=f"{area}, for {'this H' if of_one else hamiltonians} and this map, {flow}",
        scheme=_taylor_series(entries),
        hamiltonian=hamiltonians
        if entries.hamiltonian is None
        else writer.poly(entries.hamiltonian),
        p_next=formulas[0] if single else formulas[:degrees],
        q_next=formulas[1] if single else formulas[degrees:],
        area_preserving=order is None if single or order is None else None,
        order=order,
        leading=None if order is None else form(entries.leading),
        potential=None if entries.potential is None else form(entries.potential),
        convergence_order=agreed,
        domain=(
            *(f"{writer.poly(f.argument)} != 0" for f in entries.functions if f.kind == "inverse"),
            # L is not 0 as a function of p, q and the parameters; for some parameters it may be 0.
            *([_ALMOST_EVERYWHERE] if order is not None and entries.parameters else []),
        ),
        degrees=degrees,
        symplectic=order is None,
    )


def _taylor_series(entries: Expansion) -> str | None:
    """Name the flow's Taylor series, if the map is just that; else None."""
    agreed = entries.convergence_order
    # Up to h^c the coefficients are those of the flow. The map is its truncated series if there are
    # no others, and a remainder begins later than with h^(c+1).
    later_coefficients = [c for series in entries.after for c in series[agreed + 1 :] if c]
    if later_coefficients or (entries.last is not None and entries.last <= agreed):
        return None
    up_to = "" if entries.last is None else f", up to O(h^{entries.last + 1})"
    return f"the Taylor series of the flow, cut off after h^{agreed}{up_to}"


class _FormulaWriter:
    """A writer of polynomials as formulas, with each function in the place of its name."""

    def __init__(self, functions: Sequence[NamedFunction] = ()) -> None:
        self.functions: dict[str, str] = {}
        self.below: dict[str, str] = {}  # the divisor of each inverse, by its name
        for function in functions:
            inner = self.poly(function.argument)
            self.functions[function.name] = f"{function.kind}({inner})"
            if function.kind == "inverse":
                self.below[function.name] = f"({inner})"

    def poly(self, x: Poly) -> str:
        """Format the polynomial as a formula."""
        terms, length = [], 0
        for names, c in sorted(x.items(), key=lambda term: (-len(term[0]), term[0])):
            terms.append(f"{'-' if c < 0 else '+'} {self._term(names, abs(c))}")
            length += len(terms[-1])
            # Nested functions that are written out may make a short certificate enormous.
            need(length <= _LONGEST_FORMULA, "a formula is too long to be written out")
        text = " ".join(terms) or "0"
        return text.removeprefix("+ ") if text[0] != "-" else f"-{text[2:]}"

    def form(self, x: Form) -> str:
        """Format a 2-form, entry by entry."""
        return " + ".join(f"({self.poly(c)})*d{a}∧d{b}" for (a, b), c in x.items()) or "0"

    def _term(self, names: Monomial, c: Fraction) -> str:
        above: list[str] = []
        below: list[str] = []
        for name in sorted(set(names), key=lambda name: (name in self.functions, name)):
            n = names.count(name)
            base = self.below.get(name) or self.functions.get(name, name)
            (below if name in self.below else above).append(base if n == 1 else f"{base}**{n}")
        # A term is (numerator·factors)/(denominator·divisors of inverses).
        if c.numerator != 1 or not above:
            above.insert(0, str(c.numerator))
        if c.denominator != 1:
            below.insert(0, str(c.denominator))
        return "/".join(["*".join(above), *below])

    def series(self, coefficients: Sequence[Poly], last: int | None) -> str:
        """Format Σ c_n hⁿ, with a remainder O(…) unless `last` is None."""
        parts = []
        for n, c in enumerate(coefficients):
            power = "h*" if n == 1 else f"h**{n}*"
            if c:
                parts.append(f"{power}({self.poly(c)})" if n else self.poly(c))
        if last is not None:
            parts.append(f"O(h**{last + 1})")
        return " + ".join(parts) or "0"
