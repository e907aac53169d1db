"""Messages in another language than English: each template has a text there, with the same values."""

import ast
import pickle
import string
import tomllib
from pathlib import Path

import pytest

import mjrock as mr
import mjrock.__main__
from mjrock.contacts.checks import Message, reason
from mjrock.reporting.texts import MESSAGES, Words

ROOT = Path(mr.__file__).parent


def templates_in(path):
    """The templates of all messages that a module makes, also those that stand under a name first."""
    tree = ast.parse(path.read_text("utf-8"))
    named = {}
    for node in ast.walk(tree):
        if isinstance(node, ast.Assign) and isinstance(node.value, ast.Constant):
            for target in node.targets:
                named.setdefault(ast.unparse(target), []).append(node.value.value)
    for node in ast.walk(tree):
        if not isinstance(node, ast.Call):
            continue
        name = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
        at = {"Message": 0, "refusal": 1}.get(name)
        if at is not None and len(node.args) > at:
            given = node.args[at]
            yield from [given.value] if isinstance(given, ast.Constant) else named.get(ast.unparse(given), [])


def fields(text):
    return {name for _, name, _, _ in string.Formatter().parse(text) if name}


def test_every_template_has_an_italian_text_with_its_values():
    templates = {template for path in sorted(ROOT.rglob("*.py")) for template in templates_in(path)}
    assert len(templates) > 90
    italian = tomllib.loads(MESSAGES.read_text("utf-8"))["it"]
    assert sorted(templates - italian.keys()) == []
    assert sorted(italian.keys() - templates) == []
    assert [one for one, text in italian.items() if fields(text) != fields(one)] == []


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


@pytest.mark.parametrize("said", IN_ITALIAN)
def test_a_refusal_is_in_the_language_of_its_file(said):
    with pytest.raises(mr.AssessmentError) as caught:
        mr.from_toml(text=SITE + IN_ITALIAN[said])
    assert caught.value.language == "it"
    (line,) = caught.value.lines
    assert said in line
    assert str(caught.value) == line
    assert str(pickle.loads(pickle.dumps(caught.value))) == line
    with pytest.raises(mr.AssessmentError) as english:
        mr.from_toml(text=SITE.replace("'it'", "'en'") + IN_ITALIAN[said])
    assert said not in str(english.value)
    assert str(english.value).partition(":")[0] == line.partition(":")[0].replace("riga", "line")


def test_a_cause_without_a_text_stays_english_behind_the_key_its_value_and_its_range():
    motion = "[motion]\nmake = 'half_sine'\namplitude = 1.0\nduration = 1.0\nsamples = 200000\n"
    with pytest.raises(mr.AssessmentError) as caught:
        mr.from_toml(text=SITE + WALL + motion)
    (fault,) = caught.value.faults
    assert isinstance(fault.message, Message)
    said = Words("it").message(Message("{place}: {cause}", place="a.b", cause="no such thing", known=" = 3; x"))
    assert said == "a.b = 3; x: il valore è rifiutato; in inglese: «no such thing»"


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
