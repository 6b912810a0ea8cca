"""What a checked certificate establishes, in formulas that stand for themselves.

Everything here is derived from the entries that the checker has looked at; a name is nowhere
believed. Formulas are written as `verify` reads them, with each function in the place of its name.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from verify.proof.certificates.checker import check
from verify.proof.certificates.coefficients import ONE, Stages, Tableau
from verify.proof.certificates.entries import Expansion, Form, Function
from verify.proof.certificates.numbers import Number
from verify.proof.certificates.readers import PLANE, Monomial, Poly, need

_LONGEST = 1_000_000  # characters of a formula with its functions written out
_ALMOST = "L does not vanish identically in p and q"
_SOLVABLE = "the stages have a solution that depends smoothly on (p, q)"
_WHICH = {  # H, by (separable, timed)
    (False, False): "every smooth H",
    (True, False): "every smooth H = T(p) + V(q)",
    (False, True): "every smooth H(p, q, t)",
    (True, True): "every smooth H = T(p, t) + V(q, t)",
}
_DEFECT = "S = JᵀΩJ − Ω"
_WORDS = {  # by whether a 2-form is its one entry: that the defect is 0, what it is else
    True: ("det J = 1", "det J − 1"),
    False: (f"{_DEFECT} = 0", _DEFECT),
}
_TELESCOPES = {  # by that, and whether H depends on t
    (True, False): ", and L = X·G",
    (True, True): ", and L = D·G, D = ∂/∂t + X",
    (False, False): ", and L is the Lie derivative of G",
    (False, True): ", and L is the Lie derivative of G by D = ∂/∂t + X",
}


@dataclass(frozen=True)
class Established:
    """What holds: for which H, of which map, and where.

    `hamiltonian`: the one H, or which. `order`: of ΔJ = det J − 1, whose coefficient is `leading`;
    None, with `area_preserving`: det J = 1. `agrees`: the map does so with the flow up to this
    power of h; None where nothing is said. `scheme`: where the entries are those of one. In n
    `degrees` of freedom `order` and `leading` are those of S, `symplectic` says whether that is 0,
    and the map is a formula for each coordinate. `numbers`: what each name of a number stands for.
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


def accepted(data: object) -> Established | str:
    """What a certificate establishes, or why the checker refuses it."""
    try:
        return established(check(data))
    except ValueError as reason:
        return str(reason)
    except RecursionError:
        return "its functions are nested too deeply"


def established(entries: Stages | Tableau | Expansion, *, nonzero: bool = True) -> Established:
    """What the theorem of `verify.proof.certificates.checker` says of these entries.

    `nonzero`: whether it is said that L is not 0.

    Raises ValueError where a formula is too long to be written out.
    """
    if isinstance(entries, Stages):
        return _of_stages(entries)
    return _of_tableau(entries) if isinstance(entries, Tableau) else _of_expansion(entries, nonzero)


def _of_stages(entries: Stages) -> Established:
    p, q, p_next, q_next, implicit = "p", "q", [], [], False
    for n, (kick, drift, at_p, at_q) in enumerate(entries.rows, 1):
        p_new, q_new = f"p{n}", f"q{n}"
        time = _time(entries, n - 1)
        at = f"({_between(p, p_new, at_p)}, {_between(q, q_new, at_q)}{time})"
        p_next.append(f"{p_new} = {p}" + (f" - h*({_poly(kick)})*H_q{at}" if kick else ""))
        q_next.append(f"{q_new} = {q}" + (f" + h*({_poly(drift)})*H_p{at}" if drift else ""))
        mixed = not entries.separable and ((kick and at_p) or (drift and at_q))
        implicit |= bool(mixed or (kick and drift and at_p and at_q))  # else det A is 1
        p, q = p_new, q_new
    end = f"(p, q) ↦ ({p}, {q})"
    return _symplectic(entries, "the scheme of these stages", (p_next, q_next), end, implicit)


def _of_tableau(entries: Tableau) -> Established:
    at = [f"(P{j}, Q{j}{_time(entries, j - 1)})" for j in range(1, len(entries.weights) + 1)]
    points = [(f"P{i}", f"Q{i}") for i in range(1, len(entries.weights) + 1)]
    p_next, q_next = [], []
    for (p, q), row in zip([*points, ("p1", "q1")], [*entries.rows, entries.weights], strict=True):
        kept = [(_poly(a), place) for a, place in zip(row, at, strict=True) if a]
        p_next.append(f"{p} = p" + "".join(f" - h*({a})*H_q{place}" for a, place in kept))
        q_next.append(f"{q} = q" + "".join(f" + h*({a})*H_p{place}" for a, place in kept))
    said = "the Runge–Kutta scheme of these stages"
    return _symplectic(entries, said, (p_next, q_next), "(p, q) ↦ (p1, q1)", True)


