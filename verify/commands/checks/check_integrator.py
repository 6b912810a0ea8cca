"""The command `verify check-integrator`: a user's own step(p, q, h)."""

import time
from typing import TYPE_CHECKING, Any

import click

from verify.commands.shared import output as show
from verify.commands.shared.answer import Answer, answering, picked
from verify.commands.shared.input import time_limit_option, with_hamiltonian
from verify.errors import NOT_GIVEN, InputError

if TYPE_CHECKING:
    from verify.hamiltonians.hamiltonian import Hamiltonian
    from verify.integrators.results import Claims, Finding
    from verify.integrators.step import Step

_CLAIMED = click.IntRange(1, 12)


@click.command("check-integrator")
@click.argument("target", required=False, metavar="[MODULE:FUNCTION | LIB.so:SYMBOL]")
@click.option(
    "--command",
    metavar="PROGRAM",
    help="A program that answers each line `t h p1 … pn q1 … qn` with a line `p1 … pn q1 … qn`.",
)
@click.option(
    "--type",
    "number_type",
    default="double",
    show_default=True,
    metavar="TYPE",
    help="Of the numbers of a library or program: double, long-double, float128, double-double.",
)
@with_hamiltonian
@click.option(
    "--arguments",
    metavar="ORDER",
    help="How it takes p, q and h, such as q,p,h, or q,p,t,h; it returns p' and q' in that order "
    "too. Without it the names of its arguments tell.",
)
@click.option("--q", "q", metavar="Q", help="An initial value to look at beside others.")
@click.option("--p", "p", metavar="P", help="Its momentum.")
@click.option("--order", type=_CLAIMED, metavar="K", help="Claimed order of convergence.")
@click.option("--area-preserving", is_flag=True, help="Claimed: det J ≡ 1.")
@click.option("--symplectic", is_flag=True, help="Claimed: JᵀΩJ ≡ Ω; in the plane det J ≡ 1.")
@click.option("--area-order", type=_CLAIMED, metavar="K", help="Claimed: ΔJ = O(h^K).")
@time_limit_option
@answering
def check_integrator(
    target: str | None,
    exact: "Hamiltonian",
    command: str | None,
    number_type: str,
    arguments: str | None,
    q: str | None,
    p: str | None,
    order: int | None,
    area_preserving: bool,
    symplectic: bool,
    area_order: int | None,
    time_limit: float,
) -> Answer:
    """Check a step of your own, in Python or any language: its order and that of ΔJ.

    In Python a function step(p, q, h) → (p', q').

    Or step(p, q, t, h), for an H(p, q, t): then its order is that for the motion in time. For an H
    in p1 … pn, q1 … qn p and q are arrays, and S = JᵀΩJ − Ω is looked at in place of ΔJ.

    Of a library in C, Fortran or another language LIB.so:SYMBOL, which changes p and q in place:
    void step(int n, double t, double h, double *p, double *q). Or a program, by --command. Both
    run in a process of their own, limited in time and memory.

    THIS RUNS YOUR CODE, which no other command does: MODULE is imported, from the current folder
    too, or file.py:FUNCTION is loaded, and the function is called.

    Where its code allows it, the function is called with symbols, and all is proved; else it is
    measured. Exit status 1 where the verdict is REFUTED, or what is claimed is not decided.

    \b
    verify check-integrator mine:step --system pendulum
    verify check-integrator mine.py:step --hamiltonian 'p**2/2 + q**4/4' --order 2 --area-preserving
    verify check-integrator ./libstep.so:step --system pendulum --order 2 --symplectic
    verify check-integrator --command './step' --system pendulum --type long-double
    """
    from verify.arithmetic.exact import rational
    from verify.integrators.check import check_integrator as check
    from verify.integrators.results import Claims

    begun = time.perf_counter()
    if (p is None) != (q is None):
        raise InputError("--p, --q", p or q or NOT_GIVEN, "give both or none")
    start = None if p is None or q is None else (rational(p, "--p"), rational(q, "--q"))
    if exact.symbols:
        raise InputError("--param", exact.symbols[0], "has no value; a step of one's own needs it")
    called = command or target or ""
    step, notes = _step(target, command, number_type, arguments, exact, time_limit)
    claims = Claims(order, area_order, area_preserving, symplectic)
    claimed = claims != Claims()
    if not exact.planar:
        if start is not None:
            raise InputError("--p, --q", p or "", "go with one degree of freedom")
        return _in_degrees(exact, called, step, claims, notes)
    found = check(step, exact, claims, start).noting(*notes)
    seconds = f"{time.perf_counter() - begun:.6f}"
    return Answer(
        lambda: _json(exact, called, found, seconds),
        lambda: _print(exact, called, found),
        failed=found.verdict.value == "REFUTED" or (claimed and not found.verdict.holds),
    )


