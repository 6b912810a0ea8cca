"""What is read is a value or one documented error: a sample of the campaign."""

import pytest

from tests.campaigns.readers import campaign


@pytest.mark.left_to_ci
def test_a_sample_of_fuzzed_inputs_gives_documented_errors_and_no_others() -> None:
    answers, wrong = campaign(1500, seed=5)
    assert wrong == []
    for sort in ("formula", "number", "scheme", "path", "scene", "claims", "certificate", "table",
                 "coefficients"):  # fmt: skip
        assert answers[f"{sort} read"] > 0, sort
        assert answers[f"{sort} refused"] > 0, sort
