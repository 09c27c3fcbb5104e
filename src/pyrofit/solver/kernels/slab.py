"""One-dimensional pyrolysing slab: Lagrangian cells, BDF2, error-controlled steps.

Every cell keeps its masses m_i [kg/m2] and its temperature T. A step from t to t + dt
1. extrapolates T linearly to T*, and takes the rates k_j(T*) with the in-cell factor sinh(s)/s;
2. predicts the masses with the trapezoidal integral of k_j;
3. solves C dT/dt = conduction + radiation - sum_j dh_j r_j for T, implicitly, the reaction heat
   linearised about T* (one tridiagonal solve, surface and foil included);
4. corrects the rates and masses with the T found.
The difference between predicted and corrected mass loss rate controls dt. A cell whose reactant is
gone and whose residue is thin leaves the grid and becomes part of the skin: a resistance in front
of, and a heat capacity on, the first live cell.
"""

import math

import numpy as np
from numba import njit

from pyrofit.constants import STEFAN_BOLTZMANN
from pyrofit.solver.arrays import TABLE_SIZE, TABLE_START_K, TABLE_STEP_K, Status
from pyrofit.solver.kernels.reactions import react

SIGMA = STEFAN_BOLTZMANN
GASIFICATION_SCALE = 2.0e6
"""Heat of gasification [J/kg] that turns the flux into a scale of the mass loss rate."""
LEAST_FLUX_SCALE = 5.0e3
"""[W/m2]; keeps that scale above zero without external flux."""
TEMPERATURE_SCALE = 400.0
"""Surface temperature error [K] that counts as much as an error of the whole rate scale."""
SAFETY = 0.9
SHRINK, GROW, REJECT = 0.3, 1.6, 0.5
DEAD_FRACTION = 1.0e-7
"""Reactant left, relative to the cell's initial mass, below which a cell may leave the grid."""
THIN_FRACTION = 0.01
"""Residue thickness, relative to the cell's initial one, below which a cell may leave the grid."""
BURNT_FRACTION = 1.0e-5
"""Reactant left in the sample, relative to its initial mass, at which it counts as burnt out."""
LEAST_RESISTANCE = 1.0e-9
"""[m2 K/W]; keeps vanished cells from dividing by zero."""

OK, UNBURNT, DIVERGED = int(Status.OK), int(Status.UNBURNT), int(Status.DIVERGED)
NON_FINITE, TOO_MANY_STEPS = int(Status.NON_FINITE), int(Status.TOO_MANY_STEPS)

jit = njit(cache=True, error_model="numpy", forceinline=True, _nrt=False)


@jit
def at_temperature(table, i, T):
    """Return property i at T, linear between the table's nodes; one column = constant."""
    if table.shape[1] == 1:
        return table[i, 0]
    x = (min(max(T, 210.0), 1590.0) - TABLE_START_K) / TABLE_STEP_K
    p = min(int(x), TABLE_SIZE - 2)
    return table[i, p] + (x - p) * (table[i, p + 1] - table[i, p])


@jit
def flux_at(t, p, time, flux):
    """Return q_ext(t) on piece p of the flux table."""
    if p >= time.size - 1:
        return flux[time.size - 1]
    if t <= time[p]:
        return flux[p]
    return flux[p] + (flux[p + 1] - flux[p]) * (t - time[p]) / (time[p + 1] - time[p])


@jit
def exchange(surface, emissivity, T):
    """Linearise the loss of a surface about T: net gain = constant - slope * T_new [W/m2]."""
    dT = T - surface.gas_temperature
    h = surface.h + surface.h_cube_root * abs(dT) ** (1.0 / 3.0)
    cube = T * T * T
    slope = 4.0 * emissivity * SIGMA * cube + h
    wall = surface.wall_temperature
    gain = emissivity * SIGMA * (wall * wall * wall * wall - cube * T) - h * dT + slope * T
    return gain, slope


@jit
def layer(m, n, material, T):
    """Return thickness d [m], resistance d/k [m2 K/W] and capacity [J/(m2 K)] of cell n.

    k is mixed by volume, c by mass.
    """
    d = 0.0
    k = 0.0
    c = 0.0
    for i in range(m.shape[1]):
        v = m[n, i] * material.specific_volume[i]
        d += v
        k += v * at_temperature(material.conductivity, i, T)
        c += m[n, i] * at_temperature(material.specific_heat, i, T)
    return d, (d * d / k if k > 0.0 else 0.0), c


