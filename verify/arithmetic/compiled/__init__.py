"""Native code: kernels in fixed point and in float64, compiled by LLVM, cached, and called for one
orbit or for several at a time.
"""
