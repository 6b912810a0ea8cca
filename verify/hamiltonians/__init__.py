"""Hamiltonians with exact parameters, their Lie derivatives, and motions in closed form."""
