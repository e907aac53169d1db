"""A call for one wall names the call that takes masonry."""

import re

import pytest

import mjrock as mr

MASONRY = mr.Masonry.stack([mr.Block.from_size(0.5, 1.0)] * 2, k_n=1e8)
CASE = mr.MasonryCase(MASONRY, 0.1)


@pytest.mark.parametrize("given", [CASE, MASONRY], ids=["case", "masonry"])
@pytest.mark.parametrize(
    ("call", "instead"),
    [
        (lambda given: mr.solve_analytical(given, 0.5), "solve_explicit or simulate"),
        (lambda given: mr.solve_compliant(given, None), "solve_explicit or simulate"),
        (mr.pushover, "push or collapse_multiplier"),
        (lambda given: mr.mechanism_check(given, lambda T, xi: 0.1), "mr.limit_curve(masonry, direction)"),
        (mr.plotting.sketch, "plotting.blocks"),
    ],
)
def test_it_says_what_takes_masonry(call, instead, given):
    message = f"case is masonry, and one wall is needed; for masonry take {instead}"
    with pytest.raises(TypeError, match=f"^{re.escape(message)}$"):
        call(given)
