"""The command `verify explore`: properties, or a user's claims, over many drawn scenes."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from verify.commands.hunt import DEFAULT_STEPS, hunt
from verify.commands.shared.destinations import OUT_FOLDER, ensure_writable_later
from verify.commands.shared.execution_options import kept_tasks, with_tasks
from verify.commands.shared.input import FILE, SCHEME
from verify.commands.shared.option import flag, option
from verify.commands.shared.output import CommandAnswer
from verify.errors import InputError

if TYPE_CHECKING:
    from verify.execution.executors import Placement
    from verify.exploration.exploring import Exploration
    from verify.scenes.results.exploration import ExploreReport

_SEED_COUNT = 2**32


@click.command()
@click.argument("claims", type=FILE, metavar="[CLAIMS]", required=False)
@option(
    "--property names",
    "NAME",
    "Only this property; repeatable. A wrong name lists them.",
    multiple=True,
)
@option("--examples", "N", "The number of drawn scenes.", type=int, default=1000)
@option("--seed", "S", "The same seed draws the same scenes.", type=int)
@option("--scheme schemes", "NAME", "Only this; repeatable.", type=SCHEME, multiple=True)
@option(
    "--kind kinds",
    "KIND",
    "polynomial, trigonometric, exponential or rational H only; repeatable.",
    multiple=True,
)
@option("--degree", "D", "The highest degree of polynomials.", type=int, default=6)
@option("--degrees", "N", "Degrees of freedom, 1 … 8: H(p1 … pN, q1 … qN).", type=int, default=1)
@flag("--time-dependent", "Draw H(p, q, t) and a start time t₀.")
@option(
    "--maximise",
    "MEASURE",
    "Hunt for the worst scenes instead: rounding-share, digits-lost, growth or defect.",
)
@option("--steps", "N", "The number of steps of each hunted scene.  [default: 100]", type=int)
@option(
    "-o --output",
    "DIR",
    "The folder for scenes that fail; those in it are checked again first.",
    type=OUT_FOLDER,
    default=Path("explored"),
)
@with_tasks
def explore(
    claims: str | None,
    names: tuple[str, ...],
    examples: int,
    seed: int | None,
    maximise: str | None,
    steps: int | None,
    output: Path,
    keep: Path | None,
    placement: "Placement",
    **space: Any,
) -> CommandAnswer:
    """Hold properties of every scene, or the claims in CLAIMS, against many drawn scenes.

    A scene is a Hamiltonian, a scheme, a step size, an initial value and some steps. Scene K of
    seed S is the same on every machine. For each property that fails, one scene is shrunk to the
    simplest that still fails, and written as a file that `verify report` takes; exit status 1.

    \b
    verify explore --examples 100000 --workers 2 --seed 7
    verify explore --property order-by-jets --scheme lie2 --kind polynomial
    verify explore claims.toml --examples 500

    --maximise searches for the scenes in which float64 or the scheme (lie2, or those of --scheme)
    does worst, with |q|, |p| up to 2 and step sizes 1/1000 … 1/10. The measures: rounding against
    truncation in Λ, digits of p and q that float64 loses, |Λ|, |ΔJ| over its proved power of h (in
    n degrees of freedom W and S take the place of Λ and ΔJ). DIR/index.html shows the scenes.

    \b
    verify explore --maximise rounding-share --examples 2000 --seed 7 -o worst
    """
    import random

    from verify.exploration.exploring import Exploration
    from verify.exploration.sample_space import SampleSpace

    # The seed is printed, so that a run without --seed can be repeated.
    seed = random.SystemRandom().randrange(_SEED_COUNT) if seed is None else seed
    checks, left_out = _select_checks(claims, names) if maximise is None else ({}, {})
    space["schemes"] = space["schemes"] or _schemes_of_claims(checks)
    sample_space = SampleSpace(**space)
    if maximise is not None:
        if claims or names:
            raise InputError(
                "--maximise", maximise, "takes no CLAIMS and no --property; leave them out"
            )
        steps = DEFAULT_STEPS if steps is None else steps
        return hunt(maximise, seed, examples, steps, sample_space, output, keep, placement)
    if steps is not None:
        raise InputError("--steps", steps, "is of scenes that are hunted, with --maximise")
    exploration = Exploration(seed=seed, examples=examples, **checks, drawn=sample_space)
    return _explore(exploration, left_out, output, keep, placement)


def _explore(
    exploration: "Exploration",
    left_out: Mapping[str, Sequence[str]],
    output: Path,
    keep: Path | None,
    placement: "Placement",
) -> CommandAnswer:
    """Explore, write the scenes that fail, and return the answer."""
    from verify.exploration.exploring import explore, load_failures, save_failures

    ensure_writable_later(output)
    earlier = load_failures(output) if output.is_dir() else []
    with kept_tasks(exploration.plan.tasks, keep) as (store, on_result):
        report = explore(exploration, store, where=placement, done=on_result, earlier=earlier)
    problem, paths = None, [""] * len(report.failures)
    try:
        paths = [str(path) for path in save_failures(report, output)]
    except OSError as error:  # printed and raised after the findings
        problem = InputError("--output", str(output), error.strerror or "cannot be written to")
    return CommandAnswer(
        lambda: _as_json(report, paths, left_out),
        lambda: _print(report, paths, left_out),
        failed=bool(report.failures) or any(old_failure.message for old_failure in report.again),
        problem=problem,
    )


def _select_checks(
    claims: str | None, names: Sequence[str]
) -> tuple[dict[str, Any], dict[str, list[str]]]:
    """Return the requested properties and claims, or all properties if none is requested.

    Also return the claims that are left out, as they speak of one scene only, by the reason.
    """
    from verify.claims.claims_file import load_claims
    from verify.exploration import properties
    from verify.exploration.claim_properties import claim_texts, claims_left_out

    for name in names:
        # Raises InputError for an unknown name, before anything is drawn.
        properties.get(name)
    property_names = tuple(dict.fromkeys(names))
    if claims is None:
        return {"properties": property_names or properties.names()}, {}
    path = Path(claims)
    if not path.is_file():
        raise InputError("CLAIMS", claims, "is no file; give a TOML file with [[claim]] tables")
    claim_list = load_claims(path).claims
    return {"properties": property_names, "claims": claim_texts(claim_list)}, claims_left_out(
        claim_list
    )


def _schemes_of_claims(checks: dict[str, Any]) -> tuple[str, ...]:
    """Return the claims' schemes; none, which means any scheme, if a property is requested."""
    from verify.exploration.claim_properties import scheme_of

    if checks.get("properties") or not checks.get("claims"):
        return ()
    return tuple(dict.fromkeys(map(scheme_of, checks["claims"])))


