"""The size of fixed-point numbers, which have 16 integer bits, the sign among them.

In memory, and as an LLVM integer of one orbit, a number takes whole 64-bit words: the bits in front
of it repeat its sign.
"""

INTEGER_BITS = 16
WORD = 64  # bits
EXTRA_SUM_BITS = 64  # a sum has so many integer bits more than a number


def size_of(fraction: int) -> int:
    """Return the number of bits of a number with `fraction` bits after the point."""
    return fraction + INTEGER_BITS


def sizes_of(fraction: int) -> dict[str, int]:
    """Return the bits of a number and of a sum, by the language's names of their kinds."""
    size = size_of(fraction)
    return {"wide": size, "sum": size + EXTRA_SUM_BITS}


def words_of(size: int) -> int:
    """Return the number of words that hold `size` bits."""
    return -(-size // WORD)


def width_of(fraction: int) -> int:
    """Return the number of bits of the words that a number takes."""
    return WORD * words_of(size_of(fraction))
