"""The command `verify check-table`: coefficients as papers and libraries print them."""

import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from verify.commands.checks.failing import allow_undecided_option, fails, print_tally
from verify.commands.shared.answer import Answer, answering, picked

if TYPE_CHECKING:
    from verify.integrators.tables.check import Judgement
    from verify.integrators.tables.cost import Cost


@click.command("check-table")
@click.argument("tables", type=click.Path(path_type=Path), metavar="FILE.toml")
@allow_undecided_option
@answering
def check_table(tables: Path, allow_undecided: bool) -> Answer:
    """Judge printed tables of coefficients by what they claim.

    Exit status 1 where a claim is REFUTED, or UNDECIDED without --allow-undecided.

    \b
    [[table]]
    name = "Ruth 3"
    kind = "splitting"                # a wrong kind lists them
    order = 3
    first = "kick"                    # or "drift", or "both"
    sizes = ["7/24", "2/3", "3/4", "-2/3", "-1/24", "1"]
    times = ["0", "-", "2/3", "-", "0", "-"]     # where it prints them

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
    from verify.integrators.tables.check import check_table as check

    begun = time.perf_counter()
    found = check(tables)
    seconds = f"{time.perf_counter() - begun:.6f}"
    return Answer(
        lambda: {"claims": [_json(each) for each in found], "seconds": seconds},
        lambda: _print(found),
        failed=fails((each.claim.verdict for each in found), allow_undecided=allow_undecided),
    )


def _json(found: "Judgement") -> dict[str, Any]:
    claim = found.claim
    return {
        **picked(found, "id", "table", "line"),
        **picked(claim, "statement", "verdict", "evidence", "severity", "nearest"),
        "cost": claim.cost and _cost(claim.cost),
        "details": claim.details,
    }


def _cost(cost: "Cost") -> dict[str, Any]:
    sizes = picked(cost, "ulps", "error_constant", "nearest_error_constant", "below")
    return {
        **picked(cost, "double", "order", "claimed"),
        **{name: None if x is None else f"{x:.3g}" for name, x in sizes.items()},
        "said": cost.said,
    }


def _print(found: "list[Judgement]") -> None:
    width = max(len(each.id) for each in found)
    for each in found:
        claim = each.claim
        click.echo(f"{claim.verdict:9}  {each.id:{width}}  {claim.evidence}")
        if claim.severity is not None:
            cost = f"; {claim.cost.said}" if claim.cost and claim.cost.said else ""
            click.echo(f"{'':9}  {'':{width}}  {claim.severity}{cost}")
        for row in claim.details[1:]:
            name, printed, exact, off = row
            click.echo(
                f"{'':9}  {'':{width}}  {name}: {printed}, exact {exact}, off by {off} units"
            )
    print_tally(each.claim.verdict for each in found)
