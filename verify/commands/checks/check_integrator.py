"""The command `verify check-integrator`: a user's own step(p, q, h)."""

import time
from typing import TYPE_CHECKING, Any

import click

from verify.commands.checks.check_options import (
    allow_undecided_option,
    is_failure,
    looking_options,
    places_json,
    print_measured,
    print_notes,
    request_from,
    step_size_option,
)
from verify.commands.shared import proof_output as show
from verify.commands.shared.execution_options import clock
from verify.commands.shared.input import time_limit_option, with_hamiltonian
from verify.commands.shared.output import CommandAnswer, answering, cut, pick
from verify.errors import NOT_GIVEN, InputError

if TYPE_CHECKING:
    from verify.hamiltonians.hamiltonian import Hamiltonian
    from verify.integrators.results import Finding
    from verify.integrators.user_code.loading import Callee
    from verify.proof.proof_for_one_h import Proof

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
@looking_options
@step_size_option
@click.option("--order", type=_CLAIMED, metavar="K", help="Claimed order of convergence.")
@click.option("--area-preserving", is_flag=True, help="Claimed: det J ≡ 1.")
@click.option("--symplectic", is_flag=True, help="Claimed: JᵀΩJ ≡ Ω; in the plane det J ≡ 1.")
@click.option("--area-order", type=_CLAIMED, metavar="K", help="Claimed: ΔJ = O(h^K).")
@time_limit_option
@allow_undecided_option
@answering
def check_integrator(
    target: str | None,
    hamiltonian: "Hamiltonian",
    command: str | None,
    number_type: str,
    arguments: str | None,
    order: int | None,
    area_preserving: bool,
    symplectic: bool,
    area_order: int | None,
    time_limit: float,
    allow_undecided: bool,
    **looking: str | None,
) -> CommandAnswer:
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
    measured. Exit status 1 where the verdict is REFUTED, or what an option claims is UNDECIDED,
    without --allow-undecided.

    \b
    verify check-integrator mine:step --system pendulum
    verify check-integrator mine.py:step --hamiltonian 'p**2/2 + q**4/4' --order 2 --area-preserving
    verify check-integrator ./libstep.so:step --system pendulum --order 2 --symplectic
    verify check-integrator --command './step' --system pendulum --type long-double
    """
    from verify.integrators.results import Claims
    from verify.integrators.step_check import check_integrator as check

    start_time = time.perf_counter()
    request = request_from(hamiltonian.coordinates, **looking)
    if hamiltonian.symbols:
        raise InputError(
            "--param", hamiltonian.symbols[0], "has no value; a step of one's own needs it"
        )
    target_name = command or target or ""
    callee = _callee(target, command, number_type, arguments, hamiltonian, time_limit)
    claims = Claims(order, area_order, area_preserving, symplectic)
    with clock(target_name):
        finding = check(callee, hamiltonian, claims, request)
    seconds = f"{time.perf_counter() - start_time:.6f}"
    return CommandAnswer(
        lambda: _json(hamiltonian, target_name, finding, seconds),
        lambda: _print(hamiltonian, target_name, finding),
        # Without a claim there is nothing to leave undecided: only a refutation fails.
        failed=is_failure([finding.verdict], allow_undecided=allow_undecided or claims == Claims()),
    )


def _callee(
    target: str | None,
    command: str | None,
    number_type: str,
    arguments: str | None,
    hamiltonian: "Hamiltonian",
    time_limit: float,
) -> "Callee":
    """Return the step as a callee; nothing of it is called yet."""
    from verify.integrators.foreign.foreign_function import (
        is_library,
        step_of_command,
        step_of_library,
    )
    from verify.integrators.user_code.loading import callee_from, foreign_callee, load
    from verify.integrators.user_code.user_map import DOUBLE, type_of

    if (target is None) == (command is None):
        problem = "give MODULE:FUNCTION, LIB.so:SYMBOL, or --command 'PROGRAM'; one of them"
        raise InputError("integrator", target or NOT_GIVEN, problem)
    kind = type_of(number_type)
    foreign = command is not None or is_library(target or "")
    if foreign and arguments is not None:
        raise InputError("--arguments", arguments, "goes with a Python function")
    if command is not None:
        return foreign_callee(step_of_command(command, kind, time_limit, hamiltonian.degrees))
    if foreign:
        return foreign_callee(step_of_library(target or "", hamiltonian.degrees, kind, time_limit))
    if kind is not DOUBLE:
        raise InputError("--type", number_type, "goes with LIB.so:SYMBOL or --command")
    return callee_from(
        load(target or ""), hamiltonian.coordinates, arguments=arguments,
        parameters=dict(hamiltonian.values), time_limit=time_limit,
    )  # fmt: skip


def _json(
    hamiltonian: "Hamiltonian", target: str, finding: "Finding", seconds: str
) -> dict[str, Any]:
    from verify.arithmetic.exact import text
    from verify.integrators.results import potential_of_finding

    proof, example, form_proof = finding.proof, finding.counterexample, _proof_of_form(finding)
    potential = None if form_proof else potential_of_finding(finding)
    witness = proof.witness if proof and finding.symplectic is not True else {}
    # In n degrees of freedom a measured counterexample stands for the witness of a proof.
    if not witness and example is not None and finding.degrees > 1:
        witness = example.z
    against = finding.against
    return {
        **pick(finding, "verdict", "reason"),
        **hamiltonian.texts,
        "degrees": finding.degrees,
        "integrator": target,
        **show.order_json(finding.order),
        **pick(finding, "how", "leading", "delta_j", "symplectic", "area_preserving"),
        "volume_order": form_proof.volume_order if form_proof else None,
        "convergence_order": finding.convergence_order,
        "convergence_order_known": finding.order_decided,
        "entry": finding.entry,
        "witness": show.point_json(witness),
        "value": form_proof.enclosure if form_proof else example.found if example else "",
        "telescopes": form_proof.telescopes if form_proof else potential and potential.holds,
        "potential": (form_proof.potential or None) if form_proof else potential and potential.text,
        "delta_j_max": None if finding.largest is None else f"{finding.largest:.6e}",
        "probe_error": None if finding.probe_error is None else f"{finding.probe_error:.1e}",
        "step_size": None if against is None else text(against.h),
        "counterexample": example and {
            **show.point_json(example.z),
            **({} if example.h is None else {"h": text(example.h)}),
            **({} if example.t is None else {"t": text(example.t)}),
            **pick(example, "quantity", "found", "expected"),
        },
        "places": places_json(hamiltonian.coordinates, finding.places),
        **pick(finding, "domain", "faults", "notes"),
        "seconds": seconds,
    }  # fmt: skip


def _proof_of_form(finding: "Finding") -> "Proof | None":
    """Return the finding's proof if it is one of S, in n degrees of freedom."""
    return finding.proof if finding.proof and not finding.proof.planar else None


def _print(hamiltonian: "Hamiltonian", target: str, finding: "Finding") -> None:
    from dataclasses import replace

    from verify.integrators.results import potential_of_finding

    proof, form_proof, degrees = finding.proof, _proof_of_form(finding), finding.degrees
    if form_proof is not None:
        proof_view = replace(form_proof, verdict=finding.verdict, reason=finding.reason)
        show.print_symplectic(hamiltonian.texts, target, proof_view)
    elif proof is not None and finding.verdict is proof.verdict:
        show.print_proof(hamiltonian, target, proof, potential_of_finding(finding))
    else:
        show.print_head(hamiltonian, target, finding)
        if finding.leading is not None and finding.order is not None and degrees == 1:
            click.echo(f"  ΔJ       ({cut(finding.leading)})·h^{finding.order} + …")
        print_measured(finding)
    print_notes(finding)
