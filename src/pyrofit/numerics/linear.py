"""Products and factors of small matrices, the same to the last bit on every processor.

BLAS and LAPACK choose their code by the processor. Here loops are compiled, or one index runs in
Python and the others in `np.einsum` and in products of arrays. Matrices have up to some hundred
columns; larger ones take long.
"""

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from pyrofit.numerics.functions import Floats, log

_SWEEPS = 40
"""Sweeps of Jacobi's rotations at most; ten are usual."""
_EPS = float(np.finfo(float).eps)
_FEW = 24
"""Rows up to which a system of equations is solved row by row in Python."""
_LARGE = 2000
"""Products of numbers in a product of matrices from which compiled loops are faster."""
_NEXT = 8
"""Distance in bytes of neighbours in memory."""
_SMALL = 1e-140
"""Squares of smaller numbers lose digits."""


def dot(a: Floats, b: Floats) -> float:
    """Return the inner product of two vectors."""
    return float(np.einsum("i,i->", a, b))


def product(first: Any, *others: Any) -> Floats:
    """Return the product of matrices and vectors, from left to right, as ``@`` does.

    Two vectors give a number, as an array without a dimension. All but the first are vectors or
    matrices, and the first may be a stack of matrices.

    >>> product(np.eye(2), np.array([[1.0, 2.0], [3.0, 4.0]]), np.array([1.0, 1.0])).tolist()
    [3.0, 7.0]
    """
    found = np.asarray(first)
    for other in others:
        found = _product(found, np.asarray(other))
    return found


def _product(left: Floats, right: Floats) -> Floats:
    """Return the product of two of them: of large ones compiled, with the sums of `np.einsum`."""
    a = left if left.ndim > 1 else left[None]
    b = right if right.ndim > 1 else right[:, None]
    if a.ndim > 2 or a.size * b.shape[1] < _LARGE or not (_is_plain(a) and _is_plain(b)):
        of_row = "i" if left.ndim == 1 else "...i"
        of_column = "i" if right.ndim == 1 else "ij"
        kept = ("" if left.ndim == 1 else "...") + of_column[1:]
        return np.asarray(np.einsum(f"{of_row},{of_column}->{kept}", left, right))
    if a.shape[1] != b.shape[0]:
        raise ValueError(f"matrices of shapes {left.shape} and {right.shape} have no product")
    from pyrofit.numerics.kernels import matrices

    plain = np.ascontiguousarray
    if a.strides[1] == b.strides[0] == _NEXT:
        found = matrices.rows_by_rows(plain(a), plain(b.T))
    elif a.strides[0] < a.strides[1]:
        found = matrices.columns_by_columns(plain(a.T), plain(b))
        # The next product adds along what is contiguous.
        found = found if b.strides[0] > b.strides[1] else np.asfortranarray(found)
    else:
        found = matrices.rows_by_columns(plain(a), plain(b))
    return np.asarray(found.reshape(left.shape[:-1] + right.shape[1:], order="A"))


def _is_plain(a: Floats) -> bool:
    """Tell whether a matrix holds floats, its rows and columns in ascending order."""
    return a.dtype == np.float64 and min(a.strides) > 0


def gram(a: Floats) -> Floats:
    """Return A^T A of shape (columns, columns)."""
    small = a.shape[1] < 2 or a.size * a.shape[1] < _LARGE
    # In column-major order sums go along the columns, as those of products do.
    if small or not _is_plain(a) or a.strides[0] < a.strides[1]:
        return product(a.T, a)
    from pyrofit.numerics.kernels import matrices

    return np.asarray(matrices.gram(np.ascontiguousarray(a)))


def norm(a: Floats) -> float:
    """Return the root of the sum of squares of a vector."""
    return float(np.sqrt(dot(a, a)))


def correlation(rows: Floats) -> Floats:
    """Return the correlation of the rows of an array, shape (rows, rows), as `np.corrcoef` does.

    That of a row without variance is nan.
    """
    rows = np.atleast_2d(rows)
    apart = rows - rows.mean(axis=1, keepdims=True)
    square = gram(apart.T)
    variance = np.diag(square)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray(np.clip(square / np.sqrt(np.outer(variance, variance)), -1.0, 1.0))


def cholesky(a: Floats) -> Floats:
    """Return L with L L^T = A, a lower triangle; only the lower part of A is read.

    Raises
    ------
    numpy.linalg.LinAlgError
        The matrix is not positive definite.
    """
    from pyrofit.numerics.kernels import matrices

    left, definite = matrices.cholesky(np.ascontiguousarray(a, dtype=np.float64))
    if not definite:
        raise np.linalg.LinAlgError("Matrix is not positive definite")
    return np.asarray(left)


