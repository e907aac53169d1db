"""Messages in another language than English: each template has a text there, with the same values."""

import ast
import pickle
import re
import string
import tomllib
from pathlib import Path

import pytest
from trees import nodes

import mjrock as mr
import mjrock.__main__
from mjrock.contacts.checks import Message, reason
from mjrock.reporting.texts import MESSAGES, Words

ROOT = Path(mr.__file__).parent


def templates_in(path):
    """The templates of all messages that a module makes, also those that stand under a name first."""
    templates, named = [], {}
    if not re.search(r"\b(?:Message|refusal)\(", path.read_text("utf-8")):
        return
    for node in nodes(path):
        if isinstance(node, ast.Call):
            name = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
            at = {"Message": 0, "refusal": 1}.get(name)
            templates += [] if at is None else node.args[at : at + 1]
    for node in nodes(path):
        if isinstance(node, ast.Assign) and isinstance(node.value, ast.Constant):
            for target in node.targets:
                named.setdefault(ast.unparse(target), []).append(node.value.value)
    for given in templates:
        yield from [given.value] if isinstance(given, ast.Constant) else named.get(ast.unparse(given), [])


def fields(text):
    return {name for _, name, _, _ in string.Formatter().parse(text) if name}


def test_every_template_has_an_italian_text_with_its_values():
    templates = {template for path in sorted(ROOT.rglob("*.py")) for template in templates_in(path)}
    assert len(templates) > 50
    italian = tomllib.loads(MESSAGES.read_text("utf-8"))["it"]
    assert sorted(templates - italian.keys()) == []
    assert sorted(italian.keys() - templates) == []
    assert [one for one, text in italian.items() if fields(text) != fields(one)] == []


def bare(node):
    """The text of a literal, with empty braces for the values of an f-string; None of what is no literal."""
    if isinstance(node, ast.JoinedStr):
        return "".join(one.value if isinstance(one, ast.Constant) else "{}" for one in node.values)
    return node.value if isinstance(node, ast.Constant) and isinstance(node.value, str) else None


def raised_in(folder):
    """The texts of the errors that the modules of a folder raise."""
    for path in sorted((ROOT / folder).rglob("*.py")):
        for node in nodes(path):
            if isinstance(node, ast.Raise) and isinstance(node.exc, ast.Call) and node.exc.args:
                yield bare(node.exc.args[0])


def without_names(text):
    return re.sub(r"\{\w+\}", "{}", text)


PLAIN = tomllib.loads(MESSAGES.read_text("utf-8"))["texts"]["it"]
PARTS = {"path = {}: {}", "{}: {}", "line {}: {}", "body {}: {}", "parts: {}", "blocks: {}"}
"""What stands before a cause."""


def test_every_text_without_a_template_is_one_of_the_package():
    """An English text that changes takes its Italian one along."""
    in_code = "\0".join({bare(node) or "" for path in ROOT.rglob("*.py") for node in nodes(path)})
    once = {without_names(one) for one in PLAIN} - PARTS
    composed = sorted(one for one in once if one not in in_code)
    assert composed == [
        "between the bounds of {} and {} there are {} m, and no gap up to {} m joins all of them",
        "between the bounds of {} and {} there are {} m; gap = {} m joins all of them: it finds {} joints",
        "{} = {} m is more than {} m, at which the curve without ties ends: {}",
        "{} = {} m lies where the curve without ties has ended: {}",
        "{}; tolerance = {} m takes them: it finds {} joints",
    ]
    assert [one for one, text in PLAIN.items() if fields(text) - fields(one)] == []


@pytest.mark.parametrize("folder", ["builders", "blocks"])
def test_every_refusal_of_blocks_has_an_italian_text(folder):
    known = {without_names(one) for one in PLAIN}
    raised = set(raised_in(f"problem/masonry/{folder}")) - {None}
    assert len(raised) > 15
    assert sorted(raised - known) == []


SITE = "language = 'it'\n[site]\ncode = 'NTC 2018'\nag = 2.0\nF0 = 2.5\nTc = 0.33\nsoil = 'B'\n"
WALL = "[wall]\nthickness = 0.5\nheight = 5.0\n"
IN_ITALIAN = {
    "wall.thickness = -1 m è fuori dall'intervallo valido da 0,002 a 20 m": WALL.replace("0.5", "-1"),
    "wall.thickness = '30 kg' ha l'unità kg, mentre è richiesto un numero in m, ad esempio \"30 cm\"; "
    "l'intervallo valido è da 0,002 a 20 m": WALL.replace("0.5", "'30 kg'"),
    "wall.thickness = '0,3' ha una virgola; il separatore decimale nel file è il punto": WALL.replace("0.5", "'0,3'"),
    'in wall manca height: è richiesto un numero da 0,01 a 200 m, o un testo come "30 cm"': WALL[:22],
    "wall.breadth non è una chiave nota; le chiavi ammesse sono thickness": f"{WALL}breadth = 3\n",
    "wall.thicknes non è una chiave nota; si intende thickness?": f"{WALL}thicknes = 3\n",
    "effects[0].kind = 'Tye' (tipo str) non è noto; si intende 'Tie'?": f"{WALL}[[effects]]\nkind = 'Tye'\n",
    "wall.height: altezza (height) = 0,4 m minore dello spessore (thickness) = 0,5 m": WALL.replace("5.0", "0.4"),
    "wall.density è una lista; è richiesto un numero da 100 a 30000 kg/m3": f"{WALL}density = [1]\n",
    "carichi e spinte ribaltano verso l'esterno la parete già da ferma": f"{WALL}[[effects]]\nkind = 'Thrust'\n"
    "force = '900 kN'\nheight = 5\n",
}


