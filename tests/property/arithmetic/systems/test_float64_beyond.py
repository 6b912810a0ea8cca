"""What float64 says of one function beside another that leaves its range."""

from hypothesis import given
from hypothesis import strategies as st

from tests.examples import drawn
from tests.property.arithmetic.systems.test_systems import SOURCES, bits, kernels

functions = st.sampled_from(sorted({str(name) for name in SOURCES.values() if name}))


@drawn(40)
@given(functions, st.floats(710, 1e6), st.floats(-500, 500))
def test_what_leaves_the_range_changes_nothing_beside_it(name: str, x: float, y: float) -> None:
    """exp(−exp(x)) is 0 though Python refuses exp(x): the sum has the bits of the other summand."""
    beside = kernels(f"exp(-exp(x)) + {name}(y)")[0](1, x, y)
    assert bits(beside) == bits(kernels(f"0.0 + {name}(x)")[0](1, y, y))