def _step(
    target: str | None,
    command: str | None,
    number_type: str,
    arguments: str | None,
    exact: "Hamiltonian",
    time_limit: float,
) -> "tuple[Step, list[str]]":
    """The step, and notes on how it is understood."""
    from verify.integrators.foreign.called import is_library, of_command, of_library
    from verify.integrators.loading import load, step_from
    from verify.integrators.number_type import DOUBLE, type_of

    if (target is None) == (command is None):
        problem = "give MODULE:FUNCTION, LIB.so:SYMBOL, or --command 'PROGRAM'; one of them"
        raise InputError("integrator", target or NOT_GIVEN, problem)
    kind = type_of(number_type)
    foreign = command is not None or is_library(target or "")
    if foreign and arguments is not None:
        raise InputError("--arguments", arguments, "goes with a Python function")
    if command is not None:
        return of_command(command, kind, time_limit), []
    if foreign:
        return of_library(target or "", exact.degrees, kind, time_limit), []
    if kind is not DOUBLE:
        raise InputError("--type", number_type, "goes with LIB.so:SYMBOL or --command")
    return step_from(load(target or ""), arguments, dict(exact.values), time_limit)


def _in_degrees(
    exact: "Hamiltonian", target: str, step: "Step", claims: "Claims", notes: list[str]
) -> Answer:
    """For an H of several degrees of freedom."""
    from verify.commands.shared.in_degrees import print_step, step_json
    from verify.integrators.degrees.check import check_step
    from verify.integrators.results import Claims

    begun = time.perf_counter()
    found = check_step(step, exact, claims)
    for note in notes:
        found = found.noting(note)
    seconds = f"{time.perf_counter() - begun:.6f}"
    failed = found.verdict == "REFUTED" or (claims != Claims() and not found.verdict.holds)
    return Answer(
        lambda: step_json(exact.texts, target, found, seconds),
        lambda: print_step(exact.texts, target, found),
        failed=failed,
    )


def _json(exact: "Hamiltonian", target: str, found: "Finding", seconds: str) -> dict[str, Any]:
    from verify.arithmetic.exact import text
    from verify.integrators.results import potential_of_finding

    potential = potential_of_finding(found)
    witness = found.proof.witness if found.proof else {}
    example = found.counterexample
    return {
        **picked(found, "verdict", "reason"),
        **exact.texts,
        "integrator": target,
        **show.order_json(found.order),
        **picked(found, "how", "leading", "delta_j", "area_preserving"),
        "convergence_order": found.convergence_order,
        "convergence_order_known": found.order_decided,
        "witness": {name: text(value) for name, value in witness.items()},
        "telescopes": potential.holds,
        "potential": potential.text,
        "delta_j_max": None if found.largest is None else f"{found.largest:.6e}",
        "probe_error": None if found.probe_error is None else f"{found.probe_error:.1e}",
        "counterexample": example and {
            **{name: text(value) for name, value in picked(example, "p", "q", "h").items()},
            **({} if example.t is None else {"t": text(example.t)}),
            **picked(example, "quantity", "found", "expected"),
        },
        **picked(found, "domain", "faults", "notes"),
        "seconds": seconds,
    }  # fmt: skip


def _print(exact: "Hamiltonian", target: str, found: "Finding") -> None:
    from verify.integrators.results import potential_of_finding

    if found.proof is not None and found.verdict is found.proof.verdict:
        show.print_proof(exact, target, found.proof, potential_of_finding(found))
    else:
        show.print_head(exact, target, found)
        if found.leading is not None and found.order is not None:
            click.echo(f"  ΔJ       ({show.cut(found.leading)})·h^{found.order} + …")
        if found.probe_error is not None:
            click.echo(f"  probe    error of a measured ΔJ: {found.probe_error:.1e}, estimated")
    if found.counterexample is not None:
        click.echo(f"  against  {found.counterexample}")
    for note in found.notes:
        click.echo(f"  note     {note}")
