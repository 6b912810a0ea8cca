"""Mathieu's equation q'' + (a − 2b cos 2t) q = 0: linear, and unstable for some a and b."""

from verify.hamiltonians.named_system import System

SYSTEM = System(
    name="mathieu",
    title="Mathieu's equation",
    formula="p**2/2 + (a - 2*b*cos(2*t))*q**2/2",
    source="NIST Digital Library of Mathematical Functions, 28.2.1, whose q is this b",
    parameters={"a": "the mean of the coefficient", "b": "half the amplitude of its change"},
    regimes={
        "stable": {"a": "2", "b": "1/2", "p": "0", "q": "1"},
        "unstable": {"a": "1", "b": "1/2", "p": "0", "q": "1"},
    },
)
