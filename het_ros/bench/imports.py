# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""What the imports of the node take of its start: seconds and memory, in a fresh process."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Sequence

IMPORTS = ("numpy", "cv2", "filterpy.kalman", "rclpy", "het_ros.ros.tracker_node")
_SCRIPT = """
import importlib, json, os, sys, time
from pathlib import Path
def megabytes():
    return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 1e6
found = {}
for name in sys.argv[1:]:
    before, begun = megabytes(), time.perf_counter()
    importlib.import_module(name)
    seconds = time.perf_counter() - begun
    found[name] = {"seconds": seconds, "rss_mb": megabytes() - before}
print(json.dumps(found))
"""


def weigh_imports(names: Sequence[str] = IMPORTS) -> dict[str, dict[str, float]]:
    """Time, s, and memory, MB, that each import adds to those before it.

    Args:
        names: of modules, imported in this order.

    Raises:
        OSError: one of them cannot be imported.
    """
    command = [sys.executable, "-c", _SCRIPT, *names]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        raise OSError(f"importing {', '.join(names)} failed:\n{done.stderr[-2000:]}")
    found: dict[str, dict[str, float]] = json.loads(done.stdout)
    return found
