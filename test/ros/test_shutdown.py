# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""A participant that leaves during discovery does not hang."""

import os
import shutil
import subprocess
import sys
from contextlib import closing

import pytest
from live import Listener
from sensor_msgs.msg import JointState

pytestmark = pytest.mark.live

# The participant always leaves while a discovery callback runs.
SLOW_DISCOVERY = r"""
#include <dlfcn.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <unistd.h>

#define REMOVE_ENTITY _ZN14rmw_dds_common10GraphCache13remove_entityERK9rmw_gid_sb
#define SET_LISTENER \
    _ZN8eprosima7fastdds3dds17DomainParticipant12set_listenerEPNS1_25DomainParticipantListenerE
#define NAME(function) #function
#define REAL(library, function) dlsym(dlopen(library, RTLD_NOW | RTLD_NOLOAD), NAME(function))

static atomic_int running;

/* What the callback of discovery does with an endpoint that is gone. */
bool REMOVE_ENTITY(void *graph, const void *gid, bool reader)
{
    bool (*real)(void *, const void *, bool) = REAL("librmw_dds_common.so", REMOVE_ENTITY);
    ++running;
    usleep(20000);
    bool found = real(graph, gid, reader);
    --running;
    return found;
}

/* What rmw_fastrtps does first when it destroys a participant. */
int SET_LISTENER(void *participant, void *listener)
{
    int (*real)(void *, void *) = REAL("librmw_fastrtps_cpp.so", SET_LISTENER);
    for (int milliseconds = 0; !running && milliseconds < 1000; ++milliseconds)
        usleep(1000);
    return real(participant, listener);
}
"""


@pytest.fixture
def slow_discovery(tmp_path):
    """Compile it and return its path."""
    compiler = shutil.which('cc') or pytest.skip('no C compiler')
    path = tmp_path / 'slow_discovery.so'
    command = [compiler, '-shared', '-fPIC', '-o', path, '-x', 'c', '-', '-ldl']
    subprocess.run(command, input=SLOW_DISCOVERY, check=True, text=True)
    return path


def test_participant_leaves_while_it_discovers(slow_discovery):
    with (
        closing(Listener('/leaving')) as listener,
        subprocess.Popen(
            [sys.executable, '-m', 'gear_kinematics.ros'],
            env=os.environ | {'LD_PRELOAD': str(slow_discovery)},
            text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
        ) as process,
    ):  # fmt: skip
        try:
            assert any('gear ratio' in line for line in process.stdout)
            process.terminate()

            def has_ended():
                # To be discovered.
                subscription = listener.node.create_subscription(JointState, 'x', print, 1)
                listener.node.destroy_subscription(subscription)
                return process.poll() is not None

            listener.wait_until(has_ended, 'the end')
            assert process.returncode == 0
        finally:
            process.kill()
