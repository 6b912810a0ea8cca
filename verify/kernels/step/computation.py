"""What one step of a kernel computes, whatever the numbers: a step map → a straight-line program.

It depends on the map, and on what is asked of it, but on no precision and on no number system
beyond `Asked`. So it is made once for a map, and shared by the runs of it.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache

from verify.algebra.ring import Poly
from verify.hamiltonians.coordinates import PLANE
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.step.increments import increments
from verify.kernels.step.program import Evaluator, Program
from verify.kernels.step.tangent_map import Tangent, product
from verify.schemes import get
from verify.schemes.step_map import StepMap, Substep, h_inside


@dataclass(frozen=True)
class Observed:
    """ΔJ; the determinant of the four entries; A − 1 of the tangent map; in n degrees of freedom
    the entries of S, and M and W; see `verify.kernels.statements`.

    `scaled`: ΔJ is divided by the power of h that it has, and multiplied by κ. `pipelined` as in
    `verify.arithmetic.number_system.Arithmetic`.
    """

    pipelined: bool
    scaled: bool
    delta_j: bool
    determinant: bool
    tangent: bool
    symplectic: bool = False
    carried: bool = False


@dataclass(frozen=True, eq=False)
class Computation:
    """`outputs`: the indices of the increments of p and q, `dp` and `dq`, of ΔJ, `dj`, and of det J
    where it is asked for, `det`; of M's and W's entries, too. `power` is the r of κ; `parameters`
    are those of H; `timed` says whether it depends on t, which is one more input then.
    `coordinates` name the state; `defect` has the entries of S that are asked for. Nobody writes
    into the program any more.
    """

    program: Program
    outputs: Mapping[str, int]
    tangent: Tangent | None
    power: int
    parameters: tuple[str, ...]
    timed: bool
    coordinates: tuple[str, ...]
    defect: Mapping[str, int]

    @property
    def matrix(self) -> list[str]:
        """The names of M's entries, where it is carried."""
        return [name[1:] for name in self.outputs if name.startswith("dm_")]

    @property
    def roots(self) -> list[int]:
        """What is read of the program's values."""
        needed = self.tangent.needed if self.tangent else ()
        return [*self.outputs.values(), *self.defect.values(), *needed]


def step_map_of(hamiltonian: Hamiltonian, scheme: str) -> StepMap:
    """The scheme's map of a Hamiltonian; the same one for the next that asks."""
    return get(scheme).step_map(hamiltonian)


@lru_cache(maxsize=64)
def _first_part(
    step_map: StepMap, pipelined: bool, scaled: bool, delta_j: bool
) -> tuple[Evaluator, Mapping[str, int], int]:
    """What all that is asked of a map has in common: ΔJ is the longest part of it.

    What wrote it, to be copied, the inputs by their names, and ΔJ of the first substep.
    """
    program = Program()
    # A user's parameter may be named like anything; in the source it is x0, x1, ….
    parameters = step_map.hamiltonian.symbols
    arguments = {"h": "h"} | {n: f"x{k}" for k, n in enumerate(parameters)}
    named = {n: program.input(a, static=True) for n, a in arguments.items()}
    found = program.constant(Fraction(0))
    time = ("t",) if step_map.hamiltonian.time_dependent else ()
    named |= {n: program.input(n, static=False) for n in (*PLANE, *time)}
    if scaled:
        program.input("kappa", static=True)
    first = step_map.substeps[0]
    evaluator = Evaluator(program, first.ring, named, pipelined)
    if delta_j and not first.preserves_area:
        found = _delta_j(evaluator, first, scaled, common_power(step_map, scaled))
    return evaluator, named, found


@lru_cache(maxsize=64)
def computed(step_map: StepMap, asked: Observed) -> Computation:
    """What is asked of a map, made once as long as it is among the last ones."""
    power = common_power(step_map, asked.scaled)
    begun, named, delta_j = _first_part(step_map, asked.pipelined, asked.scaled, asked.delta_j)
    evaluator = begun.copy()
    program = evaluator.program
    tangent = Tangent(program) if asked.tangent else None
    total = dict.fromkeys(PLANE, program.constant(Fraction(0)))
    jacobian = None
    for k, step in enumerate(step_map.substeps):
        if k > 0:
            at = {n: program.add(named[n], total[n]) for n in PLANE}
            evaluator = Evaluator(program, step.ring, {**named, **at}, asked.pipelined)
        if k > 0 and asked.delta_j and not step.preserves_area:
            own = _delta_j(evaluator, step, asked.scaled, power)
            both = program.mul(delta_j, own)
            if asked.scaled and not program.is_constant(both, 0):
                both = program.mul(program.input("down", static=True), both)
            delta_j = program.add(program.add(delta_j, own), both)
        if asked.determinant:
            own_j = [evaluator.evaluate(entry) for entry in step.jacobian]
            jacobian = own_j if jacobian is None else product(program, own_j, jacobian)
        if tangent:
            tangent.follow(step, evaluator)
        changes = increments(evaluator, step.ring, step.increments, named["h"])
        for n, change in zip(PLANE, changes, strict=True):
            total[n] = program.add(total[n], change)
    result = {"dp": total["p"], "dq": total["q"], "dj": delta_j}
    if jacobian is not None:
        a, b, c, d = jacobian
        minus = program.neg(program.mul(b, c))
        result["det"] = program.add(program.mul(a, d), minus)
    exact = step_map.hamiltonian
    timed = exact.time_dependent
    return Computation(program, result, tangent, power, exact.symbols, timed, PLANE, {})


def _delta_j(evaluator: Evaluator, step: Substep, scaled: bool, power: int) -> int:
    """ΔJ of a substep, or 2^s ΔJ by κ (ΔJ/h^r)."""
    scale = evaluator.program.input("kappa", static=True) if scaled else None
    return evaluator.evaluate(divided(step, power), scale)


def common_power(step_map: StepMap, scaled: bool = True) -> int:
    """The greatest r for which h^r divides ΔJ of every substep; 0 where it is not divided."""
    changing = [step for step in step_map.substeps if scaled and not step.preserves_area]
    return min(map(lowest_power, changing), default=0)


def lowest_power(step: Substep) -> int:
    """The greatest r for which h^r divides ΔJ; 0 where h stands inside a function."""
    if h_inside(step.ring, step.p_next, step.q_next):
        return 0
    return min(step.ring.powers(step.delta_j, "h"))


def divided(step: Substep, power: int) -> Poly:
    """ΔJ / h^power, where that divides it."""
    if power == 0:
        return step.delta_j
    h = step.ring.variable("h")
    parts = step.ring.powers(step.delta_j, "h")
    return sum((h ** (n - power) * x for n, x in parts.items()), step.ring.zero)
