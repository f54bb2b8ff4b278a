"""Opening a file of a bag by what it is, whatever it is named."""

import tempfile
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, closing, contextmanager
from pathlib import Path
from typing import IO

from gear_kinematics.bag.compression import FILE_OPENERS, decompress_file
from gear_kinematics.bag.errors import BagError, DamagedBagError, cause
from gear_kinematics.bag.limits import Budget
from gear_kinematics.bag.mcap import MCAP_MAGIC, Mcap
from gear_kinematics.bag.ros1 import Ros1
from gear_kinematics.bag.sqlite import Sqlite
from gear_kinematics.bag.storage import Storage

_KINDS: Mapping[bytes, Callable[[Path, Budget], Storage]] = {
    MCAP_MAGIC: Mcap,
    b'SQLite format 3\0': Sqlite,
    b'#ROSBAG V2.0': Ros1,
}


@contextmanager
def opened(file: Path, budget: Budget, read: int = 0) -> Iterator[Storage]:
    """Open a file of a bag; a compressed one by way of a temporary file.

    Args:
        file: to open.
        budget: what may come out of the files of the bag.
        read: messages that were read before, from other files.

    Raises:
        BagError: for whatever is raised about the file, also by the one who uses it.
    """
    storage, broken = None, ''
    try:
        with ExitStack() as stack:
            source = stack.enter_context(file.open('rb'))
            content = file
            if opener := FILE_OPENERS.get(_start(source, 4)):
                content = Path(stack.enter_context(tempfile.TemporaryDirectory()), 'bag')
                broken = decompress_file(source, content, opener)
                source = stack.enter_context(content.open('rb'))
            start = _start(source, 16)
            kind = next((kind for magic, kind in _KINDS.items() if start.startswith(magic)), None)
            if not kind:
                raise ValueError('not a bag of a known kind' if start else 'the file is empty')
            storage = stack.enter_context(closing(kind(content, budget)))
            yield storage
            if broken:
                raise ValueError(broken)
    except BagError:
        raise
    except Exception as error:
        where, here = (storage.position(), storage.read) if storage else ('', 0)
        text = f'{file}: {where}{broken or cause(error)}'
        raise (DamagedBagError if read + here else BagError)(text) from error


def _start(source: IO[bytes], size: int) -> bytes:
    start = source.read(size)
    source.seek(0)
    return start
