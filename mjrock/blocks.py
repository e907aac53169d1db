"""Builders: functions that return the blocks of common structures, for `Masonry(blocks, ...)`.

`Masonry.arch(...)` and its like make the masonry at once: they take the arguments of the builder and the keywords of
`Masonry`. A builder of your own is a function that returns blocks.
"""

from .problem.masonry.builders import in_plane, in_space, vaults
from .problem.masonry.builders.in_plane import *  # noqa: F403
from .problem.masonry.builders.in_space import *  # noqa: F403
from .problem.masonry.builders.vaults import *  # noqa: F403

__all__ = in_plane.__all__ + in_space.__all__ + vaults.__all__
