# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Read rosbag2 bags: CDR bytes to play, frames and ground truth to look at.

A bag may come from anybody. Only files inside its folder are read, nothing in it is executed, and
whatever is wrong with it is a :class:`BagError`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray
from rosbags.interfaces import Connection
from rosbags.rosbag2 import Reader

from het_ros.ros.images import decode, to_array
from het_ros.ros.status import status_values
from het_ros.tools.bag_messages import (
    COMPRESSED_IMAGE,
    DIAGNOSTICS,
    IMAGE,
    POLYGON,
    TRUTH_BOX_TOPIC,
    VISIBILITY_TOPIC,
    box_of,
    stamp_of,
)
from het_ros.tools.bag_repair import is_whole
from het_ros.tools.bag_types import is_jazzys
from het_ros.tools.bag_writer import TYPESTORE
from het_ros.tracking.box import Box

Value = TypeVar("Value")
MOST_METADATA = 16_000_000  # bytes; a metadata.yaml is a few thousand, and YAML is slow to read


class BagError(ValueError):
    """A bag that cannot be used; the text says why and what to do."""


class Recorded(NamedTuple):
    """A message as it lies in the bag.

    Attributes:
        topic: its topic.
        kind: its type, e.g. "sensor_msgs/msg/Image".
        time: when it was recorded, ns.
        cdr: its bytes.
    """

    topic: str
    kind: str
    time: int
    cdr: bytes


class BagReader:
    """An open bag.

    Args:
        path: folder of the bag.
        image_topic: which images to take; by default the bag's only ones, or "/image".

    Attributes:
        topics: type of each topic.
        counts: number of messages of each topic.
        image_topic: topic of the images; empty when there are none.

    Raises:
        BagError: there is no bag at ``path``, it is broken or was cut off, leads out of its
            folder, or has several image topics.
    """

    def __init__(self, path: Path | str, image_topic: str | None = None) -> None:
        self.path = Path(path)
        source = _source(self.path)
        try:
            self._reader = Reader(source)
            self._reader.open()
        except Exception as error:  # a stranger's bytes: rosbags raises some twenty kinds
            raise BagError(f"{path} cannot be read as a bag: {error!r}") from error
        connections = self._reader.connections
        if not all(_is_sound(connection) for connection in connections):
            self._reader.close()
            raise BagError(f"{path} cannot be read as a bag: its list of topics is broken")
        self.topics = {connection.topic: connection.msgtype for connection in connections}
        self.counts = {connection.topic: connection.msgcount for connection in connections}
        self.image_topic = self._find_images(image_topic)

    def __enter__(self) -> BagReader:
        return self

    def __exit__(self, *_: object) -> None:
        self._reader.close()

    def _find_images(self, wanted: str | None) -> str:
        found = [t for t, kind in self.topics.items() if kind in (IMAGE, COMPRESSED_IMAGE)]
        if wanted is not None:
            if wanted not in found:
                listed = ", ".join(found) or "none"
                raise BagError(f"{self.path} has no images on {wanted}; it has {listed}")
            return wanted
        preferred = [topic for topic in found if topic in ("/image", "/image/compressed")]
        if len(found) > 1 and len(preferred) != 1:
            raise BagError(f"{self.path} has images on {', '.join(found)}: say which to take")
        return (preferred or found or [""])[0]

    @property
    def frames(self) -> int:
        """Number of images."""
        return self.counts.get(self.image_topic, 0)

    @property
    def compressed(self) -> bool:
        """Whether the images are CompressedImage."""
        return self.topics.get(self.image_topic) == COMPRESSED_IMAGE

    def has_jazzys(self, topic: str) -> bool:
        """Whether the bag defines the topic's type as ROS 2 Jazzy does."""
        return all(is_jazzys(c) for c in self._reader.connections if c.topic == topic)

    def recorded(self, *topics: str) -> Iterator[Recorded]:
        """Messages of some topics (all if none is named) in the order of recording.

        Raises:
            BagError: the file is cut off or broken here; what came before it is right.
        """
        chosen = [c for c in self._reader.connections if not topics or c.topic in topics]
        messages = iter(self._reader.messages(connections=chosen) if chosen else ())
        while True:
            try:
                connection, time, cdr = next(messages)
            except StopIteration:
                return
            except Exception as error:
                raise BagError(f"{self.path} is broken: {error!r}") from error
            yield Recorded(connection.topic, connection.msgtype, time, bytes(cdr))

    def messages(self, *topics: str) -> Iterator[tuple[str, Any]]:
        """Topic and decoded message, in the order of recording.

        Raises:
            BagError: the file or a message is broken, or of a type that is not Jazzy's.
        """
        for topic in topics or self.topics:
            if topic in self.topics and not self.has_jazzys(topic):
                raise BagError(
                    f"{self.path}: {topic} has a {self.topics[topic]} that is not ROS 2 Jazzy's"
                )
        for recorded in self.recorded(*topics):
            try:
                message = TYPESTORE.deserialize_cdr(recorded.cdr, recorded.kind)
            except Exception as error:
                raise BagError(f"{self.path}: a broken message on {recorded.topic}") from error
            yield recorded.topic, message

    def images(self) -> Iterator[tuple[int, NDArray[np.uint8]]]:
        """Header stamp (ns) and pixels, (H, W, 3) BGR or (H, W) gray uint8, of each image."""
        read = decode if self.compressed else to_array
        for _, message in self.messages(self.image_topic):
            yield stamp_of(message), read(message)

    def stamps(self) -> list[int]:
        """Header stamps of the images, ns, in the order of recording."""
        return [header_stamp(recorded.cdr) for recorded in self.recorded(self.image_topic)]

    def truth(self) -> dict[int, Box]:
        """Ground-truth boxes by header stamp; empty if the bag has none."""
        if self.topics.get(TRUTH_BOX_TOPIC) != POLYGON:
            return {}
        return {stamp_of(m): self._read(box_of, m) for _, m in self.messages(TRUTH_BOX_TOPIC)}

    def visibility(self) -> dict[int, float]:
        """Part of the target that can be seen, 0..1, by header stamp; empty if not recorded."""
        if self.topics.get(VISIBILITY_TOPIC) != DIAGNOSTICS:
            return {}
        return {
            stamp_of(m): self._read(_visible_part, m) for _, m in self.messages(VISIBILITY_TOPIC)
        }

    def _read(self, reading: Callable[[Any], Value], message: Any) -> Value:
        try:
            return reading(message)
        except (ValueError, LookupError) as error:
            raise BagError(f"{self.path}: a ground truth that is none: {error}") from error


