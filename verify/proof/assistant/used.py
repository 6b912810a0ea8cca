"""A certificate for one H without the functions that nothing in it is made of."""

from collections.abc import Iterable, Iterator
from dataclasses import replace

from verify.proof.certificates.entries import Expansion, Function
from verify.proof.certificates.readers import Poly, need

_MOST, _DEEPEST = 100, 20  # the time of coqc grows with the square of both
_PARTNERS = {"sin": "cos", "cos": "sin"}


def with_used_functions(entries: Expansion) -> Expansion:
    """The certificate with those that H, the map, L and G are made of, and their derivatives.

    What it says holds without the others, too, and where these are not defined. Raises ValueError
    where they are too many, or nested too deeply, for `coqc` to take it within minutes.
    """
    needed = {name for x in _polys(entries) for names in x for name in names}
    kept: list[Function] = []
    for made in reversed(entries.functions):  # outer functions first
        if made.name in needed or _is_partner(made, kept):
            kept.insert(0, made)
            needed |= {name for names in made.argument for name in names}
    for made in entries.functions:  # of those partners that come before the others
        if made not in kept and _is_partner(made, kept):
            kept.append(made)
    order = {made.name: k for k, made in enumerate(entries.functions)}
    functions = tuple(sorted(kept, key=lambda made: order[made.name]))
    need(
        len(functions) <= _MOST, f"it needs more than {_MOST} functions, which coqc takes long for"
    )
    said = f"its functions are nested more than {_DEEPEST} deep, which coqc takes long for"
    need(_depth(functions) <= _DEEPEST, said)
    return replace(entries, functions=functions)


def _depth(functions: Iterable[Function]) -> int:
    """How many of them stand within one another at most."""
    depths: dict[str, int] = {}
    for made in functions:  # inner ones first
        within = (depths.get(name, 0) for names in made.argument for name in names)
        depths[made.name] = 1 + max(within, default=0)
    return max(depths.values(), default=0)


def _is_partner(made: Function, kept: list[Function]) -> bool:
    """Whether it is the cos of a sin, or the sin of a cos, that is needed."""
    return any(f.argument == made.argument and _PARTNERS.get(f.kind) == made.kind for f in kept)


def _polys(entries: Expansion) -> Iterator[Poly]:
    if entries.hamiltonian is not None:
        yield entries.hamiltonian
    for series in entries.after:
        yield from series
    yield from entries.leading.values()
    yield from (entries.potential or {}).values()
