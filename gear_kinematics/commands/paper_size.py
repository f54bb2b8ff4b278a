"""The options for the size of a figure."""

import argparse

from gear_kinematics.report.image import Paper


def add_paper(parser: argparse.ArgumentParser) -> None:
    """Add the options; see `paper`."""
    parser.add_argument(
        '--width-mm',
        type=float,
        metavar='MM',
        help='width of the figure, with text as large as on any other (default: what suits it)',
    )
    parser.add_argument(
        '--dpi', type=int, metavar='N', help=f'pixels per inch (default: {Paper().dpi})'
    )


def paper(options: argparse.Namespace) -> Paper:
    """Return what a figure is for, as the options say.

    Raises:
        ValueError: if a size is out of bounds.
    """
    given = {'width_mm': options.width_mm, 'dpi': options.dpi}
    return Paper(**{name: value for name, value in given.items() if value is not None})
