"""Mass change of a cell by its reactions over one time step."""

from pyrofit.compiled.jit import inner
from pyrofit.solver.kernels.functions import exp, fma, log, nearly_inverse, power
from pyrofit.solver.kernels.lanes import somewhere, where

MOST_DECAY = 700.0
"""k dt beyond which the exact form leaves nothing."""
MOST_PADE = 1e60
"""The same for the Padé form."""
LEAST_MASS = 1.0e-200
"""[kg/m2]; less is nothing: the processor is slow with the numbers next to zero."""
TINY = 1.0e-300
NEAR = 0.4
"""Share |y| of u^(1-n) up to which the series of ln(1 - y) is good to 2e-11."""
LEAST_LEFT = 1.0e-17
"""Less of u^(1-n) than rounding leaves."""


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
    e = 1.0 / fma(x, tail, 1.0)
    return e, e * tail


@inner
def power_of_share(m, ever, n):
    """Return u^(n-1), u = m over the mass ``ever`` present; 1 where nothing is present."""
    u = m / max(ever, TINY)
    return power(where(u > 0.0, u, 1.0), n - 1.0)


@inner
def order_factors(held, x, n):
    """Return the factors that bring x = k dt of one reaction, and k behind the step, to order n.

    ``held`` is u^(n-1) at the start of the step.

    du/dt = -k u^n is solved exactly: u_new^(1-n) = u^(1-n) (1 - y), y = (1 - n) x u^(n-1). That is
    first order with x u^(n-1) (-ln(1 - y)/y), and u_new^(n-1) = u^(n-1)/(1 - y).
    """
    y = (1.0 - n) * x * held
    far = abs(y) > NEAR
    near = where(far, 0.0, y)
    # -ln(1 - y) = 2 artanh(s), the series cut after s^15.
    part = nearly_inverse(2.0 - near)
    s = near * part
    q = s * s
    p = fma(q, fma(q, fma(q, 1.0 / 15.0, 1.0 / 13.0), 1.0 / 11.0), 1.0 / 9.0)
    p = fma(q, fma(q, fma(q, fma(q, p, 1.0 / 7.0), 1.0 / 5.0), 1.0 / 3.0), 1.0)
    factor = 2.0 * held * part * p
    if somewhere(far):
        exact = -held * log(max(1.0 - y, TINY)) / where(far, y, 1.0)
        factor = where(far, where(y < 1.0, exact, MOST_DECAY / max(x, TINY)), factor)
    behind = where(y < 1.0, held / max(1.0 - y, LEAST_LEFT), 0.0)
    plain = n == 1.0
    return where(plain, 1.0, factor), where(plain, 1.0, behind)


@inner
def ordered(m, held, x, n):
    """Return x = k dt of a mass m brought to order n, and the factor of k at the end of the step.

    ``held`` is `power_of_share`.
    """
    factor, behind = order_factors(held, x, n)
    return where(m > 0.0, x * factor, x), behind


@inner
def catalysed(m, ever, x, n, K):
    """Return x = k dt of a mass m with autocatalysis, and the factor of k at the end of the step.

    With u^(n-1) of the middle of the step in x, du/dx = -u (1 + K (1 - u)) is solved exactly:
    u_new = u (1 + K) q/(K u q + c), q = exp(-(1 + K) x), c = 1 + K (1 - u).
    """
    u = where(m > 0.0, min(m / max(ever, TINY), 1.0), 1.0)
    whole, c = 1.0 + K, 1.0 + K * (1.0 - u)
    if somewhere(n != 1.0):
        fall = x * c * power(u, n - 1.0)
        x = where(n == 1.0, x, x * power(u * exp(-0.5 * min(fall, 100.0)), n - 1.0))
    q = exp(-min(whole * x, MOST_DECAY))
    part = (K * u * q + c) / whole
    left = u * q / part
    behind = 1.0 + K * (1.0 - left)
    if somewhere(n != 1.0):
        behind = where(n == 1.0, behind, behind * power(max(left, TINY), n - 1.0))
    return max(whole * x + log(part), 0.0), behind


@inner
def brought(m, ever, held, x, j, network):
    """Return `ordered` of reaction j, or `catalysed` where it is so."""
    n = network.order[j]
    slower, behind = ordered(m, held, x, n)
    if network.catalysed:
        K = network.catalysis[j]
        faster, of_end = catalysed(m, ever, x, n, K)
        slower, behind = where(K > 0.0, faster, slower), where(K > 0.0, of_end, behind)
    return slower, behind


@inner
def quickening(u, j, network):
    """Return 1 + K (1 - u) of reaction j."""
    return 1.0 + network.catalysis[j] * (1.0 - min(u, 1.0))


@inner
def bring_to_order(m, ever, j, end, room, network):
    """Bring x of the reactions j to end, all of one reactant, to their orders."""
    if end > j + 1:
        order_several(m, ever, j, end, room, network)
        return
    room.behind[j] = 1.0
    if is_curved(network, j):
        held = power_of_share(m, ever, network.order[j])
        room.x[j], room.behind[j] = brought(m, ever, held, room.x[j], j, network)


