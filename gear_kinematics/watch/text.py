"""What there is to see, in a terminal or in a pipe."""

import os
import select
import sys
import termios
import time
import tty
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future
from contextlib import contextmanager
from datetime import datetime

from rich.console import Console, Group, RenderableType
from rich.live import Live
from rich.table import Table as RichTable
from rich.text import Text

from gear_kinematics.report.document import Document, Section, Table, printable
from gear_kinematics.report.text import render
from gear_kinematics.watch.drivers import Driver
from gear_kinematics.watch.view import View
from gear_kinematics.watch.watcher import Answer, Watcher

_REFRESH = 0.1  # s
_LINES = 1.0  # s between lines in a pipe
_PATIENCE = 5.0  # s to wait for a driver
_COUNTING = 1.5  # s to measure the rates of those that are found
_STYLES = {'': '', 'notable': 'yellow', 'bad': 'bold red'}
_STATES = {
    'none': ('no node', 'bold magenta'),
    'connecting': ('connecting', 'bold magenta'),
    'connected': ('connected', 'bold green'),
    'ended': ('ended', 'bold red'),
}


def show(watcher: Watcher, console: Console, stopped: Callable[[], bool]) -> None:
    """Show what there is to see until stopped, as a table on a terminal and as lines elsewhere."""
    if console.is_terminal:
        _show_table(watcher, console, stopped)
    else:
        _print_lines(watcher, console, stopped)


def list_drivers(drivers: Sequence[Driver], console: Console) -> None:
    """Print the topics of drivers with their joints and rates."""
    if not drivers:
        console.print('There are no topics of type JointState yet.')
        return
    columns = {
        '': lambda driver: driver.topic,
        'joints': lambda driver: printable(', '.join(driver.joints)),
        'rate': lambda driver: f'{driver.rate:.0f} Hz',
        'drivers': lambda driver: str(driver.publishers) if driver.publishers > 1 else '',
    }
    table = Table.of_items(columns, drivers, words=('', 'joints'))
    render(Document('drivers', (Section('', (table,)),)), console)


def wait_and_list(watcher: Watcher, console: Console, stopped: Callable[[], bool]) -> None:
    """Listen until the rates of the first drivers are known, then list them."""
    end, found = time.monotonic() + _PATIENCE, False
    while time.monotonic() < end and not stopped():
        time.sleep(_REFRESH)
        if watcher.view.drivers and not found:
            end, found = time.monotonic() + _COUNTING, True
    list_drivers(watcher.view.drivers, console)


def _print_lines(watcher: Watcher, console: Console, stopped: Callable[[], bool]) -> None:
    wait_and_list(watcher, console, stopped)
    due = time.monotonic()
    while not stopped():
        if time.monotonic() >= due:
            due += _LINES
            now = datetime.now().astimezone().isoformat(timespec='seconds')
            console.print(Text(f'{now} {line(watcher.view)}'), soft_wrap=True)
        time.sleep(_REFRESH)


def line(view: View) -> str:
    """Put a view into one line."""
    facts = [
        f'{reading.name} {reading.value}' + (f' ({reading.detail})' if reading.detail else '')
        for reading in view.readings
    ]
    state, _ = _STATES[view.state]
    recording = f'recording {view.recording}' if view.recording else view.failure
    parts = [f'{view.node} {state}'.strip(), view.words, '; '.join(facts)]
    parts += [sentence.text for sentence in view.sentences] if view.state == 'connected' else []
    return printable(' | '.join(part for part in (*parts, recording) if part))


def _show_table(watcher: Watcher, console: Console, stopped: Callable[[], bool]) -> None:
    asked: Future[Answer] | None = None
    with _keys() as key, Live(console=console, auto_refresh=False, transient=True) as live:
        while not stopped():
            match key(_REFRESH):
                case 'h':
                    asked = watcher.home()
                case 'r':
                    asked = watcher.stop() if watcher.view.recording else watcher.record()
                case 'q':
                    return
            answer = asked.result() if asked and asked.done() else None
            live.update(table(watcher.view, answer), refresh=True)


def table(view: View, answer: Answer | None = None) -> RenderableType:
    """Show a view, and the answer to the last command, as a table."""
    state, style = _STATES[view.state]
    parts: list[RenderableType] = [
        Text.assemble(('gearkin watch ', 'bold'), f'{view.node} ', (state, style))
    ]
    if view.words:
        parts.append(Text(view.words))
    parts.append(Text())
    grid = RichTable.grid(padding=(0, 2))
    for reading in view.readings:
        value = Text(reading.value, _STYLES[reading.tone] or 'bold')
        grid.add_row(Text(reading.name, 'dim'), value, Text(reading.detail, 'dim'))
    if view.readings:
        parts += [grid, Text()]
    parts += [Text(printable(text.text), _STYLES[text.tone]) for text in view.sentences]
    if view.state == 'none':
        parts += [_drivers(view.drivers), Text('gearkin init writes a parameter file for one.')]
    if view.recording:
        parts.append(Text.assemble(('● ', 'red'), f'recording to {view.recording}'))
    elif view.failure:
        parts.append(Text(printable(view.failure), _STYLES['bad']))
    if answer:
        parts.append(Text(printable(answer.text), '' if answer.done else _STYLES['bad']))
    record = 'stop recording' if view.recording else 'record'
    parts += [Text(), Text(f'h home   r {record}   q end', 'dim')]
    return Group(*parts)


def _drivers(drivers: Sequence[Driver]) -> RenderableType:
    grid = RichTable.grid(padding=(0, 2))
    grid.add_row(*(Text(heading, 'dim') for heading in ('topic', 'joints', 'rate')))
    for driver in drivers:
        joints = printable(', '.join(driver.joints))
        grid.add_row(Text(driver.topic), Text(joints), Text(f'{driver.rate:.0f} Hz'))
    return grid


@contextmanager
def _keys() -> Iterator[Callable[[float], str]]:
    """Take single keys from the terminal; yields a function that waits some s for one.

    The end of the input is q.
    """
    if not sys.stdin.isatty():

        def wait(timeout: float) -> str:
            time.sleep(timeout)
            return ''

        yield wait
        return
    descriptor = sys.stdin.fileno()
    before = termios.tcgetattr(descriptor)

    def read(timeout: float) -> str:
        ready, _, _ = select.select([descriptor], [], [], timeout)
        if not ready:
            return ''
        try:
            return os.read(descriptor, 1).decode(errors='replace').lower() or 'q'
        except OSError:  # the terminal is gone
            return 'q'

    try:
        tty.setcbreak(descriptor)
        yield read
    finally:
        termios.tcsetattr(descriptor, termios.TCSADRAIN, before)
