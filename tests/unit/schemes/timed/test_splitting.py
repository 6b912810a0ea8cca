"""Orders of splittings with times by conditions, held against series of steps in fractions."""

import random
from fractions import Fraction

import flint
import pytest
import sympy

from tests.helpers.planted.splittings import SPLITTINGS, parts_of
from tests.helpers.stepping.steps_in_time import agreement, flow, problem, splitting_step
from verify.errors import InputError
from verify.proof.order_conditions import agreed_order
from verify.schemes import get
from verify.schemes.conditions.scheme_clocks import conditions_for
from verify.schemes.conditions.splitting_conditions import Splitting
from verify.schemes.conditions.words.equations import combinations
from verify.schemes.conditions.words.equations import logarithm_equations as plain_conditions
from verify.schemes.conditions.words.words import Kinetic, concatenate, lyndon, text, words

R, F = sympy.Rational, Fraction
KINDS = {
    Kinetic.GENERAL: "general",
    Kinetic.AUTONOMOUS: "autonomous",
    Kinetic.MASS: "mass",
    Kinetic.QUADRATIC: "quadratic",
}


def order_of(parts, kinetic: Kinetic, most: int) -> int:
    """By conditions, of (kind, size, time)."""
    sizes = tuple((kind, R(a.numerator, a.denominator)) for kind, a, _ in parts)
    clock = tuple(R(s.numerator, s.denominator) for *_, s in parts)
    return agreed_order(Splitting(sizes, clock, kinetic), most - 2)[0]


def order_by_series(parts, kinetic: Kinetic, most: int) -> int:
    found = []
    for seed in (1, 2, 3):
        at = problem(seed, KINDS[kinetic])
        found.append(agreement(splitting_step(at, parts, most), flow(at, most)))
    return min(found)


def right_times(parts) -> list[Fraction]:
    before = {"kick": F(0), "drift": F(0)}
    found = []
    for kind, size in parts:
        found.append(before["drift" if kind == "kick" else "kick"])
        before[kind] += size
    return found


RUTH = [("kick", F(7, 24)), ("drift", F(2, 3)), ("kick", F(3, 4)), ("drift", F(-2, 3)),
        ("kick", F(-1, 24)), ("drift", F(1))]  # fmt: skip
VERLET = [("kick", F(1, 2)), ("drift", F(1)), ("kick", F(1, 2))]
OTHER = [("drift", F(1, 4)), ("kick", F(1, 2)), ("drift", F(1, 2)), ("kick", F(1, 2)),
         ("drift", F(1, 4))]  # fmt: skip


def drawn(seed: int) -> list[tuple[str, Fraction, Fraction]]:
    """Parts with some clocks right and some not, some of whose moments are those of right ones."""
    dice = random.Random(seed)  # noqa: S311
    parts = dice.choice((RUTH, VERLET, OTHER))
    clock = right_times(parts)
    for kind in dice.choice((("kick",), ("drift",), ("kick", "drift"), ())):
        at = [k for k, part in enumerate(parts) if part[0] == kind]
        moves = [F(dice.randint(-3, 3), dice.choice((2, 4, 5))) for _ in at]
        if len(at) > 1 and dice.random() < 0.7:  # Σ size·time stays as it is
            others = sum(parts[k][1] * x for k, x in zip(at[1:], moves[1:], strict=True))
            moves[0] = -others / parts[at[0]][1]
        for k, x in zip(at, moves, strict=True):
            clock[k] += x
    return [(*part, s) for part, s in zip(parts, clock, strict=True)]


@pytest.mark.left_to_ci
@pytest.mark.sample(10)
@pytest.mark.parametrize("seed", range(24))
def test_the_order_is_that_of_the_steps_series(seed: int) -> None:
    parts, most = drawn(seed), 4
    for kinetic in Kinetic:
        expected = order_by_series(parts, kinetic, most)
        assert order_of(parts, kinetic, most) == expected, (parts, kinetic)


def test_samples_have_several_orders_and_several_classes_differ() -> None:
    found = [[order_of(drawn(seed), k, 4) for k in Kinetic] for seed in range(24)]
    assert {1, 2, 3} <= {n for orders in found for n in orders}
    assert any(len(set(orders)) > 1 for orders in found)


