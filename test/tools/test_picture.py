# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""A moving picture has the frames that are due, scaled, and stays small."""

import numpy as np
import pytest
from PIL import Image

from het_ros.tools.picture import main
from het_ros.tools.video import VideoWriter


def test_every_second_frame_at_half_the_width(tmp_path):
    with VideoWriter(tmp_path / "in.mp4", 10) as video:
        for number in range(20):
            video.add(np.full((48, 64, 3), 10 * number, np.uint8), number * 100_000_000)
    out = tmp_path / "out.webp"
    assert main([str(tmp_path / "in.mp4"), str(out), "--width", "32", "--rate", "5"]) == 0
    with Image.open(out) as picture:
        assert picture.size == (32, 24)
        assert picture.n_frames == 10
        picture.seek(1)
        assert picture.convert("RGB").getpixel((16, 12))[0] == pytest.approx(20, abs=6)