def _as_json(
    report: "ExploreReport", paths: Sequence[str], left_out: Mapping[str, Sequence[str]]
) -> dict[str, Any]:
    data = report.model_dump(mode="json")
    for failure, path in zip(data["failures"], paths, strict=True):
        failure["file"] = path
    left_out_rows = [
        {"claim": name, "reason": reason} for reason, names in left_out.items() for name in names
    ]
    return data | {"left_out": left_out_rows}


def _print(
    report: "ExploreReport", paths: Sequence[str], left_out: Mapping[str, Sequence[str]]
) -> None:
    width = max(len(checked_property.name) for checked_property in report.properties)
    for checked_property in report.properties:
        verdict = (
            f"FAILS for {checked_property.failures:,}" if checked_property.failures else "holds"
        )
        count = checked_property.looked_at
        summary = f"{verdict} of {count:,}" if count else "speaks of none of them"
        click.echo(f"{checked_property.name:{width}}  {summary}")
    for reason, names in left_out.items():
        click.echo(f"left out, as {reason}: {', '.join(names)}")
    for old_failure in report.again:
        outcome = f"still fails: {old_failure.message}" if old_failure.message else "holds now"
        click.echo(f"{old_failure.file}: {old_failure.property} {outcome}")
    for failure, path in zip(report.failures, paths, strict=True):
        click.echo(f"\n{failure.property} fails at example {failure.example}, shrunk:")
        click.echo("".join(f"  {line}\n" for line in failure.scene.splitlines()), nl=False)
        click.echo(f"  → {path}, which `verify report` takes" if path else "  → not written")
    failing = sum(1 for checked_property in report.properties if checked_property.failures)
    summary = f"{report.examples:,} scenes of seed {report.seed}"
    click.echo(f"{summary}: {failing or 'no'} propert{'y fails' if failing == 1 else 'ies fail'}")
