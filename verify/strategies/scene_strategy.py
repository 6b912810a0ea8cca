"""The strategy of whole scenes: an H, a scheme that takes it, and a run of a few steps."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any, NamedTuple

from hypothesis import reject
from hypothesis import strategies as st

from verify.arithmetic.exact import whole
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.scenes.run_sections import Grid
from verify.scenes.scene import Scene
from verify.scenes.values import MAX_STEPS, InitialState, InitialValue
from verify.schemes.methods.taylor.lie import eta_of
from verify.schemes.scheme import Scheme
from verify.strategies import exact_numbers
from verify.strategies.arguments import MOST_DEGREES, yes_no
from verify.strategies.hamiltonians import HamiltonianRequest
from verify.strategies.plane_formulas import DrawnFormula
from verify.strategies.schemes import schemes_taking, select_schemes
from verify.strategies.terms import FormulaLimits

_SHORT = FormulaLimits(degree=4, terms=2)  # of each of several degrees of freedom
_LONG_MAPS = (5, 6)  # the η of lieη


def scenes(
    *,
    hamiltonians: st.SearchStrategy[Hamiltonian] | None = None,
    schemes: st.SearchStrategy[Scheme] | None = None,
    initial_values: st.SearchStrategy[InitialValue] | st.SearchStrategy[InitialState] | None = None,
    initial_times: st.SearchStrategy[Fraction] | None = None,
    step_sizes: st.SearchStrategy[Fraction] | None = None,
    steps: tuple[int, int] = (1, 40),
    time_dependent: bool = False,
    degrees: int = 1,
) -> st.SearchStrategy[Scene]:
    """Return a strategy of valid scenes with one scheme and a `[grid]`.

    The grid has one step size, one initial value, and from steps[0] to steps[1] steps.

    Each part is drawn from the strategy of the same name in `verify.strategies`, or from the one
    that is given; parameters of a given H that have no value are given one. A scheme that does not
    take H is not drawn; only where both strategies are given can the two not fit, and then the
    example is rejected. A scheme is named in its scene, so it has to be one that
    `verify.schemes.get` finds. Shrinks towards lie1, one step of 1/10, H = p**2/2 + q**2/2.

    `time_dependent`: H(p, q, t), as `verify.strategies.hamiltonians` draws them; of those that are
    given it is not to be said. Wherever H depends on t, a t₀ is drawn.

    `degrees`: of freedom, 1 … 8, of H and of the initial values that are drawn here; of those that
    are given it has to be theirs. In more than one, H has two terms a degree and powers up to 4,
    and lie5 and lie6, whose maps are long there, are drawn only where they are given.

    Raises InputError for a bad argument when it is called.
    """
    whole("degrees", degrees, 1, MOST_DEGREES)
    parts = {"hamiltonians": hamiltonians, "schemes": schemes, "initial_values": initial_values,
             "initial_times": initial_times, "step_sizes": step_sizes}  # fmt: skip
    for name, strategy in parts.items():
        if strategy is not None and not isinstance(strategy, st.SearchStrategy):
            raise InputError(name, strategy, "is not a hypothesis strategy")
    if not isinstance(steps, Sequence) or len(steps) != 2:
        raise InputError("steps", steps, "is not a pair: the least and the most steps")
    if yes_no("time_dependent", time_dependent) and hamiltonians is not None:
        problem = "is of H that are drawn here; the hamiltonians that are given say it themselves"
        raise InputError("time_dependent", time_dependent, problem)
    least, most = (whole("steps", value, 1, MAX_STEPS) for value in steps)
    if least > most:
        raise InputError("steps", steps, "the first is greater than the second")
    values = (
        exact_numbers.initial_values(degrees=degrees) if initial_values is None else initial_values
    )
    times = exact_numbers.initial_times() if initial_times is None else initial_times
    sizes = exact_numbers.step_sizes() if step_sizes is None else step_sizes
    # One number needs no draw: hypothesis also draws constants of loaded modules, so that the
    # example would depend on what has been imported.
    counts = st.just(least) if least == most else st.integers(least, most)
    runs = _Runs(st.builds(_build_grid, counts, sizes, values), times)
    if hamiltonians is not None:
        return _scenes_of_hamiltonians(hamiltonians, schemes, runs)
    request = HamiltonianRequest(
        degrees, FormulaLimits() if degrees == 1 else _SHORT, time_dependent=time_dependent
    )
    if schemes is not None:
        return _scenes_of_schemes(schemes, request, runs)
    choices = select_schemes()
    if degrees > 1:
        choices = [scheme for scheme in choices if eta_of(scheme.name) not in _LONG_MAPS]
    return _scenes_of_catalogue(request, runs, choices)


class _Runs(NamedTuple):
    """The parts of a scene besides H and the scheme; times are drawn where H depends on t."""

    grids: st.SearchStrategy[Grid]
    times: st.SearchStrategy[Fraction]

    def draw_keys(self, draw: st.DrawFn, timed: bool) -> dict[str, Any]:
        """Draw the scene's keys of the run, with t₀ where H depends on t."""
        keys = {"grid": draw(self.grids)}
        return keys | {"t0": draw(self.times)} if timed else keys


