"""The options for the size of a figure."""

import argparse
from pathlib import Path

from gear_kinematics.report.image import INCH, ImageFile

_WIDTHS = (30.0, 1000.0)  # mm
_DOTS = (30, 2400)  # per inch
_DPI = 150
_MOST_PIXELS = 20_000
"""Width of an image."""


def add_paper(parser: argparse.ArgumentParser) -> None:
    """Add the options; see `image_file`."""
    parser.add_argument(
        '--width-mm',
        type=float,
        metavar='MM',
        help='width of the figure, with text as large as on any other (default: what suits it)',
    )
    parser.add_argument('--dpi', type=int, metavar='N', help=f'pixels per inch (default: {_DPI})')


def image_file(options: argparse.Namespace, target: str) -> ImageFile:
    """Return the file of a figure with its size, as the options say.

    Raises:
        ValueError: if a size is out of bounds, the image would be too large, or the suffix is
            unknown.
        ModuleNotFoundError: without matplotlib.
    """
    width, dpi = options.width_mm, _DPI if options.dpi is None else options.dpi
    least, most = _WIDTHS
    if width is not None and not least <= width <= most:
        raise ValueError(f'--width-mm must be between {least:g} and {most:g}')
    if not _DOTS[0] <= dpi <= _DOTS[1]:
        raise ValueError(f'--dpi must be between {_DOTS[0]} and {_DOTS[1]}')
    if (width or 0.0) / INCH * dpi > _MOST_PIXELS:
        raise ValueError(f'an image is at most {_MOST_PIXELS} pixels wide: reduce --dpi')
    file = ImageFile(Path(target), width, dpi)
    _ = file.format  # its errors, before any work
    return file
