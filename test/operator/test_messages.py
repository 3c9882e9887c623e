# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from het_ros.operator.messages import FROM_CLIENT, SCHEMA, MessageError, parse

PICK = {"type": "pick", "box": [1, 2, 3.5, 4], "stamp": "1795885688616938766", "replace": False}


@pytest.mark.parametrize(
    "message",
    [
        PICK,
        {"type": "view", "tracker": "", "width": 640, "quality": 70},
        {"type": "shown"},
        {"type": "ping", "time": 12.5},
        {"type": "freeze", "on": True},
        {"type": "set", "name": "seed", "value": 3},
    ],
)
def test_a_right_message_is_taken_as_it_is(message):
    assert parse(json.dumps(message)) == message


@pytest.mark.parametrize(
    "text",
    [
        "",
        "{",
        "[]",
        "null",
        "[" * 3000,
        "9" * 4000,
        '{"type": "dance"}',
        '{"type": ["pick"]}',
        '{"type": "shown", "more": 1}',
        '{"type": "track"}',
        json.dumps(PICK | {"box": [1, 2, 3]}),
        json.dumps(PICK | {"box": [1, 2, 3, 0]}),
        json.dumps(PICK | {"box": [1, 2, 3, True]}),
        json.dumps(PICK | {"box": [1, 2, 3, float("nan")]}),
        json.dumps(PICK | {"box": [1, 2, 3, float("inf")]}),
        json.dumps(PICK).replace("3.5", "1e999"),
        json.dumps(PICK | {"stamp": "-1"}),
        json.dumps(PICK | {"stamp": 1}),
        json.dumps(PICK | {"replace": 1}),
        '{"type": "view", "tracker": "", "width": 1e9, "quality": 70}',
        '{"type": "set", "name": "seed", "value": "__import__"}',
    ],
)
def test_a_wrong_message_is_refused(text):
    with pytest.raises(MessageError):
        parse(text)


json_values = st.recursive(
    st.none() | st.booleans() | st.floats() | st.integers() | st.text(max_size=20),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=8), inner),
    max_leaves=8,
)


@given(st.sampled_from(FROM_CLIENT), st.dictionaries(st.text(max_size=8), json_values))
def test_whatever_comes_is_taken_or_refused(kind, fields):
    try:
        parse(json.dumps({"type": kind, **fields}))
    except MessageError as error:
        assert str(error)


def test_the_schema_tells_of_every_message():
    listed = {entry["$ref"].rpartition("/")[2] for entry in SCHEMA["oneOf"]}
    assert listed | {"stamp", "box"} == SCHEMA["$defs"].keys()
    assert set(FROM_CLIENT) < listed
    assert all("description" in SCHEMA["$defs"][kind] for kind in listed)
