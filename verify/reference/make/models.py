"""Models of the files of reference data. The published JSON Schemas are made from them.

The formats are two: in the plane q and p of a start are a number each, and S is ΔJ; in n degrees of
freedom they are lists.
"""

from fractions import Fraction
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import ConfigDict, Field

from verify.formats import names_format
from verify.hamiltonians.coordinates import coordinates_in
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.reference.make.row_values import start_columns
from verify.scenes.frozen import Frozen
from verify.scenes.results import reference
from verify.structures import AREA, SYMPLECTIC, structure_in
from verify.verdict import Verdict

DataFormat = Literal["areaproof reference data 1"]
DataInDegreesFormat = Literal["areaproof reference data in degrees 1"]
DATA_FORMAT: DataFormat = "areaproof reference data 1"
DATA_IN_DEGREES_FORMAT: DataInDegreesFormat = "areaproof reference data in degrees 1"
_EXACT = r"^-?[0-9]+(\.[0-9]+|/[0-9]+)?$"
Exact = Annotated[str, Field(pattern=_EXACT)]
_List = Annotated[tuple[Exact, ...], Field(min_length=2)]
Name = Annotated[str, Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9._-]*$", max_length=120)]
Digits = Annotated[int, Field(ge=1, description="significant digits of each number")]
Proved = Annotated[Verdict, Field(description="PROVED where all of this row is proved")]
ConvergenceOrder = Annotated[
    int | None,
    Field(
        ge=0,
        description="one step agrees with the exact flow up to h to this power; null "
        "where all coefficients that were looked at agree",
    ),
]
Ascending = Field(description="one a chosen step, ascending")


class WithStart(Frozen):
    """A start, and the step size with which it is gone on from there."""

    step_size: Exact = Field(description="the step size h exactly: a decimal or a quotient")
    q: Any
    p: Any

    @property
    def label(self) -> str:
        """The scheme, or that it is the exact flow, and its inputs in words."""
        q, p = (x if isinstance(x, str) else f"({', '.join(x)})" for x in (self.q, self.p))
        start = f"(q, p) = ({q}, {p})" if isinstance(self.q, str) else f"q = {q}, p = {p}"
        begins = "" if self.begins is None else f", t0 = {self.begins}"
        return f"{getattr(self, 'scheme', 'exact flow')}, h = {self.step_size}, {start}{begins}"

    @property
    def begins(self) -> str | None:
        """The time at the start, where H depends on time."""
        return getattr(self, "t0", None)

    @property
    def texts(self) -> dict[str, str]:
        """q and p at the start by the columns of a table."""
        q, p = ((x,) if isinstance(x, str) else x for x in (self.q, self.p))
        return dict(zip(start_columns(len(q)), (*q, *p), strict=False))  # a file may be wrong

    @property
    def start(self) -> dict[str, Fraction]:
        """The coordinates at the start, and t where H depends on time."""
        numbers, half = [*map(Fraction, self.texts.values())], len(self.texts) // 2
        point = dict(zip(coordinates_in(half), numbers[half:] + numbers[:half], strict=True))
        return point if self.begins is None else point | {"t": Fraction(self.begins)}


class _InPlane(WithStart):
    q: Exact = Field(description="the initial displacement q exactly")
    p: Exact = Field(description="the initial momentum p exactly")
    digits: Digits


class _InTime(_InPlane):
    t0: Exact = Field(description="the time at the start exactly")


class _InDegrees(WithStart):
    q: _List = Field(description="the initial displacements q1 … qn exactly")
    p: _List = Field(description="the initial momenta p1 … pn exactly")
    t0: Exact | None = Field(
        description="the time at the start exactly; null where H does not depend on time"
    )
    digits: Digits


class WithScheme(Frozen):
    """A row that is of one scheme."""

    scheme: str = Field(description="the scheme, by the name that `verify run --scheme` takes")


# The first lines of the docstrings of these models are printed in the published JSON Schemas:
# whoever changes one makes the committed data anew.
class Proof(WithScheme):
    """What is proved of one scheme for this H, by exact algebra."""

    verdict: Proved
    area_preserving: bool | None = Field(
        description="whether ΔJ is 0 for all p, q and h; null: not decided"
    )
    order: int | None = Field(
        ge=1, description="ΔJ = leading·h^order + …; null where ΔJ is 0 for all"
    )
    leading: str = Field(
        description="the leading coefficient of ΔJ, a formula in p and q; 0 if ΔJ is 0"
    )
    convergence_order: ConvergenceOrder

    @property
    def symplectic(self) -> bool | None:
        """True if S is 0, of which ΔJ is all."""
        return self.area_preserving

    @property
    def entries(self) -> dict[str, str]:
        """The entries of S's leading coefficient: one, which needs no name."""
        return {"": self.leading}


