# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Track a webcam or a video file without ROS: in a window, or into a video file with --out."""

import argparse

import cv2

from het_ros import Box, HierarchicalEnsembleTracker

parser = argparse.ArgumentParser(
    description=__doc__, epilog="example: python3 examples/track_video.py walk.mp4"
)
parser.add_argument("source", nargs="?", default="0", help="video file, or number of the webcam")
parser.add_argument("--box", help="x,y,w,h of the target; without it you draw it in a window")
parser.add_argument("--out", help="video to write, in place of a window")
options = parser.parse_args()

video = cv2.VideoCapture(int(options.source) if options.source.isdigit() else options.source)
more, image = video.read()
if not more:
    parser.error(f"no image from {options.source!r}: name a video file, or a webcam by its number")
rate = video.get(cv2.CAP_PROP_FPS) or 30.0
box = options.box.split(",") if options.box else cv2.selectROI("track", image)
tracker = HierarchicalEnsembleTracker()
estimate = tracker.init(image, Box(*map(float, box)))
code, size = cv2.VideoWriter_fourcc(*"mp4v"), image.shape[1::-1]
writer = cv2.VideoWriter(options.out, code, rate, size) if options.out else None
if writer and not writer.isOpened():
    parser.error(f"{options.out} cannot be written: does its folder exist?")
while more and (writer or cv2.waitKey(1) != 27):  # Escape ends it
    x, y, w, h = map(round, estimate.box.as_tuple())
    text = f"{estimate.state.value} {estimate.score:.2f}"
    cv2.rectangle(image, (x, y), (x + w, y + h), (0, 200, 0), 2)
    cv2.putText(image, text, (8, 24), cv2.FONT_HERSHEY_SIMPLEX, 0.7, (0, 200, 0), 2)
    writer.write(image) if writer else cv2.imshow("track", image)
    more, image = video.read()
    estimate = tracker.update(image, dt=1 / rate) if more else estimate
if writer:
    writer.release()
print(text)
