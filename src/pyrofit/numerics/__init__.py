"""Arithmetic with the same bits on every processor.

NumPy's exponential, its powers and its unstable sort choose their code by the processor, as all of
BLAS and LAPACK do. Their last bits differ from one processor to another. The modules here use sums,
products, divisions and square roots of arrays, which are rounded alike everywhere. Inner products
are those of `np.einsum`, which is compiled once.
"""
