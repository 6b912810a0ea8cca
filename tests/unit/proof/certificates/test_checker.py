"""The checker is small, and shares nothing with the provers."""

import ast
import sys
from pathlib import Path

from verify.proof.certificates import checker


def test_the_checker_is_small_and_imports_nothing_of_the_provers() -> None:
    """The files that decide, and those that print what was decided."""
    folder = Path(checker.__file__).parent
    imported, lines = set(), 0
    own = ("checker", "entries", "balls", "readers", "named_numbers", "coefficients")
    for name in (*own, "established_statement"):
        source = (folder / f"{name}.py").read_text()
        code = [line for line in source.splitlines() if not line.lstrip().startswith("#")]
        lines += len(code) * (name != "established_statement")
        for node in ast.walk(ast.parse(source)):
            if isinstance(node, ast.Import):
                imported |= {alias.name for alias in node.names}
            elif isinstance(node, ast.ImportFrom):
                imported.add(node.module or "")
    theirs = {f"verify.proof.certificates.{name}" for name in own}
    assert lines <= 1020
    assert {x.partition(".")[0] for x in imported - theirs} <= set(sys.stdlib_module_names)
