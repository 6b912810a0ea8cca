"""A program's answers are its step; what it does instead of answering is said, soon."""

import shlex
import sys
import time
from pathlib import Path

import pytest

from tests.helpers.programs.compilers import executable
from tests.helpers.programs.judged import judged
from tests.paths import ROOT
from tests.unit.integrators.foreign.programs import HERE, IN_STEP, THERE, command, program, said
from verify.errors import InputError
from verify.integrators.foreign import process
from verify.integrators.foreign.foreign_function import step_of_command
from verify.integrators.results import Claims, Finding
from verify.integrators.user_code.user_map import DOUBLE
from verify.verdict import Verdict

UNFLUSHED = {
    "python": IN_STEP.replace(", flush=True", ""),
    "c": r"""
#include <stdio.h>
int main(void)
{ double t, h, p, q;
  while (scanf("%lf %lf %lf %lf", &t, &h, &p, &q) == 4)
    printf("%.17g %.17g\n", p - h * q, q + h * p);
  return 0; }
""",
    "cpp": r"""
#include <iostream>
int main()
{ std::ios::sync_with_stdio(false); std::cin.tie(nullptr); double t, h, p, q;
  while (std::cin >> t >> h >> p >> q) std::cout << p - h * q << " " << q + h * p << "\n"; }
""",
}


