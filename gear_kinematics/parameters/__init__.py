"""The parameters of the node and of `gearkin --config`: types, bounds, defaults and files."""
