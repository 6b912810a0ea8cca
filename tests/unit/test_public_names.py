"""The public names: there, listed in one place, and what help begins with."""

import ast
import pydoc
import subprocess
import sys
from importlib.metadata import version

import pytest

import verify
from tests.helpers.imports import VERIFY
from tests.paths import ROOT


def typed() -> set[str]:
    """The names that a type checker knows, which stand under TYPE_CHECKING."""
    tree = ast.parse((VERIFY / "__init__.py").read_text("utf-8"))
    (block,) = (x for x in tree.body if isinstance(x, ast.If))
    return {a.asname or a.name for x in block.body if isinstance(x, ast.ImportFrom)
            for a in x.names}  # fmt: skip


def test_public_names_are_those_that_a_type_checker_knows() -> None:
    assert typed() == set(verify.__all__)


@pytest.mark.parametrize("name", verify.__all__)
def test_a_public_name_is_there_and_says_what_it_is(name: str) -> None:
    assert name in dir(verify)
    assert getattr(verify, name).__doc__


def test_there_is_no_other_name() -> None:
    assert {name for name in dir(verify) if not name.startswith("__")} == set(verify.__all__)
    with pytest.raises(AttributeError, match="no attribute 'runn'"):
        _ = verify.runn  # type: ignore[attr-defined]


def test_the_version_is_that_of_the_installed_package() -> None:
    assert verify.__version__ == version("areaproof")
    assert "__version__" in dir(verify)


def test_help_names_the_public_names_before_all_modules() -> None:
    told = pydoc.plain(pydoc.render_doc(verify))
    modules = told.index("PACKAGE CONTENTS")
    assert all(told.index(f"    {name} ") < modules for name in verify.__all__)
    assert told.index("    run ") < told.index("    Verdict ")


def test_nothing_is_imported_for_the_list_of_names() -> None:
    code = (
        "import sys, verify; dir(verify); print(sorted({n.partition('.')[0] for n in sys.modules}))"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=ROOT
    )
    assert not {"numpy", "sympy", "pydantic", "flint"} & set(ast.literal_eval(done.stdout))


def test_the_module_is_the_command() -> None:
    command = [sys.executable, "-m", "verify", "--version"]
    done = subprocess.run(command, capture_output=True, text=True, check=True, cwd=ROOT)
    assert version("areaproof") in done.stdout
