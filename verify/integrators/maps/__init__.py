"""Any map (p, q) ↦ (p', q') in n degrees of freedom, without an H: is it symplectic?"""
