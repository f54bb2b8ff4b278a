"""Reads YAML files that users write, with one clear error whatever is wrong with them."""

import re
from pathlib import Path
from typing import Any

import yaml

_MAX_LENGTH = 2**18  # characters; a file of that length takes seconds to parse


class Loader(yaml.SafeLoader):
    """Reads 15e-4 as a number, as ROS does, and refuses aliases, which can expand without end."""

    def compose_node(self, parent: yaml.Node | None, index: int) -> yaml.Node | None:
        """Compose the next node."""
        if self.check_event(yaml.AliasEvent):
            problem = 'aliases are not supported'
            raise yaml.composer.ComposerError(None, None, problem, self.get_mark())
        return super().compose_node(parent, index)


class Dumper(yaml.SafeDumper):
    """Writes what `Loader` reads: texts that look like numbers are quoted."""


for _either in (Loader, Dumper):
    _either.add_implicit_resolver(
        'tag:yaml.org,2002:float',
        re.compile(r'[-+]?([0-9]+\.?[0-9]*|\.[0-9]+)[eE][-+]?[0-9]+$'),
        list('-+.0123456789'),
    )


def read_yaml(path: Path, error_type: type[ValueError], loader: type[Loader] = Loader) -> Any:
    """Read the document of a file.

    Raises:
        error_type: if it cannot be read; the text names the file and the cause.
    """
    try:
        with path.open(encoding='utf-8') as file:
            text = file.read(_MAX_LENGTH + 1)
    except OSError as error:
        raise error_type(f'{path}: {error.strerror}') from error
    except ValueError as error:  # no UTF-8, or a path with a zero byte
        raise error_type(f'{path}: {error}') from error
    if len(text) > _MAX_LENGTH:
        raise error_type(f'{path}: longer than {_MAX_LENGTH} characters')
    try:
        return yaml.load(text, loader)  # noqa: S506, it is safe
    except (yaml.YAMLError, ValueError, RecursionError) as error:
        raise error_type(f'{path}: not YAML: {_cause(error)}') from error


def _cause(error: Exception) -> str:
    """The cause without the lines of the file, which may be any file and a secret."""
    if isinstance(error, yaml.MarkedYAMLError) and error.problem_mark:
        return f'{error.problem} in line {error.problem_mark.line + 1}'
    return ' '.join(str(error).split())
