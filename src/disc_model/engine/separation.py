"""Taylor coefficients of separation (docs/model.md, Separation): disc and slider move
independently. The place of the material under the slider is followed, also where the surface
moves."""

from .jit import inlined
from .jit.simd import total
from .modes import begin_turning, deflection, next_turning, surface_velocity


@inlined
def separation_series(model, series, order):
    """Fill ``series``, whose coefficients 0 are given, up to degree ``order`` with separation, and
    the event function, the gap u - w; P is 0."""
    lightness = 1.0 / model.m
    disc = begin_turning(model, series)
    G = disc.along
    pending = disc.pending
    if model.has_moving_surface:
        series.slider[0] = series.f[0] + surface_velocity(model, series) / model.r_0
    for k in range(order + 1):
        f = series.f[k]
        u = series.u[k]
        v = series.v[k]
        if k > 0:
            pairs, _, pending = next_turning(model, series, k, f, 0.0, 0.0, pending)
            if model.has_moving_surface:
                G = total(pairs.along) + f * disc.along_by_f
        series.switch[k] = u - deflection(model, series, k)
        series.P[k] = 0.0

        # the slider
        up = series.up[k]
        slider = series.slider[k] if model.has_moving_surface else f
        lag = series.drive[k] - slider
        pull = model.k_p * series.psi[k] + model.c_p * lag
        rate = pull * lightness
        vertical = series.preload[k] + model.k * u + model.c * v
        series.psi[k + 1] = lag * up
        series.f[k + 1] = rate * up
        series.u[k + 1] = v * up
        series.v[k + 1] = -vertical * lightness * up
        if model.has_moving_surface:
            series.slider[k + 1] = rate * up
            series.f[k + 1] -= G / model.r_0 * up
            series.turn[k + 1] = (slider - f) * up
