"""A strategy says at once what is wrong with its arguments."""

from collections.abc import Callable

import pytest

from verify import Hamiltonian, InputError
from verify import strategies as s

TWISTED = Hamiltonian.parse("p**2/2 + q**2/2 + p*q**2")


@pytest.mark.parametrize(
    ("call", "said"),
    [
        (lambda: s.hamiltonians(()), "kinds"),
        (lambda: s.hamiltonians("polynomial"), "is not a list of some of: polynomial"),
        (lambda: s.hamiltonians(["cubic"]), "kinds=cubic: unknown; allowed: polynomial"),
        (lambda: s.hamiltonians(degree=0), "degree=0: must be a whole number, 1 … 64"),
        (lambda: s.hamiltonians(degree=2.0), "degree=2.0: must be a whole number"),
        (lambda: s.hamiltonians(size=0), "size=0"),
        (lambda: s.hamiltonians(terms=True), "terms=True"),
        (lambda: s.hamiltonians(separable="yes"), "True, False, or None for either"),
        (lambda: s.hamiltonians(degree=1, bounded=True), "degree=1: must be 2 or more"),
        (lambda: s.hamiltonians(["polynomial"], degree=1, separable=False), "must be 2 or more"),
        (lambda: s.hamiltonians(terms=1, bounded=True), "terms=1: must be 2 or more"),
        (lambda: s.hamiltonians(["rational"], terms=2, bounded=True), "must be 3 or more"),
        (lambda: s.hamiltonians(with_parameters=1), "with_parameters=1"),
        (lambda: s.hamiltonians(degrees=0), "degrees=0: must be a whole number, 1 … 8"),
        (lambda: s.hamiltonians(degrees=9), "degrees=9"),
        (
            lambda: s.hamiltonians(coupled=True),
            "coupled=True: wants two degrees of freedom or more",
        ),
        (lambda: s.hamiltonians(degrees=2, coupled="yes"), "coupled=yes"),
        (
            lambda: s.hamiltonians(["polynomial"], degrees=2, coupled=True, degree=1),
            "degree=1: must",
        ),
        (lambda: s.hamiltonians(["round"], degrees=2), "kinds=round"),
        (lambda: s.scenes(degrees=0), "degrees=0"),
        (lambda: s.parameters(["q"]), "parameter=q: not a parameter name"),
        (lambda: s.parameters(["sin"]), "parameter=sin"),
        (lambda: s.parameters("a"), "names=a: is not a list of names"),
        (lambda: s.parameters([1]), "parameter=1: is not a name"),
        (lambda: s.parameters(["a"], size=0), "size=0"),
        (lambda: s.initial_values(most=0), "most=0: must be greater than 0"),
        (lambda: s.initial_values(extreme=None), "extreme=None"),
        (lambda: s.step_sizes(least="0.2"), "least=0.2: is greater than most=1/10"),
        (lambda: s.step_sizes(least=0), "least=0: must be greater than 0"),
        (lambda: s.step_sizes(least=0.2), "least=0.2: is greater than most=1/10"),
        (lambda: s.step_sizes(most=float("nan")), "not a finite number"),
        (lambda: s.schemes(names=["nonsense"]), "scheme=nonsense: unknown"),
        (lambda: s.schemes(names="lie2"), "names=lie2: is not a list"),
        (lambda: s.schemes(names=[]), "no scheme"),
        (lambda: s.schemes(order=17), "no scheme"),
        (lambda: s.schemes(order="4"), "order=4: must be a whole number"),
        (lambda: s.schemes(explicit=1), "explicit=1"),
        (lambda: s.schemes(hamiltonian="p**2"), "is not a Hamiltonian"),
        (lambda: s.schemes(names=["ruth3"], hamiltonian=TWISTED), "no scheme"),
        (lambda: s.scenes(steps=(0, 3)), "steps=0"),
        (lambda: s.scenes(steps=(5, 3)), "the first is greater"),
        (lambda: s.scenes(steps=4), "is not a pair"),
        (lambda: s.scenes(hamiltonians="p**2/2"), "is not a hypothesis strategy"),
        (lambda: s.scenes(initial_times=0), "initial_times=0: is not a hypothesis strategy"),
        (lambda: s.scenes(time_dependent=1), "time_dependent=1: must be True or False"),
        (
            lambda: s.scenes(hamiltonians=s.hamiltonians(), time_dependent=True),
            "the hamiltonians that are given say it themselves",
        ),
        (lambda: s.initial_times(most=0), "most=0: must be greater than 0"),
    ],
)
def test_bad_arguments_are_told_at_once(call: Callable[[], object], said: str) -> None:
    with pytest.raises(InputError) as error:
        call()
    assert said in str(error.value)
