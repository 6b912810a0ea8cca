"""Python started with -OO, or PYTHONOPTIMIZE=2, which keeps neither docstrings nor asserts."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.paths import ROOT
from verify.exploration import properties

EVERY_MODULE = """
import importlib, pkgutil, verify
from verify.exploration import properties
for module in pkgutil.walk_packages(verify.__path__, "verify."):
    if not {"libraries", "peers"} & {*module.name.split(".")}:  # which may lack theirs
        importlib.import_module(module.name)
print(*(properties.get(name).sentence for name in properties.names()), sep="\\n")
"""


def optimized(folder: Path, *arguments: str) -> str:
    environment = os.environ | {"PYTHONPATH": str(ROOT), "PYTHONOPTIMIZE": "2"}
    done = subprocess.run(
        [sys.executable, *arguments], cwd=folder, env=environment, capture_output=True, text=True,
        timeout=120, check=False,
    )  # fmt: skip
    assert (done.returncode, done.stderr) == (0, "")
    return done.stdout


def test_docstrings_are_really_left_out(tmp_path: Path) -> None:
    assert optimized(tmp_path, "-c", "'text'\nprint(__doc__)") == "None\n"


def test_a_proof_is_the_same_without_docstrings(tmp_path: Path) -> None:
    words = ["-m", "verify", "prove", "--system", "pendulum", "--scheme", "lie2", "--json"]
    assert json.loads(optimized(tmp_path, *words))["leading"] == "-p*sin(q)/2"


@pytest.mark.left_to_ci
def test_an_exploration_looks_at_every_property_without_docstrings(tmp_path: Path) -> None:
    words = ["-m", "verify", "explore", "--examples", "1", "--workers", "1", "--seed", "1"]
    said = optimized(tmp_path, *words)
    assert all(name in said for name in properties.names())


@pytest.mark.left_to_ci
def test_every_module_is_imported_and_every_property_has_its_sentence(tmp_path: Path) -> None:
    said = optimized(tmp_path, "-c", EVERY_MODULE)
    assert said.splitlines() == [properties.get(x).sentence for x in properties.names()]
