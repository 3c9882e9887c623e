# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import json

import cv2
import numpy as np
import pytest
from sensor_msgs.msg import CompressedImage, Image

from het_ros.operator.pictures import Picture
from het_ros.ros.images import ImageError
from het_ros.ros.messages import header_of

NOW = 1_795_000_000.0


def raw_image(width: int, height: int) -> Image:
    ramp = np.linspace(0, 255, width, dtype=np.uint8)
    pixels = np.ascontiguousarray(np.broadcast_to(ramp[None, :, None], (height, width, 3)))
    return Image(
        header=header_of(round(NOW * 1e9)),
        width=width,
        height=height,
        encoding="bgr8",
        step=3 * width,
        data=pixels.tobytes(),
    )


def jpeg_of(width: int, height: int) -> CompressedImage:
    message = raw_image(width, height)
    pixels = np.frombuffer(message.data, np.uint8).reshape(height, width, 3)
    data = cv2.imencode(".jpg", pixels)[1].tobytes()
    return CompressedImage(header=message.header, format="jpeg", data=data)


def opened(data: bytes) -> tuple[dict, bytes]:
    end = 4 + int.from_bytes(data[:4], "little")
    return json.loads(data[4:end]), data[end:]


@pytest.mark.parametrize(
    "asked, given", [(16, 32), (320, 320), (330, 320), (640, 640), (4096, 640)]
)
def test_a_raw_image_goes_out_as_wide_as_asked_for_and_no_wider(asked, given):
    header, jpeg = opened(Picture(raw_image(640, 480), 7, NOW + 0.1).encoded(asked, 70))
    assert header["size"] == [640, 480]
    assert (header["stamp"], header["number"]) == (str(round(NOW * 1e9)), 7)
    assert cv2.imdecode(np.frombuffer(jpeg, np.uint8), 1).shape[1] == given


def test_a_jpeg_that_is_small_enough_goes_out_untouched():
    message = jpeg_of(640, 480)
    picture = Picture(message, 1, NOW)
    assert opened(picture.encoded(640, 70))[1] == message.data.tobytes()
    assert opened(picture.encoded(450, 70))[1] == message.data.tobytes()
    smaller = opened(picture.encoded(320, 70))[1]
    assert cv2.imdecode(np.frombuffer(smaller, np.uint8), 1).shape == (240, 320, 3)


def test_clients_of_one_size_share_the_work():
    picture = Picture(raw_image(640, 480), 1, NOW)
    assert picture.encoded(320, 70) is picture.encoded(330, 70)
    assert picture.encoded(320, 70) is not picture.encoded(320, 80)


@pytest.mark.parametrize("late, captured", [(0.2, NOW), (-0.2, NOW), (4000, NOW + 4000)])
def test_an_old_bag_s_images_are_as_old_as_their_arrival(late, captured):
    header, _ = opened(Picture(raw_image(64, 48), 1, NOW + late).encoded(64, 70))
    assert header["captured"] == pytest.approx(captured)


@pytest.mark.parametrize("cut", [1, 40])
def test_a_damaged_image_is_refused(cut):
    message = jpeg_of(64, 48)
    message.data = message.data[: len(message.data) // cut - 3]
    with pytest.raises(ImageError):
        Picture(message, 1, NOW).encoded(64, 70)
