"""A user's own map, written as formulas: `p_half = p - h/2*q; q_next = q + h*p_half; p_next = …`.

Each line may use p, q, h, the parameters of H, t where H depends on it, derivatives of H with the
point at which they are taken, as H_q(p_half, q_next), and the other lines, in any order. In n
degrees of freedom the last values are p1_next … qn_next; of equations without an H they have the
names of the coordinates. The map claims consistency (order 1) and nothing else.
"""

import re
from collections.abc import Mapping

from verify.algebra.formula import parameter_name
from verify.errors import InputError
from verify.schemes.field_splitting import separate_parts
from verify.schemes.scheme import Scheme

_FORM = "write it as 'p_next = …; q_next = …', or as 'kick 1/2; drift 1; kick 1/2'"
_NAME = re.compile(r"[A-Za-z]\w*", re.ASCII)
EXAMPLES = ()  # names are texts that users write


def make(name: str) -> Scheme | None:
    """Return the scheme for a text with `=`; None for another text.

    Raises InputError unless each line names one value, those of the end among them.
    """
    if "=" not in name or separate_parts(name)[1]:
        return None
    parts = [part.partition("=") for part in name.split(";") if part.strip()]
    formulas = {left.strip(): right.strip() for left, _, right in parts}
    is_plane = {"p_next", "q_next"} & set(formulas)
    last = [x for x in formulas if x.endswith("_next")]
    if (
        len(formulas) != len(parts)
        or not all(map(_NAME.fullmatch, formulas))
        or not last
        or (is_plane and set(last) != {"p_next", "q_next"})
    ):
        raise InputError("scheme", name, _FORM)
    for step in formulas.keys() - set(last):
        if step in ("p", "q"):
            problem = f"{step} is the value before the step; write {step}_half = …, {step}_next = …"
            raise InputError("scheme", name, problem)
        parameter_name(step)
    if is_plane and len(formulas) == 2:
        formulas = {x: formulas[x] for x in ("p_next", "q_next")}
    return _scheme(_sort(formulas, name))


def _sort(formulas: Mapping[str, str], text: str) -> dict[str, str]:
    """Return the formulas in an order in which each uses earlier ones alone."""
    waiting, ordered = dict(formulas), {}
    while waiting:
        ready = (x for x in waiting if not waiting.keys() & set(_NAME.findall(waiting[x])))
        name = next(ready, None)
        if name is None:
            problem = f"{', '.join(waiting)} need one another, or themselves: the step is implicit"
            raise InputError("scheme", text, problem)
        ordered[name] = waiting.pop(name)
    return ordered


def _scheme(formulas: Mapping[str, str]) -> Scheme:
    name = "; ".join(f"{name} = {formula}" for name, formula in formulas.items())
    return Scheme(name, order=1, source="the user's formulas", formulas=formulas)
