"""Times of splittings at random: the order by conditions is that of the map, made in other ways.

The map is composed, and the exact flow expanded, by Python's own fractions, in polynomials in p, q
and t that share no code with the toolkit.
"""

import random
from collections import defaultdict
from fractions import Fraction
from math import factorial

import pytest
import sympy

from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.order_for_one_h import convergence_of
from verify.schemes.conditions.splitting_conditions import Splitting, sums_before
from verify.schemes.conditions.words.words import Kinetic
from verify.schemes.maps.kinds import splittings

Polynomial = dict[tuple[int, int, int], Fraction]  # by the powers of p, q, t
MOST = 4
# T and V in which nothing vanishes by chance: of degree 4, and of degree 4 in t.
T: Polynomial = {
    (n, 0, m): Fraction(2 * n - m + 1, n + m + 1) for n in range(1, 5) for m in range(4)
}
V: Polynomial = {
    (0, n, m): Fraction(n + 3 * m + 1, 2 * n + m) for n in range(1, 5) for m in range(4)
}


def times(x: Polynomial, y: Polynomial) -> Polynomial:
    found: Polynomial = defaultdict(Fraction)
    for a, c in x.items():
        for b, d in y.items():
            found[a[0] + b[0], a[1] + b[1], a[2] + b[2]] += c * d
    return {k: c for k, c in found.items() if c}


def added(*terms: tuple[Fraction | int, Polynomial]) -> Polynomial:
    found: Polynomial = defaultdict(Fraction)
    for scale, x in terms:
        for k, c in x.items():
            found[k] += scale * c
    return {k: c for k, c in found.items() if c}


def diff(x: Polynomial, at: int) -> Polynomial:
    found: Polynomial = {}
    for k, c in x.items():
        if k[at]:
            lower = list(k)
            lower[at] -= 1
            found[lower[0], lower[1], lower[2]] = c * k[at]
    return found


def value(x: Polynomial, p: Fraction, q: Fraction, t: Fraction) -> Fraction:
    return sum((c * p**a * q**b * t**m for (a, b, m), c in x.items()), Fraction(0))


def flow(p: Fraction, q: Fraction, t: Fraction) -> list[tuple[Fraction, Fraction]]:
    """(Dⁿp, Dⁿq)/n! at a point."""
    force, speed = added((-1, diff(V, 1))), diff(T, 0)
    found, y, z = [(p, q)], {(1, 0, 0): Fraction(1)}, {(0, 1, 0): Fraction(1)}
    for n in range(1, MOST + 1):
        y, z = (
            added((1, times(force, diff(x, 0))), (1, times(speed, diff(x, 1))), (1, diff(x, 2)))
            for x in (y, z)
        )
        found.append((value(y, p, q, t) / factorial(n), value(z, p, q, t) / factorial(n)))
    return found


def series_of(
    parts: list[tuple[str, Fraction]], clock: list[Fraction], p: Fraction, q: Fraction, t: Fraction
) -> list[tuple[Fraction, Fraction]]:
    """The step's coefficients in h at a point, by polynomials in h cut off."""

    def product(x: list[Fraction], y: list[Fraction]) -> list[Fraction]:
        return [sum((x[k] * y[n - k] for k in range(n + 1)), Fraction(0)) for n in range(MOST + 1)]

    def at(x: Polynomial, z: list[Fraction], time: list[Fraction], place: int) -> list[Fraction]:
        total = [Fraction(0)] * (MOST + 1)
        for k, c in x.items():
            term = [c, *[Fraction(0)] * MOST]
            for _ in range(k[place]):
                term = product(term, z)
            for _ in range(k[2]):
                term = product(term, time)
            total = [a + b for a, b in zip(total, term, strict=True)]
        return total

    zero = [Fraction(0)] * (MOST - 1)
    ps, qs = [p, Fraction(0), *zero], [q, Fraction(0), *zero]
    for (kind, size), s in zip(parts, clock, strict=True):
        time = [t, s, *zero]
        slope = at(diff(V, 1), qs, time, 1) if kind == "kick" else at(diff(T, 0), ps, time, 0)
        moved = [Fraction(0), *(size * x for x in slope[:-1])]
        if kind == "kick":
            ps = [a - b for a, b in zip(ps, moved, strict=True)]
        else:
            qs = [a + b for a, b in zip(qs, moved, strict=True)]
    return list(zip(ps, qs, strict=True))


POINTS = [(Fraction(3, 7), Fraction(-5, 11), Fraction(2, 13)), (Fraction(-1, 3), 2, Fraction(7, 5))]


def order_by_hand(parts: list[tuple[str, Fraction]], clock: list[Fraction]) -> int:
    order = MOST
    for point in POINTS:
        z = tuple(map(Fraction, point))
        pairs = zip(series_of(parts, clock, *z), flow(*z), strict=True)
        wrong = next((n for n, (x, y) in enumerate(pairs) if x != y), MOST + 1)
        order = min(order, wrong - 1)
    return order


