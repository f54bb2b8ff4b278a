"""`gearkin demo`: the shipped bag through the live node, shown live, then validated."""

import math
from collections.abc import Mapping
from typing import Any

from rich.console import Console, Group
from rich.live import Live
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn
from rich.table import Table

from gear_kinematics.bag import Bag, BagMessage
from gear_kinematics.kinematics import matrix_method
from gear_kinematics.ros.live import live_messages
from gear_kinematics.state import parameters
from gear_kinematics.state.share import share_directory
from gear_kinematics.validation.report import BagReport
from gear_kinematics.validation.validator import Tolerances, Validator
from gear_kinematics.wire.cdr import decode_joint_state, decode_pose_array

TOLERANCE = 1e-12
"""Greatest deviation that passes: of angles in rad, of positions in units of the eccentricity."""
_BAG = 'servo_point_to_point'


def run(console: Console) -> BagReport:
    """Play the shipped bag's rotor states into a node process and validate what comes back."""
    config = parameters.load(parameters.default_config())
    with Bag(share_directory() / 'bags' / _BAG) as bag:
        count = sum(1 for _ in bag.messages(['/rotor_state']))
        console.print(
            f'Playing [bold]{_BAG}[/bold], {count} recorded rotor states, '
            'into gear_state_publisher over DDS.'
        )
        published = _play(console, bag, config, count)
    eccentricity = config['eccentricity']
    validator = Validator(
        config,
        tolerances=Tolerances(TOLERANCE, TOLERANCE * eccentricity),
        strict=True,
        solver=matrix_method.solve,  # not the node's own formulas
    )
    validator.feed(published)
    report = validator.report(_BAG)
    console.print(_verdict(report))
    return report


def _play(console: Console, bag: Bag, config: Mapping[str, Any], count: int) -> list[BagMessage]:
    progress = Progress(
        TextColumn('rotor states'),
        BarColumn(),
        MofNCompleteColumn(),
        TimeRemainingColumn(),
        console=console,
    )
    task = progress.add_task('', total=count)
    received: list[BagMessage] = []
    with Live(progress, console=console, auto_refresh=False, transient=True) as live:

        def show(sent: int) -> None:
            progress.update(task, completed=sent)
            live.update(Group(progress, _current(received)), refresh=True)

        for message in live_messages(bag, config, progress=show):
            received.append(message)  # noqa: PERF402  # for `show` to see it
    return received


def _current(received: list[BagMessage]) -> Table:
    """The latest message of each topic in words."""
    table = Table('topic', 'now', box=None)
    latest = {message.topic: message.data for message in received[-12:]}
    for topic, name in (('/rotor_state', 'rotor angle'), ('/output_state', 'output angle')):
        if topic in latest:
            (angle,) = decode_joint_state(latest[topic]).position
            table.add_row(topic, f'{name} {angle:10.4f} rad {math.degrees(angle):10.2f}°')
    if '/body_poses' in latest:
        numbers = decode_pose_array(latest['/body_poses']).numbers
        x, y = (1e3 * value for value in numbers[:2])
        table.add_row('/body_poses', f'satellite_a {x:+.4f} mm, {y:+.4f} mm')
    return table


def _verdict(report: BagReport) -> Table:
    verdict = '[green]All agree' if report.passed else '[red]They do not agree'
    rotor = report.rotor
    table = Table(
        'topic',
        'messages',
        'missing',
        'field',
        'worst deviation',
        title='What the node published, against the matrix method',
        caption=(
            f'{rotor.messages if rotor else 0} rotor states in. '
            f'{verdict}[/] to {TOLERANCE:g} rad and {TOLERANCE:g} of the eccentricity.'
        ),
    )
    for topic in report.topics:
        for field in topic.fields:
            table.add_row(
                topic.topic,
                str(field.compared),
                str(topic.missing),
                field.name,
                f'{field.max_error:.1e} {field.unit}',
            )
    return table
