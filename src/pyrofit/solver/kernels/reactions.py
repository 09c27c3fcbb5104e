"""Mass change of a cell by its reactions over one time step."""

import math

from numba import njit


@njit(cache=True, error_model="numpy", forceinline=True, _nrt=False)
def decay(x, exact):
    """Return E = exp(-x) and phi = (1 - E)/x, or their third-order Padé forms (L-stable, fast).

    E = 1/(1 + x + x^2/2 + x^3/6), phi = (1 + x/2 + x^2/6) E.
    """
    if exact:
        e = math.exp(-x)
        if x < 1e-4:
            return e, 1.0 - x * (0.5 - x / 6.0)
        return e, (1.0 - e) / x
    e = 1.0 / (1.0 + x * (1.0 + x * (0.5 + x * 0.16666666666666666)))
    return e, e * (1.0 + x * (0.5 + x * 0.16666666666666666))


@njit(cache=True, error_model="numpy", _nrt=False)
def order_factor(u, x, n, alone):
    """Return the factor on x = k dt that turns first order into order n.

    With one reaction du/dt = -k u^n is solved exactly, u_new^(1-n) = u^(1-n) - (1-n) x; several
    reactions of one component take u^(n-1) at the middle of the step.
    """
    if u <= 0.0:
        return 1.0
    if not alone:
        middle = u * math.exp(-0.5 * x * u ** (n - 1.0))
        return middle ** (n - 1.0)
    if x <= 0.0:
        return u ** (n - 1.0)
    base = u ** (1.0 - n) - (1.0 - n) * x
    if base <= 0.0:
        return 700.0 / x
    return (math.log(u) - math.log(base) / (1.0 - n)) / x


@njit(cache=True, error_model="numpy", forceinline=True, _nrt=False)
def react(m, formed, n, x, network, exact, m_new, used):
    """Advance the masses of cell n by dm_i/dt = sum_j (nu_ji - delta_i,i(j)) r_j over one step.

    ``m`` and ``m_new`` [kg/m2] have shape (cells, components); ``formed``, same shape, is the mass
    ever present, the reference of reaction order; ``x[j]`` is the integral of k_j over the step;
    ``used`` (cells, reactions) receives the mass consumed by each reaction. What earlier reactions
    form during the step decays with phi.
    """
    components = m.shape[1]
    reactions = x.size
    for i in range(components):
        m_new[n, i] = m[n, i]
    if network.plain:
        for j in range(reactions):
            i = network.reactant[j]
            e, _ = decay(x[j], exact)
            part = m[n, i] * (1.0 - e)
            m_new[n, i] -= part
            m_new[n, network.residue[j]] += network.residue_yield[j] * part
            used[n, j] = part
        return
    j = 0
    while j < reactions:
        i = network.reactant[j]
        end = j + 1
        while end < reactions and network.reactant[end] == i:
            end += 1
        gained = m_new[n, i] - m[n, i]
        total = 0.0
        for a in range(j, end):
            if not network.first_order and network.order[a] != 1.0:
                reference = formed[n, i] + gained
                u = (m[n, i] + 0.5 * gained) / reference if reference > 0.0 else 0.0
                x[a] *= order_factor(u, x[a], network.order[a], end == j + 1)
            total += x[a]
        e, phi = decay(total, exact)
        left = m[n, i] * e + gained * phi
        consumed = (m[n, i] - left) + gained
        m_new[n, i] = left
        for a in range(j, end):
            part = consumed
            if end > j + 1:
                part = consumed * x[a] / total if total > 0.0 else 0.0
            used[n, a] = part
            for b in range(components):
                nu = network.yields[a, b]
                if nu != 0.0:
                    m_new[n, b] += nu * part
        j = end
