"""Steps of other libraries by a few lines of Python that call them; these lines are also shown.

The systems on which steps are tried are H = p²/2 + V(q, t), which every kind of step takes. There
are two of each kind, as one may show a mistake that the other does not.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import partial
from typing import Any

from verify.audits.methods.integrator import FloatStep, Map, ReleasedIntegrator
from verify.hamiltonians.hamiltonian import Hamiltonian

_HIGH_ORDER = 5  # from this order on, few points and a fine ladder of step sizes show more
_RETURN_LINE = {
    1: "return float(np.ravel(p)[0]), float(np.ravel(q)[0])",
    2: "return np.ravel(p), np.ravel(q)",
}


@dataclass(frozen=True)
class ScriptedProblem:
    """A system on which steps are tried, with its force.

    `description`: a noun phrase for people. `formula`: that of H. `force`: lines of Python that
    define force(t, q) of an array q, with numpy as np. `tag`: the end of a method's name.
    """

    description: str
    formula: str
    force: str
    tag: str = ""

    @property
    def hamiltonian(self) -> Hamiltonian:
        """The Hamiltonian H."""
        return Hamiltonian.parse(self.formula)

    @property
    def depends_on_time(self) -> bool:
        """True if the force depends on time."""
        return self.hamiltonian.time_dependent

    @property
    def degrees(self) -> int:
        """The degrees of freedom."""
        return self.hamiltonian.degrees

    @property
    def arguments(self) -> str:
        """The arguments of a step for this system."""
        return "p, q, t, h" if self.depends_on_time else "p, q, h"


# Lines of a step: the field of z' = f(t, z) for z = (q, p), and z itself.
FIELD = """\
def field(t, y):
    q, p = np.split(y, 2)
    return np.concatenate([p, force(t, q)])
