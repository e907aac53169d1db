"""The static load of a contact, keyframes of several robots, and specifications that do not compile."""

import math
import re
import subprocess
import sys
import warnings
from pathlib import Path

import mujoco
import pytest
from pairs import FLOOR, scene, since

import mjrock as mr

BOX = '<body pos="0 0 {z}" {more}><freejoint/><geom name="{name}" type="box" size=".1 .1 .1" mass="{mass}"/></body>'
HEAVY = BOX.format(z=0.1, more="", name="box", mass=10)
PLATE = '<body mocap="true" pos="0 0 -.05"><geom name="floor" type="box" size=".5 .5 .05" mass="{}"/></body>'
NO_GRAVITY = '><flag gravity="disable"/></option><option'
STACK = BOX.format(z=0.1, more="", name="low", mass=0.1) + BOX.format(z=0.3, more="", name="box", mass=10)
LOADS = {
    "on a floor": (scene(FLOOR, HEAVY, gravity=9.81), "box", 10.0),
    "on a mocap body of .1 kg": (scene(PLATE.format(0.1), HEAVY, gravity=9.81), "box", 10.0),
    "on a mocap body without mass": (scene(PLATE.format(0), HEAVY, gravity=9.81), "box", 10.0),
    "carried by gravcomp": (scene(FLOOR, HEAVY.replace("><free", ' gravcomp="1"><free'), gravity=9.81), "box", 0.0),
    "without gravity": (scene(FLOOR, HEAVY, gravity=9.81, options=NO_GRAVITY), "box", 0.0),
    "under a heavy box": (scene(FLOOR, STACK, gravity=9.81), "low", 10.1),
    "above the floor": (scene(FLOOR, HEAVY.replace("0 0 0.1", "0 0 .5"), gravity=9.81), "box", 10.0),
}
ROBOT = """<mujoco model="bot"><worldbody><body name="base" pos="0 0 .5"><freejoint/><geom type="box" size=".1 .1 .05"
mass="4"/><body pos="0 0 -.05"><joint axis="0 1 0"/><geom type="capsule" size=".02" fromto="0 0 0 0 0 -.2" mass=".5"
contype="0" conaffinity="0"/><body pos="0 0 -.2"><joint axis="0 1 0"/><geom name="foot" size=".03" pos="0 0 -.2"
mass=".3"/></body></body></body></worldbody><keyframe><key name="home" qpos="0 0 .5 1 0 0 0 .6 -1.2"/></keyframe>
</mujoco>"""
NESTED = """<mujoco model="mid"><asset><model name="bot" file="bot.xml"/></asset><worldbody><frame>
<attach model="bot" body="base" prefix="b_"/></frame></worldbody></mujoco>"""
TWO_NESTED = """import sys, mujoco, mjrock
spec = mujoco.MjSpec.from_string('<mujoco><worldbody><geom name="floor" size="1"/></worldbody></mujoco>')
for i in range(2):
    robot = mujoco.MjSpec.from_file(sys.argv[1])
    spec.attach(robot, prefix=f"r{i}/", frame=spec.worldbody.add_frame(pos=[i, 0, 0]))
try:
    mjrock.contact_for(spec, "r0/b_foot", "floor", k=1e4, xi=0.5)
except ValueError as error:
    print(error)
"""


@pytest.mark.parametrize("name", LOADS)
def test_the_load_is_that_of_the_pose_at_rest(name):
    text, lower, mass = LOADS[name]
    contact = mr.contact_for(mujoco.MjSpec.from_string(text), lower, "floor", k=2.5e4, xi=1.0, timestep=1e-4)
    assert contact.load == pytest.approx(mass * 9.81 / 4, rel=1e-6, abs=1e-6)
    found = next(each for each in mr.inspect_contacts(mujoco.MjSpec.from_string(text)) if lower in each.geom2)
    assert found.load == pytest.approx(contact.load)


def robots():
    spec = mujoco.MjSpec.from_string(scene(FLOOR, timestep=1e-4))
    for i in range(2):
        spec.attach(mujoco.MjSpec.from_string(ROBOT), prefix=f"r{i}/", frame=spec.worldbody.add_frame(pos=[i, 0, 0]))
    return spec


