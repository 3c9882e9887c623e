"""Write rosbag2 bags in mcap without ROS being installed."""

from __future__ import annotations

from pathlib import Path
from types import TracebackType
from typing import Any

from rosbags.interfaces import Connection
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

TYPESTORE = get_typestore(Stores.ROS2_JAZZY)


class BagWriter:
    """A bag to which messages are added one by one; it is whole again after every exit.

    rosbags' own writer throws the index away when an exception leaves its block. A recording that
    was interrupted is worth keeping, so this one closes the bag in any case.

    Args:
        path: folder of the bag; it must not exist yet.
        zstd: compress the messages (raw images; JPEG gains nothing).

    Raises:
        FileExistsError: there is something at ``path`` already.
    """

    def __init__(self, path: Path | str, *, zstd: bool = False) -> None:
        self.path = Path(path)
        if self.path.exists():
            raise FileExistsError(f"{self.path} exists: remove it or choose another name")
        self._writer = Writer(self.path, version=9, storage_plugin=StoragePlugin.MCAP)
        if zstd:
            self._writer.set_compression(CompressionMode.STORAGE, CompressionFormat.ZSTD)
        self._connections: dict[str, Connection] = {}

    def __enter__(self) -> BagWriter:
        self._writer.open()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._writer.close()

    def add_topic(self, topic: str, kind: str) -> None:
        """Declare a topic, so that it is in the bag even if nothing is ever sent on it."""
        if topic not in self._connections:
            self._connections[topic] = self._writer.add_connection(
                topic, kind, typestore=TYPESTORE
            )

    def write(self, topic: str, message: Any, stamp: int) -> None:
        """Add a message made from ``TYPESTORE.types``, logged at ``stamp`` (ns)."""
        kind = message.__msgtype__
        self.write_cdr(topic, kind, TYPESTORE.serialize_cdr(message, kind), stamp)

    def write_cdr(self, topic: str, kind: str, cdr: bytes | memoryview, stamp: int) -> None:
        """Add a message of type ``kind`` ("sensor_msgs/msg/Image") that is CDR bytes already."""
        self.add_topic(topic, kind)
        self._writer.write(self._connections[topic], stamp, cdr)
