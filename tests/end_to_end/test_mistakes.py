"""Natural mistakes of somebody who has not read the code: each is told what to do, in one line.

A row is what was typed, and the words that the line must hold: what was given, and what to write.
What is nearly so and right stands at the end, and is taken.
"""

import shlex
from pathlib import Path

import pytest

from tests.end_to_end.test_command_line import here

FILES = {
    "ok.toml": 'system = "pendulum"\nschemes = ["lie2"]\n',
    "mine.py": "def step(p, q, h):\n    return p - h*q, q + h*p\n"
    "def two(p, q):\n    return p, q\nvalue = 3\n",
    "broken.py": "def step(p, q, h) return p\n",
    "notes.txt": "hello\n",
    "mine.csv": "t,x,v\n0,1,0\n",
    "data.json": '{"a": 1}\n',
    "bom.toml": '\ufeffsystem = "pendulum"\nschemes = ["lie2"]\n',
    "crlf.toml": 'system = "pendulum"\r\nschemes = ["lie2"]\r\n',
}
PENDULUM = "--system pendulum --scheme lie2"
RUN = f"run {PENDULUM} --q 1 --p 0"


@pytest.fixture(autouse=True)
def _folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "folder").mkdir()
    for name, content in FILES.items():
        (tmp_path / name).write_text(content, encoding="utf-8", newline="")


def told(capsys: pytest.CaptureFixture[str], typed: list[str], words: tuple[str, ...]) -> None:
    """Holds the answer to its contract: status 2, one line, with these words."""
    status, out, err = here(capsys, *typed)
    assert (status, out) == (2, "")
    assert err.startswith("verify: ")
    assert err.count("\n") == 1
    assert err.rstrip().isprintable()
    assert "Traceback" not in err
    missing = [word for word in words if word not in err]
    assert not missing, err


# -- formulas: more of them, with their messages, in tests/unit/algebra/test_formula_mistakes.py ---

FORMULAS = {
    "p**2/2 + 2q**2": "column 10: write 2*q for 2q",
    "(p**2/2 + q**2/2": "column 1: this ( is not closed; write )",
    "p**2/2 + lambda*q": "column 10: lambda is a reserved word of Python; write another name",
    "p²/2": "column 2: ² (superscript two) is outside ASCII; write **2",
    "p**2/2 − cos(q)": "column 8: − (minus sign) is outside ASCII; write -",
    "“p**2/2 + q”": "column 1: “ (left double quotation mark) is outside ASCII; leave it out",
    "'p**2/2 + q'": "leave out the quotation marks",
    "p**2/2 - np.cos(q)": "unknown function 'np.cos'; write cos(q)",
    "p**2/2 + tah(q)": "unknown function 'tah'; is tanh meant?",
    "p**2/2 + 0,5*q": "column 11: 'p**2/2 + 0,5*q' is not allowed; write a decimal with a point",
    "H = p**2/2 + q": "column 3: a formula has no =; write its right side alone",
    "p**2/2 + \\omega*q": "this is LaTeX; write omega without the backslash",
    "p**2/2 + q!": "! is not allowed; write a factorial as the number",
    "p**2/2 + abs(q)": "abs is not smooth, and H must be; allowed: asinh, atan",
    "p**2/2 + Heaviside(q)": "a formula has no cases, since H must be smooth",
    "p**2/2 + e**q": "exponent q must be a rational number; write exp(q)",
    "p**2/2 + 1j*q": "'1j' is not a number; H is real",
    "p**2/2 + fabs(q)": "fabs is not smooth",
    "p**2/2 + pow(q,2)": "write (q**2)",
    "v**2/2 + x**2/2": "has no p and no q; are v, x meant? write p and q",
    "p1**2/2 + p3**2/2 + q1*q3": "has p1, p3, q1, q3, and neither p2 nor q2",
    "p**2/2 + q1*q": "has q1 beside p and q; allowed: p and q alone",
    "p1**2/2 + q65*q1": "has 65 degrees of freedom; allowed: up to 64",
    "p**2/2 + pq": "has no q, and pq would be a parameter; write p*q",
    "pendulum": "is no formula but a system; write",
}


