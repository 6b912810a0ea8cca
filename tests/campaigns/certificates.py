"""Mutated certificates: whatever is accepted is true, quickly told, and never ends in a traceback.

    python -m tests.campaigns.certificates --count 20000 --seed 1

Seeds are certificates of proofs for one H and for every H. A mutant has one to four changes that
know what a certificate is made of; see `WAYS`. Whether an accepted one is true is told from what
the checker prints, by `tests.oracle.printed_certificates`, which shares nothing with it.
"""

import argparse
import copy
import json
import random
import time
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import asdict
from functools import cache
from typing import Any

from tests.oracle.printed_certificates import is_true
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.certificates.certification import certify_for_every_h, certify_for_one_h
from verify.proof.certificates.checker import check
from verify.proof.certificates.established_statement import state_theorem
from verify.proof.order_for_every_h import prove_for_every_h
from verify.proof.order_for_one_h import prove
from verify.proof.plane.potential import potential_of
from verify.schemes import get, names

Data = dict[str, Any]
SLOWEST = 10.0  # seconds for a file
HAMILTONIANS = (
    "p**2/2 + q**2/2 + d*q**4/4",
    "p**2/2 - cos(q)",
    "p**2/2 + 1/(1 + q**2)",
    "exp(p*q)",
    "p**2/2 + sin(exp(q))/(d + q**2)",
    "p**2/2 + q**3/3",
    "cos(p)*sin(q)",
    "p**2/2 - (1 + cos(2*t)/2)*cos(q)",
    "p**2/2 + d*q**3/(1 + t**2)",
    "t*p*q + exp(t)*q**2",
)
OF_ONE = ("lie1", "lie2", "lie3", "symplectic-euler", "stormer-verlet")
OF_ONE_POLYNOMIAL = ("rk4",)  # of another H its map is no polynomial in h, or too large


@cache
def seeds(longest: int = 12_000) -> tuple[Data, ...]:
    """Certificates of all schemes that have one, no longer than so many characters."""
    found = []
    for text in HAMILTONIANS:
        hamiltonian = Hamiltonian.parse(text)
        for name in OF_ONE + OF_ONE_POLYNOMIAL * bool(hamiltonian.exact.is_polynomial()):
            scheme = get(name)
            try:
                proof = prove(scheme.step_map(hamiltonian), scheme)
                found.append(certify_for_one_h(proof, potential_of(proof, scheme)))
            except InputError:
                continue
    for name in (*names(), "lie1", "lie2", "lie3"):
        scheme = get(name)
        every = scheme.every_h
        for separable in (False, True) if every and not every.separable else (True,):
            with suppress(InputError):
                found.append(certify_for_every_h(prove_for_every_h(name, separable)))
        if scheme.order <= 4 or not scheme.explicit:  # others are longer in time, and take long
            with suppress(InputError):
                found.append(certify_for_every_h(prove_for_every_h(name, timed=True)))
    texts = dict.fromkeys(map(json.dumps, found))
    return tuple(json.loads(text) for text in texts if len(text) <= longest)


# -- mutants --------------------------------------------------------------------------------------

Place = tuple[Any, Any]  # a list or an object, and an index or key in it
NUMBERS = ("0", "1", "-1", "2", "1/2", "-3/7", "1/0", "1e999999999", "-", "9" * 2000, "٣", "0.5",
           "1/" + "7" * 1999, "nan", " 1", "1_0", "")  # fmt: skip
WHOLES = (-1, -3, 0, 1, 2, 3, 4, 8, 64, 10**9, True, False, None, 2.0, "2", [], 10**4000)
NAMES = ("p", "q", "t", "h", "d", "e", "w", "#1", "#2", "#3", "#9", "H_", "H_p", "H_q", "H_pq",
         "H_qp", "H_pp", "H_t", "H_pt", "H_qtt", "H_tp", "H_" + "q" * 300, "sin", "\x1b[2J", "x y",
         "𝑝", "")  # fmt: skip
KINDS = ("sin", "cos", "exp", "inverse", "log", "")
KEYS = ("hamiltonian", "separable", "time_dependent", "parameters", "functions", "p_next",
        "q_next", "leading", "order", "convergence_order", "potential", "witness", "cofactors",
        "stages", "tableau", "numbers", "scheme", "x",
)  # fmt: skip


