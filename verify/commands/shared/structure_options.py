"""The options that name what a step is meant to keep: --keeps and what refines it."""

from collections.abc import Callable, Sequence
from functools import wraps
from typing import TYPE_CHECKING, Any

from verify.commands.shared.option import option, options
from verify.errors import InputError

if TYPE_CHECKING:
    from verify.hamiltonians.hamiltonian import Hamiltonian

_OPTIONS = options(
    option(
        "--keeps",
        "NAME[: K]",
        "A structure that the step is meant to keep: area, symplectic, volume, energy,"
        " momentum, angular-momentum, reversible, symmetric, conformal, poisson, or the formula of"
        " a first integral; with K, that its defect is O(h^K); repeatable.",
        multiple=True,
    ),
    option("--form", "FORM", "The 2-form of symplectic, as m1*dv1^dx1.", default=""),
    option("--density", "FORMULA", "The density of volume, as 1/(u*v).", default=""),
    option(
        "--poisson",
        "MATRIX",
        "The matrix of the bracket, rows by ; and entries by , as '0, u*v; -u*v, 0'.",
        default="",
    ),
    option(
        "--casimir casimirs",
        "FORMULA",
        "A Casimir of the bracket, which is to be kept too; repeatable.",
        multiple=True,
    ),
    option(
        "--reverses",
        "FORMULAS",
        "The involution that turns the flow round, as '-v, x'; by default p to -p.",
        default="",
    ),
    option(
        "--factor",
        "FORMULA",
        "The factor of the form in one step, as exp(-gamma*h), of conformal.",
        default="",
    ),
)
split_option = option(
    "--split splits",
    "NAME: FIELD",
    "A part of --field that flows exactly, as 'A: x_dot = y*z'; the scheme is then such as"
    " 'A 1/2; B 1; A 1/2'; repeatable.",
    multiple=True,
)
_NAMES = ("keeps", "form", "density", "poisson", "casimirs", "reverses", "factor")


def structure_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add the options to a command, which gets them as the argument `keeps`, a KeepsRequest."""

    @wraps(command)
    def wrapper(*args: Any, **arguments: Any) -> Any:
        from verify.structures.reading import KeepsRequest

        request = KeepsRequest(**{name: arguments.pop(name) for name in _NAMES})
        return command(*args, keeps=request, **arguments)

    return _OPTIONS(wrapper)


def compose_scheme(scheme: str, splits: Sequence[str], system: "Hamiltonian") -> str:
    """Return the scheme, with the parts in `splits` of which it is composed."""
    if not splits:
        return scheme
    from verify.hamiltonians.equations import Equations
    from verify.schemes.field_splitting import add_parts

    if not isinstance(system, Equations):
        raise InputError("--split", splits[0], "goes with --field")
    parts: dict[str, str] = {}
    for text in splits:
        name, colon, field = text.partition(":")
        if not colon or name.strip() in parts:
            problem = "stands twice" if colon else "has no name; write NAME: FIELD"
            raise InputError("--split", text, problem)
        parts[name.strip()] = field
    return add_parts(scheme, parts)
