"""A scene: the declaration of what is to be verified, read from TOML and written as TOML.

Unknown keys are refused.

    title = "My oscillator"
    hamiltonian = "p**2/2 + q**4/4"        # or: system = "duffing"; or equations without an H:
                                           # field = "u_dot = u*(v - 2); v_dot = v*(1 - u)",
                                           # see `verify.scenes.field_parts`
    parameters = { delta = "7/3" }
    schemes = ["lie2", "symplectic-euler"] # or "p_next = …; q_next = …"
    criteria = [1, 2, 3, 4]
    t0 = 0                                 # when its runs start, where H depends on t
    every_hamiltonian = true               # and what holds of the schemes for every H
    keeps = ["volume", "energy: 3"]        # what a step keeps; see `verify.scenes.keeps_section`

    [grid]                                 # runs: every step size with every initial value
    time = 20000                           # or steps = 5000
    step_sizes = [0.001, 0.01]
    initial_values = [{ q = 1.5, p = 0 }]  # of p1 … pn, q1 … qn: { q = [0.3, 0], p = [0, 0.1] }

    separate = true                        # truncation and rounding in Λ of each of these runs
    growth = true                          # Λ of each of these runs against its growth law
    growth_explains = "Figure 1"           # what of a paper that explains; may be left out

    [[separation]]                         # the same against h, for the crossover of the two
    time = 20
    step_sizes = [0.1, 0.01, 0.001]
    initial_value = { q = 1.5, p = 0 }

    [[series]]                             # thinned ΔJ(t) and Λ(t), for plots
    step_size = 0.01
    initial_value = { q = 1.5, p = 0 }
    source = "Figure 2"                    # what it repeats, for its caption; may be left out

    [work_precision]                       # error against run time; see verify.scenes.run_sections
    time = 20
    step_sizes = [0.1, 0.05, 0.025]
    initial_value = { q = 1.5, p = 0 }

    [[flow]]                               # a region carried by maps; see `region_sections`
    shape = "cat"
    centre = { q = 1, p = 0 }
    scale = 0.5
    step_size = 0.01
    steps = [5000, 20000]

    [[stroboscopic]]                       # states at multiples of a period of H
    period = 1
    step_size = 0.01
    periods = 500
    initial_values = [{ q = 1, p = 0 }]

    [[poincare]]                           # orbits where they pass a surface, in n ≥ 2 degrees
    step_size = 0.05
    time = 500
    initial_values = [{ q = [0, 0.1], p = [0.4, 0] }]

    [[reference]]                          # numbers to test against; see verify.scenes.run_sections
    step_sizes = [0.01]
    initial_values = [{ q = 1.5, p = 0 }]
    steps = [0, 1, 10, 100]

Numbers are exact: `0.001` in the file is 1/1000.
"""

from collections.abc import Mapping
from fractions import Fraction
from pathlib import Path
from typing import Annotated, Any, Self

from pydantic import Field, ValidationError, ValidationInfo, field_validator, model_validator

from verify import schemes as scheme_catalogue
from verify.drawable import drawn_by
from verify.errors import NOT_GIVEN, InputError, without_controls
from verify.hamiltonians import systems
from verify.hamiltonians.equations import read_system
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.scenes.field_parts import FieldPart, add_field_parts, check_equations, check_field_scene
from verify.scenes.frozen import Frozen, Section
from verify.scenes.keeps_section import Keeps
from verify.scenes.model_mistakes import describe_first_error
from verify.scenes.observables import check_observables
from verify.scenes.orbit_sections import Poincare, Stroboscopic
from verify.scenes.region_sections import RegionFlow
from verify.scenes.run_sections import Grid, PlottedSeries, Reference, SeparationOver, WorkPrecision
from verify.scenes.stability_sections import LargestStepOver, OrbitMap, Stability, StabilityMap
from verify.scenes.toml_file import check_depth, check_kind, read_toml, toml_data
from verify.scenes.toml_text import toml_lines
from verify.scenes.values import ExactNumber, SchemeName, SystemName, check_initial_value

_PLANE_KEYS = ("criteria", "stroboscopic")
_IDENTITY = (
    "name", "title", "system", "hamiltonian", "field", "parameters", "t0", "split", "schemes",
)  # fmt: skip
_OF_FIELDS = (*_IDENTITY, "keeps")


