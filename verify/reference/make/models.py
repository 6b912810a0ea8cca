"""What the files of reference data hold. The published JSON Schemas are made from these models."""

from fractions import Fraction
from typing import Annotated, Literal

from pydantic import ConfigDict, Field

from verify.scenes.frozen import Frozen
from verify.scenes.results.reference import FlowPoint, OrbitPoint
from verify.verdict import Verdict

DataFormat = Literal["areaproof reference data 1"]
ManifestFormat = Literal["areaproof reference manifest 1"]
DATA_FORMAT: DataFormat = "areaproof reference data 1"
MANIFEST_FORMAT: ManifestFormat = "areaproof reference manifest 1"
_SHA256 = r"^[0-9a-f]{64}$"
_EXACT = r"^-?[0-9]+(\.[0-9]+|/[0-9]+)?$"
Exact = Annotated[str, Field(pattern=_EXACT)]
Name = Annotated[str, Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9._-]*$", max_length=120)]
Digest = Annotated[str, Field(pattern=_SHA256)]
SceneName = Annotated[Name, Field(description="the scene's name; the files begin with it")]
Parameters = Annotated[
    dict[str, Exact], Field(description="each parameter's exact value by its name")
]
StepSize = Annotated[Exact, Field(description="the step size h exactly: a decimal or a quotient")]
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


class Started(Frozen):
    """What begins somewhere: `told` is its step size and start, in words."""

    @property
    def label(self) -> str:
        """The scheme, or that it is the exact flow, and its inputs."""
        return f"{getattr(self, 'scheme', 'exact flow')}, {self.told}"

    @property
    def told(self) -> str:
        raise NotImplementedError


class Tables(Frozen):
    """What is of one scene: proofs, runs and exact solutions."""

    @property
    def count(self) -> int:
        """The rows of all tables."""
        proofs, runs, flow = (getattr(self, name) for name in ("proofs", "runs", "flow"))
        return len(proofs) + sum(len(each.rows) for each in (*runs, *flow))


class OfScheme(Frozen):
    """A row that is of one scheme."""

    scheme: Annotated[
        str, Field(description="the scheme, by the name that `verify run --scheme` takes")
    ]


class Proof(OfScheme):
    """What is proved of one scheme for this H, by exact algebra."""

    verdict: Proved
    area_preserving: Annotated[
        bool | None, Field(description="whether ΔJ is 0 for all p, q and h; null: not decided")
    ]
    order: Annotated[
        int | None, Field(ge=1, description="ΔJ = leading·h^order + …; null where ΔJ is 0 for all")
    ]
    leading: Annotated[
        str, Field(description="the leading coefficient of ΔJ, a formula in p and q; 0 if ΔJ is 0")
    ]
    convergence_order: ConvergenceOrder


class _FromStart(Started):
    step_size: StepSize
    q: Annotated[Exact, Field(description="the initial displacement q exactly")]
    p: Annotated[Exact, Field(description="the initial momentum p exactly")]
    digits: Digits

    @property
    def start(self) -> dict[str, Fraction]:
        """q and p at the start, and t₀ where H depends on time."""
        return {"q": Fraction(self.q), "p": Fraction(self.p)}

    @property
    def told(self) -> str:
        """Step size and start, in words."""
        return f"h = {self.step_size}, (q, p) = ({self.q}, {self.p})"


class _FromTime(_FromStart):
    """Of an H that depends on time."""

    t0: Annotated[Exact, Field(description="the time at the start exactly")]

    @property
    def start(self) -> dict[str, Fraction]:
        return super().start | {"t": Fraction(self.t0)}

    @property
    def told(self) -> str:
        return f"{super().told}, t0 = {self.t0}"


class Run(_FromStart, OfScheme):
    """One scheme's orbit from one initial value with one step size."""

    rows: Annotated[tuple[OrbitPoint, ...], Field(description="one a chosen step, ascending")]


class RunInTime(_FromTime, Run):
    """The same for an H that depends on time, from a time on."""


class Flow(_FromStart):
    """The exact solution of p' = −H_q, q' = H_p from one initial value, at the times N·h."""

    rows: Annotated[tuple[FlowPoint, ...], Field(description="one a chosen step, ascending")]


class FlowInTime(_FromTime, Flow):
    """The same for an H that depends on time; N·h is the time since the start."""


class Data(Tables):
    """Reference data of one scene: one Hamiltonian, its schemes, step sizes and initial values."""

    model_config = ConfigDict(title="areaproof reference data")

    format: Annotated[DataFormat, Field(description="this format")]
    name: SceneName
    hamiltonian: Annotated[
        str,
        Field(
            description="the formula of H(p, q), or H(p, q, t), in p, q, t and the parameters; "
            "** is a power"
        ),
    ]
    parameters: Parameters
    proofs: Annotated[tuple[Proof, ...], Field(description="one a scheme")]
    runs: Annotated[
        tuple[RunInTime | Run, ...], Field(description="one a scheme, initial value and step size")
    ]
    flow: Annotated[
        tuple[FlowInTime | Flow, ...], Field(description="one an initial value and step size")
    ]

    @property
    def degrees(self) -> int:
        """n, the degrees of freedom."""
        return 1

    @property
    def timed(self) -> bool:
        """Whether H depends on time."""
        return any(isinstance(of, _FromTime) for of in (*self.runs, *self.flow))


class SceneFile(Frozen):
    """A scene that data were made from."""

    name: Annotated[Name, Field(description="the scene's name")]
    toml: Annotated[str, Field(description="the scene as it was written, a TOML text")]
    sha256: Annotated[Digest, Field(description="SHA-256 of that text in UTF-8")]


class ListedFile(Frozen):
    """A file beside the manifest."""

    name: Annotated[Name, Field(description="its name in the manifest's folder")]
    bytes: Annotated[int, Field(ge=0, description="its size")]
    sha256: Annotated[Digest, Field(description="SHA-256 of its content")]


class Manifest(Frozen):
    """What made a folder of reference data, and each file that belongs to it."""

    model_config = ConfigDict(title="areaproof reference manifest")

    format: Annotated[ManifestFormat, Field(description="this format")]
    command: Annotated[str, Field(description="the command that made the files")]
    versions: Annotated[
        dict[str, str], Field(description="versions of Python and of the libraries that did")
    ]
    scenes: Annotated[tuple[SceneFile, ...], Field(description="what was asked for")]
    files: Annotated[
        tuple[ListedFile, ...], Field(description="all files but the manifest itself, by name")
    ]
