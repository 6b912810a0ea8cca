"""REBOUND's integrators, on one line: a particle without mass falls towards a star, which stays.

With G = 1, a star of mass 8 and softening 2, that is H = p²/2 − 8/√(q² + 4). EOS takes no
softening, and Wisdom–Holman integrators solve the problem of two bodies exactly: so for these the
star has mass 1, H = p²/2 − 1/q, and for the latter −q/4 is an additional force.

An additional force may read the simulation's time; of one that does the documentation says nothing.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

from verify.audits.methods.driver import USUAL_LADDER, integrator_from_script
from verify.audits.methods.integrator import FINE, Point, ReleasedIntegrator

TITLE = "rebound"
LIBRARY = "rebound"
LEFT_OUT = (
    ("BS, MERCURIUS, TRACE", "choose steps or switch by themselves: no map of a fixed h"),
    ("IAS15", "of order 15: its error is rounding in float64 before a power of h shows"),
    ("SEI", "is for the shearing sheet, of two degrees of freedom, with a velocity in its force"),
    ("WHFAST512", "needs AVX-512 and its own set of planets"),
    (
        "WHFAST with correctors or kernels, SABA CM and CL, generalized orders in ε",
        "are for the planets' pull on one another, which one particle does not have",
    ),
)
_FAR_POINTS: tuple[Point, ...] = tuple(
    (Fraction(a), Fraction(b))
    for a, b in (("1/3", "2"), ("-1/4", "5/2"), ("1/5", "3"), ("0", "9/4"))
)
_TIMES = (
    "",
    "",
    "step(0.0, 2.0, 1.0, 0.5)",
    'print("in the step from 1.0 to 1.5 the force is read at", times)',
)
_ONE_POINT: tuple[Point, ...] = ((Fraction(1, 3), Fraction(1, 2)),)
_SOURCE = "the integrator's own documentation, Simulation.integrator.__doc__"


@dataclass(frozen=True)
class _Problem:
    """A problem: `mass` of the star, `softening`, and whether the additional force −q/4 acts."""

    hamiltonian: str
    mass: float
    softening: float
    forced: bool
    description: str
    driven: bool = False

    @property
    def in_time(self) -> "_Problem":
        """The same with cos(6 t/5)/4 as an additional force."""
        formula = f"{self.hamiltonian} - q*cos(6*t/5)/4"
        description = (
            f"{self.description}; and cos(6 t/5)/4 as additional force, t the simulation's time"
        )
        return replace(self, hamiltonian=formula, description=description, driven=True)


# A star of mass 8 at (−3, 0), in whose frame the particle is; the softened one is at 0.
_SOFT_IN_SPACE = "p1**2/2 + p2**2/2 - 8/sqrt(q1**2 + q2**2 + 4)"
_UNSOFTENED = "p1**2/2 + p2**2/2 - 8/sqrt((q1 + 3)**2 + q2**2)"
_PUSHED = f"{_UNSOFTENED} + q1**2/8"
_IN_SPACE = """\
import numpy as np
import rebound


def push(s):
    b = s.contents.particles[1]
    b.ax -= (b.x - 3) / 4


def step(p, q, h):
    s = rebound.Simulation()
    s.integrator = "{name}"
{settings}    away = 0.0 if s.softening else 3.0
    s.add(m=8.0)
    s.add(m=0.0, x=q[0] + away, y=q[1], vx=p[0], vy=p[1])
    s.N_active = 1
    s.dt = h
    s.steps(1)
    s.synchronize()
    a, b = s.particles
    return np.array([b.vx - a.vx, b.vy - a.vy]), np.array([b.x - a.x - away, b.y - a.y])