@jit
def optical_depth(m, n, material):
    """Return kappa d [-] of cell n, the absorption coefficient mixed by volume."""
    optical = 0.0
    for i in range(m.shape[1]):
        optical += m[n, i] * material.specific_volume[i] * material.absorption[i]
    return optical


@jit
def top_emissivity(depth, skin, m, first, material, before):
    """Return the volume-averaged emissivity of the top ``depth`` of the current sample."""
    z = 0.0
    total = 0.0
    for n in range(first - 1, m.shape[0]):
        d = 0.0
        e = 0.0
        for i in range(m.shape[1]):
            v = (skin[0, i] if n < first else m[n, i]) * material.specific_volume[i]
            d += v
            e += v * material.emissivity[i]
        if d > 0.0:
            share = min(1.0, (depth - z) / d)
            total += share * e
            z += share * d
            if share < 1.0:
                break
    return total / z if z > 0.0 else before


@jit
def temperature_fall(n, first, T, surface, foil, d):
    """Return half the temperature difference across cell n [K]."""
    if n == first:
        return surface - T[n]
    if n == T.size - 1:
        below = foil
        span = 0.5 * d[n - 1] + d[n]
    else:
        below = T[n + 1]
        span = 0.5 * (d[n - 1] + d[n + 1]) + d[n]
    return 0.5 * (T[n - 1] - below) * d[n] / span if span > 0.0 else 0.0


@jit
def cell_rates(n, inverse_T, half, network, k):
    """Fill k_j [1/s] of cell n, averaged over a linear temperature profile in the cell.

    The mean of exp(b x) over |x| <= half is sinh(s)/s with s = b half, b = E/(R T^2); its series is
    cut after s^4.
    """
    for j in range(k.shape[1]):
        e = network.activation_temperature[j] * inverse_T
        s = e * half * inverse_T
        s2 = min(s * s, 9.0)
        factor = 1.0 + s2 * (1.0 / 6.0 + s2 * (1.0 / 120.0))
        k[n, j] = network.rate_factor[j] * math.exp(-e) * factor


@jit
def mean_rate(a, b):
    """Return the mean of a rate that grows exponentially from a to b over the step.

    The logarithmic mean (b - a)/ln(b/a), to fourth order in ln(b/a): (2 sqrt(a b) + (a + b)/2)/3.
    """
    return (2.0 / 3.0) * math.sqrt(a * b) + (1.0 / 6.0) * (a + b)


@jit
def mean_rate_slope(a, b):
    """Return the derivative of that mean with respect to b."""
    return (1.0 / 3.0) * math.sqrt(a / b) + 1.0 / 6.0 if b > 0.0 else 0.5


@jit
def mass_rate(n, j, k, m, formed, network):
    """Return r_j of cell n [kg/(m2 s)]."""
    i = network.reactant[j]
    r = k[n, j] * m[n, i]
    if not network.first_order and network.order[j] != 1.0 and m[n, i] > 0.0:
        r *= (m[n, i] / formed[n, i]) ** (network.order[j] - 1.0)
    return r


@jit
def reactant_left(m, n, network):
    """Return the mass of cell n that can still react [kg/m2]."""
    left = 0.0
    for j in range(network.reactant.size):
        if j == 0 or network.reactant[j] != network.reactant[j - 1]:
            left += m[n, network.reactant[j]]
    return left


@jit
def probe_temperature(position, T, first, front, back):
    """Return T at a Lagrangian position (in cells from the front), linear between centres."""
    cells = T.size
    x = position - 0.5
    low = math.floor(x)
    if low < first:
        if x + 0.5 <= first:
            return front
        return front + (T[first] - front) * (x - first + 0.5) / 0.5
    if low >= cells - 1:
        return T[cells - 1] + (back - T[cells - 1]) * (x - cells + 1.0) / 0.5
    return T[low] + (x - low) * (T[low + 1] - T[low])


