# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
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
from rich.progress_bar import ProgressBar
from rich.table import Table as RichTable
from rich.text import Text

from gear_kinematics.report.document import Document, Section, Table, printable
from gear_kinematics.report.text import render
from gear_kinematics.watch.commissioning import LiveCommissioning
from gear_kinematics.watch.drivers import Driver
from gear_kinematics.watch.view import Answer, Commission, Entry, View
from gear_kinematics.watch.watcher import Watcher

_REFRESH = 0.1  # s
_LINES = 1.0  # s between lines in a pipe
_POLL = 0.03  # s between looks at the messages
_PATIENCE = 5.0  # s to wait for a driver
_COUNTING = 1.5  # s to measure the rates of those that are found
_STYLES = {'': 'bold', 'stale': 'dim', 'notable': 'yellow', 'pass': 'green', 'unusable': 'magenta'}
_BAD = 'bold red'  # the style of all other tones


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
    due, said = time.monotonic(), ''
    while not stopped():
        if time.monotonic() >= due:
            due += _LINES
            new = line(watcher.view)
            if new != said:  # as long as there is no node, it is the same
                now = datetime.now().astimezone().isoformat(timespec='seconds')
                console.print(Text(f'{now} {new}'), soft_wrap=True)
            said = new
        time.sleep(_REFRESH)


def line(view: View) -> str:
    """Put a view into one line."""
    values, diagnostics = (
        '; '.join(
            f'{entry.name} {entry.value}' + (f' ({entry.detail})' if entry.detail else '')
            for entry in entries
        )
        for entries in (view.values, view.diagnostics)
    )
    recording = f'recording {view.recording}' if view.recording else view.failure
    state = ' '.join(part for part in (view.node, view.state, view.duration) if part)
    parts = (state, view.message, values, diagnostics, recording)
    return printable(' | '.join(part for part in parts if part))


def _show_table(watcher: Watcher, console: Console, stopped: Callable[[], bool]) -> None:
    asked: Future[Answer] | None = None
    asking = False  # whether to home
    with _keys() as key, Live(console=console, auto_refresh=False, transient=True) as live:
        while not stopped():
            pressed, question = key(_REFRESH), watcher.view.question
            confirmed = asking and pressed == 'y'
            asking = bool(question) and (pressed == 'h' or (asking and not pressed))
            match pressed:
                case 'y' if confirmed:
                    asked = watcher.home()
                case 'h' if not question:
                    asked = watcher.home()  # is refused, and why
                case 'u':
                    asked = watcher.undo()
                case 'r':
                    asked = watcher.stop() if watcher.view.recording else watcher.record()
                case 'q':
                    return
            answer = asked.result() if asked and asked.done() else None
            live.update(table(watcher.view, answer, asking=asking), refresh=True)


def table(view: View, answer: Answer | None = None, *, asking: bool = False) -> RenderableType:
    """Show a view, the question before homing, and the answer to a command, as a table."""
    state = (f'{view.state} {view.duration}', _STYLES.get(view.tone, _BAD))
    title = Text.assemble(('gearkin watch ', 'bold'), f'{view.node} ', state)
    grid = _grid((*view.values, *view.diagnostics))
    parts: list[RenderableType] = [title, Text(printable(view.message)), grid, Text()]
    if view.state == 'no node':
        for driver in view.drivers:
            joints = printable(', '.join(driver.joints))
            parts.append(Text(f'{driver.topic}  {joints}  {driver.rate:.0f} Hz'))
        parts.append(
            Text('gearkin init writes a parameter file; from two encoders, gearkin commission.')
        )
    if view.recording:
        parts.append(Text.assemble(('● ', 'red'), f'recording to {view.recording}'))
    elif view.failure:
        parts.append(Text(printable(view.failure), _BAD))
    if answer:
        parts.append(Text(printable(str(answer)), '' if answer.done else _BAD))
    if asking and view.question:
        parts.append(Text(f'{view.question}   y yes   n no', 'bold'))
    record = 'stop recording' if view.recording else 'record'
    undo = printable(f'u undo: {view.undo} again   ') if view.undo else ''
    parts += [Text(), Text(f'h home   {undo}r {record}   q end', 'dim')]
    return Group(*parts)


def guide(live: LiveCommissioning, console: Console, stopped: Callable[[], bool]) -> None:
    """Guide through commissioning until nothing is open, or a key or a signal ends it."""
    due, said, shown = time.monotonic(), '', live.shown
    period = _REFRESH if console.is_terminal else _LINES
    with _keys() as key, Live(console=console, auto_refresh=False, transient=True) as screen:
        while not stopped() and shown.known < 1.0:
            live.poll()
            match key(_POLL):
                case 'z':
                    live.zero_here()
                case 'q' | '\n':
                    return
            if time.monotonic() < due:
                continue
            due, shown = due + period, live.shown
            if console.is_terminal:
                screen.update(progress(shown), refresh=True)
                continue
            known = '; '.join(f'{entry.name} {entry.value}' for entry in shown.entries)
            parts = f'{shown.known:.0%}', shown.advice, shown.heard, known
            if (new := printable(' | '.join(filter(None, parts)))) != said:
                console.print(Text(new), soft_wrap=True)
            said = new


def progress(shown: Commission) -> RenderableType:
    """Show what to do, a bar, and what is known."""
    heard, advice = printable(shown.heard), printable(shown.advice)
    keys = Text('z the output angle is 0 here   Enter end', 'dim')
    bar, grid = ProgressBar(1.0, shown.known, width=40), _grid(shown.entries)
    return Group(Text(advice, 'bold'), bar, Text(heard), grid, keys)


def _grid(entries: Sequence[Entry]) -> RichTable:
    grid = RichTable.grid(padding=(0, 2))
    grid.add_column(no_wrap=True)
    for entry in entries:
        name, value, detail = map(printable, (entry.name, entry.value, entry.detail))
        style = _STYLES.get(entry.tone, _BAD)
        shown = Text.assemble((f'{value:<12}', style), '  ' * bool(detail), (detail, 'dim'))
        grid.add_row(Text(name, 'dim'), shown)
    return grid


@contextmanager
def _keys() -> Iterator[Callable[[float], str]]:
    """Yield a function that waits some s for a key; the end of the input is q."""
    terminals = [sys.stdin.fileno()] if sys.stdin.isatty() else []
    before = [termios.tcgetattr(terminal) for terminal in terminals]

    def read(timeout: float) -> str:
        ready, _, _ = select.select(terminals, [], [], timeout)
        try:
            return os.read(ready[0], 1).decode(errors='replace').lower() or 'q' if ready else ''
        except OSError:  # the terminal is gone
            return 'q'

    try:
        for terminal in terminals:
            tty.setcbreak(terminal)
        yield read
    finally:
        for terminal, attributes in zip(terminals, before, strict=True):
            termios.tcsetattr(terminal, termios.TCSADRAIN, attributes)
