# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The whole way: camera, tracker and operator as processes, and a person at the page."""

from __future__ import annotations

import contextlib
import threading
import time

import pytest
from graph import PATIENCE
from operator_browser import wait
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node

from het_ros import Box
from het_ros.operator.demo import Camera
from het_ros.ros.messages import BoxError, box_from_polygon, stamp_ns
from het_ros.ros.status import status_values
from het_ros.tools.bag_reader import BagReader
from het_ros.tools.run import shipped_bag

SECOND = 10**9


class Street(Node):
    """The shipped walk as a camera, and what the tracker answers; spun in a thread of its own."""

    def __init__(self, context) -> None:
        from diagnostic_msgs.msg import DiagnosticArray
        from geometry_msgs.msg import PolygonStamped

        super().__init__("street", context=context)
        self.boxes: dict[int, object] = {}
        self.states: dict[int, str] = {}
        self.asked: list = []
        self.inputs = [
            self.create_subscription(PolygonStamped, "/tracker/box", self._on_box, 50),
            self.create_subscription(DiagnosticArray, "/tracker/status", self._on_status, 50),
            self.create_subscription(PolygonStamped, "/tracker/init_box", self.asked.append, 10),
        ]
        with BagReader(shipped_bag()) as bag:
            self.truth = bag.truth()
            self.camera = Camera(self, bag, rate=0.5)  # a busy machine has to keep up
        self._executor = SingleThreadedExecutor(context=context)
        self._executor.add_node(self)
        self._playing = True
        self._thread = threading.Thread(target=self._play)
        self._thread.start()

    def close(self) -> None:
        self._playing = False
        self._thread.join(PATIENCE)
        self.destroy_node()

    def _play(self) -> None:
        while self._playing:
            self._executor.spin_once(timeout_sec=min(max(self.camera.seconds_left(), 0), 0.02))
            if self.camera.seconds_left() <= 0:
                self.camera.send()

    def _on_box(self, message) -> None:
        with contextlib.suppress(BoxError):
            self.boxes[stamp_ns(message.header)] = box_from_polygon(message)

    def _on_status(self, message) -> None:
        self.states[stamp_ns(message.header)] = status_values(message)["state"]

    def truth_at(self, stamp: int):
        """The true box in the image that was sent with a stamp, ns."""
        return self.truth[self.camera.played[stamp]]

    def overlap(self, since: int) -> float:
        """How well the first answer after a stamp covers the target; 0 while there is none."""
        later = sorted(s for s in self.boxes if s >= since and s in self.camera.played)
        tracked = [s for s in later if self.states.get(s) == "TRACKING"]
        return self.boxes[tracked[0]].iou(self.truth_at(tracked[0])) if tracked else 0.0


@pytest.fixture
def street(local_graph):
    node = Street(local_graph.context)
    yield node
    node.close()


def test_a_box_drawn_on_a_frozen_picture_ends_on_the_target(processes, street, visit):
    tracker = processes(
        "tracker", "--ros-args", "-p", "image_transport:=compressed", "-p", "max_gap:=60.0"
    )
    operator = processes("operator", "--ros-args", "-p", "port:=0", "-p", "keep_seconds:=60.0")
    url = wait(
        lambda: next((w for w in operator.log.read_text().split() if "http" in w), ""), "address"
    )
    page = visit(url)
    page.wait_for_pictures()
    page.wait_for_state("IDLE")
    page.page.locator("#direct").uncheck()

    near = street.truth_at(int(page.get("operatorPage.view.image.stamp")))
    page.page.mouse.move(*page.place(near.x, near.y))
    page.page.mouse.down()
    stamp = wait(page.frozen_stamp, "a frozen picture")
    truth = street.truth_at(stamp)
    page.page.mouse.move(*page.place(truth.x + truth.w, truth.y + truth.h), steps=4)
    page.page.mouse.up()
    # The target moved on until the press froze the picture: its corners are put right.
    x, y, w, h = page.box()
    page.drag((x, y), (truth.x, truth.y))
    x, y, w, h = page.box()
    page.drag((x + w, y + h), (truth.x + truth.w, truth.y + truth.h))
    frozen_at = time.monotonic()
    wait(lambda: time.monotonic() - frozen_at > 1.2, "more than a second on the frozen picture")
    assert page.frozen_stamp() == stamp
    drawn = page.box()
    assert Box(*drawn).iou(truth) > 0.8
    page.keys("Enter")

    wait(lambda: street.asked, "the box on its topic")
    assert stamp_ns(street.asked[0].header) == stamp
    sent = box_from_polygon(street.asked[0])
    assert [sent.x, sent.y, sent.w, sent.h] == pytest.approx(drawn, abs=0.01)
    page.wait_for_state("TRACKING")
    assert "tracking started" in wait(lambda: page.text("log"), "the tracker's words")
    # Two seconds of the walk after the frozen picture, played at half the speed.
    wait(lambda: street.overlap(stamp + 4 * SECOND) > 0, "a track two seconds later")
    assert street.overlap(stamp + 4 * SECOND) > 0.4
    assert page.frozen_stamp() == 0

    page.page.locator("#live").focus()
    page.keys("r")
    page.wait_for_state("IDLE")
    assert tracker.poll() is None
    assert operator.poll() is None


def test_the_address_has_a_token_where_others_can_reach_it(processes):
    operator = processes("operator", "--ros-args", "-p", "host:=0.0.0.0", "-p", "port:=0")
    said = wait(lambda: "open http" in operator.log.read_text() and operator.log.read_text(), "")
    assert "#token=" in said
    operator.terminate()
    assert operator.wait(PATIENCE) == 0
    assert "Traceback" not in operator.log.read_text()


@pytest.mark.parametrize(
    "arguments, says",
    [
        (("-p", "port:=-1"), "port"),
        (("-p", "host:=203.0.113.7"), "host:="),
        (("-p", "max_clients:=none"), "max_clients"),
    ],
)
def test_wrong_settings_end_it_with_a_reason(processes, arguments, says):
    operator = processes("operator", "--ros-args", *arguments)
    assert operator.wait(PATIENCE) == 2
    assert says in operator.log.read_text()
    assert "Traceback" not in operator.log.read_text()
