"""Tables of splittings and compositions: their conditions by words, and what they claim."""
