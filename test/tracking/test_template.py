# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest

from het_ros.tracking.compressive import (
    CompressiveFeatures,
    draw_measurement_matrix,
    integral_images,
)
from het_ros.tracking.sub_patches import draw_sub_patches
from het_ros.tracking.template import TemplateWriter

CELLS = 12, 16
CHANNELS, M, Q = 3, 40, 5


@pytest.fixture
def made():
    """(planes, features' maps of them, sub-patches, the writer) of noise."""
    rng = np.random.default_rng(7)
    planes = [rng.integers(0, 256, (30, 28), np.uint8) for _ in range(CHANNELS)]
    patches = draw_sub_patches(CELLS, Q, 0.75, rng)
    features = CompressiveFeatures(
        draw_measurement_matrix(patches.size, CHANNELS, M, 4, rng), np.float32
    )
    maps = features.maps(integral_images(planes))
    return planes, maps, patches, TemplateWriter(features, patches, CHANNELS, CELLS)


@pytest.mark.parametrize("corner", [(0, 0), (5, 3), (16, 14)])
def test_its_sum_is_the_mean_score_of_the_sub_patches(made, corner):
    planes, maps, patches, writer = made
    votes = np.random.default_rng(1).normal(size=(M + 1, Q)).astype(np.float32)
    scores = []
    for q, (x, y) in enumerate(patches.corners(np.array(corner, float)).astype(int)):
        scores.append(votes[:-1, q] @ maps[:, y, x] + votes[-1, q])
    template = writer.write(votes)
    x, y = corner
    cells = np.stack(planes, axis=1)[y : y + CELLS[1], :, x : x + CELLS[0]]
    found = (template.weights * cells).sum() + template.constant
    assert found == pytest.approx(np.mean(scores), abs=2e-3)


def test_a_vote_for_nothing_is_an_empty_template(made):
    votes = np.zeros((M + 1, Q), np.float32)
    votes[-1] = 0.5
    template = made[-1].write(votes)
    assert not template.weights.any()
    assert template.constant == 0.5


def test_features_that_saw_nothing_are_an_error():
    rng = np.random.default_rng(7)
    patches = draw_sub_patches(CELLS, Q, 0.75, rng)
    features = CompressiveFeatures(draw_measurement_matrix(patches.size, 1, M, 4, rng))
    with pytest.raises(RuntimeError, match="call maps first"):
        TemplateWriter(features, patches, 1, CELLS)
