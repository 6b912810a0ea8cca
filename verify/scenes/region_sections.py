"""The section of a scene that carries a region by maps.

[[flow]]                               # regions carried by maps, and their areas
shape = "cat"                          # circle, square; or polygon, or path, as below
polygon = [[0, 0], [1, 0], [0, 1]]     # (q, p) of each corner
path = "M 0 0 C 10 20 30 20 40 0 Z"    # SVG path data, whose y points down: p = −y
centre = { q = 1, p = 0 }              # where the shape's (0, 0) is put; (0, 0)
plane = 1                              # in n degrees of freedom it lies in (q1, p1), and has lists
scale = 0.5                            # by which it is made larger first; 1
step_size = 0.01
steps = [5000, 10000, 20000]           # of the map; or times = [1, 2, 3]
schemes = ["lie2", "symplectic-euler"] # the scene's, where it is left out
exact = true                           # the exact flow beside them, and the distance from it
mean_lambda = true                     # the mean of Λ, or of W's entry, over the region
digits = 17                            # more than 17: all points are carried with 33 or more
source = "Figure 6"                    # what of a paper it repeats; may be left out
"""

from fractions import Fraction
from functools import lru_cache
from typing import Annotated, Any, Self

from mpmath.ctx_mp import MPContext
from pydantic import Field, model_validator

from verify.arithmetic.exact import text
from verify.errors import NOT_GIVEN, InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.run_domain import point_of
from verify.scenes.frozen import Frozen, Section
from verify.scenes.shapes import named as shapes
from verify.scenes.shapes.outline import Shape
from verify.scenes.values import (
    Digits,
    ExactNumber,
    InitialValue,
    SchemeName,
    Start,
    Steps,
    StepSize,
    Time,
    check_distinct,
    count_steps,
)

# The limit on the digits of points, of which a curve has thousands.
MOST_DIGITS = 1000
# The limit on a shape's coordinates, so that squares of its images' coordinates are floats too.
FARTHEST = 1e100
Corner = tuple[ExactNumber, ExactNumber]
_ORIGIN = InitialValue(q=Fraction(0), p=Fraction(0))


class _SizedShape(Frozen):
    """A shape by its name, as a polygon or as an SVG path, with its scale."""

    shape: str | None = None
    """A shape by its name; or `polygon`, or `path`."""
    polygon: Annotated[tuple[Corner, ...], Field(max_length=10_000)] | None = None
    """A polygon by its corners (q, p)."""
    path: Annotated[str, Field(max_length=100_000)] | None = None
    """An outline as SVG path data, whose y points down: p = −y."""
    scale: ExactNumber = Fraction(1)
    """By which it is made larger first."""

    @model_validator(mode="after")
    def _check_shape(self) -> Self:
        names = [n for n in ("shape", "polygon", "path") if getattr(self, n) is not None]
        if len(names) != 1:
            raise InputError("flow", ", ".join(names), "give one of shape, polygon and path")
        if self.scale <= 0:
            raise InputError("scale", text(self.scale), "must be greater than 0")
        return self


class PlacedShape(_SizedShape):
    """A shape with its place in a plane."""

    centre: InitialValue = _ORIGIN
    """Where the shape's (0, 0) is put."""

    @model_validator(mode="after")
    def _check_place(self) -> Self:
        if _reach(self) > FARTHEST:
            raise InputError("flow", "centre, scale", f"the shape reaches beyond ±{FARTHEST:g}")
        return self

    def to_shape(self) -> Shape:
        """Return the shape at its place."""
        return _build_shape(self)


# A plan asks for the same few shapes again for each map and number of steps.
@lru_cache(maxsize=64)
def _build_shape(placement: PlacedShape) -> Shape:
    if placement.shape is not None:
        shape = shapes.get(placement.shape)
    elif placement.polygon is not None:
        from verify.scenes.shapes.user_outline import polygon

        shape = polygon(placement.polygon)
    else:
        from verify.scenes.shapes.user_outline import svg_path

        shape = svg_path(placement.path or "")
    return shape.place_at(placement.centre.q, placement.centre.p, placement.scale)