@pytest.mark.parametrize("complaint", IN_ITALIAN)
def test_a_refusal_is_in_the_language_of_its_file(complaint):
    with pytest.raises(mr.AssessmentError) as caught:
        mr.from_toml(text=SITE + IN_ITALIAN[complaint])
    assert caught.value.language == "it"
    (line,) = caught.value.lines
    assert complaint in line
    assert str(caught.value) == line
    assert str(pickle.loads(pickle.dumps(caught.value))) == line
    with pytest.raises(mr.AssessmentError) as english:
        mr.from_toml(text=SITE.replace("'it'", "'en'") + IN_ITALIAN[complaint])
    assert complaint not in str(english.value)
    assert str(english.value).partition(":")[0] == line.partition(":")[0].replace("riga", "line")


BLOCKS = """language = 'it'
kind = 'MasonryCase'
duration = 1.0
[masonry]
kind = 'Masonry'
blocks = [
    { kind = 'Polygon', vertices = %s },
    { kind = 'Polygon', vertices = [[0, 0], [1, 0], [1, 1], [0, 1]], fixed = true },
]
"""
OF_BLOCKS = {
    "riga 7: masonry.blocks[0].vertices: i vertici racchiudono un'area di 0 m2": "[[0, 0], [1, 0], [0.5, 0]]",
    "vertices: il vertice 2 in [0.5, 0.5] m è rientrante": "[[0, 0], [2, 0], [0.5, 0.5], [0, 2]]",
    "tra gli ingombri di block_0 e block_1 ci sono 2 m, e nessuna distanza (gap) fino a 0,1 m li unisce tutti": (
        "[[0, 3], [1, 3], [1, 4], [0, 4]]"
    ),
}


@pytest.mark.parametrize("complaint", OF_BLOCKS)
def test_a_refusal_of_blocks_is_in_the_language_of_its_file(complaint):
    with pytest.raises(mr.AssessmentError) as caught:
        mr.from_toml(text=BLOCKS % OF_BLOCKS[complaint])
    (line,) = caught.value.lines
    assert complaint in line
    assert "in inglese" not in line


def test_a_refusal_of_a_record_is_in_the_language_of_its_file(tmp_path):
    (tmp_path / "shaken.csv").write_text("t,a\n0,1\n0.01,x\n")
    (tmp_path / "wall.toml").write_text(f"{SITE}{WALL}[records]\nfolder = '.'\npattern = '*.csv'\n")
    with pytest.raises(mr.AssessmentError) as caught:
        mr.from_toml(tmp_path / "wall.toml")
    (line,) = caught.value.lines
    assert "shaken.csv: riga 3: 'x' non è un numero finito come -0.015, 1.5E-02 o 1.5D-02. È stato letto come" in line


def test_a_cause_without_a_text_stays_english_behind_the_key_its_value_and_its_range():
    motion = "[motion]\nmake = 'half_sine'\namplitude = 1.0\nduration = 1.0\nsamples = 200000\n"
    with pytest.raises(mr.AssessmentError) as caught:
        mr.from_toml(text=SITE + WALL + motion)
    (fault,) = caught.value.faults
    assert isinstance(fault.message, Message)
    complaint = Words("it").message(Message("{place}: {cause}", place="a.b", cause="no such thing", known=" = 3; x"))
    assert complaint == "a.b = 3; x: il valore è rifiutato; in inglese: «no such thing»"


def test_a_message_is_a_text_with_its_values():
    text = Message("{name} = {value:g} m; {more}", name="a", value=0.25, more=Message("true or false"))
    assert (text, type(text.values["more"])) == ("a = 0.25 m; true or false", Message)
    for one in (
        pickle.loads(pickle.dumps(text)),
        reason(ValueError(text)),
        reason(pickle.loads(pickle.dumps(ValueError(text)))),
    ):
        assert (one, one.template, one.values) == (text, text.template, text.values)
    assert Words("en").message(text) == text == Words("it").message(str(text))
    assert Words("it").message(Message("{cause}, or inf", cause=text)) == "a = 0.25 m; true or false, oppure inf"


def test_commands_complain_in_the_language_of_the_file(tmp_path, capsys):
    path = tmp_path / "wall.toml"
    path.write_text(SITE + WALL.replace("0.5", "-1"), encoding="utf-8")
    assert mr.__main__.main(["check", str(path)]) == 2
    assert capsys.readouterr().err == (
        f"error: {path}:9: wall.thickness = -1 m è fuori dall'intervallo valido da 0,002 a 20 m\n"
    )
