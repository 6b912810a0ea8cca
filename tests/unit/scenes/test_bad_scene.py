"""A scene with a bad key or value, and one that cannot be read: each is named in one line."""

from pathlib import Path

import pytest

from tests.helpers.constructed.scenes import DUFFING, GOOD, GRID, HEAD, SERIES, H, load
from verify.errors import InputError
from verify.scenes.scene import load_scene
from verify.scenes.values import MAX_STEPS

HENON = "(p1**2 + p2**2 + q1**2 + q2**2)/2 + q1**2*q2 - q2**3/3"
TWO_DEGREES = HEAD.replace(H, HENON)
LISTS = "q = [0.3, -0.1], p = [0.1, 0.2]"
GRID_OF_LISTS = GRID.replace("q = 1.5, p = 0", LISTS)
SEPARATED = f"""
[[separation]]
step_sizes = [0.1, 0.05]
steps = 30
initial_value = {{ {LISTS} }}
"""
REFERENCE = f"""
[[reference]]
step_sizes = [0.05]
initial_values = [{{ {LISTS} }}]
steps = [0, 1, 20]
digits = 18
"""
FLOW = "[[flow]]\nshape = 'cat'\nstep_size = 0.1\nsteps = [1]\n"
FIVE_DEGREES = """
system = "fput"
schemes = ["lie2"]
[parameters]
n = 5
alpha = 1
beta = 0
[grid]
steps = 5
step_sizes = [0.1]
initial_values = [{ q = [1, 0, 0, 0, 0], p = [0, 0, 0, 0, 0] }]
"""


def short(text: str) -> str:
    """With a list of one number where q is of two."""
    return text.replace("[0.3, -0.1]", "[0.3]")