@njit(cache=True, error_model="numpy", _nrt=False)
def march(
    start,
    T_start,
    material,
    network,
    exposure,
    numerics,
    t_end,
    stop_when_burnt,
    probes,
    out,
    probe_out,
    m,
    m_new,
    formed,
    k_old,
    k_new,
    used,
    x,
    T,
    T_old,
    T_new,
    T_star,
    C,
    C_old,
    d,
    d0,
    half_r,
    source,
    up,
    right,
    heat_old,
    skin,
):
    """March in time."""
    cells, components = start.shape
    reactions = network.reactant.size
    most = numerics.most_steps
    mass0 = 0.0
    thickness = 0.0
    for n in range(cells):
        d0[n], _, C_old[n] = layer(start, n, material, T_start)
        d[n] = d0[n]
        thickness += d0[n]
        for i in range(components):
            mass0 += start[n, i]
        for j in range(reactions):
            E = network.activation_temperature[j]
            k_old[n, j] = network.rate_factor[j] * math.exp(-E / T_start)
    in_depth = False
    for i in range(components):
        in_depth = in_depth or material.absorption[i] > 0.0

    front = T_start
    front_old = T_start
    foil = T_start
    foil_old = T_start
    first = 0
    eps = top_emissivity(exposure.mixing_depth, skin, m, first, material, 1.0)
    rate_scale = max(LEAST_FLUX_SCALE, exposure.flux[0]) / GASIFICATION_SCALE
    piece = 0
    while piece + 1 < exposure.flux_time.size and exposure.flux_time[piece + 1] <= 0.0:
        piece += 1

    t = 0.0
    released = 0.0
    heat_in = 0.0
    heat_crossed = 0.0
    heat_used = 0.0
    q_net_old = 0.0
    dt = numerics.first_step
    dt_old = dt
    restart = True
    status = UNBURNT
    steps = 0
    out[0, 0] = 0.0
    out[1, 0] = 0.0
    out[2, 0] = 0.0
    out[3, 0] = T_start
    out[4, 0] = T_start
    out[5, 0] = thickness
    for a in range(probes.size):
        probe_out[0, a] = T_start
    tries = 0
    while t < t_end - 1e-9:
        if steps >= most or tries >= 2 * most:
            status = TOO_MANY_STEPS
            break
        tries += 1
        landing = t_end
        has_break = piece + 1 < exposure.flux_time.size
        if has_break and exposure.flux_time[piece + 1] < landing:
            landing = exposure.flux_time[piece + 1]
        lands = t + dt * (1.0 + 1e-9) >= landing
        if lands:
            dt = landing - t
        r = 0.0 if restart else dt / dt_old
        b1 = (1.0 + 2.0 * r) / (1.0 + r) / dt
        b2 = (1.0 + r) / dt
        b3 = r * r / (1.0 + r) / dt

        # 1, 2: extrapolate, rates, predicted masses
        front_star = front + r * (front - front_old)
        foil_star = foil + r * (foil - foil_old)
        for n in range(first, cells):
            T_star[n] = T[n] + r * (T[n] - T_old[n])
        for n in range(first, cells):
            half_r[n] = temperature_fall(n, first, T_star, front_star, foil_star, d)
        predicted = 0.0
        for n in range(first, cells):
            Tn = min(max(T_star[n], 200.0), 2000.0)
            inverse_T = 1.0 / Tn
            cell_rates(n, inverse_T, half_r[n], network, k_new)
            for j in range(reactions):
                x[j] = dt * mean_rate(k_old[n, j], k_new[n, j])
            react(m, formed, n, x, network, False, m_new, used)
            d[n], resistance, C[n] = layer(m_new, n, material, Tn)
            half_r[n] = 0.5 * resistance + LEAST_RESISTANCE
            sink = -b3 * heat_old[n]
            slope = 0.0
            for j in range(reactions):
                r_j = mass_rate(n, j, k_new, m_new, formed, network)
                predicted += network.gas[j] * r_j
                sink += b1 * network.heat[j] * used[n, j]
                share = mean_rate_slope(k_old[n, j], k_new[n, j]) * dt * b1
                slope += share * network.heat[j] * r_j * network.activation_temperature[j]
            slope *= inverse_T * inverse_T
            source[n] = slope * T_star[n] - sink
            up[n] = slope
        d_skin, r_skin, C_skin = layer(skin, 0, material, front_star)
        C[first] += C_skin
        lead = half_r[first] + r_skin

        # 3: surface, tridiagonal solve, foil
        q = flux_at(t + dt, piece, exposure.flux_time, exposure.flux)
        eps = top_emissivity(exposure.mixing_depth, skin, m_new, first, material, eps)
        gain, slope_front = exchange(exposure.front, eps, front_star)
        transmitted = 0.0
        if in_depth:
            transmitted = eps * q
            for n in range(first - 1, cells):
                if n < first:
                    optical = optical_depth(skin, 0, material)
                else:
                    optical = optical_depth(m_new, n, material)
                passed = transmitted * math.exp(-optical)
                source[max(n, first)] += transmitted - passed
                transmitted = passed
        else:
            gain += eps * q
        couple = 1.0 / (1.0 + slope_front * lead)
        g_up = slope_front * couple
        carried = gain * couple
        upper = 0.0
        for n in range(first, cells):
            g_down = 1.0 / (half_r[n] + (half_r[n + 1] if n < cells - 1 else 0.0))
            diagonal = C[n] * b1 + up[n] + g_down + g_up * (1.0 - upper)
            rhs = C[n] * (b2 * T[n] - b3 * T_old[n]) + source[n] + carried
            inverse = 1.0 / diagonal
            up[n] = g_down * inverse
            right[n] = rhs * inverse
            g_up = g_down
            upper = up[n]
            carried = right[n] * g_down
        gain_back, slope_back = exchange(exposure.back, exposure.back_emissivity, foil_star)
        if exposure.foil_opaque:
            gain_back += transmitted
        Cf = exposure.foil_capacity
        foil_new = (Cf * (b2 * foil - b3 * foil_old) + gain_back + carried) / (
            Cf * b1 + slope_back + g_up * (1.0 - upper)
        )

        # 4: temperatures from the back, corrected rates and masses
        below = foil_new
        corrected = 0.0
        gas_step = 0.0
        used_step = 0.0
        stored_step = Cf * (foil_new - foil)
        coldest = foil_new
        hottest = foil_new
        for n in range(cells - 1, first - 1, -1):
            below = right[n] + up[n] * below
            T_new[n] = below
            coldest = min(coldest, below)
            hottest = max(hottest, below)
            stored_step += mean_rate(C_old[n], C[n]) * (below - T[n])
            Tn = min(max(T_star[n], 200.0), 2000.0)
            change = min(max(below - T_star[n], -20.0), 20.0) / (Tn * Tn)
            for j in range(reactions):
                y = network.activation_temperature[j] * change
                k_new[n, j] *= 1.0 + y * (1.0 + 0.5 * y)
                x[j] = dt * mean_rate(k_old[n, j], k_new[n, j])
            react(m, formed, n, x, network, False, m_new, used)
            for j in range(reactions):
                gas_step += network.gas[j] * used[n, j]
                used_step += network.heat[j] * used[n, j]
                corrected += network.gas[j] * mass_rate(n, j, k_new, m_new, formed, network)
        front_new = (gain * lead + T_new[first]) * couple
        coldest = min(coldest, front_new)
        hottest = max(hottest, front_new)
        if not (coldest > 50.0 and hottest < 5000.0):
            status = DIVERGED if math.isfinite(coldest + hottest) else NON_FINITE
            break

        error = abs(corrected - predicted) / rate_scale
        error = max(error, abs(front_new - front_star) / TEMPERATURE_SCALE)
        error = max(error, abs(foil_new - foil_star) / TEMPERATURE_SCALE)
        ratio = SAFETY * math.sqrt(numerics.tolerance / (error + 1e-30))
        if ratio < REJECT and dt > 1.001 * numerics.first_step:
            dt = max(dt * max(ratio, SHRINK), numerics.first_step)
            continue

        # accept
        steps += 1
        t = landing if lands else t + dt
        released += gas_step
        q_net = gain - slope_front * front_new + gain_back - slope_back * foil_new
        if in_depth:
            q_net += eps * q - transmitted
        if steps == 1:
            q_net_old = q_net
        heat_in += 0.5 * dt * (q_net + q_net_old)
        heat_crossed += 0.5 * dt * abs(q_net + q_net_old)
        heat_used += stored_step + used_step
        q_net_old = q_net
        for n in range(first, cells):
            C_old[n] = C[n]
            heat_old[n] = 0.0
            for j in range(reactions):
                heat_old[n] += network.heat[j] * used[n, j]
            if not network.first_order:
                for j in range(reactions):
                    for i in range(components):
                        formed[n, i] += network.yields[j, i] * used[n, j]
        m, m_new = m_new, m
        k_old, k_new = k_new, k_old
        T_old, T, T_new = T, T_new, T_old
        front_old, front = front, front_new
        foil_old, foil = foil, foil_new
        thickness = d_skin
        left = 0.0
        for n in range(first, cells):
            thickness += d[n]
            left += reactant_left(m, n, network)
        while first < cells - 1:
            total = 0.0
            for i in range(components):
                total += start[first, i]
            gone = reactant_left(m, first, network) < DEAD_FRACTION * total
            if not gone or reactions == 0 or d[first] > THIN_FRACTION * d0[first]:
                break
            for i in range(components):
                skin[0, i] += m[first, i]
            C_old[first + 1] += C_old[first]
            heat_used += C_old[first] * (T[first + 1] - T[first])
            first += 1

        out[0, steps] = t
        out[1, steps] = released
        out[2, steps] = corrected
        out[3, steps] = front
        out[4, steps] = foil
        out[5, steps] = thickness
        for a in range(probes.size):
            probe_out[steps, a] = probe_temperature(probes[a], T, first, front, foil)

        if status == UNBURNT and left <= BURNT_FRACTION * mass0:
            status = OK
            if stop_when_burnt:
                break
        restart = False
        dt_old = dt
        dt = min(dt * min(ratio, GROW), numerics.longest_step)
        if lands and t < t_end - 1e-9:
            while piece + 1 < exposure.flux_time.size and exposure.flux_time[piece + 1] <= t:
                piece += 1
            restart = True
            dt = numerics.first_step

    mass = skin.sum()
    for n in range(first, cells):
        for i in range(components):
            mass += m[n, i]
    energy_error = abs(heat_in - heat_used) / heat_crossed if heat_crossed > 0.0 else 0.0
    mass_error = abs(mass + released - mass0) / mass0
    return status, steps, energy_error, mass_error


