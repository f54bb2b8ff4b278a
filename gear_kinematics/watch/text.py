# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Renderings of a view: a table on a terminal, lines in a pipe."""

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

from rich.console import Console
from rich.live import Live
from rich.table import Table
from rich.text import Text

from gear_kinematics.report.document import counted, hertz, printable
from gear_kinematics.ros.live import replay_node
from gear_kinematics.watch.commissioning import LiveCommissioning
from gear_kinematics.watch.drivers import DriverTopic, Listener
from gear_kinematics.watch.gear import Answer
from gear_kinematics.watch.recorder import Recorder
from gear_kinematics.watch.view import UNANSWERED, Entry, View
from gear_kinematics.watch.watcher import Watcher

_REFRESH = 0.1  # s
_LINES = 1.0  # s between lines in a pipe
_BAR = 40  # characters
_END = {'q', '\4'}  # or Ctrl-D
_STYLES = {'': 'bold', 'stale': 'dim', 'notable': 'yellow', 'pass': 'green', 'unusable': 'magenta'}
_BAD = 'bold red'  # the style of all other tones


def list_drivers(drivers: Sequence[DriverTopic], console: Console) -> None:
    """Print the topics of drivers with their joints and rates; ValueError if there are none."""
    if not drivers:
        raise ValueError(
            'no topic of type JointState: is the driver running, with the same ROS_DOMAIN_ID?'
        )
    for driver in drivers:
        line = f'{driver.topic}: {", ".join(driver.joints)} at {hertz(driver.rate)}'
        console.print(Text(printable(line)), soft_wrap=True)


def show(watcher: Watcher, console: Console, stopped: Callable[[], bool]) -> None:
    """Show a node and its drivers until stopped; on a terminal, the node can be homed by keys."""
    asked: Future[Answer] | None = None
    asking = 0  # the revision to home, if the question is shown

    def frame(pressed: str) -> tuple[list[Entry], bool]:
        nonlocal asked, asking
        view = watcher.view
        names = [node.name for node in view.nodes]
        place = names.index(view.node) + 1 if view.node in names else 0
        others = [name for name in (*names[place:], *names[:place]) if name != view.node]
        if pressed == 'u':
            asked = watcher.ask({'do': 'undo', 'revision': view.revision})
        elif pressed == 'n' and others:
            asked = watcher.ask({'do': 'show', 'node': others[0]})
        elif (asking and pressed == 'y') or (pressed == 'h' and not view.question):
            # Without a question it is refused, and why.
            asked = watcher.ask({'do': 'home', 'revision': asking if pressed == 'y' else 0})
        if pressed or not view.question:
            asking = view.revision if pressed == 'h' and view.question else 0
        rows = rows_of(view)
        if not console.is_terminal:
            return rows, True
        if view.state == 'no node':
            rows += view.drivers
        if asked:
            text, done = asked.result() if asked.done() else (UNANSWERED, True)
            rows.append(Entry('', text, '', '' if done else 'bad'))
        if asking:
            rows.append(Entry('', f'{view.question}   y yes   n no'))
        undo = f'   u undo: back to {view.undo}' if view.undo else ''
        more = f'   n next {"actuator" if view.arm else "node"}' * bool(others)
        rows.append(Entry('', '', f'h home{undo}{more}   q end'))
        return rows, pressed not in _END

    _show(console, stopped, frame)


def rows_of(view: View) -> list[Entry]:
    """Convert a view to rows."""
    state = Entry(view.node or 'gearkin watch', view.state, view.message, view.tone)
    arm = '   '.join(line([each]) for each in view.arm)
    return [state, *[Entry('all', arm)] * bool(arm), *view.values, *view.diagnostics]


def guide(live: LiveCommissioning, console: Console, stopped: Callable[[], bool]) -> None:
    """Guide through commissioning until everything is known, or a key or a signal ends it."""

    def frame(pressed: str) -> tuple[list[Entry], bool]:
        live.take(listener.poll())
        shown = live.shown
        rows = [Entry(f'{shown.known:.0%}', shown.advice), *shown.entries[:1]]
        if console.is_terminal:
            rows.insert(1, Entry('', f'{"━" * round(_BAR * shown.known):─<{_BAR}}'))
            rows += [*shown.entries[1:], Entry('', '', 'Enter end')]
        return rows, shown.known < 1.0 and pressed not in {*_END, '\n'}

    with replay_node('') as node:
        listener = Listener(node)
        listener.look([live.request.rotor.topic, live.request.output.topic])
        _show(console, stopped, frame)


def show_recording(recorder: Recorder, console: Console, stopped: Callable[[], bool]) -> None:
    """Record until a key or a signal ends it; in a pipe, there is a line for each new topic."""

    def frame(pressed: str) -> tuple[list[Entry], bool]:
        recorder.poll()
        rows = [Entry('waiting', recorder.absent or 'for a gear_state_publisher')]
        if recorder.heard:
            rows = [Entry('recording', ', '.join(recorder.heard))]
        if console.is_terminal:
            rows = [
                *(Entry(topic, hertz(polled.rate), counted(polled.count, 'message'))
                  for topic, polled in recorder.heard.items()),
                *([] if recorder.heard else rows),
                Entry('', '', 'q end'),
            ]  # fmt: skip
        return rows, pressed not in _END

    _show(console, stopped, frame)


def _show(
    console: Console, stopped: Callable[[], bool], frame: Callable[[str], tuple[list[Entry], bool]]
) -> None:
    """Show rows, which a function gives for each key, or for none, and whether to go on."""
    due, printed, going_on = time.monotonic(), '', True
    with (
        _keys(listening=console.is_terminal) as key,
        Live(console=console, auto_refresh=False, transient=True) as live,
    ):
        while going_on and not stopped():
            rows, going_on = frame(key(_REFRESH))
            if console.is_terminal:
                live.update(table(rows), refresh=True)
            elif time.monotonic() >= due or not going_on:
                due = time.monotonic() + _LINES
                if (new := line(rows)) != printed:  # without a node, it stays the same
                    now = datetime.now().astimezone().isoformat(timespec='seconds')
                    console.print(Text(f'{now} {new}'), soft_wrap=True)
                printed = new


def line(rows: Sequence[Entry]) -> str:
    """Join rows in one line; their sentences lose their full stops."""
    bare = ((row.name, row.value.removesuffix('.'), row.detail) for row in rows)
    parts = ((name, value, f'({detail})' * bool(detail)) for name, value, detail in bare)
    return printable('; '.join(' '.join(filter(None, part)) for part in parts))


def table(rows: Sequence[Entry]) -> Table:
    """Arrange rows in a table without lines."""
    grid = Table.grid(padding=(0, 2))
    grid.add_column(style='dim', overflow='fold')
    grid.add_column(overflow='fold')
    for row in rows:
        name, value, detail = map(printable, (row.name, row.value, row.detail))
        value = f'{value:<12}  ' if value and detail else value
        style = _STYLES.get(row.tone, _BAD)
        grid.add_row(Text(name), Text.assemble((value, style), (detail, 'dim')))
    return grid


@contextmanager
def _keys(*, listening: bool) -> Iterator[Callable[[float], str]]:
    """Yield a function that waits some s for a key; the end of the input is q."""
    terminals = [sys.stdin.fileno()] if listening and sys.stdin.isatty() else []
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