@lru_cache(maxsize=64)
def _reach(placement: PlacedShape) -> Any:
    """Return the greatest |coordinate| of some points of each arc, in numbers of any size."""
    mp = MPContext()
    arcs = (arc for outline in _build_shape(placement).outlines for arc in outline.arcs)
    points = (arc(mp, mp.mpf(k) / 2) for arc in arcs for k in (0, 1))
    return max(abs(x) for point in points for x in point)


class RegionFlow(_SizedShape, Section):
    """A region that maps carry, and the change of its area; see the module's text."""

    centre: Start = _ORIGIN
    """Where the shape's (0, 0) is put; in n degrees of freedom lists, such as
    `{ q = [0, 0.1], p = [0.4, 0] }`, of which `plane` says where the shape lies."""
    plane: Annotated[int, Field(ge=1, strict=True)] = 1
    """In n degrees of freedom the region lies in (q1, p1), or in (q2, p2), …: which of them."""
    step_size: StepSize
    """The step size h."""
    steps: Annotated[tuple[Steps, ...], Field(max_length=100)] = ()
    """After how many steps the region is looked at, each once; or `times`."""
    times: Annotated[tuple[Time, ...], Field(max_length=100)] = ()
    """At which times it is looked at, N = T/h rounded down; or `steps`."""
    schemes: Annotated[tuple[SchemeName, ...], Field(max_length=100)] = ()
    """The maps; the scene's schemes, where it is left out."""
    exact: Annotated[bool, Field(strict=True)] = True
    """Whether the exact flow stands beside them, with the distance from it."""
    mean_lambda: Annotated[bool, Field(strict=True)] = True
    """Whether the mean of Λ over the region is computed, where a map changes area; in n degrees of
    freedom the mean of W's entry, the symplectic defect of all steps."""
    digits: Digits = 17
    """With more than 17, all points are carried with 33 or more."""
    source: Annotated[str, Field(max_length=80)] = ""
    """What of a paper it repeats, for its caption."""

    @model_validator(mode="after")
    def _check(self) -> Self:
        if bool(self.steps) == bool(self.times):
            raise InputError("steps, times", NOT_GIVEN, "give one of the two")
        if self.digits > MOST_DIGITS:
            raise InputError("digits", self.digits, f"must be at most {MOST_DIGITS}")
        check_distinct("steps", self.steps)
        if len(set(self.counts)) < len(self.counts):
            times = ", ".join(map(text, self.times))
            raise InputError("times", times, "two of them make the same number of steps")
        check_distinct("schemes", self.schemes)
        if self.plane > min(map(len, self._lists)):
            problem = f"must be 1 … {min(map(len, self._lists))}, as q and p of centre have it"
            raise InputError("plane", self.plane, problem)
        self.placed_shape()
        return self

    @property
    def _lists(self) -> tuple[tuple[Fraction, ...], tuple[Fraction, ...]]:
        """q and p of the centre; the default, the origin, has as many as there are planes."""
        if not isinstance(self.centre, InitialValue):
            return self.centre.q, self.centre.p
        # The default centre has as many planes as `plane` requires, so that H decides which exist.
        planes = 1 if "centre" in self.model_fields_set else self.plane
        return (self.centre.q,) * planes, (self.centre.p,) * planes

    def point(self, hamiltonian: Hamiltonian) -> dict[str, Fraction]:
        """Return the centre by the names of H's coordinates.

        Raises InputError if it, or the plane, is of another number of degrees of freedom.
        """
        degrees = hamiltonian.degrees
        if self.plane > degrees:
            raise InputError("plane", self.plane, f"must be 1 … {degrees}: H is in (q1, p1), …")
        if "centre" not in self.model_fields_set:
            return dict.fromkeys(hamiltonian.coordinates, Fraction(0))
        return point_of(hamiltonian, self.centre.q, self.centre.p)

    @property
    def counts(self) -> tuple[int, ...]:
        """The numbers of steps, ascending; for a time T, T/h rounded down."""
        of_times = (count_steps(time, None, self.step_size) for time in self.times)
        return tuple(sorted((*self.steps, *of_times)))

    def placed_shape(self) -> PlacedShape:
        """Return the shape with its place in its plane alone."""
        q, p = (values[self.plane - 1] for values in self._lists)
        sized = {n: getattr(self, n) for n in _SizedShape.model_fields}
        return PlacedShape(**sized, centre=InitialValue(q=q, p=p))
