"""The command `verify prove`, for one Hamiltonian or for every one."""

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from verify.commands.shared import proof_output as show
from verify.commands.shared.destinations import OUT_FILE
from verify.commands.shared.input import every_options, one_or_every, scheme_option, system_options
from verify.commands.shared.option import flag, option
from verify.commands.shared.output import CommandAnswer, answering, cut, pick, print_line
from verify.commands.shared.structure_options import compose_scheme, split_option, structure_options
from verify.errors import NOT_GIVEN, InputError
from verify.schemes import get

if TYPE_CHECKING:
    from collections.abc import Callable

    from verify.hamiltonians.hamiltonian import Hamiltonian
    from verify.proof.proof_for_every_h import ProofForEveryH
    from verify.proof.proof_for_one_h import Proof
    from verify.proof.special_values import SpecialValue
    from verify.proof.structures.structures_proof import StructuresProof
    from verify.schemes.scheme import Scheme
    from verify.structures.reading import KeepsRequest


@click.command()
@system_options
@scheme_option
@answering
@every_options
@flag("--time-dependent", "With --every-hamiltonian: for every H(p, q, t), or T(p, t) + V(q, t).")
@option(
    "--degrees",
    "N",
    "With --every-hamiltonian: in N degrees of freedom; without it the names in H decide.",
    type=int,
)
@option(
    "--certificate",
    "FILE",
    "Write the identities of the proof, for `verify certificate check`; if H has functions "
    "other than sin, cos, exp and quotients, those of the proof for every H.",
    type=OUT_FILE,
)
@structure_options
@split_option
def prove(
    scheme: str,
    every_hamiltonian: bool,
    separable: bool,
    time_dependent: bool,
    degrees: int | None,
    certificate: Path | None,
    keeps: "KeepsRequest",
    splits: tuple[str, ...],
    **options: Any,
) -> CommandAnswer:
    """Prove the order in h of ΔJ = det J − 1, and of the map itself.

    A parameter without a value stays a symbol, and the proof holds for all its values but those
    that it names: ΔJ may be smaller if a parameter is 0. For an H in p1 … pn and q1 … qn the orders
    of S = JᵀΩJ − Ω, which is 0 for a symplectic map, and of det J − 1 are proved.

    With --keeps, only what it names is judged: that the defect of one step is 0, or of an order;
    with --every-hamiltonian, of every H whose flow keeps it.

    \b
    verify prove --system duffing --scheme lie2
    verify prove --hamiltonian "p**2/2 - (1 + cos(2*t)/2)*cos(q)" --scheme lie2
    verify prove --hamiltonian "(p1**2 + p2**2)/2 + q1**2*q2 - q2**3/3" --scheme lie2
    verify prove --every-hamiltonian --scheme lie6
    verify prove --every-hamiltonian --degrees 2 --scheme lie4
    verify prove --every-hamiltonian --time-dependent --scheme stormer-verlet
    verify prove --system pendulum --scheme lie2 --keeps "energy: 3" --keeps reversible
    verify prove --every-hamiltonian --degrees 2 --scheme gauss4 --keeps angular-momentum
    verify prove --field "u_dot = u*(v - 2); v_dot = v*(1 - u)" --scheme rk4 --form "du^dv/(u*v)"
    """
    options_of_every = {
        "separable": separable,
        "time_dependent": time_dependent,
        "degrees": degrees,
    }
    hamiltonian = one_or_every(every_hamiltonian, options, **options_of_every)
    is_field = hamiltonian is not None and hamiltonian.energy is None
    if certificate is not None and (keeps or is_field):
        raise InputError("--certificate", str(certificate), "goes without --keeps and --field")
    if hamiltonian is not None and (keeps or is_field):
        return _prove_structures(hamiltonian, compose_scheme(scheme, splits, hamiltonian), keeps)
    if splits:
        raise InputError("--split", NOT_GIVEN, "goes with --field")
    if keeps:
        return _prove_structures_of_every(scheme, separable, time_dependent, degrees, keeps)
    if hamiltonian is not None:
        return _prove_one(hamiltonian, scheme, certificate)
    return _prove_every(scheme, separable, time_dependent, degrees, certificate)


