"""OpenMM's Verlet integrators, in double precision on its reference platform.

The velocities of VerletIntegrator belong to a time half a step before that of the positions. As a
map of both it is symplectic, and its order is not that of its positions.
"""

from collections.abc import Iterator

from verify.audits.methods import driver
from verify.audits.methods.integrator import ReleasedIntegrator

TITLE = "OpenMM"
LIBRARY = "openmm"
PACKAGE = "OpenMM"
EXTRA = "heavy-peers"
LEFT_OUT = (
    ("VariableVerletIntegrator", "chooses its steps by itself; it is said not to be symplectic"),
    ("Langevin and Nosé–Hoover integrators", "are of other equations than H's"),
)
_POTENTIALS: dict[driver.ScriptedProblem, str] = {
    driver.TWO_WAVES: "-2*cos(x)-sin(2*x)/2",
    driver.HENON_HEILES: "(x^2+y^2)/2+x^2*y-y^3/3",
}
_HEAD = """\
import numpy as np
import openmm

system = openmm.System()
system.addParticle(1.0)
field = openmm.CustomExternalForce("{potential}")
field.addParticle(0)
system.addForce(field)
integrator = {method}
context = openmm.Context(system, integrator, openmm.Platform.getPlatformByName("Reference"))
"""
_BODY = """\
n = np.size(q)
context.setPositions([[*np.atleast_1d(q), 0.0, 0.0][:3]])
context.setVelocities([[*np.atleast_1d(p), 0.0, 0.0][:3]])
integrator.setStepSize(h)
integrator.step(1)
state = context.getState(getPositions=True, getVelocities=True)
q = state.getPositions(asNumpy=True)._value[0, :n]
p = state.getVelocities(asNumpy=True)._value[0, :n]
"""
_METHODS = (
    ("VerletIntegrator", "openmm.VerletIntegrator(0.1)", None,
     "OpenMM's documentation, of VariableVerletIntegrator: “Unlike a fixed step size Verlet "
     "integrator, variable step size Verlet is not symplectic”"),
    ("MTSIntegrator", "openmm.MTSIntegrator(0.1, [(0, 1)])", None,
     "OpenMM's documentation: the rRESPA of Tuckerman et al.; nothing is said of order or area"),
)  # fmt: skip


def integrators() -> Iterator[ReleasedIntegrator]:
    for name, method, order, claim in _METHODS:
        for problem, potential in _POTENTIALS.items():
            driven = driver.Driver(
                _HEAD.replace("{potential}", potential), _BODY, "one step on the reference platform"
            )
            symplectic = True if name == "VerletIntegrator" else None
            yield from driver.drive_problems(
                name, driven, method, claim, order, symplectic, (problem,)
            )
