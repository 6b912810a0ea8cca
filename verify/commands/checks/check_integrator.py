"""The command `verify check-integrator`: a user's own step(p, q, h)."""

from typing import TYPE_CHECKING, Any

import click

from verify.commands.checks import check_options
from verify.commands.shared import proof_output as show
from verify.commands.shared.execution_options import clock
from verify.commands.shared.input import hamiltonian_of, system_options, time_limit_option
from verify.commands.shared.option import flag, option
from verify.commands.shared.output import CommandAnswer, answering, cut, pick
from verify.commands.shared.structure_options import structure_options
from verify.errors import NOT_GIVEN, InputError

if TYPE_CHECKING:
    from verify.hamiltonians.hamiltonian import Hamiltonian
    from verify.integrators.results import Finding
    from verify.integrators.user_code.loading import Callee
    from verify.proof.proof_for_one_h import Proof
    from verify.structures.reading import KeepsRequest

_ORDER_RANGE = click.IntRange(1, 12)


@click.command("check-integrator")
@click.argument("target", required=False, metavar="[MODULE:FUNCTION | LIB.so:SYMBOL]")
@option(
    "--command",
    "PROGRAM",
    "A program that answers each line `t h p1 … pn q1 … qn` with a line `p1 … pn q1 … qn`.",
)
@option(
    "--type number_type",
    "TYPE",
    "The type of the numbers of a library or program: double, long-double, float128, "
    "double-double.",
    default="double",
    show_default=True,
)
@system_options
@option(
    "--arguments",
    "ORDER",
    "The order of a Python function's arguments, such as q,p,h or q,p,t,h; it returns p' and "
    "q' in that order too. By default the names of its arguments decide.",
)
@check_options.place_options
@check_options.point_option
@check_options.step_size_option
@option("--order", "K", "Claimed order of convergence.", type=_ORDER_RANGE)
@flag("--area-preserving", "Claimed: det J ≡ 1.")
@flag("--symplectic", "Claimed: JᵀΩJ ≡ Ω; in the plane det J ≡ 1.")
@option("--area-order", "K", "Claimed: ΔJ = O(h^K).", type=_ORDER_RANGE)
@structure_options
@time_limit_option
@check_options.allow_undecided_option
@answering
def check_integrator(
    target: str | None,
    system: str | None,
    hamiltonian: str | None,
    params: tuple[str, ...],
    field: str | None,
    command: str | None,
    number_type: str,
    arguments: str | None,
    order: int | None,
    area_preserving: bool,
    symplectic: bool,
    area_order: int | None,
    time_limit: float,
    allow_undecided: bool,
    keeps: "KeepsRequest",
    **place_texts: str | None,
) -> CommandAnswer:
    """Check a step of your own, in Python or any language: its order and that of ΔJ.

    In Python a function step(p, q, h) → (p', q').

    For an H(p, q, t) it is step(p, q, t, h), and its order is that for the motion in time. For an H
    in p1 … pn, q1 … qn, p and q are arrays, and S = JᵀΩJ − Ω is examined in place of ΔJ.

    With --field it is a step of equations: its arguments are the coordinates, by their names or one
    array of all, then h. With --keeps it is judged what the step keeps, and only that unless an
    order is claimed too.

    LIB.so:SYMBOL is a function of a library, in C, Fortran or another language, which changes p and
    q in place: void step(int n, double t, double h, double *p, double *q). --command names a
    program. Both run in a process of their own, limited in time and memory.

    THIS RUNS YOUR CODE, as no other command but check-map does: MODULE is imported, from the
    current folder too, or file.py:FUNCTION is loaded, and the function is called.

    If its code allows it, the function is called with symbols, and all is proved; otherwise it is
    measured. Exit status 1 if the verdict is REFUTED; or if an option claims something, the verdict
    is UNDECIDED and --allow-undecided is not given.

    \b
    verify check-integrator mine:step --system pendulum
    verify check-integrator mine.py:step --hamiltonian 'p**2/2 + q**4/4' --order 2 --area-preserving
    verify check-integrator ./libstep.so:step --system pendulum --order 2 --symplectic
    verify check-integrator --command './step' --system pendulum --type long-double
    verify check-integrator mine:step --system pendulum --keeps reversible --keeps "energy: 3"
    verify check-integrator mine:step --field "u_dot = u*(v - 2); v_dot = v*(1 - u)" \
        --form "du^dv/(u*v)"
    """
    from verify.integrators.results import Claims
    from verify.integrators.step_check import check_step
    from verify.structures.reading import read_structures

    parsed = hamiltonian_of(system, hamiltonian, params, field)
    request = check_options.request_from(parsed.coordinates, **place_texts)
    if parsed.symbols:
        raise InputError("--param", parsed.symbols[0], "has no value; a step of one's own needs it")
    target_name = command or target or ""
    callee = _build_callee(target, command, number_type, arguments, parsed, time_limit)
    claims = Claims(order, area_order, area_preserving, symplectic)
    structures = read_structures(keeps, parsed)
    with clock(target_name):
        finding = check_step(callee, parsed, claims, structures, request)
    return CommandAnswer(
        lambda: _json(parsed, target_name, finding),
        lambda: _print(parsed, target_name, finding, with_keeps=bool(structures)),
        timed=True,
        # Without a claim there is nothing to leave undecided: only a refutation fails.
        failed=check_options.is_failure(
            [finding.verdict],
            allow_undecided=allow_undecided or (claims == Claims() and not structures),
        ),
    )


