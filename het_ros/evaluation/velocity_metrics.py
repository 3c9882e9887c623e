# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""How good a velocity is: against the truth's derivative, and against what needs no tracker.

All functions are pure. Velocities are (n, 2) px/s, a row a frame, NaN where there is none; ``dt``
is the time between two frames, s. Errors are in sides of the target a second, a side being
sqrt(w h) of the true box.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]

WINDOW = 11  # frames of the quadratic fit
CHI2_95 = 5.991  # 95 % of the squared errors of 2 dimensions lie under it
MOST_LAG = 10  # frames
LEAST_CORRELATION = 0.5  # under which the shift of two velocities means nothing
# The constant-velocity filter that needs no tracker but its boxes: white noise of acceleration and
# of the centre. Only their ratio counts for its velocity; one tuning for all sequences.
ACCELERATION = 10.0  # sides/s^2
CENTRE = 0.05  # sides


def centres(boxes: Floats) -> Floats:
    """Centres of boxes x, y, w, h: (n, 4) -> (n, 2), px."""
    return np.asarray(boxes[:, :2] + boxes[:, 2:] / 2)


def sides(truth: Floats) -> Floats:
    """Side sqrt(w h) of each box: (n, 4) -> (n,), px."""
    return np.asarray(np.sqrt(truth[:, 2] * truth[:, 3]))


def derivative(places: Floats, dt: float, window: int = WINDOW) -> Floats:
    """Slope, in each frame, of the quadratic fitted to ``window`` frames around it.

    In the middle of a symmetric window it is sum(k x_k) / sum(k^2) / dt (Savitzky and Golay,
    1964).

    Args:
        places: (n, 2) px.
        dt: time between two frames, s.
        window: frames of the fit, odd.

    Returns:
        (n, 2) px/s; NaN where the window reaches over an end or holds a NaN.
    """
    half = window // 2
    slopes = np.full(places.shape, np.nan)
    if len(places) >= window:
        steps = np.arange(-half, half + 1)
        windows = np.lib.stride_tricks.sliding_window_view(places, window, axis=0)
        slopes[half : len(places) - half] = windows @ steps / (steps @ steps) / dt
    return slopes


def differences(places: Floats, dt: float) -> Floats:
    """From each frame's predecessor to it: (n, 2) px/s, NaN in the first."""
    return np.diff(places, axis=0, prepend=np.nan) / dt


def filtered(places: Floats, side: float, dt: float) -> tuple[Floats, Floats, Floats]:
    """A Kalman filter of constant velocity run over centres.

    White noise of acceleration and of measurement, ``ACCELERATION`` and ``CENTRE`` of ``side``.

    Args:
        places: (n, 2) px; a row of NaN is predicted only.
        side: of the target, px; one for the whole run.
        dt: time between two frames, s.

    Returns:
        Centres (n, 2) px, velocities (n, 2) px/s and their variance (n,) px^2/s^2, which is the
        same in both directions and without correlation between them.
    """
    move = np.array([[1.0, dt], [0.0, 1.0]])
    gain_of_noise = np.array([dt**2 / 2, dt])
    process = (ACCELERATION * side) ** 2 * np.outer(gain_of_noise, gain_of_noise)
    measured = (CENTRE * side) ** 2
    state = np.stack([places[0], np.zeros(2)])  # centre and velocity; x and y in columns
    spread = np.diag([measured, side**2])  # a side a second is a common speed
    states, variances = [state], [spread[1, 1]]
    for place in places[1:]:
        state, spread = move @ state, move @ spread @ move.T + process
        if np.isfinite(place).all():
            gain = spread[:, 0] / (spread[0, 0] + measured)
            state = state + np.outer(gain, place - state[0])
            spread = spread - np.outer(gain, spread[0])
        states.append(state)
        variances.append(spread[1, 1])
    found = np.array(states)
    return found[:, 0], found[:, 1], np.array(variances)


def rms(vectors: Floats) -> float | None:
    """Root mean square length of (n, 2) vectors without NaN; None where there are none."""
    squared = (vectors**2).sum(axis=1)
    squared = squared[np.isfinite(squared)]
    return float(np.sqrt(squared.mean())) if len(squared) else None


