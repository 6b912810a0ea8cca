"""`verify.flow`: a region carried by schemes, and the change of its area."""

from collections.abc import Sequence
from typing import Any

from verify.arithmetic.exact import Exact
from verify.calls.inputs import ParametersLike, SystemLike, as_list, perform, scene_of
from verify.errors import InputError
from verify.hamiltonians.start import Given
from verify.scenes.results.regions import FlowResult
from verify.studies.kinds.regions import flows_of, need_flows

_ORIGIN = (0, 0)


def flow(
    system: SystemLike,
    scheme: Any,
    *,
    step_size: Exact,
    steps: Any = None,
    times: Any = None,
    t0: Exact = 0,
    parameters: ParametersLike = None,
    shape: str | None = None,
    polygon: Sequence[tuple[Exact, Exact]] | None = None,
    path: str | None = None,
    centre: tuple[Given, Given] = _ORIGIN,
    plane: int = 1,
    scale: Exact = 1,
    exact: bool = True,
    mean_lambda: bool = True,
    digits: int = 17,
    workers: int = 1,
) -> FlowResult:
    """Carry a region by one scheme or several, and measure the change of its area.

    Parameters
    ----------
    system, scheme, step_size, parameters: as in `verify.run`; `scheme` may be a list.
    steps, times: one of the two, a number or a list; of a time N = T/h, rounded down.
    t0: the time at the start, for an H that depends on t.
    shape: a name, circle, square or cat; or `polygon`, corners (q, p); or `path`, as SVG has it.
        Without any of them a circle.
    centre: (q, p) of its place; `scale`: the factor of its size. In n degrees of freedom q and p
        are lists, and the region lies in (q_i, p_i), i = `plane`; measured is ∮ p·dq.
    exact: also the exact flow, and the distance from it.
    mean_lambda: the mean of Λ over the region, of schemes that change area.
    digits: of areas and distances; `workers`: processes; 1 is this one, and others
        import the caller's script again, whose call then stands under `__name__ == "__main__"`.

    Returns a FlowResult: `before`, and `images`, one a map and number of steps. Raises InputError.

    >>> result = flow("harmonic", "stormer-verlet", parameters={"omega": 1}, step_size=0.1, steps=3)
    >>> [(image.map, image.area_preserving) for image in result.images]
    [('exact flow', True), ('stormer-verlet', True)]
    """
    if not isinstance(centre, Sequence) or isinstance(centre, str) or len(centre) != 2:
        raise InputError("centre", centre, "is no pair (q, p)")
    if shape is None and polygon is None and path is None:
        shape = "circle"
    section = {
        "shape": shape,
        "polygon": polygon,
        "path": path,
        # The default is left out: in n degrees of freedom two zeros are too few. A centre that the
        # caller gives is checked, so the comparison is by identity.
        **({} if centre is _ORIGIN else {"centre": {"q": centre[0], "p": centre[1]}}),
        "plane": plane,
        "scale": scale,
        "step_size": step_size,
        "steps": None if steps is None else as_list("steps", steps),
        "times": None if times is None else as_list("times", times),
        "exact": exact,
        "mean_lambda": mean_lambda,
        "digits": digits,
    }
    scene = scene_of(system, scheme, parameters, t0=t0, flow=[section])
    return flows_of(scene, perform(scene, need_flows, workers))[0]
