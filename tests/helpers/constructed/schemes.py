"""Schemes that are made by hand for proofs for every H: by a series, by stages, by conditions."""

from dataclasses import dataclass, replace
from typing import Any

import pytest
from hypothesis import strategies as st

from verify.proof import order_for_every_h
from verify.proof.order_for_every_h import prove_for_every_h
from verify.proof.proof_for_every_h import ProofForEveryH
from verify.schemes import get
from verify.schemes.conditions.condition import Condition
from verify.schemes.scheme import Scheme


def made_of(generic: Any, order: int, area: bool = False, base: str = "euler") -> Scheme:
    """A scheme named "made" with these claims; for one H it is the scheme `base`."""
    true = get(base)
    return replace(
        true, name="made", every_h=generic, order=order, area_preserving=area, build=true.step_map
    )


def proof_of(
    generic: Any, order: int, area: bool = False, separable: bool = False, base: str = "euler"
) -> ProofForEveryH:
    """What `prove_for_every_h` says of such a scheme."""
    scheme = made_of(generic, order, area, base)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(order_for_every_h, "get", lambda _: scheme)
        return prove_for_every_h("made", separable)


@dataclass(frozen=True)
class Made:
    """Conditions by hand: (order, whether it holds)."""

    of_order: tuple[tuple[int, bool | None], ...]
    of_area: tuple[bool | None, ...]
    most_order: int
    separable: bool = False

    def order_conditions(self, order: int) -> tuple[Condition, ...]:
        assert order <= self.most_order
        own = [(n, holds) for n, holds in self.of_order if n <= order]
        return tuple(Condition(f"C{k}", n, f"r{k}", holds) for k, (n, holds) in enumerate(own))

    def area_conditions(self) -> tuple[Condition, ...]:
        return tuple(Condition(f"A{k}", 0, f"s{k}", holds) for k, holds in enumerate(self.of_area))


holding = st.sampled_from([True, True, True, True, False, None])
conditions = st.builds(
    Made,
    st.lists(st.tuples(st.integers(1, 6), holding), max_size=6).map(
        lambda x: tuple(sorted(x, key=lambda c: c[0]))
    ),
    st.lists(holding, max_size=2).map(tuple),
    st.integers(4, 8),
    st.booleans(),
)
