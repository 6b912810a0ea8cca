"""A user's own map, written as formulas: `p_next = p - h*q; q_next = q + h*p_next`.

The formulas may use p, q, h, the parameters of H, and t where H depends on it; q_next may use
p_next. In n degrees of freedom they are p1_next … qn_next, each of which may use those that are
written before it; of equations without an H they have the names of the coordinates. The map claims
consistency (order 1) and nothing else.
"""

import re
from collections.abc import Mapping

from verify.errors import InputError
from verify.schemes.scheme import Scheme

_FORM = "write it as 'p_next = …; q_next = …', or as 'kick 1/2; drift 1; kick 1/2'"
_NUMBERED = re.compile(r"[pq][1-9]\d{0,2}_next", re.ASCII)
_NEXT = re.compile(r"[A-Za-z]\w*_next", re.ASCII)
EXAMPLES = ()  # names are texts that users write


def make(name: str) -> Scheme | None:
    """Return the scheme for a text with `=`; None for another text.

    Raises InputError unless it defines p_next and q_next, or p1_next, …, once each.
    """
    if "=" not in name:
        return None
    parts = [part.partition("=") for part in name.split(";") if part.strip()]
    formulas = {left.strip(): right.strip() for left, _, right in parts}
    if len(formulas) == len(parts) and all(map(_NUMBERED.fullmatch, formulas)):
        return _scheme(formulas)
    if len(parts) == 2 and set(formulas) == {"p_next", "q_next"}:
        return _scheme({name: formulas[name] for name in ("p_next", "q_next")})
    # Of other coordinates, which are those of equations without an H.
    if len(formulas) != len(parts) or not all(map(_NEXT.fullmatch, formulas)):
        raise InputError("scheme", name, _FORM)
    if {"p_next", "q_next"} & set(formulas):
        raise InputError("scheme", name, _FORM)
    return _scheme(formulas)


def _scheme(formulas: Mapping[str, str]) -> Scheme:
    name = "; ".join(f"{name} = {formula}" for name, formula in formulas.items())
    return Scheme(name, order=1, source="the user's formulas", formulas=formulas)
