"""Draw the pictures of the README and of these pages: `make pictures`.

Pages are photographed by the system's Chromium.
"""

import os
import shutil
import sys
import tempfile
from io import BytesIO
from pathlib import Path

from PIL import Image
from playwright.sync_api import sync_playwright

from gear_kinematics.commands.cli import main

ROOT = Path(__file__).parents[1]
DOCS = Path('docs')
BAG = 'bags/servo_point_to_point'
CONFIG = ['--config', 'config/actuator.yaml']
SHAFT = ['--branch-stiffness', '3000', '--shaft-diameter', '0.012', '--shaft-length', '0.151']
DRAWN = {
    'mechanism.gif': ['animate'],
    'scheme.svg': ['plot', 'scheme'],
    'roses.svg': ['plot', 'roses'],
    'slides.svg': ['plot', 'slides'],
    'pictures/output.svg': ['plot', 'output', '--bag', BAG],
    'pictures/preload.svg': ['preload', '--wanted-threshold', '1', *SHAFT, '--plot'],
    'pictures/index.svg': ['index', '--phase-b', '--preload', '0.8', *SHAFT, '--drawing'],
}
"""By file, each with the arguments of gearkin that come before it."""
PAGES = {
    'pictures/validate.png': ['validate', BAG, *CONFIG],
    'pictures/describe.png': ['describe'],
    'pictures/index.png': ['index', '--phase-b', '--preload', '0.8', *SHAFT],
    'pictures/preload.png': ['preload', '--wanted-threshold', '1', *SHAFT],
    'pictures/lost_motion.png': ['lost-motion', 'docs/examples/ramps.csv', *CONFIG],
}
VIEW = {'width': 1100, 'height': 1000}  # pixels
COLOURS = 64


def photograph(pages: dict[str, list[str]]) -> None:
    """Have each page made, and keep its upper part as a PNG."""
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=shutil.which('chromium'))
        tab = browser.new_page(viewport=VIEW, color_scheme='light')
        for name, arguments in pages.items():
            page = Path(folder, 'page.html')
            run([*arguments, '--html', str(page)])
            tab.goto(page.as_uri())
            tab.wait_for_load_state('networkidle')
            picture = Image.open(BytesIO(tab.screenshot()))
            picture.quantize(COLOURS).save(DOCS / name, optimize=True)
        browser.close()


def run(arguments: list[str]) -> None:
    """Run gearkin, which has to succeed."""
    if main(arguments):
        sys.exit(f'gearkin {" ".join(arguments)}: failed')


if __name__ == '__main__':
    os.chdir(ROOT)  # pages show the paths that they were made from
    for name, arguments in DRAWN.items():
        run([*arguments, str(DOCS / name), '--force'])
    photograph(PAGES)