@pytest.mark.parametrize("order", [(0, 1, 2), (2, 0, 1)])
def test_a_kick_may_be_parted_into_neighbours_of_other_times(order: tuple[int, ...]) -> None:
    """With the same moments up to degree 2; which comes first is of no matter, as kicks commute."""
    clock, nodes = right_times(RUTH), [F(0), F(1, 2), F(1)]
    size, s = RUTH[2][1], clock[2]
    shares = []
    for x in nodes:
        share = size
        for y in nodes:
            share *= F(1) if x == y else (s - y) / (x - y)
        shares.append(share)
    inner = [("kick", shares[k], nodes[k]) for k in order]
    plain = [(*part, x) for part, x in zip(RUTH, clock, strict=True)]
    parts = [*plain[:2], *inner, *plain[3:]]
    for kinetic in (Kinetic.GENERAL, Kinetic.AUTONOMOUS):
        assert order_of(parts, kinetic, 4) == order_by_series(parts, kinetic, 4) == 3
    wrong = [*plain[:2], *inner[:2], (*inner[2][:2], inner[2][2] + F(1, 9)), *plain[3:]]
    assert order_of(wrong, Kinetic.AUTONOMOUS, 4) == 1


# -- what is known --------------------------------------------------------------------------------


@pytest.mark.left_to_ci
@pytest.mark.parametrize("name", SPLITTINGS)
def test_with_right_clocks_every_splitting_keeps_its_order(name: str) -> None:
    scheme = get(name)
    for kinetic in Kinetic:
        found, _ = agreed_order(conditions_for(scheme.every_h, kinetic), scheme.order)
        assert found == scheme.order
    written = scheme.every_h.in_time()
    assert written.clocks_are_right
    assert written.order_conditions(scheme.order) == scheme.every_h.order_conditions(scheme.order)


@pytest.mark.parametrize("name", SPLITTINGS)
def test_the_full_conditions_hold_where_clocks_are_right(name: str, monkeypatch) -> None:
    """What the argument says, condition by condition: without the way that it allows."""
    scheme = get(name)
    monkeypatch.setattr(Splitting, "clocks_are_right", False)
    for kinetic in Kinetic:
        found = conditions_for(scheme.every_h, kinetic).order_conditions(scheme.order)
        assert all(c.holds for c in found)
        assert any("1" in c.name and "time" in c.name for c in found) is (scheme.order > 1)


@pytest.mark.parametrize("name", SPLITTINGS)
def test_a_frozen_clock_leaves_order_1(name: str) -> None:
    parts = tuple(parts_of(name))
    frozen = Splitting(parts, (sympy.S.Zero,) * len(parts), Kinetic.QUADRATIC)
    order, wrong = agreed_order(frozen, 4)
    assert order == 1
    if get(name).order > 1:
        assert (wrong.name, wrong.residue) == (
            "Σ kicks·time = 1/2, coefficient of K1 = 1/2",
            "-5.00000000000e-01",
        )


def test_a_drifts_time_is_judged_only_where_t_depends_on_time() -> None:
    parts = tuple((kind, R(str(size))) for kind, size in OTHER)
    clock = [R(str(s)) for s in right_times(OTHER)]
    both = zip(parts, clock, strict=True)
    wrong = tuple(s + 3 if kind == "drift" else s for (kind, _), s in both)
    orders = {k: agreed_order(Splitting(parts, wrong, k), 2)[0] for k in Kinetic}
    assert orders == {
        Kinetic.GENERAL: 1, Kinetic.MASS: 1, Kinetic.AUTONOMOUS: 2, Kinetic.QUADRATIC: 2,
    }  # fmt: skip


NYSTROM = ("0.1344961992774310892", "0.5153528374311229364", "-0.2248198030794208058",
           "-0.085782019412973646", "0.7563200005156682911", "0.4415830236164665242",
           "0.3340036032863214255", "0.1288461583653841854")  # fmt: skip


def test_mclachlan_and_atela_lose_an_order_where_the_mass_depends_on_time() -> None:
    """Their method of order 4 for quadratic T, to its printed digits."""
    parts = tuple((("kick", "drift")[k % 2], R(x)) for k, x in enumerate(NYSTROM))
    largest = {}
    for kinetic in Kinetic:
        found = Splitting(parts, (None,) * 8, kinetic).order_conditions(5)
        largest[kinetic] = [
            max(abs(float(c.residue)) for c in found if c.order == n) for n in range(1, 6)
        ]
    for kinetic, orders in largest.items():
        assert max(orders[:3]) < 1e-15
        assert (orders[3] < 1e-15) is (kinetic is Kinetic.QUADRATIC), kinetic
        assert orders[4] > 1e-4


# -- words ----------------------------------------------------------------------------------------


