"""The Sun and the five outer planets of 1994, Pluto among them, in space.

Body k is at (q_(3k+1), q_(3k+2), q_(3k+3)), from the Sun, 0, to Pluto, 5. Distances are in
astronomical units, times in days, masses relative to the Sun, whose m0 has the inner planets in it.
The regime has positions and velocities as they are printed, and momenta exactly m·v.
"""

from fractions import Fraction
from itertools import combinations

from verify.arithmetic.exact import text
from verify.hamiltonians.named_system import System

_MASSES = {
    "m0": "1.00000597682",
    "m1": "0.000954786104043",
    "m2": "0.000285583733151",
    "m3": "0.0000437273164546",
    "m4": "0.0000517759138449",
    "m5": "1/130000000",
}
_POSITIONS = [
    "0", "0", "0",
    "-3.5023653", "-3.8169847", "-1.5507963",
    "9.0755314", "-3.0458353", "-1.6483708",
    "8.3101420", "-16.2901086", "-7.2521278",
    "11.4707666", "-25.7294829", "-10.8169456",
    "-15.5387357", "-25.2225594", "-3.1902382",
]  # fmt: skip
_VELOCITIES = [
    "0", "0", "0",
    "0.00565429", "-0.00412490", "-0.00190589",
    "0.00168318", "0.00483525", "0.00192462",
    "0.00354178", "0.00137102", "0.00055029",
    "0.00288930", "0.00114527", "0.00039677",
    "0.00276725", "-0.00170702", "-0.00136504",
]  # fmt: skip


def _momenta() -> list[str]:
    masses = [Fraction(mass) for mass in _MASSES.values() for _ in range(3)]
    return [text(m * Fraction(v)) for m, v in zip(masses, _VELOCITIES, strict=True)]


def _formula() -> str:
    axes = range(1, 4)
    kinetic = (
        f"({' + '.join(f'p{3 * k + i}**2' for i in axes)})/(2*{m})" for k, m in enumerate(_MASSES)
    )
    pairs = (
        f"{a}*{b}/sqrt({' + '.join(f'(q{3 * j + i} - q{3 * k + i})**2' for i in axes)})"
        for (j, a), (k, b) in combinations(enumerate(_MASSES), 2)
    )
    return f"{' + '.join(kinetic)} - G*({' + '.join(pairs)})"


SYSTEM = System(
    name="outer-solar-system",
    title="outer solar system",
    formula=_formula(),
    source=(
        "Hairer, Lubich, Wanner, Geometric Numerical Integration, I.2.4, table 2.2:"
        " September 5, 1994, 0h"
    ),
    parameters={
        "G": "the gravitational constant",
        "m0": "mass of the Sun and the inner planets",
        "m1": "mass of Jupiter",
        "m2": "mass of Saturn",
        "m3": "mass of Uranus",
        "m4": "mass of Neptune",
        "m5": "mass of Pluto",
    },
    regimes={
        "september-1994": {
            "G": "2.95912208286e-4",
            **_MASSES,
            "p": ", ".join(_momenta()),
            "q": ", ".join(_POSITIONS),
        }
    },
)
