"""The modified Hamiltonian of a step map: of one H, and of every one."""
