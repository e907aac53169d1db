"""Class methods of `Masonry`: one for each builder of blocks, and one for each kind of file.

What editors and type checkers know of them stands in `constructors.pyi`, which `python tests/house/stubs.py` writes.
"""

from .builders import in_plane, in_space, vaults
from .constructor import of_builder, of_reader
from .files import compas, lmgc90, meshes
from .files.bodies import meshes_of

BUILDERS = {name: getattr(room, name) for room in (in_plane, in_space, vaults) for name in room.__all__}
"""Functions that return blocks, by name."""
READERS = {
    "from_obj": meshes.read_obj,
    "from_stl": meshes.read_stl,
    "from_ply": meshes.read_ply,
    "from_compas": compas.read_compas,
    "from_lmgc90": lmgc90.read_lmgc90,
    "from_meshes": meshes_of,
}
"""Functions that return meshes, by the class method that makes masonry of them."""


class Constructors:
    """Class methods of `Masonry` that build it. Each has the arguments of its builder or reader, and the keywords of
    `Masonry`."""


for _name, _builder in BUILDERS.items():
    if _name != "stack":  # which has numbers of its own for the joints with a side stop
        setattr(Constructors, _name, of_builder(_name, _builder))
for _name, _reader in READERS.items():
    setattr(Constructors, _name, of_reader(_name, _reader))
