"""The schemes: what each claims, for which H it is, and what a step costs."""

from collections.abc import Iterator

from docs._generate.markdown import codes, prose, table
from verify.schemes import aliases, family, get, names

_HEAD = ("scheme", "order", "is", "for H", "a step", "H_p, H_q")


def text() -> str:
    """A table of each family, in which all of them stand, and where they are from."""
    families = sorted({family(name) for name in names()})
    return "\n\n".join(part for of in families for part in _section(of))


def _section(of: str) -> Iterator[str]:
    own = [name for name in names() if family(name) == of]
    yield f"### {of}"
    yield table(_HEAD, map(_row, own))
    sources: dict[str, list[str]] = {}
    for name in own:
        sources.setdefault(get(name).source, []).append(name)
    yield "\n".join(f"- {codes(users)}: {prose(source)}" for source, users in sources.items())


def _row(name: str) -> tuple[str, ...]:
    scheme = get(name)
    others = [alias for alias, of in aliases().items() if of == name]
    claims = {"symplectic": scheme.area_preserving, "symmetric": scheme.symmetric,
              "explicit": scheme.explicit, "implicit": not scheme.explicit}  # fmt: skip
    return (
        codes([name, *others]),
        str(scheme.order),
        ", ".join(claim for claim, holds in claims.items() if holds),
        "T(p) + V(q)" if scheme.needs_separable else "every smooth one",
        getattr(scheme.every_h, "a_step", ""),
        ", ".join(map(str, (scheme.evaluations or {}).values())),
    )
