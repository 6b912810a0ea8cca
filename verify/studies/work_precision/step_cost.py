"""What one step of a kernel executes: its operations, counted as they are written in its loop."""

from collections import Counter
from collections.abc import Sequence

from verify.kernels.kernel import Kernel
from verify.kernels.step.lowering import Lowering
from verify.scenes.results.work_precision import CostResult
from verify.schemes.scheme import Scheme

_CALL = "call "  # before a function's name, among the kinds of operations


def cost(kernel: Kernel, scheme: Scheme) -> CostResult:
    """Operations of one step that carries the state alone, those before the loop left out.

    Adding the increments to the coordinates counts; a change of sign does not.
    """
    lowering, roots = kernel.lowering, [kernel.outputs[f"d{name}"] for name in kernel.coordinates]
    turn: Counter[str] = Counter()
    for loop in lowering.loops(lowering.live(roots)):
        turn += _counted(lowering.inner(loop), loop.updates) + Counter(add=len(loop.updates))
    counted = _counted(lowering, roots) + Counter(add=len(roots))
    return _result(counted, scheme.evaluations, _result(turn, None, None) if turn else None)


def _counted(lowering: Lowering, roots: Sequence[int]) -> "Counter[str]":
    """Operations and functions by their names."""
    program = lowering.program
    inside = [index for index in lowering.live(roots) if not program.static[index]]
    called = [name for index in inside if (name := lowering.function(index))]
    return Counter(program.ops[i].kind for i in inside) + Counter(f"{_CALL}{f}" for f in called)


def _result(
    counted: "Counter[str]", gradient: dict[str, int] | None, turn: CostResult | None
) -> CostResult:
    functions = {n.removeprefix(_CALL): k for n, k in counted.items() if n.startswith(_CALL)}
    return CostResult(
        additions=counted["add"] + counted["sub"],
        multiplications=counted["mul"],
        divisions=counted["inverse"],
        functions=dict(sorted(functions.items())),
        gradient=gradient,
        turn=turn,
    )