@njit(cache=True, error_model="numpy")
def slab(start, T_start, material, network, exposure, numerics, t_end, stop_when_burnt, probes):
    """Run one sample under one exposure.

    Parameters
    ----------
    start : initial masses of the cells [kg/m2], shape (cells, components), front first.
    T_start : initial temperature [K].
    material, network, exposure, numerics : see `pyrofit.solver.arrays`.
    t_end : end of the run [s].
    stop_when_burnt : end as soon as the reactant is gone.
    probes : Lagrangian positions (in cells) of temperature probes, shape (probes,).

    Returns
    -------
    status, steps, time, released, rate, front, back, thickness, probe temperatures, energy error
    (imbalance relative to the heat that crossed the surfaces), mass error (relative).
    """
    cells, components = start.shape
    reactions = network.reactant.size
    most = numerics.most_steps
    out = np.empty((6, most + 1))
    probe_out = np.empty((most + 1, probes.size))

    m = start.copy()
    m_new = start.copy()
    formed = start.copy()
    k_old = np.zeros((cells, reactions))
    k_new = np.zeros((cells, reactions))
    used = np.zeros((cells, reactions))
    x = np.empty(reactions)
    T = np.full(cells, T_start)
    T_old = np.full(cells, T_start)
    T_new = np.full(cells, T_start)
    T_star = np.full(cells, T_start)
    C = np.empty(cells)
    C_old = np.empty(cells)
    d = np.empty(cells)
    d0 = np.empty(cells)
    half_r = np.empty(cells)
    source = np.empty(cells)
    up = np.empty(cells)
    right = np.empty(cells)
    heat_old = np.zeros(cells)
    skin = np.zeros((1, components))
    end = march(
        start,
        T_start,
        material,
        network,
        exposure,
        numerics,
        t_end,
        stop_when_burnt,
        probes,
        out,
        probe_out,
        m,
        m_new,
        formed,
        k_old,
        k_new,
        used,
        x,
        T,
        T_old,
        T_new,
        T_star,
        C,
        C_old,
        d,
        d0,
        half_r,
        source,
        up,
        right,
        heat_old,
        skin,
    )
    status, steps, energy_error, mass_error = end
    return (
        status,
        steps,
        out[0, : steps + 1],
        out[1, : steps + 1],
        out[2, : steps + 1],
        out[3, : steps + 1],
        out[4, : steps + 1],
        out[5, : steps + 1],
        probe_out[: steps + 1],
        energy_error,
        mass_error,
    )
