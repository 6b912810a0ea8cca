"""`python -m verify` is the command `verify`."""

import sys
from pathlib import Path

# Python puts the current folder first on the path; where verify itself does not come from there,
# nothing else shall.
if Path(sys.path[0]).resolve() != Path(__file__).resolve().parents[1]:
    del sys.path[0]

from verify.commands.main import main

main()
