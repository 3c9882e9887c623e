# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest

from features.slow import all_features
from het_ros.tracking.features.compressive import (
    CompressiveFeatures,
    draw_measurement_matrix,
    integral_images,
    raw_feature_maps,
)


def draw(size=(9, 13), channels=3, features=200, rectangles=4, seed=0):
    rng = np.random.default_rng(seed)
    return draw_measurement_matrix(size, channels, features, rectangles, rng)


def random_planes(shape=(20, 25), count=3, seed=1):
    rng = np.random.default_rng(seed)
    return [rng.integers(0, 256, shape, dtype=np.uint8) for _ in range(count)]


@pytest.mark.parametrize("size", [(9, 13), (3, 3), (1, 1), (1, 40)], ids=str)
@pytest.mark.parametrize("most", [1, 2, 4])
def test_rows_hold_few_rectangles_inside_the_sub_patch(size, most):
    rows = draw(size=size, rectangles=most).rows
    assert len(rows) == 200
    assert {len(row) for row in rows} == set(range(min(2, most), most + 1))
    for row in rows:
        assert len({rectangle.channel for rectangle in row}) == 1
        for channel, x0, y0, x1, y1, sign in row:
            assert channel in (0, 1, 2)
            assert 0 <= x0 < x1 <= size[0]
            assert 0 <= y0 < y1 <= size[1]
            assert sign in (-1, 1)


def test_matrix_draws_all_of_its_kind():
    rectangles = [rectangle for row in draw(features=600).rows for rectangle in row]
    assert {r.channel for r in rectangles} == {0, 1, 2}
    assert 0.45 < np.mean([r.sign > 0 for r in rectangles]) < 0.55
    assert min(r.x0 for r in rectangles) == 0
    assert max(r.x1 for r in rectangles) == 9
    assert max(r.y1 for r in rectangles) == 13


def test_matrix_is_its_generators():
    assert draw(seed=3) == draw(seed=3)
    assert draw(seed=3) != draw(seed=4)


@pytest.mark.parametrize(
    ("size", "shape"),
    [((9, 13), (20, 25)), ((9, 13), (13, 9)), ((1, 1), (4, 5)), ((20, 3), (9, 21))],
    ids=str,
)
@pytest.mark.parametrize("features", [4, 60])
def test_maps_are_exact_sums(size, shape, features):
    """With few rectangles and with many, which share sums over their heights."""
    planes = random_planes(shape)
    matrix = draw(size=size, features=features)
    maps = raw_feature_maps(integral_images(planes), matrix)
    assert maps.shape == (features, shape[0] - size[1] + 1, shape[1] - size[0] + 1)
    whole = [plane.astype(int) for plane in planes]
    for (x, y), values in all_features(whole, matrix.rows, size).items():
        assert maps[:, y, x].tolist() == values


def test_maps_of_channels_in_floats():
    planes = [plane.astype(np.float32) / 8 for plane in random_planes()]
    matrix = draw(features=25)
    maps = raw_feature_maps(integral_images(planes), matrix)
    slow = all_features([p * 8 for p in planes], matrix.rows, matrix.size)
    np.testing.assert_allclose(maps[:, 2, 3] * 8, slow[3, 2], rtol=1e-9)


def test_maps_that_are_held_stay_as_they_are():
    """A first look is kept while a second one is taken, whole or in part."""
    features = CompressiveFeatures(draw(features=25))
    integrals = [integral_images(random_planes(seed=seed)) for seed in range(4)]
    first = features.maps(integrals[0])
    part = features.maps(integrals[1])[3:5, 1:]
    before, part_before = first.copy(), part.copy()
    for other in integrals[1:]:
        assert not np.allclose(features.maps(other), before)
    np.testing.assert_array_equal(first, before)
    np.testing.assert_array_equal(part, part_before)
    np.testing.assert_array_equal(features.maps(integrals[0]), before)


def test_maps_of_another_window_leave_no_trace():
    features = CompressiveFeatures(draw(features=25))
    small, large = (integral_images(random_planes(shape)) for shape in ((20, 25), (33, 41)))
    before = features.maps(small).copy()
    features.maps(large)
    np.testing.assert_array_equal(features.maps(small), before)


def test_the_normalisation_is_known_after_the_first_window():
    features = CompressiveFeatures(draw(features=25), np.float32)
    with pytest.raises(RuntimeError, match="call maps first"):
        _ = features.normalisation
    integrals = integral_images(random_planes())
    maps = features.maps(integrals)
    centre, scale = features.normalisation
    raw = raw_feature_maps(integrals, features.matrix)
    wanted = (raw - centre[:, None, None]) * scale[:, None, None]
    assert maps.dtype == np.float32
    np.testing.assert_allclose(maps, wanted, rtol=1e-6)


@pytest.mark.parametrize("side", [200, 400])
def test_sums_of_large_white_windows_are_exact(side):
    """Beyond 2^24 not all whole numbers fit into float32."""
    white = [np.full((side, side), 255, np.uint8)]
    matrix = draw(size=(90, 60), channels=1, features=12)
    maps = raw_feature_maps(integral_images(white), matrix)
    for feature, row in zip(maps, matrix.rows, strict=True):
        wanted = sum(255 * r.sign * (r.x1 - r.x0) * (r.y1 - r.y0) for r in row)
        np.testing.assert_array_equal(feature, wanted)


def test_first_maps_are_normalised_and_fix_the_scale():
    features = CompressiveFeatures(draw(features=40))
    planes = random_planes((60, 70))
    first = features.maps(integral_images(planes)).copy()
    np.testing.assert_allclose(first.mean(axis=(1, 2)), 0, atol=0.01)
    np.testing.assert_allclose(first.std(axis=(1, 2)), 1, rtol=1e-6)
    brighter = [np.clip(plane, 0, 200) + 55 for plane in planes]
    assert features.maps(integral_images(brighter)).std() != pytest.approx(1, abs=0.01)
    np.testing.assert_allclose(features.maps(integral_images(planes)), first)


def test_flat_image_gives_finite_features():
    features = CompressiveFeatures(draw())
    flat = [np.full((30, 30), 77, np.uint8)] * 3
    np.testing.assert_array_equal(features.maps(integral_images(flat)), 0)
    assert np.isfinite(features.maps(integral_images(random_planes((30, 30))))).all()
