"""Constants of the contact search, with their reasons. They are ratios, and lengths go by the size of a block.

The size of a block is the largest distance of a corner from its centroid.
"""

# When blocks are searched

LONGEST_INTERVAL = 0.03
"""Longest time between two updates of the search, over the time in which a block falls by half its size: 5 ms for one
of 0.27 m, which is half the diagonal of a block of 0.5 x 0.25 m. So a model is updated as often as what it is a model
of."""
SHORTEST_INTERVAL = 0.1
"""Shortest time between two updates, over the longest one."""
SEARCHED_TOGETHER = 0.5
"""Time for which contacts are still valid, over the longest time between two updates, up to which a block that has
moved is searched with others that are."""
VALID_DISPLACEMENT = 2e-4
"""Largest displacement of a block, over its size, for which its contacts are not searched again. What is within `NEAR`
is found."""
VALID_APPROACH = 0.02
"""Displacement that two blocks may make towards each other between two searches, over the size of the smaller one."""
NEAR = 1e-3
"""Distance at which blocks are near each other, and displacement up to which no block is searched, over their size.
Blocks without a common joint that are so near at rest touch at edges or corners. They are searched later, from
`VALID_APPROACH` on."""
TOWARDS_OTHERS = 0.4
"""Displacement of a block over its distance from the nearest one without a common joint, from which on it is
searched."""
REACH = 2.0
"""Distance within which contacts are kept until the next search of a block, over what its speed alone makes."""

# When a joint is handed over

HANDOVER_OPENING = 0.05
"""Opening of a whole joint, or slip of a part of it, over its width, beyond which it is handed over."""
ROLLED = 0.5
"""Rotation of a joint about its end, over the angle to the nearest side beside it, beyond which it is handed over too.
So a polygon of many sides rolls on to the next one."""
ONE_PLANE = 0.9999
"""Cosine of the angle of two sides of a block from which on they are one plane."""

# Where two blocks meet

EDGES_MEET = 0.8
"""Overlap along the normal of two edges, over that along the best normal of a face, below which the edges meet."""
NOT_PARALLEL = 1e-3
"""Sine of the angle of two edges below which there is no direction square to both."""
FACES_MEET = -0.7
"""Cosine of the angle between the normals of two faces up to which they meet as faces."""
CANDIDATE_FACES = 0.06
"""How much deeper than along the best face two blocks may overlap along a candidate, over the outline of a face: about
a third of the width of a unit in space."""
SHALLOWER = 0.7
"""Overlap at the places of a candidate face, over that of the best face, below which it is taken. Faces of two blocks
that are nearly flush differ by the cosine of their angle, see `FACES_MEET`, and the best one stays."""
LARGER_FACE = 1e-6
"""By how much the other block may be less outside of a face, over how much longer its outline is than that of another
face, for it to be taken. The corners of the smaller one then lie over it."""
SECOND_FACE = 1e-9
"""How much farther, over its outline, a block must be outside of the face of the second block of a pair for this one to
be taken. So rounding does not decide between two that are equal."""
AS_LARGE = 1e-6
"""Relative difference up to which blocks are as large, and difference of heights over the smallest size up to which
they are as high."""
ON_ENDS = 0.01
"""Distance up to which a place outside of a block counts as inside, over the overlap there. The place of two prisms
whose ends lie in one plane is on these ends, and rounding does not decide."""
SHARE_OF_EDGES = 0.25
"""Share of what a pair has that two edges take: that of a corner of a rectangle."""
ON_EDGE = 1e-9
"""Distance of a corner beyond an edge within which it counts as on it, over the longest edge of the face."""
ONE_PLACE = 1e-6
"""Distance of two places that are one, over the longest edge of the face."""
PARALLEL_EDGES, EDGES_ALONG_FACE = 1e-4, 0.3
"""Sine of the angle of two edges, and cosine of the angle between their common normal and that of the face, below which
they do not meet as edges."""

# What a contact has

WHOLE_CONTACT = 0.1
"""Part of the area of a joint over which two faces that had none have all that a pair has."""
LEAST_CONTACT = 0.25
"""Part of what a loose block has over its largest face, or a pair over its joint, that a smaller area has too."""
SIDES_THAT_BEAR = 2.0
"""On how many others a loose block lies at once."""
AS_STIFF = 1e-9
"""Relative difference up to which what two blocks have is the same."""
OF_STABLE_STEP = 0.5
"""Longest step over the longest one with which the contacts of a block alone are stable. Intact joints, and contacts of
blocks that have not moved, act on it besides."""
STABLE = 4.0
"""Highest eigenvalue of the stiffness over the masses that leaves a step stable, times the square of the step."""
SQUARINGS = 4
"""How often a matrix is squared before its trace is taken. The trace of the 16th power of a matrix of six rows bounds
the highest eigenvalue by 1.12 times what it is."""

# What new contacts take over from those before them

SAME_PLACE = 0.2
"""Distance along the face of a place from a line of its pair within which it is the same, over the size of the smaller
block. Along the normal it may be as far as the blocks overlap."""
SAME_NORMAL = 0.7
"""Cosine of the angle between the normals of two places that are the same."""
REGAINED = 1.25
"""Largest factor by which a search raises the force of a place."""
AS_TOWARDS = 1e-9
"""Difference of the cosines of the normals of two faces with a direction up to which they look there alike. So rounding
does not decide between two faces beside a corner."""
AS_NEAR = 1 + 1e-6
"""Square of the distance of a place over that of the nearest one up to which it is as near."""

# How far blocks overlap at the end

OVERLAP_SAMPLES = 200
"""Most samples at which the overlap of blocks is measured."""
DEEPEST_PAIRS = 16
"""Pairs whose overlap is measured: those whose mean depth over their size is largest."""
FLUSH = 1e-14
"""Distance within which faces of two blocks lie in one plane, over their largest coordinate, which rounds [-]."""
OVERLAP_WARNED_OF = 0.01
"""Share of a block from which on its overlap is warned of."""
SOFTENED_WARNED_OF = 0.25
"""Stiffness that dashpots leave a contact, over that which its springs alone would keep in a step, below which there
is a warning [-]."""
