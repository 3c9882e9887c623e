# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import cv2
import numpy as np
import pytest

from het_ros import Box
from het_ros.tools import make_bag as make_bag_module
from het_ros.tools.bag_messages import box_of, stamp_of
from het_ros.tools.bag_reader import BagError, BagReader
from het_ros.tools.bag_writer import BagWriter
from het_ros.tools.footage import open_footage
from het_ros.tools.interrupt import StopRequest
from het_ros.tools.make_bag import FIRST_STAMP, make_bag
from het_ros.tools.video import VideoWriter


@pytest.mark.parametrize("raw", [False, True])
def test_a_sequence_comes_back_whole_from_its_bag(crossing, tmp_path, raw):
    frames = make_bag(crossing, tmp_path / "bag", rate=25, raw=raw)
    assert frames == len(crossing.images)
    with BagReader(tmp_path / "bag") as bag:
        assert bag.topics == {
            "/image" if raw else "/image/compressed": bag.topics[bag.image_topic],
            "/tracker/init_box": "geometry_msgs/msg/PolygonStamped",
            "/ground_truth/box": "geometry_msgs/msg/PolygonStamped",
        }
        images = list(bag.images())
        truth = bag.truth()
        (init,) = bag.messages("/tracker/init_box")
        assert bag.stamps() == [stamp for stamp, _ in images]
    assert [stamp for stamp, _ in images] == [FIRST_STAMP + i * 40_000_000 for i in range(frames)]
    for (stamp, image), file, box in zip(images, crossing.images, crossing.truth, strict=True):
        assert np.array_equal(image, cv2.imread(str(file), cv2.IMREAD_ANYCOLOR))
        assert truth[stamp] == box
    assert (stamp_of(init[1]), box_of(init[1])) == (FIRST_STAMP, Box(204, 150, 17, 50))


def test_jpeg_files_go_into_the_bag_as_they_are(crossing, crossing_bag):
    with BagReader(crossing_bag) as bag:
        recorded = [m.data.tobytes() for _, m in bag.messages("/image/compressed")]
    assert recorded == [file.read_bytes() for file in crossing.images]


def test_a_bag_begins_with_the_image_of_the_init_box(crossing_bag):
    with BagReader(crossing_bag) as bag:
        order = [recorded.topic for recorded in bag.recorded()][:3]
    assert order[0] == "/image/compressed"
    assert "/tracker/init_box" in order


def test_a_video_becomes_a_bag_at_its_own_rate(made_footage, tmp_path):
    frames, first = made_footage
    with VideoWriter(tmp_path / "video.mp4", 10) as video:
        for i, frame in enumerate(frames):
            video.add(frame, i * 10**8)
    assert make_bag(open_footage(tmp_path / "video.mp4"), tmp_path / "bag", init=Box(*first)) == 40
    with BagReader(tmp_path / "bag") as bag:
        images = list(bag.images())
        assert bag.truth() == {}
    assert [stamp - FIRST_STAMP for stamp, _ in images] == [i * 10**8 for i in range(40)]
    pairs = zip(images, frames, strict=True)
    differences = [np.abs(read - frame.astype(float)).mean() for (_, read), frame in pairs]
    assert max(differences) < 8  # grey levels; H.264 and JPEG lose a little


def test_images_without_ground_truth_need_a_box(crossing, tmp_path):
    for name in ("10.jpg", "9.jpg"):
        (tmp_path / name).write_bytes(crossing.images[int(name[:-4])].read_bytes())
    footage = open_footage(tmp_path)
    assert [file.name for file in footage.images] == ["9.jpg", "10.jpg"]
    with pytest.raises(ValueError, match="give --init"):
        make_bag(footage, tmp_path / "bag")
    assert not (tmp_path / "bag").exists()
    assert make_bag(footage, tmp_path / "bag", init=Box(1, 2, 30, 40)) == 2