y = np.hstack([q, p])
"""


def _force(line: str) -> str:
    return f"def force(t, q):\n    return {line}\n"


PENDULUM = ScriptedProblem("a pendulum", "p**2/2 - cos(q)", _force("-np.sin(q)"))
TWO_WAVES = ScriptedProblem(
    "a particle in a potential of two waves",
    "p**2/2 - 2*cos(q) - sin(2*q)/2",
    _force("np.cos(2 * q) - 2 * np.sin(q)"),
)
DRIVEN = ScriptedProblem(
    "a driven pendulum",
    "p**2/2 - cos(q) - q*cos(2*t)/2",
    _force("np.cos(2 * t) / 2 - np.sin(q)"),
    ", driven",
)
SWUNG = ScriptedProblem(
    "an oscillator with a stiffness that depends on time",
    "p**2/2 + (1 + sin(t)/2)*(q**2/2 + q**4/4)",
    _force("-(1 + np.sin(t) / 2) * (q + q**3)"),
    ", driven",
)
HENON_HEILES = ScriptedProblem(
    "Hénon and Heiles's system",
    "p1**2/2 + p2**2/2 + q1**2/2 + q2**2/2 + q1**2*q2 - q2**3/3",
    _force("np.array([-q[0] - 2 * q[0] * q[1], -q[1] - q[0] ** 2 + q[1] ** 2])"),
    ", two degrees",
)
COUPLED = ScriptedProblem(
    "two coupled oscillators of degree 4",
    "p1**2/2 + p2**2/2 + q1**4/4 + q2**2 + q1**2*q2**2/2",
    _force("np.array([-(q[0] ** 3) - q[0] * q[1] ** 2, -2 * q[1] - q[0] ** 2 * q[1]])"),
    ", two degrees",
)
PROBLEMS = TWO_WAVES, DRIVEN, HENON_HEILES
# The second problem of the same kind, for a second look.
SECOND_PROBLEMS = {TWO_WAVES: PENDULUM, DRIVEN: SWUNG, HENON_HEILES: COUPLED}
# The usual points (p, q) at which a step is tried.
POINTS = tuple(
    (Fraction(p), Fraction(q))
    for p, q in (("1/3", "3/5"), ("-1/2", "7/8"), ("1/7", "6/5"), ("3/4", "-2/5"), ("-1/5", "-2/5"))
)
# At these points a high order shows in float64, for steps between too large ones and rounding.
POINTS_OF_HIGH_ORDER = ((Fraction(5, 4), Fraction(-1, 2)), (Fraction(-1, 3), Fraction(9, 8)))
LONG_LADDER = tuple(Fraction(k, 64) for k in (*range(64, 16, -4), *range(16, 3, -1)))
USUAL_LADDER = tuple(
    Fraction(x, 2**k) for k in range(3, 16) for x in ((4, 3) if k < 10 else (4,))
)  # fmt: skip


# -- steps ----------------------------------------------------------------------------------------


def step_of(text: str) -> Map:
    """Run lines of Python, and return the step(p, q, h), or step(p, q, t, h), that they define.

    The lines are our own: no text from elsewhere is in them. Raises what the library raises.
    """
    names: dict[str, Any] = {}
    exec(compile(text, "<the lines shown>", "exec"), names)  # noqa: S102 - our own text
    step: Map = names["step"]
    return step


@dataclass(frozen=True)
class Driver:
    """The lines of Python that call the step of a library.

    `head`: the imports, with numpy as np, and the definitions beside force(t, q). `body`: the lines
    of a step, from arrays p and q, and t and h, to p and q; `{method}` stands for the method.
    `description`: one sentence.
    """

    head: str
    body: str
    description: str

    def script(self, problem: ScriptedProblem, method: str) -> str:
        """Return the lines for one problem and one method."""
        begin = [] if problem.depends_on_time else ["t = 0.0"]
        inside = [*begin, *self.body.strip().splitlines(), _RETURN_LINE[problem.degrees]]
        lines = [
            self.head.replace("{method}", method).strip(),
            "",
            "",
            problem.force.strip(),
            "",
            "",
            f"def step({problem.arguments}):",
            *(f"    {line}".rstrip().replace("{method}", method) for line in inside),
        ]
        return "\n".join(lines) + "\n"


def integrator_from_script(
    name: str,
    driven: str,
    source: str,
    formula: str,
    text: str,
    order: int | None,
    symplectic: bool | None = None,
    points: Sequence[tuple[Fraction, ...]] = (),
    ladder: Sequence[Fraction] = (),
) -> ReleasedIntegrator:
    """Build the integrator whose step the lines of `text` define, which also reproduce it."""
    step = FloatStep(formula, partial(step_of, text), tuple(points), tuple(ladder))
    return ReleasedIntegrator(name, driven, source, step, order, symplectic, text)


def drive_problems(
    name: str,
    driven: Driver,
    method: str,
    source: str,
    order: int | None,
    symplectic: bool | None = None,
    problems: Iterable[ScriptedProblem] = PROBLEMS,
) -> Iterator[ReleasedIntegrator]:
    """Yield one integrator for each problem."""
    for problem in problems:
        first, second = (
            integrator_from_script(
                f"{name}{each.tag}", f"{driven.description}, for {each.description}", source,
                each.formula, driven.script(each, method), order,
                symplectic if each is not DRIVEN else None,
                *_points_and_ladder(each, order or 0),
            )
            for each in (problem, SECOND_PROBLEMS[problem])
        )  # fmt: skip
        yield replace(first, second_step=second.method)


def _points_and_ladder(
    problem: ScriptedProblem, order: int
) -> tuple[Sequence[tuple[Fraction, ...]], Sequence[Fraction]]:
    """Return the points and the step sizes at which an order of this height shows."""
    high = order >= _HIGH_ORDER
    points = (POINTS_OF_HIGH_ORDER if high else POINTS[:2]) if problem.degrees == 1 else ()
    return points, LONG_LADDER if high else USUAL_LADDER
