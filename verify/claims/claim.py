"""A claim: a precise reading of what a paper states, with all that is asked of it.

A kind of claim is one file in `verify.claims.kinds`: a subclass that has the keys, says of which
scene and runs it speaks, which tasks it needs, and judges. A claim's own value stands under the
name of its kind where it has one (`order = 3`); its verdict always comes with evidence.
"""

from abc import abstractmethod
from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction
from typing import Annotated, Any, ClassVar, Self

from pydantic import Field

from verify.algebra.domain import EVERYWHERE, Domain
from verify.claims.findings import Findings
from verify.errors import InputError
from verify.execution.task import Task
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.prose import Prose, prose, read_prose
from verify.scenes.frozen import Frozen
from verify.scenes.results.claim import ClaimResult, Standing
from verify.scenes.scene import Scene
from verify.scenes.values import SchemeName
from verify.verdict import Verdict


class Claim(Frozen):
    """What claims of every kind have; this base is of what algebra decides of one H.

    `exact`: decided by algebra alone, so that it costs no run. `on_scene`: it speaks of a scheme
    and a scene. `run_keys`: the keys that say of which runs it speaks, and `one_run` whether it
    speaks of one only. `autonomous`: whether it speaks of no H that depends on time; `planar`:
    whether of an H in one degree of freedom only. `only_here`: why other scenes cannot be asked the
    same; empty where they can. `warning`: what a reader of the claim may take amiss; empty where
    nothing is. Formulas in `statement` and `reading` stand between backticks.
    `reading_of`, `reading` and `standing`: of which statement it is a reading, see
    `verify.claims.readings`.
    """

    exact: ClassVar[bool] = True
    on_scene: ClassVar[bool] = True
    run_keys: ClassVar[tuple[str, ...]] = ()
    one_run: ClassVar[bool] = False
    autonomous: ClassVar[bool] = False
    planar: ClassVar[bool] = False
    only_here: ClassVar[str] = ""
    warning: ClassVar[str] = ""

    id: Annotated[str, Field(pattern=r"^[^\s\x00-\x1f]+$", max_length=80)]
    """What the claim is called, each its own."""
    kind: str
    """Which kind of claim it is."""
    source: str = ""
    """Where the paper states it, such as `Eq. 19`."""
    section: str = ""
    """Under which headline a report has it."""
    statement: str = ""
    """What the paper states, in words; a formula stands between backticks."""
    reading_of: str = ""
    """Of which statement it is one reading."""
    reading: str = ""
    """How that reading takes the statement, in words."""
    standing: Standing = "fair"
    """How close the reading is to what is printed."""
    remark: str = ""
    """What a reader of the verdict should know beside it; formulas as in `statement`."""
    confirmed_by: str = ""
    """What computes it again with other code, such as the name of a test."""
    scene: str = ""
    """The scene that it speaks of: a `[[scene]]` of the file, or a file beside it."""
    scheme: SchemeName
    """The scheme that it speaks of."""

    # -- of which scene it speaks -----------------------------------------------------------------

    def scene_of_its_own(
        self, label: str, scene: Scene, runs: Mapping[str, Any]
    ) -> tuple[str, Scene]:
        """The scene for the claim's own H, with its `runs`, under a name that no other has."""
        return f"{label}: claim {self.id}", scene

    def scene_on(self, name: str, scene: Scene, runs: Mapping[str, Any]) -> tuple[str, Scene]:
        """The scene that the claim speaks of and its name, where it names this one.

        Raises InputError where the scene has nothing that it speaks of.
        """
        if self.scheme not in scene.schemes:
            known = ", ".join(scene.schemes)
            raise InputError("scheme", self.scheme, f"is not in scene {name}: {known}")
        return name, scene

    def check_scene(self, scene: Scene) -> None:
        """Raises InputError where the scene cannot be asked what the claim says."""

    # -- what it needs, and its verdict -----------------------------------------------------------

    def tasks(self, scene: Scene) -> Iterable[Task]:
        """What is to be computed before the claim can be judged."""
        return ()

    def tasks_without_scene(self) -> Iterable[Task]:
        """The same of a claim that speaks of no scene."""
        return ()

    def closer(self, scene: Scene) -> Scene | None:
        """The scene with runs that may decide what those of this one leave open; None: there are
        none."""
        return None

    @abstractmethod
    def judge(self, findings: Findings) -> ClaimResult:
        """The verdict with its evidence. Raises InputError where a scene or a run is missing."""

    def checked_by(self, found: ClaimResult, findings: Findings) -> Sequence[Prose]:
        """Who checked the proof by which it was `found`, one text each; none where nobody did."""
        return ()

    def result(
        self,
        verdict: Verdict,
        evidence: str,
        details: Sequence[Sequence[str]] = (),
        proof: str = "",
        domain: Domain = EVERYWHERE,
    ) -> ClaimResult:
        """The result for the claim; `details` is a table whose first row is its head."""
        return ClaimResult(
            id=self.id,
            kind=self.kind,
            source=self.source,
            section=self.section,
            statement=read_prose(self.statement),
            statement_id=self.reading_of,
            reading=read_prose(self.reading),
            standing=self.standing,
            scene=self.scene,
            verdict=verdict,
            evidence=prose(evidence),
            domain=domain.texts,
            details=tuple(tuple(map(prose, row)) for row in details),
            proof=prose(proof),
            remark=read_prose(self.remark),
            confirmed_by=self.confirmed_by,
        )

    # -- the same of other scenes -----------------------------------------------------------------

    def why_only_here(self) -> str:
        """Why drawn scenes cannot be asked what the claim says; empty where they can."""
        return self.only_here

    def of_one(self, hamiltonian: Hamiltonian) -> Self:
        """What a claim of every H says of this one."""
        return self

    def drawn_runs(self, step_size: Fraction, steps: int) -> dict[str, Any]:
        """The keys of its runs, for a drawn run of so many steps."""
        return {"step_size": step_size, "steps": steps}


# -- one that cannot be read ----------------------------------------------------------------------

_OF_READINGS = ("reading_of", "reading", "standing")
_KEPT = ("id", "kind", "source", "section", "statement", "scheme", *_OF_READINGS)


class OutsideClaim(Claim):
    """One that is too large, or in functions that are not known; so it is undecided, and the others
    of its file are none the worse for it. `problem`: what is beyond the limits, in one line."""

    on_scene = False
    only_here = "it could not be read"
    problem: str

    def judge(self, findings: Findings) -> ClaimResult:
        return self.result(Verdict.UNDECIDED, prose(self.problem))


def outside(table: Mapping[str, Any], problem: str) -> OutsideClaim:
    """The claim of that table. Raises pydantic's ValidationError where its texts are none."""
    known = {key: table[key] for key in _KEPT if key in table}
    return OutsideClaim.model_validate({"scheme": "", **known, "problem": problem})
