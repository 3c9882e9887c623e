# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The installed executable ``tracker`` as a process of its own, stopped for sure."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

INSTALLED = Path("install/het_ros/lib/het_ros/tracker")  # where colcon build puts it
PATIENCE = 5.0  # s between SIGTERM and SIGKILL
LOG_TAIL = 20  # lines
FIRST_PORT, PORTS_A_DOMAIN, DOMAINS = 7400, 250, range(1, 100)  # of DDS, see RTPS 9.6.1


class TrackerProcessError(RuntimeError):
    """The tracker could not be started, or ended by itself; the text has its last words."""


def find_tracker() -> Path:
    """The executable that colcon installed: beside this checkout, or in a sourced workspace.

    Raises:
        TrackerProcessError: it is nowhere; the text says how to build it.
    """
    prefixes = os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep)
    places = [parent / INSTALLED for parent in Path(__file__).resolve().parents]
    places += [Path(prefix) / "lib/het_ros/tracker" for prefix in prefixes if prefix]
    for place in places:
        if place.is_file():
            return place
    raise TrackerProcessError(f"no {INSTALLED} found: run `colcon build` (or `make run`) first")


class TrackerProcess:
    """A running tracker; leaving the block ends it, whatever happens.

    Args:
        executable: the file that ``ros2 run het_ros tracker`` would start.
        arguments: its arguments.
        log: file for what it says.

    Raises:
        TrackerProcessError: it cannot be executed.
    """

    def __init__(self, executable: Path, arguments: Sequence[str], log: Path) -> None:
        self._log = log
        with log.open("wb") as output:
            try:
                # A session of its own: Ctrl-C reaches us alone, and we say when it stops.
                self._process = subprocess.Popen(
                    [executable, *arguments],
                    stdin=subprocess.DEVNULL,
                    stdout=output,
                    stderr=subprocess.STDOUT,
                    env=os.environ | _workspace_of(executable),
                    start_new_session=True,
                )
            except OSError as error:
                raise TrackerProcessError(f"{executable} cannot be started: {error}") from None

    def __enter__(self) -> TrackerProcess:
        return self

    def __exit__(self, *_: object) -> None:
        self._process.send_signal(signal.SIGTERM)
        try:
            self._process.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()

    @property
    def pid(self) -> int:
        """Its process id."""
        return self._process.pid

    def check(self) -> None:
        """Raise TrackerProcessError if it has ended."""
        code = self._process.poll()
        if code is not None:
            lines = self._log.read_text(errors="replace").splitlines()[-LOG_TAIL:]
            said = "\n".join(lines) or "nothing"
            raise TrackerProcessError(f"the tracker ended by itself (exit code {code}):\n{said}")


def _workspace_of(executable: Path) -> dict[str, str]:
    """What sourcing the workspace's setup.bash would set for this package."""
    prefix = executable.resolve().parents[2]
    packages = [str(path) for path in prefix.glob("lib/python3*/site-packages")]
    paths = {
        "PYTHONPATH": [*packages, os.environ.get("PYTHONPATH", "")],
        "AMENT_PREFIX_PATH": [
            str(prefix),
            os.environ.get("AMENT_PREFIX_PATH", ""),
            sys.prefix,  # messages installed by pip
        ],
    }
    return {name: os.pathsep.join(filter(None, parts)) for name, parts in paths.items()}


def own_graph() -> dict[str, str]:
    """Environment of processes on this host that hear each other and nobody else."""
    return {
        "ROS_DOMAIN_ID": str(free_domain()),
        "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
    }


def free_domain() -> int:
    """A ROS_DOMAIN_ID that no process on this host uses now."""
    first = os.getpid() % len(DOMAINS)
    for domain in [*DOMAINS[first:], *DOMAINS[:first]]:
        base = FIRST_PORT + PORTS_A_DOMAIN * domain
        if all(_is_free(base + offset) for offset in (0, 10, 11)):
            return domain
    raise TrackerProcessError("every ROS_DOMAIN_ID is in use on this host")


def _is_free(port: int) -> bool:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.bind(("", port))
        except OSError:
            return False
    return True
