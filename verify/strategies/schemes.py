"""The strategy of schemes, selected by their claims and by the H that they take."""

from collections.abc import Iterable

import sympy
from hypothesis import strategies as st

from verify import schemes as catalogue
from verify.algebra.formula import symbol
from verify.arithmetic.exact import whole
from verify.errors import InputError
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.schemes.methods.taylor.lie import eta_of
from verify.schemes.scheme import Scheme
from verify.strategies.arguments import yes_no_either

_LIE_AS_OFTEN = 3  # as each of the others: the toolkit was written for this family


def schemes(
    *,
    names: Iterable[str] | None = None,
    hamiltonian: Hamiltonian | None = None,
    area_preserving: bool | None = None,
    explicit: bool | None = None,
    symmetric: bool | None = None,
    order: int | None = None,
) -> st.SearchStrategy[Scheme]:
    """Return a strategy of schemes of the catalogue, or of these names, with these claims.

    `hamiltonian`: only schemes that take it; those for H = T(p) + V(q) only where it is so. A name
    may be any that `verify.schemes.get` knows: a family's member such as `lie7`, or formulas of
    one's own. Without names, `lie1` … `lie6` are drawn three times as often as each of the others.

    >>> from hypothesis import find, settings
    >>> drawn = schemes(area_preserving=True, order=4)
    >>> find(drawn, lambda scheme: True, settings=settings(database=None)).order
    4

    Shrinks towards lie1, or the first of `names`. Raises InputError for an unknown name, and where
    no scheme is left.
    """
    choices = select_schemes(names)
    if hamiltonian is not None and not isinstance(hamiltonian, Hamiltonian):
        raise InputError("hamiltonian", hamiltonian, "is not a Hamiltonian")
    claims = {"area_preserving": area_preserving, "explicit": explicit, "symmetric": symmetric}
    for name, value in claims.items():
        if yes_no_either(name, value) is not None:
            choices = [scheme for scheme in choices if getattr(scheme, name) == value]
    if order is not None:
        whole("order", order, 1)
        choices = [scheme for scheme in choices if scheme.order == order]
    if hamiltonian is not None:
        choices = schemes_taking(choices, hamiltonian)
    if not choices:
        raise InputError("schemes", "none", "no scheme claims all of that and takes that H")
    return st.sampled_from(choices)


def select_schemes(names: Iterable[str] | None = None) -> list[Scheme]:
    """Return the schemes of these names, or all; one of weight three stands there three times."""
    if names is None:
        all_names = catalogue.names()
        family = [name for name in all_names if eta_of(name)]
        others = [name for name in all_names if not eta_of(name)]
        return [catalogue.get(name) for name in (*family, *others, *family * (_LIE_AS_OFTEN - 1))]
    if isinstance(names, str) or not isinstance(names, Iterable):
        raise InputError("names", names, "is not a list of schemes' names")
    return [catalogue.get(name) for name in names]


def schemes_taking(candidates: Iterable[Scheme], hamiltonian: Hamiltonian) -> list[Scheme]:
    """Return the schemes that take this H."""
    # H is examined once for all schemes.
    separable = _is_separable(hamiltonian)
    return [scheme for scheme in candidates if _takes(scheme, hamiltonian, separable)]


def _takes(scheme: Scheme, hamiltonian: Hamiltonian, separable: bool) -> bool:
    if scheme.every_h is not None:
        return separable or not scheme.needs_separable
    try:  # a scheme of the user's own: nothing else is known of it
        scheme.step_map(hamiltonian)
    except InputError:
        return False
    return True


def separable_for(names: Iterable[str]) -> bool | None:
    """Return the `separable` of `hamiltonians` whose H each scheme of these names takes."""
    return True if any(catalogue.get(name).needs_separable for name in names) else None


def _is_separable(hamiltonian: Hamiltonian) -> bool:
    """Return True if H = T(p) + V(q); terms of one variable each need no algebra."""
    half = hamiltonian.degrees
    momenta, places = (
        set(map(symbol, coordinates))
        for coordinates in (hamiltonian.coordinates[:half], hamiltonian.coordinates[half:])
    )
    terms = sympy.Add.make_args(hamiltonian.exact)
    if not any(momenta & term.free_symbols and places & term.free_symbols for term in terms):
        return True
    return canonical_field(hamiltonian)[0].separable
