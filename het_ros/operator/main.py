# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The executable ``operator``."""

from __future__ import annotations

import argparse
import asyncio
import secrets
import signal
import socket
import sys

import rclpy
from rclpy.exceptions import ParameterException
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from rclpy.utilities import remove_ros_args

from het_ros.operator.bridge import Bridge
from het_ros.operator.config import OperatorConfig
from het_ros.operator.server import Server
from het_ros.ros.parameters import declare, read


def main(args: list[str] | None = None) -> int:
    """Serve the page until told to stop; 0 on a clean stop, 2 where it cannot be served."""
    argv = sys.argv if args is None else ["operator", *args]
    argparse.ArgumentParser(
        prog="operator",
        description="Pick the target of a tracker, and watch it, in a browser.",
        epilog="example: ros2 run het_ros operator --ros-args -p host:=0.0.0.0",
    ).parse_args(remove_ros_args(argv)[1:])
    rclpy.init(args=argv, signal_handler_options=SignalHandlerOptions.NO)
    node = None
    try:
        node = Node("operator")
        declare(node, OperatorConfig())
        asyncio.run(serve(node, read(node, OperatorConfig)))
    except (ParameterException, ValueError) as error:
        print(f"operator: {error}", file=sys.stderr)
        return 2
    except OSError as error:
        print(f"operator: {error}: choose another with -p host:= or -p port:=", file=sys.stderr)
        return 2
    finally:
        if node is not None:
            node.destroy_node()
        rclpy.try_shutdown()
    return 0


async def serve(node: Node, config: OperatorConfig) -> None:
    """Serve the page from a node until SIGINT or SIGTERM.

    Raises:
        OSError: the address cannot be listened on.
    """
    stop, loop = asyncio.Event(), asyncio.get_running_loop()
    for number in (signal.SIGINT, signal.SIGTERM):
        loop.add_signal_handler(number, stop.set)
    token = config.token or ("" if config.local else secrets.token_urlsafe(12))
    bridge = Bridge(node, config)
    server = Server(bridge, config, token)
    try:
        await server.start()
        _print_address(config, server.port, token)
        await stop.wait()
    finally:
        await server.close()
        await bridge.close()


def _print_address(config: OperatorConfig, port: int, token: str) -> None:
    """The address to open; as a QR code too, where another device can reach it."""
    everywhere = config.host in ("0.0.0.0", "::", "")
    host = _own_address() if everywhere else config.host
    address = f"http://{f'[{host}]' if ':' in host else host}:{port}/"
    if token:
        address += f"#token={token}"
    print(f"operator: open {address}", flush=True)
    if config.local:
        return
    try:
        import segno
    except ImportError:
        return
    segno.make(address, micro=False).terminal(compact=True)
    sys.stdout.flush()


def _own_address() -> str:
    """This machine's address in the network that its way out leads to; nothing is sent."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.connect(("192.0.2.1", 9))
        except OSError:
            return socket.gethostname()
        return str(probe.getsockname()[0])


if __name__ == "__main__":
    sys.exit(main())
