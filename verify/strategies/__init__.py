"""hypothesis strategies, to property-test an integrator of one's own against exact schemes.

    from hypothesis import given
    from verify import strategies

    @given(strategies.hamiltonians(separable=True), strategies.initial_values())
    def test_mine(hamiltonian, start): ...

All numbers are exact rationals. Arguments are checked when a strategy is built; InputError names a
bad one. `st.from_type` knows the types that are drawn here: see `verify.from_type`.
"""

from verify.strategies.exact_numbers import initial_times, initial_values, parameters, step_sizes
from verify.strategies.hamiltonians import hamiltonians
from verify.strategies.scene_strategy import scenes
from verify.strategies.schemes import schemes
from verify.strategies.terms import KINDS as KINDS

__all__ = [
    "hamiltonians",
    "initial_times",
    "initial_values",
    "parameters",
    "scenes",
    "schemes",
    "step_sizes",
]
