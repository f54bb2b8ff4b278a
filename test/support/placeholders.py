# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Values for every field of a sentence: a text is its name, and each number another."""

import string


class Placeholder:
    """A value of a field, whose attributes are further ones."""

    def __init__(self, name):
        self.name = name

    @property
    def number(self):
        """So that no field can take the place of another: 10.34567 to 98.34567."""
        return 10.34567 + sum(map(ord, self.name)) % 89

    def __getattr__(self, name):
        return Placeholder(f'{self.name}.{name}')

    def __repr__(self):
        return repr(str(self))

    def __str__(self):
        return f'<{self.name}>'

    def __format__(self, spec):
        return format(self.number, spec) if spec else str(self)

    def __mul__(self, factor):
        """As an angle, rad, or a time, s, in another unit."""
        return 1e-3 * self.number * factor

    def __index__(self):
        return 3


def filled(template, own=(), **values):
    """Values for all fields of a template but its own; some of them are given."""
    fields = (field or '' for _, field, *_ in string.Formatter().parse(template))
    names = {field.partition('.')[0] for field in fields} - {'', *own}
    return {name: values.get(name) or Placeholder(name) for name in names}
