"""What may be wrong with somebody's numbers: each mistake makes another setting of the right one.

Those of a state are tried on p and q; those of an area error are other readings of ΔJ, MSE and Λ,
tried where the state is known. Adding a mistake is adding an entry.
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import combinations

import flint
import numpy as np

from reference.setting import Case, Known, Setting
from verify import schemes
from verify.balls import in_reach, middle_and_radius, rational_ball
from verify.exact import short
from verify.formula import to_text
from verify.hamiltonian import Hamiltonian
from verify.proof.splitting_conditions import Part, Splitting


@dataclass(frozen=True)
class Mistake:
    """`says`: in words, to whom it may concern."""

    name: str
    says: str
    setting: Setting


def of_inputs(right: Setting) -> Iterator[Mistake]:
    """Inputs that are doubles; no program that works with doubles can be told by them."""
    case = right.case
    doubles = {
        "h": case.step_size, "q0": case.q, "p0": case.p, **dict(case.hamiltonian.values),
    }  # fmt: skip
    inexact = [n for n, x in doubles.items() if _double(x) not in (x, None)]
    subsets = [c for k in range(1, len(inexact) + 1) for c in combinations(inexact, k)]
    for names in subsets if len(inexact) <= _MOST_INEXACT else [tuple(inexact), *_ones(inexact)]:
        changed = {n: _double(doubles[n]) for n in names}
        shown = " and ".join(f"{n} is the double nearest to {_text(doubles[n])}" for n in names)
        says = f"your {shown}, and not exactly that"
        name = f"double-{'-'.join(names)}"
        yield Mistake(name, says, replace(right, case=_with(case, changed)))


def of_states(right: Setting) -> Iterator[Mistake]:
    """All that can be seen in doubles."""
    yield from _of_columns(right)
    yield from _of_scheme(right)
    yield from _of_step(right)


_MOST_INEXACT = 4
_OF_SCHEME = "scheme "
_OTHER_EULER = "symplectic Euler of the other kind"


def _of_columns(right: Setting) -> Iterator[Mistake]:
    case = right.case
    exchanged = replace(case, q=case.p, p=case.q)
    yield Mistake("swapped-columns", "your columns p and q are swapped",
                  replace(right, swapped=True))  # fmt: skip
    yield Mistake("swapped-start", "your initial p and q are swapped",
                  replace(right, case=exchanged))  # fmt: skip
    yield Mistake("swapped-throughout", "p and q are swapped, in your columns and at the start",
                  replace(right, case=exchanged, swapped=True))  # fmt: skip
    yield Mistake("negated-p", "your p has the other sign", replace(right, negated=True))
    yield Mistake("negated-start", "your initial p has the other sign",
                  replace(right, case=replace(case, p=-case.p)))  # fmt: skip
    backwards = Hamiltonian(-case.hamiltonian.expression, case.hamiltonian.values)
    yield Mistake("backwards", "your time runs backwards: p' = +∂H/∂q, q' = −∂H/∂p",
                  replace(right, case=replace(case, hamiltonian=backwards)))  # fmt: skip
    for late, says in ((1, "too low"), (-1, "too high")):
        yield Mistake(f"late{late:+d}", f"your step index is {says} by one",
                      replace(right, late=late))  # fmt: skip


def _of_step(right: Setting) -> Iterator[Mistake]:
    case, h = right.case, right.case.step_size
    for name, factor, says in (("half", Fraction(1, 2), "half"), ("double", Fraction(2), "twice")):
        yield Mistake(f"{name}-step", f"your h is {says} of {_text(h)}",
                      replace(right, case=replace(case, step_size=factor * h)))  # fmt: skip
    single = {"h": _single(h)}
    if single["h"] not in (None, h):
        yield Mistake("single-h", f"your h is the single-precision number nearest to {_text(h)}",
                      replace(right, case=_with(case, single)))  # fmt: skip
    for name, value in case.hamiltonian.values:
        for what, other in (("minus", -value), ("no", Fraction(0))):
            if other != value:
                yield Mistake(f"{what}-{name}", f"your {name} is {_text(other)}",
                              replace(right, case=_with(case, {name: other})))  # fmt: skip


def _of_scheme(right: Setting) -> Iterator[Mistake]:
    """Its relatives by name, then all other schemes."""
    mine = right.case.scheme
    said = dict(_relatives(mine))
    for name in schemes.names():
        said.setdefault(name, f"your scheme is {name}")
    said.pop(mine, None)
    for name, says in said.items():
        yield Mistake(
            f"{_OF_SCHEME}{name}", says, replace(right, case=replace(right.case, scheme=name))
        )


_ELSEWHERE = Fraction(1, 3), Fraction(2, 7), Fraction(1, 5)  # q, p and h like no others
_SHARP = 40  # digits


def without_synonyms(mistakes: list[Mistake]) -> list[Mistake]:
    """The mistakes but for those that are another name of an earlier one's scheme, for this H."""
    found: dict[object, Mistake] = {}
    for mistake in mistakes:
        setting, (q, p, h) = mistake.setting, _ELSEWHERE
        there = replace(setting.case, q=q, p=p, step_size=h)
        state = None
        if mistake.name.startswith(_OF_SCHEME):
            known = replace(setting, case=there).state(1, _SHARP)
            state = known and (known["p"][0], known["q"][0])
        found.setdefault(state or mistake.name, mistake)
    return list(found.values())


