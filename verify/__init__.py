"""Arbitrary-precision verification of area preservation; the public names, imported when used."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from verify.from_type import register

if TYPE_CHECKING:
    from verify.errors import InputError as InputError
    from verify.hamiltonians import systems as systems
    from verify.hamiltonians.hamiltonian import Hamiltonian as Hamiltonian
    from verify.hamiltonians.named_system import System as System
    from verify.pages.plotting import plot_over_time as plot_over_time
    from verify.pages.plotting import plot_runs as plot_runs
    from verify.pages.plotting import plot_separation as plot_separation
    from verify.proof.order import prove as prove
    from verify.proof.order_proof import Proof as Proof
    from verify.runs.run import run as run
    from verify.scenes.results.report import Report as Report
    from verify.scenes.results.run import RunResult as RunResult
    from verify.scenes.results.separation import SeparationGrid as SeparationGrid
    from verify.scenes.results.separation import SeparationResult as SeparationResult
    from verify.scenes.scene import Scene as Scene
    from verify.scenes.scene import load_scene as load_scene
    from verify.schemes.scheme import Scheme as Scheme
    from verify.schemes.step_map import StepMap as StepMap
    from verify.studies.separation.separate import separate as separate
    from verify.studies.separation.separate import separate_grid as separate_grid
    from verify.verdict import Verdict as Verdict

# Where each public name lives. Nothing is imported before it is asked for, so that `verify --help`
# and a proof do not wait for what they do not use.
_HOMES = {
    "Hamiltonian": "verify.hamiltonians.hamiltonian",
    "InputError": "verify.errors",
    "Proof": "verify.proof.order_proof",
    "Report": "verify.scenes.results.report",
    "RunResult": "verify.scenes.results.run",
    "Scene": "verify.scenes.scene",
    "Scheme": "verify.schemes.scheme",
    "SeparationGrid": "verify.scenes.results.separation",
    "SeparationResult": "verify.scenes.results.separation",
    "StepMap": "verify.schemes.step_map",
    "System": "verify.hamiltonians.named_system",
    "Verdict": "verify.verdict",
    "load_scene": "verify.scenes.scene",
    "plot_over_time": "verify.pages.plotting",
    "plot_runs": "verify.pages.plotting",
    "plot_separation": "verify.pages.plotting",
    "prove": "verify.proof.order",
    "run": "verify.runs.run",
    "separate": "verify.studies.separation.separate",
    "separate_grid": "verify.studies.separation.separate",
}
_MODULES = {"systems": "verify.hamiltonians.systems"}
__all__ = [*_HOMES, *_MODULES]

register()  # what hypothesis draws, whichever of the two is imported first


def __getattr__(name: str) -> Any:
    if name in _MODULES:
        return import_module(_MODULES[name])
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_HOMES[name]), name)
