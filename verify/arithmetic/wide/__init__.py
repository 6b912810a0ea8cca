"""Fixed-point numbers of 128, 156, 192, … bits, compiled by LLVM: formats, operations, functions.

`verify.arithmetic.systems.fixed` is the number system made of them.
"""