def _relatives(name: str) -> Iterator[tuple[str, str]]:
    if name.startswith("lie"):
        eta = int(name[3:])
        for other in (eta - 1, eta + 1):
            if other > 0:
                yield f"lie{other}", f"your η is {other}, and not {eta}"
    generic = schemes.get(name).generic
    if isinstance(generic, Splitting):
        parts = generic.parts
        kinds = {"kick": "drift", "drift": "kick"}
        changes = (
            ("its parts in the opposite order", parts[::-1]),
            ("kicks for drifts and drifts for kicks", tuple((kinds[k], x) for k, x in parts)),
        )
        for says, changed in changes:
            if changed != parts:
                euler = name == "symplectic-euler"
                own = _OTHER_EULER if euler else f"{name} with {says}"
                yield _named(changed), f"your scheme is {own}"


def _named(parts: tuple[Part, ...]) -> str:
    """The name of the scheme of these parts; the parts themselves where it has none."""
    for name in schemes.names():
        generic = schemes.get(name).generic
        if isinstance(generic, Splitting) and generic.parts == parts:
            return name
    return "; ".join(f"{kind} {to_text(size)}" for kind, size in parts)


# -- numbers of other sizes -----------------------------------------------------------------------


def _ones(names: list[str]) -> list[tuple[str, ...]]:
    return [(name,) for name in names]


def _with(case: Case, changed: dict[str, Fraction | None]) -> Case:
    new = {n: x for n, x in changed.items() if x is not None}
    h, q, p = new.pop("h", case.step_size), new.pop("q0", case.q), new.pop("p0", case.p)
    values = {**dict(case.hamiltonian.values), **new}
    hamiltonian = Hamiltonian(case.hamiltonian.expression).with_values(values)
    return Case(hamiltonian, case.scheme, h, q, p)


def _double(x: Fraction) -> Fraction | None:
    try:
        return Fraction(float(x))
    except OverflowError:
        return None


def _single(x: Fraction) -> Fraction | None:
    near = np.float32(float(x))
    return Fraction(float(near)) if np.isfinite(near) and near else None


def _text(x: Fraction) -> str:
    return short(x)


_NEAR = Fraction(1, 10**9)

# -- other readings of the area error -------------------------------------------------------------


@dataclass(frozen=True)
class Foretold:
    """What a column is foretold to hold, and how many times more than the right value of that
    column it changes with what that is made of."""

    value: Fraction
    radius: Fraction
    factor: Fraction = Fraction(1)


Reading = Callable[[Setting, int, int], Foretold | None]  # the setting, digits, the row's step


def readings(name: str) -> Iterator[tuple[str, str, Reading]]:
    """For a column, what else it may hold: a name, in words, and how it is had."""
    for late, says in ((1, "later"), (-1, "earlier")):
        yield f"{name}{late:+d}", f"your {name} is that of one step {says}", _shifted(name, late)
    yield from {"lambda": _LAMBDA, "mse": _MSE, "delta_j": _DELTA_J}[name]


def value_of(setting: Setting, name: str, step: int, digits: int) -> Known | None:
    point = setting.point(step, digits)
    found = getattr(point, "lam" if name == "lambda" else name, None)
    return None if found is None else (Fraction(found.value), Fraction(found.radius))


def _shifted(name: str, late: int) -> Reading:
    def read(setting: Setting, digits: int, step: int) -> Foretold | None:
        known = value_of(replace(setting, late=setting.late + late), name, step, digits)
        return known and Foretold(*known)

    return read