def _prove_structures(
    hamiltonian: "Hamiltonian", scheme: str, keeps: "KeepsRequest"
) -> CommandAnswer:
    from verify.proof.structures.structures_proof import prove_structures
    from verify.structures.reading import KeepsRequest, read_structures

    integrator = get(scheme)
    request = keeps or KeepsRequest(keeps=("volume",))
    claims = read_structures(request, hamiltonian)
    proof = prove_structures(integrator.step_map(hamiltonian), claims, integrator)
    texts = {**hamiltonian.texts, "scheme": integrator.name}
    print_head = partial(show.print_head, hamiltonian, integrator.name, proof)
    return _answer_structures(proof, texts, print_head)


def _prove_structures_of_every(
    scheme: str, separable: bool, timed: bool, degrees: int | None, keeps: "KeepsRequest"
) -> CommandAnswer:
    from verify.proof.structures.structures_for_every_h import prove_structures_for_every_h

    proof = prove_structures_for_every_h(
        scheme, keeps, separable, timed=timed, degrees=1 if degrees is None else degrees
    )

    def print_head() -> None:
        click.echo(f"{proof.verdict}: {proof.reason}")
        print_line("H", proof.quantifier)
        print_line("scheme", scheme)

    texts = {"hamiltonian": proof.quantifier, "scheme": scheme}
    return _answer_structures(proof, texts, print_head)


def _answer_structures(
    proof: "StructuresProof",
    texts: dict[str, Any],
    print_head: "Callable[[], None]",
) -> CommandAnswer:
    from verify.commands.shared.structure_output import print_structures, structure_json

    def data() -> dict[str, Any]:
        rows = [{**structure_json(x), "example": x.example or None} for x in proof.keeps]
        head = {**pick(proof, "verdict", "reason"), **texts, **show.agreement_json(proof)}
        return {**head, "keeps": rows}

    def show_proof() -> None:
        print_head()
        print_structures(proof.keeps)
        click.echo(f"  the map  agrees with the exact flow {show.describe_agreement(proof)}")

    return CommandAnswer(data, show_proof, failed=proof.verdict == "REFUTED", timed=True)


def _prove_every(
    scheme: str, separable: bool, timed: bool, degrees: int | None, certificate: Path | None
) -> CommandAnswer:
    from verify.proof.order_for_every_h import prove_for_every_h

    proof = prove_for_every_h(
        scheme, separable, timed=timed, degrees=1 if degrees is None else degrees
    )
    if certificate is not None:
        from verify.proof.certificates.certification import certify_for_every_h

        _write_certificate(certify_for_every_h(proof), certificate)
    texts = {"hamiltonian": proof.quantifier}
    # Scripts read the lines of a proof in the plane, so their older form stays.
    print_in_degrees = partial(show.print_symplectic, texts, proof.scheme)
    return CommandAnswer(
        lambda: show.proof_json(texts, proof.scheme, proof, **show.checks_json(proof)),
        lambda: (_print_every if proof.planar else print_in_degrees)(proof),
        failed=proof.verdict == "REFUTED",
        timed=True,
    )


