"""The part that all computations of one map share: its inputs, and S in closed form."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import combinations

from verify.algebra.ring import Poly
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.step.evaluator import Evaluator
from verify.kernels.step.matrix_operations import Place
from verify.kernels.step.operations import StepProgram
from verify.schemes.maps.closed_form import ClosedForm
from verify.schemes.maps.step_map import StepMap


def source_names(hamiltonian: Hamiltonian) -> tuple[str, ...]:
    """Return the names of the coordinates in a kernel's source and notes: z1, z2, … for equations,
    whose own may be any, also those of other values there."""
    names = hamiltonian.coordinates
    return names if hamiltonian.has_energy else tuple(f"z{k}" for k in range(1, len(names) + 1))


@dataclass(frozen=True)
class SharedPart:
    """The part that all computations of one map share, since S in closed form takes longest: a
    program to be copied, and the indices of its inputs and of the entries of S."""

    program: StepProgram
    inputs: Mapping[str, int]
    forms: Mapping[Place, int]


@lru_cache(maxsize=64)
def shared_part(step_map: StepMap, pipelined: bool, scaled: bool, defect: bool) -> SharedPart:
    """Return the part for such requests, which is cached."""
    program, hamiltonian = StepProgram(), step_map.hamiltonian
    # In the source H's parameters are x0, x1, …: a user may call a parameter `v1` or `steps`.
    arguments = {"h": "h"} | {n: f"x{k}" for k, n in enumerate(hamiltonian.symbols)}
    inputs = {n: program.input(a, static=True) for n, a in arguments.items()}
    dynamic = dict(zip(hamiltonian.coordinates, source_names(hamiltonian), strict=True))
    dynamic |= {"t": "t"} if hamiltonian.time_dependent else {}
    inputs |= {n: program.input(a, static=False) for n, a in dynamic.items()}
    kappa = program.input("kappa", static=True) if scaled else None
    closed_form = step_map.written_defect
    forms: dict[Place, int] = {}
    if defect and closed_form and not step_map.preserves_area:
        evaluator = Evaluator(program, step_map.ring, inputs, pipelined)
        power = common_power(step_map) if scaled else 0
        for place in combinations(range(len(hamiltonian.coordinates)), 2):
            forms[place] = evaluator.evaluate(sum_of(closed_form, [place], power), kappa)
    return SharedPart(program, inputs, forms)


def common_power(step_map: StepMap) -> int:
    """Return the greatest r for which h^r divides all of S in closed form; 0 if there is none, or
    the map preserves area."""
    closed_form = step_map.written_defect
    return (
        min(closed_form.forms or {}, default=0)
        if closed_form and not step_map.preserves_area
        else 0
    )


def sum_of(closed_form: ClosedForm, places: Sequence[Place], power: int) -> Poly:
    """Return the sum of the entries of S at these places, divided by h^power."""
    h, total = closed_form.ring.variable("h"), closed_form.ring.zero
    for m, form in (closed_form.forms or {}).items():
        for place in places:
            if place in form.entries:
                total += h ** (m - power) * form.entries[place]
    return total
