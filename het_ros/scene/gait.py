# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""A walking body: where its joints are at a phase of the gait.

Body axes: forward, up, left; the angles are those of an ordinary adult's walk, simplified.
"""

from __future__ import annotations

import numpy as np

STRIDE = 1.24  # m that one full cycle (two steps) covers for a body of 1.75 m
SWING = 0.37  # rad: how far the thigh swings to either side
BONES = {"thigh": 0.245, "shank": 0.240, "foot": 0.135, "upper_arm": 0.172, "forearm": 0.155}
HIP_WIDTH, SHOULDER_WIDTH, TRUNK, NECK = 0.052, 0.108, 0.292, 0.052  # all as part of the height


def joints(
    phase: float, stride: float, height: float, forward: np.ndarray, at: np.ndarray
) -> dict[str, np.ndarray]:
    """Joints of a body, (3,) m of the street each.

    Args:
        phase: of the gait, rad; the left leg is foremost at 0.
        stride: 0 stands still, 1 walks with full steps.
        height: of the body, m.
        forward: unit vector (3,) along which it walks.
        at: the point (3,) of the ground beneath it.
    """
    left = np.array([-forward[2], 0.0, forward[0]])
    up = np.array([0.0, 1.0, 0.0])
    found: dict[str, np.ndarray] = {}
    for side, sign, shift in (("left", 1, 0.0), ("right", -1, np.pi)):
        hip = sign * HIP_WIDTH * left
        found |= _leg(side, hip, phase + shift, stride, forward, up)
    lowest = min(p[1] for name, p in found.items() if name.endswith(("heel", "toe")))
    lean = up * np.cos(0.06 * stride) + forward * np.sin(0.06 * stride)
    twist = 0.14 * stride * np.cos(phase)  # the shoulders turn against the hips
    across = left * np.cos(twist) + forward * np.sin(twist)
    found["pelvis"] = np.zeros(3)
    found["neck"] = TRUNK * lean
    found["head"] = found["neck"] + (NECK + 0.062) * (0.99 * up + 0.13 * forward * stride)
    for side, sign, shift in (("left", 1, np.pi), ("right", -1, 0.0)):
        shoulder = found["neck"] - 0.022 * up + sign * SHOULDER_WIDTH * across
        found |= _arm(side, shoulder, phase + shift, stride, forward, up, sign * left)
    base = at - np.array([0.0, (lowest - 0.012) * height, 0.0])
    return {name: base + height * point for name, point in found.items()}


def _leg(
    side: str, hip: np.ndarray, phase: float, stride: float, forward: np.ndarray, up: np.ndarray
) -> dict[str, np.ndarray]:
    thigh = stride * (SWING * np.cos(phase) + 0.06)
    lifted = np.angle(np.exp(1j * (phase - 1.52 * np.pi)))  # the knee bends while the leg swings
    bend = 0.06 + stride * (0.92 * np.exp(-((lifted / 0.8) ** 2)) + 0.06)
    toe_off = np.angle(np.exp(1j * (phase - 1.2 * np.pi)))
    pitch = stride * (0.3 * np.exp(-((phase_distance(phase, 0.0) / 0.5) ** 2))
                      - 0.75 * np.exp(-((toe_off / 0.55) ** 2)))  # fmt: skip
    knee = hip + BONES["thigh"] * (np.sin(thigh) * forward - np.cos(thigh) * up)
    shank = thigh - bend
    ankle = knee + BONES["shank"] * (np.sin(shank) * forward - np.cos(shank) * up)
    sole = np.cos(pitch) * forward + np.sin(pitch) * up
    under = np.cos(pitch) * up - np.sin(pitch) * forward
    heel = ankle - 0.034 * under - 0.3 * BONES["foot"] * sole
    return {
        f"{side}_hip": hip, f"{side}_knee": knee, f"{side}_ankle": ankle, f"{side}_heel": heel,
        f"{side}_toe": heel + BONES["foot"] * sole,
    }  # fmt: skip


def phase_distance(phase: float, other: float) -> float:
    """Difference of two phases, rad, in -pi..pi."""
    return float(np.angle(np.exp(1j * (phase - other))))


def _arm(
    side: str, shoulder: np.ndarray, phase: float, stride: float, forward: np.ndarray,
    up: np.ndarray, outward: np.ndarray,
) -> dict[str, np.ndarray]:  # fmt: skip
    swing = stride * 0.46 * np.cos(phase) - 0.02
    bend = 0.18 + stride * (0.26 + 0.2 * np.cos(phase))
    elbow = shoulder + BONES["upper_arm"] * (
        np.sin(swing) * forward - np.cos(swing) * up + 0.1 * outward
    )
    wrist = elbow + BONES["forearm"] * (
        np.sin(swing + bend) * forward - np.cos(swing + bend) * up - 0.02 * outward
    )
    hand = wrist + 0.3 * (wrist - elbow)
    return {f"{side}_shoulder": shoulder, f"{side}_elbow": elbow, f"{side}_wrist": wrist,
            f"{side}_hand": hand}  # fmt: skip
