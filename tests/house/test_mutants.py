"""The script that draws mutants names only what is there."""

from tests import mutants


def test_modules_tests_and_mutants_that_it_names_are_there(monkeypatch):
    assert mutants.gone() == []
    monkeypatch.setitem(mutants.EQUIVALENT, "step_control.py: return 17", "no line of the module becomes this")
    monkeypatch.setitem(mutants.OWN, "engine/no_such_room.py", ("no_such_test",))
    assert mutants.gone() == [
        "mjrock/engine/no_such_room.py",
        "test_no_such_test.py",
        "EQUIVALENT, step_control.py: return 17",
    ]
