"""Whether our numbers make of a user's step what his floats make of it."""

from collections.abc import Callable, Sequence
from fractions import Fraction

from verify.integrators.probe import Trial, dual_step
from verify.integrators.step import Step
from verify.integrators.tracing.dual import Dual, Duals
from verify.integrators.tracing.functions import copied
from verify.integrators.tracing.number import UntraceableError
from verify.integrators.tracing.trace import Node, in_order, through
from verify.prose import read_prose

Lifted = Callable[[Dual, Dual, Dual], Sequence[Dual]]  # (p, q, h) ↦ p', q'
_SIZES = Fraction(1, 8), Fraction(1, 64)
_AGREES = 1e-10
_ENDS_ELSEWHERE = 1e-6  # where values are compared, as a loop's tolerance may with duals


def by_graph(kind: Duals, p_next: Node, q_next: Node) -> Lifted:
    nodes = in_order(p_next, q_next)

    def at(p: Dual, q: Dual, h: Dual) -> tuple[Dual, Dual]:
        start = {"p": p, "q": q, "h": h}

        def number(node: Node, x: list[Dual]) -> Dual:
            match node.operation:
                case "symbol":
                    return start[node.value]
                case "number":
                    return kind.rational(node.value)
                case "pi":
                    return kind.pi()
                case "power":
                    return x[0].raised(node.value)
                case "add" | "subtract" | "multiply" | "divide" as name:
                    return x[0].combined(name, x[1])
                case name:
                    return x[0].applied(name)

        made = through(nodes, number)
        return made[p_next.number], made[q_next.number]

    return at


def by_duals(step: Step) -> Callable[[Duals], Lifted]:
    def made(kind: Duals) -> Lifted:
        function = copied(step.function, kind)
        return lambda p, q, h: dual_step(step, function, p, q, h)

    return made


def must_agree(trial: Trial, made: Callable[[Duals], Lifted]) -> None:
    """UntraceableError where our numbers and the user's floats part at a point.

    So it is where the code keeps a state, or takes another branch with floats.
    """
    kind, compared = Duals(), 0
    with kind.running():
        at = made(kind)
        for point in trial.points:
            for h in _SIZES:
                try:
                    mine = trial.step.at(float(point[0]), float(point[1]), float(h))
                except Exception:  # noqa: S112 - it fails there; other points may do
                    continue
                theirs = [x.value for x in at(*kind.state(*point), kind.rational(h))]
                compared += 1
                reach = 1 + max(map(abs, mine))
                near = _ENDS_ELSEWHERE if kind.compared else _AGREES
                if any(abs(x - y) > near * reach for x, y in zip(mine, theirs, strict=True)):
                    where = f"p = `{point[0]}`, q = `{point[1]}`, h = `{h}`"
                    raise UntraceableError(
                        read_prose(f"with floats it does something else, at {where}")
                    )
    if not compared:
        raise UntraceableError("it fails at every point that is tried")
