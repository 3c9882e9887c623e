# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest

from het_ros import Box
from het_ros.tracking.middle.colour_extent import ColourExtent, ExtentConfig, extent

CONFIG = ExtentConfig()
CORNER, SIZE = np.array([30.0, 24.0]), np.array([20.0, 32.0])
BOX = Box(*CORNER, *SIZE)


def picture(box, inside=0.9, outside=0.1):
    """Likelihood (80, 80) of a target that fills a box of whole px."""
    likelihood = np.full((80, 80), outside, np.float32)
    x, y, w, h = map(int, box)
    likelihood[y : y + h, x : x + w] = inside
    return likelihood


def slow_extent(likelihood, reach):
    """The best of all rectangles whose edges are within reach of the box's."""
    lengths = (reach * SIZE).astype(int)
    edges = [
        [range(int(start - more), int(start + more) + 1) for start in (low, low + side)]
        for low, side, more in zip(CORNER, SIZE, lengths, strict=True)
    ]
    total = np.zeros((81, 81))
    total[1:, 1:] = np.cumsum(np.cumsum(likelihood - 0.5, axis=0), axis=1)
    return max(
        (total[b, r] - total[t, r] - total[b, x] + total[t, x], -x, -t, r, b)
        for x in edges[0][0]
        for r in edges[0][1]
        for t in edges[1][0]
        for b in edges[1][1]
    )


@pytest.mark.parametrize(
    "shown", [(30, 24, 20, 32), (26, 24, 28, 32), (34, 20, 12, 40), (33, 28, 20, 32)], ids=str
)
def test_the_edges_of_what_is_shown_are_found(shown):
    (x, y), (w, h) = extent(picture(shown), CORNER, SIZE, CONFIG)
    found = np.exp((w, h)) * SIZE
    corner = CORNER + (np.array([x, y]) + 0.5) * SIZE - found / 2
    np.testing.assert_allclose([*corner, *found], shown, atol=1e-9)


def test_it_is_the_best_of_all_rectangles():
    """Of noise over a shifted target, against a slow loop over all edges."""
    noise = np.random.default_rng(5).uniform(-0.3, 0.3, (80, 80))
    likelihood = (picture((33, 22, 24, 28)) + noise).astype(np.float32)
    (x, y), (w, h) = extent(likelihood, CORNER, SIZE, CONFIG)
    found = np.exp((w, h)) * SIZE
    left, top = CORNER + (np.array([x, y]) + 0.5) * SIZE - found / 2
    best = slow_extent(likelihood, CONFIG.reach)
    np.testing.assert_allclose((left, top, left + found[0], top + found[1]), np.abs(best[1:]))


@pytest.mark.parametrize("outside", [(-200.0, 0.0), (500.0, 20.0), (20.0, 300.0)], ids=str)
def test_outside_the_window_nothing_is_known(outside):
    assert extent(picture((30, 24, 20, 32)), np.array(outside), SIZE, CONFIG) is None


def test_a_box_that_its_colours_never_filled_stays_what_it_is():
    """The given box is wider than its colours, now as at first."""
    followed = ColourExtent()
    for _ in range(20):
        followed.follow(picture((34, 24, 12, 32)), CORNER, SIZE)
    np.testing.assert_allclose(followed.refined(BOX).as_tuple(), BOX.as_tuple())


def test_part_of_a_change_is_believed():
    followed = ColourExtent()
    for _ in range(CONFIG.known):
        followed.follow(picture(BOX.as_tuple()), CORNER, SIZE)
    for _ in range(40):  # it spreads its arms, to the right more than to the left
        followed.follow(picture((28, 24, 26, 32)), CORNER, SIZE)
    found = followed.refined(BOX)
    assert found.w == pytest.approx(20 * (26 / 20) ** CONFIG.size[0], rel=1e-4)
    assert found.centre[0] == pytest.approx(40 + CONFIG.shift[0] * 1, abs=1e-3)
    assert (found.h, found.centre[1]) == pytest.approx((32, 40))