@inner
def order_several(m, ever, j, end, room, network):
    """Do that for more than one, at the middle of the step."""
    u = m / max(ever, TINY)
    some = u > 0.0
    u = where(some, u, 1.0)
    fall = 0.0 * u
    for a in range(j, end):
        fall += room.x[a] * factor_at(u, a, network)
    middle = u * exp(-0.5 * min(fall, 100.0))
    for a in range(j, end):
        room.x[a] *= where(some, factor_at(middle, a, network), 1.0)


@inner
def factor_at(u, j, network):
    """Return u^(n-1) (1 + K (1 - u)) of reaction j."""
    factor = power(u, network.order[j] - 1.0)
    if network.catalysed:
        factor = factor * quickening(u, j, network)
    return factor


@inner
def react(m, formed, n, room, network, exact, m_new):
    """Advance the masses of cell n by dm_i/dt = sum_j (nu_ji - delta_i,i(j)) r_j over one step.

    ``m`` and ``m_new`` [kg/m2] have shape (components, cells); ``formed``, same shape, is the mass
    ever present, the reference of reaction order. Of the room, ``x[j]`` is the integral of k_j over
    the step, and becomes that of k_j u^(n-1). ``used[j]`` becomes the mass consumed by each
    reaction, ``behind[j]`` the factor of its order on k_j at the end. Mass that earlier reactions
    form during the step decays with phi.
    """
    for i in range(m.shape[0]):
        m_new[i, n] = m[i, n]
    for j in range(network.reactant.size):
        if network.plain:
            consume_alone(m, formed, n, j, room, network, exact, m_new)
        elif j == 0 or network.reactant[j] != network.reactant[j - 1]:
            end = j + 1
            while end < network.reactant.size and network.reactant[end] == network.reactant[j]:
                end += 1
            consume(m, formed, n, j, end, room, network, exact, m_new)


@inner
def consume_alone(m, formed, n, j, room, network, exact, m_new):
    """Let reaction j consume its reactant, in a network in which nothing else touches that.

    Rounds as `consume`, so that a reaction or component without effect changes no curve.
    """
    i = network.reactant[j]
    room.behind[j] = 1.0
    curved = is_curved(network, j)
    if curved:
        held = power_of_share(m[i, n], formed[i, n], network.order[j])
        ever = formed[i, n]
        room.x[j], room.behind[j] = brought(m[i, n], ever, held, room.x[j], j, network)
    e, _ = decay_of_order(room.x[j], network.order[j], curved, exact)
    m_new[i, n], room.used[j] = remaining(m[i, n], e)
    residue = network.residue[j]
    m_new[residue, n] = fma(network.residue_yield[j], room.used[j], m_new[residue, n])


@inner
def is_curved(network, j):
    """Tell whether reaction j is of another order than the first, or catalysed, in some lane."""
    if network.first_order:
        return False
    if network.catalysed and somewhere(network.catalysis[j] != 0.0):
        return True
    return somewhere(network.order[j] != 1.0)


@inner
def decay_of_order(x, n, curved, exact):
    """Return `decay`: exact where the order is not the first, as its closed form is."""
    if not curved or exact:
        return decay(x, exact)
    e, phi = decay(x, True)
    if somewhere(n == 1.0):
        e_first, phi_first = decay(x, False)
        e, phi = where(n == 1.0, e_first, e), where(n == 1.0, phi_first, phi)
    return e, phi


@inner
def remaining(m, e):
    """Return the part of a mass that is left, and the part used."""
    left = m * e
    left = where(left > LEAST_MASS, left, 0.0)
    return left, m - left


@inner
def consume(m, formed, n, j, end, room, network, exact, m_new):
    """Let reactions j to end, all of one reactant, consume it in cell n."""
    i = network.reactant[j]
    gained = m_new[i, n] - m[i, n]
    if not network.first_order:
        middle, ever = m[i, n] + 0.5 * gained, formed[i, n] + 0.5 * gained
        bring_to_order(middle, ever, j, end, room, network)
    total = 0.0 * gained
    for a in range(j, end):
        total += room.x[a]
    alone = end == j + 1
    e, phi = decay_of_order(total, network.order[j], alone and is_curved(network, j), exact)
    left = m[i, n] * e + gained * phi
    left = where(left > LEAST_MASS, left, 0.0)
    consumed = (m[i, n] - left) + gained
    m_new[i, n] = left
    if not (exact or network.first_order) and (somewhere(gained > 0.0) or not alone):
        mix_behind(left, formed[i, n] + gained, gained, j, end, room, network)
    for a in range(j, end):
        part = consumed
        if end > j + 1:
            part = where(total > 0.0, consumed * (room.x[a] / max(total, TINY)), 0.0)
        room.used[a] = part
        for b in range(m.shape[0]):
            if somewhere(network.yields[a, b] != 0.0):
                m_new[b, n] = fma(network.yields[a, b], part, m_new[b, n])


@inner
def mix_behind(left, ever, gained, j, end, room, network):
    """Fill the factor of k after the step for a reactant formed in it, or of several reactions."""
    u = where(left > 0.0, left / max(ever, TINY), 1.0)
    for a in range(j, end):
        mixed = factor_at(u, a, network)
        room.behind[a] = where((gained > 0.0) | (end > j + 1), mixed, room.behind[a])
