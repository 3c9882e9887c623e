# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import av
import numpy as np
import pytest

from het_ros import Box, State
from het_ros.tools.drawing import annotate
from het_ros.tools.plot import plot_track
from het_ros.tools.results import Row, read_csv, write_csv
from het_ros.tools.summary import Truth, summarise
from het_ros.tools.video import VideoWriter

ROWS = [
    Row(10**18, Box(1.5, -2.25, 17, 50), (3.125, -0.5), 1.0, State.TRACKING),
    Row(10**18 + 33_333_333, Box(0, 0, 17, 50), (0.0, 0.0), 0.25, State.COASTING),
    Row(10**18 + 66_666_667, None, None, 0.0, State.LOST),
    Row(10**18 + 100_000_000),
    Row(10**18 + 133_333_333, None, None, 0.0, State.IDLE),
]


def test_rows_come_back_from_the_csv(tmp_path):
    write_csv(ROWS, tmp_path / "track.csv")
    assert read_csv(tmp_path / "track.csv") == ROWS
    lines = (tmp_path / "track.csv").read_text().splitlines()
    assert lines[:2] == [
        "stamp,x,y,w,h,vx,vy,score,state",
        "1000000000.000000000,1.500,-2.250,17.000,50.000,3.125,-0.500,1.0000,TRACKING",
    ]
    assert lines[4] == "1000000000.100000000,,,,,,,,"


def test_another_csv_is_refused(tmp_path):
    (tmp_path / "other.csv").write_text("a,b\n1,2\n")
    with pytest.raises(ValueError, match=r"no track\.csv"):
        read_csv(tmp_path / "other.csv")


@pytest.mark.parametrize("row", ROWS)
@pytest.mark.parametrize("shape", [(48, 64), (480, 640, 3), (33, 1301, 3)])
def test_every_answer_can_be_drawn(row, shape):
    image = np.full(shape, 90, np.uint8)
    canvas = annotate(image, row, Box(5, 5, 10, 10))
    assert canvas.ndim == 3
    assert canvas.shape[1] >= 640
    assert (image == 90).all()
    assert len(np.unique(canvas)) > 1


def test_the_box_is_drawn_where_it_is():
    """A box of whole px gets its line on the border between inside and outside."""
    row = Row(1, Box(200, 100, 40, 60), None, None, State.TRACKING)
    canvas = annotate(np.zeros((480, 640, 3), np.uint8), row, None)
    ys, xs = np.nonzero(canvas[:300, :, 1] > 60)
    assert (xs.min() + xs.max() + 1) / 2 == pytest.approx(220, abs=0.5)
    assert (ys.min() + ys.max() + 1) / 2 == pytest.approx(130, abs=0.5)
    assert np.ptp(xs) + 1 == pytest.approx(40, abs=4)


def decoded(path) -> tuple[av.video.stream.VideoStream, list]:
    with av.open(str(path)) as container:
        stream = container.streams.video[0]
        return stream, [(float(f.pts * f.time_base), f) for f in container.decode(stream)]


def test_a_video_shows_every_frame_at_its_stamp(tmp_path):
    stamps = [0, 100, 200, 600, 700]  # ms: a gap in it
    with VideoWriter(tmp_path / "v.mp4", 10) as video:
        for grey, stamp in enumerate(stamps):
            video.add(np.full((121, 81, 3), 40 * grey, np.uint8), stamp * 10**6)
    stream, frames = decoded(tmp_path / "v.mp4")
    assert stream.codec_context.name == "h264"
    assert (stream.width, stream.height, stream.pix_fmt) == (80, 120, "yuv420p")
    assert [time for time, _ in frames] == pytest.approx([s / 1000 for s in stamps], abs=1e-4)
    greys = [frame.to_ndarray(format="gray").mean() for _, frame in frames]
    assert greys == pytest.approx([0, 40, 80, 120, 160], abs=6)


def test_a_browser_finds_the_index_first(tmp_path):
    with VideoWriter(tmp_path / "v.mp4", 30) as video:
        video.add(np.zeros((64, 64, 3), np.uint8), 0)
    data = (tmp_path / "v.mp4").read_bytes()
    assert 0 < data.find(b"moov") < data.find(b"mdat")


