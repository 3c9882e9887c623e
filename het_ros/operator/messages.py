# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""What goes over the socket: ``static/messages.schema.json`` describes it, and is held to here."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from jsonschema import Draft202012Validator

SCHEMA = json.loads((Path(__file__).parent / "static/messages.schema.json").read_text())
LONGEST = 4096  # bytes of a client's message
FROM_CLIENT = ("view", "shown", "ping", "freeze", "pick", "reset", "enable", "record", "set")
CHECKS = {
    kind: Draft202012Validator({**SCHEMA, "oneOf": [{"$ref": f"#/$defs/{kind}"}]})
    for kind in FROM_CLIENT
}


class MessageError(ValueError):
    """A client's message that is none; the text says why."""


def parse(text: str) -> dict[str, Any]:
    """A client's message.

    Raises:
        MessageError: it is no JSON, of no known type, or a field is wrong.
    """
    try:
        message = json.loads(text, parse_constant=lambda name: None)
    except (ValueError, RecursionError) as error:
        raise MessageError("the message is no JSON") from error
    kind = message.get("type") if isinstance(message, dict) else None
    check = CHECKS.get(kind) if isinstance(kind, str) else None
    if check is None:
        raise MessageError(f"the type of a message is one of {', '.join(FROM_CLIENT)}")
    if not check.is_valid(message):
        raise MessageError(f"{kind} is not as messages.schema.json describes it")
    return dict(message)


def image_message(header: dict[str, Any], jpeg: bytes) -> bytes:
    """The binary message of one image: the header's length (4 bytes), it, and the JPEG."""
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
