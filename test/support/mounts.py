# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Programs that see other file systems than the rest of the machine does."""

import os
import subprocess

import pytest


def with_mounts(mount: str, *command: object) -> list[str]:
    """Give the command that runs another with a file system mounted, which nobody else sees.

    Skips the test if this user cannot do that here.

    Args:
        mount: the arguments of `mount`.
        command: what to run.
    """
    unshare = ['unshare', '--mount'] if os.geteuid() == 0 else ['unshare', '-r', '--mount']
    mounted = [*unshare, 'sh', '-c', f'mount {mount} && exec "$@"', 'sh']
    try:
        subprocess.run([*mounted, 'true'], check=True, capture_output=True, text=True)
    except FileNotFoundError:
        pytest.skip('unshare is not installed')
    except subprocess.CalledProcessError as error:
        pytest.skip(f'mount namespaces need root: {error.stderr.strip()}')
    return [*mounted, *map(str, command)]
