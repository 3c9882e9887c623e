# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""What command lines share: the parser, and arguments of a bag, of the tracker and of ROS."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from het_ros.tracking.box import Box

INTERRUPTED = 130  # the exit code of a shell's own commands after Ctrl-C


def command(name: str, description: str | None, examples: str) -> argparse.ArgumentParser:
    """A parser whose --help shows description and examples as they are written."""
    return argparse.ArgumentParser(
        prog=name,
        description=description,
        epilog=examples,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )


def split_ros_arguments(argv: Sequence[str] | None) -> tuple[list[str], list[str]]:
    """A command's own arguments, and ROS's from ``--ros-args`` on; None is the process's."""
    arguments = list(sys.argv[1:] if argv is None else argv)
    cut = arguments.index("--ros-args") if "--ros-args" in arguments else len(arguments)
    return arguments[:cut], arguments[cut:]


def add_bag(parser: argparse.ArgumentParser, out: str) -> None:
    """Add bag, --out, --image-topic and --init."""
    parser.add_argument("bag", type=Path, help="folder of a rosbag2")
    parser.add_argument("--out", type=Path, default=Path(out), help="results folder")
    add_image_topic(parser)
    add_init(parser)


def add_image_topic(parser: Any) -> None:
    """Add --image-topic."""
    parser.add_argument("--image-topic", help="which images, if the bag has several")


def add_init(parser: Any) -> None:
    """Add --init."""
    parser.add_argument("--init", type=parse_box, help="x,y,w,h of the target in the first frame")


def add_parameters(parser: Any) -> None:
    """Add -p, any number of times."""
    parser.add_argument(
        "-p", dest="parameters", action="append", default=[], metavar="NAME:=VALUE",
        help="a parameter of the tracker",
    )  # fmt: skip


def add_network(parser: Any) -> None:
    """Add --network: the folder of a network that this OpenCV can read, or ""."""
    parser.add_argument(
        "--network", type=network_folder, default="", metavar="FOLDER",
        help="of a NanoTrack network, one more base ensemble (none)",
    )  # fmt: skip


def network_folder(text: str) -> str:
    """The absolute path of a network's folder from a command line; "" for ""."""
    from het_ros.tracking.bottom.siamese import Siamese

    if not text:
        return ""
    folder = Path(text).expanduser().absolute()
    try:
        Siamese.read(folder)
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from None
    return str(folder)


def parse_box(text: str) -> Box:
    """A box from "x,y,w,h" on a command line."""
    try:
        x, y, w, h = (float(number) for number in text.split(","))
        return Box(x, y, w, h)
    except ValueError as error:
        raise argparse.ArgumentTypeError(f"{text!r} is not x,y,w,h in px: {error}") from None
