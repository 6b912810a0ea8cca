"""Properties with other examples each day: all that are asked for, by a seed that is printed.

    python -m tests.campaigns.today                     # the seed is the date, as 20261129
    python -m tests.campaigns.today --seed 20261129     # that day's again
    python -m tests.campaigns.today tests/property/runs -k fixed

CI draws the same examples each time, an eighth of them; what they miss they would miss for ever.
What is given beside goes to pytest.
"""

import argparse
import datetime
import os
import subprocess
import sys

from tests.paths import ROOT

_WITH_EXAMPLES = ("tests/property", "tests/unit/kernels", "tests/unit/strategies")


def command(seed: int, given: list[str]) -> list[str]:
    """What is run."""
    places = [] if any(not x.startswith("-") and "/" in x for x in given) else _WITH_EXAMPLES
    return [sys.executable, "-m", "pytest", "--whole", f"--hypothesis-seed={seed}", *places, *given]


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    today = int(datetime.datetime.now(tz=datetime.UTC).strftime("%Y%m%d"))
    parser.add_argument("--seed", type=int, default=today)
    asked, given = parser.parse_known_args()
    print(f"seed {asked.seed}; again: python -m tests.campaigns.today --seed {asked.seed}")
    # In CI hypothesis would draw the same examples whatever the seed is.
    environment = {name: value for name, value in os.environ.items() if name != "CI"}
    done = subprocess.run(command(asked.seed, given), cwd=ROOT, env=environment, check=False)
    raise SystemExit(done.returncode)


if __name__ == "__main__":
    main()
