# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""What was recorded stays readable when the disk takes no more."""

from __future__ import annotations

import contextlib
import errno
import os
import resource
import shutil
import signal
import subprocess
import sys

import numpy as np
import pytest

from het_ros.tools.bag_messages import IMAGE, IMAGE_TOPIC, image_message, stamp_of
from het_ros.tools.bag_reader import BagError, BagReader
from het_ros.tools.bag_repair import END, cut_and_end, is_whole, whole_records
from het_ros.tools.bag_repair import main as repair
from het_ros.tools.bag_writer import RESERVE, BagWriteError, BagWriter

PIXELS = np.random.default_rng(0).integers(0, 255, (120, 160, 3), np.uint8)
MEGABYTE = 2**20


@pytest.fixture
def small_disk(tmp_path):
    """``small_disk(bytes)`` gives a folder with so much space, a file system of its own."""
    mounted = []

    def mount(size: int):
        folder = tmp_path / f"disk{len(mounted)}"
        folder.mkdir()
        words = ["mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", str(folder)]
        if os.geteuid() != 0 or subprocess.run(words, stderr=subprocess.DEVNULL).returncode:
            pytest.skip("a small file system takes root")
        mounted.append(folder)
        return folder

    yield mount
    for folder in mounted:
        subprocess.run(["umount", "-l", str(folder)], check=True)