def test_ctrl_c_leaves_a_readable_bag(crossing, tmp_path):
    class AfterTen(StopRequest):
        calls = 0

        def __bool__(self):
            self.calls += 1
            return self.calls > 10

    assert make_bag(crossing, tmp_path / "bag", stop=AfterTen()) == 10
    with BagReader(tmp_path / "bag") as bag:
        assert len(list(bag.images())) == 10


def test_a_stop_before_the_first_frame_is_no_error(crossing, tmp_path):
    stop = StopRequest()
    stop.requested = True
    assert make_bag(crossing, tmp_path / "bag", stop=stop) == 0
    with BagReader(tmp_path / "bag") as bag:
        assert not list(bag.recorded())


def test_a_recording_survives_an_exception(crossing_bag, tmp_path):
    with BagReader(crossing_bag) as source:
        first = list(source.recorded())[:7]
    with pytest.raises(KeyboardInterrupt), BagWriter(tmp_path / "bag") as bag:
        for recorded in first:
            bag.write_cdr(recorded.topic, recorded.kind, recorded.cdr, recorded.time)
        raise KeyboardInterrupt
    with BagReader(tmp_path / "bag") as bag:
        assert list(bag.recorded()) == first


def nothing(folder, footage):
    return folder / "nothing"


def no_video(folder, footage):
    (folder / "text.mp4").write_text("this is no video")
    return folder / "text.mp4"


def no_images(folder, footage):
    (folder / "empty").mkdir()
    return folder / "empty"


def broken_truth(folder, footage):
    (folder / "img").mkdir()
    (folder / "img" / "1.jpg").write_bytes(footage.images[0].read_bytes())
    (folder / "groundtruth_rect.txt").write_text("1,2,three,4\n")
    return folder


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (nothing, "does not exist"),
        (no_video, "not a video"),
        (no_images, "no image"),
        (broken_truth, "groundtruth_rect.txt, line 1"),
    ],
)
def test_footage_that_is_none_is_refused_with_the_reason(make, says, crossing, tmp_path, capsys):
    source = make(tmp_path, crossing)
    assert make_bag_module.main([str(source), str(tmp_path / "bag")]) == 1
    assert says in capsys.readouterr().err


def test_nothing_is_overwritten(crossing, crossing_bag):
    with pytest.raises(FileExistsError, match="remove it or choose another"):
        make_bag(crossing, crossing_bag)


@pytest.mark.parametrize("rate", [-1, 1e4, float("nan")])
def test_a_rate_that_makes_no_sense_is_refused(crossing, tmp_path, rate):
    with pytest.raises(ValueError, match="rate"):
        make_bag(crossing, tmp_path / "bag", rate=rate)


def test_a_folder_that_is_no_bag_is_refused(tmp_path):
    with pytest.raises(BagError, match=r"no metadata\.yaml"):
        BagReader(tmp_path)


@pytest.mark.parametrize("suffix", [".mcap", ".yaml"])
def test_a_bag_that_was_cut_off_is_refused(crossing_bag, tmp_path, suffix):
    for file in crossing_bag.iterdir():
        half = file.stat().st_size // 2 if file.suffix == suffix else None
        (tmp_path / file.name).write_bytes(file.read_bytes()[:half])
    with pytest.raises(BagError, match="cannot be read"):
        BagReader(tmp_path)


def test_several_cameras_have_to_be_told_apart(crossing_bag, tmp_path):
    with BagReader(crossing_bag) as source, BagWriter(tmp_path / "bag") as bag:
        for recorded in source.recorded("/image/compressed"):
            for topic in ("/left/image", "/right/image"):
                bag.write_cdr(topic, recorded.kind, recorded.cdr, recorded.time)
    with pytest.raises(BagError, match="/left/image, /right/image"):
        BagReader(tmp_path / "bag")
    with BagReader(tmp_path / "bag", "/right/image") as bag:
        assert bag.frames == 40
    with pytest.raises(BagError, match="no images on /image"):
        BagReader(tmp_path / "bag", "/image")
