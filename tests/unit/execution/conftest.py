"""The plan that tests of its execution carry out."""

from pathlib import Path

import pytest

from tests.helpers.constructed.plans import CONTENT
from tests.helpers.constructed.scenes import load
from verify.execution.plan import Plan
from verify.studies.tasks_of_scenes import plan_scenes


@pytest.fixture
def plan(tmp_path: Path) -> Plan:
    made = plan_scenes([load(tmp_path, CONTENT)])
    assert len(made.tasks) == 8
    return made
