"""A user's own map, written as formulas: `p_next = p - h*q; q_next = q + h*p_next`.

The formulas may use p, q, h, the parameters of H, and t where H depends on it; q_next may use
p_next. In n degrees of freedom they are p1_next … qn_next, each of which may use those that are
written before it. The map claims consistency (order 1) and nothing else; what it has is proved, not
believed.
"""

import re
from collections.abc import Mapping

from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.schemes.scheme import Scheme
from verify.schemes.step_map import StepMap

_FORM = "write it as 'p_next = …; q_next = …', or as 'kick 1/2; drift 1; kick 1/2'"
_NUMBERED = re.compile(r"[pq][1-9]\d{0,2}_next", re.ASCII)
EXAMPLES = ()  # its names are the users' own


def make(name: str) -> Scheme | None:
    """The scheme for a text with `=`; InputError unless it defines p_next and q_next, once each."""
    if "=" not in name:
        return None
    parts = [part.partition("=") for part in name.split(";") if part.strip()]
    formulas = {left.strip(): right.strip() for left, _, right in parts}
    if len(formulas) == len(parts) and all(map(_NUMBERED.fullmatch, formulas)):
        return _in_degrees(formulas)
    if len(parts) != 2 or set(formulas) != {"p_next", "q_next"}:
        raise InputError("scheme", name, _FORM)
    p_next, q_next = formulas["p_next"], formulas["q_next"]
    return Scheme(
        name=f"p_next = {p_next}; q_next = {q_next}",
        order=1,
        area_preserving=False,
        explicit=True,
        symmetric=False,
        source="the user's formulas",
        build=lambda hamiltonian: StepMap.from_formulas(hamiltonian, p_next, q_next),
        formulas=formulas,
    )


def _in_degrees(formulas: Mapping[str, str]) -> Scheme:
    written = "; ".join(f"{name} = {formula}" for name, formula in formulas.items())

    def refuse(hamiltonian: Hamiltonian) -> StepMap:
        needed = "p_next and q_next" if hamiltonian.planar else ", ".join(hamiltonian.coordinates)
        raise InputError(
            "scheme", written, f"H has other coordinates; allowed: formulas of {needed}"
        )

    return Scheme(
        name=written,
        order=1,
        area_preserving=False,
        explicit=True,
        symmetric=False,
        source="the user's formulas",
        build=refuse,
        formulas=formulas,
    )
