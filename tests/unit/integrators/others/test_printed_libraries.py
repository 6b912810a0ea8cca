"""Tables in the sources of libraries: their claims, and what is wrong shown by plain steps."""

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from tests.helpers.tables.by_series import gap
from verify.integrators.others.printed_libraries import claims_of, files
from verify.integrators.tables.check import read_tables
from verify.scenes.results.claim import ClaimResult
from verify.verdict import Verdict

SOME = 5  # of so many tables one is judged here; all are by `verify report integrators`
# Splittings whose clocks are judged besides, and those of order 1 in time as in the sources.
CLOCKS = ("EULER", "LEAPFROG", "RUTH", "CANDY", "MCLACHLAN_2", "MCLACHLAN_4", "Leapfrog", "McAte2",
          "McAte4", "Ruth3", "CandyRoz4", "CalvoSanz4")  # fmt: skip


def of_some(path: Path) -> list[ClaimResult]:
    whole = read_tables(path)
    chosen = [
        pair
        for k, pair in enumerate(whole.entries)
        if k % SOME == 0 or any(name in pair[0].name for name in CLOCKS)
    ]
    chosen = [pair for pair in chosen if "SUZUKI" not in pair[0].name]
    return list(claims_of(replace(whole, entries=tuple(chosen))))


def test_every_file_is_read_and_names_where_it_was_read() -> None:
    assert files()
    for path in files():
        found = read_tables(path)
        assert found.title != path.stem
        for entry, _ in found.entries:
            assert entry.source
            assert entry.read.startswith(found.title), entry.name


@pytest.mark.parametrize("path", files(), ids=lambda path: path.stem)
def test_what_is_refuted_of_a_library_is_a_clock_or_known(
    path: Path,
) -> None:
    claims = of_some(path)
    wrong = [c for c in claims if c.verdict is Verdict.REFUTED]
    assert wrong
    assert {(c.kind, c.severity) for c in wrong if c.source not in KNOWN} == {
        ("order in time", "wrong clock")
    }
    assert all(c.severity for c in wrong)
    assert not any(c.severity for c in claims if c.verdict is not Verdict.REFUTED)
    assert len({c.id for c in claims}) == len(claims)


KNOWN = {  # for quadratic T, and claimed for every T
    "ARKODE_SPRK_MCLACHLAN_4_4", "ARKODE_SPRK_MCLACHLAN_5_6",
    "McAte4", "McAte5", "CalvoSanz4",  # their kicks and drifts are exchanged
}  # fmt: skip


@pytest.mark.parametrize("path", files(), ids=lambda path: path.stem)
def test_a_wrong_clock_is_shown_by_plain_code(path: Path) -> None:
    """The slopes of the error of one step end at 2, that of order 1."""
    clocks = [c for c in of_some(path) if c.severity == "wrong clock"]
    assert clocks
    for claim in clocks:
        told: list[Any] = []
        names = {"print": told.append, "__name__": "page"}
        exec(compile(claim.reproduction, claim.id, "exec"), names)  # noqa: S102 - our own
        assert abs(told[0][-1][1] - 2) < 0.3, claim.id


def test_the_series_of_a_leapfrog_with_sundials_clock_part_from_the_flow() -> None:
    table = {"kind": "splitting", "order": 2, "first": "kick", "sizes": ["0", "1/2", "1", "1/2"],
             "times": ["0", "1/2", "1", "1"], "time_dependent": "T and V"}  # fmt: skip
    assert gap(table, 2, timed=True) > 1
    assert gap({**table, "times": ["0", "0", "1/2", "1"]}, 2, timed=True) == 0
    assert math.isclose(gap(table, 1, timed=True), 0)