def test_a_keyframe_of_one_robot_leaves_the_other_and_several_serve_both():
    requested = {("r?/foot", "floor"): {"k": 1e4, "restitution": 0.5}}
    with pytest.warns(mr.ContactWarning, match=r"r1/foot on floor: .* 0\.468 kg at keyframe 'r1/home' and 4\.8 kg"):
        mr.contacts_for(robots(), requested, keyframe="r0/home")
    both = mr.contacts_for(robots(), requested, keyframe=("r0/home", "r1/home"))
    assert [contact.mass for contact in both] == pytest.approx([0.4677] * 2, rel=1e-3)


def test_a_motion_that_cannot_be_is_no_advice():
    """A pendulum that hangs upright approaches the floor by rounding only, and stops no mass of 1e20 kg."""
    text = """<mujoco><option timestep="1e-4"/><worldbody><geom name="floor" type="plane" size="1 1 1"/>
    <body pos="0 0 1"><joint axis="0 1 0"/><geom name="bob" size=".1" mass="1" pos=".5 0 0"/></body></worldbody>
    <keyframe><key name="open" qpos="1.5707963"/></keyframe></mujoco>"""
    (found,) = mr.inspect_contacts(mujoco.MjSpec.from_string(text))
    assert not any("keyframe='open'" in note for note in found.notes)


@pytest.mark.slow
def test_keyframes_of_nested_robots_are_an_error_and_no_signal(tmp_path):
    """MuJoCo 4.0 ends the process where a copy of such a specification does not compile."""
    (tmp_path / "bot.xml").write_text(ROBOT)
    (tmp_path / "mid.xml").write_text(NESTED)
    command = [sys.executable, "-c", TWO_NESTED, str(tmp_path / "mid.xml")]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0
    assert "model does not compile: Error: repeated name 'b_home' in key" in done.stdout


@pytest.mark.slow
def test_the_fault_that_the_page_reports_is_there():
    """Once this fails, MuJoCo has mended it: take it from the page."""
    page = (Path(__file__).parents[2] / "docs" / "contacts_in_your_model.md").read_text(encoding="utf-8")
    code = re.findall(r"```py\n(.*?)```", page, re.DOTALL)[-1]
    for last, status in (("", True), ("spec.compile()", False)):
        text = code if not last else code.replace("spec.copy().compile()", last)
        done = subprocess.run([sys.executable, "-c", text], capture_output=True, text=True, check=False)
        assert (done.returncode < 0) == status
    assert "ValueError: Error: repeated name 'b_home' in key" in done.stderr


GROUNDS = {
    "plane": FLOOR,
    "field": '<geom name="floor" type="hfield" hfield="hf"/>',
    "tiles": "".join(f'<geom name="floor{i}" type="box" size=".5 .5 .05" pos="{i} 0 -.05"/>' for i in range(4)),
}
FOOT = """<body pos="{x} 0 1"><joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 0 1"/><geom size=".1"
mass="9" contype="0" conaffinity="0"/><body pos="0 0 -.3"><joint type="slide" axis="1 0 0"/>
<geom name="{name}" type="{kind}" size=".05 .05 .05" mass="1" pos="0 0 -.3"/></body></body>"""


@pytest.mark.parametrize(("kind", "points"), [("sphere", 1), ("box", 4)])
@pytest.mark.parametrize("ground", GROUNDS)
@pytest.mark.parametrize("x", [0.0, 2.2])
def test_a_foot_lands_on_whatever_lies_below(ground, kind, points, x):
    """It stops 10 kg on each tile that it does not stand above, and where it stands on a field."""
    field = '<asset><hfield name="hf" nrow="41" ncol="41" size="4 4 .1 .1"/></asset><worldbody>'
    text = scene(GROUNDS[ground], FOOT.format(x=x, name="foot", kind=kind)).replace("<worldbody>", field)
    spec = mujoco.MjSpec.from_string(text)
    requested = {"k": 1e5, "restitution": 0.5, "friction": 0, "normal": (0, 0, 1)}
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", ".*one of the geoms is uneven")
        contacts = mr.contacts_for(spec, {("foot", "floor*"): requested})
    assert [contact.mass * contact.contacts for contact in contacts] == pytest.approx([10.0] * len(contacts))
    if ground != "field":
        assert {contact.contacts for contact in contacts} == {points}