def _build_grid(
    steps: int, step_size: Fraction, initial_value: InitialValue | InitialState
) -> Grid:
    return Grid(steps=steps, step_sizes=(step_size,), initial_values=(initial_value,))


def _scenes_of_catalogue(
    request: HamiltonianRequest, runs: _Runs, choices: Sequence[Scheme]
) -> st.SearchStrategy[Scene]:
    # A drawn H that is not separable gets only schemes for every H, so that no scene is rejected.
    schemes_of_any = st.sampled_from([scheme for scheme in choices if not scheme.needs_separable])
    schemes_of_separable = st.sampled_from(choices)
    any_formula = _formulas(request)

    @st.composite
    def draw_scene(draw: st.DrawFn) -> Scene:
        formula = draw(any_formula)
        scheme = draw(schemes_of_separable if formula.separable else schemes_of_any)
        return _build_scene(formula, scheme, runs.draw_keys(draw, formula.timed))

    return draw_scene()


def _scenes_of_schemes(
    schemes: st.SearchStrategy[Scheme], request: HamiltonianRequest, runs: _Runs
) -> st.SearchStrategy[Scene]:
    any_formula, separable = (_formulas(replace(request, separable=x)) for x in (None, True))

    @st.composite
    def draw_scene(draw: st.DrawFn) -> Scene:
        scheme = draw(schemes)
        formula = draw(separable if scheme.needs_separable else any_formula)
        run = runs.draw_keys(draw, formula.timed)
        # A scheme of the catalogue takes every such H; one of the user's own may refuse it.
        if scheme.every_h is not None:
            return _build_scene(formula, scheme, run)
        return _fitting_scene(formula.hamiltonian(), scheme, run)

    return draw_scene()


def _scenes_of_hamiltonians(
    hamiltonians: st.SearchStrategy[Hamiltonian],
    schemes: st.SearchStrategy[Scheme] | None,
    runs: _Runs,
) -> st.SearchStrategy[Scene]:
    choices = select_schemes()

    @st.composite
    def draw_scene(draw: st.DrawFn) -> Scene:
        hamiltonian = draw(hamiltonians)
        if hamiltonian.symbols:
            values = draw(exact_numbers.parameters(hamiltonian.symbols))
            hamiltonian = hamiltonian.with_values(dict(hamiltonian.values) | values)
        fitting = (
            st.sampled_from(schemes_taking(choices, hamiltonian)) if schemes is None else schemes
        )
        scheme = draw(fitting)
        return _fitting_scene(hamiltonian, scheme, runs.draw_keys(draw, hamiltonian.time_dependent))

    return draw_scene()


def _formulas(request: HamiltonianRequest) -> st.SearchStrategy[DrawnFormula]:
    """Return a strategy of formulas, one in three with parameters."""
    bare, with_names = (replace(request, with_parameters=x).formulas() for x in (False, True))
    return st.one_of(bare, bare, with_names)


def _build_scene(formula: DrawnFormula, scheme: Scheme, run: Mapping[str, Any]) -> Scene:
    """Return the scene of drawn parts, without validation.

    It is valid by construction; to validate it would make the step map of each scheme.
    """
    return Scene.model_construct(
        hamiltonian=formula.text, parameters=dict(formula.parameters), schemes=(scheme.name,), **run
    )


def _fitting_scene(hamiltonian: Hamiltonian, scheme: Scheme, run: Mapping[str, Any]) -> Scene:
    """Return the scene of parts from a user's strategies; reject it where they do not fit."""
    if not schemes_taking([scheme], hamiltonian):
        reject()
    return Scene(
        hamiltonian=hamiltonian.formula,
        parameters=dict(hamiltonian.values),
        schemes=(scheme.name,),
        **run,
    )
