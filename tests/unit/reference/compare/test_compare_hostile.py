"""Reference data of others, which may be hostile: refused in one line, and nothing hangs."""

import json
import re
from pathlib import Path
from typing import Any

import pytest

from tests.helpers.constructed.reference import IN_DEGREES, made
from verify.errors import InputError
from verify.reference.compare.published_data import load
from verify.reference.compare.setting import OrbitPoints
from verify.reference.make.data_folder import PUBLISHED

HUGE = "1e+9999999999"


@pytest.mark.parametrize(
    ("scene", "place", "value", "problem"),
    [
        ("extreme-zero", ["rows", 0, "p", "value"], HUGE, f"zero.json: has the number {HUGE}"),
        ("extreme-zero", ["rows", 0, "p", "radius"], HUGE, f"zero.json: has the number {HUGE}"),
        ("heiles", ["rows", 2, "energy", "value"], "1e+9999999", "beyond all sizes"),
        ("heiles", ["q"], ["1/0", "1"], "1/0"),
        ("heiles", ["q"], ["1", "1", "1"], "of 2 numbers"),
        ("heiles", ["q"], "1", "is no reference data"),
    ],
    ids=["value", "radius", "energy", "by 0", "too many numbers", "no list"],
)
def test_a_run_that_cannot_be_one_is_refused_in_one_line(
    scene: str, place: list[Any], value: Any, problem: str, tmp_path: Path
) -> None:
    planar = scene not in IN_DEGREES
    if planar:
        text = (PUBLISHED / f"{scene}.json").read_text()
    else:
        text = made({scene: IN_DEGREES[scene]})[0].model_dump_json(by_alias=True)
    data = json.loads(text)
    *parts, last = place
    at = data["runs"][0]
    for part in parts:
        at = at[part]
    at[last] = value
    (tmp_path / f"{scene}.json").write_text(json.dumps(data))
    with pytest.raises(InputError, match=re.escape(problem)) as caught:
        load(tmp_path, None, planar=planar)
    assert "\n" not in str(caught.value)


def test_a_mistake_is_not_run_for_very_many_steps() -> None:
    case = next(load(PUBLISHED, "extreme-zero").runs()).orbit
    assert OrbitPoints({}).point_at(case, 10**30, 30) is None
    assert OrbitPoints({}).point_at(case, 10, 30) is not None
