"""Arbitrary-precision verification of area preservation, and the public names.

A system is a name such as "duffing", a formula such as "p**2/2 - cos(q)", or a Hamiltonian; a
scheme is a name such as "lie2", 'p_next = …; q_next = …', a Scheme or a StepMap. Numbers are exact:
0.1 is 1/10. Bad input is an InputError of one line. Nothing is imported before it is used.

"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from verify.from_type import register

if TYPE_CHECKING:
    from verify import schemes as schemes
    from verify.calls.check import check as check
    from verify.calls.check import check_map as check_map
    from verify.calls.export import export as export
    from verify.calls.prove import modified_hamiltonian as modified_hamiltonian
    from verify.calls.prove import prove as prove
    from verify.calls.run import run as run
    from verify.calls.run import sweep as sweep
    from verify.calls.run_result import Report as Report
    from verify.calls.run_result import RunResult as RunResult
    from verify.calls.separate import separate as separate
    from verify.calls.separate import separate_grid as separate_grid
    from verify.calls.studies import bench as bench
    from verify.calls.studies import flow as flow
    from verify.calls.studies import stability as stability
    from verify.errors import InputError as InputError
    from verify.hamiltonians import systems as systems
    from verify.hamiltonians.hamiltonian import Hamiltonian as Hamiltonian
    from verify.hamiltonians.named_system import System as System
    from verify.integrators.tables.table_file import check_table as check_table
    from verify.pages.plotting import plot_energy_drift as plot_energy_drift
    from verify.pages.plotting import plot_flow as plot_flow
    from verify.pages.plotting import plot_orbit as plot_orbit
    from verify.pages.plotting import plot_over_time as plot_over_time
    from verify.pages.plotting import plot_runs as plot_runs
    from verify.pages.plotting import plot_separation as plot_separation
    from verify.pages.plotting import plot_work_precision as plot_work_precision
    from verify.proof.plane.modified_equation import ModifiedEquation as ModifiedEquation
    from verify.proof.proof_for_one_h import Proof as Proof
    from verify.proof.structures.structures_proof import StructuresProof as StructuresProof
    from verify.scenes.results.run import OrbitTable as OrbitTable
    from verify.scenes.results.separation import SeparationGrid as SeparationGrid
    from verify.scenes.results.separation import SeparationGridInDegrees as SeparationGridInDegrees
    from verify.scenes.results.separation import SeparationInDegrees as SeparationInDegrees
    from verify.scenes.results.separation import SeparationResult as SeparationResult
    from verify.scenes.results.sweep import Sweep as Sweep
    from verify.scenes.scene import Scene as Scene
    from verify.scenes.scene import load_scene as load_scene
    from verify.schemes.maps.step_map import StepMap as StepMap
    from verify.schemes.scheme import Scheme as Scheme
    from verify.verdict import Verdict as Verdict

# Each public name with its module and the line that describes it in help(verify). A module is
# imported when its name is used, so that `verify --help` and a proof do not wait for the others.
_NAMES = {
    "run": ("verify.calls.run", "N steps: values with error bounds, and the orbit as arrays"),
    "sweep": ("verify.calls.run", "runs over lists of schemes, steps, starts: a table"),
    "prove": ("verify.calls.prove", "the order of ΔJ = det J − 1 and of the map, exactly"),
    "modified_hamiltonian": ("verify.calls.prove", "the energy that a scheme keeps: H̃ in h"),
    "export": ("verify.calls.export", "a step map, J and ΔJ as C, Python, Julia or LaTeX"),
    "separate": ("verify.calls.separate", "truncation and rounding in Λ of a float64 run"),
    "separate_grid": ("verify.calls.separate", "the same over step sizes, and where they cross"),
    "flow": ("verify.calls.studies", "a region carried by schemes, and its area"),
    "stability": ("verify.calls.studies", "runs judged: stable or not, and whose fault it is"),
    "bench": ("verify.calls.studies", "error against run time"),
    "check": ("verify.calls.check", "a step function of one's own: proved, else measured"),
    "check_map": ("verify.calls.check", "any map of one's own: symplectic or not"),
    "check_table": (
        "verify.integrators.tables.table_file",
        "printed coefficients, by what they claim",
    ),
    "plot_orbit": ("verify.pages.plotting", "an orbit's quantity over t, or in the plane"),
    "plot_energy_drift": ("verify.pages.plotting", "the drift of H and of H̃ over t"),
    "plot_runs": ("verify.pages.plotting", "a quantity of runs against the step size"),
    "plot_over_time": ("verify.pages.plotting", "ΔJ and Λ over t, as bands"),
    "plot_separation": ("verify.pages.plotting", "truncation and rounding against the step size"),
    "plot_flow": ("verify.pages.plotting", "a region and its images"),
    "plot_work_precision": ("verify.pages.plotting", "error against run time, and step size"),
    "Hamiltonian": ("verify.hamiltonians.hamiltonian", "H(p, q) with exact parameters"),
    "System": ("verify.hamiltonians.named_system", "a named Hamiltonian, with its exact flow"),
    "systems": ("verify.hamiltonians.systems", "the named systems: names(), get(name)"),
    "Scheme": ("verify.schemes.scheme", "an integration scheme with its claims"),
    "schemes": ("verify.schemes", "the schemes: names(), get(name)"),
    "StepMap": (
        "verify.schemes.maps.step_map",
        "the exact map of one step; from_formulas(H, p', q')",
    ),
    "Scene": ("verify.scenes.scene", "a declaration of what is to be verified"),
    "load_scene": ("verify.scenes.scene", "the scene in a TOML file"),
    "Proof": ("verify.proof.proof_for_one_h", "what is proved of a step map"),
    "StructuresProof": (
        "verify.proof.structures.structures_proof",
        "what is proved of what a step keeps",
    ),
    "ModifiedEquation": ("verify.proof.plane.modified_equation", "what is known of a scheme's H̃"),
    "RunResult": ("verify.calls.run_result", "what a run gave"),
    "OrbitTable": ("verify.scenes.results.run", "the states of a run"),
    "Sweep": ("verify.scenes.results.sweep", "what a sweep gave"),
    "SeparationResult": ("verify.scenes.results.separation", "what a separation gave"),
    "SeparationGrid": ("verify.scenes.results.separation", "separations over step sizes"),
    "SeparationInDegrees": (
        "verify.scenes.results.separation",
        "what a separation gave in n degrees of freedom",
    ),
    "SeparationGridInDegrees": (
        "verify.scenes.results.separation",
        "such separations over step sizes",
    ),
    "Report": ("verify.calls.run_result", "a whole report"),
    "Verdict": ("verify.verdict", "PROVED, ENCLOSED, MEASURED, REFUTED or UNDECIDED"),
    "InputError": ("verify.errors", "bad input, in one line that says what is allowed"),
}
# Public names of modules; the other names are attributes of a module.
_MODULES = ("schemes", "systems")
_NAME_WIDTH = max(map(len, _NAMES))  # characters, in the table
__all__ = [*_NAMES]
__doc__ = (__doc__ or "") + "\n".join(  # it is None with python -OO
    f"    {name:{_NAME_WIDTH}}  {summary}" for name, (_, summary) in _NAMES.items()
)


register()  # the classes that hypothesis can draw, whichever package is imported first


def __getattr__(name: str) -> Any:
    if name == "__version__":
        from importlib.metadata import version

        return version("areaproof")
    if name not in _NAMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    home = import_module(_NAMES[name][0])
    return home if name in _MODULES else getattr(home, name)


def __dir__() -> list[str]:
    return sorted({*_NAMES, *(name for name in globals() if name.startswith("__")), "__version__"})
