"""Formulas, the differential ring in which zero is decided, series, jets, enclosures."""
