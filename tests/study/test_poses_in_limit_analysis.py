"""Limit analysis of masonry in a pose: rigid bodies that have turned, by closed forms and by explicit steps."""

import math

import numpy as np
import pytest

import mjrock as mr
from mjrock.problem.masonry.limit.pose import posed

THICK, HIGH = 0.5, 2.0
ALPHA = math.atan2(THICK, HIGH)
TURNS = (1e-3, 0.05, 0.2, ALPHA, 0.3)
BOTH = pytest.mark.parametrize("in_space", [False, True], ids=["plane", "space"])


def wall(in_space=False, size=1.0, **more):
    """A block on the ground that turns about its toe at the origin, and leans to the right."""
    t, h = size * THICK, size * HIGH
    blocks = [
        mr.Polygon([(-3 * h, -h), (3 * h, -h), (3 * h, 0), (-3 * h, 0)], fixed=True, name="ground"),
        mr.Polygon([(-t, 0), (0, 0), (0, h), (-t, h)], name="wall"),
    ]
    if in_space:
        blocks = [mr.Polyhedron.prism(block) for block in blocks]
    return mr.Masonry(blocks, friction=2.0, **more)


def turned(theta, about, centroid, in_space=False, first=(0.0, 0.0)):
    """Pose of a block that has turned about a point of it, which has moved by `first`."""
    sine, cosine = math.sin(theta), math.cos(theta)
    x, z = np.subtract(centroid, about)
    moved = np.array([x * (cosine - 1) + z * sine, z * (cosine - 1) - x * sine]) + first
    if not in_space:
        return [*moved, theta]
    return [moved[0], 0.0, moved[1], math.cos(theta / 2), 0.0, math.sin(theta / 2), 0.0]


def toppled(theta, in_space=False, size=1.0):
    return [turned(theta, (0.0, 0.0), (-0.5 * size * THICK, 0.5 * size * HIGH), in_space)]


@BOTH
@pytest.mark.parametrize("theta", TURNS)
def test_a_block_that_leans_bears_tan_of_what_is_left(theta, in_space):
    found = mr.collapse_multiplier(wall(in_space), 1, pose=toppled(theta, in_space))
    assert found.multiplier == pytest.approx(math.tan(ALPHA - theta), abs=1e-9)
    other = mr.collapse_multiplier(wall(in_space), -1, pose=toppled(theta, in_space))
    assert other.multiplier == pytest.approx(-found.multiplier, abs=1e-9)  # what holds it from falling back


@BOTH
@pytest.mark.parametrize("size", [1e-2, 50.0])
def test_size_and_side_play_no_part(size, in_space):
    masonry = wall(in_space, size)
    found = mr.collapse_multiplier(masonry, 1, pose=toppled(0.1, in_space, size))
    assert found.multiplier == pytest.approx(math.tan(ALPHA - 0.1), rel=1e-6)
    back = toppled(-0.1, in_space, size)
    about = turned(-0.1, (-size * THICK, 0.0), (-0.5 * size * THICK, 0.5 * size * HIGH), in_space)
    mirrored = mr.collapse_multiplier(masonry, -1, pose=[about])
    assert mirrored.multiplier == pytest.approx(found.multiplier, rel=1e-6)
    with pytest.raises(ValueError, match="m inside one another"):
        mr.collapse_multiplier(masonry, -1, pose=back)  # the heel would be in the ground


@BOTH
def test_at_rest_a_pose_changes_nothing(in_space):
    masonry, none = wall(in_space), [[0.0] * 3 + [1.0] + [0.0] * 3] if in_space else [[0.0] * 3]
    at_rest, posed = (mr.collapse_multiplier(masonry, 1, pose=pose) for pose in (None, none))
    assert posed.multiplier == pytest.approx(at_rest.multiplier, rel=1e-12)
    assert posed.forces.normal == pytest.approx(at_rest.forces.normal)


@BOTH
def test_effects_move_with_their_block(in_space):
    """Moments about the toe of a load, a thrust, a mass and a tie where they have gone."""
    theta, masonry = 0.1, wall(in_space)
    weight = masonry.blocks[1].mass * mr.GRAVITY

    def at(x, z):
        return {"at": (x, 0.0, z) if in_space else (x, z), "block": "wall"}

    def gone(x, z):
        return x * math.cos(theta) + z * math.sin(theta), z * math.cos(theta) - x * math.sin(theta)

    anchor = (-3.0, 0.0, 1.0) if in_space else (-3.0, 1.0)
    effects = [
        mr.Load(0.3 * weight, **at(-0.4, 2.0)),
        mr.Thrust(force=0.05 * weight, **at(-0.1, 1.5)),
        mr.AddedMass(0.2 * weight / mr.GRAVITY, **at(-0.3, 1.8)),
        mr.Tie(stiffness=1e7, strength=0.04 * weight, anchor=anchor, **at(-0.5, 1.2)),
    ]
    (x, z), load, thrust, mass, held = (
        gone(*p) for p in ((-0.25, 1), (-0.4, 2), (-0.1, 1.5), (-0.3, 1.8), (-0.5, 1.2))
    )
    way = np.subtract((-3.0, 1.0), held) / math.dist((-3.0, 1.0), held)
    pull = 0.04 * (held[1] * way[0] - held[0] * way[1])  # turns it to the right
    back = -x - 0.3 * load[0] - 0.2 * mass[0] - 0.05 * thrust[1] - pull
    found = mr.collapse_multiplier(masonry, 1, pose=toppled(theta, in_space), effects=effects)
    assert found.multiplier == pytest.approx(back / (z + 0.2 * mass[1]), rel=1e-9)


