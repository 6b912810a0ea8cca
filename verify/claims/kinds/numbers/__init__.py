"""Kinds of claims about single printed numbers."""
