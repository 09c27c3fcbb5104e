"""Exact solutions of heat conduction in a slab that starts at one temperature."""

import numpy as np
from cases import Curve
from scipy.optimize import brentq
from scipy.special import erfc, erfcx


def ierfc(u: Curve) -> Curve:
    """The integral of erfc from u to infinity."""
    out: Curve = np.exp(-u * u) / np.sqrt(np.pi) - u * erfc(u)
    return out


def deep_body(q: float, k: float, rho_c: float, depth: float | Curve, time: Curve) -> Curve:
    """Rise [K] under a constant flux: (2 q/k) sqrt(a t) ierfc(x/(2 sqrt(a t)))."""
    reach = 2.0 * np.sqrt(k / rho_c * time)
    return q / k * reach * ierfc(depth / reach)


def deep_translucent_body(
    q: float, kappa: float, k: float, rho_c: float, depth: float, time: Curve
) -> Curve:
    """Rise [K] where q kappa exp(-kappa x) is absorbed per volume.

    deep_body - q/(kappa k) e^(-kappa x) + q/(2 kappa k) e^(s^2) [e^(-kappa x) erfc(s - u)
    + e^(kappa x) erfc(s + u)] with s = kappa sqrt(a t), u = x/(2 sqrt(a t)); it solves the
    equation with an insulated surface and vanishes at t = 0.
    """
    root = np.sqrt(k / rho_c * time)
    s, u = kappa * root, depth / (2.0 * root)
    # e^(s^2 -+ kappa x) erfc(s -+ u) = e^(-u^2) erfcx(s -+ u), which does not overflow.
    tails = np.exp(-u * u) * (erfcx(s - u) + erfcx(s + u))
    rise: Curve = deep_body(q, k, rho_c, depth, time)
    return rise + q / (2.0 * kappa * k) * (tails - 2.0 * np.exp(-kappa * depth))


def slab_with_foil(
    q: float, k: float, rho_c: float, length: float, foil: float, depth: float, time: Curve
) -> Curve:
    """Rise [K] under a constant flux; ``foil`` [J/(m2 K)] is a heat capacity on the back, or 0.

    The mean q t/(rho c L + M), a parabola, and modes cos(z x/L) that decay with z^2 a/L^2, where
    tan z = -z M/(rho c L).
    """
    ratio = foil / (rho_c * length)
    z = np.array([_root(ratio, n) for n in range(1, 400)])
    mean = q * time / (rho_c * length + foil)
    curvature = q * rho_c / (k * (rho_c * length + foil))
    at_back = -q * length / k + 0.5 * curvature * length**2
    middle = -q * length / (2.0 * k) + curvature * length**2 / 6.0
    offset = -(middle + ratio * at_back) / (1.0 + ratio)
    parabola = offset - q * depth / k + 0.5 * curvature * depth**2
    norm = 0.5 + np.sin(2.0 * z) / (4.0 * z) + ratio * np.cos(z) ** 2
    weight = q * length / (k * z * z * norm) * np.cos(z * depth / length)
    decay = np.exp(-np.outer(time, z * z) * k / (rho_c * length**2))
    rise: Curve = mean + parabola - decay @ weight
    return rise


def _root(ratio: float, n: int) -> float:
    """The n-th positive root of sin z + ratio z cos z."""
    if ratio == 0.0:
        return n * np.pi
    low, high = (n - 0.5) * np.pi, n * np.pi
    return float(brentq(lambda z: np.sin(z) + ratio * z * np.cos(z), low, high, xtol=1e-13))


def convective_step(biot: float, fourier: Curve, place: float) -> Curve:
    """Part of a step of the gas temperature still to go, at ``place`` = distance from the back / L.

    Sum of 4 sin z/(2 z + sin 2 z) cos(z place) exp(-z^2 Fo), z tan z = Bi.
    """
    z = np.array(
        [
            brentq(lambda x: x * np.sin(x) - biot * np.cos(x), n * np.pi, (n + 0.5) * np.pi)
            for n in range(200)
        ]
    )
    weight = 4.0 * np.sin(z) / (2.0 * z + np.sin(2.0 * z)) * np.cos(z * place)
    left: Curve = np.exp(-np.outer(fourier, z * z)) @ weight
    return left
