"""The command line asked in this process, and its answer read: what knows its keys."""

import contextlib
import io
import json
import re
import time
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from verify.commands.main import main

_NUMBER = r"(\d+(?:\.\d+)?(?:[eE][+-]?\d+)?(?:/\d+)?)"


@dataclass(frozen=True)
class Answer:
    """What `verify … --json` prints: `said` is empty where it is bad input, and `error` is not."""

    status: int
    seconds: float
    error: str = ""
    said: dict[str, Any] = field(default_factory=dict)

    @property
    def verdict(self) -> str:
        """REFUTED, UNDECIDED, … or ERROR."""
        return str(self.said.get("verdict", "ERROR"))

    @property
    def outcome(self) -> str:
        """Of what was claimed: "accepted", "refuted", "undecided" or "error"."""
        if self.status not in (0, 1) or not self.said:
            return "error"
        if self.verdict == "REFUTED":
            return "refuted"
        return "accepted" if self.status == 0 and self.verdict != "UNDECIDED" else "undecided"

    @property
    def order(self) -> int | None:
        """The order that it says, where it does."""
        order = self.said.get("convergence_order")
        return order if self.said.get("convergence_order_known", True) else None

    @property
    def text(self) -> str:
        """All that it says to people."""
        notes = [str(x) for x in self.said.get("notes") or ()]
        return " | ".join([str(self.said.get("reason", self.error)), *notes])

    @property
    def defect(self) -> "Defect":
        """The counterexample, or the largest defect that is named, and its noise."""
        said, example = self.said, self.said.get("counterexample") or {}
        place = {name: example[name] for name in ("p", "q", "h", "t") if name in example}
        of_area = str(example.get("quantity", "")).startswith(("Δ", "det J"))
        size, _, noise = str(example.get("found", "") if of_area else "").partition("±")
        if not size:
            size, noise = said.get("delta_j_max"), said.get("probe_error")
        return Defect(_size(size), _size(noise), place)


@dataclass(frozen=True)
class Defect:
    """|ΔJ| as the answer names it, with the noise that it names, and where: p, q, h by name. The
    noise is that of the counterexample, and else the largest of all places."""

    size: float | None
    noise: float | None
    place: dict[str, str]


def _size(text: object) -> float | None:
    """The first number in what may be a sentence."""
    found = re.search(_NUMBER, str(text or ""))
    if found is None:
        return None
    above, _, below = found[1].partition("/")
    return float(above) / float(below or 1)


def asked(arguments: Sequence[str]) -> Answer:
    """Runs `verify` with these arguments, and `--json`, in this process."""
    out, errors, began, status = io.StringIO(), io.StringIO(), time.perf_counter(), 0
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(errors):
        try:
            main([*arguments, "--json"])
        except SystemExit as ended:
            status = int(ended.code or 0)
    seconds = time.perf_counter() - began
    try:
        said = json.loads(out.getvalue())
    except ValueError:
        said = {}
    return Answer(status, seconds, errors.getvalue().strip(), said)
