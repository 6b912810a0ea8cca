"""A claim, a precise reading of a statement in a paper, and the findings by which it is judged.

A kind of claim is one file in `verify.claims.kinds`: a subclass with the claim's keys, which names
the scene, the runs and the tasks it needs, and judges. A claim's own value stands under the
name of its kind if it has one (`order = 3`); its verdict always comes with evidence.
Readings of one statement, and repairs: `verify.claims.statement_readings`.
"""

from abc import abstractmethod
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Annotated, Any, ClassVar, Self

from pydantic import Field

from verify.algebra.domain import EVERYWHERE, FormulaDomain
from verify.errors import InputError, unknown_name
from verify.execution.task import Task
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.prose import Prose, prose, read_prose
from verify.scenes.frozen import Frozen
from verify.scenes.results.claim import ClaimResult, CriterionResult, Effect, Standing
from verify.scenes.results.proof_result import ProofResult
from verify.scenes.results.run import RunResult
from verify.scenes.scene import Scene
from verify.scenes.values import SchemeName
from verify.studies.criteria_verdicts import judge as judge_criterion
from verify.studies.kinds.grid import grid_runs
from verify.studies.kinds.proofs import proof_task
from verify.verdict import Verdict


@dataclass(frozen=True)
class Findings:
    """The scenes with all results that were computed for them."""

    scenes: Mapping[str, Scene]
    results: Mapping[str, Frozen] = field(default_factory=dict)

    def scene(self, name: str) -> Scene:
        """Return the scene of that name. Raises InputError if there is none."""
        if name not in self.scenes:
            raise unknown_name("claim.scene", name, self.scenes)
        return self.scenes[name]

    def scene_of(self, claim: "Claim") -> Scene:
        """Return the claim's scene, which must have its scheme."""
        scene = self.scene(claim.scene)
        _check_scheme(scene, claim.scheme)
        return scene

    def proof(self, scene: Scene, scheme: str) -> ProofResult:
        """Return the proof for the scene's H. Raises InputError if the scene lacks the scheme."""
        _check_scheme(scene, scheme)
        result = self.results[proof_task(scene, scheme).key]
        assert isinstance(result, ProofResult)  # noqa: S101 - the key is a proof's
        return result

    def runs(self, scene: Scene, scheme: str) -> list[RunResult]:
        """Return the grid's runs by initial value, then step size; empty if none were needed."""
        return grid_runs(scene, scheme, self.results)

    def criterion(self, scene: Scene, scheme: str, number: int) -> CriterionResult:
        """Return the result of criterion 1, 2, 3 or 4, by the proof and the grid's runs."""
        return judge_criterion(number, self.proof(scene, scheme), self.runs(scene, scheme))


def _check_scheme(scene: Scene, scheme: str) -> None:
    if scheme not in scene.schemes:
        names = ", ".join(scene.schemes)
        raise InputError("claim.scheme", scheme, f"is not in scene {scene.name}: {names}")


