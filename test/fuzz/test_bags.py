# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Bags from strangers: whatever is in the files, it is read or it is a BagError; nothing else."""

import shutil
import tempfile
from functools import cache
from pathlib import Path

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer

from het_ros.ros.images import ImageError
from het_ros.tools import bag_repair
from het_ros.tools.bag_messages import (
    COMPRESSED_IMAGE,
    DIAGNOSTICS,
    IMAGE,
    IMAGE_TOPIC,
    INIT_BOX_TOPIC,
    POLYGON,
    TRUTH_BOX_TOPIC,
    VISIBILITY_TOPIC,
    box_message,
    image_message,
)
from het_ros.tools.bag_reader import BagError, BagReader
from het_ros.tools.bag_writer import TYPESTORE, BagWriter
from het_ros.tools.message_types import check_types

from .cases import cases, counted
from .footage import BOX, frames

KINDS = ["mcap", "mcap, messages", "mcap, chunks", "mcap, file", "sqlite3"]
COMPRESSION = {
    "mcap, messages": CompressionMode.MESSAGE,
    "mcap, chunks": CompressionMode.STORAGE,
    "mcap, file": CompressionMode.FILE,
}
NUMBERS = st.sampled_from(["-1", "0", "1e999", "99999999999999999999", "x", "[]", "null", "true"])
PATHS = st.sampled_from(
    ["../../etc/passwd", "/etc/passwd", "..", ".", "", "bag.mcap/../..", "~", "\\0", "a\nb", "{}"]
)
LINES = st.sampled_from(
    ["!!python/object/apply:os.system ['touch hacked']", "a: &a [*a, *a]", "\t- x", "%YAML 9.9"]
)


@cache
def whole_bag(kind: str) -> dict[str, bytes]:
    """The files of a sound bag with 4 images and their truth."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "bag"
        plugin = StoragePlugin.SQLITE3 if kind == "sqlite3" else StoragePlugin.MCAP
        writer = Writer(path, version=9, storage_plugin=plugin)
        if kind in COMPRESSION:
            writer.set_compression(COMPRESSION[kind], CompressionFormat.ZSTD)
        with writer:
            topics = {IMAGE_TOPIC: IMAGE, TRUTH_BOX_TOPIC: POLYGON, INIT_BOX_TOPIC: POLYGON}
            made = {
                topic: writer.add_connection(topic, of, typestore=TYPESTORE)
                for topic, of in topics.items()
            }
            for i in range(4):
                stamp = 10**18 + i
                small = np.ascontiguousarray(frames()[i][::8, ::8])
                image, box = image_message(small, stamp, "camera"), box_message(BOX, stamp, "c")
                for topic, message in ((IMAGE_TOPIC, image), (TRUTH_BOX_TOPIC, box)):
                    cdr = TYPESTORE.serialize_cdr(message, topics[topic])
                    writer.write(made[topic], stamp, cdr)
        return {file.name: file.read_bytes() for file in path.iterdir()}


def read_all(path: Path) -> int:
    """Do with a bag all that the tools do; how many images could be read. BagError or nothing."""
    read = 0
    try:
        with BagReader(path) as bag:
            for topic in bag.topics:
                bag.has_jazzys(topic)
            check_types(bag, list(bag.topics))
            bag.stamps()
            bag.truth()
            bag.visibility()
            assert all(isinstance(recorded.cdr, bytes) for recorded in bag.recorded())
            if bag.image_topic:
                for _, pixels in bag.images():
                    assert pixels.dtype == np.uint8
                    read += 1
    except (BagError, ImageError) as error:
        assert str(error)
    return read


def in_a_folder(files: dict[str, bytes], links: dict[str, str] | None = None) -> int:
    """Read a bag of these files; nothing beside them is made or changed."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "bag"
        path.mkdir()
        for name, data in files.items():
            (path / name).write_bytes(data)
        for name, target in (links or {}).items():
            (path / name).symlink_to(target)
        read = read_all(path)
        assert sorted(p.name for p in path.iterdir()) == sorted([*files, *(links or {})])
        assert all((path / name).read_bytes() == data for name, data in files.items())
        assert [p.name for p in Path(folder).iterdir()] == ["bag"]
    return read


def storage_of(files: dict[str, bytes]) -> str:
    return next(name for name in files if name != "metadata.yaml")


@cases(5)
@given(st.sampled_from(KINDS))
@counted
def test_a_sound_bag_is_read(kind):
    assert in_a_folder(whole_bag(kind)) == 4


