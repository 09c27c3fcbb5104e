"""Mass change of a cell by its reactions over one time step."""

import math

from pyrofit.solver.kernels.jit import inner, live


@inner
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


MOST_DECAY = 700.0
"""k dt beyond which nothing is left."""


@inner
def order_factor(u, x, n):
    """Return the factor on x = k dt that turns first order into order n, for a single reaction.

    du/dt = -k u^n is solved exactly: u_new^(1-n) = u^(1-n) - (1-n) x.
    """
    if x <= 0.0:
        return u ** (n - 1.0)
    base = u ** (1.0 - n) - (1.0 - n) * x
    if base <= 0.0:
        return MOST_DECAY / x
    return (math.log(u) - math.log(base) / (1.0 - n)) / x


@inner
def apply_order(x, n, j, end, u, network):
    """Bring x of the reactions j to end of one reactant to their orders; u is its m/m_formed.

    Several reactions of one reactant take u^(order - 1) at the middle of the step.
    """
    if u <= 0.0:
        return
    if end == j + 1:
        if network.order[j] != 1.0:
            x[j, n] *= order_factor(u, x[j, n], network.order[j])
        return
    fall = 0.0
    for a in range(j, end):
        fall += x[a, n] * u ** (network.order[a] - 1.0)
    middle = u * math.exp(-0.5 * min(fall, 100.0))
    for a in range(j, end):
        x[a, n] *= middle ** (network.order[a] - 1.0)


@inner
def react(m, formed, first, x, network, exact, m_new, used):
    """Advance the masses by dm_i/dt = sum_j (nu_ji - delta_i,i(j)) r_j over one step.

    ``m`` and ``m_new`` [kg/m2] have shape (components, cells), cells before ``first`` stay;
    ``formed``, same shape, is the mass ever present, the reference of reaction order; ``x[j, n]``
    is the integral of k_j over the step; ``used`` (reactions, cells) receives the mass consumed by
    each reaction. What earlier reactions form during the step decays with phi.
    """
    for i in range(m.shape[0]):
        for n in live(m, first):
            m_new[i, n] = m[i, n]
    for j in range(x.shape[0]):
        if j > 0 and network.reactant[j] == network.reactant[j - 1]:
            continue
        if network.plain:
            consume_alone(m, first, j, x, network, exact, m_new, used)
            continue
        end = j + 1
        while end < x.shape[0] and network.reactant[end] == network.reactant[j]:
            end += 1
        for n in live(m, first):
            consume(m, formed, n, j, end, x, network, exact, m_new, used)


@inner
def consume_alone(m, first, j, x, network, exact, m_new, used):
    """Let reaction j consume its reactant, in a network in which nothing else touches that.

    Rounds as `consume`, so that a reaction or component without effect changes no curve.
    """
    i = network.reactant[j]
    for n in live(m, first):
        e, _ = decay(x[j, n], exact)
        left = m[i, n] * e
        used[j, n] = m[i, n] - left
        m_new[i, n] = left
    i = network.residue[j]
    for n in live(m, first):
        m_new[i, n] += network.residue_yield[j] * used[j, n]


@inner
def consume(m, formed, n, j, end, x, network, exact, m_new, used):
    """Let reactions j to end, all of one reactant, consume it in cell n."""
    i = network.reactant[j]
    gained = m_new[i, n] - m[i, n]
    if not network.first_order:
        reference = formed[i, n] + 0.5 * gained
        u = (m[i, n] + 0.5 * gained) / reference if reference > 0.0 else 0.0
        apply_order(x, n, j, end, u, network)
    total = 0.0
    for a in range(j, end):
        total += x[a, n]
    e, phi = decay(total, exact)
    left = m[i, n] * e + gained * phi
    consumed = (m[i, n] - left) + gained
    m_new[i, n] = left
    for a in range(j, end):
        part = consumed
        if end > j + 1:
            part = consumed * (x[a, n] / total) if total > 0.0 else 0.0
        used[a, n] = part
        for b in range(m.shape[0]):
            if network.yields[a, b] != 0.0:
                m_new[b, n] += network.yields[a, b] * part