def _source(path: Path) -> Path:
    """What to open of a bag's folder: itself, or its only file where there is no metadata.

    A recording that a full disk ended has no metadata.yaml, one that was killed no end either.

    Raises:
        BagError: there is no bag, or it has to be repaired.
    """
    if (path / "metadata.yaml").is_file():
        _check_folder(path)
        return path
    files = list(path.glob("*.mcap")) if path.is_dir() else []
    if len(files) != 1:
        raise BagError(f"{path} is no rosbag2: there is no metadata.yaml in that folder")
    if not files[0].resolve().is_relative_to(path.resolve()):
        raise BagError(f"{files[0]} leads out of the bag's folder: put the file itself there")
    if not is_whole(files[0]):
        raise BagError(
            f"{path} was cut off while it was recorded: "
            f"`ros2 run het_ros bag_repair {files[0]}` ends it so that it can be read"
        )
    return files[0]


def _check_folder(path: Path) -> None:
    """Raise BagError for what is too large to be a bag's metadata, or leads out of its folder."""
    if (path / "metadata.yaml").stat().st_size > MOST_METADATA:
        raise BagError(f"{path} is no bag: its metadata.yaml is over {MOST_METADATA:,} bytes")
    folder = path.resolve()
    for file in path.iterdir():
        if not file.resolve().is_relative_to(folder):
            raise BagError(f"{file} leads out of the bag's folder: put the file itself there")


def _is_sound(connection: Connection) -> bool:
    """Whether name, type and number of messages, as metadata.yaml gives them, are such."""
    name, kind, count = connection.topic, connection.msgtype, connection.msgcount
    return isinstance(name, str) and isinstance(kind, str) and type(count) is int and count >= 0


def _visible_part(message: Any) -> float:
    return float(status_values(message)["visible"])


def header_stamp(cdr: bytes) -> int:
    """Stamp (ns) of a message that begins with a std_msgs/Header, from its little-endian CDR."""
    seconds = int.from_bytes(cdr[4:8], "little", signed=True)
    return seconds * 10**9 + int.from_bytes(cdr[8:12], "little")
