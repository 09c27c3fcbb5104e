"""Mass change of a cell by its reactions over one time step."""

from pyrofit.solver.kernels.functions import exp, fma, inverse, log, power
from pyrofit.solver.kernels.jit import inner
from pyrofit.solver.kernels.lanes import somewhere, where

MOST_DECAY = 700.0
"""k dt beyond which nothing is left."""
MOST_PADE = 1e60
"""The same for the Padé form."""
LEAST_MASS = 1.0e-200
"""[kg/m2]; less is nothing: the processor is slow with the numbers next to zero."""
TINY = 1.0e-300


@inner
def decay(x, exact):
    """Return E = exp(-x) and phi = (1 - E)/x, or their third-order Padé forms (L-stable, fast).

    E = 1/(1 + x + x^2/2 + x^3/6), phi = (1 + x/2 + x^2/6) E.
    """
    if exact:
        e = exp(-x)
        short = 1.0 - x * (0.5 - x / 6.0)
        return e, where(x < 1e-4, short, (1.0 - e) / max(x, 1e-4))
    x = min(x, MOST_PADE)
    tail = fma(x, fma(x, 1.0 / 6.0, 0.5), 1.0)
    e = inverse(fma(x, tail, 1.0))
    return e, e * tail


@inner
def order_factor(u, x, n):
    """Return the factor on x = k dt that turns first order into order n, for a single reaction.

    du/dt = -k u^n is solved exactly: u_new^(1-n) = u^(1-n) - (1-n) x.
    """
    m = where(n == 1.0, 1.0, 1.0 - n)
    log_u = log(u)
    base = exp(m * log_u) - m * x
    solved = (log_u - log(max(base, TINY)) / m) / max(x, TINY)
    factor = where(base <= 0.0, MOST_DECAY / max(x, TINY), solved)
    factor = where(x <= 0.0, exp(-m * log_u), factor)
    return where(n == 1.0, 1.0, factor)


@inner
def apply_order(x, j, end, u, network):
    """Bring x of the reactions j to end of one reactant to their orders; u is its m/m_formed.

    Several reactions of one reactant take u^(order - 1) at the middle of the step.
    """
    some = u > 0.0
    u = where(some, u, 1.0)
    if end == j + 1:
        x[j] *= where(some, order_factor(u, x[j], network.order[j]), 1.0)
        return
    fall = 0.0 * u
    for a in range(j, end):
        fall += x[a] * power(u, network.order[a] - 1.0)
    middle = u * exp(-0.5 * min(fall, 100.0))
    for a in range(j, end):
        x[a] *= where(some, power(middle, network.order[a] - 1.0), 1.0)


@inner
def react(m, formed, n, x, network, exact, m_new, used):
    """Advance the masses of cell n by dm_i/dt = sum_j (nu_ji - delta_i,i(j)) r_j over one step.

    ``m`` and ``m_new`` [kg/m2] have shape (components, cells); ``formed``, same shape, is the mass
    ever present, the reference of reaction order; ``x[j]`` is the integral of k_j over the step;
    ``used[j]`` becomes the mass consumed by each reaction. What earlier reactions form during the
    step decays with phi.
    """
    for i in range(m.shape[0]):
        m_new[i, n] = m[i, n]
    for j in range(x.shape[0]):
        if network.plain:
            consume_alone(m, n, j, x, network, exact, m_new, used)
        elif j == 0 or network.reactant[j] != network.reactant[j - 1]:
            end = j + 1
            while end < x.shape[0] and network.reactant[end] == network.reactant[j]:
                end += 1
            consume(m, formed, n, j, end, x, network, exact, m_new, used)


@inner
def consume_alone(m, n, j, x, network, exact, m_new, used):
    """Let reaction j consume its reactant, in a network in which nothing else touches that.

    Rounds as `consume`, so that a reaction or component without effect changes no curve.
    """
    i = network.reactant[j]
    m_new[i, n], used[j] = remaining(m[i, n], x[j], exact)
    m_new[network.residue[j], n] += network.residue_yield[j] * used[j]


@inner
def remaining(m, x, exact):
    """Return what is left of a mass, and what is used."""
    e, _ = decay(x, exact)
    left = m * e
    left = where(left > LEAST_MASS, left, 0.0)
    return left, m - left


@inner
def consume(m, formed, n, j, end, x, network, exact, m_new, used):
    """Let reactions j to end, all of one reactant, consume it in cell n."""
    i = network.reactant[j]
    gained = m_new[i, n] - m[i, n]
    if not network.first_order:
        reference = formed[i, n] + 0.5 * gained
        u = (m[i, n] + 0.5 * gained) / max(reference, TINY)
        apply_order(x, j, end, where(reference > 0.0, u, 0.0), network)
    total = 0.0 * gained
    for a in range(j, end):
        total += x[a]
    e, phi = decay(total, exact)
    left = m[i, n] * e + gained * phi
    left = where(left > LEAST_MASS, left, 0.0)
    consumed = (m[i, n] - left) + gained
    m_new[i, n] = left
    for a in range(j, end):
        part = consumed
        if end > j + 1:
            part = where(total > 0.0, consumed * (x[a] / max(total, TINY)), 0.0)
        used[a] = part
        for b in range(m.shape[0]):
            if somewhere(network.yields[a, b] != 0.0):
                m_new[b, n] += network.yields[a, b] * part
