"""Arbitrary-precision verification of area preservation; the public names, imported when used."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from verify.errors import InputError as InputError
    from verify.hamiltonian import Hamiltonian as Hamiltonian
    from verify.proof.order import Proof as Proof
    from verify.proof.order import prove as prove
    from verify.results import RunResult as RunResult
    from verify.results import SeparationGrid as SeparationGrid
    from verify.results import SeparationResult as SeparationResult
    from verify.runs import run as run
    from verify.scene import Scene as Scene
    from verify.scene import load_scene as load_scene
    from verify.scene_results import Report as Report
    from verify.scheme import Scheme as Scheme
    from verify.separation import separate as separate
    from verify.separation import separate_grid as separate_grid
    from verify.step_map import StepMap as StepMap
    from verify.system import System as System
    from verify.verdict import Verdict as Verdict

# Where each public name lives. Nothing is imported before it is asked for, so that `verify --help`
# and a proof do not wait for what they do not use.
_HOMES = {
    "Hamiltonian": "verify.hamiltonian",
    "InputError": "verify.errors",
    "Proof": "verify.proof.order",
    "Report": "verify.scene_results",
    "RunResult": "verify.results",
    "Scene": "verify.scene",
    "Scheme": "verify.scheme",
    "SeparationGrid": "verify.results",
    "SeparationResult": "verify.results",
    "StepMap": "verify.step_map",
    "System": "verify.system",
    "Verdict": "verify.verdict",
    "load_scene": "verify.scene",
    "prove": "verify.proof.order",
    "run": "verify.runs",
    "separate": "verify.separation",
    "separate_grid": "verify.separation",
}
__all__ = list(_HOMES)


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_HOMES[name]), name)
