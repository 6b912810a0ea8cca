"""What users write themselves: formulas, and a splitting's coefficients."""
