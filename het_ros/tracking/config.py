# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The tracker's parameters, one declaration each for the node, the command line and the docs."""

from __future__ import annotations

from dataclasses import dataclass

from het_ros.tracking.channels import CHANNEL_NAMES, ORIENTATIONS
from het_ros.tracking.parameter import check_parameters, parameter

_ALL_CHANNELS = (
    "lightness",
    "green_red",
    "blue_yellow",
    "gradient",
    *(f"orientation{k}" for k in range(ORIENTATIONS)),
)


@dataclass(frozen=True)
class TrackerConfig:
    """Every parameter of the tracker; "working px" are px of the search window.

    Working px equal image px unless ``working_side`` is set.

    Raises:
        ValueError: a value is of the wrong type or outside its range, or two contradict.
    """

    seed: int = parameter(0, "seed of the random sub-patches and features", low=0, high=2**31 - 1)
    most_memory: float = parameter(
        300.0, "a box whose target would take more is refused", unit="MB", low=1, high=1e5
    )
    # Appearance: sub-patches and compressive features.
    channels: tuple[str, ...] = parameter(
        _ALL_CHANNELS, "image channels that features are taken from", choices=CHANNEL_NAMES
    )
    gray_below: float = parameter(
        2.0,
        "images of three channels that differ by less than this in the mean are taken as gray",
        unit="gray values",
        low=0,
        high=255,
    )
    working_side: float = parameter(
        48.0,
        "sqrt(w h) of the target in the search window; 0 takes the image as it is",
        unit="px",
        low=0,
        high=1000,
    )
    cell: int = parameter(
        2, "channels are averaged over cells of this side", unit="working px", low=1, high=16
    )
    sub_patches: int = parameter(11, "Q, number of sub-patches", low=1, high=100)
    sub_patch_fraction: float = parameter(
        0.75, "side of a sub-patch over the target's side", low=0.1, high=1.0
    )
    features: int = parameter(
        150, "m, number of compressive features and of weak classifiers", low=1, high=2000
    )
    rectangles: int = parameter(4, "Z, most rectangles of a feature", low=1, high=16)
    largest_rectangle: float = parameter(
        1.0, "longest side of a rectangle over the sub-patch's side", low=0.01, high=1.0
    )
    light_jumps: bool = parameter(
        True, "take back exposure and white balance that jump from one image to the next"
    )
    # Bottom layer: base ensembles.
    base_ensemble: str = parameter(
        "ridge", "how a base ensemble weighs its features", choices=("ridge", "naive_bayes")
    )
    search_radius: float = parameter(
        34.0, "beta, how far a sub-patch is searched", unit="working px", low=1, high=200
    )
    positive_radius: float = parameter(
        4.0,
        "naive Bayes: samples nearer than this are positives",
        unit="working px",
        low=1,
        high=200,
    )
    negative_radius: float = parameter(
        8.0,
        "naive Bayes: samples at least this far are negatives",
        unit="working px",
        low=1,
        high=400,
    )
    learning_rate: float = parameter(
        0.985, "lambda, weight of the old value at an update", low=0, high=1
    )
    sigma_floor: float = parameter(
        0.05,
        "naive Bayes: least sigma of a Gaussian, as part of the feature's own deviation",
        low=1e-6,
        high=10,
    )
    ridge: float = parameter(
        0.01, "ridge: regularisation over the variance of a feature", low=1e-9, high=1e3
    )
    label_sigma: float = parameter(
        0.12, "ridge: deviation of the labels", unit="target sides", low=0.01, high=1
    )
    target_emphasis: float = parameter(
        20.0, "ridge: how much more the target's places weigh than background", low=0, high=1e4
    )
    first_frame: float = parameter(
        0.1, "ridge, scale: share of the first frame, which is never forgotten", low=0, high=1
    )
    # Middle layer: combination.
    combination: str = parameter(
        "dense",
        "votes of all score maps, or weighted mean of one hypothesis a sub-patch",
        choices=("dense", "weighted"),
    )
    weight_low: float = parameter(0.1, "least weight of a sub-patch", low=0, high=0.99)
    weight_high: float = parameter(0.9, "greatest weight of a sub-patch", low=0, high=0.99)
    colour_weight: float = parameter(
        0.4, "share of the colour histograms in the dense votes; 0 is without", low=0, high=1
    )
    colour_rate: float = parameter(
        0.02, "weight of the new frame in the colour histograms", low=0, high=1
    )
    rotation: bool = parameter(True, "follow how the target is turned in the image")
    centring: bool = parameter(
        True, "move the box to where the target's colours are: a start box may lie beside it"
    )
    flow_weight: float = parameter(
        0.25,
        "how much a place gains by optical flow in the dense votes; 0 is without",
        low=0,
        high=5,
    )
    # Scale.
    scales: int = parameter(
        17, "number of sizes tried a frame; 1 keeps the size of the first box", low=1, high=65
    )
    scale_step: float = parameter(1.02, "ratio of one size to the next", low=1.001, high=1.2)
    scale_context: float = parameter(
        1.2, "how much more than the target the scale filter sees", low=0.5, high=3
    )
    scale_rate: float = parameter(
        0.02, "weight of the new frame in the scale filter", low=0, high=1
    )
    size_regression: bool = parameter(
        True, "half of what is believed of a change of size is regressed on all features together"
    )
    size_template: bool = parameter(
        True, "draw the size to where the base ensembles score as they did at first (ridge)"
    )
    first_look: bool = parameter(
        True, "draw place and size to where the target looks as in its first frame"
    )
    growth_limit: float = parameter(
        0.42, "the target's size changes at most this fast", unit="1/s", low=0, high=100
    )
    # Top layer: adaptive Kalman filter.
    acceleration: float = parameter(
        80.0,
        "deviation of the target's acceleration, which makes Q(0)",
        unit="target sides/s^2",
        low=0,
        high=1e4,
    )
    measurement_noise: float = parameter(
        0.1,
        "deviation of a measurement, which makes R(0)",
        unit="target sides",
        low=1e-4,
        high=10,
    )
    camera_motion: bool = parameter(
        True,
        "predict the target in the scene, not in the image, where that is right more often",
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
    # Trust: shares of what the evidence was while all went well.
    trust: bool = parameter(
        True,
        "judge whether the target is there; centring, scenery and colour_search rest without it",
    )
    hidden: float = parameter(
        0.47,
        "hidden where the product of the base ensembles' and the colours' shares falls below",
        low=0,
        high=1,
    )
    learn_colour: float = parameter(
        0.8, "not learnt where the colours' likelihood falls below this share", low=0, high=1
    )
    doubt_template: float = parameter(
        0.75, "not learnt where the score falls below this share", low=0, high=1
    )
    doubt_rival: float = parameter(
        0.8, "and another place scores above this share of the best", low=0, high=1
    )
    twin: float = parameter(
        0.9, "not learnt where another place scores above this share of the best", low=0, high=10
    )
    return_probability: float = parameter(
        0.65, "found again where it is the target with this probability", low=0, high=1
    )
    scenery: bool = parameter(
        True, "what stood at its place before the target came there is not the target"
    )
    colour_search: bool = parameter(
        True, "look for a hidden target wherever in the image its colours are"
    )
    lost_after: float = parameter(
        2.0, "a target that stays hidden is coasted this long, then LOST", unit="s", low=0, high=60
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
        if self.trust and (self.base_ensemble, self.combination) != ("ridge", "dense"):
            raise ValueError(
                "trust judges the scores of base_ensemble ridge and combination dense: "
                "set trust to false with any other"
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
        return cls(
            seed=seed,
            most_memory=2000.0,
            channels=("b", "g", "r"),
            gray_below=0.0,
            working_side=0.0,
            cell=1,
            sub_patches=11,
            sub_patch_fraction=0.75,
            features=150,
            rectangles=4,
            largest_rectangle=1.0,
            base_ensemble="naive_bayes",
            search_radius=20.0,
            positive_radius=4.0,
            negative_radius=8.0,
            learning_rate=0.85,
            sigma_floor=0.05,
            combination="weighted",
            weight_low=0.1,
            weight_high=0.9,
            colour_weight=0.0,
            rotation=False,
            centring=False,
            flow_weight=0.0,
            camera_motion=False,
            light_jumps=False,
            scales=1,
            size_regression=False,
            size_template=False,
            first_look=False,
            acceleration=20.0,
            measurement_noise=0.05,
            trust=False,
            scenery=False,
            colour_search=False,
        )
