"""The size of fixed-point numbers, which have 16 integer bits, the sign among them.

In memory, and in the integers of one orbit, a number takes whole words: its sign is repeated in
front of it.
"""

INTEGER_BITS = 16
WORD = 64  # bits
MORE_OF_SUMS = 64  # integer bits of a sum beyond those of a number


def size_of(fraction: int) -> int:
    """Return the bits of a number with so many after the point."""
    return fraction + INTEGER_BITS


def sizes_of(fraction: int) -> dict[str, int]:
    """Return the bits of a number and of a sum, by the names that the language has for them."""
    size = size_of(fraction)
    return {"wide": size, "sum": size + MORE_OF_SUMS}


def words_of(size: int) -> int:
    """Return the words for so many bits."""
    return -(-size // WORD)


def width_of(fraction: int) -> int:
    """Return the bits of the words that a number takes."""
    return WORD * words_of(size_of(fraction))