@pytest.mark.parametrize(("formula", "words"), FORMULAS.items(), ids=map(ascii, FORMULAS))
def test_a_formula(formula: str, words: str, capsys: pytest.CaptureFixture[str]) -> None:
    typed = ["prove", "--scheme", "lie2", "--hamiltonian", formula]
    told(capsys, typed, (f"hamiltonian={formula}: ", words))


def test_an_h_in_time_is_not_for_every_one(capsys: pytest.CaptureFixture[str]) -> None:
    formula = "p**2/2 + q*t"
    lie2 = ["prove", "--scheme", "lie2"]
    told(capsys, [*lie2, "--time-dependent", "--hamiltonian", formula], ("--time-dependent",))


SCHEMES = {
    "RK45": "is rk4 meant?",
    "DOP853": "unknown; allowed: blanes-moan4",
    "backward_euler": "is euler meant?",
    "lie 2": "is lie2 meant?",
    "lie0": "must be 1 … 100",
    "lie2,rk4": "is lie2 meant?",
    "störmer-verlet": "is stormer-verlet meant?",
    "mine.py": "code of your own goes with verify check-integrator",
    "p_next = p - h*q": "write it as 'p_next = …; q_next = …'",
    "p' = p - h*q; q' = q": "write it as 'p_next = …; q_next = …'",
    "Kick 1/2; Drift 1": "write it in small letters",
    "kick 1/2, drift 1": "write it as 'kick 1/2; drift 1; kick 1/2; order 2'",
}


@pytest.mark.parametrize(("scheme", "words"), SCHEMES.items(), ids=map(ascii, SCHEMES))
def test_a_scheme(scheme: str, words: str, capsys: pytest.CaptureFixture[str]) -> None:
    typed = ["prove", "--system", "pendulum", "--scheme", scheme]
    told(capsys, typed, (f"scheme={scheme}: ", words))


NUMBERS = {
    "pi/2": "numbers are rational; write as many digits",
    "sqrt(2)": "numbers are rational",
    "0,5": "write 0.5",
    "1d-3": "write 1e-3",
    "−1.5": "write -1.5",
    "½": "write 1/2",
    "30°": "numbers have no unit",
    "inf": "every number is finite",
    "1+1": "nothing is calculated here; write the result",
    "1e2000": "exponent beyond ±1000",
}


@pytest.mark.parametrize(("number", "words"), NUMBERS.items(), ids=map(ascii, NUMBERS))
def test_a_number(number: str, words: str, capsys: pytest.CaptureFixture[str]) -> None:
    typed = ["run", *PENDULUM.split(), "--step-size", "0.1", "--steps", "10", "--p", "0"]
    told(capsys, [*typed, "--q", number], (f"q={number}: ", words))


# -- commands -------------------------------------------------------------------------------------

