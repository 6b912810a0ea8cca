"""Scenes as users write them, of which a test changes a part, and how one is read."""

from pathlib import Path

from tests.paths import ROOT
from verify.scenes.scene import Scene, load_scene

PAPER = ROOT / "reports" / "paper"
H = "p**2/2 + q**4/4"
HEAD = f'hamiltonian = "{H}"\nschemes = ["lie2"]\n'
START = "initial_values = [{ q = 1.5, p = 0 }]"
GRID = f"[grid]\ntime = 1\nstep_sizes = [0.1]\n{START}\n"
SERIES = "[[series]]\ntime = 1\nstep_size = 0.1\ninitial_value = { q = 1.5, p = 0 }\n"
GOOD = HEAD + GRID + SERIES
DUFFING = 'system = "duffing"\nschemes = ["lie2"]\n'


def load(folder: Path, content: str | bytes) -> Scene:
    path = folder / "mine.toml"
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return load_scene(path)
