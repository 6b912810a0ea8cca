"""The operations that one step of a kernel executes, counted as its loop contains them."""

from collections import Counter
from collections.abc import Sequence

from verify.kernels.kernel import Kernel
from verify.kernels.step.lowering import Lowering
from verify.scenes.results.work_precision import CostResult
from verify.schemes.scheme import Scheme

_CALL = "call "  # before a function's name, among the kinds of operations


def count_cost(kernel: Kernel, scheme: Scheme) -> CostResult:
    """Count the operations of one step of the state alone, without those before the loop.

    Adding the increments to the coordinates counts; a change of sign does not.
    """
    lowering, roots = kernel.lowering, [kernel.outputs[f"d{name}"] for name in kernel.coordinates]
    turn: Counter[str] = Counter()
    # One turn of the loops that solve equations is counted apart, as their number varies.
    for loop in lowering.loops(lowering.live(roots)):
        turn += _count_operations(lowering.inner(loop), loop.updates) + Counter(
            add=len(loop.updates)
        )
    operations = _count_operations(lowering, roots) + Counter(add=len(roots))
    return _build_result(
        operations, scheme.evaluations, _build_result(turn, None, None) if turn else None
    )


def _count_operations(lowering: Lowering, roots: Sequence[int]) -> "Counter[str]":
    """Count operations and functions by their names."""
    program = lowering.program
    inside = [index for index in lowering.live(roots) if not program.static[index]]
    functions = [name for index in inside if (name := lowering.function(index))]
    return Counter(program.ops[i].kind for i in inside) + Counter(f"{_CALL}{f}" for f in functions)


def _build_result(
    operations: "Counter[str]", gradient: dict[str, int] | None, turn: CostResult | None
) -> CostResult:
    functions = {n.removeprefix(_CALL): k for n, k in operations.items() if n.startswith(_CALL)}
    return CostResult(
        additions=operations["add"] + operations["sub"],
        multiplications=operations["mul"],
        divisions=operations["inverse"],
        functions=dict(sorted(functions.items())),
        gradient=gradient,
        turn=turn,
    )
