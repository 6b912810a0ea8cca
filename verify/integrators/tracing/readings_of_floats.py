"""What the floats in a user's code were read as, and what else was taken for granted."""

from verify.arithmetic.exact import text
from verify.integrators.tracing.trace import Tape
from verify.prose import Prose, prose, read_prose


def readings(tape: Tape) -> list[Prose]:
    """Notes on it."""
    notes = [prose("h > 0 is taken for granted")] if tape.positive else []
    if tape.readings:
        shown = ", ".join(f"`{x!r}` as `{text(v)}`" for x, v in sorted(tape.readings.items()))
        told = f"floats are read as the exact numbers that they are written for: {shown}"
        notes.append(read_prose(told))
    if tape.rounded:
        shown = ", ".join(f"`{x!r}`" for x in sorted(tape.rounded))
        notes.append(read_prose(f"floats taken by their exact binary values: {shown}"))
    return notes