@drawn_by("scenes")
class Scene(Frozen):
    """A declaration of what is to be verified: H, its schemes, and sections of what is computed.

    The module's text has an example of each section, and the text below each key says what it is.
    All numbers are exact and without units. `load_scene` reads a scene from TOML, and raises an
    InputError of one line for a bad one; the class itself raises pydantic's ValidationError.
    """

    name: Annotated[str, Field(pattern=r"^[A-Za-z0-9_-]*$", max_length=80)] = ""
    """What results and files are called; the file's own name where it is left out."""
    title: str = ""
    """The headline of its part of a page."""
    system: SystemName | None = None
    """A named system; or `hamiltonian`."""
    hamiltonian: str | None = None
    """H as a formula in p, q and parameters; or `system`."""
    field: str | None = None
    """Equations without an H in place of it, as `u_dot = u*(v - 2); v_dot = v*(1 - u)`, with
    coordinates of your own names; then a scene has `keeps`, which is volume by default, and
    runs, `grid` and `series`."""
    parameters: dict[str, ExactNumber] = Field(default_factory=dict)
    """The values of H's parameters; a section that runs needs all of them."""
    t0: ExactNumber = Fraction(0)
    """When its runs start, where H depends on t."""
    split: Annotated[tuple[FieldPart, ...], Field(max_length=100)] = ()
    """The parts of a splitting of `field`, which schemes such as `A 1/2; B 1; A 1/2` compose."""
    schemes: Annotated[tuple[SchemeName, ...], Field(min_length=1, max_length=100)]
    """Names of schemes, or formulas `p_next = …; q_next = …` of your own."""
    every_hamiltonian: bool = False
    """Whether to prove what holds of the schemes for every H, too."""
    criteria: tuple[Annotated[int, Field(ge=1, le=4, strict=True)], ...] = ()
    """Which of the paper's criteria of area preservation are judged."""
    keeps: Keeps | None = None
    """What a step is meant to keep: a list, or a table with what refines it."""
    grid: Grid | None = None
    """Runs of every scheme for every step size and initial value."""
    separation: tuple[SeparationOver, ...] = ()
    """Truncation and rounding in Λ against h, and where the two cross."""
    series: tuple[PlottedSeries, ...] = ()
    """ΔJ(t) and Λ(t) of one run, for a plot."""
    work_precision: WorkPrecision | None = None
    """Error against run time."""
    flow: tuple[RegionFlow, ...] = ()
    """Regions that maps carry, and their areas."""
    stroboscopic: tuple[Stroboscopic, ...] = ()
    """Orbits looked at once in each period of H."""
    poincare: tuple[Poincare, ...] = ()
    """Orbits looked at where they pass a surface, in two degrees of freedom or more."""
    stability: tuple[Stability, ...] = ()
    """Runs, judged: stable or not, and whose fault it is."""
    largest_step: tuple[LargestStepOver, ...] = ()
    """The largest step size with bounded motion."""
    stability_map: tuple[StabilityMap, ...] = ()
    """Verdicts over step size and one parameter, as a picture."""
    orbit_map: tuple[OrbitMap, ...] = ()
    """What orbits do over two of their initial values, as a picture."""
    reference: tuple[Reference, ...] = ()
    """Numbers to test integrators against: `verify reference make`."""

    @field_validator("schemes")
    @classmethod
    def _add_parts(cls, schemes: tuple[str, ...], info: ValidationInfo) -> tuple[str, ...]:
        return add_field_parts(schemes, info.data.get("split", ()))

    @model_validator(mode="after")
    def _check(self) -> Self:
        sources = (self.system, self.hamiltonian, self.field)
        if sum(source is not None for source in sources) != 1:
            raise InputError("system, hamiltonian", NOT_GIVEN, "give one of the two, or field")
        hamiltonian = self.exact_hamiltonian()
        sections = self.sections()
        section_schemes = (name for section in sections for name in getattr(section, "schemes", ()))
        for name in dict.fromkeys((*self.schemes, *section_schemes)):
            scheme_catalogue.get(name).step_map(hamiltonian)
        if self.keeps is not None:
            self.keeps.claims(hamiltonian, prefix="keeps.")
        if self.field is not None:
            others = {name: getattr(self, name) for name in Scene.model_fields}
            check_field_scene(self.field, {n: x for n, x in others.items() if n not in _OF_FIELDS})
        self._check_degrees(hamiltonian)
        if hamiltonian.time_dependent:
            if self.grid is not None and self.grid.growth:
                problem = "depends on t; [grid] with growth = true is of orbits that close"
                raise InputError("hamiltonian", hamiltonian.formula, problem)
            for strobe in self.stroboscopic:
                strobe.check_hamiltonian(hamiltonian)
        free = set(hamiltonian.symbols)
        # A map varies its own parameter, which needs no value in the scene.
        if all(isinstance(section, StabilityMap) for section in sections):
            free -= {stability_map.parameter for stability_map in self.stability_map}
        if sections and free:
            raise InputError(
                "parameter", min(free), f"has no value; a run needs one, as {min(free)}=1"
            )
        for stability_map in self.stability_map:
            if stability_map.parameter not in hamiltonian.parameters:
                names = ", ".join(hamiltonian.parameters) or "none"
                raise InputError(
                    "parameter", stability_map.parameter, f"H has no such; it has: {names}"
                )
        return self

    def _check_degrees(self, hamiltonian: Hamiltonian) -> None:
        """Raise InputError if a start or a section does not fit H's degrees of freedom."""
        if (
            not hamiltonian.planar and self.field is None
        ):  # criteria, growth laws and others are of the plane alone
            self._check_no_plane(hamiltonian)
        for surface in self.poincare:
            surface.check_hamiltonian(hamiltonian)
        for orbit_map in self.orbit_map:
            orbit_map.check_hamiltonian(hamiltonian)
        for section in self.sections():
            for place, start in section.starts():
                check_initial_value(place, start, hamiltonian)
        for flow in self.flow:
            flow.point(hamiltonian)
        if self.grid is not None and self.grid.observables is not None:
            check_observables(hamiltonian, self.grid.observables)

    def _check_no_plane(self, hamiltonian: Hamiltonian) -> None:
        """Raise InputError if something is requested that exists in the plane alone."""
        requested = {name for name in _PLANE_KEYS if getattr(self, name)}
        requested |= {"grid.growth"} if self.grid and self.grid.growth else set()
        limits_defect = any(section.symplectic_defect is not None for section in self.largest_step)
        if self.separation or (self.grid and self.grid.separate) or limits_defect:
            check_observables(hamiltonian, ("symplectic_defect",))  # W is what is separated
        if requested:
            names = ", ".join(hamiltonian.coordinates)
            problem = f"is of {names}; {min(requested)} takes p and q, one degree of freedom"
            raise InputError("hamiltonian", hamiltonian.formula, problem)

    def sections(self) -> list[Section]:
        """Return every [section] and [[section]] of the scene."""
        values = (getattr(self, name) for name in Scene.model_fields)
        members = (x for value in values for x in (value if isinstance(value, tuple) else (value,)))
        return [x for x in members if isinstance(x, Section)]

    def with_only(self, **sections: Any) -> "Scene":
        """Return a scene with the same H and schemes, and with these sections only."""
        empty = {name: field.default for name, field in Scene.model_fields.items()
                 if name not in _IDENTITY}  # fmt: skip
        return self.model_copy(update=empty | sections)

    @property
    def begin(self) -> Fraction | None:
        """The start time t0 where H depends on time; else None."""
        return self.t0 if self.exact_hamiltonian().time_dependent else None

    def hamiltonian_fields(self) -> dict[str, Any]:
        """Return H as the fields of a task: its formula, and its exact parameter values."""
        hamiltonian = self.exact_hamiltonian()
        return {"hamiltonian": hamiltonian.formula, "parameters": dict(hamiltonian.values)}

    def exact_hamiltonian(self) -> Hamiltonian:
        """Return the Hamiltonian with the scene's parameter values."""
        if self.system is not None:
            return systems.get(self.system).hamiltonian(self.parameters)
        if self.field is not None:
            check_equations(self.field)
            return read_system(self.field, self.parameters)
        systems.check_is_formula(self.hamiltonian or "")
        return Hamiltonian.parse(self.hamiltonian or "", self.parameters)


