"""The one error that the kinematics core raises by itself."""


class MechanismError(ValueError):
    """A mechanism that cannot exist; `faults` lists everything that is wrong with it."""

    def __init__(self, faults: list[str]) -> None:
        """Keep every fault, so that they can be mended in one go."""
        self.faults = tuple(faults)
        super().__init__('; '.join(faults))
