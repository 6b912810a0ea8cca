"""The schemes: what each claims, for which H it is, and what a step costs."""

from docs._generate.markdown import codes, prose, table
from verify.schemes import aliases, family, get, names

_HEAD = ("scheme", "order", "is", "for H", "a step", "H_p, H_q", "source")


def text() -> str:
    """A table of each family, in which all of them stand."""
    families = dict.fromkeys(sorted(family(name) for name in names()))
    return "\n".join(
        f"### {of}\n\n{table(_HEAD, (_row(name) for name in names() if family(name) == of))}"
        for of in families
    )


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
        prose(scheme.source),
    )
