"""A stand-in for what watches a node, for the server of `gearkin watch`."""

from concurrent.futures import Future

from gear_kinematics.kinematics import Branch, Mechanism
from gear_kinematics.ros.watch.view import View
from gear_kinematics.ros.watch.watcher import Answer


class WatcherStandIn:
    """Shows one view, answers every command, and notes what it is asked for."""

    def __init__(self, view: View) -> None:
        """Take the view."""
        self.view = view
        self.drawn = Mechanism(80, 76, 0.0011, (Branch('a'),))
        self.module = 0.0005
        self.asked: list[tuple] = []

    def __getattr__(self, name):
        """Answer a command with its name."""

        def ask(*arguments) -> Future:
            self.asked.append((name, *arguments))
            answer: Future = Future()
            answer.set_result(Answer(f'{name}.', done=True))
            return answer

        return ask
