"""The symplectic defect S = JᵀΩJ − Ω of a map in n degrees of freedom, by exact algebra."""
