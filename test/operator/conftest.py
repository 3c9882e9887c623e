# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""A server on the recorded stream, and a browser; tests are skipped without Chromium."""

from __future__ import annotations

import pytest

pytest.importorskip("aiohttp", reason="the operator's extra is not installed")

from operator_browser import CHROMIUM, OperatorPage, chromium
from recorded_stream import RunningServer


@pytest.fixture
def serve():
    """Start servers: ``serve(token="...", max_clients=2)``; no fault in their loop is let pass."""
    running: list[RunningServer] = []

    def start(**options) -> RunningServer:
        running.append(RunningServer(**options))
        return running[-1]

    yield start
    for server in running:
        server.close()
    assert [fault for server in running for fault in server.faults] == []


@pytest.fixture
def server(serve) -> RunningServer:
    """A server of this machine's own browsers."""
    return serve()


@pytest.fixture(scope="session")
def browser():
    """Chromium."""
    pytest.importorskip("playwright", reason="playwright is not installed")
    if CHROMIUM is None:
        pytest.skip("no Chromium: apt-get install chromium")
    with chromium() as running:
        yield running


@pytest.fixture
def visit(browser):
    """Open the page: ``visit(url, has_touch=True)``; no error in its code is let pass."""
    opened: list[OperatorPage] = []

    def open_page(url: str, **options) -> OperatorPage:
        context = browser.new_context(**options)
        opened.append(OperatorPage(context.new_page(), url))
        return opened[-1]

    yield open_page
    for page in opened:
        page.page.context.close()
    assert [error for page in opened for error in page.errors] == []
