"""Proofs for every H in n degrees of freedom: seconds, and the most memory that each took.

python tests/bench/several_degrees.py
"""

import subprocess
import sys

PROVED = (
    "import resource, sys, time\n"
    "from verify.proof.order_for_every_h import prove_for_every_h\n"
    "degrees, most = map(int, sys.argv[1:])\n"
    "begun = time.perf_counter()\n"
    "for eta in range(1, most + 1):\n"
    "    found = prove_for_every_h(f'lie{eta}', degrees=degrees)\n"
    "    assert found.verdict == 'PROVED' and found.order == eta + 1, found\n"
    "    assert found.telescopes is (eta % 2 == 0), found\n"
    "peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1024\n"
    "print(f'{time.perf_counter() - begun:.2f} s, {peak} MB')\n"
)


def main() -> None:
    for degrees, most in ((2, 5), (3, 3), (3, 4), (2, 6)):
        command = [sys.executable, "-c", PROVED, str(degrees), str(most)]
        found = subprocess.run(command, check=True, capture_output=True, text=True).stdout.strip()
        target = "60 s, 2000 MB" if (degrees, most) in ((2, 5), (3, 3)) else "none"
        print(f"n = {degrees}, lie1 … lie{most}, with telescoping: {found}; target {target}")


if __name__ == "__main__":
    main()