def _symplectic(
    entries: Stages | Tableau,
    scheme: str,
    formulas: tuple[Sequence[str], Sequence[str]],
    end: str,
    implicit: bool,
) -> Established:
    which = _which(entries, entries.times is not None)
    p_next, q_next = map("; ".join, formulas)
    return Established(
        statement=f"{_WORDS[entries.layout.single][0]} for {which} and {scheme}",
        scheme=end,
        hamiltonian=which,
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


def _which(entries: Stages | Tableau | Expansion, timed: bool) -> str:
    layout = entries.layout
    degrees = "" if layout.single else f" in {layout.degrees} degrees of freedom"
    return f"{_WHICH[entries.separable, timed]}{degrees}"


def _number(number: Number) -> str:
    powers = enumerate(number.polynomial)
    polynomial = _poly({(number.name,) * k: Fraction(c) for k, c in powers if c})
    return f"{number.name} = the root of {polynomial} in {number.ends}"


def _time(entries: Stages | Tableau, k: int) -> str:
    """The time of a stage, beside the point that H is taken at."""
    if entries.times is None:
        return ""
    time = entries.times[k]
    return f", t + ({_poly(time)})*h" if time else ", t"


def _poly(x: Poly) -> str:
    return _Writer().poly(x)


def _between(start: str, end: str, share: Poly) -> str:
    if share in ({}, ONE):
        return end if share else start
    return f"{start} + ({_poly(share)})*({end} - {start})"


def _of_expansion(entries: Expansion, nonzero: bool) -> Established:
    written, single = _Writer(entries.functions), entries.layout.single
    which, order, degrees = _which(entries, entries.timed), entries.order, entries.layout.degrees
    of_one, agreed = entries.hamiltonian is not None, entries.convergence_order
    area, defect = _WORDS[single]
    if order is not None:
        area = f"{defect} = L h^{order} + O(h^{order + 1})"
        if nonzero:
            area += f", L not zero{'' if of_one else ' for some H'}"
    by = "" if entries.potential is None else _TELESCOPES[single, entries.timed]
    flow = f"which agrees with the flow up to h^{agreed}{by}"
    formulas = tuple(written.series(x, entries.last) for x in entries.after)

    def form(x: Form) -> str:
        return written.poly(x.get(PLANE, {})) if single else written.form(x)

    return Established(
        statement=f"{area}, for {'this H' if of_one else which} and this map, {flow}",
        scheme=_taylor_series(entries),
        hamiltonian=which if entries.hamiltonian is None else written.poly(entries.hamiltonian),
        p_next=formulas[0] if single else formulas[:degrees],
        q_next=formulas[1] if single else formulas[degrees:],
        area_preserving=order is None if single or order is None else None,
        order=order,
        leading=None if order is None else form(entries.leading),
        potential=None if entries.potential is None else form(entries.potential),
        convergence_order=agreed,
        domain=(
            *(f"{written.poly(f.argument)} != 0" for f in entries.functions if f.kind == "inverse"),
            # L is not zero as a polynomial in the parameters, too; for some of them it may be.
            *([_ALMOST] if order is not None and entries.parameters else []),
        ),
        degrees=degrees,
        symplectic=order is None,
    )


def _taylor_series(entries: Expansion) -> str | None:
    """The flow's own series, where that is all there is of the map."""
    agreed = entries.convergence_order
    beyond = [c for series in entries.after for c in series[agreed + 1 :] if c]
    if beyond or (entries.last is not None and entries.last <= agreed):
        return None
    up_to = "" if entries.last is None else f", up to O(h^{entries.last + 1})"
    return f"the Taylor series of the flow, cut off after h^{agreed}{up_to}"


class _Writer:
    """Polynomials in names as formulas; a function stands written out in the place of its name."""

    def __init__(self, functions: Sequence[Function] = ()) -> None:
        self.functions: dict[str, str] = {}
        self.below: dict[str, str] = {}  # what 1/u divides by
        for made in functions:
            inner = self.poly(made.argument)
            self.functions[made.name] = f"{made.kind}({inner})"
            if made.kind == "inverse":
                self.below[made.name] = f"({inner})"

    def poly(self, x: Poly) -> str:
        """The polynomial as a formula."""
        terms, length = [], 0
        for names, c in sorted(x.items(), key=lambda term: (-len(term[0]), term[0])):
            terms.append(f"{'-' if c < 0 else '+'} {self._term(names, abs(c))}")
            length += len(terms[-1])
            need(length <= _LONGEST, "a formula is too long to be written out")
        text = " ".join(terms) or "0"
        return text.removeprefix("+ ") if text[0] != "-" else f"-{text[2:]}"

    def form(self, x: Form) -> str:
        """A 2-form, entry by entry."""
        return " + ".join(f"({self.poly(c)})*d{a}∧d{b}" for (a, b), c in x.items()) or "0"

    def _term(self, names: Monomial, c: Fraction) -> str:
        above: list[str] = []
        below: list[str] = []
        for name in sorted(set(names), key=lambda name: (name in self.functions, name)):
            n = names.count(name)
            base = self.below.get(name) or self.functions.get(name, name)
            (below if name in self.below else above).append(base if n == 1 else f"{base}**{n}")
        if c.numerator != 1 or not above:
            above.insert(0, str(c.numerator))
        if c.denominator != 1:
            below.insert(0, str(c.denominator))
        return "/".join(["*".join(above), *below])

    def series(self, coefficients: Sequence[Poly], last: int | None) -> str:
        """Σ c_n hⁿ, with what is not known where there is a last power."""
        parts = []
        for n, c in enumerate(coefficients):
            power = "h*" if n == 1 else f"h**{n}*"
            if c:
                parts.append(f"{power}({self.poly(c)})" if n else self.poly(c))
        if last is not None:
            parts.append(f"O(h**{last + 1})")
        return " + ".join(parts) or "0"