COMMANDS: dict[str, tuple[str, ...]] = {
    "prove": ("--scheme: is missing; write --scheme NAME",),
    "prove --scheme lie2": ("--system, --hamiltonian: give one of the two",),
    "prove --system --scheme lie2": ("--system=--scheme: has no value; write --system NAME",),
    "prove --system pendulum --scheme": ("--scheme: has no value; write --scheme VALUE",),
    "prove -system pendulum": ("-system: no such option; write --system",),
    f"prove {PENDULUM} --delta 1": ("--delta: no such option", "--param delta=VALUE"),
    "prove -H p**2/2 --scheme lie2": ("-H: no such option; write --hamiltonian",),
    "prove -Hp**2/2 --scheme lie2": ("-Hp**2/2: no such option; write --hamiltonian",),
    "prove --H p**2/2 --scheme lie2": ("--H: no such option; write --hamiltonian",),
    "prove pendulum lie2":
        ("pendulum lie2: not allowed here; write --system pendulum --scheme lie2",),
    "prove lie2 pendulum":
        ("lie2 pendulum: not allowed here; write --scheme lie2 --system pendulum",),
    "prove --system pendulum lie7": ("lie7: not allowed here; write --scheme lie7",),
    "prove pendulum 'kick 1; drift 1'": ("--system pendulum --scheme 'kick 1; drift 1'",),
    "prove 'p**2/2 + q**4' lie2":
        ("write --hamiltonian 'p**2/2 + q**4' --scheme lie2",),
    "prove 'p_next = p - h*q**3; q_next = q' pendulum":
        ("write --scheme 'p_next = p - h*q**3; q_next = q' --system pendulum",),
    "prove pendulum --scheme lie2": ("pendulum: not allowed here; write --system pendulum",),
    "prove pendulum nonsense": ("--scheme: is missing; write --scheme NAME",),
    f"prove {PENDULUM} duffing": ("duffing: not allowed here; write a value with spaces",),
    "bench --scheme lie2 --scheme lie1 pendulum duffing": ("write --system duffing",),
    f"prove {PENDULUM} --h 0.1": ("--h: no such option here; it is one of verify bench",),
    f"prove {PENDULUM} --param delta": ("--param=delta: has no value; write NAME=VALUE",),
    f"prove {PENDULUM} --param g=1,l=2": ("--param=g=1,l=2: ", "write --param g=1 --param l=2"),
    f"prove {PENDULUM} --param delta 1": ("1: not allowed here; write --param delta=1",),
    f"prove {PENDULUM} --param δ=1": ("parameter=δ: ", "write delta"),
    f"prove {PENDULUM} --param delta=1": ("parameter=delta: H has no such parameter; it has: ",),
    "prove --hamiltonian p**2 + q**2 --scheme lie2": ("+ q**2: not allowed here", "quotation"),
    "prove --system 'p**2 + q' --scheme lie2": ("system=p**2 + q: ", "goes with --hamiltonian"),
    "prove --system 'harmonic oscillator' --scheme lie2": ("is harmonic meant?",),
    f"prove {PENDULUM} --separable": ("--separable: goes with --every-hamiltonian",),
    f"prove {PENDULUM} --certificate folder": ("--certificate=folder: is a folder",),
    RUN: ("--step-size: is missing; write --step-size H",),
    f"{RUN} --dt 0.1 --steps 10": ("--dt: no such option; write --step-size",),
    f"{RUN} --step_size 0.1": ("--step_size: no such option; write --step-size",),
    f"{RUN} --x 1": ("--x: no such option; write --q",),
    f"{RUN} --method rk4": ("--method: no such option; write --scheme",),
    f"{RUN} --step-size 0 --steps 10": ("=0: must be greater than 0",),
    f"{RUN} --step-size -0.1 --steps 10": ("=-0.1: must be greater than 0",),
    f"{RUN} --step-size 0.1 --steps 1e6": ("--steps=1e6: ", "write 1000000"),
    f"{RUN} --step-size 0.1 --steps 1e3": ("--steps=1e3: must be a whole number; write 1000",),
    f"{RUN} --step-size 0.1 --steps 1e400": ("--steps=1e400: must be a whole number",),
    f"{RUN} -H 0.1": ("-H: no such option; write --hamiltonian",),
    f"{RUN} --scheme rk4":
        ("--scheme=lie2, rk4: verify run takes one; several go with verify bench, ",),
    f"{RUN} --scheme=rk4": ("--scheme=lie2, rk4: verify run takes one; ",),
    f"{RUN} --step-size 0.1 --steps 1,000": ("--steps=1,000: ", "write 1000"),
    f"{RUN} --step-size 0.1 --steps 0": ("steps=0: must be a whole number, 1 … ",),
    f"{RUN} --step-size 0.1 --steps 10 --digits 1e2": ("--digits=1e2: ", "write 100"),
    f"{RUN} --step-size 0.1 --steps 10 --arithmetic double": ("is float64 meant?",),
    f"{RUN} --step-size 0.1 --steps 10 --keep ok.toml": ("--keep=ok.toml: ", "give a folder"),
    f"{RUN} --step-size 0.3 --time 0.1": ("--time=0.1: makes 0 steps; allowed: 1 … ",),
    f"{RUN} --step-size 1 --steps 3 -o x.csv": ("-o: no such option; write --csv",),
    f"{RUN} --step-size 1 --steps 3 --csv folder": ("--csv=folder: is a folder",),
    f"{RUN} --q 2": ("--q=1, 2: verify run takes one; call it once for each",),
    f"{RUN} --json=yes": ("--json: takes no value; write --json",),
    "run --system duffing --scheme lie2 --step-size 1 --steps 1 --q 1 --p 0":
        ("parameter=delta: has no value; a run needs one, as delta=1",),
    f"separate {PENDULUM} --q 1 --p 0 --step-size 0.1": ("--steps, --time: give one of the two",),
    f"separate {PENDULUM} --q 1 --p 0 --step-size 0.3 --time 0.1":
        ("time=0.1: is shorter than the step size 0.3",),
    f"separate {PENDULUM} --q 1 --p 0 --time 1 --step-size 0.1 0.01":
        ("0.01: not allowed here", "--step-size again for another"),
    "check nope.toml": ("file=nope.toml: No such file", "give a file that is there"),
    "check folder": ("file=folder: Is a directory; give a file",),
    "check ok.toml": ("file=ok.toml: is a scene; verify report takes it",),
    "check-table ok.toml": ("file=ok.toml: is a scene; verify report takes it",),
    "init scenes": ("claims|scene|table=scenes: unknown; is scene meant?",),
    "init scene -o ok.toml": ("--output=ok.toml: is there already; give another with -o",),
    "check data.json": ("file=data.json: is not TOML", "this is JSON; write lines"),
    "check paper --only eq12": ("--only=eq12: no claim has this id; is eq-12 meant?",),
    "certificate": ("verify certificate: a command is missing; allowed: check",),
    "certificate check data.json": ("FILE=data.json: names no format; this version reads",),
    "certificate export nope.json": ("file=nope.json: No such file",),
    "certificate export nope.json --coq out.v": ("file=nope.json: No such file",),
    "certificate export data.json": ("--coq: is missing; write --coq OUT.v",),
    "certificate check notes.txt": ("FILE=notes.txt: is not JSON",),
    "check-integrator mine.py --system pendulum": ("integrator=mine.py: write it as MODULE:",),
    "check-integrator mine.py::step --system pendulum": ("write one : in it, as mine.py:step",),
    "check-integrator mine.py:stepp --system pendulum":
        ("has no stepp; is step meant? it has: step, two",),
    "check-integrator nope:step --system pendulum": ("nope:step: does not import",
        "write the path of its file"),
    "check-integrator notes.txt:step --system pendulum": ("notes.txt is no Python file",),
    "check-integrator broken.py:step --system pendulum": ("SyntaxError", "line 1"),
    "check-integrator mine.py:value --system pendulum": ("value is no function but int",),
    "check-integrator mine.py:two --system pendulum": ("two(p, q): wanted: step(p, q, h)",),
    "check-integrator mine.py:step --system pendulum --order two": ("--order=two: ", "1 … 12"),
    "check-integrator mine.py:step --system pendulum --arguments x,v,g":
        ("--arguments=x,v,g: is no order of p, q and h, such as q,p,h",),
    "report ok.tml -o out": ("file=ok.tml: No such file", "is ok.toml meant?"),
    "report papers -o out": ("SCENE=papers: unknown; is paper meant?",),
    "modified --system henon-heiles --scheme lie2": ("takes p and q, one degree of freedom",),
    "report nosuch -o out": ("SCENE=nosuch: unknown; allowed: paper, ", "integrators, or a TOML"),
    "report integrator -o out": ("SCENE=integrator: unknown; is integrators meant?",),
    "report ok.toml -o ok.toml": ("--output=ok.toml: ",),
    "report ok.toml --format pdf": ("--format=pdf: unknown; allowed: html, md",),
    "report ok.toml --workers 0": ("--workers=0: must be a whole number, 1 … 256",),
    "report ok.toml --cluster localhost": ("=localhost: ", "tcp://HOST:PORT"),
    "plan": ("SCENE: is missing; write verify plan SCENE",),
    "plan ''": ("SCENE='': is empty; give paper, a suite or a TOML file",),
    "plan ok": ("SCENE=ok: unknown; is ok.toml meant?",),
    "plan OK.toml": ("file=OK.toml: No such file", "is ok.toml meant?"),
    "plan mine.py": ("file=mine.py: is not TOML", "this is a program"),
    "plan mine.csv": ("file=mine.csv: is not TOML", "every line is a key with its value"),
    "plan bom.toml": ("file=bom.toml: is not TOML", "save it as UTF-8 without one"),
    "plan ok.toml ok.toml": ("ok.toml: not allowed here; write verify plan SCENE",),
    "plan 'C:\\\\scenes\\\\mine.toml'": ("No such file", "write / for \\ in a path"),
    "plan https://example.org/mine.toml": ("No such file", "an address is not fetched"),
    "explore --examples 0": ("examples=0: must be 1 … ",),
    "explore --maximize growth": ("--maximize: no such option; write --maximise",),
    "explore --property order-by-jet": ("is order-by-jets meant?",),
    "explore --kind Polynomial": ("=Polynomial: unknown; is polynomial meant?",),
    "explore nope.toml": ("CLAIMS=nope.toml: is no file; give a TOML file with [[claim]]",),
    "flow ok.toml": ("SCENE=ok.toml: asks for no [[flow]]; add one",),
    "flow --form cat": ("--form: no such option",),
    "flow --system pendulum --scheme lie2": ("--step-size: is missing",),
    "bench ok.toml --system pendulum": ("--system=pendulum: goes without SCENE",),
    "stability --system pendulum --scheme lie2 --step-size 1 --time 1 --q 1": ("--p: is missing",),
    "stability stif": ("SCENE=stif: unknown; is stiff meant?",),
    "stability --linear": ("--scheme: give one with --linear",),
    "stability ok.toml --linear --scheme lie2": ("does not go with --linear; leave it out",),
    "bench ok.toml": ("SCENE=ok.toml: has no [work_precision]; add one",),
    "bench ok.toml -o out.pdf": ("--output=out.pdf: must end in .",),
    "reference": ("verify reference: a command is missing; allowed: check, compare, make",),
    "reference make ok.toml": ("SCENE=ok.toml: asks for no [[reference]]",),
    "reference check nope": ("DIR=nope: is no folder",),
    "reference compare mien.csv": ("file=mien.csv: No such file", "is mine.csv meant?"),
    "reference compare notes.txt": ("line 1 names no column of p, q", "it has hello"),
    "schemes lie2 lie3": ("lie3: not allowed here; write verify schemes NAME [OPTIONS]",),
    "schemes gaus4": ("scheme=gaus4: unknown; is gauss4 meant?",),
    "systems dufing": ("system=dufing: unknown; is duffing meant?",),
    f"export {PENDULUM} --language c++": ("language=c++: unknown; is c meant? allowed: c, julia, ",
        'a C++ step that is extern "C"'),
    f"export {PENDULUM} --language rust":
        ("language=rust: unknown; allowed: c, julia, latex, python",),
    "systems --jsn": ("--jsn: no such option; is --json meant?",),
    "help": ("command=help: unknown; is --help meant?",),
    "simulate --system pendulum": ("command=simulate: unknown; is run meant?",),
    "Proove": ("command=Proove: unknown; is prove meant?",),
}  # fmt: skip


