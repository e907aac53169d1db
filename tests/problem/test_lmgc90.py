"""The input of LMGC90, written here by hand: bodies in axes of their own, densities, and bodies that are held."""

import numpy as np
import pytest
from everyday import slow

import mjrock as mr

FACES = [(1, 5, 7), (1, 7, 3), (2, 4, 8), (2, 8, 6), (1, 2, 6), (1, 6, 5), (3, 7, 8), (3, 8, 4), (1, 3, 4), (1, 4, 2),
         (5, 6, 8), (5, 8, 7)]  # fmt: skip
"""Triangles of a box whose vertices are in the order of `ndindex`, counted from 1."""
ZEROS = ("0.0000000D+00",) * 6
SIZES = [((3.0, 2.0, 0.4), (0.0, 0.0, -0.2)), ((0.5, 0.4, 0.6), (0.1, 0.0, 0.3)), ((0.4, 0.3, 0.2), (0.05, 0.02, 0.7))]
"""Of a ground and two blocks on it, and their middles [m]."""


def row(name, values):
    return " ".join(f"{name.format(i + 1)}={value:14.7E}" for i, value in enumerate(values)) + "\n"


def datbox(folder, held=(1,), waves=0.0, turns=None):
    """A folder of boxes, each in axes of its own that a rotation turns, with the names of files and keywords."""
    rng = np.random.default_rng(7)
    texts = {"BODIES.DAT": "! made up\n", "DOF.INI": "\n", "DRV_DOF.DAT": "\n"}
    for number, (size, middle) in enumerate(SIZES, 1):
        turn = np.linalg.qr(rng.normal(size=(3, 3)))[0] if turns is None else turns
        turn = turn * np.sign(np.linalg.det(turn))
        own = (np.array(list(np.ndindex(2, 2, 2))) - 0.5) * size @ turn  # so that own axes, turned back, are level
        head = f"$bdyty\n RBDY3  {number:5d}\n"
        texts["BODIES.DAT"] += (
            f"{head}$blmty\n PLAIN      1  behav  {'STONE' if number > 1 else 'SLAB'}  avrd= 1.0E-01\n"
        )
        texts["BODIES.DAT"] += "$nodty\n NO6xx      1   " + row("coo{}", (*middle, 0, 0, 0))
        texts["BODIES.DAT"] += "$tacty\n POLYR      1  color  REDxx  nb_vertex=      8    nb_faces=     12\n"
        texts["BODIES.DAT"] += "".join(row("coo{}", place) for place in own)
        texts["BODIES.DAT"] += (
            "".join(f"  ver1= {a:6d}  ver2= {b:6d}  ver3= {c:6d}\n" for a, b, c in FACES) + "$$$$$$\n"
        )
        texts["DOF.INI"] += f"{head}$nodty\n NO6xx  1 " + row("X({})", 6 * [0]) + row("V({})", 6 * [0])
        texts["DOF.INI"] += (
            "".join(row(f"{name}({{}})", axis) for name, axis in zip("abg", turn.T, strict=True)) + "$$$$$$\n"
        )
        if number in held:
            rows = [f" vlocy {way:6d}  {' '.join((ZEROS[0], f'{waves:.7E}', *ZEROS[2:]))}\n" for way in range(1, 7)]
            texts["DRV_DOF.DAT"] += f"{head}$nodty\n NO6xx      1\n$dofty        [CT...]\n{''.join(rows)}$$$$$$\n"
    texts["BULK_BEHAV.DAT"] = "$behav  lawty\n STONE  RIGID          Umas= 2.4000000D+03\n"
    for name, text in texts.items():
        (folder / name).write_text(text)
    return folder


@pytest.mark.parametrize("name", [".", "BODIES.DAT"])
def test_bodies_in_axes_of_their_own(tmp_path, name):
    """Places, densities and supports are those that were drawn; a material without a density has that of the call."""
    masonry = mr.Masonry.from_lmgc90(datbox(tmp_path) / name, density=1900.0, tolerance=1e-5)
    assert masonry.names == ("body_1", "body_2", "body_3")
    for block, (size, middle) in zip(masonry.blocks, SIZES, strict=True):
        corners = np.array(middle) + (np.array(list(np.ndindex(2, 2, 2))) - 0.5) * size
        found = sorted(np.round(block.corners, 5).tolist())
        np.testing.assert_allclose(found, sorted(corners.tolist()), atol=2e-6)
        assert block.volume == pytest.approx(np.prod(size), rel=1e-6)
    assert [block.density for block in masonry.blocks] == [1900.0, 2400.0, 2400.0]
    assert [block.fixed for block in masonry.blocks] == [True, False, False]
    assert [joint.name for joint in masonry.joints] == ["body_1|body_2", "body_2|body_3"]


