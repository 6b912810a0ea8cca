"""A small folder of reference data, and ways to damage it, for several tests."""

import json
import random
from functools import cache
from pathlib import Path
from typing import Any

from verify.execution.execute import Store, execute
from verify.execution.executors import THIS_PROCESS
from verify.reference.make.data_files import MANIFEST, digest
from verify.reference.make.data_folder import (
    SceneText,
    command_of,
    data_of,
    files_of,
    manifest_of,
    write,
)
from verify.reference.make.models import AnyData
from verify.reference.make.scene_plan import plan_references
from verify.scenes.scene import scene_from_toml

SCENES = {
    "mine": """
title = "A pendulum"
hamiltonian = "p**2/2 - a*cos(q)"
parameters = { a = "3/2" }
schemes = ["lie1", "lie2", "rk4", "stormer-verlet"]
[[reference]]
step_sizes = [0.1, "1/3"]
initial_values = [{ q = 1.5, p = "-1/4" }]
steps = [0, 1, 7, 30]
digits = 14
""",
    "leaves": """
system = "duffing"
parameters = { delta = 1 }
schemes = ["lie2", "symplectic-euler"]
[[reference]]
step_sizes = [100]
initial_values = [{ q = 1, p = 0 }]
steps = [0, 1, 2, 8, 9]
digits = 9
flow = false
""",
}

IN_DEGREES = {
    "heiles": """
hamiltonian = "p1**2/2 + p2**2/2 + q1**2/2 + q2**2/2 + q1**2*q2 - q2**3/3"
schemes = ["lie1", "lie2", "stormer-verlet"]
[[reference]]
step_sizes = [0.05]
initial_values = [{ q = [0.3, 0.1], p = [0, "1/3"] }]
steps = [0, 1, 20]
digits = 18
""",
    "three": """
hamiltonian = "p1**2/2 + p2**2/2 + p3**2/2 - cos(q1 - q2) + a*q3**2*cos(t) + q2*q3"
parameters = { a = "1/2" }
t0 = 0.25
schemes = ["lie1", "explicit-midpoint"]
[[reference]]
step_sizes = [0.1]
initial_values = [{ q = [0.3, 0.1, 1], p = [0, "1/3", -0.5] }]
steps = [0, 3]
digits = 12
""",
}

POLES = {  # H is not defined after the first step
    "pole": """
hamiltonian = "p**2/2 + q*log(q) - q"
schemes = ["lie2"]
[[reference]]
step_sizes = [1]
initial_values = [{ q = "0.5", p = "-2" }]
steps = [0, 1, 3, 5]
digits = 8
flow = false
""",
    "pole-in-degrees": """
hamiltonian = "p1**2/2 + p2**2/2 + q1*log(q1) - q1 + q2**2*q1"
schemes = ["lie2"]
[[reference]]
step_sizes = [1]
initial_values = [{ q = [0.5, 0.2], p = [-2, 0] }]
steps = [0, 1, 3, 5]
digits = 8
flow = false
""",
}


def made(scenes: dict[str, str] | None = None) -> list[AnyData]:
    """The data of the scenes."""
    return [_made(name, toml) for name, toml in (scenes or SCENES).items()]


@cache
def _made(name: str, toml: str) -> AnyData:
    scene = scene_from_toml(toml, name)
    return data_of(scene, execute(plan_references([scene]), Store(None), where=THIS_PROCESS))


def put(folder: Path, data: list[AnyData], scenes: dict[str, str] | None = None) -> None:
    """The data's files and their manifest in the folder."""
    folder.mkdir(parents=True, exist_ok=True)
    asked = [SceneText(scene_from_toml(x, name), x) for name, x in (scenes or SCENES).items()]
    files = files_of(data)
    command = command_of([f"{name}.toml" for name in scenes or SCENES], parquet=False)
    write(folder, files, manifest_of(asked, files, command))


def repaired(folder: Path, name: str) -> None:
    """The manifest says of that file what it now is."""
    path, content = folder / MANIFEST, (folder / name).read_bytes()
    lines = path.read_text().split("\n")
    for k, line in enumerate(lines):
        if f'"name": "{name}", "bytes"' in line:
            listed = {"name": name, "bytes": len(content), "sha256": digest(content)}
            lines[k] = f"  {json.dumps(listed)}" + ("," if line.endswith(",") else "")
    path.write_text("\n".join(lines))


def flipped(text: str, at: int, draw: random.Random) -> str:
    """The text with another character of the same kind there."""
    kinds = ("0123456789", "abcdefghijklmnopqrstuvwxyz", "{}[],:.-+ \n")
    old = text[at]
    kind = next((kind for kind in kinds if old in kind), "xyz")
    new = draw.choice([c for c in kind if c != old])
    return text[:at] + new + text[at + 1 :]


def changed(data: Any, path: list[Any], value: Any) -> Any:
    """The data with another value there, which a function makes of the one that is there."""
    raw = data.model_dump(mode="json", by_alias=True)
    at = raw
    for part in path[:-1]:
        at = at[part]
    at[path[-1]] = value(at[path[-1]]) if callable(value) else value
    return type(data).model_validate(raw)
