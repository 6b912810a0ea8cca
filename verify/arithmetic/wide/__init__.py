"""Fixed-point numbers of 128, 192, 256, … bits, compiled by LLVM: formats, operations, functions.

`verify.arithmetic.systems.fixed` makes a number system of it.
"""
