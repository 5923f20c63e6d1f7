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
    along = disc.along
    pending = disc.pending
    surface = surface_velocity(model, series)
    series.surface[0] = surface
    for k in range(order + 1):
        f = series.f[k]
        u = series.u[k]
        v = series.v[k]
        if k > 0:
            pairs, _, pending = next_turning(model, series, k, f, 0.0, 0.0, pending)
            if model.has_moving_surface:
                along = total(pairs.along) + f * disc.along_by_f
        series.switch[k] = u - deflection(model, series, k)
        series.P[k] = 0.0

        # the slider
        up = series.up[k]
        lag = series.drive[k] - f
        if model.has_moving_surface:
            lag -= surface / model.r_0
            series.turn[k + 1] = surface / model.r_0 * up
            surface = along * up
            series.surface[k + 1] = surface
        pull = model.k_p * series.psi[k] + model.c_p * lag
        if model.has_moving_surface:
            pull -= model.m / model.r_0 * along
        vertical = series.preload[k] + model.k * u + model.c * v
        series.psi[k + 1] = lag * up
        series.f[k + 1] = pull * lightness * up
        series.u[k + 1] = v * up
        series.v[k + 1] = -vertical * lightness * up
