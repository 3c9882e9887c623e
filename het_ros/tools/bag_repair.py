# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""End an mcap file that was cut off (a full disk, a killed recorder) so that it can be read.

A recording that was cut off lacks its index and often ends in half a record. That half is cut away
and an end without an index is put there: readers then find the messages by scanning.
"""

from __future__ import annotations

import struct
import sys
from collections.abc import Sequence
from pathlib import Path

from het_ros.tools.arguments import command

MAGIC = b"\x89MCAP0\r\n"
DATA_END, FOOTER = 0x0F, 0x02
RECORD_HEAD = struct.Struct("<BQ")  # opcode, length of what follows
END = (
    RECORD_HEAD.pack(DATA_END, 4)
    + struct.pack("<I", 0)
    + RECORD_HEAD.pack(FOOTER, 20)
    + struct.pack("<QQI", 0, 0, 0)  # no summary
    + MAGIC
)

EXAMPLE = """example:
  ros2 run het_ros bag_repair out/play/bag/bag.mcap
"""


def cut_and_end(file: Path, sound: int) -> None:
    """Keep the first ``sound`` bytes, or fewer where a record or the end does not fit behind.

    Raises:
        OSError: the file cannot be written, not even shortened.
    """
    ends = whole_records(file, sound)
    for length in reversed(ends[-3:]):
        try:
            with file.open("r+b") as opened:
                opened.truncate(length)
                opened.seek(length)
                opened.write(END)
            return
        except OSError as error:
            failed = error
    raise failed


def whole_records(file: Path, most: int | None = None) -> list[int]:
    """Where the file's whole records end, bytes from its start; at least after the magic.

    Raises:
        ValueError: the file does not begin as an mcap does.
    """
    size = file.stat().st_size if most is None else most
    with file.open("rb") as opened:
        if opened.read(len(MAGIC)) != MAGIC:
            raise ValueError(f"{file} is no mcap file: it does not begin as one")
        ends = [len(MAGIC)]
        while len(head := opened.read(RECORD_HEAD.size)) == RECORD_HEAD.size:
            opcode, length = RECORD_HEAD.unpack(head)
            end = ends[-1] + RECORD_HEAD.size + length
            if opcode in (0, DATA_END, FOOTER) or end > size:
                break
            ends.append(end)
            opened.seek(end)
    return ends


def is_whole(file: Path) -> bool:
    """Whether the file has an end."""
    with file.open("rb") as opened:
        if opened.read(len(MAGIC)) != MAGIC:
            return False
        opened.seek(0, 2)
        opened.seek(max(opened.tell() - len(MAGIC), len(MAGIC)))
        return opened.read() == MAGIC


def main(argv: Sequence[str] | None = None) -> int:
    """Command line."""
    parser = command("bag_repair", __doc__, EXAMPLE)
    parser.add_argument("file", type=Path, help="an mcap file; it is changed in its place")
    options = parser.parse_args(argv)
    try:
        if is_whole(options.file):
            print(f"{options.file} is whole already")
            return 0
        before = options.file.stat().st_size
        sound = whole_records(options.file)[-1]
        cut_and_end(options.file, sound)
    except (OSError, ValueError) as error:
        print(f"bag_repair: {error}", file=sys.stderr)
        return 1
    print(f"{options.file} can be read again; {before - sound} bytes of half a record are gone")
    return 0


if __name__ == "__main__":
    sys.exit(main())
