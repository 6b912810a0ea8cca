"""Families of observables, one a file: a member is named by the family and a text behind a colon.

A file defines `member(text)`, which returns the observable; its name is the family's and the text.
"""