"""
_SOFT = _Problem(
    "p**2/2 - 8/sqrt(q**2 + 4)", 8.0, 2.0, False,
    "a massless particle on a line through a star of mass 8, softening 2",
)  # fmt: skip
_FREE = _Problem(
    "p**2/2 - 1/q", 1.0, 0.0, False,
    "a massless particle on a line before a star of mass 1",
)  # fmt: skip
_FORCED = _Problem(
    "p**2/2 - 1/q + q**2/8", 1.0, 0.0, True,
    "a massless particle on a line before a star of mass 1, −q/4 as additional force",
)  # fmt: skip


def integrators() -> Iterator[ReleasedIntegrator]:
    for order in (2, 4, 6, 8):
        yield _integrator(_SOFT, "leapfrog", f"LEAPFROG, order {order}", order, f"order = {order}")
    for order in (2, 4, 6, 8, 10):
        yield _integrator(_SOFT, "janus", f"JANUS, order {order}", order, f"order = {order}")
    for name, order in (("LF", 2), ("LF4", 4), ("LF6", 6), ("LF8", 8), ("PMLF4", 4), ("PMLF6", 6)):
        yield _integrator(_FREE, "eos", f"EOS, phi1 = {name}", order, f"phi1 = '{name}'")
    for arguments in _with_forces():
        yield _integrator(_FORCED, *arguments)
    yield from _in_space()
    yield from _in_time()


def _in_space() -> Iterator[ReleasedIntegrator]:
    """Yield one integrator of each kind, in the plane of two coordinates."""
    for name, settings, order in (
        ("leapfrog", "order = 2", 2), ("leapfrog", "order = 4", 4), ("janus", "order = 4", 4),
        ("whfast", "", 2), ("saba", "type = '2'", 2), ("eos", "phi1 = 'LF4'", 4),
    ):  # fmt: skip
        # The others take no softening: the star then stands aside, so that the particle stays away
        # from the singularity.
        softened = name in ("leapfrog", "janus")
        text = _IN_SPACE.replace("{name}", name)
        setting = f"    s.integrator.{settings}\n" if settings else ""
        softening = "    s.softening = 2.0\n" if softened else ""
        push = "" if softened else "    s.additional_forces = push\n"
        if name == "eos":
            push = ""
        text = text.replace("{settings}", setting + softening + push)
        formula = _SOFT_IN_SPACE if softened else _UNSOFTENED if name == "eos" else _PUSHED
        title = f"{name.upper()}{', ' if settings else ''}{settings.replace(' = ', ' ')}"
        yield integrator_from_script(
            f"{title}, two degrees",
            "one step of dt = h: a massless particle before a star of mass 8, in the plane",
            _SOURCE, formula, text, order, True, (), USUAL_LADDER,
        )  # fmt: skip


def _with_forces() -> Iterator[tuple[Any, ...]]:
    """Yield the arguments of those that take additional forces."""
    yield "whfast", "WHFAST", 2
    for name in ("1", "2", "3", "4"):
        yield "saba", f"SABA{name}", 2, f"type = '{name}'"
    for name in ("10_4", "8_6_4", "10_6_4"):
        yield "saba", f"SABA({name.replace('_', ',')})", 4, f"type = '{name}'"


def _in_time() -> Iterator[ReleasedIntegrator]:
    """Yield one of each kind that reads a time by itself, and of each order where that is another
    one."""
    for order in (2, 4):
        yield _driven(_SOFT, "leapfrog", f"LEAPFROG, order {order}", order, f"order = {order}")
        yield _driven(_SOFT, "janus", f"JANUS, order {order}", order, f"order = {order}")
    for name, order in (("LF", 2), ("LF4", 4)):  # additional forces belong to the outer splitting
        settings = f"phi0 = '{name}'", "phi1 = 'LF8'"
        yield _driven(_FREE, "eos", f"EOS, phi0 = {name}, phi1 = LF8", order, *settings)
    for arguments in _with_forces():
        yield _driven(_FORCED, *arguments)


def _driven(problem: _Problem, *arguments: Any) -> ReleasedIntegrator:
    """Build the same with a force that depends on time, of whose order nothing is said."""
    # Nothing is claimed in time: what is measured is reported, and refutes nothing.
    integrator = _integrator(problem.in_time, *arguments)
    script = "\n".join((integrator.reproduction, *_TIMES))
    return replace(integrator, name=f"{integrator.name}, driven", order=None, area_preserving=None,
                   reproduction=script)  # fmt: skip


def _integrator(
    problem: _Problem, integrator: str, name: str, order: int, *settings: str
) -> ReleasedIntegrator:
    points: tuple[Point, ...] = () if problem.softening else _FAR_POINTS
    ladder: tuple[Fraction, ...] = ()
    if order >= 8:
        # A high order shows between steps that are too large for it and rounding: at one place,
        # with a fine ladder.
        points, ladder = (_ONE_POINT if problem.softening else _FAR_POINTS[:1]), FINE
    elif order == 6 and problem is _FREE:
        points, ladder = _FAR_POINTS[3:], tuple(h for h in FINE if h < Fraction(7, 8))
    text = _script(problem, integrator, settings)
    driven = f"one step of dt = h: {problem.description}"
    return integrator_from_script(
        name, driven, _SOURCE, problem.hamiltonian, text, order, True, points, ladder
    )


def _script(problem: _Problem, integrator: str, settings: tuple[str, ...]) -> str:
    forces = [
        *(["    b.ax -= b.x / 4"] if problem.forced else []),
        *(["    b.ax += math.cos(1.2 * s.contents.t) / 4"] if problem.driven else []),
        *(["    times.append(s.contents.t)"] if problem.driven else []),
    ]
    push = ["", "", "def push(s):", "    b = s.contents.particles[1]", *forces]
    lines = [
        *(["import math"] if problem.driven else []),
        "import rebound",
        *(["", "times = []"] if problem.driven else []),
        *(push if forces else ()),
        "",
        "",
        f"def step(p, q, {'t, ' if problem.driven else ''}h):",
        "    s = rebound.Simulation()",
        f"    s.add(m={problem.mass})",
        "    s.add(m=0.0, x=q, vx=p)",
        "    s.N_active = 1",
        f"    s.integrator = {integrator!r}",
        *(f"    s.integrator.{setting}" for setting in settings),
        *([f"    s.softening = {problem.softening}"] if problem.softening else ()),
        *(["    s.t = t"] if problem.driven else ()),
        *(["    s.additional_forces = push"] if forces else ()),
        "    s.dt = h",
        "    s.steps(1)",
        "    s.synchronize()",
        "    a, b = s.particles",
        "    return b.vx - a.vx, b.x - a.x",
    ]
    return "\n".join(lines)
