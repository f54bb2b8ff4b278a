"""What tests with nodes in their own process have in common."""

import pytest
import rclpy
from rclpy.context import Context
from rclpy.signals import SignalHandlerOptions


@pytest.fixture(scope='module')
def context():
    context = Context()
    rclpy.init(context=context, signal_handler_options=SignalHandlerOptions.NO)
    yield context
    rclpy.shutdown(context=context)