def test_what_is_driven_is_fixed_and_named(tmp_path):
    with pytest.warns(UserWarning, match=r"BODIES\.DAT: body_1 are driven, and read as fixed; supports= of"):
        masonry = mr.Masonry.from_lmgc90(datbox(tmp_path, waves=0.1))
    assert [block.fixed for block in masonry.blocks] == [True, False, False]


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("DOF.INI", "no DOF.INI lies beside it, which states how each body is turned; all are taken as not turned"),
        ("DRV_DOF.DAT", "no DRV_DOF.DAT lies beside it, which states which bodies are held; fixed= takes its place"),
        ("BULK_BEHAV.DAT", "no BULK_BEHAV.DAT lies beside it, which states the density of each material; density="),
    ],
)
def test_a_file_that_is_missing_is_named(tmp_path, name, message):
    (datbox(tmp_path, turns=np.eye(3)) / name).unlink()
    with pytest.warns(UserWarning, match=message):
        masonry = mr.Masonry.from_lmgc90(tmp_path, fixed=["body_1"])
    assert len(masonry.joints) == 2


def test_other_shapes_are_left_out_and_named(tmp_path):
    path = datbox(tmp_path) / "BODIES.DAT"
    plane = "$tacty\n PLANx      1  color  BLUEx  axe1= 1.0E+00  axe2= 1.0E+00  axe3= 1.0E-02\n$$$$$$\n"
    path.write_text(f"{path.read_text()}$bdyty\n RBDY3      4\n$blmty\n{plane}")
    with pytest.warns(UserWarning, match="only polyhedra POLYR are read; left out are 1 PLANx; ground=True puts"):
        assert len(mr.Masonry.from_lmgc90(tmp_path).blocks) == 3


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("RBDY3      2", "RBDY2      2", "body 2 is of the kind RBDY2; bodies in space of the kind RBDY3 are read"),
        ("nb_vertex=      8", "nb_vertex=      9", r"body 1 has 8 vertices and 12 faces .* it states 9 and 12"),
        ("ver3=      7\n", "ver3=     19\n", "body 1 has 8 vertices and 12 faces between vertices 1 to 8"),
        (
            "$tacty\n",
            "$tacty\n POLYR      1  color  REDxx  nb_vertex=      0    nb_faces=     0\n",
            "body 1 has 2 polyhedra",
        ),
        ("POLYR", "SPHER", "it has no polyhedra POLYR"),
        ("$bdyty", "$body", r"it has no \$bdyty: it is not a file BODIES\.DAT of LMGC90"),
    ],
)
@pytest.mark.filterwarnings("ignore:.*left out are")
def test_what_is_refused(tmp_path, old, new, message):
    path = datbox(tmp_path) / "BODIES.DAT"
    path.write_text(path.read_text().replace(old, new))
    with pytest.raises(ValueError, match=rf"path = .*: {message}"):
        mr.Masonry.from_lmgc90(tmp_path)


@pytest.mark.filterwarnings("ignore::UserWarning")
@pytest.mark.parametrize("count", [60, slow(160)])
def test_damaged_files_are_read_or_refused_with_their_path(tmp_path, count):
    folder, rng = datbox(tmp_path), np.random.default_rng(4)
    texts = {path: path.read_text() for path in sorted(folder.iterdir())}
    refused = 0
    for i in range(count):
        path = list(texts)[i % len(texts)]
        text, at = texts[path], rng.integers(len(texts[path]), size=2)
        kinds = (text[: at[0]] + "#=-E"[i % 4] + text[at[0] + i % 3 :], text[: at[0]], text[: at[0]] + text[max(at) :])
        path.write_text(kinds[int(rng.integers(3))])
        try:
            mr.Masonry.from_lmgc90(folder)
        except (ValueError, TypeError) as error:
            refused += 1
            assert f"path = {folder}" in str(error), str(error)  # noqa: PT017
        path.write_text(text)
    assert count / 8 < refused < count
