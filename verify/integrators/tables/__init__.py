"""Printed tables of coefficients: read, and what their digits can say of what they claim."""
