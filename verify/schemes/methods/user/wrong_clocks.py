"""A scheme with a wrong clock, for comparison: `forest-ruth, clock frozen`, `rk4, clock frozen`.

Without time it is the same scheme. If H depends on time it reads

- `frozen`: every part or stage at the step's start;
- `at the end`: every part or stage at the step's end;
- `exchanged`: each part of a splitting at the sum of the parts of its own kind before it, in place
  of the other kind.

It claims the order of the scheme with its right clocks, which a proof refutes. `lieη` with such a
clock is the Taylor polynomial of the flow of H at that fixed time.
"""

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import partial
from itertools import count

import sympy

from verify.algebra.formula import symbol
from verify.algebra.symbols import H_STEP
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.schemes.conditions.every_hamiltonian import RungeKutta, TaylorSeries
from verify.schemes.conditions.splitting_conditions import Part, Splitting, sums_before
from verify.schemes.maps.formula_map import map_from_expressions
from verify.schemes.maps.kinds import explicit_runge_kutta
from verify.schemes.maps.step_map import StepMap
from verify.schemes.methods.taylor.lie import lie_map
from verify.schemes.scheme import Scheme
from verify.schemes.splitting import splitting

EXAMPLES = ()  # names are texts that users write
_NAME = re.compile(r"\s*(?P<base>[^,;]+?)\s*,\s*clock\s+(?P<clock>.*\S)\s*")


def make(name: str) -> Scheme | None:
    """Return the scheme for a text `NAME, clock HOW`; None for another text.

    Raises InputError for a scheme without clocks, and for an unknown HOW.
    """
    from verify.schemes import get

    match = _NAME.fullmatch(name)
    if match is None:
        return None
    base, how = get(match["base"]), " ".join(match["clock"].split())
    clocks = _CLOCKS if isinstance(base.every_h, Splitting) else _STANDING
    if not isinstance(base.every_h, Splitting | RungeKutta | TaylorSeries):
        problem = f"{base.name} has no such clocks; splittings, explicit stages and lieη do"
        raise InputError("scheme", name, problem)
    if how not in clocks:
        raise InputError("scheme", name, f"clock {how}: unknown; allowed: {', '.join(clocks)}")
    if not isinstance(base.every_h, Splitting):
        return replace(
            base,
            name=f"{base.name}, clock {how}",
            source=f"{base.source}; with a wrong clock",
            build=partial(_with_standing_clock, base.every_h, _STANDING[how]),
            every_h=None,
        )
    parts = base.every_h.parts
    return splitting(
        f"{base.name}, clock {how}",
        parts,
        order=base.order,
        symmetric=False,
        source=f"{base.source}; with a wrong clock",
        times=tuple(_CLOCKS[how](parts)),
    )


def _with_standing_clock(
    every_h: RungeKutta | TaylorSeries, clock: int, hamiltonian: Hamiltonian
) -> StepMap:
    """Return the map of H at the fixed time t + `clock` h."""
    if isinstance(every_h, RungeKutta):
        return explicit_runge_kutta.build(every_h, hamiltonian, standing=Fraction(clock))
    if not hamiltonian.time_dependent:
        return lie_map(hamiltonian, every_h.eta)
    t, names = symbol("t"), hamiltonian.symbols
    instant = symbol(next(n for n in map("instant{}".format, count()) if n not in names))
    still = lie_map(Hamiltonian(hamiltonian.exact.xreplace({t: instant})), every_h.eta)
    exact = [x.xreplace({instant: t + clock * H_STEP}) for x in still.composed]
    return map_from_expressions(hamiltonian, exact)


_STANDING = {"frozen": 0, "at the end": 1}  # the fixed time of a clock, in parts of h
_CLOCKS: Mapping[str, Callable[[Sequence[Part]], Sequence[sympy.Expr]]] = {
    "frozen": lambda parts: (sympy.S.Zero,) * len(parts),
    "at the end": lambda parts: (sympy.S.One,) * len(parts),
    "exchanged": lambda parts: sums_before(parts, sympy.S.Zero, same_kind=True),
}
