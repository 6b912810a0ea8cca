"""Claims about numbers, decided by runs whose values carry error bounds: their bases.

A comparison counts only if the enclosures of both sides are disjoint; else the answer is
UNDECIDED. These keys select the runs: `step_size` or `step_sizes`, `time` or `steps`, `q` and `p`
or `initial_values`, and `digits`. A claim on a named scene takes from the scene's grid what it does
not specify itself.
"""

from abc import abstractmethod
from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction
from typing import Annotated, Any, ClassVar, Self

from pydantic import Field, model_validator

from verify.arithmetic.arb import precision
from verify.arithmetic.exact import text
from verify.claims.base_claim import Claim, Findings
from verify.claims.kinds import models
from verify.claims.quantities import QUANTITIES, NoValueError, Quantity
from verify.errors import NOT_GIVEN, InputError
from verify.execution.task import Task
from verify.scenes import values
from verify.scenes.frozen import Frozen
from verify.scenes.results.claim import ClaimResult
from verify.scenes.results.run import RunResult
from verify.scenes.run_sections import Grid
from verify.scenes.scene import Scene
from verify.studies.kinds.grid import grid_tasks
from verify.verdict import Verdict

_LEAST_DIGITS = 20  # certified of every value, unless the claim asks for more or fewer
_MORE_DIGITS = 5  # than are printed


class RunKeys(Frozen):
    """The keys that select runs; None if the claim does not specify them."""

    step_size: values.StepSize | None = None
    """The step size h."""
    step_sizes: tuple[values.StepSize, ...] | None = None
    """The step sizes, if there are several."""
    time: values.Time | None = None
    """The length of each run, N = T/h rounded down; or `steps`."""
    steps: values.Steps | None = None
    """The number of steps of each run; or `time`."""
    q: values.Coordinates | None = None
    """The initial displacement; in n degrees of freedom a list."""
    p: values.Coordinates | None = None
    """The initial momentum; as q."""
    initial_values: tuple[values.Start, ...] | None = None
    """The initial values, if there are several."""
    digits: values.Digits | None = None
    """Certified digits; by default 20, and five more than are printed."""