@cases(60)
@given(st.data())
@counted
def test_storage_cut_off_or_changed(data):
    files = dict(whole_bag(data.draw(st.sampled_from(KINDS))))
    name = storage_of(files)
    broken = bytearray(files[name])
    for _ in range(data.draw(st.sampled_from([0, 1, 2, 10, 100]))):
        place = data.draw(st.integers(0, len(broken) - 1))
        broken[place] = data.draw(st.integers(0, 255))
    if data.draw(st.booleans()):
        broken = broken[: data.draw(st.integers(0, len(broken)))]
    if data.draw(st.booleans()):
        broken += data.draw(st.binary(max_size=50))
    files[name] = bytes(broken)
    if data.draw(st.integers(0, 5)) == 0:  # as a recorder that was killed leaves it
        del files["metadata.yaml"]
    in_a_folder(files)


@cases(20)
@given(st.data())
@counted
def test_repair_of_what_was_cut_off_or_changed(data):
    broken = bytearray(whole_bag("mcap")["bag.mcap"])
    for _ in range(data.draw(st.sampled_from([0, 0, 1, 5]))):
        broken[data.draw(st.integers(0, len(broken) - 1))] = data.draw(st.integers(0, 255))
    broken = broken[: data.draw(st.integers(0, len(broken)))]
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "bag.mcap"
        file.write_bytes(broken)
        assert bag_repair.main([str(file)]) in (0, 1)
        assert [p.name for p in Path(folder).iterdir()] == ["bag.mcap"]
        read_all(Path(folder))


@cases(60)
@given(st.data())
@counted
def test_metadata_that_lies(data):
    files = dict(whole_bag(data.draw(st.sampled_from(KINDS))))
    lines = files["metadata.yaml"].decode().split("\n")
    for _ in range(data.draw(st.integers(1, 3))):
        place = data.draw(st.integers(0, len(lines) - 1))
        key, colon, _ = lines[place].partition(": ")
        action = data.draw(st.sampled_from(["number", "path", "line", "remove", "text", "twice"]))
        if action == "remove":
            lines[place] = ""
        elif action == "twice":
            lines.insert(place, lines[place])
        elif action == "line":
            lines[place] = data.draw(LINES)
        else:
            draw = {"number": NUMBERS, "path": PATHS, "text": st.text(max_size=10)}[action]
            lines[place] = f"{key}{colon}{data.draw(draw)}"
    files["metadata.yaml"] = "\n".join(lines).encode("utf-8", "surrogatepass")
    in_a_folder(files)


@cases(15)
@given(st.sampled_from(KINDS), st.binary(max_size=100))
@counted
def test_metadata_that_is_none(kind, content):
    in_a_folder({**whole_bag(kind), "metadata.yaml": content})


@cases(15)
@given(PATHS)
@counted
def test_paths_stay_in_the_folder(path):
    files = dict(whole_bag("mcap"))
    name = storage_of(files)
    text = files["metadata.yaml"].decode().replace(name, repr(path))
    in_a_folder({**files, "metadata.yaml": text.encode()})


@cases(4)
@given(st.sampled_from(["/etc/passwd", "/", "../bag", "nowhere"]))
@counted
def test_links_stay_in_the_folder(target):
    files = dict(whole_bag("mcap"))
    name = storage_of(files)
    del files[name]
    assert in_a_folder(files, {name: target}) == 0


@cases(40)
@given(
    st.lists(
        st.tuples(
            st.sampled_from([IMAGE_TOPIC, "/image/compressed", TRUTH_BOX_TOPIC, VISIBILITY_TOPIC]),
            st.sampled_from([IMAGE, COMPRESSED_IMAGE, POLYGON, DIAGNOSTICS]),
            st.binary(max_size=60) | st.integers(0, 300),
        ),
        max_size=4,
    )
)
@counted
def test_messages_that_are_none_or_of_another_type(messages):
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "bag"
        kinds = {}
        with BagWriter(path) as bag:
            for stamp, (topic, kind, cdr) in enumerate(messages, 1):
                kind = kinds.setdefault(topic, kind)
                if isinstance(cdr, int):  # a sound message, cut off
                    sound = box_message(BOX, 10**18, "camera")
                    cdr = bytes(TYPESTORE.serialize_cdr(sound, POLYGON))[:cdr]
                bag.write_cdr(topic, kind, cdr, stamp)
        read_all(path)
        shutil.rmtree(path)
