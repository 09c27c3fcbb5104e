"""How functions are compiled by numba, and kept on disk."""

import os

# The kernels themselves state the operations to run side by side: the compiler's search for more
# takes a third of the time to compile, and gains nothing. Read when numba is imported.
os.environ.setdefault("NUMBA_OPT", "2")
os.environ.setdefault("NUMBA_LOOP_VECTORIZE", "0")
