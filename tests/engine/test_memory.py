"""The engine's memory is proved before anything is written to it."""

import ctypes
import sys

import mujoco
import numpy as np
import pytest
from mujoco.introspect.ast_nodes import ArrayType, StructDecl, StructFieldDecl, ValueType
from mujoco.introspect.structs import STRUCTS

import mjrock as mr
from mjrock.engine import memory
from mjrock.engine.memory import IMPRATIO, TIMESTEP, EngineArrays


@pytest.fixture
def model(one_sided, contacts):
    return mujoco.MjModel.from_xml_string(mr.wall_mjcf(one_sided, contacts, 1e-3))


def test_the_options_are_where_they_should_be(model):
    data = mujoco.MjData(model)
    found = EngineArrays.from_model(model, data)
    assert (found.options[TIMESTEP], found.options[IMPRATIO]) == (model.opt.timestep, model.opt.impratio)
    assert model.opt.timestep == 1e-3
    found.options[TIMESTEP] = 5e-4
    assert model.opt.timestep == 5e-4
    found.options[IMPRATIO] = 7.0
    assert model.opt.impratio == 7.0
    np.testing.assert_array_equal(model.opt.gravity, [0, 0, -mr.GRAVITY])


def test_options_elsewhere_are_refused_and_nothing_is_written(model, monkeypatch):
    options = (ctypes.c_char * 512).from_address(model.opt.gravity.ctypes.data - 56)
    before = bytes(options)
    right = memory.option_offsets()
    for name, wrong in (("gravity", 48), ("gravity", 64), ("gravity", 512), ("impratio", 16), ("timestep", 8)):
        monkeypatch.setattr(memory, "option_offsets", lambda there=right | {name: wrong}: there)
        with pytest.raises(RuntimeError, match=r"does not keep opt\.timestep and opt\.impratio where"):
            EngineArrays.from_model(model, mujoco.MjData(model))
    assert bytes(options) == before


def test_places_are_those_of_the_description(monkeypatch):
    """Of the one that MuJoCo 4.0 has, and of another with an integer and arrays before, and impratio not beside."""
    assert memory.option_offsets() == {"timestep": 0, "impratio": 8, "gravity": 56}
    number, whole = ValueType("mjtNum"), ValueType("int")
    types = {"flag": whole, "impratio": number, "table": ArrayType(number, (2, 3)), "flags": ArrayType(whole, (3,))}
    types |= {"timestep": number, "gravity": ArrayType(number, (3,))}
    assert described(monkeypatch, types) == {"impratio": 8, "timestep": 80, "gravity": 88}
    for kinds, complaint in (
        ({"odd": ValueType("short")} | types, "KeyError: 'short'"),
        ({"timestep": number, "gravity": number}, "AttributeError: .*'impratio'"),
        ({"timestep": number, "gravity": number, "impratio": number}, "KeyError: 'gravity comes first'"),
    ):
        with pytest.raises(RuntimeError, match=rf"describes mjOption in a way that mjrock does not know \({complaint}"):
            described(monkeypatch, kinds)


def described(monkeypatch, types):
    """The places for a description with fields of these names and types."""
    fields = [StructFieldDecl(name, kind, "") for name, kind in types.items()]
    monkeypatch.setitem(STRUCTS, "mjOption", StructDecl("mjOption", "struct mjOption_", fields))
    return memory.option_offsets.__wrapped__()


def test_a_missing_description_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "mujoco.introspect.structs", None)
    with pytest.raises(RuntimeError, match=r"lacks its module mujoco\.introspect\.structs.*reinstall mujoco"):
        memory.option_offsets.__wrapped__()


def test_a_step_by_address_is_a_step(model):
    one, other = mujoco.MjData(model), mujoco.MjData(model)
    for data in (one, other):
        mujoco.mj_resetDataKeyframe(model, data, 0)
    found = EngineArrays.from_model(model, one)
    for _ in range(50):
        found.step(found.model, found.data)
        mujoco.mj_step(model, other)
    np.testing.assert_array_equal(one.qpos, other.qpos)
    np.testing.assert_array_equal(found.velocity, other.qvel)


@pytest.mark.parametrize(
    ("platform", "files", "found"),
    [
        ("linux", ["libmujoco.so.4.0.0"], "libmujoco.so.4.0.0"),
        ("darwin", ["libmujoco.4.0.0.dylib", "other.dylib"], "libmujoco.4.0.0.dylib"),
        ("win32", ["mujoco.dll"], "mujoco.dll"),
    ],
)
def test_the_library_is_found_on_every_system(tmp_path, monkeypatch, platform, files, found):
    for name in files:
        (tmp_path / name).touch()
    monkeypatch.setattr(memory.sys, "platform", platform)
    assert memory.library_file(tmp_path) == tmp_path / found


def test_a_missing_library_is_named(tmp_path):
    with pytest.raises(RuntimeError, match=r"0 files match .* in .*; reinstall mujoco"):
        memory.library_file(tmp_path)
