"""Where things lie in the repository."""

import json
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[1]
DATA = ROOT / "tests" / "data"


def vectors() -> Any:
    """Values that were computed elsewhere, with MPFR at 500 bits."""
    return json.loads((DATA / "vectors.json").read_text())["cases"]
