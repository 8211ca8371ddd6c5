"""A calm CoM."""

import numpy as np

from quadlab.planners.vertex_zmp.fast.model import ReducedModel
from quadlab.planners.vertex_zmp.fast.rows import Rows, on_both_axes


def com_acceleration(model: ReducedModel) -> Rows:
    """Return rows whose squares add up to the squared acceleration of the CoM over time, in [m^2/s^3].

    J = int ||c_ddot||^2 dt. Under a linear CoP the acceleration a(t) itself satisfies a_ddot = w^2 a, so its end values
    determine it: J = I (a_0^2 + a_1^2) + 2 K a_0 a_1 = I (a_0 + K / I a_1)^2 + (I - K^2 / I) a_1^2 with
    I = int (sinh(w t) / sinh(w T))^2 dt and K = int sinh(w t) sinh(w (T - t)) / sinh(w T)^2 dt.
    Addition to Winkler 2017: with J_lambda alone a slow walk hurries from one support centre to the next.
    """
    count, rate, length = model.grid.count, model.spline.rate, model.grid.durations_s
    angle = rate * length
    scale = 2.0 * rate * np.sinh(angle) ** 2
    equal = (np.sinh(angle) * np.cosh(angle) - angle) / scale
    mixed = (angle * np.cosh(angle) - np.sinh(angle)) / scale
    intervals = np.arange(count)
    start, end = (model.spline.weights(intervals, np.full(count, fraction), 2) for fraction in (0.0, 1.0))
    first = np.sqrt(equal)[:, None] * (start + (mixed / equal)[:, None] * end)
    second = np.sqrt(equal - mixed**2 / equal)[:, None] * end
    columns = model.knot_columns(intervals)
    both = on_both_axes(np.concatenate([columns, columns]), np.concatenate([first, second]))
    return Rows("com_acceleration", *both, np.zeros(len(both[0])))
