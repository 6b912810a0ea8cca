"""TOML of anybody's: what is too deep is refused before it is read, and nothing else is."""

import tomllib
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.examples import drawn
from tests.paths import ROOT
from verify.audits import mistake
from verify.claims.claims_file import load_claims
from verify.errors import InputError
from verify.exploration.island_search import scene_of
from verify.integrators.tables.table_file import check_table
from verify.scenes.results.exploration import Worst
from verify.scenes.scene import load_scene, scene_from_toml
from verify.scenes.toml_file import read_toml, toml_data

MANY = ".".join(["a"] * 20_000)
DEEP = {
    "key": f"{MANY} = 1",
    "header": f"[{MANY}]",
    "array": f"[[{MANY}]]",
    "inline": f"x = {{ {MANY} = 1 }}",
    "inside an array": f"x = [1, {{ b = '#', {MANY} = 1 }}]",
    "with spaces": "\t. ".join(["a"] * 20_000) + "=1",
    "quoted": ".".join(['"a.\\"b"', "'#'"] * 10_000) + "=1",
    "after a text": f'x = """a""\\""""\n{MANY} = 1',
    "after a comment": f"# '''\n{MANY} = 1",
    "after an open text": f"x = 'a\n{MANY} = 1",
}
SHALLOW = {
    "text": f'x = "{MANY}"',
    "literal": f"x = '{MANY}'",
    "text of lines": f'x = """\n""{MANY}\n"""""',
    "literal of lines": f"x = '''\n'{MANY}\n'''''",
    "escaped": f'x = "\\"{MANY}"',
    "comment": f"x = 1  # {MANY}",
    "decimals": f"x = [{'0.5, ' * 20_000}]",
    "allowed": ".".join(["a"] * 11) + " = 1",
}


def never(*_: object, **__: object) -> None:
    raise AssertionError("it is read")


@pytest.mark.parametrize("text", DEEP.values(), ids=DEEP)
def test_a_key_of_very_many_parts_is_refused_before_it_is_read(
    text: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tomllib, "loads", never)
    with pytest.raises(InputError, match=r"file=deep\.toml: is nested deeper than 12"):
        toml_data(text, "deep.toml")


@pytest.mark.parametrize("text", SHALLOW.values(), ids=SHALLOW)
def test_what_only_looks_like_such_a_key_is_read(text: str) -> None:
    assert toml_data(text, "x.toml") == tomllib.loads(text, parse_float=str)


PIECES = ["a", ".", '"', "'", '"""', "'''", "\\", "#", "\n", " ", "=", "1", "[", "]", "{", "}", ","]
KEYS = st.lists(st.sampled_from(["a", '"b"', "'c.'", '"\\""']), min_size=1, max_size=14)
KEY = KEYS.map(".".join)
STRING = st.lists(st.sampled_from(PIECES), max_size=30).map("".join)
VALUE = st.one_of(
    st.just("1"), STRING.map(lambda x: f'"""{x}"""'), STRING.map(lambda x: f"'''{x}'''"),
    STRING.map(lambda x: '"' + x.replace('"', "").replace("\n", "") + '"'),
    KEY.map(lambda x: f"{{{x} = 1}}"),
)  # fmt: skip
LINE = st.builds(lambda k, v, c: f"{k} = {v} # {c}", KEY, VALUE, st.just('\'""" a.b'))


def depth(data: object) -> int:
    inner = data.values() if isinstance(data, dict) else data if isinstance(data, list) else []
    return 1 + max(map(depth, inner), default=0)


@drawn(500)
@given(st.lists(LINE, min_size=1, max_size=3).map("\n".join))
def test_what_is_refused_is_what_is_deep(text: str) -> None:
    try:
        data = tomllib.loads(text, parse_float=str)
    except tomllib.TOMLDecodeError:
        with pytest.raises(InputError):
            toml_data(text, "x.toml")
        return
    if depth(data) > 12:
        with pytest.raises(InputError, match="deeper than 12"):
            toml_data(text, "x.toml")
    else:
        assert toml_data(text, "x.toml") == data


def in_results(path: Path) -> object:
    return scene_of(Worst.model_construct(scene=path.read_text()))


READERS = [
    read_toml, load_scene, load_claims, check_table, mistake.read, in_results,
    lambda path: scene_from_toml(path.read_text(), path.name),
]  # fmt: skip


@pytest.mark.parametrize("reader", READERS)
def test_every_reader_refuses_it(reader: Callable[[Path], object], tmp_path: Path) -> None:
    path = tmp_path / "deep.toml"
    path.write_text(DEEP["key"])
    with pytest.raises(InputError, match="is nested deeper than 12"):
        reader(path)


def test_there_is_no_other_reader() -> None:
    readers = [x.name for x in (ROOT / "verify").rglob("*.py") if "tomllib" in x.read_text()]
    assert sorted(readers) == ["toml_file.py"]


# -- what a terminal would act on -----------------------------------------------------------------

PLACES = {
    "key": '"a{}" = 1',
    "dotted key": 'a."b{}" = 1',
    "header": '["a{}"]\nx = 1',
    "array of tables": '[["a{}"]]\nx = 1',
    "inline": 'x = {{ "a{}" = 1 }}',
    "key inside an array": 'x = [1, {{ "a{}" = 1 }}]',
    "text": 'x = "a{}"',
    "text in an array": 'x = ["b", "a{}"]',
    "text in a table": '[a]\nb = {{ c = "a{}" }}',
}


@pytest.mark.parametrize("character", ["001b", "0007", "0000", "007f", "009b"])
@pytest.mark.parametrize("text", PLACES.values(), ids=PLACES)
def test_a_control_character_is_refused_wherever_it_stands(text: str, character: str) -> None:
    with pytest.raises(InputError, match=f"U\\+{character.upper()}, a control character") as told:
        toml_data(text.format(f"\\u{character}"), "x.toml")
    assert str(told.value).isprintable()
    assert toml_data(text.format(r"\\"), "x.toml")
