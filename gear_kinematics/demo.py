"""`gearkin demo`: the shipped bag through the live node, shown live, then validated."""

import math
import os
import time

from rich.console import Console, Group
from rich.live import Live
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn
from rich.table import Table

from gear_kinematics import parameters
from gear_kinematics.bag import BagMessage, read_bag
from gear_kinematics.kinematics import matrix_method
from gear_kinematics.messages import decode_joint_state, decode_pose_array
from gear_kinematics.replay import Replay, running_node
from gear_kinematics.report import BagReport
from gear_kinematics.share import share_directory
from gear_kinematics.validation import Tolerances, Validator

TOLERANCE = 1e-12
"""Greatest deviation that passes: of angles in rad, of positions in units of the eccentricity."""
_BAG = 'servo_point_to_point'
_REFRESH = 0.1  # s


def run(console: Console) -> BagReport:
    """Play the shipped bag's rotor states into a node process and validate what comes back."""
    # The demo talks to its own node and to nobody else's.
    os.environ['ROS_AUTOMATIC_DISCOVERY_RANGE'] = 'LOCALHOST'
    config = parameters.load(parameters.default_config())
    path = share_directory() / 'bags' / _BAG
    recorded = list(read_bag(path, ['/rotor_state']))
    console.print(
        f'Playing [bold]{_BAG}[/bold], {len(recorded)} recorded rotor states, '
        'into gear_state_publisher over DDS.'
    )
    namespace = f'/gear_kinematics_demo_{os.getpid()}'
    with (
        running_node(['--ros-args', '-r', f'__ns:={namespace}']),
        Replay(namespace) as replay,
    ):
        replay.wait_for_node()
        _play(console, replay, recorded)
    eccentricity = config['eccentricity']
    validator = Validator(
        config,
        tolerances=Tolerances(TOLERANCE, TOLERANCE * eccentricity),
        solver=matrix_method.solve,  # not the node's own formulas
    )
    validator.feed(replay.received)
    report = validator.report(_BAG)
    console.print(_verdict(report))
    return report


def _play(console: Console, replay: Replay, recorded: list[BagMessage]) -> None:
    progress = Progress(
        TextColumn('rotor states'),
        BarColumn(),
        MofNCompleteColumn(),
        TimeRemainingColumn(),
        console=console,
    )
    task = progress.add_task('', total=len(recorded))
    start, next_refresh = time.monotonic(), 0.0
    with Live(progress, console=console, auto_refresh=False, transient=True) as live:
        for number, message in enumerate(recorded, start=1):
            moment = start + 1e-9 * (message.received - recorded[0].received)
            replay.receive_until(moment)
            replay.send(message.data)
            if moment >= next_refresh:
                next_refresh = moment + _REFRESH
                progress.update(task, completed=number)
                live.update(Group(progress, _current(replay.received)), refresh=True)
        replay.wait_until(lambda: len(replay.received) == 3 * len(recorded), timeout=5.0)


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
