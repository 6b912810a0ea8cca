"""Coefficients as they are printed: do exact ones near them satisfy a method's conditions?"""
