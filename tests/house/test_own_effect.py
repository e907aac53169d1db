"""Effects say of themselves what they are."""

import re
from pathlib import Path

import mjrock

ROOT = Path(mjrock.__file__).parent


def test_no_module_outside_the_problem_asks_which_kind_an_effect_is():
    kinds = r"isinstance\([^)]*\b(Tie|Thrust|Load|AddedMass|Damper|FrictionDamper|Link|Anchored|Effect)\b|\.each\("
    assert [
        str(path)
        for path in ROOT.rglob("*.py")
        if re.search(kinds, path.read_text(encoding="utf-8"))
        and not {"problem", "examples"} & set(path.relative_to(ROOT).parts)
    ] == []
