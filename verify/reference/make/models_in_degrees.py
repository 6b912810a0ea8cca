"""What the files of reference data in n degrees of freedom hold; a JSON Schema is made from them.

As `verify.reference.make.models` in the plane, with q and p as lists, and S in place of ΔJ.
"""

from fractions import Fraction
from typing import Annotated, Literal

from pydantic import ConfigDict, Field

from verify.reference.make.models import (
    ConvergenceOrder,
    Data,
    Digits,
    Exact,
    Flow,
    OfScheme,
    Parameters,
    Proof,
    Proved,
    Run,
    SceneName,
    Started,
    StepSize,
    Tables,
)
from verify.scenes.results.reference_in_degrees import FlowPointInDegrees, OrbitPointInDegrees

DataInDegreesFormat = Literal["areaproof reference data in degrees 1"]
DATA_IN_DEGREES_FORMAT: DataInDegreesFormat = "areaproof reference data in degrees 1"
_HEAD = 100  # bytes of a file, in which its format stands: a key that comes first
_List = Annotated[tuple[Exact, ...], Field(min_length=2)]


def is_of_degrees(content: bytes) -> bool:
    """Whether a file that begins so has the format of data in n degrees of freedom."""
    return DATA_IN_DEGREES_FORMAT.encode() in content[:_HEAD]


class ProofInDegrees(OfScheme):
    """What is proved of one scheme for this H, by exact algebra."""

    verdict: Proved
    symplectic: Annotated[
        bool | None, Field(description="whether S is 0 for all z and h; null: not decided")
    ]
    area_preserving: Annotated[
        bool | None, Field(description="whether det J is 1 for all z and h; null: not decided")
    ]
    order: Annotated[
        int | None, Field(ge=1, description="S = leading·h^order + …; null where S is 0 for all")
    ]
    leading: Annotated[
        dict[str, str],
        Field(description="the entries of the leading coefficient of S that are not 0, such as "
              "dp1∧dq2, each a formula in z; none where S is 0, or where they are too long"),
    ]  # fmt: skip
    convergence_order: ConvergenceOrder


class _FromStart(Started):
    step_size: StepSize
    q: Annotated[_List, Field(description="the initial displacements q1 … qn exactly")]
    p: Annotated[_List, Field(description="the initial momenta p1 … pn exactly")]
    t0: Annotated[
        Exact | None,
        Field(description="the time at the start exactly; null where H does not depend on time"),
    ]
    digits: Digits

    @property
    def start(self) -> dict[str, Fraction]:
        """p1 … pn, q1 … qn at the start, and t₀ where H depends on time."""
        found = {
            f"{letter}{k}": Fraction(x)
            for letter, own in (("p", self.p), ("q", self.q))
            for k, x in enumerate(own, start=1)
        }
        return found | ({} if self.t0 is None else {"t": Fraction(self.t0)})

    @property
    def told(self) -> str:
        """Step size and start, in words."""
        q, p = (", ".join(own) for own in (self.q, self.p))
        begins = "" if self.t0 is None else f", t0 = {self.t0}"
        return f"h = {self.step_size}, q = ({q}), p = ({p}){begins}"


class RunInDegrees(_FromStart, OfScheme):
    """One scheme's orbit from one initial value with one step size."""

    rows: Annotated[
        tuple[OrbitPointInDegrees, ...], Field(description="one a chosen step, ascending")
    ]


class FlowInDegrees(_FromStart):
    """The exact solution of p' = −∂H/∂q, q' = ∂H/∂p from one initial value, at the times N·h."""

    rows: Annotated[
        tuple[FlowPointInDegrees, ...], Field(description="one a chosen step, ascending")
    ]


class DataInDegrees(Tables):
    """Reference data of one scene in n degrees of freedom: one H(p1 … pn, q1 … qn), its schemes,
    step sizes and initial values."""

    model_config = ConfigDict(title="areaproof reference data in n degrees of freedom")

    format: Annotated[DataInDegreesFormat, Field(description="this format")]
    name: SceneName
    hamiltonian: Annotated[
        str,
        Field(description="the formula of H in p1 … pn, q1 … qn, t and the parameters; "
              "** is a power"),
    ]  # fmt: skip
    parameters: Parameters
    degrees: Annotated[int, Field(ge=2, description="n, the degrees of freedom")]
    proofs: Annotated[tuple[ProofInDegrees, ...], Field(description="one a scheme")]
    runs: Annotated[
        tuple[RunInDegrees, ...], Field(description="one a scheme, initial value and step size")
    ]
    flow: Annotated[
        tuple[FlowInDegrees, ...], Field(description="one an initial value and step size")
    ]

    @property
    def timed(self) -> bool:
        """Whether H depends on time."""
        return any(of.t0 is not None for of in (*self.runs, *self.flow))


AnyProof = Proof | ProofInDegrees
AnyRun = Run | RunInDegrees
AnyFlow = Flow | FlowInDegrees
AnyData = Data | DataInDegrees
