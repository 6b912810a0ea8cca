"""A user's own splitting, by its coefficients: `kick 1/2; drift 1; kick 1/2; order 2`.

Coefficients are exact: decimals and quotients, and expressions of them with `sqrt` and powers, as
`drift 1/(2 - 2**(1/3))`. Decimals of eight digits and more stand for exact numbers near them: the
order is that of these numbers (`verify.schemes.printed.nearby_order`). `order` is the claimed
order, 1 if left out.

For an H that depends on time a part may have a time, in parts of h from the step's start, as in
`kick 1/2 at 0; drift 1; kick 1/2 at 1`; if left out, it is the right one.
"""

import sympy

from verify.algebra.formula import parse
from verify.errors import InputError
from verify.schemes.conditions.splitting_conditions import LETTERS, MOST_ORDER, Part, sums_before
from verify.schemes.printed.nearby_order import nearby_of
from verify.schemes.scheme import Scheme
from verify.schemes.splitting import splitting

EXAMPLES = ()  # names are texts that users write
_MOST_PARTS = 200
_FORM = "write it as 'kick 1/2; drift 1; kick 1/2; order 2'"


def make(name: str) -> Scheme | None:
    """Return the scheme for a text that begins with kick or drift; InputError for a wrong one."""
    words = [part.split(maxsplit=1) for part in name.split(";") if part.strip()]
    if not words or words[0][0] not in LETTERS:
        if words and words[0][0].lower() in LETTERS:
            raise InputError("scheme", name, f"write it in small letters: {_FORM}")
        return None
    # Each part needs a size, and long texts are refused before sympy sees them.
    if any(len(part) < 2 for part in words) or len(words) > _MOST_PARTS:
        raise InputError("scheme", name, _FORM)
    order = order_of(name, words.pop()[1]) if words[-1][0] == "order" else 1
    part_texts = [_part(name, *part) for part in words]
    parts = tuple((kind, parse(size, (), source=kind)) for kind, size, _ in part_texts)
    times = tuple(
        None if time is None else parse(time, (), source=f"{kind} at")
        for kind, _, time in part_texts
    )
    # A time that is exactly the right one stays the right one when sizes are moved to exact
    # numbers.
    not_right = [
        x != right for x, right in zip(times, sums_before(parts, sympy.S.Zero), strict=True)
    ]
    at_times = [
        (kind, size, time if keep else None)
        for (kind, size, time), keep in zip(part_texts, not_right, strict=True)
    ]
    return splitting(
        "; ".join(" ".join(part.split()) for part in name.split(";") if part.strip()),
        parts,
        order=order,
        symmetric=_palindrome(parts),
        source="the user's coefficients",
        times=times,
        nearby=nearby_of([(kind, size, None) for kind, size, _ in part_texts]),
        nearby_in_time=nearby_of(at_times),
    )


def order_of(name: str, text: str) -> int:
    """Return the order that a user's scheme claims; InputError for one that is none."""
    if not (text.strip().isascii() and text.strip().isdigit()):
        raise InputError("scheme", name, f"order {text.strip()}: is not a whole number")
    order = int(text)
    if not 1 <= order <= MOST_ORDER:
        raise InputError("scheme", name, f"order {order}: must be 1 … {MOST_ORDER}")
    return order


def _part(name: str, kind: str, text: str) -> tuple[str, str, str | None]:
    """Return the part's kind, size and time as they are written; None for no time."""
    if kind not in LETTERS:
        raise InputError("scheme", name, f"{kind}: unknown; {_FORM}")
    if "," in text:
        raise InputError("scheme", name, f"a , parts nothing; {_FORM}")
    size, separator, time = text.partition(" at ")
    return kind, size, time if separator else None


def _palindrome(parts: tuple[Part, ...]) -> bool:
    """Return True if the parts are the same read backwards, as written."""
    return parts == parts[::-1]
