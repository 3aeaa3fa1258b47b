"""What the user has to see to."""


class InputError(Exception):
    """Bad input. Text: `where: what: got X, expected Y; next step`."""


class UsageError(InputError):
    """Arguments that make no sense."""


class NotComputed(Exception):
    """A metric the frames do not allow; the text is the reason."""
