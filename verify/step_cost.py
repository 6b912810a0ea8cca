"""What one step of a kernel executes: its operations, counted as they are written in its loop."""

from collections import Counter
from collections.abc import Sequence

from verify.generic import RungeKutta, StageEquations
from verify.kernel import Kernel
from verify.lowering import Lowering
from verify.proof.splitting_conditions import Splitting
from verify.scheme import Scheme
from verify.work_precision_results import CostResult


def cost(kernel: Kernel, scheme: Scheme) -> CostResult:
    """Operations of one step that carries the state alone, those before the loop left out.

    Adding the increments to p and q counts; a change of sign does not.
    """
    lowering, roots = kernel.lowering, [kernel.outputs["dp"], kernel.outputs["dq"]]
    counted = _counted(lowering, roots, added=2)
    loops = lowering.loops(lowering.live(roots))
    turns = [
        _counted(lowering.inner(loop), loop.updates, added=len(loop.updates)) for loop in loops
    ]
    turn = None if not turns else _sum(turns)
    return counted.model_copy(update={"gradient": gradient(scheme), "turn": turn})


def _counted(lowering: Lowering, roots: Sequence[int], added: int) -> CostResult:
    program = lowering.program
    inside = [index for index in lowering.live(roots) if not program.static[index]]
    kinds = Counter(program.ops[index].kind for index in inside)
    called = (lowering.function(index) for index in inside)
    functions = Counter(name for name in called if name)
    return CostResult(
        additions=kinds["add"] + kinds["sub"] + added,
        multiplications=kinds["mul"],
        divisions=kinds["inverse"],
        functions=dict(sorted(functions.items())),
        gradient=None,
    )


def _sum(parts: Sequence[CostResult]) -> CostResult:
    functions: Counter[str] = Counter()
    for part in parts:
        functions.update(part.functions)
    return CostResult(
        additions=sum(part.additions for part in parts),
        multiplications=sum(part.multiplications for part in parts),
        divisions=sum(part.divisions for part in parts),
        functions=dict(sorted(functions.items())),
        gradient=None,
    )


def gradient(scheme: Scheme) -> dict[str, int] | None:
    """Evaluations of H_p and of H_q in a step, for schemes that are made of such."""
    generic = scheme.generic
    if isinstance(generic, RungeKutta):
        return dict.fromkeys(("H_p", "H_q"), len(generic.weights))
    if isinstance(generic, Splitting):
        kinds = Counter(kind for kind, _ in generic.parts)
        return {"H_p": kinds["drift"], "H_q": kinds["kick"]}
    if isinstance(generic, StageEquations) and scheme.explicit:
        return {
            "H_p": sum(stage.drift != 0 for stage in generic.stages),
            "H_q": sum(stage.kick != 0 for stage in generic.stages),
        }
    return None