@pytest.mark.parametrize("stamps", [[5, 5, 5], [10**9, 0, 2 * 10**9]], ids=["frozen", "backwards"])
def test_strange_stamps_still_make_a_video(tmp_path, stamps):
    with VideoWriter(tmp_path / "v.mp4", 30) as video:
        for stamp in stamps:
            video.add(np.zeros((64, 64, 3), np.uint8), stamp)
    assert len(decoded(tmp_path / "v.mp4")[1]) == 3


def test_an_interrupted_video_can_be_seen(tmp_path):
    with pytest.raises(KeyboardInterrupt), VideoWriter(tmp_path / "v.mp4", 30) as video:
        for index in range(10):
            video.add(np.zeros((64, 64, 3), np.uint8), index * 33 * 10**6)
        raise KeyboardInterrupt
    assert len(decoded(tmp_path / "v.mp4")[1]) == 10


def test_a_camera_that_changes_its_size_still_makes_a_video(tmp_path):
    with VideoWriter(tmp_path / "v.mp4", 30) as video:
        video.add(np.zeros((64, 64, 3), np.uint8), 0)
        video.add(np.zeros((120, 160, 3), np.uint8), 33 * 10**6)
    assert [(f.width, f.height) for _, f in decoded(tmp_path / "v.mp4")[1]] == [(64, 64)] * 2


@pytest.mark.parametrize(
    ("rows", "truth"),
    [
        (ROWS, [Truth()] * 5),
        (ROWS, [Truth(Box(0, 0, 17, 50)), Truth(), *[Truth(Box(1, 1, 5, 5), 0.05)] * 3]),
        (ROWS[3:4], [Truth()]),
        ([], []),
    ],
    ids=["no truth", "truth", "nothing answered", "no frames"],
)
def test_every_track_can_be_plotted(tmp_path, rows, truth):
    strip = [(i, np.zeros((48, 64, 3), np.uint8)) for i in range(len(rows))]
    plot_track(tmp_path / "track.png", rows, truth, strip, "a test")
    assert (tmp_path / "track.png").read_bytes().startswith(b"\x89PNG")


def test_a_summary_counts_answers_and_holds_the_tracker_to_what_can_be_seen():
    here, there = Box(10, 10, 20, 20), Box(100, 10, 20, 20)
    rows = [
        Row(0, here, (0.0, 0.0), 1.0, State.TRACKING),
        Row(10**8, Box(10, 20, 20, 20), (0.0, 0.0), 0.9, State.TRACKING),
        Row(2 * 10**8, there, (0.0, 0.0), 0.1, State.COASTING),
        Row(3 * 10**8, None, None, 0.0, State.LOST),
        Row(4 * 10**8),
    ]
    truth = [Truth(here), Truth(here), Truth(here, 0.0), Truth(here, 0.05), Truth()]
    summary = summarise(rows, truth, np.array([10.0, 20.0, 30.0, 40.0]))
    assert (summary.sent, summary.answered, summary.answered_share) == (5, 4, 0.8)
    assert summary.seconds == pytest.approx({"TRACKING": 0.2, "COASTING": 0.1, "LOST": 0.1})
    assert summary.score.frames == 2
    assert summary.score.mean_overlap == pytest.approx((1 + 1 / 3) / 2)
    assert (summary.hidden, summary.hidden_told) == (2, 2)
    assert summary.lines() == [
        "frames    5 sent, 4 answered (80.0%)",
        "states    TRACKING 0.2 s, COASTING 0.1 s, LOST 0.1 s",
        "latency   25.0 ms (median), 38.5 ms (95 %)",
        "accuracy  mean IoU 0.667, centre within 20 px in 100.0% of 2 frames",
        "hidden    in 2 frames; COASTING or LOST in 2 of them",
    ]


def test_a_run_without_frames_has_a_summary():
    assert summarise([], [], np.array([])).lines() == [
        "frames    0 sent, 0 answered (0.0%)",
        "states    none",
    ]