class RunClaim(Claim):
    """The base of the kinds that runs decide.

    `separate_runs`: it takes certified runs of its own, even if the scene has a grid. `compares`:
    the quantities that it compares, if they are the same for every claim of the kind.
    """

    exact = False
    run_keys = tuple(RunKeys.model_fields)
    obstacle = "printed numbers are those of its own runs"
    separate_runs: ClassVar[bool] = False
    compares: ClassVar[tuple[str, ...]] = ()

    def quantities(self) -> tuple[str, ...]:
        """Return the names of its quantities, keys of `verify.claims.quantities.QUANTITIES`."""
        return self.compares

    def observables(self) -> tuple[str, ...]:
        """Return the observables that its quantities need, which its own runs compute."""
        return tuple(dict.fromkeys(o for name in self.quantities() for o in QUANTITIES[name].needs))

    def printed_texts(self) -> list[str]:
        """Return the printed decimals, all of whose digits its runs must certify."""
        return []

    # -- of which runs it speaks ------------------------------------------------------------------

    def separate_scene(
        self, label: str, scene: Scene, runs: Mapping[str, Any]
    ) -> tuple[str, Scene]:
        return self._with_grid(label, scene, None, runs)

    def selected_scene(self, name: str, scene: Scene, runs: Mapping[str, Any]) -> tuple[str, Scene]:
        if not runs:
            super().selected_scene(name, scene, runs)
        # A key that is also a field of the claim selects among the runs of the scene's grid; only
        # the other keys require new runs.
        if self.separate_runs or set(runs) - set(type(self).model_fields):
            bare = {"schemes": (self.scheme,), "grid": None, "separation": (), "series": ()}
            return self._with_grid(name, scene.model_copy(update=bare), scene.grid, runs)
        self.check_grid(name, scene)
        return name, scene

    def check_grid(self, name: str, scene: Scene) -> None:
        """Raise InputError if the scene has no runs that the claim could be about."""
        if scene.grid is None:
            raise InputError("scene", name, "has no [grid]; say which runs: step_size, steps, q, p")

    def check_scene(self, scene: Scene) -> None:
        grid = scene.grid if self.one_run else None
        if grid is not None and len(grid.step_sizes) * len(grid.initial_values) > 1:
            raise InputError("", NOT_GIVEN, "speaks of one run; give step_size, q and p")

    def _with_grid(
        self, label: str, scene: Scene, base: Grid | None, runs: Mapping[str, Any]
    ) -> tuple[str, Scene]:
        keys = RunKeys.model_validate(runs)
        # A decimal with n digits is decided by n + 5 certified ones, unless the value is very close
        # to a border of rounding; then the claim is undecided, and may ask for more `digits`.
        longest = max((len(t.partition("e")[0]) for t in self.printed_texts()), default=0)
        grid = Grid(
            **_length(keys, base),
            step_sizes=_step_sizes(keys, base),
            initial_values=_initial_values(keys, base),
            arithmetic=values.AUTO,
            digits=keys.digits or max(_LEAST_DIGITS, longest + _MORE_DIGITS),
            observables=self.observables(),
        )
        # `model_validate` and not `model_copy`, which would not check the grid against the scene.
        fields = {**scene.model_dump(), "grid": grid}
        return f"{label}: claim {self.id}", Scene.model_validate(fields)

    # -- what it needs, and its verdict -----------------------------------------------------------

    def tasks(self, scene: Scene) -> Iterable[Task]:
        return grid_tasks(scene, self.scheme)

    def judge(self, findings: Findings) -> ClaimResult:
        """Compare the runs' values; a MEASURED result of rigorous bounds alone is ENCLOSED."""
        result = self.compare_or_undecided(findings)
        enclosed = all(run.error_kind == "enclosed" for run in self.runs(findings))
        if result.verdict is Verdict.MEASURED and enclosed:
            return result.model_copy(update={"verdict": Verdict.ENCLOSED})
        # A refutation by estimated bounds is no proof, and says so.
        if result.verdict is Verdict.REFUTED and not enclosed:
            evidence = result.evidence + " (by estimated error bounds)"
            return result.model_copy(update={"evidence": evidence})
        return result

    def runs(self, findings: Findings) -> list[RunResult]:
        """Return the runs whose bounds decide."""
        return findings.runs(findings.scene(self.scene), self.scheme)

    def compare_or_undecided(self, findings: Findings) -> ClaimResult:
        """Return the result of `compare`, or UNDECIDED if a run that it needs has no values."""
        try:
            with precision():
                return self.compare(findings)
        except NoValueError as error:
            return self.result(Verdict.UNDECIDED, error.reason)

    @abstractmethod
    def compare(self, findings: Findings) -> ClaimResult:
        """Return the verdict by the values of its runs: MEASURED if the claim holds."""

    def run_rows(
        self, findings: Findings, other_scene: Scene | None = None
    ) -> list[list[RunResult]]:
        """Return the grid's runs: a row for each initial value, by increasing step size.

        They are the runs of the claim's scene, or of the `other` one. Raises InputError if the
        scene lacks the claim's runs, and NoValueError if a run ended without values.
        """
        scene = other_scene or findings.scene(self.scene)
        runs = findings.runs(scene, self.scheme)
        if not runs or scene.grid is None:
            raise InputError("claim", self.id, "its scene has no runs of that scheme")
        for run in runs:
            if run.status != "finished":
                raise NoValueError(run)
            if missing := [name for name in self.observables() if name not in run.values]:
                raise InputError("claim", self.id, f"its scene does not observe {missing[0]}")
        # Runs are stored by initial value, then step size, in the order of the grid.
        width = len(scene.grid.step_sizes)
        rows = [runs[i : i + width] for i in range(0, len(runs), width)]
        return [sorted(row, key=lambda run: Fraction(run.step_size)) for row in rows]

    def only_run(self, findings: Findings) -> RunResult:
        """Return the run of a claim about one; InputError if its scene has several."""
        (run, *other_runs), *other_rows = self.run_rows(findings)
        if other_runs or other_rows:
            problem = "speaks of one run; give step_size, q and p"
            raise InputError(f"claim {self.id}", NOT_GIVEN, problem)
        return run

    def run_at(self, row: Sequence[RunResult], step_size: Fraction) -> RunResult:
        """Return the run of a row with that step size; InputError if there is none."""
        for run in row:
            if Fraction(run.step_size) == step_size:
                return run
        raise InputError(f"claim {self.id}: step size", text(step_size), "is not in the grid")


class QuantityClaim(RunClaim):
    """The base of the kinds that look at one quantity of runs."""

    quantity: Quantity
    """The quantity that the claim is about."""

    def quantities(self) -> tuple[str, ...]:
        return (self.quantity,)


