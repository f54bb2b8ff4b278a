# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The system's Chromium, driven by Playwright; a test that has none is skipped with the reason."""

import shutil
from collections.abc import Iterator
from contextlib import contextmanager

import pytest


@contextmanager
def chromium() -> Iterator:
    """Open the browser."""
    sync_api = pytest.importorskip('playwright.sync_api', reason='no playwright is installed')
    program = shutil.which('chromium') or shutil.which('google-chrome')
    if program is None:
        pytest.skip('no Chromium is installed')
    with sync_api.sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=program)
        sync_api.expect.set_options(timeout=60_000.0)  # a machine can be busy
        yield browser
        browser.close()


def expect(shown):
    """Give what waits for an element to be as expected, by Playwright, whose import takes long."""
    from playwright.sync_api import expect  # noqa: PLC0415, where there is a browser

    return expect(shown)


def noting(page):
    """Let a page note in `seen` what it asks for and complains about."""
    page.seen = []
    page.on('console', lambda message: page.seen.append(message.text))
    page.on('pageerror', lambda error: page.seen.append(str(error)))
    page.on('request', lambda request: page.seen.append(request.url))
    return page