class ProofInDegrees(WithScheme):
    """What is proved of one scheme for this H, by exact algebra."""

    verdict: Proved
    symplectic: bool | None = Field(description="whether S is 0 for all z and h; null: not decided")
    area_preserving: bool | None = Field(
        description="whether det J is 1 for all z and h; null: not decided"
    )
    order: int | None = Field(
        ge=1, description="S = leading·h^order + …; null where S is 0 for all"
    )
    leading: dict[str, str] = Field(
        description="the entries of the leading coefficient of S that are not 0, such as "
        "dp1∧dq2, each a formula in z; none where S is 0, or where they are too long"
    )
    convergence_order: ConvergenceOrder

    @property
    def entries(self) -> dict[str, str]:
        """The entries of S's leading coefficient that are not 0."""
        return self.leading


class Run(_InPlane, WithScheme):
    """One scheme's orbit from one initial value with one step size."""

    rows: tuple[reference.OrbitPoint, ...] = Ascending


class RunInTime(_InTime, Run):
    """The same for an H that depends on time, from a time on."""


class RunInDegrees(_InDegrees, WithScheme):
    """One scheme's orbit from one initial value with one step size."""

    rows: tuple[reference.OrbitPointInDegrees, ...] = Ascending


class Flow(_InPlane):
    """The exact solution of p' = −H_q, q' = H_p from one initial value, at the times N·h."""

    rows: tuple[reference.FlowPoint, ...] = Ascending


class FlowInTime(_InTime, Flow):
    """The same for an H that depends on time; N·h is the time since the start."""


class FlowInDegrees(_InDegrees):
    """The exact solution of p' = −∂H/∂q, q' = ∂H/∂p from one initial value, at the times N·h."""

    rows: tuple[reference.FlowPointInDegrees, ...] = Ascending


class _SceneData(Frozen):
    format: str = Field(description="this format")
    name: Name = Field(description="the scene's name; the files begin with it")
    hamiltonian: str
    parameters: dict[str, Exact] = Field(description="each parameter's exact value by its name")

    @property
    def count(self) -> int:
        """The rows of all tables."""
        fields = dict(self)
        return len(fields["proofs"]) + sum(
            len(item.rows) for item in (*fields["runs"], *fields["flow"])
        )

    @property
    def time_dependent(self) -> bool:
        """True if H depends on time."""
        fields = dict(self)
        return any(item.begins is not None for item in (*fields["runs"], *fields["flow"]))


class Data(_SceneData):
    """Reference data of one scene: one Hamiltonian, its schemes, step sizes and initial values."""

    model_config = ConfigDict(title="areaproof reference data")

    format: DataFormat = Field(description="this format")
    hamiltonian: str = Field(
        description="the formula of H(p, q), or H(p, q, t), in p, q, t and the parameters; "
        "** is a power"
    )
    proofs: tuple[Proof, ...] = Field(description="one a scheme")
    runs: tuple[RunInTime | Run, ...] = Field(
        description="one a scheme, initial value and step size"
    )
    flow: tuple[FlowInTime | Flow, ...] = Field(description="one an initial value and step size")

    @property
    def degrees(self) -> int:
        """n, the degrees of freedom."""
        return 1


class DataInDegrees(_SceneData):
    """Reference data of one scene in n degrees of freedom: one H(p1 … pn, q1 … qn), its schemes,
    step sizes and initial values."""

    model_config = ConfigDict(title="areaproof reference data in n degrees of freedom")

    format: DataInDegreesFormat = Field(description="this format")
    hamiltonian: str = Field(
        description="the formula of H in p1 … pn, q1 … qn, t and the parameters; ** is a power"
    )
    degrees: int = Field(ge=2, description="n, the degrees of freedom")
    proofs: tuple[ProofInDegrees, ...] = Field(description="one a scheme")
    runs: tuple[RunInDegrees, ...] = Field(description="one a scheme, initial value and step size")
    flow: tuple[FlowInDegrees, ...] = Field(description="one an initial value and step size")


AnyProof = Proof | ProofInDegrees
AnyRun = Run | RunInDegrees
AnyFlow = Flow | FlowInDegrees
AnyData = Data | DataInDegrees
MODELS: dict[str, type[AnyData]] = {DATA_FORMAT: Data, DATA_IN_DEGREES_FORMAT: DataInDegrees}


# The format follows from the structure: area in the plane, the symplectic form beyond.
_FORMATS = {AREA: DATA_FORMAT, SYMPLECTIC: DATA_IN_DEGREES_FORMAT}


def format_of(degrees: int) -> str:
    """Return the format of data in so many degrees of freedom."""
    return _FORMATS[structure_in(degrees)]


def heading(hamiltonian: Hamiltonian) -> dict[str, Any]:
    """Return a file's fields of H: its formula and parameters, and in its format the degrees."""
    values = {**hamiltonian.texts, "degrees": hamiltonian.degrees}
    fields = MODELS[format_of(hamiltonian.degrees)].model_fields
    return {name: x for name, x in values.items() if name in fields}


def format_at(path: Path) -> str:
    """Return the format of a file of data; the plane's, too, where it names none."""
    several = names_format(path, DATA_IN_DEGREES_FORMAT)
    return DATA_IN_DEGREES_FORMAT if several else DATA_FORMAT