@pytest.mark.parametrize(("typed", "words"), COMMANDS.items(), ids=map(ascii, COMMANDS))
def test_a_command(typed: str, words: tuple[str, ...], capsys: pytest.CaptureFixture[str]) -> None:
    told(capsys, shlex.split(typed), words)


# -- scenes ---------------------------------------------------------------------------------------

GRID = "steps = 3\nstep_sizes = [0.1]\ninitial_values = [{ q = 1, p = 0 }]\n"
HEAD = FILES["ok.toml"]
RUNS = f"{HEAD}[grid]\n"
SCENES = {
    "system = pendulum": 'write a text in quotation marks: system = "pendulum"',
    "system = “pendulum”": 'write " for “ (left double quotation mark)',
    "system: pendulum": "write = for :",
    '{"system": "pendulum"}': "this is JSON; write lines such as",
    'system = "duffing"\nparameters = { delta = 0,5 }': "write a decimal with a point",
    'system = "pendulum"': "s.toml: schemes: is missing; write schemes = …",
    'schemes = ["lie2"]': "s.toml: system, hamiltonian: give one of the two",
    'system = "pendulum"\nscheme = "lie2"': "scheme=lie2: unknown key; is one of these meant",
    'system = "pendulum"\nschemes = "lie2"': '=lie2: must be a list; write schemes = ["lie2"]',
    'system = "pendulum"\nschemes = []': "schemes=[]: must be a list of 1 or more",
    HEAD + "params = { a = 1 }": "is parameters meant? allowed: name",
    HEAD + "every_hamiltonian = True": "write every_hamiltonian = true",
    HEAD + 'system = "duffing"': "the key stands twice; leave one out",
    HEAD + f"[grids]\n{GRID}": "unknown key; is grid meant?",
    HEAD + f"[[grid]]\n{GRID}": "must be one table; write [grid] for [[grid]]",
    HEAD + "[series]\nsteps = 3": "must be a list of tables; write [[series]] for [series]",
    f"{RUNS}{GRID.replace('[0.1]', '0.1')}": "step_sizes=0.1: must be a list; write step_sizes",
    f"{RUNS}{GRID.replace('[0.1]', '{ h = 0.1 }')}": "must be a list; write step_sizes = […]",
    f"{RUNS}{GRID.replace('[0.1]', '[-0.1]')}": "step_size=-0.1: must be greater than 0",
    f"{RUNS}{GRID.replace('= 3', '= 1e3')}": "grid.steps=1e3: must be a whole number; write steps",
    f"{RUNS}{GRID.replace('= 3', '= -3')}": "grid.steps=-3: must be 1 or more",
    f"{RUNS}{GRID.replace('q = 1', 'x = 1')}": "x=1: unknown key; is one of these meant: q",
    f"{RUNS}{GRID}time = 1": "time, steps: give one of the two",
    f"{RUNS}{GRID}arithmetic = 'quad'": "arithmetic=quad: unknown; is mpfr meant?",
    'hamiltonian = "p**2/2 + 2q"\nschemes = ["lie2"]': "column 10: write 2*q for 2q",
    'hamiltonian = "\\frac{p}{2}"\nschemes = ["lie2"]': "U+000C, a control character; write a text",
}  # fmt: skip


