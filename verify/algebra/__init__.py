"""Formulas, the differential ring in which zero is decided, power series, jets, enclosures."""