@pytest.fixture
def impatient(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(process, "CALL_SECONDS", 1.0)
    monkeypatch.setattr(process, "FIRST_SECONDS", 3.0)


@pytest.fixture(autouse=True)
def buffered(monkeypatch: pytest.MonkeyPatch) -> None:
    """Programs in Python, whatever is usual where the tests run."""
    monkeypatch.delenv("PYTHONUNBUFFERED", raising=False)


@pytest.mark.left_to_ci
@pytest.mark.parametrize("language", UNFLUSHED)
@pytest.mark.usefixtures("impatient")
def test_a_program_that_does_not_flush_is_told_to(language: str, tmp_path: Path) -> None:
    source = UNFLUSHED[language]
    if language == "python":
        running = program(source)
    else:
        running = command(executable(tmp_path, f"unflushed.{language}", source))
    with running as function:
        begun = time.monotonic()
        results = function.several([HERE] * 30)
        assert time.monotonic() - begun < 10, "2 s are meant"
        for result in results:
            assert "no answer to its first line, “0 0.125 0.5 0.25”, within 1 s" in said(result)
            assert "when its input ends: it does not flush; write fflush(stdout)" in said(result)
            assert "0.31" in said(result), "its answer is shown"


@pytest.mark.left_to_ci
def test_the_first_answer_is_waited_for_5_seconds_where_nothing_computes() -> None:
    with program(UNFLUSHED["python"]) as function:
        begun = time.monotonic()
        assert "within 5 s" in said(function.several([HERE])[0])
        assert 4.9 < time.monotonic() - begun < 9, "5 s are meant"


def test_a_program_that_computes_before_its_first_answer_is_waited_for(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """As one that compiles itself: it takes longer than one that sleeps may."""
    monkeypatch.setattr(process, "CALL_SECONDS", 1.0)
    begins = "import time\nend = time.process_time() + 1.5\nwhile time.process_time() < end: pass\n"
    with program(begins + IN_STEP) as function:
        assert function(*HERE) == THERE


READS = "import sys, os, time, signal\nline = sys.stdin.readline()\n"


@pytest.mark.left_to_ci
@pytest.mark.parametrize(
    ("source", "words"),
    [
        ("pass", "ends with status 0 in place of an answer to “0 0.125 0.5 0.25”; it is to read"),
        ("raise SystemExit(3)", "ends with status 3"),
        ("raise KeyError(7)", "status 1 in place of an answer to “0 0.125 0.5 0.25”: KeyError: 7"),
        (READS + "os.kill(os.getpid(), signal.SIGFPE)", "crashes with SIGFPE, asked “0 0.125 0.5"),
        (READS + "os.abort()", "crashes with SIGABRT"),
        ("import time\ntime.sleep(99)", "within 1 s: it does not read it"),
        (READS + "time.sleep(99)", "an answer is one line of numbers, and nothing else is printed"),
        (READS + "while True: pass", "no answer to its first line, “0 0.125 0.5 0.25”, within 3 s"),
        (READS + "print('0.5 0.25', end='', flush=True)\ntime.sleep(99)",
         "it prints “0.5 0.25” without an end of line"),
        (IN_STEP.replace("print(", "print('>', "), "answers “> 0.46875 0.3125”; wanted: 2 numbers"),
        (IN_STEP.replace("print(", "print(t, "), "answers “0.0 0.46875 0.3125”; wanted: 2 numbers"),
        (IN_STEP.replace("print(p - h * q, q + h * p", "print(p"), "“0.5”; wanted: 2 numbers"),
        (IN_STEP.replace("p - h * q", "'none'"), "“none”, which is no number"),
        (IN_STEP.replace("p - h * q", "'1e999'"), "“1e999”, which is no number of its type"),
        (IN_STEP.replace("p - h * q", "'1D999'"), "“1D999”, which is no number of its type"),
        (IN_STEP.replace("p - h * q", "'1_0'"), "“1_0”, which is no number"),
        (IN_STEP.replace("p - h * q", "'-nan(0x7)'"), "“-nan(0x7)”, which is not finite"),
        (IN_STEP + "    print('done', flush=True)", "prints “done”, which it was not asked for"),
        ("print('v1.0', flush=True)\n" + IN_STEP, "which it was not asked for"),
    ],
)  # fmt: skip
@pytest.mark.usefixtures("impatient")
def test_what_a_program_does_instead_is_said(source: str, words: str) -> None:
    with program(source) as function:
        first, *others = map(said, function.several([HERE] * 4))
        assert words in first
        for text in others:
            assert words in text or "which it was not asked for" in text


def test_a_number_that_is_none_at_one_point_is_of_that_point_alone() -> None:
    source = IN_STEP.replace("p - h * q", "float('nan') if q == 3 else p - h * q")
    points = [(0.5, float(q), 0.0, 0.125) for q in range(8)]
    with program(source) as function:
        results = function.several(points)
        assert "“nan”, which is not finite" in said(results.pop(3))
        assert results == [(0.5 - q / 8, q + 1 / 16) for q in (0, 1, 2, 4, 5, 6, 7)]


def test_a_crash_at_one_point_is_of_that_point_alone() -> None:
    source = "import os\n" + IN_STEP.replace("    print", "    q == 3 and os.abort()\n    print")
    points = [(0.5, float(q), 0.0, 0.125) for q in range(300)] * 2
    with program(source) as function:
        results = function.several(points)
        for place in (303, 3):
            assert "SIGABRT, asked “0 0.125 0.5 3”" in said(results.pop(place))
        assert len([x for x in results if isinstance(x, tuple)]) == 598


def test_a_program_that_always_fails_is_not_started_for_ever() -> None:
    with program(READS + "os.abort()") as function:
        results = [said(x) for x in function.several([HERE] * 1000)]
    assert all("SIGABRT" in text for text in results)
    assert "it has failed 6 times, and is not started again" in results[-1]


def test_an_alarm_amid_a_call_does_not_shift_the_answers() -> None:
    """The answer that comes too late is not that to the next line."""
    from verify.integrators.user_code.step import StepError, limit_time

    slow = IN_STEP.replace("    print", "    time.sleep(q if q > 1 else 0)\n    print")
    with program("import time\n" + slow) as function:
        assert function(*HERE) == THERE
        with pytest.raises(StepError, match="too slow"), limit_time(0.3, "too slow"):
            function(0.5, 1.5, 0.0, 0.125)
        assert function(*HERE) == THERE


# -- to a verdict ------------------------------------------------------------------------------

BAD = str(ROOT / "tests" / "helpers" / "programs" / "bad_program.py")


def finding_of(mode: str, claims: Claims = Claims(order=2)) -> Finding:  # noqa: B008 - it is frozen
    command = shlex.join([sys.executable, BAD, mode])
    return judged(step_of_command(command, DOUBLE, 60), claims)


@pytest.mark.left_to_ci
@pytest.mark.parametrize("mode", ["right", "hexadecimal"])
def test_a_program_that_answers_lines_is_measured(mode: str) -> None:
    found = finding_of(mode)
    assert (found.verdict, found.convergence_order) == (Verdict.MEASURED, 2), found.reason


@pytest.mark.left_to_ci
def test_a_program_of_order_1_is_refuted_with_a_counterexample() -> None:
    found = finding_of("order-1")
    assert found.verdict is Verdict.REFUTED
    assert found.counterexample is not None


@pytest.mark.left_to_ci
@pytest.mark.sample(3)
@pytest.mark.parametrize(
    ("mode", "said"),
    [
        ("crash", "SIGSEGV"),
        ("exit", "no step today"),
        ("hang", "no answer to its first line"),
        ("spin", "no answer to its first line"),
        ("nonsense", "segmentation fault (not really)"),
        ("too-few", "wanted: 2"),
        ("nan", "not finite"),
        ("allocate", "memory"),
        ("flood", "bytes for a line"),
        ("closed", "closes its output"),
        ("chatter", "not asked for"),
    ],
)
def test_a_program_that_misbehaves_is_named_and_ends_nothing(
    mode: str, said: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(process, "CALL_SECONDS", 1.0)
    monkeypatch.setattr(process, "FIRST_SECONDS", 3.0)
    monkeypatch.setattr(process, "MOST_MEMORY", 2**28)
    begun = time.perf_counter()
    with pytest.raises(InputError) as error:
        finding_of(mode)
    assert said in str(error.value)
    assert time.perf_counter() - begun < 60


@pytest.mark.left_to_ci
@pytest.mark.sample(2)
@pytest.mark.parametrize(
    ("mode", "said"),
    [
        ("crash-late", "SIGSEGV"),
        ("single", "coarse"),
        ("state", "not deterministic"),
    ],
)
def test_a_program_that_misbehaves_at_times_is_undecided(mode: str, said: str) -> None:
    found = finding_of(mode)
    assert found.verdict is Verdict.UNDECIDED
    assert any(said in text for text in (found.reason, *found.notes)), found.notes


def test_no_process_is_left_behind() -> None:
    step = step_of_command(shlex.join([sys.executable, BAD, "right"]), DOUBLE, 60)
    assert judged(step, Claims(order=2)).verdict is Verdict.MEASURED
    own = step.function.program  # type: ignore[attr-defined]
    pid = own._process.pid
    assert Path(f"/proc/{pid}").exists()
    own.close()
    assert not Path(f"/proc/{pid}").exists()


@pytest.mark.parametrize(
    ("command", "problem"),
    [("", "empty"), ("'", "no command"), ("./there-is-none", "no such program")],
)
def test_a_command_that_is_none_is_told(command: str, problem: str) -> None:
    with pytest.raises(InputError, match=problem):
        step_of_command(command, DOUBLE, 60)
