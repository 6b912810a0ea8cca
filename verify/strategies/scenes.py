"""Whole scenes: an H, a scheme that takes it, and a run of a few steps."""

from collections.abc import Sequence
from fractions import Fraction

from hypothesis import reject
from hypothesis import strategies as st

from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.scenes.run_sections import Grid
from verify.scenes.scene import Scene
from verify.scenes.values import MAX_STEPS, InitialValue
from verify.schemes.scheme import Scheme
from verify.strategies import numbers
from verify.strategies.arguments import whole
from verify.strategies.formulas import Formula, formulas
from verify.strategies.schemes import named, takers


def scenes(
    *,
    hamiltonians: st.SearchStrategy[Hamiltonian] | None = None,
    schemes: st.SearchStrategy[Scheme] | None = None,
    initial_values: st.SearchStrategy[InitialValue] | None = None,
    step_sizes: st.SearchStrategy[Fraction] | None = None,
    steps: tuple[int, int] = (1, 40),
) -> st.SearchStrategy[Scene]:
    """Valid scenes with one scheme and a `[grid]` of one step size, one initial value and at least
    steps[0] and at most steps[1] steps.

    Each part is drawn from the strategy of the same name in `verify.strategies`, or from the one
    that is given; parameters of a given H that have no value are given one. A scheme that does not
    take H is not drawn; only where both strategies are given can the two not fit, and then the
    example is rejected. A scheme is named in its scene, so it has to be one that
    `verify.schemes.get` finds. Shrinks towards lie1, one step of 1/10, H = p**2/2 + q**2/2.

    Raises InputError for a bad argument when it is called.
    """
    given = {"hamiltonians": hamiltonians, "schemes": schemes, "initial_values": initial_values,
             "step_sizes": step_sizes}  # fmt: skip
    for name, strategy in given.items():
        if strategy is not None and not isinstance(strategy, st.SearchStrategy):
            raise InputError(name, strategy, "is not a hypothesis strategy")
    if not isinstance(steps, Sequence) or len(steps) != 2:
        raise InputError("steps", steps, "is not a pair: the least and the most steps")
    least, most = (whole("steps", value, 1, MAX_STEPS) for value in steps)
    if least > most:
        raise InputError("steps", steps, "the first is greater than the second")
    values = numbers.initial_values() if initial_values is None else initial_values
    sizes = numbers.step_sizes() if step_sizes is None else step_sizes
    # One number needs no draw, nor may it hang on whether a loaded module has it as a constant.
    counts = st.just(least) if least == most else st.integers(least, most)
    grids = st.builds(_grid, counts, sizes, values)
    if hamiltonians is not None:
        return _of_hamiltonians(hamiltonians, schemes, grids)
    if schemes is not None:
        return _of_schemes(schemes, grids)
    return _of_formulas(grids)


def _grid(steps: int, step_size: Fraction, initial_value: InitialValue) -> Grid:
    return Grid(steps=steps, step_sizes=(step_size,), initial_values=(initial_value,))


def _of_formulas(grids: st.SearchStrategy[Grid]) -> st.SearchStrategy[Scene]:
    found = named()
    of_any = st.sampled_from([scheme for scheme in found if not scheme.needs_separable])
    of_separable = st.sampled_from(found)
    any_formula = _formulas()

    @st.composite
    def drawn(draw: st.DrawFn) -> Scene:
        formula = draw(any_formula)
        return _scene(formula, draw(of_separable if formula.separable else of_any), draw(grids))

    return drawn()


def _of_schemes(
    schemes: st.SearchStrategy[Scheme], grids: st.SearchStrategy[Grid]
) -> st.SearchStrategy[Scene]:
    any_formula, separable = _formulas(), _formulas(separable=True)

    @st.composite
    def drawn(draw: st.DrawFn) -> Scene:
        scheme = draw(schemes)
        formula = draw(separable if scheme.needs_separable else any_formula)
        if scheme.every_h is not None:
            return _scene(formula, scheme, draw(grids))
        return _fitting(formula.hamiltonian(), scheme, draw(grids))

    return drawn()


def _of_hamiltonians(
    hamiltonians: st.SearchStrategy[Hamiltonian],
    schemes: st.SearchStrategy[Scheme] | None,
    grids: st.SearchStrategy[Grid],
) -> st.SearchStrategy[Scene]:
    found = named()

    @st.composite
    def drawn(draw: st.DrawFn) -> Scene:
        hamiltonian = draw(hamiltonians)
        if hamiltonian.symbols:
            values = draw(numbers.parameters(hamiltonian.symbols))
            hamiltonian = hamiltonian.with_values(dict(hamiltonian.values) | values)
        own = st.sampled_from(takers(found, hamiltonian)) if schemes is None else schemes
        return _fitting(hamiltonian, draw(own), draw(grids))

    return drawn()


def _formulas(separable: bool | None = None) -> st.SearchStrategy[Formula]:
    plain, named = (formulas(separable=separable, with_parameters=named) for named in (False, True))
    return st.one_of(plain, plain, named)


def _scene(formula: Formula, scheme: Scheme, grid: Grid) -> Scene:
    """What is valid by how it was made: looking at it again would make the step map of each."""
    return Scene.model_construct(
        hamiltonian=formula.text,
        parameters=dict(formula.parameters),
        schemes=(scheme.name,),
        grid=grid,
    )


def _fitting(hamiltonian: Hamiltonian, scheme: Scheme, grid: Grid) -> Scene:
    """The scene of parts that others drew; rejected where the scheme does not take H."""
    if not takers([scheme], hamiltonian):
        reject()
    return Scene(
        hamiltonian=hamiltonian.formula,
        parameters=dict(hamiltonian.values),
        schemes=(scheme.name,),
        grid=grid,
    )
