"""Arithmetic with the same bits on every processor.

NumPy's exponential, its powers and its unstable sort, and all of BLAS and LAPACK, choose their code
by the processor; so their last bits differ from one to another. The modules here use additions,
products, divisions and square roots of arrays only, which are rounded alike everywhere, and
`np.einsum`, which is compiled once.
"""
