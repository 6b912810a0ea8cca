"""Reference data of others, which may be hostile: refused in one line, and nothing hangs."""

import json
from pathlib import Path
from typing import Any

import pytest

from verify.errors import InputError
from verify.reference.compare.published_data import load
from verify.reference.compare.setting import OrbitPoints
from verify.reference.make.data_folder import PUBLISHED


@pytest.mark.parametrize("part", ["value", "radius"])
def test_a_number_of_very_many_digits_is_refused(tmp_path: Path, part: str) -> None:
    data: dict[str, Any] = json.loads((PUBLISHED / "extreme-zero.json").read_text())
    data["runs"][0]["rows"][0]["p"][part] = "1e+9999999999"
    (tmp_path / "extreme-zero.json").write_text(json.dumps(data))
    with pytest.raises(InputError, match=r"extreme-zero\.json: has the number 1e\+9999999999"):
        load(tmp_path, None)


def test_a_mistake_is_not_run_for_very_many_steps() -> None:
    case = next(load(PUBLISHED, "extreme-zero").runs()).orbit
    assert OrbitPoints({}).point_at(case, 10**30, 30) is None
    assert OrbitPoints({}).point_at(case, 10, 30) is not None
