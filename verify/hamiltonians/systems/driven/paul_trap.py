"""One coordinate of an ion in Paul's trap, q'' + (U + V cos Ωt) q = 0, charge and mass put in."""

from verify.hamiltonians.named_system import System

SYSTEM = System(
    name="paul-trap",
    title="Paul trap, one coordinate",
    formula="p**2/2 + (U + V*cos(Omega*t))*q**2/2",
    source="W. Paul, Rev. Mod. Phys. 62 (1990) 531–540, section I.B",
    parameters={
        "U": "the constant voltage, by charge and mass",
        "V": "the amplitude of the other one",
        "Omega": "its angular frequency",
    },
    regimes={
        "trapped": {"U": "0", "V": "1/10", "Omega": "1", "p": "0", "q": "1"},
        "lost": {"U": "0", "V": "1", "Omega": "1", "p": "0", "q": "1"},
    },
)
