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


def library(folder: Path, name: str, source: str, *options: str) -> str:
    """A shared library of that C or Fortran source, and its path."""
    path, made = folder / name, folder / f"{Path(name).stem}.so"
    path.write_text(source, encoding="utf-8")
    compiler = needed("gfortran" if path.suffix == ".f90" else "gcc")
    command = [compiler, "-O2", "-shared", "-fPIC", str(path), "-o", str(made), *options]
    # A Fortran compiler writes the modules of a source where it is started.
    subprocess.run(command, check=True, capture_output=True, cwd=folder)
    return str(made)
