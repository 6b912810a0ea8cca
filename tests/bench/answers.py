"""The JSON of some sixty commands, over all subcommands: one state of the code against another.

python tests/bench/answers.py write DIR        # with the `verify` that stands beside this Python
python tests/bench/answers.py compare OLD NEW  # exit status 1 where they differ but for times

For a change that must change no verdict, no digit and no key: write once before it and once after.
What is measured (times, rates, paths) is masked; everything else must be equal, exit statuses too.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

SCENE = """\
title = "A quartic oscillator"
hamiltonian = "p**2/2 + a*q**4"
parameters = { a = "1/3" }
schemes = ["lie2", "lie4", "symplectic-euler"]
criteria = [1, 2, 3, 4]

[grid]
time = 10
step_sizes = [0.01, 0.02, 0.04]
initial_values = [{ q = 1, p = 0 }, { q = 0, p = 0.5 }]
separate = true
growth = true

[[separation]]
time = 5
step_sizes = [0.1, 0.01, 0.001]
initial_value = { q = 1, p = 0 }

[[series]]
step_size = 0.01
time = 10
initial_value = { q = 1, p = 0 }
"""
BENCH = """\
system = "pendulum"
schemes = ["lie2"]
[work_precision]
time = 10
step_sizes = [0.1, 0.05, 0.025]
initial_value = { q = 1, p = 0 }
schemes = ["lie2", "lie4", "stormer-verlet", "rk4"]
number_systems = ["float64", "fixed", "mpfr"]
digits = [33]
"""
CAT = """\
system = "pendulum"
schemes = ["lie2", "symplectic-euler"]
[[flow]]
shape = "cat"
centre = { q = 1, p = 0 }
scale = 0.5
step_size = 0.01
steps = [300, 1000]
"""
STABILITY = """\
hamiltonian = "p**2/2 + a*q**4"
parameters = { a = 1 }
schemes = ["lie2", "stormer-verlet"]
[[stability]]
time = 100
step_sizes = [0.01, 0.5, 2]
initial_values = [{ q = 1, p = 0 }]
[[largest_step]]
time = 100
initial_value = { q = 1, p = 0 }
[[stability_map]]
parameter = "a"
values = { from = 0.01, to = 1e4, count = 5 }
step_sizes = { from = 1e-3, to = 10, count = 7 }
steps = 500
initial_value = { q = 1, p = 0 }
"""
CLAIMS = """\
[defaults]
scheme = "lie2"
hamiltonian = "p**2/2 + q**2/2 + delta*q**4/4"
[[claim]]
id = "eq-21"
kind = "delta_j"
formula = "3*h**3*delta*p*q"
up_to = 4
[[claim]]
id = "order"
kind = "defect_order"
defect_order = 3
[[claim]]
id = "preserves-area"
kind = "area_preserving"
area_preserving = true
[[claim]]
id = "area-error"
kind = "lambda"
parameters = { delta = 1 }
step_size = 0.01
steps = 2000
q = 1.5
p = 0
printed = "-2.666e-06"
"""
FOURTH = """\
[[claim]]
id = "fourth-order"
kind = "order"
scheme = "lie2"
hamiltonian = "p**2/2 + q**2/2"
order = 4
at_least = true
"""
REFERENCE = """\
system = "morse"
parameters = { D = 1, a = 1 }
schemes = ["lie2", "stormer-verlet"]
[[reference]]
step_sizes = [0.01]
initial_values = [{ q = 0.3, p = 0 }]
steps = [0, 1, 10, 100]
"""
MINE = """\
import math


def step(p, q, h):
    p = p - h / 2 * math.sin(q)
    q = q + h * p
    return p - h / 2 * math.sin(q), q


def newton(p, q, h):
    x = p
    for _ in range(9):
        x = x - (x - p + h * math.sin(q + h * x / 2))
        if abs(x) > 100:
            break
    return x, q + h * (x + p) / 2