def changes(velocities: Floats, use: Flags) -> Floats:
    """Change from each frame's predecessor, NaN unless both are in use: (n, 2)."""
    kept = np.where(use[:, None], velocities, np.nan)
    return np.diff(kept, axis=0, prepend=np.nan)


def correlation(a: Floats, b: Floats) -> float:
    """Of two velocities without their means, over the frames that both have: -1..1, or NaN."""
    both = np.isfinite(a).all(axis=1) & np.isfinite(b).all(axis=1)
    if both.sum() < 2:
        return float("nan")
    a, b = a[both] - a[both].mean(axis=0), b[both] - b[both].mean(axis=0)
    power = float((a**2).sum() * (b**2).sum())
    return float((a * b).sum() / np.sqrt(power)) if power > 0 else float("nan")


def lag(velocities: Floats, truth: Floats) -> float | None:
    """Frames by which ``velocities`` are late: where their correlation with the truth is best.

    The best whole shift within ``MOST_LAG``, refined by the parabola through it and its
    neighbours. Both are (n, 2), NaN where not in use. None where no shift correlates by
    ``LEAST_CORRELATION``, as of a target that moves evenly, or where the best one is the largest.
    """
    shifts = np.arange(-MOST_LAG, MOST_LAG + 1)
    found = np.array([correlation(*_shifted(velocities, truth, int(s))) for s in shifts])
    if not np.isfinite(found).any():
        return None
    best = int(np.nanargmax(found))
    if found[best] < LEAST_CORRELATION or best in (0, len(shifts) - 1):
        return None
    left, top, right = found[best - 1 : best + 2]
    bend = left - 2 * top + right
    part = 0.5 * (left - right) / bend if np.isfinite(bend) and bend < 0 else 0.0
    return float(shifts[best] + part)


def _shifted(late: Floats, early: Floats, frames: int) -> tuple[Floats, Floats]:
    """Rows of ``late`` beside those of ``early`` so many frames before."""
    n = len(late)
    if frames >= 0:
        return late[frames:], early[: max(n - frames, 0)]
    return late[:frames], early[-frames:]


def share_within(errors: Floats, covariances: Floats) -> float | None:
    """Share of errors (n, 2) inside the 95 % bound of their covariances (n, 2, 2).

    Only frames that have both count; None where there are none.
    """
    known = np.isfinite(errors).all(axis=1) & np.isfinite(covariances).all(axis=(1, 2))
    known &= np.linalg.det(np.nan_to_num(covariances)) > 0
    if not known.any():
        return None
    error = errors[known]
    solved = np.linalg.solve(covariances[known], error[:, :, None])[:, :, 0]
    return float(((error * solved).sum(axis=1) <= CHI2_95).mean())


def ahead(places: Floats, seconds: float, dt: float) -> Floats:
    """Where a target is ``seconds`` later, between two frames on the line: (n, 2) -> (n, 2) px.

    NaN where that is after the end or one of the two frames has none.
    """
    frames = seconds / dt
    whole = int(np.floor(frames + 1e-9))
    part = max(frames - whole, 0.0) if frames - whole > 1e-9 else 0.0
    later = _moved_up(places, whole)
    return later if part == 0 else (1 - part) * later + part * _moved_up(places, whole + 1)


def _moved_up(places: Floats, frames: int) -> Floats:
    moved = np.full(places.shape, np.nan)
    if frames < len(places):
        moved[: len(places) - frames] = places[frames:]
    return moved


Predictor = Callable[[float], Floats]


def prediction_errors(
    predictors: dict[str, Predictor],
    truth: Floats,
    use: Flags,
    horizons: Sequence[float],
    dt: float,
) -> dict[str, dict[str, float | None]]:
    """Root mean square error of places ahead, in the target's sides.

    Args:
        predictors: by name; each gives (n, 2) centres px for a time ahead, s.
        truth: (n, 4) px.
        use: (n,) frames in which a prediction is asked for.
        horizons: s.
        dt: time between two frames, s.

    Returns:
        By horizon ("0.1"...) and name; None where no frame has a truth so much later.
    """
    places, side = centres(truth), sides(truth)
    found: dict[str, dict[str, float | None]] = {}
    for seconds in horizons:
        later = ahead(places, seconds, dt)
        found[f"{seconds:g}"] = {
            name: rms(((predict(seconds) - later) / side[:, None])[use])
            for name, predict in predictors.items()
        }
    return found
