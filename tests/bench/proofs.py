"""Proofs as whole processes: every H, certificates, a polynomial H of degree 8, the paper's claims.

python tests/bench/proofs.py
"""

import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

ROUNDS = 3
EVERY = (
    "from verify.proof.order_for_every_h import prove_for_every_h\n"
    "for eta in range(1, 9):\n"
    "    proof = prove_for_every_h(f'lie{eta}')\n"
    "    assert proof.verdict == 'PROVED' and proof.order == eta + 1, proof\n"
    "    assert proof.telescopes is (eta % 2 == 0), proof\n"
)
DEGREE_8 = "(p**8 + q**8)/8 + p**3*q**5/5 - 2*p**4*q**2 + p*q/3 + q**7/7"


SYMBOLIC = (
    "import sys; from verify.claims.verdicts import prepare\n"
    "from verify.claims.claims_file import load_claims\n"
    "from verify.commands.shared.input import paper_folder\n"
    "from verify.execution.execute import Store\n"
    "file = load_claims(paper_folder() / 'claims.toml')\n"
    "names = [c.id for c in file.claims if c.exact]\n"
    "found = prepare(file, names).run(Store(None))\n"
    "assert len(found) >= 28 and all(c.verdict != 'UNDECIDED' for c in found)\n"
)


def show(what: str, command: Sequence[str], target: str) -> None:
    """The least wall time of some rounds, process start included."""
    taken = []
    for _ in range(ROUNDS):
        begun = time.perf_counter()
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        taken.append(time.perf_counter() - begun)
    print(f"{what:66} {min(taken):6.2f} s   target {target}")


def main() -> None:
    verify = [sys.executable, "-m", "verify"]
    show("lie1 … lie8 for every H, with telescoping", [sys.executable, "-c", EVERY], "< 2 s")
    with tempfile.TemporaryDirectory() as folder:
        file = str(Path(folder) / "lie6.json")
        made = [*verify, "prove", "--every-hamiltonian", "--scheme", "lie6", "--certificate", file]
        show("lie6 for every H, its certificate written", made, "–")
        show("that certificate checked", [*verify, "certificate", "check", file], "< 1 s")
    one = [*verify, "prove", "--hamiltonian", DEGREE_8, "--scheme", "lie8"]
    show("a polynomial H of degree 8, lie8", one, "< 2 s")
    show("the paper's claims, symbolic part", [sys.executable, "-c", SYMBOLIC], "< 5 s")


if __name__ == "__main__":
    main()
