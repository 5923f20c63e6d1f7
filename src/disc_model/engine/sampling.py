"""Uniform samples from the dense output.

A sample at an event shows the side before it.  The time of an event is rounded, and differently on another way to the
same event. A sample is therefore "at" an event up to `SAME_INSTANT` of the clock after it.
"""

import math

from . import layout
from .dense_output import force_at, move_to
from .jit import helper
from .transitions import disc_point

# Columns of a row of samples.
ROW = ("sampler", "time", "P", "u", "u_velocity", "w", "w_point", "w_point_velocity", "psi", "psi_velocity", "phase")

# Of the clock: 256 units of rounding.  A release found by the series is rounded at each step, and deviates by up to 80
# such units within 400 steps.
SAME_INSTANT = 256 * 2.0**-52


@helper
def point_motion(model, state, angle):
    """Displacement and velocity of the disc's point (r_0, slider's angle + ``angle``)."""
    w, velocity = 0.0, 0.0
    for j in range(len(model.shift)):
        if j % layout.WIDTH < layout.HALF:
            turn = model.shift[j] * angle
            cosine, sine = math.cos(turn), math.sin(turn)
            w += model.mode_amplitude[j] * (state.z[j] * cosine + state.z[j + layout.HALF] * sine)
            velocity += model.mode_amplitude[j] * (state.e[j] * cosine + state.e[j + layout.HALF] * sine)
    for j in range(len(model.mode_amplitude0)):
        w += model.mode_amplitude0[j] * state.y[j]
        velocity += model.mode_amplitude0[j] * state.g[j]
    return w, velocity


@helper
def _write_row(model, s, order, x, time, phase, theta, probe, row):
    move_to(model, s, order, x, phase, probe)
    w, velocity, _ = disc_point(model, probe)
    angle = theta - (layout.drive_angle(model, time) - probe.x[layout.PSI])
    row[1] = time
    row[2] = force_at(model, s, order, phase, probe)
    row[3], row[4], row[5] = w, velocity, w
    if model.compliant or phase == layout.SEPARATION:
        row[3], row[4] = probe.x[layout.U], probe.x[layout.U_VELOCITY]
    row[6], row[7] = point_motion(model, probe, angle)
    row[8] = probe.x[layout.PSI]
    row[9] = layout.drive_now(model, probe) - probe.x[layout.F]
    row[10] = phase


@helper
def sample_step(model, s, order, state, x_end, samplers, progress, probe, rows, filled):
    """Append a row for every sample time within the step that starts at ``state`` and lasts ``x_end`` units.

    A sample at the end of the step, to rounding, belongs to this step: at an event it shows the side before. samplers:
    shape (n, 5), columns first time, interval, number of samples, theta, end of run; progress: shape (n,), samples
    taken so far; rows: shape (capacity, len(ROW)).  Returns the number of rows filled.
    """
    start, low = state.x[layout.TIME], state.x[layout.TIME_LOW]
    last = x_end + SAME_INSTANT * (start / model.unit + x_end + 1.0)
    for i in range(len(samplers)):
        while progress[i] < samplers[i, 2]:
            # the last sample may lie a rounding error behind the end of the run
            time = min(samplers[i, 0] + progress[i] * samplers[i, 1], samplers[i, 4])
            x = ((time - start) - low) / model.unit
            if x > last:
                break
            rows[filled, 0] = i
            _write_row(model, s, order, max(x, 0.0), time, state.x[layout.PHASE], samplers[i, 3], probe, rows[filled])
            filled += 1
            progress[i] += 1
    return filled
