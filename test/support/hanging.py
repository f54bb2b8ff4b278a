"""A pytest plugin that ends a process in which a test hangs, with the GIL held or not.

pytest-timeout interrupts a test from Python, which cannot run while a C call keeps the GIL. Here
a thread of C writes the stacks of all threads to stderr and ends the process. pytest-xdist then
reports the test as failed by name and has the others run in a new process.
"""

import faulthandler
import os

import pytest

_stderr = pytest.StashKey[int]()


def pytest_addoption(parser):
    parser.addini('watchdog_timeout', 's that setup, call and teardown of a test may take each')


def pytest_configure(config):
    config.stash[_stderr] = os.dup(2)  # what tests write there is captured


@pytest.hookimpl(tryfirst=True)
def _watch(item):
    # Each anew: pytest cancels it when one of them fails.
    faulthandler.dump_traceback_later(
        float(item.config.getini('watchdog_timeout')), exit=True, file=item.config.stash[_stderr]
    )


pytest_runtest_setup = pytest_runtest_call = pytest_runtest_teardown = _watch


def pytest_runtest_logfinish():
    faulthandler.cancel_dump_traceback_later()