def brackets(kinds: str, most: int, quadratic: bool):
    """By weight: (number of Lyndon words, rank of brackets, rank of their Hamiltonians)."""
    names = ["p", *(f"{x}{n}_{k}" for x in "VT" for n in range(most) for k in range(most + 2))]
    context = flint.fmpq_mpoly_ctx.get(names, flint.Ordering.degrevlex)
    of = dict(zip(names, context.gens(), strict=True))

    def diff(x, name: str):
        total = context.constant(0)
        for at, degree in enumerate(x.degrees()):
            if degree > 0 and at == 0 and name == "p":
                total += x.derivative(0)
            elif degree > 0 and at and (names[at][0] == "V") == (name == "q"):
                head, _, k = names[at].partition("_")
                total += x.derivative(at) * of[f"{head}_{int(k) + 1}"]
        return total

    def hamiltonian(letter):
        kind, n = letter
        return of[f"V{n}_0"] if kind == "K" else of["p"] ** 2 if quadratic else of[f"T{n}_0"]

    def bracket(letter, element):
        words_in, h = element
        found: dict = {}
        for word, n in words_in.items():
            for other, sign in (
                (concatenate((letter,), word), n),
                (concatenate(word, (letter,)), -n),
            ):
                found[other] = found.get(other, 0) + sign
        own = hamiltonian(letter)
        value = diff(own, "p") * diff(h, "q") - diff(own, "q") * diff(h, "p")
        return {w: n for w, n in found.items() if n}, value

    def rank(rows) -> int:
        columns = sorted({x for row in rows for x in row})
        if not columns:
            return 0
        return flint.fmpq_mat([[row.get(c, 0) for c in columns] for row in rows]).rank()

    known, result = {}, []
    for weight in range(1, most + 1):
        counts = [len(lyndon(kinds, weight)), 0, 0]
        for letters in sorted({tuple(sorted(w)) for w in words(kinds, weight)}):
            if len(letters) == 1:
                known[letters] = [({letters: 1}, hamiltonian(letters[0]))]
            else:
                known[letters] = []
                for letter in dict.fromkeys(letters):
                    others = list(letters)
                    others.remove(letter)
                    known[letters] += [bracket(letter, e) for e in known[tuple(others)]]
            leading = [w for w in lyndon(kinds, weight) if tuple(sorted(w)) == letters]
            full = rank([e[0] for e in known[letters]])
            # The Lyndon words' coefficients alone tell them apart.
            assert full == rank([{w: e[0].get(w, 0) for w in leading} for e in known[letters]])
            counts[1] += full
            counts[2] += rank([e[1].to_dict() for e in known[letters]])
        result.append(tuple(counts))
    return result


@pytest.mark.parametrize(
    ("kinds", "counts"), [("K", [2, 2, 4, 7, 15, 28]), ("KD", [2, 3, 6, 12, 28, 61])]
)
def test_brackets_are_independent_in_the_plane_and_known_by_lyndon_words(kinds, counts) -> None:
    assert brackets(kinds, 6, quadratic=False) == [(n, n, n) for n in counts]


@pytest.mark.parametrize(
    ("kinds", "counts"), [("K", [2, 2, 4, 6, 12, 20]), ("KD", [2, 3, 6, 11, 23, 45])]
)
def test_for_quadratic_t_as_many_count_as_hamiltonians_have_rank(kinds, counts) -> None:
    assert [rank for *_, rank in brackets(kinds, 6, quadratic=True)] == counts
    assert [len(combinations(kinds, n)) for n in range(1, 7)] == counts


def test_without_time_the_words_are_those_of_kicks_and_drifts() -> None:
    for n in range(1, 9):
        own = list(lyndon("", n))
        assert [c.name.split("coefficient of ")[1].split(" =")[0] for c in
                Splitting((("kick", R(1)),)).order_conditions(n) if c.order == n] == list(
            map(text, own))  # fmt: skip
    # As many as are known of Nyström methods; in the plane one less of seven letters.
    known = [sum(c.order == n for c in plain_conditions("nystrom", 7)) for n in range(1, 8)]
    assert known == [2, 1, 2, 2, 4, 5, 10]
    assert [len(combinations("", n)) for n in range(1, 8)] == [2, 1, 2, 2, 4, 5, 9]


def test_kicks_commute_so_that_no_word_of_kicks_alone_counts() -> None:
    assert not [w for n in range(2, 7) for w in lyndon("KD", n) if len({k for k, _ in w}) == 1
                and len(w) > 1]  # fmt: skip


def test_bad_input_is_refused() -> None:
    with pytest.raises(InputError, match=r"^order=9"):
        Splitting((("kick", R(1)),), (None,), Kinetic.GENERAL).order_conditions(9)
    with pytest.raises(ValueError, match="2 times of 1 parts"):
        Splitting((("kick", R(1)),), (None, None))
    with pytest.raises(InputError, match="not given by coefficients"):
        conditions_for(get("lie2").every_h)
