"""The tracker's parameters, one declaration each for the node, the command line and the docs."""

from __future__ import annotations

from dataclasses import dataclass

from het_ros.tracking.channels import CHANNEL_NAMES
from het_ros.tracking.parameter import check_parameters, parameter


@dataclass(frozen=True)
class TrackerConfig:
    """Every parameter of the tracker; "working px" are px of the search window.

    Working px equal image px unless ``working_side`` is set.

    Raises:
        ValueError: a value is of the wrong type or outside its range, or two contradict.
    """

    seed: int = parameter(0, "seed of the random sub-patches and features", low=0, high=2**31 - 1)
    # Appearance: sub-patches and compressive features.
    channels: tuple[str, ...] = parameter(
        ("b", "g", "r"), "image channels that features are taken from", choices=CHANNEL_NAMES
    )
    working_side: float = parameter(
        0.0,
        "sqrt(w h) of the target in the search window; 0 takes the image as it is",
        unit="px",
        low=0,
        high=1000,
    )
    sub_patches: int = parameter(11, "Q, number of sub-patches", low=1, high=100)
    sub_patch_fraction: float = parameter(
        0.75, "side of a sub-patch over the target's side", low=0.1, high=1.0
    )
    features: int = parameter(
        150, "m, number of compressive features and of weak classifiers", low=1, high=2000
    )
    rectangles: int = parameter(4, "Z, most rectangles of a feature", low=1, high=16)
    # Bottom layer: base ensembles.
    search_radius: float = parameter(
        20.0, "beta, how far a sub-patch is searched", unit="working px", low=1, high=200
    )
    positive_radius: float = parameter(
        4.0, "samples nearer than this are positives", unit="working px", low=1, high=200
    )
    negative_radius: float = parameter(
        8.0, "samples at least this far are negatives", unit="working px", low=1, high=400
    )
    learning_rate: float = parameter(
        0.85, "lambda, weight of the old value at an update", low=0, high=1
    )
    sigma_floor: float = parameter(
        0.05,
        "least sigma of a Gaussian, as part of the feature's own deviation",
        low=1e-6,
        high=10,
    )
    # Middle layer: combination.
    weight_low: float = parameter(0.1, "weight of the worst sub-patch", low=0, high=0.99)
    weight_high: float = parameter(0.9, "weight of the best sub-patch", low=0, high=0.99)
    # Top layer: adaptive Kalman filter.
    acceleration: float = parameter(
        20.0,
        "deviation of the target's acceleration, which makes Q(0)",
        unit="target sides/s^2",
        low=0,
        high=1e4,
    )
    measurement_noise: float = parameter(
        0.05,
        "deviation of a measurement, which makes R(0)",
        unit="target sides",
        low=1e-4,
        high=10,
    )
    nominal_dt: float = parameter(
        1 / 30,
        "taken where the real time between frames is not positive",
        unit="s",
        low=1e-4,
        high=1,
    )
    longest_dt: float = parameter(
        1.0, "motion is extrapolated over no longer a time", unit="s", low=1e-3, high=60
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

    @classmethod
    def paper(cls, seed: int = 0) -> TrackerConfig:
        """The paper's constants, and this project's choice where the paper is silent.

        The paper fixes Q = 11 sub-patches of 3/4, m = 150, Z = 4, lambda = 0.85, beta = 20 px
        and weights in [0.1, 0.9]. Chosen here:

        - Positives lie within 4 px and negatives from 8 px on, as in its base method (Compressive
          Tracking). The paper's own words, positives within beta = 20 px, make background of most
          positives of a target 17 px wide.
        - N is every position there is: all of a sub-patch's disc in the search, all positions of
          the search window in an update. Nothing is subsampled, so nothing is drawn at random
          after the first frame.
        - Colour images give their three channels; samples are not normalised one by one.
        - The first frame sets the Gaussians outright instead of blending them into mean 0 and
          deviation 1.
        - Beyond the image's border its last pixels are repeated. The box keeps its size.
        - Q(0) is that of white acceleration over the real time step; Q(0) and R(0) are in
          multiples of the target's side sqrt(w h).
        """
        return cls(seed=seed)
