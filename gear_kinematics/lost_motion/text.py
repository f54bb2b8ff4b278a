"""Lost motion on a terminal, and as plain lines in a pipe."""

from collections.abc import Iterator, Sequence

from rich.console import Console
from rich.text import Text

from gear_kinematics.lost_motion import wording
from gear_kinematics.lost_motion.report import LostMotionReport
from gear_kinematics.report.text import in_columns, is_wide, item, print_lines, rich_table


def render(reports: Sequence[LostMotionReport], console: Console) -> None:
    """Print the reports: tables on a terminal that has room, one fact per line elsewhere."""
    if not is_wide(console):
        print_lines(lines(reports), console)
        return
    for report in reports:
        _render(report, console)
    if len(reports) > 1:
        console.print(rich_table(wording.summary_table(reports)))


def lines(reports: Sequence[LostMotionReport]) -> Iterator[str]:
    """Give one fact per line, each with the recording it is about."""
    for report in reports:
        name = wording.name(report)
        for table in (wording.head(report), *wording.tables(report)):
            for subject, column, cell in table.facts():
                about = f'{subject}: {column}' if subject else column
                yield f'{name}: {about}: {cell.with_unit()}'
        for remark in wording.remarks(report):
            yield f'{name}: remark: {remark}'


def _render(report: LostMotionReport, console: Console) -> None:
    console.print(Text(wording.name(report), 'bold', overflow='fold'))
    console.print(in_columns(wording.head(report)))
    for table in wording.tables(report):
        if table.rows:
            console.print()
            console.print(rich_table(table))
    console.print()
    for remark in wording.remarks(report):
        console.print(item(remark, ''))
    console.print()
