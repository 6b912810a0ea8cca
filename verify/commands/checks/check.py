"""The command `verify check`: the claims of a paper, one verdict each."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from verify.commands.checks.check_options import allow_undecided_option, is_failure, print_tally
from verify.commands.shared.execution_options import kept_tasks, with_tasks
from verify.commands.shared.input import CLAIMS, paper_folder
from verify.commands.shared.option import option
from verify.commands.shared.output import CommandAnswer, pick

if TYPE_CHECKING:
    from verify.execution.executors import Placement
    from verify.scenes.results.claim import ClaimResult, StatementResult

_CLAIM_KEYS = ("id", "kind", "source", "statement", "verdict", "evidence", "checked_by", "domain")
_READING_KEYS = ("statement_id", "reading", "standing")
_STATEMENT_KEYS = ("id", "source", "statement", "outcome", "readings")


@click.command()
@click.argument("claims", type=CLAIMS, metavar="CLAIMS")
@option("--only", "ID", "Only this claim, or eq-* for several; repeatable.", multiple=True)
@allow_undecided_option
@with_tasks
def check(
    claims: str,
    only: tuple[str, ...],
    allow_undecided: bool,
    keep: Path | None,
    placement: "Placement",
) -> CommandAnswer:
    """Check the claims in CLAIMS (a TOML file, or `paper`).

    Exit status 1 if a claim is REFUTED, or UNDECIDED without --allow-undecided.

    \b
    [defaults]                        # what the claims share
    scheme = "lie2"
    system = "duffing"                # or hamiltonian = "…", with parameters = { … }

    \b
    [[claim]]
    id = "eq-21"
    kind = "delta_j"                  # an unknown kind lists all
    formula = "3*h**3*delta*p*q"
    up_to = 4                         # + O(h⁴); without it, exactly

    \b
    [[claim]]
    id = "order-of-every-H"
    kind = "defect_order"             # ΔJ = c h³ + …
    defect_order = 3
    every = "hamiltonian"             # or "separable hamiltonian"

    \b
    [[claim]]
    id = "area-error"
    kind = "lambda"
    parameters = { delta = 1 }
    step_size = 0.001
    steps = 20000
    q = 1.5
    p = 0
    printed = "-2.666e-06"            # or lg_printed
    """
    from verify.claims.claims_file import load_claims
    from verify.claims.verdicts import prepare

    path = paper_folder() / "claims.toml" if claims == "paper" else Path(claims)
    prepared = prepare(load_claims(path), only)
    for warning in prepared.file.warnings(prepared.claims):
        click.echo(f"verify: {warning}", err=True)
    with kept_tasks(prepared.plan.tasks, keep) as (store, on_result):
        results = prepared.run(store, where=placement, done=on_result)
    statements = prepared.statements(results)
    return CommandAnswer(
        lambda: {
            "claims": [pick(claim, *_CLAIM_KEYS, *_READING_KEYS) for claim in results],
            "statements": [pick(statement, *_STATEMENT_KEYS) for statement in statements],
        },
        lambda: _print(results, statements),
        failed=is_failure((claim.verdict for claim in results), allow_undecided=allow_undecided),
    )


def _print(results: "list[ClaimResult]", statements: "Sequence[StatementResult]") -> None:
    from verify.scenes.results.claim import describe_counts

    width = max(len(claim.id) for claim in results)
    for claim in results:
        source = f"{claim.source}: " if claim.source else ""
        click.echo(f"{claim.verdict:9}  {claim.id:{width}}  {source}{claim.evidence}")
    print_tally(claim.verdict for claim in results)
    if statements:
        click.echo(describe_counts(statements, [c for c in results if _is_counted(c, statements)]))


def _is_counted(claim: "ClaimResult", statements: "Sequence[StatementResult]") -> bool:
    """Return True for a claim without a statement, and for a reading of one of `statements`."""
    return not claim.statement_id or claim.statement_id in {
        statement.id for statement in statements
    }
