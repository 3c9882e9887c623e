# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The paper's constants, and this project's choice where the paper is silent."""

from __future__ import annotations

from dataclasses import dataclass

from het_ros.tracking.features.channels import CHANNEL_NAMES
from het_ros.tracking.parameter import check_parameters, parameter


@dataclass(frozen=True)
class PaperConfig:
    """Parameters of :class:`~het_ros.tracking.paper.tracker.PaperTracker`.

    "Paper" in a description marks what the paper fixes, "chosen" what it leaves open:

    - Positives lie within 4 px and negatives from 8 px on, as in its base method (Compressive
      Tracking). The paper's own words, positives within beta = 20 px and negatives beyond
      pi = 2 beta, make background of most positives of a target 17 px wide.
    - N is every position there is: all of a sub-patch's disc in the search, all positions of the
      search window in an update. Nothing is drawn at random after the first frame.
    - Colour images give their three channels; samples are not normalised one by one.
    - The first frame sets the Gaussians outright instead of blending them into mean 0 and
      deviation 1.
    - Beyond the image's border its last pixels are repeated. The box keeps its size.
    - Q(0) is that of white acceleration over the real time step; Q(0) and R(0) are in multiples
      of the target's side sqrt(w h).

    ``learning_rate`` is the weight of the new frame, one minus the paper's lambda.

    Raises:
        ValueError: a value is of the wrong type or outside its range, or two contradict.
    """

    seed: int = parameter(0, "seed of the random sub-patches and features", low=0, high=2**31 - 1)
    most_memory: float = parameter(
        2000.0,
        "a box whose target would take more is refused (chosen)",
        unit="MB",
        low=1,
        high=1e5,
    )
    channels: tuple[str, ...] = parameter(
        ("b", "g", "r"),
        "image channels that features are taken from (chosen)",
        choices=CHANNEL_NAMES,
    )
    sub_patches: int = parameter(11, "Q, number of sub-patches (paper)", low=1, high=100)
    sub_patch_fraction: float = parameter(
        0.75, "side of a sub-patch over the target's side (paper)", low=0.1, high=1.0
    )
    features: int = parameter(
        150, "m, number of features and of weak classifiers (paper)", low=1, high=2000
    )
    rectangles: int = parameter(4, "Z, most rectangles of a feature (paper)", low=1, high=16)
    search_radius: float = parameter(
        20.0, "beta, how far a sub-patch is searched (paper)", unit="px", low=1, high=200
    )
    positive_radius: float = parameter(
        4.0,
        "samples nearer than this are positives (chosen, Compressive Tracking)",
        unit="px",
        low=1,
        high=200,
    )
    negative_radius: float = parameter(
        8.0,
        "samples at least this far are negatives (chosen, Compressive Tracking)",
        unit="px",
        low=1,
        high=400,
    )
    learning_rate: float = parameter(
        0.15, "weight of the new frame, 1 - lambda (paper)", low=0, high=1
    )
    sigma_floor: float = parameter(
        0.05,
        "least sigma of a Gaussian, as part of the feature's own deviation (chosen)",
        low=1e-6,
        high=10,
    )
    weight_low: float = parameter(0.1, "least weight of a sub-patch (paper)", low=0, high=0.99)
    weight_high: float = parameter(0.9, "greatest weight of a sub-patch (paper)", low=0, high=0.99)
    acceleration: float = parameter(
        20.0,
        "deviation of the target's acceleration, which makes Q(0) (chosen)",
        unit="target sides/s^2",
        low=0,
        high=1e4,
    )
    measurement_noise: float = parameter(
        0.05,
        "deviation of a measurement, which makes R(0) (chosen)",
        unit="target sides",
        low=1e-4,
        high=10,
    )
    nominal_dt: float = parameter(
        1 / 30,
        "taken where the real time between frames is not positive (chosen)",
        unit="s",
        low=1e-4,
        high=1,
    )
    longest_dt: float = parameter(
        1.0,
        "motion is extrapolated over no longer a time (chosen)",
        unit="s",
        low=1e-3,
        high=60,
    )

    def __post_init__(self) -> None:
        check_parameters(self)
        if not self.channels:
            raise ValueError("channels needs at least one name")
        for low, high in (
            ("positive_radius", "negative_radius"),
            ("negative_radius", "search_radius"),
            ("weight_low", "weight_high"),
        ):
            if getattr(self, low) > getattr(self, high):
                raise ValueError(
                    f"{low} ({getattr(self, low):g}) must not exceed {high} "
                    f"({getattr(self, high):g})"
                )