def places(data: Any) -> Iterator[Place]:
    """All places in a certificate."""
    keys = list(data) if isinstance(data, dict) else range(len(data))
    for key in keys:
        if key != "format":
            yield data, key
            if isinstance(data[key], dict | list):
                yield from places(data[key])


def polynomials(data: Data) -> list[list[Any]]:
    """Those among its entries."""
    found = [data.get("hamiltonian"), data.get("leading"), data.get("potential")]
    found += [*data.get("p_next", []), *data.get("q_next", [])]
    found += [f[2] for f in data.get("functions", []) if isinstance(f, list) and len(f) == 3]
    return [x for x in found if isinstance(x, list)]


def another_value(data: Data, rng: random.Random) -> None:
    """A number, name, kind, flag or order is replaced by one of its sort, or of any."""
    inside, key = rng.choice([(a, k) for a, k in places(data) if not isinstance(a[k], list | dict)])
    old = inside[key]
    if isinstance(old, bool):
        inside[key] = not old
    elif isinstance(old, str) and rng.random() < 0.9:
        numeric = old.lstrip("-").replace("/", "").isdigit()
        choice = NUMBERS if numeric else KINDS if old in KINDS else NAMES
        inside[key] = rng.choice(choice)
        if numeric and rng.random() < 0.3:
            inside[key] = old[1:] if old[0] == "-" else f"-{old}"
    else:
        inside[key] = rng.choice(WHOLES)


def another_shape(data: Data, rng: random.Random) -> None:
    """An entry of any depth is taken away, doubled, emptied, or put in the place of another."""
    inside, key = rng.choice(list(places(data)))
    match rng.randrange(5):
        case 0:
            del inside[key]
        case 1 if isinstance(inside, list):
            inside.insert(key, copy.deepcopy(inside[key]))
        case 2:
            inside[key] = type(inside[key])() if inside[key] is not None else []
        case 3 if isinstance(inside, list):
            rng.shuffle(inside)
        case _:
            other, there = rng.choice(list(places(data)))
            inside[key] = copy.deepcopy(other[there])


def another_term(data: Data, rng: random.Random) -> None:
    """A polynomial has a term more or less, or a term another factor."""
    kept = polynomials(data)
    if not kept:
        return
    poly = rng.choice(kept)
    known = [
        "p",
        "q",
        *NAMES,
        *(f[0] for f in data.get("functions", []) if isinstance(f, list) and f),
    ]
    if poly and rng.random() < 0.5:
        term = rng.choice(poly)
        if isinstance(term, list):
            term.append(rng.choice(known))
    else:
        poly.append(["1", *rng.sample(known, rng.randrange(3))])


def another_entry(data: Data, rng: random.Random) -> None:
    """A whole entry comes from another certificate, or under another key."""
    other = copy.deepcopy(rng.choice(seeds()))
    key = rng.choice(KEYS)
    value = other.get(key, rng.choice(WHOLES))
    data[key if rng.random() < 0.8 else rng.choice(KEYS)] = value


def another_function(data: Data, rng: random.Random) -> None:
    """A function that may have no value anywhere, or a relation that is none."""
    ones: list[Any] = [
        [["#90", "inverse", []]],
        [["#90", "inverse", [["1", "q"], ["-1", "q"]]]],
        [
            ["#90", "sin", [["1", "q"]]],
            ["#91", "cos", [["1", "q"]]],
            ["#92", "inverse", [["1", "#90", "#90"], ["1", "#91", "#91"], ["-1"]]],
        ],
        [["#90", "exp", [["999999", "q"]]]],
        [["#90", "sin", [["1", "p"]]]],
        [["#90", "sin", [["1", "t"]]], ["#91", "cos", [["1", "t"]]]],
        [["p", "exp", [["1", "q"]]]],
        [["#90", "inverse", [["1", "#90"]]]],
        [["#90", "inverse", [["1", "q"]]]],
    ]
    given = data.setdefault("functions", [])
    if isinstance(given, list):
        given[:0] = copy.deepcopy(rng.choice(ones))
    name = rng.choice(["#90", "#92"])
    cofactors = data.setdefault("cofactors", {})
    if isinstance(cofactors, dict):
        what = f"{rng.choice(['p', 'q', 'det'])} {rng.randrange(5)}"
        cofactors[what] = {name: [["1"], ["1", name]]}


