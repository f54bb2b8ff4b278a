# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Draw the pictures of the README and of these pages: `make pictures`.

Pages are photographed by the system's Chromium.
"""

import os
import re
import shutil
import subprocess
import sys
import tempfile
from contextlib import ExitStack, chdir
from io import BytesIO
from pathlib import Path

from PIL import Image
from playwright.sync_api import Page, sync_playwright

from gear_kinematics.commands.cli import main
from gear_kinematics.ros.live import running_node

ROOT = Path(__file__).parents[1]
sys.path.append(str(ROOT / 'test' / 'support'))

from drawings import FLOWS, draw_bodies, draw_flow, draw_printed_gear  # noqa: E402, see above
from gear_recordings import record_both_encoders  # noqa: E402, see above

DOCS = Path('docs')
BAG = 'bags/servo_point_to_point'
PRELOADED = ['--config', 'docs/examples/preloaded.yaml']
CONFIG = ['--config', 'config/actuator.yaml']
SHAFT = ['--branch-stiffness', '3000', '--shaft-stiffness', '1069']
DRAWN = {
    'mechanism.gif': ['animate'],
    'scheme.svg': ['plot', 'scheme'],
    'pictures/forces.svg': ['plot', 'scheme', '--torque', '4', *PRELOADED],
    'roses.svg': ['plot', 'roses'],
    'slides.svg': ['plot', 'slides'],
    'pictures/output.svg': ['plot', 'output', '--bag', BAG],
    'pictures/preload.svg': ['preload', '--wanted-threshold', '1', *SHAFT, '--plot'],
}
"""By file, each with the arguments of gearkin that come before it."""
PAGES = {
    'pictures/describe.png': ['describe'],
    'pictures/index.png': ['index', '--degrees', '0.07'],
    'pictures/preload.png': ['preload', '--wanted-threshold', '1', *SHAFT],
    'pictures/loads.png': ['loads', BAG, *PRELOADED],
    'pictures/lost_motion.png': ['lost-motion', 'docs/examples/ramps.csv', *CONFIG],
}
OF_RECORDINGS = {
    'pictures/validate.png': ['validate', 'other_gear', '--config', 'actuator.yaml'],
    'pictures/calibrate.png': ['calibrate', 'monday', 'tuesday', '-o', 'calibration.yaml'],
    'pictures/calibrate_check.png': ['calibrate', 'friday', '--check', 'calibration.yaml'],
    'pictures/commissioning.png': ['commission', 'monday', '-o', 'commissioned.yaml'],
}
"""Pages of recordings that `record` makes."""
OTHER_GEAR = '/**: {ros__parameters: {ring_teeth: 84, satellite_teeth: 80}}'
VIEW = {'width': 1100, 'height': 1000}  # pixels
LIVE_VIEW = {'width': 1100, 'height': 740}  # pixels
COLOURS = 64


def record() -> None:
    """Record other_gear, which has other teeth, and both encoders of another one."""
    shutil.copy(ROOT / CONFIG[1], 'actuator.yaml')
    Path('other.yaml').write_text(OTHER_GEAR, 'utf-8')
    run(['compute', str(ROOT / BAG), 'other_gear', '--config', 'other.yaml'])
    record_both_encoders(Path(), 'monday', 'tuesday', 'friday')


def photograph(pages: dict[str, list[str]], *live: str) -> None:
    """Have each page made, and keep its upper part as a PNG; and the live page, if it is named.

    The live page is kept as two files: while the driver runs, and after it has stopped.
    """
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=shutil.which('chromium'))
        tab = browser.new_page(viewport=VIEW, color_scheme='light')
        for name, arguments in pages.items():
            page = Path(folder, 'page.html')
            run([*arguments, '--html', str(page)])
            tab.goto(page.as_uri())
            tab.add_style_tag(content='footer { display: none; }')  # it has a date
            tab.wait_for_load_state('networkidle')
            keep(tab.screenshot(), DOCS / name)
        if live:
            photograph_live(tab, *(DOCS / name for name in live))
        browser.close()


def photograph_live(tab: Page, running: Path, stopped: Path) -> None:
    """Have a driver and a node shown live, and keep the page as a PNG."""
    started = []
    with ExitStack() as stack:
        stack.enter_context(running_node(stderr=subprocess.DEVNULL))
        for words in (['replay', str(ROOT / BAG), '--loop'], ['watch']):
            command = [sys.executable, '-P', '-m', 'gear_kinematics', *words]
            process = subprocess.Popen(  # noqa: S603, our own program
                command, stdout=subprocess.PIPE, text=True
            )
            started.append(stack.enter_context(process))
            stack.callback(process.terminate)
        driver, watch = started
        address = watch.stdout.readline().split()[-1]
        tab.set_viewport_size(LIVE_VIEW)
        tab.goto(address)
        tab.get_by_text('healthy').wait_for()
        tab.wait_for_timeout(10_000.0)  # the span of the curves, ms
        keep(tab.screenshot(), running)
        driver.terminate()
        tab.get_by_text(re.compile('no input', re.IGNORECASE)).first.wait_for()
        keep(tab.screenshot(), stopped)


def keep(screenshot: bytes, target: Path) -> None:
    """Write a PNG with few colours."""
    picture = Image.open(BytesIO(screenshot))
    picture.quantize(COLOURS).save(ROOT / target, optimize=True)


def run(arguments: list[str]) -> None:
    """Run gearkin, which has to succeed, or to find that something fails."""
    if main(arguments) > 1:
        sys.exit(f'gearkin {" ".join(arguments)}: failed')


if __name__ == '__main__':
    os.chdir(ROOT)  # pages show the paths that they were made from
    for name, arguments in DRAWN.items():
        run([*arguments, str(DOCS / name), '--force'])
    for name, flow in FLOWS.items():
        draw_flow(flow, DOCS / name)
    draw_bodies(DOCS / 'pictures/viewing.png')
    draw_printed_gear(DOCS / 'pictures/twin.svg')
    photograph(PAGES, 'pictures/watch.png', 'pictures/diagnostics.png')
    with tempfile.TemporaryDirectory() as folder, chdir(folder):
        record()
        photograph(OF_RECORDINGS)
