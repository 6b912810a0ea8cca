"""One tableau as a file has it: rows, weights and times, or all of them pasted or in a CSV file."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from verify.errors import NOT_GIVEN, InputError
from verify.integrators.tables.entry import Row
from verify.integrators.tables.layout import layout_of_csv, pasted
from verify.integrators.tables.tableaux.table import MOST_STAGES, PrintedBlock, Texts, square
from verify.scenes.frozen import Frozen
from verify.schemes.printed.naming import Naming


class Block(Frozen):
    """`tableau`: pasted text, in place of the others; `csv`: the name of a file."""

    a: tuple[Row, ...] | None = None
    b: Row | None = None
    c: Row | None = None
    embedded: Row | None = None
    tableau: str | None = None
    csv: str | None = None


@dataclass(frozen=True)
class NamedBlock:
    """With names for its decimals."""

    printed: PrintedBlock
    embedded: Texts | None


def block_of(given: Block, naming: Naming, name: str, folder: Path) -> NamedBlock:
    """InputError, of the key that is wrong, where it is no tableau."""
    given = _laid_out(given, name, folder)
    if given.a is None or given.b is None:
        what = "a" if given.a is None else "b"
        raise InputError(f"{what}{name}", NOT_GIVEN, "is missing; write a and b, or tableau")
    stages = len(given.b)
    if not 1 <= stages <= MOST_STAGES:
        raise InputError(f"b{name}", stages, f"has 1 to {MOST_STAGES} weights")
    rows = square(given.a, stages, f"a{name}")
    named = tuple(
        naming.entries(row, f"a{name}{i + 1}_" if stages > 9 else f"a{name}{i + 1}")
        for i, row in enumerate(rows)
    )
    weights = naming.entries(given.b, f"b{name}")
    times = None if given.c is None else naming.entries(_filled(given.c, stages), f"c{name}")
    embedded = None
    if given.embedded is not None:
        if len(given.embedded) != stages:
            problem = f"has {stages} weights, as b; write 0 for one that it leaves out"
            raise InputError(f"embedded{name}", len(given.embedded), problem)
        embedded = naming.entries(given.embedded, f"embedded{name}")
    return NamedBlock(PrintedBlock(named, weights, times), embedded)


def _filled(times: Sequence[str], stages: int) -> Sequence[str]:
    """The times, of which the first, 0, need not be printed."""
    return ["0", *times] if len(times) == stages - 1 else times


def _laid_out(given: Block, name: str, folder: Path) -> Block:
    if given.tableau is None and given.csv is None:
        return given
    others = [given.a, given.b, given.c, given.embedded]
    if any(x is not None for x in others) or (given.tableau and given.csv):
        raise InputError(
            f"tableau{name}", NOT_GIVEN, "stands alone: leave out a, b, c and embedded"
        )
    label = f"tableau{name}"
    own = pasted(given.tableau, label) if given.tableau is not None else (
        layout_of_csv(folder, given.csv or "")
    )  # fmt: skip
    weights, *more = own.weights
    embedded = _padded(more[0], len(weights)) if more else None
    rows = tuple(own.rows)
    return Block(a=rows, b=weights, c=own.times, embedded=embedded)


def _padded(weights: Sequence[str], stages: int) -> tuple[str, ...]:
    return (*weights, *["0"] * (stages - len(weights)))


def embedded_of(own: Sequence[NamedBlock], order: int | None) -> tuple[Texts, ...] | None:
    """The embedded weights, where every part has them. InputError where some have, or where an
    order of them is claimed and there are none."""
    known = tuple(x.embedded for x in own if x.embedded is not None)
    if len(known) == len(own):
        return known
    if known or order is not None:
        alone = "is missing; embedded_order is that of its weights"
        raise InputError("embedded", NOT_GIVEN, alone if len(own) == 1 else "is missing in a part")
    return None
