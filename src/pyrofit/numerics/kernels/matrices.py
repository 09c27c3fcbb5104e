"""Products and factors of matrices in row-major order, for `pyrofit.numerics.linear`.

A sum over rows adds one product after the other. One over two contiguous vectors (`along`) adds
even and odd ones apart and in blocks of eight, as `np.einsum` does with registers of two numbers.
"""

import numpy as np

from pyrofit.compiled.jit import inner, short


@inner
def along(a, i, b, j, count):
    """Return the sum of products of the first numbers of row i of a and row j of b."""
    even = odd = 0.0
    n = 0
    while n + 8 <= count:
        for m in range(n + 6, n - 2, -2):
            even += a[i, m] * b[j, m]
            odd += a[i, m + 1] * b[j, m + 1]
        n += 8
    while n < count:
        even += a[i, n] * b[j, n]
        if n + 1 < count:
            odd += a[i, n + 1] * b[j, n + 1]
        n += 2
    return even + odd


@short
def rows_by_rows(a, b):
    """Return A B^T of shapes (m, i) and (n, i), sums along rows."""
    found = np.empty((a.shape[0], b.shape[0]))
    for k in range(a.shape[0]):
        for j in range(b.shape[0]):
            found[k, j] = along(a, k, b, j, a.shape[1])
    return found


@short
def rows_by_columns(a, b):
    """Return A B of shapes (m, i) and (i, n), sums over rows of B."""
    found = np.zeros((a.shape[0], b.shape[1]))
    for k in range(a.shape[0]):
        for i in range(a.shape[1]):
            for j in range(b.shape[1]):
                found[k, j] += a[k, i] * b[i, j]
    return found


@short
def columns_by_columns(a, b):
    """Return A^T B of shapes (i, m) and (i, n), sums over rows."""
    found = np.zeros((a.shape[1], b.shape[1]))
    rows = a.shape[0] - a.shape[0] % 4
    for i in range(0, rows, 4):
        for k in range(a.shape[1]):
            add_four(a, b, i, k, found, 0)
    for i in range(rows, a.shape[0]):
        for k in range(a.shape[1]):
            for j in range(b.shape[1]):
                found[k, j] += a[i, k] * b[i, j]
    return found


@inner
def add_four(a, b, i, k, to, begin):
    """Add the products of four rows to row k, from a column on."""
    x, y, z, w = a[i, k], a[i + 1, k], a[i + 2, k], a[i + 3, k]
    for j in range(begin, b.shape[1]):
        total = to[k, j] + x * b[i, j]
        total = total + y * b[i + 1, j]
        total = total + z * b[i + 2, j]
        to[k, j] = total + w * b[i + 3, j]


@short
def gram(a):
    """Return A^T A of shape (i, n), sums over rows."""
    n = a.shape[1]
    found = np.zeros((n, n))
    rows = a.shape[0] - a.shape[0] % 4
    for i in range(0, rows, 4):
        for k in range(n):
            add_four(a, a, i, k, found, k)
    for i in range(rows, a.shape[0]):
        for k in range(n):
            for j in range(k, n):
                found[k, j] += a[i, k] * a[i, j]
    for k in range(n):
        for j in range(k):
            found[k, j] = found[j, k]
    return found


@short
def cholesky(a):
    """Return L with L L^T = A, and whether A is positive definite."""
    n = a.shape[0]
    left = np.zeros((n, n))
    for k in range(n):
        pivot = a[k, k] - along(left, k, left, k, k)
        if not pivot > 0.0:
            return left, False
        size = np.sqrt(pivot)
        left[k, k] = pivot / size
        for i in range(k + 1, n):
            left[i, k] = (a[i, k] - along(left, i, left, k, k)) / size
    return left, True


@short
def solve_lower(left, b, apart):
    """Return x of L x = b of shape (n, k); sums along rows if ``apart``, else over rows of x."""
    n, columns = b.shape
    x = np.empty((columns, n)) if apart else np.empty((n, columns))
    total = np.empty(columns)
    for k in range(n):
        if apart:
            for j in range(columns):
                x[j, k] = (b[k, j] - along(left, k, x, j, k)) / left[k, k]
            continue
        total[:] = 0.0
        for i in range(k):
            for j in range(columns):
                total[j] += left[k, i] * x[i, j]
        for j in range(columns):
            x[k, j] = (b[k, j] - total[j]) / left[k, k]
    return x


@inner
def reflect(v, double, to, first, apart, total):
    """Bring columns of a matrix, from ``first`` on, to (1 - double v v^T) times them.

    v is that of the rows from ``first`` on. Sums go along columns if ``apart``, else over rows.
    """
    rows, columns = to.shape
    if apart:
        for j in range(first, columns):
            total[j] = along(v, 0, to[first:, j : j + 1].T, 0, rows - first)
    else:
        total[:] = 0.0
        for i in range(first, rows):
            for j in range(first, columns):
                total[j] += v[0, i - first] * to[i, j]
    for i in range(first, rows):
        share = double * v[0, i - first]
        for j in range(first, columns):
            to[i, j] -= share * total[j]


@short
def qr(a, apart, small):
    """Return Q with orthonormal columns and R, not yet a triangle, of Householder's reflections.

    Shapes (m, k) and (k, n), k = min(m, n). Columns of numbers below ``small`` are scaled before
    they are squared. Sums go along columns if ``apart``, else over rows.
    """
    rest = a.copy()
    rows, columns = rest.shape
    count = min(rows, columns)
    mirrors, doubles = np.empty((count, 1, rows)), np.empty(count)
    total = np.empty(max(columns, count))
    for k in range(count):
        v, length = mirrors[k], rows - k
        largest = 0.0
        for i in range(length):
            v[0, i] = rest[k + i, k]
            largest = max(largest, abs(v[0, i]))
        if 0.0 < largest < small:
            for i in range(length):
                v[0, i] /= largest
        size = np.sqrt(along(v, 0, v, 0, length))
        v[0, 0] += np.copysign(size, v[0, 0])
        doubles[k] = 2.0 / along(v, 0, v, 0, length) if size > 0.0 else 0.0
        reflect(v, doubles[k], rest, k, apart, total)
    basis = np.eye(rows, count)
    for k in range(count - 1, -1, -1):
        reflect(mirrors[k], doubles[k], basis, k, count == 1, total)
    return basis, rest[:count]


@short
def solve_band(factor, b):
    """Return x of L x = b of shape (n, k), L of the bands of `pyrofit.numerics.bands`."""
    x = b.copy()
    for i in range(x.shape[0]):
        for k in range(1, min(factor.shape[1] - 1, i) + 1):
            for j in range(x.shape[1]):
                x[i, j] -= factor[i, k] * x[i - k, j]
        for j in range(x.shape[1]):
            x[i, j] /= factor[i, 0]
    return x