def load_scene(path: Path) -> Scene:
    """Read a scene from a TOML file; InputError names the file, key, value and problem."""
    data = read_toml(path)
    check_kind(data, "schemes", path.name)
    return scene_from(data, path.name, default_name=path.stem)


def scene_from_toml(content: str, name: str) -> Scene:
    """Read a scene from the text of a TOML file of that name."""
    return scene_from(toml_data(content, name), name, default_name=name)


def scene_from(data: Mapping[str, Any], source: str, default_name: str = "") -> Scene:
    """Build a scene from a mapping, as TOML gives it."""
    check_depth(data, "scene", source)
    try:
        scene = Scene.model_validate(dict(data))
    except ValidationError as error:
        raise describe_first_error(error, source, Scene) from None
    return (
        scene if scene.name else scene.model_copy(update={"name": without_controls(default_name)})
    )


def scene_text(scene: Scene, *, comment: str = "") -> str:
    """Return the scene's TOML without defaults, below the lines of a comment.

    Exactly the same scene is read from it.
    """
    data = scene.model_dump(mode="json", exclude_defaults=True)
    lines = [f"# {without_controls(line)}".rstrip() for line in comment.splitlines()]
    return "\n".join([*lines, *toml_lines(data, inline=("parameters",))]) + "\n"