class AgainClaim(RunClaim):
    """The base of the kinds that repeat other claims on the same runs with changed values."""

    obstacle = "which claims are made again is a matter of their own scene"
    again: Annotated[tuple[dict[str, Any], ...], Field(min_length=1, max_length=100)]
    """Claims of the same scene and scheme, each its kind and its keys."""

    @model_validator(mode="after")
    def _check(self) -> Self:
        for claim in self.claims():
            problem = self.refuses(claim)
            if problem:
                raise InputError("again", claim.kind, problem)
        return self

    def claims(self) -> list[RunClaim]:
        """Return the claims that are repeated."""
        claims = []
        for n, table in enumerate(self.again, start=1):
            kind = table.get("kind")
            model = models().get(kind) if isinstance(kind, str) else None
            # AgainClaim is excluded: a list of claims within one of them could nest forever.
            if model is None or not issubclass(model, RunClaim) or issubclass(model, AgainClaim):
                raise InputError("again", kind, "is no kind of claim on runs")
            # The stamp comes last: a table must not leave the scene and scheme of this claim.
            stamp = {"id": f"{self.id}-{n}", "scene": self.scene, "scheme": self.scheme}
            claims.append(model.model_validate({**table, **stamp}))
        return claims

    def compare_twice(
        self, findings: Findings, changed_runs: Mapping[str, RunResult]
    ) -> list[tuple[ClaimResult, ClaimResult]]:
        """Return each claim's results by the original runs and by the changed ones."""
        changed = Findings(findings.scenes, {**findings.results, **changed_runs})
        return [(claim.compare(findings), claim.compare(changed)) for claim in self.claims()]

    def rows(self, pairs: Sequence[tuple[ClaimResult, ClaimResult]]) -> list[list[str]]:
        """Return a row for each claim: its keys in words, then both of its verdicts.

        A verdict that holds is written as `holds`, whether it is PROVED or MEASURED: both results
        are compared by the side that they take, and not by how certain they are.
        """
        rows = []
        for table, pair in zip(self.again, pairs, strict=True):
            words = ", ".join(f"{k} {v}" for k, v in table.items() if isinstance(v, str | int))
            rows.append([words, *("holds" if x.verdict.holds else x.verdict.lower() for x in pair)])
        return rows

    def refuses(self, claim: RunClaim) -> str:
        """Return why this claim cannot be repeated; empty if it can."""
        return "takes runs of its own" if claim.separate_runs else ""


def _length(keys: RunKeys, base: Grid | None) -> dict[str, Any]:
    if keys.time is not None and keys.steps is not None:
        raise InputError("steps", keys.steps, "give one of time and steps")
    if keys.time is None and keys.steps is None:
        if base is None:
            raise InputError("time", NOT_GIVEN, "is missing: give time or steps")
        return {"time": base.time, "steps": base.steps}
    return {"time": keys.time, "steps": keys.steps}


def _step_sizes(keys: RunKeys, base: Grid | None) -> tuple[Any, ...]:
    if keys.step_size is not None and keys.step_sizes is not None:
        raise InputError("step_size", keys.step_size, "give one of step_size and step_sizes")
    if keys.step_size is not None:
        return (keys.step_size,)
    if keys.step_sizes is None and base is None:
        raise InputError("step_size", NOT_GIVEN, "is missing")
    return keys.step_sizes or (base.step_sizes if base else ())


def _initial_values(keys: RunKeys, base: Grid | None) -> tuple[values.AnyStart, ...]:
    if keys.q is None and keys.p is None:
        if keys.initial_values is None and base is None:
            raise InputError("q", NOT_GIVEN, "is missing: give q and p, or initial_values")
        return keys.initial_values or (base.initial_values if base else ())
    if keys.initial_values is not None:
        raise InputError("initial_values", NOT_GIVEN, "give these, or q and p")
    if keys.q is None or keys.p is None:
        raise InputError("p" if keys.p is None else "q", NOT_GIVEN, "is missing: give q and p")
    if isinstance(keys.q, tuple) and isinstance(keys.p, tuple):
        return (values.InitialState(q=keys.q, p=keys.p),)
    if isinstance(keys.q, tuple) or isinstance(keys.p, tuple):
        raise InputError("q, p", NOT_GIVEN, "give a number each, or a list each")
    return (values.InitialValue(q=keys.q, p=keys.p),)
