"""Compiled kernels; nothing outside this folder imports numba. `cache` keeps them on disk."""

import os

# The kernels themselves state the operations to run side by side: the compiler's search for more
# takes a third of the time to compile, and gains nothing. Read when numba is imported.
os.environ.setdefault("NUMBA_OPT", "2")
os.environ.setdefault("NUMBA_LOOP_VECTORIZE", "0")
