# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The system's Chromium, and the operator's page in it."""

from __future__ import annotations

import shutil
import time
from contextlib import contextmanager

PATIENCE = 60  # s: how long something that must happen may take on a busy machine
CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")


@contextmanager
def chromium():
    """A running browser; its own downloads are not used."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=CHROMIUM, args=["--no-sandbox", "--disable-dev-shm-usage"]
        )
        yield browser
        browser.close()


def wait(happened, what: str):
    """Poll until ``happened()`` is true, and return it; fail when it does not happen at all."""
    end = time.monotonic() + PATIENCE
    while not (result := happened()):
        assert time.monotonic() < end, f"did not happen: {what}"
        time.sleep(0.05)
    return result


class OperatorPage:
    """The page, driven as a person does.

    Attributes:
        page: Playwright's.
        errors: exceptions of the page's own code.
    """

    def __init__(self, page, url: str) -> None:
        self.page = page
        self.errors: list[str] = []
        page.set_default_timeout(1000 * PATIENCE)
        page.on("pageerror", lambda error: self.errors.append(str(error)))
        page.goto(url)

    def get(self, expression: str):
        return self.page.evaluate(expression)

    def text(self, name: str) -> str:
        return self.page.locator(f"#{name}").inner_text()

    @property
    def state(self) -> str:
        return self.page.locator("body").get_attribute("data-state")

    def wait_for_pictures(self) -> None:
        """Return when pictures move."""
        first = self.get("operatorPage.view.image?.stamp")
        wait(
            lambda: (
                self.get("operatorPage.view.image?.stamp") not in (None, first)
                and self.get("operatorPage.figures.all.median !== undefined")
            ),
            "pictures",
        )

    def wait_for_state(self, state: str) -> None:
        wait(lambda: self.state == state, f"the page says {state}")

    def frozen_stamp(self) -> int:
        """Stamp of the frozen picture, ns; 0 while it is live."""
        return int(self.get("operatorPage.view.frozen?.stamp ?? '0'"))

    def box(self) -> list[float] | None:
        """The box that is drawn, px of the image."""
        return self.get("operatorPage.view.box")

    def place(self, x: float, y: float) -> tuple[float, float]:
        """Where a px of the image is on the screen."""
        area = self.page.locator("#live").bounding_box()
        width, height = self.get("operatorPage.view.shown.size")
        shrink = min(area["width"] / width, area["height"] / height)
        left = area["x"] + (area["width"] - width * shrink) / 2
        return left + x * shrink, area["y"] + y * shrink

    def drag(self, start, end, release: bool = True) -> None:
        """Drag the mouse from one px of the image to another."""
        self.page.mouse.move(*self.place(*start))
        self.page.mouse.down()
        self.page.mouse.move(*self.place(*end), steps=4)
        if release:
            self.page.mouse.up()

    def keys(self, *keys: str) -> None:
        for key in keys:
            self.page.keyboard.press(key)