@pytest.mark.parametrize(("scene", "words"), SCENES.items(), ids=map(ascii, SCENES))
def test_a_scene(
    scene: str, words: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "s.toml").write_text(scene, encoding="utf-8")
    told(capsys, ["plan", "s.toml"], ("s.toml", words))


# -- what is right, beside them -------------------------------------------------------------------

RIGHT_FORMULAS = (
    "p^2/2 - q^2", "2*q + p", "p**2/2 + 1e-3*q", "(p**2 + q**2)/2", "p**2/2 + lambda_*q",
    "p**2/2 + omega**2*q**2/2", "p**2/2 + exp(-q)", "p**2/2 + E*q", "p**2/2 + i*q + q**2",
    "p**2/2 + q**0.5", "p**2/2 + q**2/2.", "p**2/2 ++ q", "p**2/(2*m)", "p*q + pq",
    "x*q + v*p", "p**2/2 + .5*q", " p**2/2\n+ q ", "p**2/2 + sqrt(1 + q**2)", "pendulum*p + q",
)  # fmt: skip
RIGHT = (
    "schemes leapfrog",
    "systems Kepler",
    "schemes 'p_half = p - h*q; q_next = q + h*p_half; p_next = p_half'",
    "prove --system Pendulum --scheme leapfrog",
    "prove --system 'double well' --scheme RK4",
    "prove --system duffing --scheme lie2 --param delta=7/3",
    "prove --system pendulum --scheme symplectic_euler",
    "prove --system pendulum --scheme 'p_next = p - h*sin(q); q_next = q + h*p_next'",
    "prove --system pendulum --scheme 'kick 1/2; drift 1; kick 1/2'",
    f"{RUN} --step-size 1e-1 --steps 3",
    f"run {PENDULUM} --q 1 --p -1 --step-size=1/10 --steps=3",
    f"run {PENDULUM} --q 1 --p +1. --step-size .5 --steps 3",
    "plan ./ok.toml",
    "plan crlf.toml",
    "check-integrator mine.py:step --hamiltonian p**2/2+q**2/2",
)  # fmt: skip


@pytest.mark.parametrize("typed", RIGHT)
def test_what_is_right_is_taken(typed: str, capsys: pytest.CaptureFixture[str]) -> None:
    status, out, err = here(capsys, *shlex.split(typed))
    assert (status, err) == (0, "")
    assert out


@pytest.mark.parametrize("formula", RIGHT_FORMULAS)
def test_a_right_formula_is_taken(formula: str, capsys: pytest.CaptureFixture[str]) -> None:
    status, _, err = here(capsys, "prove", "--scheme", "lie1", "--hamiltonian", formula)
    assert (status, err) == (0, "")


def test_they_are_as_many_as_is_claimed() -> None:
    assert len(FORMULAS) + len(SCHEMES) + len(NUMBERS) + len(COMMANDS) + len(SCENES) >= 168
    assert len(RIGHT) + len(RIGHT_FORMULAS) >= 30
