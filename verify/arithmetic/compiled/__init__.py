"""Kernels in fixed point as functions of this machine: compiled, kept, and called, one orbit or
several at a time.
"""