def _prove_one(hamiltonian: "Hamiltonian", scheme: str, certificate: Path | None) -> CommandAnswer:
    from verify.proof.certificates.certification import certify_for_one_h
    from verify.proof.order_for_one_h import prove as prove_order
    from verify.proof.plane.potential import potential_of
    from verify.proof.special_values import special_values

    integrator = get(scheme)
    proof = prove_order(integrator.step_map(hamiltonian), integrator)
    # In n degrees of freedom the proof itself says whether its leading coefficient telescopes.
    potential = potential_of(proof, integrator) if proof.planar else None
    special = () if potential is None else special_values(proof, integrator)
    if certificate is not None:
        _write_certificate(
            _build_certificate(
                partial(certify_for_one_h, proof, potential), proof, hamiltonian, integrator
            ),
            certificate,
        )

    def extra_json() -> dict[str, Any]:
        if potential is None:
            return show.checks_json(proof)
        return {"delta_j": proof.step_map.delta_j_text, "telescopes": potential.holds,
                "potential": potential.text, "special_values": list(map(_special_json, special)),
                "witness": show.point_json(proof.witness)}  # fmt: skip

    def show_proof() -> None:
        if potential is None:  # in n degrees of freedom: S in place of ΔJ
            show.print_symplectic(hamiltonian.texts, integrator.name, proof)
        else:
            closed = proof.step_map.delta_j_text
            show.print_proof(hamiltonian, integrator.name, proof, potential, closed, special)

    return CommandAnswer(
        lambda: show.proof_json(hamiltonian.texts, integrator.name, proof, **extra_json()),
        show_proof,
        failed=proof.verdict == "REFUTED",
        timed=True,
    )


def _special_json(special: "SpecialValue") -> dict[str, Any]:
    from verify.arithmetic.exact import text

    proof, keys = special.proof, ("verdict", "reason", "area_preserving")
    order, value = show.order_json(proof.order), text(special.value)
    return {"parameter": special.parameter, "value": value, **order, **pick(proof, *keys),
            "domain": proof.domain.texts}  # fmt: skip


def _build_certificate(
    build: "Callable[[], dict[str, Any]]",
    proof: "Proof",
    hamiltonian: "Hamiltonian",
    scheme: "Scheme",
) -> dict[str, Any]:
    """Return the certificate of this proof, which `build` makes, or that of the proof for every H.

    The latter if `build` raises InputError, as it does for a function of H that the checker does
    not know, and if this proof is PROVED.
    """
    from verify.proof.certificates.certification import certify_for_every_h
    from verify.proof.order_for_every_h import prove_for_every_h

    try:
        return build()
    except InputError as error:
        if scheme.every_h is None or proof.verdict != "PROVED":
            raise
        click.echo(f"the certificate is of the proof for every H: {error}", err=True)
        # Time and the degrees of freedom must be those of this H: the proof must apply to it.
        timed, degrees = hamiltonian.time_dependent, hamiltonian.degrees
        return certify_for_every_h(prove_for_every_h(scheme.name, timed=timed, degrees=degrees))


def _write_certificate(data: dict[str, Any], path: Path) -> None:
    import json

    from verify.files import write_atomically
    from verify.proof.certificates.checker import check

    try:
        # This is the checker that users run, which shares no code with the prover. A certificate
        # that it refuses is not written.
        check(data)
    except ValueError as reason:
        raise InputError("certificate", str(path), f"would be refused: {reason}") from None
    write_atomically(path, json.dumps(data, ensure_ascii=False, indent=1) + "\n")


def _print_every(proof: "ProofForEveryH") -> None:
    click.echo(f"{proof.verdict}: {proof.reason}")
    print_line("H", proof.quantifier)
    print_line("scheme", proof.scheme)
    if proof.order is not None:
        leading = cut(proof.formula or proof.leading) or "which is not written out"
        print_line("leading", f"h^{proof.order} · ({leading})")
        if proof.formula:
            print_line("", f"= h^{proof.order} · ({cut(proof.leading)})")
    if proof.telescopes:
        operator = "D" if proof.timed else "X"
        print_line("G", f"{cut(proof.potential or '')}, the leading coefficient is {operator}·G")
    if proof.telescopes is not None:
        print_line("telescopes", ("yes: " if proof.telescopes else "no: ") + cut(proof.why))
    if proof.domain:
        print_line("where", proof.domain.prose)
    print_line("the map", f"agrees with the exact flow {show.describe_agreement(proof)}")
    show.print_checks(proof)
