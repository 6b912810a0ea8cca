"""What is shown of the worst scenes, and the files that a hunt leaves behind."""

import json
from pathlib import Path

import pytest

from tests.helpers.constructed.galleries import at, gallery, shown
from verify.commands.hunt import _describe_loss, _format_command, _write_scenes
from verify.execution.execute import Store
from verify.execution.executors import THIS_PROCESS
from verify.exploration.hunting import Hunt, find_meaningless_span
from verify.exploration.hunting import gallery as gallery_of
from verify.exploration.sample_space import SampleSpace
from verify.scenes.results.exploration import HuntResult, Worst


def _text(formula: str) -> str:
    return (
        f'hamiltonian = "{formula}"\nschemes = ["lie2"]\n[grid]\nsteps = 2\n'
        'step_sizes = ["0.1"]\ninitial_values = [{ q = "0.1", p = "0.1" }]\n'
    )


@pytest.mark.parametrize(
    ("series", "first", "over"),
    [
        ([(5, "1e-6", "1e-16"), (9, "1e-9", "1e-15")], None, None),
        ([(5, "1e-12", "1e-16"), (9, "1e-12", "1e-11")], 9, None),
        ([(5, "1e-16", "1e-15"), (9, "1e-11", "1e-15"), (12, "-1e-10", "1e-14")], 5, 9),
        ([(5, "1e-6", "0"), (9, "0", "1e-16")], None, None),  # Λ passes through 0
        ([(5, "0", "0"), (9, "0", "0")], None, None),  # nothing, or of no known digit
        ([(5, "0", "0"), (9, "1e-6", "1e-12")], None, None),
        ([(5, "0", "-1e-16")], 5, None),  # all of it is rounding
    ],
)
def test_where_lambda_is_meaningless(
    series: list[tuple[int, str, str]], first: int | None, over: int | None
) -> None:
    found = find_meaningless_span([at(*each) for each in series])
    assert (found.first, found.over) == (first, over)


def test_a_run_that_does_not_end_is_shown_by_the_hunts_own() -> None:
    asked = Hunt(measure="growth", seed=1, examples=1, steps=20)
    text = _text("p**2/2 + 9*q**2/2").replace("steps = 2", "steps = 20")
    far = _text("p*q**2").replace("steps = 2", "steps = 20")
    found = HuntResult(
        worst=(Worst(value=1.0, scene=text), Worst(value=0.5, scene=far)), examples=2
    )
    kept, lost = gallery_of(asked, found, Store(None), where=THIS_PROCESS).scenes
    assert (kept.separation.steps, kept.longer) == (2000, None)
    assert (lost.separation.steps, lost.separation.status) == (20, "finished")
    assert lost.longer is not None
    assert (lost.longer.steps, lost.longer.status) == (2000, "left range")
    assert lost.orbit[0] == ("1.00000e-01", "1.00000e-01")
    assert "separate = true" in kept.scene, "its own report shows what the gallery shows"


def test_the_command_makes_the_same_hunt_again() -> None:
    drawn = SampleSpace(kinds=("polynomial",), degree=4, schemes=("lie1", "p_next = p; q_next = q"))
    asked = Hunt(measure="growth", seed=3, examples=10, steps=50)
    assert _format_command(asked) == (
        "verify explore --maximise growth --examples 10 --seed 3 --steps 50"
    )
    object.__setattr__(asked, "drawn", drawn)
    assert _format_command(asked).endswith(
        "--steps 50 --scheme lie1 --scheme 'p_next = p; q_next = q' --kind polynomial --degree 4"
    )


def test_where_nothing_of_lambda_is_known_neither_part_is_said_to_be_the_larger() -> None:
    """Størmer–Verlet of a quadratic H: truncation and rounding are both 0."""
    text = _text("p**2/2 + q**2/2").replace("lie2", "stormer-verlet")
    asked = Hunt(measure="digits-lost", seed=1, examples=1, steps=2)
    found = HuntResult(worst=(Worst(value=1.0, scene=text),), examples=1)
    (each,) = gallery_of(asked, found, Store(None), where=THIS_PROCESS).scenes
    assert _describe_loss(each) == "over 200 steps no digit of a part of Λ is known but 0"
    lies = HuntResult(worst=(Worst(value=1.0, scene=_text("p**2/2 + q**2/2")),), examples=1)
    (other,) = gallery_of(asked, lies, Store(None), where=THIS_PROCESS).scenes
    assert _describe_loss(other) == "over 200 steps truncation is the larger part of Λ"


def test_scenes_of_an_earlier_hunt_do_not_stay(tmp_path: Path) -> None:
    for name in ("worst-1.toml", "worst-2.toml", "worst-12.toml", "worst-of-mine.toml"):
        (tmp_path / name).write_text("old")
    _write_scenes([each.scene for each in gallery(shown()).scenes], tmp_path)
    left = {file.name: file.read_text() for file in tmp_path.iterdir()}
    assert set(left) == {"worst-1.toml", "worst-of-mine.toml"}
    assert left["worst-1.toml"] == shown().scene


def test_results_are_the_same_after_a_round_trip() -> None:
    made = gallery(shown())
    assert type(made).model_validate_json(made.model_dump_json()) == made
    found = HuntResult(worst=(Worst(value=-1.5, scene="x"),), examples=3)
    assert HuntResult.model_validate(json.loads(found.model_dump_json())) == found