"""
TABLE = """\
step,p,q
0,0,1.5
10,-0.0487,1.4997
100,-0.4811,1.4757
"""
FILES = {"mine.toml": SCENE, "bench.toml": BENCH, "cat.toml": CAT, "stability.toml": STABILITY,
         "claims.toml": CLAIMS, "fourth.toml": FOURTH, "morse.toml": REFERENCE, "mine.py": MINE,
         "mine.csv": TABLE}  # fmt: skip
RUN = "--system duffing --param delta=1 --scheme lie2 --step-size 0.01 --q 1.5 --p 0"
PENDULUM = "--system pendulum --scheme stormer-verlet --step-size 1/50 --q 1.5 --p 0"
HARMONIC = "--system harmonic --param omega=1 --q 1 --p 0"
SPLIT = "'kick 1/6; drift 1/2; kick 2/3; drift 1/2; kick 1/6; order 3'"

COMMANDS = f"""\
prove --system duffing --scheme lie2
prove --system pendulum --scheme symplectic-euler
prove --hamiltonian 'p**2/2 + q**2/2 + delta*q**4/4' --scheme lie3
prove --hamiltonian 'p**2/2 - cos(q)' --scheme 'p_next = p - h*sin(q); q_next = q + h*p_next'
prove --hamiltonian 'p**2/2 - cos(q)' --scheme 'p_next = p; q_next = q'
prove --hamiltonian 'exp(p)*log(q) + sqrt(q)' --scheme lie2
prove --hamiltonian 'p**4/4 + q**2*p' --scheme implicit-midpoint
prove --system morse --scheme rk4 --param a=3
prove --system toda --scheme gauss4
prove --every-hamiltonian --scheme lie6
prove --every-hamiltonian --scheme blanes-moan4
prove --every-hamiltonian --scheme gauss6
prove --every-hamiltonian --scheme {SPLIT}
prove --every-hamiltonian --separable --scheme yoshida4
prove --every-hamiltonian --scheme lie2 --certificate every.json
certificate check every.json
prove --system pendulum --scheme lie3 --certificate one.json
certificate check one.json
run {RUN} --steps 20000
run {RUN} --steps 20000 --digits 50
run {RUN} --steps 2000 --digits 30 --arithmetic fixed
run {RUN} --steps 2000 --digits 30 --arithmetic mpfr
run {RUN} --steps 500 --digits 30 --arithmetic mpmath
run {RUN} --steps 200 --digits 30 --arithmetic ball
run {PENDULUM} --steps 1000 --digits 40
run {PENDULUM} --steps 300000
run {HARMONIC} --scheme gauss4 --step-size 0.1 --steps 50 --digits 30
run --system pendulum --scheme implicit-midpoint --step-size 0.1 --steps 50 --q 1 --p 0 --digits 30
run --system cubic --scheme lie2 --step-size 0.1 --steps 5000 --q 9 --p 9
separate {RUN} --steps 2000
separate {RUN} --step-size 0.001 --step-size 0.1 --time 20
separate {PENDULUM} --steps 2000
check paper --only 'eq-*'
check paper --only 'criter*'
check claims.toml
stability stability.toml
stability --linear --scheme lie4
stability --linear --scheme stormer-verlet
bench bench.toml
flow cat.toml
explore --examples 60 --seed 7
explore --examples 40 --seed 3 --property order-by-jets --scheme lie2 --kind polynomial
explore fourth.toml --examples 50 --seed 1
explore --maximise rounding-share --examples 20 --seed 7 -o worst
plan paper
plan stiff
plan mine.toml
reference make morse.toml -o made
reference check made --seed 1
reference check --seed 1 --share 0.01
reference compare mine.csv --scene duffing --scheme lie2 --step-size 0.01 --q 1.5 --p 0
reference compare mine.csv --scene duffing --scheme lie1 --step-size 0.01 --q 1.5 --p 0
check-integrator mine:step --system pendulum
check-integrator mine:step --system pendulum --order 3 --area-preserving
check-integrator mine:newton --system pendulum
report integrators -o integrators
report mine.toml -o report --format html --format md
report cat.toml -o cat
prove --system dufing --scheme lie2
run {RUN} --steps 0
plan nowhere.toml
""".splitlines()
MEASURED = ("seconds", "time", "ratio", "per_step", "speed", "kept", "machine", "versions", "rate",
            "ns", "path", "place", "peak", "command", "median", "minimum", "output",
            "python", "wall", "sha256", "areaproof", "overhead", "comparisons")  # fmt: skip
FOLDERS = ("report", "cat", "made", "worst", "integrators")


def _masked(value: Any, key: str = "") -> Any:
    """The value without what is measured; a key's words tell."""
    if set(key.lower().replace("-", "_").split("_")) & set(MEASURED) and not isinstance(
        value, dict
    ):
        return "measured"
    if isinstance(value, dict):
        return {name: _masked(inner, name) for name, inner in value.items()}
    if isinstance(value, list):
        return [_masked(inner, key) for inner in value]
    return value


def _answer(command: str, folder: Path) -> dict[str, Any]:
    verify = Path(sys.executable).parent / "verify"
    line = f"{verify} {command} --json"
    done = subprocess.run(
        ["bash", "-c", line], cwd=folder, capture_output=True, text=True, check=False
    )
    try:
        printed = _masked(json.loads(done.stdout))
    except ValueError:
        printed = done.stdout
    return {"command": command, "status": done.returncode, "printed": printed, "error": done.stderr}


def _files(folder: Path) -> dict[str, Any]:
    """What the commands wrote: each name, and of JSON and CSV the content without times."""
    written: dict[str, Any] = {}
    for path in sorted(p for name in FOLDERS for p in (folder / name).rglob("*") if p.is_file()):
        if "kept" in path.parts:
            continue
        name = str(path.relative_to(folder))
        if path.suffix == ".json":
            written[name] = _masked(json.loads(path.read_text()))
        else:
            written[name] = path.read_text() if path.suffix in (".csv", ".toml") else "there"
    return written


def write(target: Path) -> None:
    target.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for file, content in FILES.items():
            (folder / file).write_text(content)
        for index, command in enumerate(COMMANDS):
            answer = json.dumps(_answer(command, folder), indent=1, ensure_ascii=False)
            (target / f"{index:02}.json").write_text(answer.replace(name, "FOLDER"))
            print(f"{index + 1}/{len(COMMANDS)}  {command}", flush=True)
        written = json.dumps(_files(folder), indent=1, ensure_ascii=False)
        (target / "files.json").write_text(written.replace(name, "FOLDER"))


def compare(old: Path, new: Path) -> int:
    names = sorted({path.name for folder in (old, new) for path in folder.glob("*.json")})
    if not names:
        sys.exit(f"{old}, {new}: no answers there")
    differ = []
    for name in names:
        answers = [
            json.loads((folder / name).read_text()) if (folder / name).exists() else {}
            for folder in (old, new)
        ]
        if answers[0] != answers[1]:
            differ.append(name)
            print(f"{name}  {answers[0].get('command', 'the files written')}: differs")
    print(f"{len(names)} answers, {len(differ)} differ")
    return 1 if differ else 0


def main() -> None:
    match sys.argv[1:]:
        case ["write", target]:
            write(Path(target))
        case ["compare", old, new]:
            sys.exit(compare(Path(old), Path(new)))
        case _:
            sys.exit(__doc__)


if __name__ == "__main__":
    main()
