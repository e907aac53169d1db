"""The wall US-1 in the plane, and the damping of its cracked joints."""

import pytest

from scripts.studies.cracked_damping import ways


def test_what_the_laws_say_of_the_wall_above_a_crack():
    """Published: Eq. 5 with h/b 6.14, 2.5e9 N/m3 and Housner's 0.9613, and with the 0.7396 of the impact of both
    bodies; the calibrated law is its own."""
    made = ways()
    slender, stiff = (2.58 / 2) / 0.21, 2.5e9
    for name, loss in (("published law", 0.03949), ("published law, both bodies", 0.30170)):
        expected = 0.000292 * slender**0.935 * stiff**0.343 * loss
        assert made[name].xi == pytest.approx(expected, rel=2e-3)
    assert 0 < made["calibrated law"].xi < made["published law"].xi
