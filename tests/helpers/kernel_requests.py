"""Which kernels a run asks for."""

import sys
from typing import Any

import pytest

from verify.kernels.kernel import kernel_for


def record_kernel_requests(
    monkeypatch: pytest.MonkeyPatch, allowed: bool = True
) -> list[frozenset[str]]:
    """The observables of every kernel that is asked for from now on, in a list that grows."""
    requests: list[frozenset[str]] = []

    def spy(hamiltonian: Any, scheme: Any, arithmetic: Any, observables: Any, *more: Any) -> Any:
        requests.append(observables)
        assert allowed, "a kernel was asked for"
        return kernel_for(hamiltonian, scheme, arithmetic, observables, *more)

    for name, module in list(sys.modules.items()):
        if name.startswith("verify.") and getattr(module, "kernel_for", None) is kernel_for:
            monkeypatch.setattr(module, "kernel_for", spy)
    return requests
