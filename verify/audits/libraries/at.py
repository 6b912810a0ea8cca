"""pyAT's pass methods: an element of length h in one slice is one step along the beam's axis.

At the design energy, in (x, p_x, y, p_y), the steps are drifts and kicks of H = p²/2 + V, or of an
H with the square root of exact drifts. V is that of a quadrupole and a sextupole.
"""

from collections.abc import Iterator
from fractions import Fraction

from verify.audits.methods.driver import USUAL_LADDER, integrator_from_script
from verify.audits.methods.integrator import ReleasedIntegrator

TITLE = "pyAT"
LIBRARY = "at"
PACKAGE = "accelerator-toolbox"
LEFT_OUT = (
    ("… Rad, … Quant, … E2", "radiate or have fringe fields: no flow of such an H"),
    ("QuadLinearPass, DriftPass", "are exact flows by their formulas"),
    ("IdTablePass, wake fields, cavities", "are kicks alone"),
)
_SCRIPT = """\
import at
import numpy as np


def step(p, q, h):
    field = [0, 2 / 3, 1 / 2]
    magnet = at.Multipole("m", h, [0, 0, 0], field, PassMethod="{method}", NumIntSteps=1{more})
    z = np.zeros(6)
    {put}
    magnet.track(z, in_place=True)
    return {got}
"""
_PLANE = {"put": "z[:2] = q, p", "got": "float(z[1]), float(z[0])"}
_SPACE = {"put": "z[[0, 2]], z[[1, 3]] = q, p", "got": "z[[1, 3]], z[[0, 2]]"}
_FIELD = "q**2/3 + q**3/6"
_FIELDS = "q1**2/3 - q2**2/3 + q1**3/6 - q1*q2**2/2"
_BENT = ", BendingAngle=h / 2, EntranceAngle=0.0, ExitAngle=0.0"
_DRIVEN = "one element of length h with NumIntSteps = 1, a quadrupole and a sextupole"
_CLAIM = "its name, and the documentation of its pass methods: a symplectic integrator of order 4"
_SYSTEMS = {
    "StrMPoleSymplectic4Pass": ("p**2/2", "p1**2/2 + p2**2/2", ""),
    "BndMPoleSymplectic4Pass": ("p**2/2 + q**2/8", "p1**2/2 + p2**2/2 + q1**2/8", _BENT),
    "ExactMultipolePass": ("-sqrt(1 - p**2)", "-sqrt(1 - p1**2 - p2**2)", ""),
}
_SLOW = ((Fraction(1, 5), Fraction(3, 5)), (Fraction(-1, 4), Fraction(2, 5)))  # |p| is below 1


def integrators() -> Iterator[ReleasedIntegrator]:
    for method, (plane, space, more) in _SYSTEMS.items():
        for tag, formula, ends in (
            ("", f"{plane} + {_FIELD}", _PLANE),
            (", two degrees", f"{space} + {_FIELDS}", _SPACE),
        ):
            text = _SCRIPT.format(method=method, more=more, **ends)
            points = _SLOW if ends is _PLANE else ()
            yield integrator_from_script(
                f"{method}{tag}", _DRIVEN, _CLAIM, formula, text, 4, True, points, USUAL_LADDER
            )