@contextlib.contextmanager
def largest_file(size: int):
    """No file of this process grows over so many bytes: a disk that is full, without root."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    handler = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
        signal.signal(signal.SIGXFSZ, handler)


class ReadOnly:
    """An open file whose disk has turned read-only."""

    def tell(self) -> int:
        return 0

    def write(self, data) -> int:
        raise OSError(errno.EROFS, os.strerror(errno.EROFS))

    def close(self) -> None:
        pass


def fill(path) -> tuple[int, str]:
    """Write images until it fails; how many were taken, and what was said."""
    written = 0
    with pytest.raises(BagWriteError) as raised, BagWriter(path) as bag:
        for written in range(10_000):
            bag.write(IMAGE_TOPIC, image_message(PIXELS, 10**9 + written, "camera"), 10**9)
    return written, str(raised.value)


def stamps(path) -> list[int]:
    with BagReader(path) as bag:
        return [stamp_of(message) for _, message in bag.messages(IMAGE_TOPIC)]


@pytest.mark.parametrize("size", [3 * MEGABYTE, 5 * MEGABYTE + 12345, 12 * MEGABYTE])
def test_a_full_disk_keeps_all_that_was_taken(small_disk, size):
    folder = small_disk(size)
    written, said = fill(folder / "bag")
    assert "No space left on device" in said and "kept" in said
    kept = stamps(folder / "bag")
    assert kept == [10**9 + i for i in range(len(kept))] and len(kept) == written + 1
    assert (folder / "bag" / "metadata.yaml").is_file()
    assert not list(folder.rglob("*.reserve"))


@pytest.mark.parametrize("size", [100, 1000, MEGABYTE, 5 * MEGABYTE + 12345])
def test_a_file_that_cannot_grow_keeps_what_is_in_it(tmp_path, size):
    with largest_file(size):
        written, said = fill(tmp_path / "bag")
    assert "File too large" in said
    kept = stamps(tmp_path / "bag") if size > MEGABYTE else []
    # What was not on the disk yet, a chunk and the one that failed, is what may be missing.
    chunk = 1 + MEGABYTE // PIXELS.nbytes
    assert kept == [10**9 + i for i in range(len(kept))]
    assert len(kept) >= min(written, size // PIXELS.nbytes) - 2 * chunk


def test_a_disk_that_turns_read_only_leaves_what_can_be_repaired(small_disk, capsys):
    folder = small_disk(12 * MEGABYTE)
    path = folder / "bag"
    with pytest.raises(BagWriteError, match="can be read after"), BagWriter(path) as bag:
        for i in range(60):
            bag.write(IMAGE_TOPIC, image_message(PIXELS, 10**9 + i, "camera"), 10**9)
        # Linux does so after an error of the disk, with files open; asked for, it wants them shut.
        bag._writer.storage.bio.close()
        bag._writer.storage.bio = ReadOnly()
        subprocess.run(["mount", "-o", "remount,ro", str(folder)], check=True)
    subprocess.run(["mount", "-o", "remount,rw", str(folder)], check=True)
    with pytest.raises(BagError, match=r"bag_repair .*bag\.mcap"):
        BagReader(path)
    assert repair([str(path / "bag.mcap")]) == 0
    assert "can be read again" in capsys.readouterr().out
    kept = stamps(path)
    assert len(kept) >= 50 and kept == [10**9 + i for i in range(len(kept))]


def test_a_killed_recorder_leaves_what_can_be_repaired(tmp_path):
    program = (
        "import numpy, os, signal, sys\n"
        "from het_ros.tools.bag_writer import BagWriter\n"
        "from het_ros.tools.bag_messages import image_message\n"
        "with BagWriter(sys.argv[1]) as bag:\n"
        "    for i in range(60):\n"
        "        pixels = numpy.full((120, 160, 3), i, numpy.uint8)\n"
        "        bag.write('/image', image_message(pixels, 1 + i, 'camera'), 1 + i)\n"
        "    os.kill(os.getpid(), signal.SIGKILL)\n"
    )
    path = tmp_path / "bag"
    ended = subprocess.run([sys.executable, "-c", program, str(path)])
    assert ended.returncode == -signal.SIGKILL
    with pytest.raises(BagError, match="cut off"):
        BagReader(path)
    assert repair([str(path / "bag.mcap")]) == 0
    with BagReader(path) as bag:
        kept = [(stamp, int(pixels[0, 0, 0])) for stamp, pixels in bag.images()]
    assert len(kept) >= 36
    assert kept == [(1 + i, i) for i in range(len(kept))]


def test_repair_wherever_it_was_cut(tmp_path, capsys):
    """Cut at any byte, a file is readable after the repair, with a part of its messages."""
    with BagWriter(tmp_path / "bag") as bag:
        for i in range(60):
            bag.write(IMAGE_TOPIC, image_message(PIXELS, 1 + i, "camera"), 1 + i)
    whole = (tmp_path / "bag" / "bag.mcap").read_bytes()
    cut = tmp_path / "cut"
    for length in np.random.default_rng(0).integers(9, len(whole) - 1, 40):
        shutil.rmtree(cut, ignore_errors=True)
        cut.mkdir()
        (cut / "cut.mcap").write_bytes(whole[:length])
        assert repair([str(cut / "cut.mcap")]) == 0
        try:
            kept = stamps(cut)
        except BagError as error:  # nothing but the head of the file was there
            assert length < MEGABYTE, error
            continue
        assert kept == [1 + i for i in range(len(kept))]
        assert len(kept) >= length // PIXELS.nbytes - MEGABYTE // PIXELS.nbytes - 2
    capsys.readouterr()
    (cut / "cut.mcap").write_bytes(whole)
    assert repair([str(cut / "cut.mcap")]) == 0
    assert "whole already" in capsys.readouterr().out
    (cut / "cut.mcap").write_bytes(b"no bag")
    assert repair([str(cut / "cut.mcap")]) == 1
    assert "no mcap" in capsys.readouterr().err


def test_the_end_needs_little(tmp_path):
    file = tmp_path / "x.mcap"
    with BagWriter(tmp_path / "bag") as bag:
        bag.add_topic(IMAGE_TOPIC, IMAGE)
    shutil.copy(tmp_path / "bag" / "bag.mcap", file)
    ends = whole_records(file)
    cut_and_end(file, ends[-1])
    assert is_whole(file) and file.stat().st_size == ends[-1] + len(END) and len(END) < 60


def test_make_bag_says_so_and_keeps_what_there_is(small_disk, sequences):
    """Through the command line: an exit code of 1, a sentence, no traceback, a readable bag."""
    out = small_disk(3 * MEGABYTE) / "bag"
    ended = subprocess.run(
        [sys.executable, "-m", "het_ros.tools.make_bag", str(sequences / "Woman"), str(out)],
        capture_output=True,
        text=True,
    )
    assert ended.returncode == 1
    assert "No space left on device" in ended.stderr and "Traceback" not in ended.stderr
    with BagReader(out) as bag:
        assert len(list(bag.images())) == bag.frames >= 50


def test_a_disk_without_space_is_told_before_anything_is_recorded(small_disk, crossing_bag):
    out = small_disk(RESERVE // 2) / "out"
    words = ["het_ros.tools.replay", str(crossing_bag), "--out", str(out)]
    ended = subprocess.run([sys.executable, "-m", *words], capture_output=True, text=True)
    assert ended.returncode == 1
    assert "takes 2 MB at least" in ended.stderr and "Traceback" not in ended.stderr
    assert not list(out.iterdir())


def test_a_folder_that_is_read_only_is_told_at_once(small_disk, crossing_bag):
    folder = small_disk(MEGABYTE)
    subprocess.run(["mount", "-o", "remount,ro", str(folder)], check=True)
    words = ["het_ros.tools.replay", str(crossing_bag), "--out", str(folder / "out")]
    ended = subprocess.run([sys.executable, "-m", *words], capture_output=True, text=True)
    assert ended.returncode == 1
    assert "Read-only file system" in ended.stderr and "Traceback" not in ended.stderr
