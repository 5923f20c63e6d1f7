"""Taylor coefficients of separation (docs/model.md, Separation): disc and slider move
independently."""

from .jit import inlined
from .modes import begin_turning, deflection, next_turning


@inlined
def separation_series(model, series, order):
    """Fill ``series``, whose coefficients 0 are given, up to degree ``order`` with separation, and
    the event function, the gap u - w; P is 0."""
    lightness = 1.0 / model.m
    pending = begin_turning(model, series).pending
    for k in range(order + 1):
        f = series.f[k]
        u = series.u[k]
        v = series.v[k]
        if k > 0:
            _, _, pending = next_turning(model, series, k, f, 0.0, 0.0, pending)
        series.switch[k] = u - deflection(model, series, k)
        series.P[k] = 0.0

        # the slider
        up = series.up[k]
        turn = series.drive[k] - f
        pull = model.k_p * series.psi[k] + model.c_p * turn
        vertical = series.preload[k] + model.k * u + model.c * v
        series.psi[k + 1] = turn * up
        series.f[k + 1] = pull * lightness * up
        series.u[k + 1] = v * up
        series.v[k + 1] = -vertical * lightness * up
