"""What one step of a kernel executes: its operations, counted as they are written in its loop."""

from collections import Counter

from verify.generic import RungeKutta, StageEquations
from verify.kernel import Kernel
from verify.scheme import Scheme
from verify.work_precision_results import CostResult


def cost(kernel: Kernel, scheme: Scheme) -> CostResult:
    """Operations of one step that carries the state alone, those before the loop left out.

    Adding the increments to p and q counts; a change of sign does not.
    """
    program = kernel.lowering.program
    live = kernel.lowering.live([kernel.outputs["dp"], kernel.outputs["dq"]])
    inside = [index for index in live if not program.static[index]]
    kinds = Counter(program.ops[index].kind for index in inside)
    called = (kernel.lowering.function(index) for index in inside)
    functions = Counter(name for name in called if name)
    return CostResult(
        additions=kinds["add"] + kinds["sub"] + 2,
        multiplications=kinds["mul"],
        divisions=kinds["inverse"],
        functions=dict(sorted(functions.items())),
        gradient=gradient(scheme),
    )


def gradient(scheme: Scheme) -> dict[str, int] | None:
    """Evaluations of H_p and of H_q in a step, for schemes that are made of such."""
    generic = scheme.generic
    if isinstance(generic, RungeKutta):
        return dict.fromkeys(("H_p", "H_q"), len(generic.weights))
    if isinstance(generic, StageEquations) and scheme.explicit:
        return {
            "H_p": sum(stage.drift != 0 for stage in generic.stages),
            "H_q": sum(stage.kick != 0 for stage in generic.stages),
        }
    return None
