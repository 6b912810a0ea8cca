"""The section on the symplectic form: what stands in it, and where there is none."""

from fractions import Fraction
from pathlib import Path

from verify.pages.sections.scene.more_than_the_plane import SECTION, BeyondView
from verify.scenes.results.bounded_value import Value
from verify.scenes.results.proof_result import FormResult, ProofResult
from verify.scenes.results.report import SceneResult
from verify.scenes.results.work_precision import WorkLine, WorkPoint, WorkPrecisionResult
from verify.scenes.scene import load_scene
from verify.structures import SYMPLECTIC
from verify.studies.work_precision.work_lines import lambda_slope

PAPER = Path(__file__).parents[4] / "reports" / "paper"


def value(x: str) -> Value:
    return Value(value=x, bound="0")


def point(scheme: str, form: str, volume: str, error: str = "0.001") -> WorkPoint:
    return WorkPoint(
        scheme=scheme, step_size="0.1", steps=1000, error=value(error), energy=value("0.0001"),
        lam=value(volume), symplectic_defect=value(form), limited_by="truncation",
        lambda_limited_by="truncation", seconds_median=1e-5,
    )  # fmt: skip


def line(one: WorkPoint, *, kept: bool) -> WorkLine:
    slope = lambda_slope([one], kept, structure=SYMPLECTIC)
    return WorkLine(
        name=one.scheme, peer=False, order=2, area_preserving=kept, error_slope=slope,
        lambda_slope=slope, cost=None, compile_seconds=0.0, points=(one,),
    )  # fmt: skip


def scene(
    *lines: WorkLine, planar: bool = False, proofs: tuple[ProofResult, ...] = ()
) -> SceneResult:
    start = "1" if planar else ("1", "0")
    work = WorkPrecisionResult.model_construct(
        hamiltonian="", parameters={}, time="100", t0="0", q=start, p=start, scale="1",
        lines=lines,
    )  # fmt: skip
    return SceneResult.model_construct(name="x", work_precision=work, proofs=proofs)


def view(of: SceneResult) -> BeyondView:
    found = SECTION.view(of, "x")
    assert isinstance(found, BeyondView)
    return found


def test_it_says_by_how_much_det_j_alone_understates() -> None:
    lost = line(point("lie4", "39", "-0.00013"), kept=False)
    found = view(scene(lost, line(point("stormer-verlet", "0", "0"), kept=True)))
    said = " ".join(found.finding)
    assert "stormer-verlet: every step is symplectic" in said
    assert "of lie4 at h = 0.1 that 1,000 steps change volume by Λ = −1.3" in said
    assert "times as much" in said
    assert "farther off" not in said
    assert [group.about for group in found.groups] == ["", "S ≡ 0 is proved"]


def test_a_solution_that_is_lost_is_said_to_be() -> None:
    found = view(scene(line(point("lie2", "800", "0.08", error="1.5"), kept=False)))
    assert "Of lie2 some solutions are farther off" in " ".join(found.finding)


def test_where_det_j_begins_later_than_s_it_is_said() -> None:
    def proved(volume: int) -> ProofResult:
        form = FormResult.model_construct(volume_order=volume)
        return ProofResult.model_construct(scheme="lie2", order=3, form=form)

    later, same = (scene(proofs=(proved(n),)) for n in (4, 3))
    assert "begins with h³ and det J − 1 with h⁴" in " ".join(view(later).finding)
    assert not view(same).finding


def test_in_the_plane_there_is_none_and_of_schemes_that_are_symplectic_nothing_is_compared() -> (
    None
):
    assert SECTION.view(scene(line(point("lie2", "1", "1"), kept=False), planar=True), "x") is None
    kept = view(scene(line(point("yoshida4", "0", "0"), kept=True)))
    assert "What det J alone" not in " ".join(kept.finding)


def test_the_papers_report_has_a_regular_and_a_chaotic_orbit_below_the_escape_energy() -> None:
    for path, energy in (("1-regular", Fraction(1, 12)), ("2-chaotic", Fraction(1, 8))):
        made = load_scene(PAPER / f"two-degrees-{path}.toml")
        asked = made.work_precision
        assert asked is not None
        assert made.schemes == ("lie2", "lie4", "stormer-verlet", "yoshida4")
        (q1, q2), (p1, p2) = asked.initial_value.q, asked.initial_value.p  # type: ignore[misc]
        found = (p1**2 + p2**2 + q1**2 + q2**2) / 2 + q1**2 * q2 - q2**3 / 3
        assert abs(found - energy) < Fraction(1, 500)