def test_a_block_that_has_slid_stands_on_the_corner_where_the_other_ends():
    """On a plinth that ends under it, it turns about the corner of the plinth."""
    plinth = mr.Polygon([(-2, -1), (0, -1), (0, 0), (-2, 0)], fixed=True, name="plinth")
    block = mr.Polygon([(-THICK, 0), (0, 0), (0, HIGH), (-THICK, HIGH)], name="wall")
    masonry = mr.Masonry([plinth, block], friction=2.0)
    slid, theta = 0.1, 0.05
    level = mr.collapse_multiplier(masonry, 1, pose=[[slid, 0.0, 0.0]])
    assert level.multiplier == pytest.approx((THICK - 2 * slid) / HIGH, rel=1e-9)
    corner = (-slid, 0.0)  # what lies on the corner of the plinth
    pose = turned(theta, corner, (-0.5 * THICK, 0.5 * HIGH), first=(slid, 0.0))
    about = np.array([0.5 * THICK - slid, 0.5 * HIGH])
    lean = math.atan2(*about) - theta
    assert mr.collapse_multiplier(masonry, 1, pose=[pose]).multiplier == pytest.approx(math.tan(lean), rel=1e-9)


def test_points_that_have_slid_off_in_space_are_refused():
    plinth = mr.Polyhedron.box((1, 1, 1), (0, 0, -0.5), fixed=True, name="plinth")
    masonry = mr.Masonry([plinth, mr.Polyhedron.box((1, 1, 2), (0, 0, 1), name="block")])
    with pytest.raises(ValueError, match=r"plinth\|block has slid 0.1 m off its face"):
        mr.collapse_multiplier(masonry, 1, pose=[[0.1, 0, 0, 1, 0, 0, 0]])


def strip_pose(bending, theta):
    """Poses of both bodies of a wall that bends between floors, and of the floor above, at a rotation of the lower."""
    t, z, h = 2 * bending.wall.b, bending.crack_height, 2 * bending.wall.h
    inner = np.array([t * (1 - math.cos(theta)) + z * math.sin(theta), t * math.sin(theta) + z * math.cos(theta)])
    arm = np.array([bending.lever, h - z])  # from the inner edge of the crack to where the floor bears
    psi = math.atan2(*arm) - math.asin((bending.lever - inner[0]) / math.hypot(*arm))  # to the left
    rise = inner[1] + arm[0] * math.sin(psi) + arm[1] * math.cos(psi) - h
    return [
        turned(theta, (t, 0.0), (0.5 * t, 0.5 * z)),
        turned(-psi, (0.0, z), (0.5 * t, 0.5 * (z + h)), first=inner - [0.0, z]),
        [0.0, rise, 0.0],
    ]


@pytest.mark.parametrize("load", [5e3, 40e3])
def test_a_wall_that_bends_between_floors_follows_virtual_work(load):
    bending = mr.VerticalBending(mr.Block.from_size(0.35, 3.2, 1.0, 1800.0), load)
    masonry, curve = mr.Masonry.between_floors(bending.wall, load), bending.curve
    for k in np.linspace(1, len(curve.rotation) - 2, 7).astype(int):
        found = mr.collapse_multiplier(masonry, 1, pose=strip_pose(bending, float(curve.rotation[k])))
        assert found.multiplier == pytest.approx(curve.multiplier[k], abs=1e-6)


@pytest.mark.slow
def test_an_arch_on_supports_that_spread_bears_what_explicit_steps_find():
    """A driver holds the centroid as the right abutment moves away, and then moves it. A pose of the run has the
    multiplier of the force of the driver, of joints of 1e11 N/m3."""
    arch = mr.Masonry.arch(2.0, 0.4, voussoirs=9, k_n=1e11, friction=2.0, xi=0.1)
    weight = mr.GRAVITY * sum(arch.blocks[i].mass for i in arch.free)
    k = 1e4 * weight / 2.4
    path = [0, 6, 16], [0, 0, 0.05]
    jack = mr.Actuator(None, None, 1, path, stiffness=k, damping=math.sqrt(k * weight / mr.GRAVITY))
    spread = {"right_abutment": ([0, 5, 16], [0, 0.06, 0.06], [0, 0, 0])}
    run = mr.solve_explicit(mr.MasonryCase(arch, 16.0, supports=spread, effects=jack), output_step=0.02)
    force = run.actuators["actuator_0"] / weight
    for t in (5.8, 9.0, 10.0, 15.0):
        k = int(np.searchsorted(run.t, t))
        found = mr.collapse_multiplier(arch, 1, pose=run.at(t)).multiplier
        assert found == pytest.approx(force[k - 5 : k + 6].mean(), rel=0.01)


