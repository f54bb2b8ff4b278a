"""The outputs of the node: publishers of serialised messages."""

import time
from collections.abc import Callable, Iterable, Mapping

from rclpy.duration import Duration
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.publisher import Publisher


class Outputs:
    """Sends serialised messages, by topic."""

    def __init__(
        self,
        publishers: Mapping[str, Publisher],
        on_failure: Callable[[Publisher, Exception], None],
    ) -> None:
        """Start with publishers by topic.

        Args:
            publishers: the name of each topic and its publisher.
            on_failure: called with the publisher of a message that was not sent, and the error.
        """
        self._publishers = publishers
        self._on_failure = on_failure
        # `publish` checks the type and holds the handle around `publish_raw`, which takes longer
        # than encoding. Neither is needed: these are bytes, and nobody can destroy the publisher
        # meanwhile, as `publish_raw` keeps the GIL. Other releases may lack it.
        self._senders: dict[str, Callable[[bytes], None]] = {
            topic: getattr(publisher.handle, 'publish_raw', publisher.publish)
            for topic, publisher in publishers.items()
        }

    def listened_to(self, topics: Iterable[str]) -> list[str]:
        """Return those of the topics that have subscribers."""
        return [topic for topic in topics if self._publishers[topic].get_subscription_count()]

    def send(self, messages: Iterable[tuple[str, bytes]]) -> None:
        """Send messages, given with their topics, and report what fails."""
        # All are encoded first: a listener is still awake at the second if it follows at once.
        for topic, message in list(messages):
            try:
                self._senders[topic](message)
            except rclpy_implementation.RCLError as error:
                self._on_failure(self._publishers[topic], error)

    def wait_for_delivery(self, timeout: float) -> None:
        """Wait until reliable subscribers have received all messages; `timeout` is in s."""
        deadline = time.monotonic() + timeout
        for publisher in self._publishers.values():
            left = max(0.0, deadline - time.monotonic())
            publisher.wait_for_all_acked(Duration(seconds=left))
