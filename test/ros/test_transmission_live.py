"""The transmission error of the node as a process of its own, beside both encoders' drivers."""

import itertools
import math
from contextlib import ExitStack

import pytest
from live import SECOND, START, connected, rotor_state, stamp_of
from rclpy.qos import QoSProfile
from sensor_msgs.msg import JointState

pytestmark = pytest.mark.live

MS = SECOND // 1000
PLAY = 0.002  # rad
COUNT = 800
SUBJECT = 'transmission error'
TOPIC = 'transmission_error'


class Encoder:
    """The driver of the output's encoder, and a listener to the transmission error."""

    def __init__(self, peer) -> None:
        self.peer = peer
        qos = QoSProfile(depth=2000)
        self._driver = peer.node.create_publisher(JointState, 'output_encoder', qos)
        listener = peer.listen(JointState, TOPIC, qos)
        peer.wait_until(self._driver.get_subscription_count, 'a subscription to output_encoder')
        peer.wait_until(listener.get_publisher_count, TOPIC)
        # That the listener has found the node does not say that the node has found it.
        number = 0
        while not peer.received[TOPIC]:
            number += 1
            self.send(number * MS, 0.0)
            peer.answer(rotor_state(number * MS, position=[0.0]))

    @property
    def errors(self):
        """What came that is no answer to a probe."""
        return [error for error in self.peer.received[TOPIC] if stamp_of(error) >= START]

    def send(self, stamp, *position) -> None:
        self._driver.publish(rotor_state(stamp, ['shaft'], position))

    def status(self, condition=bool, meanwhile=lambda: None):
        return self.peer.status(
            lambda s: s.name.endswith(f': {SUBJECT}') and condition(s), SUBJECT, meanwhile
        )


@pytest.fixture
def start(tmp_path):
    """Give a function that runs a node with parameters, and the encoder at its output."""
    with ExitStack() as stack:

        def start(**parameters):
            arguments = [
                part for name, value in parameters.items() for part in ('-p', f'{name}:={value}')
            ]
            peer = stack.enter_context(connected(tmp_path, *arguments))
            if 'rotor_encoder' in parameters:
                assert peer.home().success
            return Encoder(peer)

        yield start


def swing(encoder):
    """Swing once, with play in the gear; gives the errors put in, by stamp."""
    errors = {}
    peer = encoder.peer
    for k in range(COUNT):
        phase = k * math.tau / COUNT
        angle = 0.3 * math.sin(phase)
        error = math.copysign(0.5 * PLAY, -math.cos(phase))
        stamp = START + k * MS
        encoder.send(stamp, angle + error)
        errors[stamp] = error
        peer.send(rotor_state(stamp, ['rotor'], [-19.0 * angle]))
    peer.outputs(COUNT)
    return errors


def test_error_is_published_with_the_encoders_stamp_and_judged(start):
    encoder = start(transmission_error_limit=1e-3)
    errors = swing(encoder)
    # The two streams come in any order, so that the last measured angle may not be known yet.
    encoder.peer.wait_until(lambda: len(encoder.errors) >= COUNT - 1, 'the errors')
    found = {stamp_of(message): message for message in encoder.errors}
    assert found.keys() <= errors.keys()
    for stamp, message in found.items():
        assert message.name == ['output_shaft']
        assert list(message.position) == [pytest.approx(errors[stamp], abs=1e-12)]
        assert not message.velocity
        assert not message.effort
    stamps = itertools.count(START + COUNT * MS, MS)

    def go_on():
        stamp = next(stamps)
        encoder.send(stamp, 0.0)
        encoder.peer.answer(rotor_state(stamp, position=[0.0]))

    level, message, values = encoder.status(lambda s: 'peak to peak' in s.message, go_on)
    assert level == 1
    assert message == 'peak to peak 0.002 rad'
    assert float(values['peak to peak (rad)']) == pytest.approx(PLAY)
    assert encoder.peer.set(transmission_error_limit=0.1).successful
    # A new setting starts the comparison anew only where it changes what is compared.
    level, message, values = encoder.status(lambda s: s.level == b'\0', go_on)
    assert message == 'ok'
    assert int(values['samples']) >= COUNT
    _, message, values = encoder.status(lambda s: 'no output_encoder' in s.message)
    assert values['peak to peak (rad)'] == 'none'


def test_nothing_is_published_of_a_stale_pair(start):
    encoder = start()
    for stamp, between in ((START, 50 * MS), (START + SECOND, 500 * MS), (START + 2 * SECOND, MS)):
        encoder.peer.answer(rotor_state(stamp, position=[0.0]))
        encoder.send(stamp + between, 0.25)
        encoder.peer.answer(rotor_state(stamp + 2 * between, position=[0.0]))
    encoder.peer.wait_until(lambda: len(encoder.errors) > 1, 'the errors of the good pairs')
    assert [stamp_of(message) for message in encoder.errors] == [
        START + 50 * MS,
        START + 2 * SECOND + MS,
    ]
    *_, values = encoder.status(lambda s: any('gap' in pair.key for pair in s.values))
    assert values['not compared: gap of the ideal angle'] == '1'


def test_nothing_is_published_while_the_turns_are_unknown(start):
    encoder = start(rotor_encoder='single_turn')
    peer = encoder.peer

    def pair(stamp):
        peer.answer(rotor_state(stamp, position=[0.0]))
        encoder.send(stamp + MS, 0.0)
        peer.answer(rotor_state(stamp + 2 * MS, position=[0.0]))

    stamps = itertools.count(START, 2 * MS)
    pair(next(stamps))  # the gap before it could have hidden turns
    encoder.status(lambda s: 'no rotor angle' in s.message, lambda: pair(next(stamps)))
    assert not encoder.errors
    assert peer.home().success
    referenced = next(stamps)
    pair(referenced)
    peer.wait_until(lambda: encoder.errors, 'an error')
    assert [stamp_of(message) for message in encoder.errors] == [referenced + MS]


def test_without_an_encoder_there_is_no_word_of_it(tmp_path):
    with connected(tmp_path) as peer:
        report, _ = peer.report()
        names = [s.name for s in report.status if s.hardware_id.startswith(peer.namespace)]
    assert names == [f'{peer.namespace[1:]}/gear_state_publisher: rotor input']


def test_bad_input_is_counted_and_the_node_goes_on(start):
    encoder = start()
    encoder.send(START)
    encoder.send(START + MS, math.nan)
    encoder.peer.answer(rotor_state(START, position=[0.0]))
    encoder.send(START + MS, 0.5)
    encoder.peer.answer(rotor_state(START + MS, position=[0.0]))
    encoder.peer.wait_until(lambda: encoder.errors, 'an error')
    level, _, values = encoder.status(
        lambda s: 'rejected: position missing' in s.message, lambda: encoder.send(START)
    )
    assert level == 1
    assert values['rejected: position not finite'] == '1'
