"""Which scenes a report of a claims file shows, and how a file of claims is told from a scene's."""

from pathlib import Path

import pytest

from verify.claims.claims_file import load_claims
from verify.commands.shared.input import load_target
from verify.errors import InputError

SCENE = 'system = "harmonic"\nschemes = ["lie2"]\n'
HERE = f'[[scene]]\nname = "here"\n{SCENE}'
CLAIM = '[[claim]]\nid = "a"\nscheme = "lie2"\nkind = "defect_order"\ndefect_order = 4\n'
OF_BESIDE = f'{CLAIM}scene = "beside"\n'
OF_NO_SCENE = f'{CLAIM}system = "harmonic"\n'


@pytest.fixture(autouse=True)
def _folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    for name in ("beside", "further"):
        Path(f"{name}.toml").write_text(f'title = "{name.title()}"\n{SCENE}')


def shown(text: str) -> list[str]:
    path = Path("claims.toml")
    path.write_text(text)
    return [scene.name for scene in load_claims(path).report_scenes]


# -- report_scenes --------------------------------------------------------------------------------


def test_a_report_shows_the_scenes_that_the_file_has_and_that_its_claims_name() -> None:
    assert shown(HERE + OF_BESIDE) == ["here", "beside"]


def test_a_claim_with_an_h_of_its_own_has_no_scene_that_is_shown() -> None:
    assert shown(OF_NO_SCENE) == []


def test_the_scene_of_a_figure_is_shown_too() -> None:
    grid = "[grid]\nsteps = 1\nstep_sizes = [0.1]\ninitial_values = [{ q = 1, p = 0 }]\n"
    Path("further.toml").write_text(f"{SCENE}parameters = {{ omega = 1 }}\n{grid}")
    figure = '[[figure]]\nlabel = "Figure 1"\nscene = "further"\nshows = "runs"\n'
    assert shown(OF_NO_SCENE + figure) == ["further"]


def test_a_file_may_name_the_scenes_in_their_order() -> None:
    names = 'report_scenes = ["further", "here"]\n'
    assert shown(names + HERE + OF_BESIDE) == ["further", "here"]


def test_a_file_may_have_no_scene_shown() -> None:
    assert shown("report_scenes = []\n" + HERE + OF_BESIDE) == []


WRONG = {
    "unknown": ('["nowhere"]', "scene=nowhere: there is no nowhere.toml beside the claims file"),
    "one-of-two": ('["here", "nowhere"]', "scene=nowhere: there is no nowhere.toml"),
    "a-path": ('["../beside"]', "scene=../beside: is no name of a scene"),
    "a-text": ('"here"', "report_scenes=here: is not a list of texts"),
    "numbers": ("[1]", "report_scenes=[1]: is not a list of texts"),
    "a-table": ("{ here = 1 }", "report_scenes={'here': 1}: is not a list of texts"),
}


@pytest.mark.parametrize(("value", "problem"), WRONG.values(), ids=WRONG)
def test_what_is_no_list_of_scenes_is_named_with_its_line(value: str, problem: str) -> None:
    with pytest.raises(InputError) as error:
        shown(f'title = "x"\nreport_scenes = {value}\n{HERE}{OF_BESIDE}')
    assert str(error.value).startswith("claims.toml:2: report_scenes")
    assert problem in str(error.value)
    assert "\n" not in str(error.value)


# -- the target of a command ----------------------------------------------------------------------


def test_a_file_of_claims_is_a_target_with_its_title_its_scenes_and_its_claims() -> None:
    Path("mine.toml").write_text(f'title = "A paper"\n{HERE}{OF_BESIDE}')
    title, scenes, file = load_target("mine.toml")
    assert (title, [scene.name for scene in scenes]) == ("A paper", ["here", "beside"])
    assert file is not None
    assert [claim.id for claim in file.claims] == ["a"]


def test_a_file_of_claims_without_a_title_has_its_own_name() -> None:
    Path("mine.toml").write_text(OF_NO_SCENE)
    assert load_target("mine.toml")[0] == "mine"


def test_a_file_of_a_scene_is_a_target_without_claims() -> None:
    title, scenes, file = load_target("beside.toml")
    assert (title, [scene.name for scene in scenes], file) == ("Beside", ["beside"], None)


def test_the_paper_is_its_file_of_claims() -> None:
    title, scenes, file = load_target("paper")
    assert file is not None
    assert (title, scenes) == (file.title, file.report_scenes)
    assert [scene.name for scene in scenes] == [
        "duffing", "pendulum", "two-degrees-1-regular", "two-degrees-2-chaotic",
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("claim = 3\n", "file=mine.toml: must hold [[claim]] tables"),
        (f"{CLAIM}scene = 'nowhere'\n", "mine.toml:6: claim a: scene=nowhere"),
        ("claims = 3\n", "mine.toml: claims=3: unknown key"),
        ("= 3\n", "file=mine.toml: is not TOML"),
    ],
)
def test_what_is_wrong_in_a_target_is_named_with_its_place(text: str, message: str) -> None:
    Path("mine.toml").write_text(text)
    with pytest.raises(InputError) as error:
        load_target("mine.toml")
    assert str(error.value).startswith(message)


def test_a_target_that_is_no_file_is_named() -> None:
    with pytest.raises(InputError, match=r"nothing\.toml"):
        load_target("nothing.toml")
