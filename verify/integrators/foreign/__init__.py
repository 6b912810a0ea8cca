"""Steps written in other languages: a shared library's, or a program's that is talked to by lines.

Both run in a process of their own, limited in time and memory, so that one that crashes or hangs
ends nothing else.
"""
