"""How many drawn Hamiltonians a second lie1, lie2, lie3 and lie4 are all proved for, on one core.

    python tests/bench/drawn_proofs.py

From each formula's text to the four proofs with their witnesses, in seconds of processor time; each
kind in a process of its own, with its peak memory. Target: 300 a second for the polynomials.
"""

import random
import resource
import subprocess
import sys
import time
from collections.abc import Callable

SEED, DEGREE, ROUNDS = 1, 6, 3
SCHEMES = ("lie1", "lie2", "lie3", "lie4")
Draw = Callable[[random.Random], str]


def number(rng: random.Random) -> str:
    return f"{rng.choice((-1, 1)) * rng.randint(1, 9)}/{rng.randint(1, 9)}"


def sparse(rng: random.Random) -> str:
    """One to five terms of total degree at most 6."""
    terms = []
    for _ in range(rng.randint(1, 5)):
        i = rng.randint(0, DEGREE)
        terms.append(f"({number(rng)})*p**{i}*q**{rng.randint(0, DEGREE - i)}")
    return " + ".join(terms)


def dense(rng: random.Random) -> str:
    """All 27 monomials of total degree 1 to 6."""
    powers = [(i, j) for i in range(DEGREE + 1) for j in range(DEGREE + 1 - i) if i + j]
    return " + ".join(f"({number(rng)})*p**{i}*q**{j}" for i, j in powers)


def of_functions(*names: str) -> Draw:
    """The kinetic energy and one or two functions of p, q or both."""

    def draw(rng: random.Random) -> str:
        terms = (
            f"({number(rng)})*{rng.choice(names)}({rng.choice(('q', '2*q', 'p', 'p + q'))})"
            for _ in range(rng.randint(1, 2))
        )
        return " + ".join(("p**2/2", *terms))

    return draw


KINDS: dict[str, tuple[int, Draw]] = {
    "sparse, 1 to 5 terms": (600, sparse),
    "dense, 27 terms": (100, dense),
    "trigonometric": (100, of_functions("sin", "cos")),
    "exponential": (100, of_functions("exp", "cosh")),
}


def prove_all(kind: str) -> None:
    """Prints Hamiltonians a second, the best of some rounds of other ones, and the peak memory."""
    from verify import schemes
    from verify.hamiltonians.hamiltonian import Hamiltonian
    from verify.proof.order_for_one_h import prove
    from verify.verdict import Verdict

    made = [schemes.get(name) for name in SCHEMES]
    count, draw = KINDS[kind]
    rng = random.Random(SEED)  # noqa: S311 - the same Hamiltonians in every run
    best, parsing = 0.0, 0.0
    for _ in range(ROUNDS):
        formulas = [draw(rng) for _ in range(count)]
        parsed, began = 0.0, time.process_time()
        for formula in formulas:
            start = time.process_time()
            hamiltonian = Hamiltonian.parse(formula)
            parsed += time.process_time() - start
            for scheme in made:
                proof = prove(scheme.step_map(hamiltonian), scheme)
                assert proof.verdict is Verdict.PROVED, (formula, scheme.name)
        taken = time.process_time() - began
        if count / taken > best:
            best, parsing = count / taken, parsed / taken
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(f"{kind:>24} {best:10.0f} {parsing:8.0%} {peak:10.0f}", flush=True)


def main() -> None:
    if len(sys.argv) > 1:
        prove_all(sys.argv[1])
        return
    print(f"{'Hamiltonians':>24} {'a second':>10} {'parsing':>8} {'peak MiB':>10}", flush=True)
    for kind in KINDS:
        subprocess.run([sys.executable, __file__, kind], check=True)


if __name__ == "__main__":
    main()