# name -> (content, what the message must hold)
BAD: dict[str, tuple[str | bytes, str]] = {
    "unknown-key": (HEAD + "speed = 3\n", "speed=3: unknown key"),
    "unknown-key-in-grid": (HEAD + GRID + "fast = true\n", "grid.fast=True: unknown key"),
    "unknown-key-in-series": (HEAD + SERIES + "x = 1\n", "series.0.x=1: unknown key"),
    "unknown-key-in-start": (HEAD + GRID.replace("p = 0", "p = 0, r = 1"), "r=1: unknown key"),
    "unknown-table": (GOOD + "[gird]\n", "gird={}: unknown key"),
    "q-nan": (HEAD + GRID.replace("1.5", "nan"), "initial_values.0.q: number=nan"),
    "q-inf": (HEAD + GRID.replace("1.5", "-inf"), "initial_values.0.q: number=-inf"),
    "q-true": (HEAD + GRID.replace("1.5", "true"), "number=True"),
    "q-date": (HEAD + GRID.replace("1.5", "1979-05-27"), "datetime.date(1979, 5, 27)"),
    "p-missing": (HEAD + GRID.replace(", p = 0", ""), "initial_values.0.p"),
    "h-zero": (HEAD + GRID.replace("0.1", "0"), "step_size=0: must be greater than 0"),
    "h-negative": (HEAD + GRID.replace("0.1", "-0.1"), "step_size=-0.1: must be greater"),
    "h-inf": (HEAD + GRID.replace("0.1", "inf"), "step_size=inf"),
    "h-exponent": (HEAD + GRID.replace("0.1", "1e-99999"), "step_size=1e-99999: exponent"),
    "h-not-a-list": (HEAD + GRID.replace("[0.1]", "0.1"), "grid.step_sizes=0.1"),
    "h-none": (HEAD + GRID.replace("[0.1]", "[]"), "grid.step_sizes=[]"),
    "h-beyond-time": (HEAD + GRID.replace("0.1", "1.5"), "step_size=1.5: makes 0 steps"),
    "h-too-small": (HEAD + GRID.replace("0.1", "1e-13"), "step_size=0.0000000000001: makes"),
    "h-4301-digits": (HEAD + GRID.replace("0.1", "1" * 4301), "is not TOML"),
    "h-huge-hex": (HEAD + GRID.replace("0.1", "0x" + "f" * 9000), "step_size"),
    "q-huge-hex": (HEAD + GRID.replace("1.5", "0x" + "f" * 9000), "number"),
    "time-negative": (HEAD + GRID.replace("time = 1", "time = -1"), "grid.time"),
    "time-zero": (HEAD + GRID.replace("time = 1", "time = 0"), "grid.time"),
    "time-and-steps": (HEAD + GRID.replace("time", "steps = 5\ntime"), "give one of the two"),
    "neither-time-nor-steps": (HEAD + GRID.replace("time = 1\n", ""), "give one of the two"),
    "n-zero": (HEAD + GRID.replace("time = 1", "steps = 0"), "grid.steps=0"),
    "n-negative": (HEAD + GRID.replace("time = 1", "steps = -5"), "grid.steps=-5"),
    "n-fraction": (HEAD + GRID.replace("time = 1", "steps = 2.5"), "grid.steps=2.5"),
    "n-true": (HEAD + GRID.replace("time = 1", "steps = true"), "grid.steps=True"),
    "n-huge": (HEAD + GRID.replace("time = 1", f"steps = {MAX_STEPS + 1}"), "grid.steps"),
    "series-h-zero": (HEAD + SERIES.replace("0.1", "0"), "series.0.step_size"),
    "series-n-zero": (HEAD + SERIES.replace("time = 1", "steps = 0"), "series.0.steps"),
    "series-h-beyond-time": (HEAD + SERIES.replace("0.1", "1.5"), "step_size=1.5"),
    "series-too-many-steps": (HEAD + SERIES.replace("0.1", "1e-300"), "steps"),
    "series-one-point": (HEAD + SERIES + "points = 1\n", "series.0.points=1"),
    "series-a-table": (HEAD + SERIES.replace("[[series]]", "[series]"), "series="),
    "unknown-scheme": (HEAD.replace("lie2", "rk5"), "scheme=rk5: unknown; is rk4 meant"),
    "scheme-lie0": (HEAD.replace("lie2", "lie0"), "scheme=lie0: η must be 1 … 100"),
    "scheme-not-a-list": (HEAD.replace('["lie2"]', '"lie2"'), "schemes=lie2"),
    "no-scheme": (HEAD.replace('["lie2"]', "[]"), "schemes=[]"),
    "scheme-half-a-map": (HEAD.replace("lie2", "p_next = p"), "scheme=p_next = p"),
    "scheme-of-unknown-names": (HEAD.replace("lie2", "p_next = x; q_next = q"), "name 'x'"),
    "scheme-not-separable": (
        'hamiltonian = "p*q**2"\nschemes = ["symplectic-euler"]', "hamiltonian=p*q**2"),
    "unknown-system": ('system = "lorenz"\nschemes = ["lie2"]', "system=lorenz: unknown; allowed"),
    "unknown-observable": (HEAD + GRID + 'observables = ["energy"]', "observable=energy: unknown"),
    "unknown-arithmetic": (HEAD + GRID + 'arithmetic = "float16"', "arithmetic=float16: unknown"),
    "digits-zero": (HEAD + GRID + "digits = 0", "grid.digits=0"),
    "criterion-5": (HEAD + "criteria = [5]\n", "criteria.0=5"),
    "criterion-true": (HEAD + "criteria = [true]\n", "criteria.0=True"),
    "system-and-hamiltonian": (HEAD + 'system = "duffing"\n', "give one of the two"),
    "neither-system-nor-hamiltonian": ('schemes = ["lie2"]', "give one of the two"),
    "parameter-nan": (DUFFING + "parameters = { delta = nan }", "delta"),
    "parameter-unknown": (DUFFING + "parameters = { eps = 1 }", "parameter=eps"),
    "symbol-with-a-grid": (DUFFING + GRID, "parameter=delta"),
    "symbol-with-a-series": (DUFFING + SERIES, "parameter=delta"),
    "formula-code": (HEAD.replace(H, "__import__('os').getcwd()"), "hamiltonian="),
    "formula-not-smooth": (HEAD.replace(H, "abs(q)"), "abs is not smooth"),
    "formula-nested": (HEAD.replace(H, "(" * 3000 + "q" + ")" * 900), "hamiltonian="),
    "name-a-number": ("name = 3\n" + HEAD, "name=3"),
    "not-utf8": (b"\xff\xfe" + HEAD.encode(), "is not UTF-8"),
    "not-toml": ("hamiltonian = \n", "is not TOML"),
    "key-twice": (HEAD + HEAD, "is not TOML"),
    "nested-lists": ("a = " + "[" * 20000, "is not TOML"),
    "nested-tables": ("a = " + "{a=" * 20000, "is not TOML"),
    "dotted-deeply": (".".join("a" * 3000) + " = 1", "mine.toml"),
    "empty": ("", "schemes"),
    "q-too-short": (TWO_DEGREES + short(GRID_OF_LISTS),
        "q=0.3: has 1 of 2 numbers; H is of q1, q2"),
    "q-no-list": (TWO_DEGREES + GRID_OF_LISTS.replace("[0.3, -0.1]", "0.3"),
        "grid.initial_values.0.p: number="),
    "no-lists": (TWO_DEGREES + GRID, "has 1 of 2 numbers"),
    "q2-a-letter": (TWO_DEGREES + GRID_OF_LISTS.replace("-0.1", '"x"'),
        "grid.initial_values.0.q.1: number=x"),
    "separation-too-short": (TWO_DEGREES + short(SEPARATED), "q=0.3: has 1 of 2 numbers"),
    "reference-too-short": (TWO_DEGREES + short(REFERENCE), "of 2 numbers"),
    "growth-in-degrees": (TWO_DEGREES + GRID_OF_LISTS + "growth = true\n",
        "grid.growth takes p and q"),
    "observable-of-the-plane": (TWO_DEGREES + GRID_OF_LISTS + 'observables = ["lambda_plain"]\n',
        "observable=lambda_plain"),
    "criterion-in-degrees": (TWO_DEGREES + "criteria = [1]\n", "criteria takes p and q"),
    "flow-no-lists": (TWO_DEGREES + FLOW + "centre = { q = 1, p = 0 }\nscale = 1\n",
        "p=0: has 1 of 2 numbers; H is of p1, p2"),
    "flow-plane-3": (TWO_DEGREES + FLOW + "plane = 3\n", "plane=3: must be 1 … 2"),
    "flow-plane-3-of-a-point": (
        TWO_DEGREES + FLOW + "plane = 3\ncentre = { q = [1, 0], p = [0, 0] }\n",
        "plane=3: must be 1 … 2"),
    "lists-in-the-plane": (HEAD + GRID_OF_LISTS, "is a list; H is of p and q"),
    "observable-of-degrees": (HEAD + GRID + 'observables = ["symplectic_defect"]',
        "is |lambda| in one degree of freedom"),
    "separate-in-five-degrees": (FIVE_DEGREES + "separate = true\n",
        "is for up to 4 degrees of freedom; H has 5"),
}  # fmt: skip


@pytest.mark.parametrize(("content", "named"), BAD.values(), ids=BAD)
def test_a_bad_scene_is_an_input_error_that_names_it_in_one_line(
    tmp_path: Path, content: str | bytes, named: str
) -> None:
    with pytest.raises(InputError) as caught:
        load(tmp_path, content)
    message = str(caught.value)
    assert named in message
    assert "mine.toml" in message
    assert "\n" not in message
    assert "«" not in message
    assert len(message) < 500


def test_the_scene_that_the_bad_ones_are_made_of_is_good(tmp_path: Path) -> None:
    scene = load(tmp_path, GOOD)
    assert (scene.name, len(scene.series)) == ("mine", 1)
    for section in (GRID_OF_LISTS, SEPARATED, REFERENCE, FLOW):
        assert load(tmp_path, TWO_DEGREES + section).exact_hamiltonian().degrees == 2
    assert load(tmp_path, FIVE_DEGREES).grid


@pytest.mark.parametrize("path", ["missing.toml", ".", "/dev/null/x"])
def test_a_file_that_cannot_be_read_is_named(tmp_path: Path, path: str) -> None:
    with pytest.raises(InputError, match=r"^file="):
        load_scene(tmp_path / path)