def solve_lower(left: Floats, b: Floats) -> Floats:
    """Return x of L x = b; L a lower triangle, b of shape (n,) or (n, k)."""
    from pyrofit.numerics.kernels import matrices

    x = np.array(b, dtype=np.float64)
    columns = x if x.ndim > 1 else x[:, None]
    apart = left.strides[1] == columns.strides[0] == _NEXT
    of_columns = np.ascontiguousarray(columns)
    found = matrices.solve_lower(np.ascontiguousarray(left), of_columns, apart)
    found = found.T if apart else found
    if x.ndim == 1:
        return np.ascontiguousarray(found[:, 0])
    return np.asarray(found, order="F" if x.flags.f_contiguous else "C")


def solve_upper(right: Floats, b: Floats) -> Floats:
    """Return x of R x = b; R an upper triangle, b of shape (n,) or (n, k)."""
    return solve_lower(right[::-1, ::-1], b[::-1])[::-1]


def solve(a: Floats, b: Floats) -> Floats:
    """Return x of A x = b of a symmetric positive definite A, b of shape (n,) or (n, k).

    Raises
    ------
    numpy.linalg.LinAlgError
        The matrix is not positive definite.
    """
    if b.ndim == 1 and b.size <= _FEW:
        return np.array(_solved(a.tolist(), b.tolist()))
    left = cholesky(a)
    return solve_upper(left.T, solve_lower(left, b))


def _solved(a: list[list[float]], b: list[float]) -> list[float]:
    """Return x of A x = b: of few rows, numbers of Python are faster than arrays."""
    left: list[list[float]] = []
    for i, own in enumerate(a):
        row: list[float] = []
        for value, other in zip(own[: i + 1], [*left, row], strict=True):
            for p, q in zip(row, other, strict=False):
                value -= p * q
            row.append(value / other[-1] if other is not row else _root(value))
        left.append(row)
    x = b.copy()
    for i, row in enumerate(left):
        for k in range(i):
            x[i] -= row[k] * x[k]
        x[i] /= row[i]
    for i in reversed(range(len(x))):
        x[i] /= left[i][i]
        for k in range(i):
            x[k] -= left[i][k] * x[i]
    return x


def _root(pivot: float) -> float:
    if not pivot > 0.0:
        raise np.linalg.LinAlgError("Matrix is not positive definite")
    return math.sqrt(pivot)


def inverse(a: Floats) -> Floats:
    """Return the inverse of a symmetric positive definite matrix, symmetric to the last bit."""
    found = gram(inverse_root(a))
    return np.asarray(0.5 * (found + found.T))


def inverse_root(a: Floats) -> Floats:
    """Return L^-1 of A = L L^T: W with W^T W = A^-1, a lower triangle.

    Raises
    ------
    numpy.linalg.LinAlgError
        The matrix is not positive definite.
    """
    return solve_lower(cholesky(a), np.eye(len(a)))


def log_det(a: Floats) -> float:
    """Return the logarithm of the determinant of a symmetric positive definite matrix."""
    return 2.0 * float(np.sum(log(np.diag(cholesky(a)))))


def thin_factor(diagonal: Floats, row: Callable[[int], Floats], least: float) -> Floats:
    """Return F of few columns with F F^T = A but for ``least`` of the largest diagonal, (n, k).

    Cholesky's factor of a symmetric matrix without negative eigenvalues, the largest remainder of
    the diagonal first. Only the few rows that it takes are asked for.
    """
    left = np.array(diagonal, dtype=np.float64)
    enough, columns = least * float(left.max()), np.empty((0, left.size))
    while len(columns) < left.size and left.max() > max(enough, 0.0):
        k = int(left.argmax())
        column = (row(k) - product(columns[:, k], columns)) / np.sqrt(left[k])
        columns = np.vstack([columns, column])
        left = np.maximum(left - column**2, 0.0)
        left[k] = 0.0
    return np.asarray(columns.T)


def qr(a: Floats) -> tuple[Floats, Floats]:
    """Return Q with orthonormal columns and an upper triangle R with Q R = A.

    Shapes (m, k) and (k, n) of A of shape (m, n), k = min(m, n); by Householder's reflections.
    """
    from pyrofit.numerics.kernels import matrices

    rest = np.array(a, dtype=np.float64)
    apart = rest.strides[0] == _NEXT
    basis, rest = matrices.qr(np.ascontiguousarray(rest), apart, _SMALL)
    return basis, np.triu(rest)


def svd(a: Floats) -> tuple[Floats, Floats, Floats]:
    """Return U, s and V^T with U diag(s) V^T = A, s in falling order.

    Shapes (m, k), (k,) and (k, n), k = min(m, n). Jacobi's rotations of one side (Hestenes 1958,
    doi 10.1137/0106005) of the rows of R of A = Q R, all disjoint pairs side by side. Small
    singular values are as exact as the columns are, however differently these are scaled.
    """
    a = np.asarray(a, dtype=np.float64)
    if a.shape[0] < a.shape[1]:
        U, s, rows = svd(a.T)
        return rows.T, s, U.T
    largest = float(np.max(np.abs(a), initial=0.0))
    order = np.argsort(-np.sum((a / (largest or 1.0)) ** 2, axis=0), kind="stable")
    Q, R = qr(a[:, order] / (largest or 1.0))
    turned, rotation = _orthogonal(R)
    s = np.sqrt(np.sum(turned**2, axis=1))
    falling = np.argsort(-s, kind="stable")
    s, turned, rotation = s[falling], turned[falling], rotation[falling]
    rows = np.empty_like(turned)
    rows[:, order] = _completed(turned, s)
    return product(Q, rotation.T), s * largest, rows


