"""Drawn scenes in n degrees of freedom, and steps of their maps in ball arithmetic."""