class Claim(Frozen):
    """The base of all claims; on its own, one that algebra decides for a single H.

    `exact`: algebra alone decides it, so that it costs no run. `on_scene`: it is about a scheme
    and a scene. `run_keys`: the keys that select its runs; `one_run`: it is about one run only.
    `autonomous`: H must not depend on time; `planar`: H must have one degree of freedom;
    `of_fields`: it may be about equations without an H.
    `obstacle`: the reason why the claim cannot be transferred to other scenes; empty if it can.
    `warning`: how a reader may misunderstand the claim; empty if there is no such danger.
    Formulas in `statement` and `reading` stand between backticks. `reading_of`, `reading` and
    `standing` connect a reading with its statement; see `verify.claims.statement_readings`.
    """

    exact: ClassVar[bool] = True
    on_scene: ClassVar[bool] = True
    run_keys: ClassVar[tuple[str, ...]] = ()
    one_run: ClassVar[bool] = False
    autonomous: ClassVar[bool] = False
    planar: ClassVar[bool] = False
    of_fields: ClassVar[bool] = False
    obstacle: ClassVar[str] = ""
    warning: ClassVar[str] = ""

    id: Annotated[str, Field(pattern=r"^[^\s\x00-\x1f]+$", max_length=80)]
    """The claim's name, unique in its file."""
    kind: str
    """The kind of claim."""
    source: str = ""
    """The place in the paper, such as `Eq. 19`."""
    section: str = ""
    """The headline under which a report lists it."""
    statement: str = ""
    """The paper's statement in words; a formula stands between backticks."""
    reading_of: str = ""
    """The statement of which this is a reading."""
    reading: str = ""
    """The interpretation of the statement, in words."""
    standing: Standing = "fair"
    """The standing of the reading: its closeness to the printed text."""
    repaired: str = ""
    """The statement as it would be right; this claim's verdict is on it."""
    repairs: str = ""
    """The statement that a claim of ours repairs; a reading with `repaired` repairs its own."""
    effect: Effect = ""
    """What the repair changes in the paper: nothing else, a table, or a conclusion."""
    remark: str = ""
    """A remark for readers of the verdict; formulas as in `statement`."""
    confirmed_by: str = ""
    """An independent computation that confirms it, such as the name of a test."""
    scene: str = ""
    """The scene that it speaks of: a `[[scene]]` of the file, or a file beside it."""
    scheme: SchemeName
    """The scheme that it speaks of."""

    # -- of which scene it speaks -----------------------------------------------------------------

    def separate_scene(
        self, label: str, scene: Scene, runs: Mapping[str, Any]
    ) -> tuple[str, Scene]:
        """Return a unique name, and the scene for the claim's own H with its `runs`."""
        return f"{label}: claim {self.id}", scene

    def selected_scene(self, name: str, scene: Scene, runs: Mapping[str, Any]) -> tuple[str, Scene]:
        """Return the name and the scene of a claim that refers to this scene.

        Raises InputError if the scene lacks what the claim is about.
        """
        if self.scheme not in scene.schemes:
            names = ", ".join(scene.schemes)
            raise InputError("scheme", self.scheme, f"is not in scene {name}: {names}")
        return name, scene

    def check_scene(self, scene: Scene) -> None:
        """Raise InputError if the claim cannot be judged on this scene."""

    # -- what it needs, and its verdict -----------------------------------------------------------

    def tasks(self, scene: Scene) -> Iterable[Task]:
        """Return the tasks whose results the claim's verdict needs."""
        return ()

    def tasks_without_scene(self) -> Iterable[Task]:
        """Return the tasks of a claim that has no scene."""
        return ()

    def refined_scene(self, scene: Scene) -> Scene | None:
        """Return the scene with more accurate runs, which may decide the claim; None if there is
        no such scene."""
        return None

    @abstractmethod
    def judge(self, findings: Findings) -> ClaimResult:
        """Return the verdict with its evidence. Raises InputError if a scene or run is missing."""

    def checked_by(self, result: ClaimResult, findings: Findings) -> Sequence[Prose]:
        """Return who checked the proof of this `result`, one text each; empty if nobody did."""
        return ()

    def result(
        self,
        verdict: Verdict,
        evidence: str,
        details: Sequence[Sequence[str]] = (),
        proof: str = "",
        domain: FormulaDomain = EVERYWHERE,
    ) -> ClaimResult:
        """Build the claim's result; `details` is a table whose first row is its head."""
        return ClaimResult.from_object(
            self,
            statement=read_prose(self.statement),
            statement_id=self.reading_of,
            reading=read_prose(self.reading),
            repaired=read_prose(self.repaired),
            repairs=self.repairs or (self.reading_of if self.repaired else ""),
            verdict=verdict,
            evidence=prose(evidence),
            domain=domain.texts,
            details=tuple(tuple(map(prose, row)) for row in details),
            proof=prose(proof),
            remark=read_prose(self.remark),
            checked_by=(),  # added by the caller: `checked_by` of a claim takes its result
        )

    # -- the same of other scenes -----------------------------------------------------------------

    def why_not_transferable(self) -> str:
        """Return why the claim cannot be made on drawn scenes; empty if it can."""
        return self.obstacle

    def for_hamiltonian(self, hamiltonian: Hamiltonian) -> Self:
        """Return the claim for this H alone that follows from a claim for every H."""
        return self

    def drawn_runs(self, step_size: Fraction, steps: int) -> dict[str, Any]:
        """Return the keys of its runs for a drawn run with this step size and number of steps."""
        return {"step_size": step_size, "steps": steps}


# -- one that cannot be read ----------------------------------------------------------------------

# These keys can be read even where the claim itself cannot: they keep its place in the
# report and in the count of its statement.
KEYS_OF_READINGS = ("reading_of", "reading", "standing")
_READABLE = ("id", "kind", "source", "section", "statement", "scheme", *KEYS_OF_READINGS)


class OutsideClaim(Claim):
    """A claim that exceeds the limits or uses unknown functions.

    It is UNDECIDED, so that the other claims of its file are still judged. `problem` says in one
    line which limit it exceeds.
    """

    on_scene = False
    obstacle = "it could not be read"
    problem: str

    def judge(self, findings: Findings) -> ClaimResult:
        return self.result(Verdict.UNDECIDED, prose(self.problem))


def outside(table: Mapping[str, Any], problem: str) -> OutsideClaim:
    """Build the undecided claim from its TOML table.

    Raises pydantic's ValidationError if one of its texts is not a text.
    """
    texts = {key: table[key] for key in _READABLE if key in table}
    return OutsideClaim.model_validate({"scheme": "", **texts, "problem": problem})
