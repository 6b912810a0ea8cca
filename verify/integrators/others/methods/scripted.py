"""A step of someone else's library by the few lines that drive it: what is shown is what is run."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

from verify.integrators.others.methods.integrator import FloatStep, Map, ReleasedIntegrator
from verify.integrators.others.methods.problems import (
    AGAIN,
    AWAY,
    DRIVEN,
    EACH,
    LONG,
    POINTS,
    USUAL,
    Problem,
)

_HIGH = 5  # an order of which few points and a fine ladder tell more
_END = {
    1: "return float(np.ravel(p)[0]), float(np.ravel(q)[0])",
    2: "return np.ravel(p), np.ravel(q)",
}


@dataclass(frozen=True)
class Script:
    """Lines of Python that define step(p, q, h), or step(p, q, t, h), with nothing but the library
    that they import. They are ours: nothing that is read from elsewhere is in them."""

    text: str

    def step(self) -> Map:
        """Raises what the library raises."""
        names: dict[str, Any] = {}
        exec(compile(self.text, "<the lines shown>", "exec"), names)  # noqa: S102 - our own text
        made: Map = names["step"]
        return made


@dataclass(frozen=True)
class Driven:
    """How the steps of a library are driven.

    `head`: what its lines import, numpy as np among it, and define beside force(t, q). `body`: the
    lines of a step, from p, q, t and h, of arrays, to p and q; `{method}` stands for the method.
    `said`: one sentence.
    """

    head: str
    body: str
    said: str

    def script(self, problem: Problem, method: str) -> str:
        """The lines for one problem and one method."""
        begin = [] if problem.timed else ["t = 0.0"]
        inside = [*begin, *self.body.strip().splitlines(), _END[problem.degrees]]
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


def by_script(
    name: str,
    driven: str,
    source: str,
    hamiltonian: str,
    text: str,
    order: int | None,
    symplectic: bool | None = None,
    points: Sequence[tuple[Fraction, ...]] = (),
    ladder: Sequence[Fraction] = (),
) -> ReleasedIntegrator:
    """The integrator whose step the lines of `text` define, which are what is shown of it."""
    step = FloatStep(hamiltonian, Script(text).step, tuple(points), tuple(ladder))
    return ReleasedIntegrator(name, driven, source, step, order, symplectic, text)


def scripted(
    name: str,
    driven: Driven,
    method: str,
    source: str,
    order: int | None,
    symplectic: bool | None = None,
    problems: Iterable[Problem] = EACH,
) -> Iterator[ReleasedIntegrator]:
    """One for each problem."""
    for problem in problems:
        first, second = (
            by_script(
                f"{name}{each.tag}", f"{driven.said}, for {each.said}", source, each.hamiltonian,
                driven.script(each, method), order, symplectic if each is not DRIVEN else None,
                *_where(each, order or 0),
            )
            for each in (problem, AGAIN[problem])
        )  # fmt: skip
        yield replace(first, again=second.method)


def _where(
    problem: Problem, order: int
) -> tuple[Sequence[tuple[Fraction, ...]], Sequence[Fraction]]:
    """Points and steps with which an order is seen."""
    high = order >= _HIGH
    points = (AWAY if high else POINTS[:2]) if problem.degrees == 1 else ()
    return points, LONG if high else USUAL
