"""A user's own map, written as formulas: `p_next = p - h*q; q_next = q + h*p_next`.

The formulas may use p, q, h, the parameters of H, and t where H depends on it; q_next may use
p_next. The map claims consistency (order 1) and nothing else; what it has is proved, not believed.
"""

from verify.errors import InputError
from verify.schemes.scheme import Scheme
from verify.schemes.step_map import StepMap

_FORM = "write it as 'p_next = …; q_next = …', or as 'kick 1/2; drift 1; kick 1/2'"
EXAMPLES = ()  # its names are the users' own


def make(name: str) -> Scheme | None:
    """The scheme for a text with `=`; InputError unless it defines p_next and q_next, once each."""
    if "=" not in name:
        return None
    parts = [part.partition("=") for part in name.split(";") if part.strip()]
    formulas = {left.strip(): right.strip() for left, _, right in parts}
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
    )
