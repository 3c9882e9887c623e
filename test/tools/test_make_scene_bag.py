# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
from pathlib import Path

import cv2
import numpy as np
import pytest
from rosbags.highlevel import AnyReader

from het_ros import Box
from het_ros.scene import Scene, SceneConfig
from het_ros.tools import make_scene_bag
from het_ros.tools.bag_messages import box_of, stamp_of
from het_ros.tools.bag_writer import TYPESTORE

SHIPPED = Path(__file__).resolve().parents[2] / "bags" / "follow_walk"
CONFIG = SceneConfig(story="hidden_1s", seed=2, width=160, height=120, rate=10.0, seconds=1.0)
TOPICS = ("/image/compressed", "/camera_info", "/ground_truth/box", "/ground_truth/visibility")


def _messages(path: Path) -> dict:
    found = {}
    with AnyReader([path], default_typestore=TYPESTORE) as reader:
        for connection, stamp, raw in reader.messages():
            message = reader.deserialize(raw, connection.msgtype)
            assert stamp_of(message) == stamp
            found.setdefault(connection.topic, []).append(message)
    return found


@pytest.fixture(scope="module")
def bag(tmp_path_factory):
    path = tmp_path_factory.mktemp("scene") / "bag"
    assert make_scene_bag.make_scene_bag(Scene(CONFIG), path, quality=95) == 10
    return _messages(path)


def test_every_frame_comes_with_its_camera_and_its_truth(bag):
    assert {topic: len(bag[topic]) for topic in TOPICS} == dict.fromkeys(TOPICS, 10)
    for index, frame in enumerate(Scene(CONFIG).frames()):
        image = cv2.imdecode(bag["/image/compressed"][index].data, cv2.IMREAD_COLOR)
        assert np.abs(image.astype(int) - frame.image).mean() < 4
        assert box_of(bag["/ground_truth/box"][index]).as_tuple() == frame.box.as_tuple()
        (status,) = bag["/ground_truth/visibility"][index].status
        assert float(status.values[0].value) == pytest.approx(frame.visible, abs=1e-4)


def test_the_init_box_names_the_first_image(bag):
    (init,) = bag["/tracker/init_box"]
    assert stamp_of(init) == stamp_of(bag["/image/compressed"][0])
    assert box_of(init) == box_of(bag["/ground_truth/box"][0])


def test_the_camera_info_is_the_lens(bag):
    info = bag["/camera_info"][0]
    assert (info.width, info.height) == (160, 120)
    assert np.allclose(info.k.reshape(3, 3), Scene(CONFIG).lens.matrix)


@pytest.mark.parametrize("wrong", [["--size", "big"], ["--quality", "0"], ["--story", "romance"]])
def test_wrong_options_say_what_is_wrong(tmp_path, capsys, wrong):
    assert make_scene_bag.main([str(tmp_path / "bag"), "--seconds", "1", *wrong]) == 1
    assert "make_scene_bag: " in capsys.readouterr().err
    assert not (tmp_path / "bag").exists()


def test_the_shipped_bag_is_small_and_whole():
    assert sum(f.stat().st_size for f in SHIPPED.parent.rglob("*") if f.is_file()) <= 8_000_000
    bag = _messages(SHIPPED)
    stamps = [stamp_of(message) for message in bag["/image/compressed"]]
    assert 20 <= (stamps[-1] - stamps[0]) / 1e9 <= 30
    assert len(set(np.diff(stamps) // 1000)) <= 2  # evenly spaced
    assert {len(bag[topic]) for topic in TOPICS} == {len(stamps)}
    image = cv2.imdecode(bag["/image/compressed"][0].data, cv2.IMREAD_COLOR)
    assert image.shape == (480, 640, 3)
    seen = [float(m.status[0].values[0].value) for m in bag["/ground_truth/visibility"]]
    assert sum(v < 0.02 for v in seen) / len(seen) * 22 == pytest.approx(1.1, abs=0.3)
    box = box_of(bag["/tracker/init_box"][0])
    assert Box(0, 0, 640, 480).intersection(box) == pytest.approx(box.area)