def _changed(name: str, change: Callable[[Fraction, int], Fraction | None]) -> Reading:
    """A function of the right value and N; thrice its radius is taken along, for good measure."""

    def read(setting: Setting, digits: int, step: int) -> Foretold | None:
        known = value_of(setting, name, step, digits)
        if known is None:
            return None
        (x, radius), n = known, step + setting.late
        near = abs(x) * _NEAR
        middle, aside = change(x, n), change(x + near, n)
        if middle is None or aside is None:
            return None
        factor = abs(aside - middle) / near if near else Fraction(1)
        return Foretold(middle, 3 * factor * radius, max(factor, Fraction(1)))

    return read


def _from_second(name: str) -> Reading:
    """Over k = 1 … N and not 0 … N−1."""

    def read(setting: Setting, digits: int, step: int) -> Foretold | None:
        n = step + setting.late
        whole = value_of(replace(setting, late=setting.late + 1), name, step, digits)
        first = value_of(setting, "delta_j", -setting.late, digits)
        if whole is None or first is None or first[0] == -1 or (name == "mse" and n < 1):
            return None
        if name == "lambda":
            value = (1 + whole[0]) / (1 + first[0]) - 1
        else:
            value = ((n + 1) * whole[0] - first[0] ** 2) / n
        radius = 4 * (whole[1] * (n + 1) + first[1] * (1 + abs(whole[0])))
        return Foretold(value, radius, Fraction(2))

    return read


def _sum(setting: Setting, digits: int, step: int) -> Foretold | None:
    """Σ ΔJ_k = log(1 + Λ) + ½ Σ ΔJ_k² − …, what is left out being at most ⅓ Σ |ΔJ_k|³."""
    lam, mse = value_of(setting, "lambda", step, digits), value_of(setting, "mse", step, digits)
    n = step + setting.late
    if lam is None or (mse is None and n > 0):
        return None
    mse = mse or (Fraction(0), Fraction(0))
    with flint.ctx.workprec(4 * digits + 64):
        squares = rational_ball(n * mse[0])
        total = (1 + rational_ball(lam[0])).log() + squares / 2
        if not in_reach(total):
            return None
        value, radius = middle_and_radius(total)
        rest = middle_and_radius(squares * squares.sqrt())  # Σ|x|³ ≤ (Σ x²)^(3/2)
    return Foretold(value, radius + sum(rest) + 2 * lam[1] + n * mse[1])


def _root(x: Fraction, _: int) -> Fraction | None:
    scale = 10**80
    return Fraction(math.isqrt(int(x * scale**2)), scale) if x >= 0 else None


_LAMBDA: tuple[tuple[str, str, Reading], ...] = (
    ("product", "your lambda is the product of det J, without − 1",
     _changed("lambda", lambda x, _: 1 + x)),
    ("sum", "your lambda is the sum of ΔJ_k, not the product of 1 + ΔJ_k, less 1", _sum),
    ("negated-lambda", "your lambda has the other sign", _changed("lambda", lambda x, _: -x)),
    ("inverse", "your lambda is that of the inverse map: 1/Π det J_k − 1",
     _changed("lambda", lambda x, _: 1 / (1 + x) - 1 if x != -1 else None)),
    ("second-first", "your lambda is over k = 1 … N, not 0 … N−1", _from_second("lambda")),
)  # fmt: skip
_MSE: tuple[tuple[str, str, Reading], ...] = (
    ("root", "your mse is its square root", _changed("mse", _root)),
    ("whole-sum", "your mse is the sum, not divided by N", _changed("mse", lambda x, n: n * x)),
    ("one-more", "your mse is divided by N + 1", _changed("mse", lambda x, n: n * x / (n + 1))),
    ("one-less", "your mse is divided by N − 1",
     _changed("mse", lambda x, n: n * x / (n - 1) if n > 1 else None)),
    ("second-first", "your mse is over k = 1 … N, not 0 … N−1", _from_second("mse")),
)  # fmt: skip
_DELTA_J: tuple[tuple[str, str, Reading], ...] = (
    ("determinant", "your delta_j is det J, without − 1",
     _changed("delta_j", lambda x, _: 1 + x)),
    ("negated", "your delta_j has the other sign", _changed("delta_j", lambda x, _: -x)),
    ("inverse", "your delta_j is that of the inverse map: 1/det J − 1",
     _changed("delta_j", lambda x, _: 1 / (1 + x) - 1 if x != -1 else None)),
)  # fmt: skip
