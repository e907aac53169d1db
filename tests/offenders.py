"""Lists of what breaks a rule, so that one test tries all values and names those that fail."""

import re
from collections.abc import Callable, Iterable

REFUSED = TypeError, ValueError, FileNotFoundError
"""Errors by which a call is refused."""


def not_refused(
    calls: Iterable[tuple[str, Callable[[], object], str]], errors: tuple[type[Exception], ...] = REFUSED
) -> list[str]:
    """Calls that do not end with one of some errors that says what it should.

    A call has a name, and a regular expression that is searched for in what the error says.
    """
    found = []
    for name, call, complaint in calls:
        try:
            call()
        except errors as error:
            if not re.search(complaint, str(error)):
                found.append(f"{name} says {error}")
        except Exception as error:
            found.append(f"{name} raises {type(error).__name__}: {error}")
        else:
            found.append(f"{name} is not refused")
    return found
