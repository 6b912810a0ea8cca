"""No file here, nor what it takes from the helpers, imports the toolkit."""

import ast
from pathlib import Path

import pytest

from tests.helpers.programs import compilers

FILES = sorted(Path(__file__).parent.glob("*.py"))
HELPER = Path(compilers.__file__)


def imported(file: Path) -> set[str]:
    names: set[str] = set()
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names |= {each.name for each in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0
            names.add(str(node.module))
    return names


@pytest.mark.parametrize("file", [*FILES, HELPER], ids=lambda file: file.name)
def test_a_file_imports_nothing_of_the_toolkit(file: Path) -> None:
    names = imported(file)
    assert not {name for name in names if name.split(".")[0] == "verify"}
    ours = {name for name in names if name.split(".")[0] == "tests"}
    assert all(name.startswith(("tests.second", "tests.helpers.programs")) for name in ours)


def test_the_helper_s_packages_are_empty() -> None:
    for folder in (HELPER.parent, HELPER.parents[1], HELPER.parents[2]):
        assert not imported(folder / "__init__.py")


def test_an_import_of_the_toolkit_is_seen(tmp_path: Path) -> None:
    bad = tmp_path / "bad.py"
    bad.write_text("def f():\n    from verify.flows import orbit\n", encoding="utf-8")
    assert imported(bad) == {"verify.flows"}
