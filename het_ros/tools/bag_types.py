# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Whether a bag means by a message type what ROS 2 Jazzy does.

A bag carries the definitions of its types. rosbags' own high-level reader makes Python code of
them and executes it, which a stranger's bag should not be given: here they are parsed and compared
with Jazzy's, and messages are decoded with Jazzy's alone.
"""

from __future__ import annotations

from typing import Any

from rosbags.interfaces import Connection, MessageDefinition, MessageDefinitionFormat
from rosbags.typesys import get_types_from_idl, get_types_from_msg

from het_ros.tools.bag_writer import TYPESTORE

_IDL_RULE = "=" * 80 + "\n"


def is_jazzys(connection: Connection) -> bool:
    """Whether the type of a bag's topic is defined there as in ROS 2 Jazzy.

    Bags of before Jazzy may hold neither definition nor hash: then the name alone counts.
    """
    kind = connection.msgtype
    if kind not in TYPESTORE.fielddefs:
        return False
    if connection.digest and connection.digest != TYPESTORE.hash_rihs01(kind):
        return False
    if connection.msgdef.format == MessageDefinitionFormat.NONE:
        return True
    try:
        defined = _parsed(connection.msgdef, kind)
    except Exception:  # whatever the parser makes of a stranger's text
        return False
    return kind in defined and all(
        name in TYPESTORE.fielddefs and _fields(fields) == _fields(TYPESTORE.fielddefs[name][1])
        for name, (_, fields) in defined.items()
    )


def _parsed(definition: MessageDefinition, kind: str) -> dict[str, Any]:
    """Constants and fields of each type in a definition, by name."""
    if definition.format == MessageDefinitionFormat.MSG:
        return get_types_from_msg(definition.data, kind)
    if not definition.data.startswith(_IDL_RULE):
        return get_types_from_idl(definition.data)
    types: dict[str, Any] = {}
    for part in definition.data.split(_IDL_RULE)[1:]:
        types.update(get_types_from_idl(part.partition("\n")[2]))
    return types


def _fields(fields: Any) -> list[tuple[str, Any]]:
    """Names and types; IDL and msg differ in the case of names."""
    return [(name.lower(), kind) for name, kind in fields]
