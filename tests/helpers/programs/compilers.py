"""Compilers that tests need: where one is missing a test is skipped by name, and fails in CI."""

import os
import shutil
import subprocess
from pathlib import Path

import pytest


def needed(name: str) -> str:
    """Where the program is."""
    found = shutil.which(name)
    if found is None:
        if os.environ.get("CI"):
            pytest.fail(f"{name} is not installed")
        pytest.skip(f"{name} is not installed")
    return found


_COMPILERS = {".c": "gcc", ".cpp": "g++", ".f90": "gfortran"}


def library(folder: Path, name: str, source: str, *options: str) -> str:
    """A shared library of that C, C++ or Fortran source, and its path."""
    return _compiled(folder, name, source, ".so", "-shared", "-fPIC", *options)


def executable(folder: Path, name: str, source: str, *options: str) -> str:
    """A program of that source, and its path."""
    return _compiled(folder, name, source, "", *options)


def _compiled(folder: Path, name: str, source: str, suffix: str, *options: str) -> str:
    path, made = folder / name, folder / f"{Path(name).stem}{suffix}"
    path.write_text(source, encoding="utf-8")
    command = [needed(_COMPILERS[path.suffix]), "-O2", str(path), "-o", str(made), *options]
    # A Fortran compiler writes the modules of a source where it is started.
    subprocess.run(command, check=True, capture_output=True, cwd=folder)
    return str(made)
