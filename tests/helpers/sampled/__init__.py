"""Formulas, maps, certificates and separations that hypothesis draws."""
