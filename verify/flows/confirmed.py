"""The numerical flow with more and more digits, until two agree; poles in t are found before."""

from collections.abc import Sequence
from fractions import Fraction

from verify.arithmetic.exact import plain
from verify.flows.extrapolation import Flow, NoFlowError
from verify.hamiltonians.canonical_field import CanonicalField
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.times_on_the_way import first_fault
from verify.hamiltonians.vector_field import VectorField

METHOD = "numerical flow: Gragg's method, extrapolated"
_GUARD = 6  # digits beyond those asked for with which the first flow is followed
_MORE = 10  # and how many more the next one has
_TRIES = 6
_SAFETY = 2  # the better of two flows is nearer to the truth than they are to each other
_PARTS = 1024  # of the time, in which poles of H are looked for


def check_poles(hamiltonian: Hamiltonian, t0: Fraction, time: Fraction) -> None:
    """NoFlowError where H is not smooth at some time on the way."""
    part = time / _PARTS
    passed, words = first_fault(hamiltonian, t0, part, _PARTS)
    if words:
        between = f"t = {plain(t0 + passed * part, 6)} and {plain(t0 + (passed + 1) * part, 6)}"
        raise NoFlowError(f"between {between} H is not smooth; it is where `{words}`")


def confirmed(
    field: VectorField | CanonicalField, start: Sequence[Fraction], time: Fraction, digits: int
) -> tuple[list[Fraction], Fraction]:
    """The coordinates after the time and a bound of the error of each, an estimate; NoFlowError.

    `start`: the coordinates, and t where H depends on it.
    """
    coordinates = len(field.names)
    before: list[Fraction] | None = None
    for k in range(_TRIES):
        flow = Flow(field, digits + _GUARD + k * _MORE)
        z = flow.follow(tuple(map(flow.number, start)), time)
        after = [flow.arithmetic.exact(x) for x in z[:coordinates]]
        if before is not None:
            bound = _SAFETY * max(abs(x - y) for x, y in zip(after, before, strict=True))
            if bound * 10**digits <= max(map(abs, (*start[:coordinates], *after))):
                return after, bound
        before = after
    raise NoFlowError("the digits asked for are lost along the orbit")