def _orthogonal(rows: Floats) -> tuple[Floats, Floats]:
    """Return W A with orthogonal rows, and the rotation W, both of shape (n, n)."""
    n = len(rows)
    both = np.concatenate([rows, np.eye(n)], axis=1)
    rounds = _rounds(n)
    for _ in range(_SWEEPS):
        largest = 0.0
        for i, j in rounds:
            x, y = both[i], both[j]
            own, other = x[:, :n], y[:, :n]
            a = np.einsum("ij,ij->i", own, own)
            b = np.einsum("ij,ij->i", other, other)
            c = np.einsum("ij,ij->i", own, other)
            scale = np.sqrt(a) * np.sqrt(b)
            apart = (np.abs(c) > _EPS * scale) & (scale > 0.0)
            if not apart.any():
                continue
            largest = max(largest, float(np.max(np.abs(c[apart]) / scale[apart])))
            zeta = (b - a) / np.where(apart, 2.0 * c, 1.0)
            with np.errstate(over="ignore"):  # the angle is then zero
                t = np.copysign(1.0, zeta) / (np.abs(zeta) + np.sqrt(1.0 + zeta * zeta))
            t = np.where(apart, t, 0.0)[:, None]
            cosine = 1.0 / np.sqrt(1.0 + t * t)
            both[i], both[j] = cosine * (x - t * y), cosine * (t * x + y)
        if largest <= n * _EPS:
            break
    return both[:, :n], both[:, n:]


def _rounds(n: int) -> list[tuple[Any, Any]]:
    """Return rounds of disjoint pairs in which each pair of n occurs once.

    >>> [list(zip(i.tolist(), j.tolist())) for i, j in _rounds(3)]
    [[(1, 2)], [(0, 2)], [(0, 1)]]
    """
    ring = list(range(n + n % 2))
    found = []
    for _ in ring[1:]:
        half = len(ring) // 2
        pairs = zip(ring[:half], reversed(ring[half:]), strict=True)
        kept = np.array([sorted(p) for p in pairs if max(p) < n], dtype=np.intp).reshape(-1, 2)
        found.append((kept[:, 0], kept[:, 1]))
        ring = [ring[0], ring[-1], *ring[1:-1]]
    return found


def _completed(rows: Floats, sizes: Floats) -> Floats:
    """Return orthogonal rows over their sizes; those without a size are made orthogonal anew."""
    found = rows / np.where(sizes > 0.0, sizes, 1.0)[:, None]
    for k in np.flatnonzero(sizes <= rows.shape[1] * _EPS * _EPS * sizes[:1].sum()):
        left = np.eye(rows.shape[1])
        for _ in range(2):
            left = left - product(product(left, found[:k].T), found[:k])
        length = np.sqrt(np.sum(left**2, axis=1))
        found[k] = left[length.argmax()] / length.max()
    return found


def eigen(a: Floats) -> tuple[Floats, Floats]:
    """Return eigenvalues in rising order and eigenvectors, as columns, of a symmetric matrix.

    By singular values of A + c I, where c makes all eigenvalues positive.
    """
    radius = np.sum(np.abs(a), axis=1) - np.abs(np.diag(a))
    shift = max(0.0, float(np.max(radius - np.diag(a))))
    vectors, s, _ = svd(a + shift * np.eye(len(a)))
    return s[::-1] - shift, vectors[:, ::-1]


def least_squares(a: Floats, b: Floats, least: float | None = None) -> Floats:
    """Return the shortest x of least |A x - b|, of shape (n,).

    Singular values below ``least`` times the largest count as zero; by default eps max(m, n).
    """
    least = _EPS * max(a.shape) if least is None else least
    U, s, rows = svd(a)
    kept = s > least * s[:1].sum()
    return product(rows[kept].T, product(U[:, kept].T, b) / s[kept])


def running_mean(x: Floats, width: int) -> Floats:
    """Return sums of neighbours over the width, as `np.convolve(..., "same")` with zeros outside.

    >>> running_mean(np.array([1.0, 2.0, 3.0]), 2).tolist()
    [0.5, 1.5, 2.5]
    """
    ahead = width // 2
    padded = np.concatenate([np.zeros(ahead), x, np.zeros(width - 1 - ahead)])
    return np.asarray(np.lib.stride_tricks.sliding_window_view(padded, width).sum(axis=1) / width)