def _build_callee(
    target: str | None,
    command: str | None,
    number_type: str,
    arguments: str | None,
    hamiltonian: "Hamiltonian",
    time_limit: float,
) -> "Callee":
    """Return the step as a callee, without calling it."""
    from verify.integrators.foreign.foreign_function import (
        is_library,
        step_of_command,
        step_of_library,
    )
    from verify.integrators.user_code.coordinate_layout import callee_of_coordinates
    from verify.integrators.user_code.loading import callee_from, foreign_callee, load
    from verify.integrators.user_code.user_map import DOUBLE, type_of

    if (target is None) == (command is None):
        problem = "give MODULE:FUNCTION, LIB.so:SYMBOL, or --command 'PROGRAM'; one of them"
        raise InputError("integrator", target or NOT_GIVEN, problem)
    kind = type_of(number_type)
    foreign = command is not None or is_library(target or "")
    if hamiltonian.energy is None and (foreign or arguments is not None):
        value = arguments or command or target or ""
        raise InputError("--field", value, "goes with a Python function, and without --arguments")
    if foreign and arguments is not None:
        raise InputError("--arguments", arguments, "goes with a Python function")
    if command is not None:
        return foreign_callee(step_of_command(command, kind, time_limit, hamiltonian.degrees))
    if foreign:
        return foreign_callee(step_of_library(target or "", hamiltonian.degrees, kind, time_limit))
    if kind is not DOUBLE:
        raise InputError("--type", number_type, "goes with LIB.so:SYMBOL or --command")
    if hamiltonian.energy is None:
        return callee_of_coordinates(
            load(target or ""), hamiltonian.coordinates, stepped=True,
            parameters=dict(hamiltonian.values), time_limit=time_limit,
        )  # fmt: skip
    return callee_from(
        load(target or ""), hamiltonian.coordinates, arguments=arguments,
        parameters=dict(hamiltonian.values), time_limit=time_limit,
    )  # fmt: skip


def _json(hamiltonian: "Hamiltonian", target: str, finding: "Finding") -> dict[str, Any]:
    from verify.arithmetic.exact import text
    from verify.integrators.results import potential_of_finding

    proof, example, s_proof = finding.proof, finding.counterexample, _proof_of_s(finding)
    potential = None if s_proof else potential_of_finding(finding)
    witness = proof.witness if proof and finding.symplectic is not True else {}
    # In n degrees of freedom a measured counterexample takes the place of a proof's witness.
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
        "volume_order": s_proof.volume_order if s_proof else None,
        "convergence_order": finding.convergence_order,
        "convergence_order_known": finding.order_decided,
        "entry": finding.entry,
        "witness": show.point_json(witness),
        "value": s_proof.enclosure if s_proof else example.found if example else "",
        "telescopes": s_proof.telescopes if s_proof else potential and potential.holds,
        "potential": (s_proof.potential or None) if s_proof else potential and potential.text,
        "delta_j_max": None if finding.largest is None else f"{finding.largest:.6e}",
        "probe_error": None if finding.probe_error is None else f"{finding.probe_error:.1e}",
        "step_size": None if against is None else text(against.h),
        "counterexample": example and check_options.example_json(example),
        "places": check_options.places_json(hamiltonian.coordinates, finding.places),
        "keeps": check_options.keeps_json(finding),
        **pick(finding, "domain", "faults", "notes"),
    }  # fmt: skip


def _proof_of_s(finding: "Finding") -> "Proof | None":
    """Return the finding's proof if it is one on S = JᵀΩJ − Ω, in n degrees of freedom."""
    return finding.proof if finding.proof and not finding.proof.planar else None


def _print(
    hamiltonian: "Hamiltonian", target: str, finding: "Finding", *, with_keeps: bool
) -> None:
    from dataclasses import replace

    from verify.integrators.results import potential_of_finding

    proof, s_proof, degrees = finding.proof, _proof_of_s(finding), finding.degrees
    if s_proof is not None:
        proof_view = replace(s_proof, verdict=finding.verdict, reason=finding.reason)
        show.print_symplectic(hamiltonian.texts, target, proof_view)
    elif proof is not None and finding.verdict is proof.verdict:
        potential = potential_of_finding(finding)
        show.print_proof(hamiltonian, target, proof, potential, finding.delta_j)
    else:
        show.print_head(hamiltonian, target, finding)
        if finding.leading is not None and finding.order is not None and degrees == 1:
            click.echo(f"  ΔJ       ({cut(finding.leading)})·h^{finding.order} + …")
        check_options.print_measured(finding)
    if with_keeps:
        check_options.print_keeps(finding)
    check_options.print_notes(finding)