def test_the_pose_of_a_response_has_supports_and_centroids_without_masses():
    masonry = wall()
    top = mr.AddedMass(500.0, 1.5, -0.1, block="wall")
    run = mr.solve_explicit(
        mr.MasonryCase(masonry, 0.2, supports={"ground": ([0, 0.2], [0, 0.01], [0, 0])}, effects=top), output_step=0.05
    )
    pose = run.at(0.1)
    assert pose.shape == (2, 3)
    assert pose[0].tolist() == pytest.approx([0.005, 0.0, 0.0])
    assert pose[1, 2] == run.pose[2, 0, 2]
    assert pose[1, 2] != 0
    laden, alone = run.case.centroids[1], masonry.centroids[1]
    assert pose[1].tolist() == pytest.approx(turned(pose[1, 2], laden, alone, first=run.pose[2, 0, :2]), abs=1e-15)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"pose": [[0.0, 0.0]]}, "pose"),
        ({"pose": [[0.0, 0.0, 5.73]]}, r"rotation of 5\.73 rad; .* radians"),
        ({"pose": [[0.0, 1.0, 0.0]]}, "no multiplier of the forces that grow holds the masonry"),
        ({"pose": [[0.0, 0.0, 0.0]], "associated": False}, "a pose takes associated friction"),
    ],
)
def test_what_a_pose_does_not_allow_is_refused(given, message):
    with pytest.raises(ValueError, match=message):
        mr.collapse_multiplier(wall(), 1, **given)


def test_quaternions_are_of_unit_length():
    with pytest.raises(ValueError, match=r"quaternion of the length 0\.9"):
        mr.collapse_multiplier(wall(True), 1, pose=[[0, 0, 0, 0.9, 0, 0, 0]])


def test_a_column_that_leans_as_one_is_a_block():
    """The lines of the page: the toe of the lowest of three drums bears, and no joint between them opens."""
    column = mr.Masonry.stack([mr.Block.from_size(thickness=0.6, height=1.0)] * 3, friction=2.0)
    lean = [turned(0.05, (0.3, 0.0), centroid) for centroid in column.centroids[1:]]
    found = mr.collapse_multiplier(column, 1, pose=lean)
    assert found.multiplier == pytest.approx(math.tan(math.atan2(0.6, 3.0) - 0.05), rel=1e-9)
    assert found.moving == ("block_0", "block_1", "block_2")


def test_a_tie_that_the_pose_has_made_shorter_or_has_torn_bears_nothing():
    column, tie = mr.Masonry.stack([mr.Block.from_size(0.6, 2.0)]), {"height": 1.9, "stiffness": 1e6, "strength": 1e3}
    torn = mr.Tie(**tie, ultimate=0.05, block="block_0")
    for theta, effect in ((-0.1, mr.Tie(**tie, block="block_0")), (0.1, torn)):
        half = 0.5 * math.copysign(0.6, theta)
        x, z = -half * (math.cos(theta) - 1) + math.sin(theta), half * math.sin(theta) + math.cos(theta) - 1
        pose = [[x, z, theta]]
        bare = mr.collapse_multiplier(column, 1, pose=pose).multiplier
        assert mr.collapse_multiplier(column, 1, pose=pose, effects=effect).multiplier == pytest.approx(bare, rel=1e-9)
    held = mr.collapse_multiplier(column, 1, pose=pose, effects=mr.Tie(**tie, block="block_0")).multiplier
    assert held > bare + 0.05


def test_a_block_in_space_keeps_its_faces_which_turn_with_it():
    """They are those of the hull of its corners where these have moved."""
    moved, _ = posed(wall(in_space=True), toppled(0.1, in_space=True))
    leaning = moved.blocks[1]
    assert leaning.corners[:, 0].max() > 0.1
    for block in moved.blocks:
        anew = mr.Polyhedron(block.vertices, name=block.name, fixed=block.fixed)
        assert block == anew
        faces, others = ({frozenset(face): i for i, face in enumerate(one.faces)} for one in (block, anew))
        assert len(faces) == 6
        for face, number in others.items():
            assert block.normals[faces[face]] == pytest.approx(anew.normals[number], abs=1e-12)
        assert block.inertia == pytest.approx(anew.inertia, rel=1e-12, abs=1e-9 * anew.inertia.max())
