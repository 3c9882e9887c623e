# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The default tracker's parameters, one declaration each for node, command line and docs.

What a user may have a reason to change stands here. What is geometry or was chosen once is in the
frozen configuration of the part that it belongs to.
"""

from __future__ import annotations

from dataclasses import dataclass

from het_ros.tracking.parameter import check_parameters, parameter


@dataclass(frozen=True)
class TrackerConfig:
    """Every public parameter of the tracker; "working px" are px of the search window.

    A target's area is brought to ``working_side`` squared before anything is looked at. A rate
    is the weight of the new frame in a running mean.

    Raises:
        ValueError: a value is of the wrong type or outside its range.
    """

    seed: int = parameter(0, "seed of the random sub-patches and features", low=0, high=2**31 - 1)
    most_memory: float = parameter(
        300.0, "a box whose target would take more is refused", unit="MB", low=1, high=1e5
    )
    # Search window.
    working_side: float = parameter(
        40.0, "sqrt(w h) of the target in the search window", unit="px", low=8, high=1000
    )
    search_radius: float = parameter(
        28.0,
        "how far the target is looked for around its place",
        unit="working px",
        low=1,
        high=200,
    )
    gray_below: float = parameter(
        2.0,
        "images of three channels that differ by less than this in the mean are taken as gray",
        unit="gray values",
        low=0,
        high=255,
    )
    # Bottom layer: sub-patches, colours, flow.
    sub_patches: int = parameter(11, "Q, number of sub-patches", low=1, high=100)
    sub_patch_fraction: float = parameter(
        0.75, "side of a sub-patch over the target's side", low=0.1, high=1.0
    )
    features: int = parameter(150, "m, number of compressive features", low=1, high=2000)
    ridge: float = parameter(
        0.01, "regularisation over the variance of a feature", low=1e-9, high=1e3
    )
    learning_rate: float = parameter(0.02, "slow rate of the sub-patches' model", low=0, high=1)
    fast_learning_rate: float = parameter(
        0.1, "fast rate of the sub-patches' model, which counts half", low=0, high=1
    )
    first_frame: float = parameter(
        0.1, "share of the first frame in what is learnt, never forgotten", low=0, high=1
    )
    colour_weight: float = parameter(
        0.4, "share of the colour histograms in the votes; 0 is without", low=0, high=1
    )
    colour_rate: float = parameter(0.04, "rate of the colour histograms", low=0, high=1)
    flow_weight: float = parameter(
        0.25, "how much a place gains by optical flow; 0 is without", low=0, high=5
    )
    network: str = parameter(
        "", "folder with a NanoTrack network (two ONNX files); empty is without"
    )
    network_thread: bool = parameter(
        True, "the network works in a second thread where it may use a second processor"
    )
    # Size.
    scale_rate: float = parameter(0.04, "rate of the scale filter", low=0, high=1)
    growth_limit: float = parameter(
        0.42,
        "the size changes at most this fast beside what optical flow measures",
        unit="1/s",
        low=0,
        high=100,
    )
    # Motion.
    acceleration: float = parameter(
        80.0, "deviation of the target's acceleration", unit="target sides/s^2", low=0, high=1e4
    )
    measurement_noise: float = parameter(
        0.1, "deviation of a measured place", unit="target sides", low=1e-4, high=10
    )
    nominal_dt: float = parameter(
        1 / 30, "taken where the time between frames is not positive", unit="s", low=1e-4, high=1
    )
    longest_dt: float = parameter(
        1.0, "motion is extrapolated over no longer a time", unit="s", low=1e-3, high=60
    )
    # Confidence.
    background: bool = parameter(
        True, "what stood at its place before the target came there is not the target"
    )
    lost_after: float = parameter(
        2.0,
        "a target that is not recognised is COASTING for this long, then LOST",
        unit="s",
        low=0,
        high=60,
    )

    def __post_init__(self) -> None:
        check_parameters(self)
