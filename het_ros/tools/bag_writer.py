# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Write rosbag2 bags in mcap without ROS being installed."""

from __future__ import annotations

import errno
import os
from contextlib import suppress
from pathlib import Path
from typing import Any

from rosbags.interfaces import Connection
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

from het_ros.tools.bag_repair import cut_and_end, is_whole

TYPESTORE = get_typestore(Stores.ROS2_JAZZY)
RESERVE = 2 * 2**20  # bytes: what is not on the disk yet (1 MB at most), the index and metadata


class BagWriteError(OSError):
    """A bag could not be written to its end; the text says why, and what is kept."""


class BagWriter:
    """A bag to which messages are added one by one; it is whole again after every exit.

    rosbags' own writer throws the index away when an exception leaves its block. A recording that
    was interrupted is worth keeping, so this one closes the bag in any case. Space for that is
    reserved from the start: on a full disk all that was added before is kept. Where nothing can
    be written at all, what is on the disk is ended so that it can be read (see
    :mod:`het_ros.tools.bag_repair`).

    Args:
        path: folder of the bag; it must not exist yet.
        zstd: compress the messages (raw images; JPEG gains nothing).

    Raises:
        FileExistsError: there is something at ``path`` already.
        OSError: nothing can be written there, or less than a recording takes.
    """

    def __init__(self, path: Path | str, *, zstd: bool = False) -> None:
        self.path = Path(path)
        if self.path.exists():
            raise FileExistsError(f"{self.path} exists: remove it or choose another name")
        self._writer = Writer(self.path, version=9, storage_plugin=StoragePlugin.MCAP)
        if zstd:
            self._writer.set_compression(CompressionMode.STORAGE, CompressionFormat.ZSTD)
        self._connections: dict[str, Connection] = {}
        self._file = self.path / f"{self.path.name}.mcap"
        self._reserve = self.path / f"{self.path.name}.reserve"
        self._sound = 0  # so many bytes of the file are whole records
        self._broken: OSError | None = None

    def __enter__(self) -> BagWriter:
        self._writer.open()
        try:
            with self._reserve.open("xb") as file:
                os.posix_fallocate(file.fileno(), 0, RESERVE)
        except OSError as error:
            if error.errno == errno.ENOSPC:
                self._leave_nothing()
                raise BagWriteError(
                    f"{self.path} cannot be written: {_words(error)}; "
                    f"a recording takes {RESERVE / 1e6:.0f} MB at least"
                ) from error
        return self

    def __exit__(self, *_: object) -> None:
        with suppress(OSError):
            self._reserve.unlink()
        try:
            if self._broken:
                self._back_to_sound()
            else:
                self._sound = self._position()
            self._writer.close()
        except OSError as why:
            self._end_what_there_is(why)

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
        """Add a message of type ``kind`` ("sensor_msgs/msg/Image") that is CDR bytes already.

        Raises:
            BagWriteError: the disk does not take it; what was added before is kept.
        """
        self.add_topic(topic, kind)
        if not self._broken:
            self._sound = self._position()
            connection = self._connections[topic]
            try:
                self._writer.write(connection, stamp, cdr)
                return
            except OSError as why:
                self._broken = why
                # It failed to put a chunk on the disk that holds this message: it is kept too.
                self._writer.counts[connection.id] += 1
        raise BagWriteError(
            f"{self.path} cannot be written: {_words(self._broken)}; "
            "what was recorded before is kept there"
        ) from self._broken

    def _leave_nothing(self) -> None:
        """Take back a bag that holds nothing yet."""
        self._writer.abort()
        for file in (self._reserve, self._file):
            file.unlink(missing_ok=True)
        with suppress(OSError):
            self.path.rmdir()

    def _position(self) -> int:
        return int(self._writer.storage.bio.tell()) if self._writer.storage else 0

    def _back_to_sound(self) -> None:
        """Take back the record that was written in part; raises OSError where that fails."""
        storage = self._writer.storage
        if storage is not None:
            storage.bio.seek(self._sound)
            storage.bio.truncate()

    def _end_what_there_is(self, why: OSError) -> None:
        """End the file behind its last whole record; raises BagWriteError in any case."""
        with suppress(OSError):
            self._writer.abort()
        try:
            if not is_whole(self._file):
                cut_and_end(self._file, self._sound)
        except OSError:
            raise BagWriteError(
                f"{self.path} cannot be written: {_words(why)}; what is there can be read after "
                f"`ros2 run het_ros bag_repair {self._file}` on a disk with space"
            ) from why
        raise BagWriteError(
            f"{self.path} cannot be written to its end: {_words(why)}; "
            "what is on the disk can be read"
        ) from why


def _words(error: OSError | None) -> str:
    return (error.strerror if error else None) or repr(error)
