# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""What goes over the socket, as ``static/messages.schema.json`` describes it.

Clients send JSON texts, which are checked here field by field. The server sends JSON texts and,
for an image, one binary message: the length of a JSON header (4 bytes, little-endian), that
header, and the JPEG.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

LONGEST = 4096  # bytes of a client's message
LARGEST = 1e5  # px

Check = Callable[[Any], bool]


class MessageError(ValueError):
    """A client's message that is none; the text says why."""


def _is_number(value: Any) -> bool:
    return type(value) in (int, float) and math.isfinite(value)


def _whole(low: int, high: int) -> Check:
    return lambda value: type(value) is int and low <= value <= high


def _text(most: int) -> Check:
    return lambda value: isinstance(value, str) and len(value) <= most


def _is_flag(value: Any) -> bool:
    return isinstance(value, bool)


def _is_stamp(value: Any) -> bool:
    return isinstance(value, str) and re.fullmatch("[0-9]{1,19}", value, re.ASCII) is not None


def _is_box(value: Any) -> bool:
    return (
        isinstance(value, list)
        and len(value) == 4
        and all(_is_number(part) and abs(part) <= LARGEST for part in value)
        and min(value[2:]) > 0
    )


def _is_value(value: Any) -> bool:
    return _is_flag(value) or _is_number(value) or _text(200)(value)


# The fields of each message that a client may send; all of them are required.
FROM_CLIENT: dict[str, dict[str, Check]] = {
    "view": {"tracker": _text(300), "width": _whole(16, 4096), "quality": _whole(20, 95)},
    "shown": {},
    "ping": {"time": _is_number},
    "freeze": {"on": _is_flag},
    "pick": {"box": _is_box, "stamp": _is_stamp, "replace": _is_flag},
    "reset": {},
    "enable": {"on": _is_flag},
    "record": {"on": _is_flag},
    "set": {"name": _text(100), "value": _is_value},
}


def parse(text: str) -> dict[str, Any]:
    """A client's message.

    Raises:
        MessageError: it is no JSON, of no known type, or a field is wrong.
    """
    try:
        message = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise MessageError("the message is no JSON") from error
    kind = message.get("type") if isinstance(message, dict) else None
    fields = FROM_CLIENT.get(kind) if isinstance(kind, str) else None
    if fields is None:
        raise MessageError(f"the type of a message is one of {', '.join(FROM_CLIENT)}")
    if message.keys() != fields.keys() | {"type"}:
        raise MessageError(f"{kind} has the fields {', '.join(fields) or 'type alone'}")
    for name, fits in fields.items():
        if not fits(message[name]):
            raise MessageError(f"{kind}: {name} has a value that is not allowed")
    return dict(message)


def image_message(header: dict[str, Any], jpeg: bytes) -> bytes:
    """The binary message of one image."""
    head = json.dumps({"type": "image", **header}).encode()
    return len(head).to_bytes(4, "little") + head + jpeg


@dataclass(frozen=True)
class Answer:
    """What became of a client's request.

    Attributes:
        ok: whether it was done.
        text: what was done, or why it was not.
    """

    ok: bool
    text: str

    def message(self, request: str) -> dict[str, Any]:
        """The message to the client that sent a request of that type."""
        return {"type": "answer", "to": request, "ok": self.ok, "text": self.text}