@since(3, 4)
def test_a_foot_across_a_seam_of_tiles_is_twice_as_stiff():
    """It has the points of both tiles, as docs/contacts_in_your_model.md says."""
    depths = []
    for x in (0.0, 0.5):
        foot = FOOT.format(x=x, name="foot", kind="box")
        spec = mujoco.MjSpec.from_string(scene(GROUNDS["tiles"], foot, timestep=1e-4, gravity=9.81))
        requested = {"k": 1e5, "xi": 1.0, "friction": 0, "normal": (0, 0, 1)}
        mr.contacts_for(spec, {("foot", "floor*"): requested}).apply(spec)
        model = spec.compile()
        data = mujoco.MjData(model)
        data.qpos[1] = -0.3499  # just above the tiles
        mujoco.mj_step(model, data, 4000)
        depths.append(0.05 - data.geom("foot").xpos[2])
    assert depths == pytest.approx([9.81 * 10 / 4e5, 9.81 * 10 / 8e5], rel=1e-3)


def test_where_the_pose_does_not_show_the_landing_it_says_so():
    spec = mujoco.MjSpec.from_string(scene(GROUNDS["tiles"], FOOT.format(x=0.2, name="foot", kind="sphere")))
    requested = {"k": 1e5, "restitution": 0.5, "friction": 0}
    mr.contact_for(spec, "foot", "floor0", **requested)
    with pytest.warns(mr.ContactWarning, match=r"their shortest line meets a face of neither: how .* is not known"):
        mr.contact_for(spec, "foot", "floor2", **requested)
    for normal, error in (((0, 0, 0), "no direction"), ((0, 1), "normal has the shape")):
        with pytest.raises(ValueError, match=error):
            mr.contact_for(spec, "foot", "floor2", normal=normal, **requested)


CUBE = "-.1 -.1 -.1 .1 -.1 -.1 -.1 .1 -.1 .1 .1 -.1 -.1 -.1 .1 .1 -.1 .1 -.1 .1 .1 .1 .1 .1"
FACES = {"box": 'type="box" size=".1 .1 .1"', "mesh": 'type="mesh" mesh="cube"'}


def faces(low, high, joint="<freejoint/>", size=0.1):
    upper = FACES[high].replace(".1 .1 .1", f"{size} {size} .1")
    return mujoco.MjSpec.from_string(f"""<mujoco><option timestep="5e-4"/><asset><mesh name="cube" vertex="{CUBE}"/>
    </asset><worldbody><geom name="low" {FACES[low]} pos="0 0 -.1"/><body pos="0 0 .1">{joint}
    <geom name="high" {upper} mass="10"/></body></worldbody></mujoco>""")


@since(4, 0)
def test_a_turn_that_gives_faces_more_points_is_told_with_both_stiffnesses():
    """The static depth m g / (k points) of the turned box says that the second number is right."""
    spec = faces("box", "box")
    message = (
        r"a turn of 0.01 degrees about the normal gives the two faces 8 points for 4: .* has 2e\+05 N/m for 1e\+05 N/m"
    )
    with pytest.warns(mr.ContactWarning, match=message):
        contact = mr.contact_for(spec, "high", "low", k=2.5e4, xi=1.0, friction=0.6)
    contact.apply(spec)
    (found,) = mr.inspect_contacts(model := spec.compile())
    assert any(re.search(message, note) for note in found.notes)
    assert [depth(model, degrees) for degrees in (0, 0.01)] == pytest.approx([9.81e-4, 4.905e-4], rel=1e-3)


