"""The symplectic form in n degrees of freedom: its defect is S = JᵀΩJ − Ω."""

from verify.structures.structure import Structure

SYMPLECTIC = Structure(
    name="symplectic",
    state="z",
    defect="S",
    accumulated="W",
    size="max |W|",
    zero="form",
    vanishes="S is the zero form: the map is symplectic",
    identity="S ≡ 0",
    claim="to be symplectic",
    of_step="symplectic_defect_max",
    of_run="symplectic_defect",
    over_run="symplectic_defect",
)
