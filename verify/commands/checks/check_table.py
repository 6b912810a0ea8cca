"""The command `verify check-table`: coefficients as papers and libraries print them."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from verify.commands.checks.check_options import allow_undecided_option, is_failure, print_tally
from verify.commands.shared.output import CommandAnswer, answering, pick

if TYPE_CHECKING:
    from verify.integrators.tables.cost import Cost
    from verify.integrators.tables.table_file import TableJudgement


@click.command("check-table")
@click.argument("tables", type=click.Path(path_type=Path), metavar="FILE.toml")
@allow_undecided_option
@answering
def check_table(tables: Path, allow_undecided: bool) -> CommandAnswer:
    """Judge printed tables of coefficients by what they claim.

    Exit status 1 if a claim is REFUTED, or UNDECIDED without --allow-undecided.

    \b
    [[table]]
    name = "Ruth 3"
    kind = "splitting"                # an unknown kind lists all
    order = 3
    first = "kick"                    # or "drift", or "both"
    sizes = ["7/24", "2/3", "3/4", "-2/3", "-1/24", "1"]
    times = ["0", "-", "2/3", "-", "0", "-"]     # may be left out

    \b
    [[table]]
    name = "Heun"
    kind = "runge-kutta"
    order = 2
    tableau = \"\"\"
    0 |
    1 | 1
    --+---------
      | 1/2 1/2
    \"\"\"
    """
    from verify.integrators.tables.table_file import check_table as check

    judgements = check(tables)
    return CommandAnswer(
        lambda: {"claims": list(map(_json, judgements))},
        lambda: _print(judgements),
        timed=True,
        failed=is_failure(
            (judgement.claim.verdict for judgement in judgements), allow_undecided=allow_undecided
        ),
    )


def _json(judgement: "TableJudgement") -> dict[str, Any]:
    claim = judgement.claim
    return {
        **pick(judgement, "id", "table", "line"),
        **pick(claim, "statement", "verdict", "evidence", "severity", "nearest"),
        "cost": claim.cost and _cost_json(claim.cost),
        "details": claim.details,
    }


def _cost_json(cost: "Cost") -> dict[str, Any]:
    sizes = pick(cost, "ulps", "error_constant", "nearest_error_constant", "below")
    return {
        **pick(cost, "double", "order", "claimed"),
        **{name: None if x is None else f"{x:.3g}" for name, x in sizes.items()},
        "said": cost.sentence,
    }


def _print(judgements: "list[TableJudgement]") -> None:
    width = max(len(judgement.id) for judgement in judgements)
    for judgement in judgements:
        claim = judgement.claim
        click.echo(f"{claim.verdict:9}  {judgement.id:{width}}  {claim.evidence}")
        if claim.severity is not None:
            cost = f"; {claim.cost.sentence}" if claim.cost and claim.cost.sentence else ""
            click.echo(f"{'':9}  {'':{width}}  {claim.severity}{cost}")
        for row in claim.details[1:]:
            name, printed_value, exact_value, distance = row
            values = f"{printed_value}, exact {exact_value}, off by {distance} units"
            click.echo(f"{'':9}  {'':{width}}  {name}: {values}")
    print_tally(judgement.claim.verdict for judgement in judgements)