def depth(model, degrees):
    """How deep the upper face lies after 1 s, turned [m]."""
    data = mujoco.MjData(model)
    mujoco.mju_axisAngle2Quat(data.qpos[3:], [0, 0, 1], math.radians(degrees))
    mujoco.mj_step(model, data, 2000)
    return 0.1 - data.qpos[2]


@since(3, 8)
@pytest.mark.parametrize(
    "spec",
    [
        faces("mesh", "box"),
        faces("mesh", "mesh"),
        faces("box", "box", size=0.09),
        faces("box", "box", '<joint type="slide" axis="0 0 1"/>'),
    ],
)
def test_faces_that_keep_their_points_are_not_told_of(spec):
    """MuJoCo gives the faces of a mesh four points at most."""
    mr.contact_for(spec, "high", "low", k=2.5e4, xi=1.0, friction=0.6)


@since(4, 0)
def test_meshes_are_a_tenth_softer_when_they_are_turned():
    """Four of the eight corners of the common face are kept, and they are not those of a square."""
    mr.contact_for(spec := faces("mesh", "mesh"), "high", "low", k=2.5e4, xi=1.0, friction=0.6).apply(spec)
    model = spec.compile()
    assert [depth(model, degrees) for degrees in (0, 0.01)] == pytest.approx([9.81e-4, 1.08e-3], rel=5e-3)


TORUS = """<mujoco><option timestep="1e-4" gravity="0 0 0"/><extension><plugin plugin="mujoco.sdf.torus">
<instance name="torus"><config key="radius1" value=".35"/><config key="radius2" value=".15"/></instance></plugin>
</extension><asset><mesh name="torus"><plugin instance="torus"/></mesh></asset><worldbody><geom name="floor" {floor}/>
<body pos="0 0 .3"><freejoint/><geom name="ring" type="sdf" mesh="torus" mass="3"><plugin instance="torus"/></geom>
</body></worldbody></mujoco>"""


@pytest.mark.slow
def test_a_ring_of_signed_distances_is_right_on_a_plane_and_uneven_on_a_box():
    """MuJoCo's own torus: four points on a plane that share the mass, and some that come and go on a box."""
    mujoco.mj_loadPluginLibrary(next(map(str, Path(mujoco.__file__).parent.joinpath("plugin").glob("*sdf_plugin.*"))))
    for floor, e in (('type="plane" size="1 1 1"', 0.505), ('type="box" size="1 1 .1" pos="0 0 -.1"', 0.215)):
        spec = mujoco.MjSpec.from_string(TORUS.format(floor=floor))
        with pytest.warns(mr.ContactWarning, match="uneven, and the number of contact points changes"):
            mr.contact_for(spec, "ring", "floor", k=1e5, restitution=0.5, normal=(0, 0, 1), friction=0).apply(spec)
        data = mujoco.MjData(model := spec.compile())
        data.qvel[2] = -1
        while data.qvel[2] < 0 or data.efc_force.max(initial=0) > 0:
            mujoco.mj_step(model, data)
        assert data.qvel[2] == pytest.approx(e, abs=0.02)


@since(4, 0)
@pytest.mark.parametrize("high", ["box", "mesh"])
@pytest.mark.parametrize(("degrees", "of_the_face_above"), [(1, True), (5, True), (5.5, False), (8, False)])
def test_the_normal_of_a_mesh_is_that_of_the_second_face_within_five_degrees(high, degrees, of_the_face_above):
    """As the page says, of a block on the edge of its base."""
    model = faces("box", high).compile()
    data, angle = mujoco.MjData(model), math.radians(degrees)
    mujoco.mju_axisAngle2Quat(data.qpos[3:], [0, 1, 0], angle)
    data.qpos[2] = 0.1 * (math.cos(angle) + math.sin(angle)) - 1e-4
    data.qpos[0] = -0.05
    mujoco.mj_forward(model, data)
    slope = math.degrees(math.atan2(abs(data.contact[0].frame[0]), abs(data.contact[0].frame[2])))
    assert slope == pytest.approx(degrees if high == "mesh" and of_the_face_above else 0, abs=0.01)