def order_by_conditions(parts: list[tuple[str, Fraction]], clock: list[Fraction]) -> int:
    own = Splitting(
        tuple((kind, sympy.Rational(x)) for kind, x in parts),
        tuple(map(sympy.Rational, clock)),
        Kinetic.GENERAL,
    )
    for order in range(1, MOST + 1):
        if not all(c.holds for c in own.order_conditions(order)):
            return order - 1
    return MOST


def _neighbours(
    rng: random.Random,
) -> tuple[list[tuple[str, Fraction]], list[Fraction]]:
    """Kicks side by side at times of their own, whose moments are those of one kick and of its
    neighbours: of order 2, though no clock is right."""
    size = Fraction(rng.randint(1, 5), 7)
    apart = Fraction(rng.randint(1, 3), 5)
    parts = [
        ("drift", Fraction(1, 2)),
        ("kick", size),
        ("kick", 1 - size),
        ("drift", Fraction(1, 2)),
    ]
    middle = Fraction(1, 2)
    return parts, [Fraction(0), middle - apart * (1 - size), middle + apart * size, Fraction(1)]


def drawn(seed: int) -> tuple[list[tuple[str, Fraction]], list[Fraction]]:
    """Consistent sizes, and times that are right, right but for one, symmetric, or anything."""
    rng = random.Random(seed)  # noqa: S311 - the same ones in every run
    if seed % 3 == 0:  # a symmetric one of order 2 or 4
        name = rng.choice(["verlet", "suzuki"])
        part = Fraction(1, 4) if name == "suzuki" else Fraction(1)
        sizes = [part / 2, part, part / 2]
        parts = list(zip(("kick", "drift", "kick"), sizes, strict=True))
    else:
        count = rng.randint(2, 4)
        kicks = [Fraction(rng.randint(1, 5), 6) for _ in range(count)]
        drifts = [Fraction(rng.randint(1, 5), 6) for _ in range(count)]
        kicks[-1] += 1 - sum(kicks)
        drifts[-1] += 1 - sum(drifts)
        parts = [x for k, d in zip(kicks, drifts, strict=True) for x in (("kick", k), ("drift", d))]
    if seed % 5 == 4:  # a part is cut in two, which stand at different times or at one
        at = rng.randrange(len(parts))
        kind, size = parts[at]
        cut = Fraction(rng.randint(1, 3), 4)
        parts[at : at + 1] = [(kind, size * cut), (kind, size - size * cut)]
    clock = sums_before(parts, Fraction(0))
    if seed % 10 == 4:  # times that are wrong and make up for each other
        parts, clock = _neighbours(rng)
    elif seed % 2:
        clock[rng.randrange(len(clock))] += Fraction(rng.choice([-1, 1]), rng.randint(1, 4))
    return parts, clock


@pytest.mark.sample(4)
@pytest.mark.parametrize("seed", range(24))
def test_the_order_by_conditions_is_that_of_the_map_by_hand(seed: int) -> None:
    parts, clock = drawn(seed)
    assert order_by_conditions(parts, clock) == order_by_hand(parts, clock)


@pytest.mark.left_to_ci
@pytest.mark.sample(3)
@pytest.mark.parametrize("seed", range(6))
def test_and_so_is_that_of_a_proof_for_one_h(seed: int) -> None:
    parts, clock = drawn(seed)

    def text(x: Polynomial) -> str:
        return " + ".join(f"({c})*p**{a}*q**{b}*t**{m}" for (a, b, m), c in x.items())

    hamiltonian = Hamiltonian.parse(f"{text(T)} + {text(V)}")
    own = Splitting(
        tuple((kind, sympy.Rational(x)) for kind, x in parts),
        times=tuple(map(sympy.Rational, clock)),
    )
    step = splittings.build(own, hamiltonian, "drawn")
    assert convergence_of(step).order == order_by_hand(parts, clock)


def test_a_coefficient_that_is_a_little_off_is_seen() -> None:
    """The planted error beside it all: sizes, or a time, wrong by 10⁻⁹."""
    verlet = [("kick", Fraction(1, 2)), ("drift", Fraction(1)), ("kick", Fraction(1, 2))]
    clock, little = [Fraction(0), Fraction(1, 2), Fraction(1)], Fraction(1, 10**9)
    assert order_by_conditions(verlet, clock) == order_by_hand(verlet, clock) == 2
    for wrong in ([*clock[:2], 1 + little], [clock[0], clock[1] + little, clock[2]]):
        assert order_by_conditions(verlet, wrong) == order_by_hand(verlet, wrong) == 1


def test_kicks_side_by_side_commute() -> None:
    """Of order 3, though no sum over kicks alone asks for these times in this order."""
    sizes = ["7/24", "2/3", "-1/12", "2/3", "1/6", "-2/3", "-1/24", "1"]
    kinds = ["kick", "drift", "kick", "kick", "kick", "drift", "kick", "drift"]
    parts = list(zip(kinds, map(Fraction, sizes), strict=True))
    clock = sums_before(parts, Fraction(0))
    for at, time in zip((0, 2, 3, 4, 6), ("0", "0", "1/2", "1", "0"), strict=True):
        clock[at] = Fraction(time)
    assert order_by_conditions(parts, clock) == order_by_hand(parts, clock) == 3
