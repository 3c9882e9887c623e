# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Bags from strangers: nothing in them is executed, nothing outside their folder is read."""

import sys

import pytest
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_types_from_msg, get_typestore
from rosbags.typesys.store import Typestore

from het_ros.tools.bag_messages import (
    INIT_BOX_TOPIC,
    POLYGON,
    TRUTH_BOX_TOPIC,
    VISIBILITY_TOPIC,
    box_message,
)
from het_ros.tools.bag_reader import MOST_METADATA, BagError, BagReader
from het_ros.tools.bag_writer import TYPESTORE, BagWriter
from het_ros.tools.message_types import check_types
from het_ros.tracking.box import Box

BOX = Box(10, 20, 30, 40)


@pytest.fixture
def bag(tmp_path):
    """Folder of a sound bag with one box."""
    with BagWriter(tmp_path / "bag") as writer:
        writer.write(INIT_BOX_TOPIC, box_message(BOX, 10**18, "camera"), 10**18)
    return tmp_path / "bag"


def test_its_definitions_of_types_are_not_made_into_code(bag, monkeypatch):
    def executed(*_):
        raise AssertionError("rosbags executes the code that it makes of the definitions")

    monkeypatch.setattr(Typestore, "register", executed)
    with BagReader(bag) as reader:
        check_types(reader, list(reader.topics))
        assert len(list(reader.messages(INIT_BOX_TOPIC))) == 1


def test_a_type_of_another_meaning_is_told_by_its_definition(tmp_path):
    """A Polygon of pairs: the bytes would be read as nonsense."""
    store = get_typestore(Stores.EMPTY)
    store.register(get_types_from_msg("float32 x\nfloat32 y", POLYGON))
    with Writer(tmp_path / "bag", version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        topic = writer.add_connection(INIT_BOX_TOPIC, POLYGON, typestore=store)
        writer.write(topic, 1, b"\0\1\0\0" + bytes(8))
    with BagReader(tmp_path / "bag") as reader:
        assert not reader.has_jazzys(INIT_BOX_TOPIC)
        with pytest.raises(BagError, match="not ROS 2 Jazzy's"):
            list(reader.messages(INIT_BOX_TOPIC))


def test_no_package_is_imported_because_a_bag_names_it(tmp_path, monkeypatch):
    trap = tmp_path / "trap"
    trap.mkdir()
    (trap / "__init__.py").write_text("raise AssertionError('imported')\n")
    monkeypatch.syspath_prepend(tmp_path)
    store = get_typestore(Stores.EMPTY)
    store.register(get_types_from_msg("float32 x", "trap/msg/Trap"))
    with Writer(tmp_path / "bag", version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        writer.add_connection("/trap", "trap/msg/Trap", typestore=store)
    with BagReader(tmp_path / "bag") as reader, pytest.raises(BagError, match="not ROS 2 Jazzy's"):
        check_types(reader, ["/trap"])
    assert "trap" not in sys.modules


@pytest.mark.parametrize("path", ["../secret.mcap", "..", "."])
def test_paths_in_its_metadata_stay_in_its_folder(bag, path):
    (bag / "bag.mcap").rename(bag.parent / "secret.mcap")
    metadata = bag / "metadata.yaml"
    metadata.write_text(metadata.read_text().replace("bag.mcap", path))
    with pytest.raises(BagError, match="cannot be read"):
        BagReader(bag)


@pytest.mark.parametrize("whole", [True, False], ids=["with metadata", "without"])
def test_links_that_lead_out_of_its_folder_are_refused(bag, whole):
    (bag / "bag.mcap").rename(bag.parent / "secret.mcap")
    (bag / "bag.mcap").symlink_to("../secret.mcap")
    if not whole:
        (bag / "metadata.yaml").unlink()
    with pytest.raises(BagError, match="leads out of the bag's folder"):
        BagReader(bag)


@pytest.mark.parametrize(
    "text",
    [
        "!!python/object/apply:os.mkdir [{folder}/hacked]",
        "rosbag2_bagfile_information: !!python/object/new:os.mkdir [{folder}/hacked]",
        "a: &a [x, x]\nb: &b [*a, *a]\nrosbag2_bagfile_information: *b",
        "[]",
        "",
        "\0",
    ],
)
def test_yaml_makes_nothing(bag, text):
    (bag / "metadata.yaml").write_text(text.format(folder=bag.parent))
    with pytest.raises(BagError, match="cannot be read"):
        BagReader(bag)
    assert not (bag.parent / "hacked").exists()


def test_metadata_without_end_is_not_read(bag):
    with (bag / "metadata.yaml").open("ab") as file:
        file.truncate(MOST_METADATA + 1)
    with pytest.raises(BagError, match="over 16,000,000 bytes"):
        BagReader(bag)


@pytest.mark.parametrize("count", ["-1", "many", "[1]", "1.5"])
def test_numbers_of_messages_that_are_none(bag, count):
    metadata = bag / "metadata.yaml"
    metadata.write_text(
        metadata.read_text().replace("- message_count: 1", f"- message_count: {count}")
    )
    with pytest.raises(BagError):
        BagReader(bag)


def test_a_message_that_is_cut_off(tmp_path):
    cdr = bytes(TYPESTORE.serialize_cdr(box_message(BOX, 1, "camera"), POLYGON))
    with BagWriter(tmp_path / "bag") as writer:
        writer.write_cdr(INIT_BOX_TOPIC, POLYGON, cdr, 1)
        writer.write_cdr(INIT_BOX_TOPIC, POLYGON, cdr[:-9], 2)
    with BagReader(tmp_path / "bag") as reader:
        messages = reader.messages(INIT_BOX_TOPIC)
        assert next(messages)[0] == INIT_BOX_TOPIC
        with pytest.raises(BagError, match="a broken message"):
            next(messages)


def test_truth_that_is_none(tmp_path):
    polygon = box_message(BOX, 1, "camera")
    polygon.polygon.points = []
    with BagWriter(tmp_path / "bag") as writer:
        writer.write(TRUTH_BOX_TOPIC, polygon, 1)
        empty = TYPESTORE.types["diagnostic_msgs/msg/DiagnosticArray"](polygon.header, [])
        writer.write(VISIBILITY_TOPIC, empty, 1)
    with BagReader(tmp_path / "bag") as reader:
        with pytest.raises(BagError, match="ground truth"):
            reader.truth()
        with pytest.raises(BagError, match="ground truth"):
            reader.visibility()
