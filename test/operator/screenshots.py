# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Pictures of the operator's page: light, dark, on a phone, while picking, and LOST.

example: python test/operator/screenshots.py --out docs/images
"""

from __future__ import annotations

import argparse
import time
from pathlib import Path

from operator_browser import OperatorPage, chromium
from recorded_stream import RunningServer

LAPTOP = {"viewport": {"width": 1280, "height": 720}}
PHONE = {
    "viewport": {"width": 390, "height": 844},
    "device_scale_factor": 2,
    "is_mobile": True,
    "has_touch": True,
}
PICTURES = {
    "operator_light": (LAPTOP, "TRACKING", "light"),
    "operator_dark": (LAPTOP, "COASTING", "dark"),
    "operator_phone": (PHONE, "TRACKING", "light"),
    "operator_pick": (LAPTOP, "PICK", "light"),
    "operator_lost": (LAPTOP, "LOST", "light"),
}
HISTORY = 8.0  # s that are watched before


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0], epilog=__doc__)
    parser.add_argument("--out", type=Path, default=Path("out/operator"))
    parser.add_argument("--only", default="", help="one of " + ", ".join(PICTURES))
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    server = RunningServer()
    try:
        with chromium() as browser:
            for name, (device, state, scheme) in PICTURES.items():
                if options.only in ("", name):
                    _take(server, browser, options.out / f"{name}.jpg", device, state, scheme)
    finally:
        server.close()


def _take(server, browser, path: Path, device: dict, state: str, scheme: str) -> None:
    context = browser.new_context(color_scheme=scheme, **device)
    page = OperatorPage(context.new_page(), server.url)
    server.bridge.state = "TRACKING"
    page.wait_for_state("TRACKING")
    page.wait_for_pictures()
    time.sleep(HISTORY)
    if state == "PICK":
        page.page.locator("#live").focus()
        page.keys("p")
    else:
        server.bridge.state = state
        page.wait_for_state(state)
    time.sleep(0.5)
    page.page.screenshot(path=str(path), type="jpeg", quality=85)
    context.close()
    print(path)


if __name__ == "__main__":
    main()