def another_number(data: Data, rng: random.Random) -> None:
    """A name stands for another root, or for none; or a coefficient is made of other powers."""
    polynomials = (["-2", "0", "1"], ["-3", "0", "1"], ["2", "0", "1"], ["-4", "0", "1"], ["1"],
                   ["0", "-1", "0", "1"], ["-2", "0", "0", "1"], ["-3", "2"], [])  # fmt: skip
    ends = (["1", "2"], ["-2", "-1"], ["-2", "2"], ["0", "3"], ["2", "1"], ["3/2", "7/4"])
    given = data.setdefault("numbers", [])
    if isinstance(given, list) and given and rng.random() < 0.7:
        number = rng.choice(given)
        number[1:] = [rng.choice([number[1], *polynomials]), *rng.choice([number[2:], *ends])]
        return
    given.append([rng.choice(["w", "u", "p1"]), rng.choice(polynomials), *rng.choice(ends)])
    inside, key = rng.choice(list(places(data.get("stages") or data["tableau"])))
    factors = [["w"] * rng.randrange(4), ["u"], []]
    inside[key] = [["1/2", *rng.choice(factors)], ["-1/3", *rng.choice(factors)]]


def another_clock(data: Data, rng: random.Random) -> None:
    """t stands where a parameter stood, or the other way round, or is no longer said to be time."""
    timed = data.get("time_dependent") is True
    match rng.randrange(4):
        case 0:
            data["time_dependent"] = not timed
        case 1:
            data.pop("time_dependent", None)
        case 2:
            old, new = ('"d"', '"t"') if rng.random() < 0.5 else ('"t"', '"d"')
            data |= json.loads(json.dumps(data).replace(old, new))
        case _ if isinstance(data.get("parameters"), list):
            data["parameters"].append("t")


def less_is_said(data: Data, rng: random.Random) -> None:
    """What stays true: a lower order of agreement, no potential, other names, another witness."""
    match rng.randrange(5):
        case 0 if isinstance(data.get("convergence_order"), int):
            data["convergence_order"] -= 1
        case 1:
            data.pop("potential", None)
        case 2 if isinstance(data.get("witness"), dict):
            for name in data["witness"]:
                data["witness"][name] = rng.choice(["1/3", "-2/5", "5/7", "0", "100000"])
        case 3:
            for poly in polynomials(data):
                rng.shuffle(poly)
        case _:
            text = json.dumps(data).replace('"d"', '"mass"').replace('"#2"', '"#200"')
            data |= json.loads(text)


WAYS: tuple[Callable[[Data, random.Random], None], ...] = (
    another_value, another_value, another_shape, another_term, another_entry, another_function,
    another_number, another_clock, less_is_said,
)  # fmt: skip


def mutant(rng: random.Random) -> Data:
    """A certificate with one to four changes."""
    data = copy.deepcopy(rng.choice(seeds()))
    for _ in range(rng.choice([1, 1, 1, 2, 3, 4])):
        with suppress(LookupError, TypeError, AttributeError):  # an earlier change left it no room
            rng.choice(WAYS)(data, rng)
    return data


# -- the campaign ---------------------------------------------------------------------------------


def judged(data: Data, seed: int) -> tuple[str, float]:
    """("refused", "true", or what is wrong; seconds that the checker took)."""
    begun = time.perf_counter()
    try:
        found = state_theorem(check(data))
    except ValueError:
        return "refused", time.perf_counter() - begun
    except RecursionError:
        return "too deep", time.perf_counter() - begun
    seconds = time.perf_counter() - begun
    return "true" if is_true(asdict(found), seed, points=2) else "FALSE", seconds


def campaign(count: int, seed: int) -> tuple[Counter[str], float, list[Data]]:
    """How often each answer came, the slowest check, and what was accepted and is false."""
    answers: Counter[str] = Counter()
    slowest, wrong = 0.0, []
    for k in range(count):
        data = mutant(random.Random(f"{seed}:{k}"))  # noqa: S311 - no secret
        answer, seconds = judged(data, k)
        answers[answer] += 1
        slowest = max(slowest, seconds)
        if answer == "FALSE":
            wrong.append(data)
    return answers, slowest, wrong


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])  # type: ignore[union-attr]
    parser.add_argument("--count", type=int, default=20_000)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    answers, slowest, wrong = campaign(given.count, given.seed)
    print(f"{len(seeds())} certificates; {given.count} mutants: {dict(answers)}")
    print(f"slowest check {slowest:.2f} s")
    for data in wrong:
        print(json.dumps(data))
    raise SystemExit(bool(wrong) or slowest > SLOWEST)


if __name__ == "__main__":
    main()
