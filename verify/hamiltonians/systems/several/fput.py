"""The chain of Fermi, Pasta, Ulam and Tsingou: n unit masses in a row between two walls.

Each of its n + 1 springs has the energy s²/2 + α s³/3 + β s⁴/4 where it is longer by s. For small
amplitudes its normal modes are sin(jkπ/(n + 1)) of the frequencies 2 sin(kπ/(2(n + 1))).
Of one mass the cubic parts of its two springs cancel, so that n begins with 2.
"""

from itertools import pairwise

from verify.hamiltonians.coordinates import numbered_names
from verify.hamiltonians.named_system import System


def _chain(n: int) -> str:
    names = numbered_names(n)
    momenta, places = names[:n], names[n:]
    inner = [f"({after} - {before})" for before, after in pairwise(places)]
    first, last = places[0], places[-1]  # the last spring is longer by -last
    kinetic = " + ".join(f"{p}**2" for p in momenta)
    square, fourth = (
        " + ".join(f"{s}**{power}" for s in (first, *inner, last)) for power in (2, 4)
    )
    # The last spring is longer by −q_n, whose cube has the other sign.
    cubic = " + ".join(f"{s}**3" for s in (first, *inner))
    return f"({kinetic})/2 + ({square})/2 + alpha*({cubic} - {last}**3)/3 + beta*({fourth})/4"


SYSTEM = System(
    name="fput",
    title="Fermi–Pasta–Ulam–Tsingou chain with fixed ends",
    formula=_chain(3),
    family=_chain,
    source=(
        "E. Fermi, J. Pasta, S. Ulam, Studies of Nonlinear Problems I, Los Alamos report LA-1940,"
        " 1955; the computations by M. Tsingou"
    ),
    parameters={
        "n": "number of moving masses, 2 … 64; 3 where it is not given",
        "alpha": "the springs' quadratic force",
        "beta": "their cubic force",
    },
    regimes={
        "alpha": {"n": "3", "alpha": "1/4", "beta": "0", "p": "0, 0, 0", "q": "1/2, 7/10, 1/2"},
        "beta": {"n": "3", "alpha": "0", "beta": "1", "p": "0, 0, 0", "q": "1/2, 7/10, 1/2"},
        "four": {"n": "4", "alpha": "1/4", "beta": "1/2", "p": "0, 0, 0, 0", "q": "1/10, 0, 0, 0"},
    },
)
