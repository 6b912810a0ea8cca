"""The `results.json` of the manual's page, held to the schema that the manual gives along."""

import copy
from collections.abc import Callable
from typing import Any

import pytest
from jsonschema import Draft202012Validator

from docs._generate.parts.results_json import schema
from tests.helpers.pages.blocks import PAGES
from tests.helpers.pages.session import read_through

Report = dict[str, Any]


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory) -> Report:
    made = tmp_path_factory.mktemp("results")
    found: Report = read_through(PAGES["docs/reference/results-json.md"], made).names["report"]
    return found


def mistakes(report: Report) -> list[str]:
    return [error.message for error in Draft202012Validator(schema()).iter_errors(report)]


def test_a_report_is_as_the_schema_says(report: Report) -> None:
    Draft202012Validator.check_schema(schema())
    assert not mistakes(report)


def _a_number_in_place_of_a_text(scene: Report) -> None:
    scene["runs"][0]["values"]["lambda"]["value"] = 0.00152


def _a_key_too_many(scene: Report) -> None:
    scene["proofs"][0]["sure"] = True


def _a_key_too_few(scene: Report) -> None:
    del scene["proofs"][0]["reason"]


def _another_verdict(scene: Report) -> None:
    scene["proofs"][0]["verdict"] = "TRUE"


@pytest.mark.parametrize(
    "planted",
    [_a_number_in_place_of_a_text, _a_key_too_many, _a_key_too_few, _another_verdict],
)
def test_what_is_none_is_seen(report: Report, planted: Callable[[Report], None]) -> None:
    wrong = copy.deepcopy(report)
    planted(wrong["scenes"][0])
    assert mistakes(wrong)
