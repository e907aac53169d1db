"""Numbers that threads change and read together, in compiled loops. Importing this module imports numba."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from llvmlite import ir  # type: ignore[import-untyped]
from numba.core import types
from numba.core.base import BaseContext
from numba.core.typing import Context, Signature
from numba.extending import intrinsic

from ..quantities import Integers

Intrinsic = tuple[Signature, Callable[[BaseContext, ir.IRBuilder, Signature, Sequence[ir.Value]], ir.Value]]
"""Types of a call, and what writes its instructions."""

ORDERED = "seq_cst"
"""What a thread has written before such a number is seen by those that read the number after."""
WORD = 8
"""Bytes of a number."""


def _place(
    context: BaseContext, builder: ir.IRBuilder, array_type: types.Type, numbers: ir.Value, index: ir.Value
) -> ir.Value:
    """The address of a number of an array."""
    return builder.gep(context.make_array(array_type)(context, builder, numbers).data, [index])


@intrinsic  # type: ignore[untyped-decorator]
def _add(typing: Context, numbers: types.Type, index: types.Type, amount: types.Type) -> Intrinsic:
    signature = types.int64(numbers, types.int64, types.int64)

    def generated(
        context: BaseContext, builder: ir.IRBuilder, signature: Signature, arguments: Sequence[ir.Value]
    ) -> ir.Value:
        place = _place(context, builder, signature.args[0], arguments[0], arguments[1])
        return builder.atomic_rmw("add", place, arguments[2], ORDERED)

    return signature, generated


@intrinsic  # type: ignore[untyped-decorator]
def _look(typing: Context, numbers: types.Type, index: types.Type) -> Intrinsic:
    signature = types.int64(numbers, types.int64)

    def generated(
        context: BaseContext, builder: ir.IRBuilder, signature: Signature, arguments: Sequence[ir.Value]
    ) -> ir.Value:
        return builder.load_atomic(_place(context, builder, signature.args[0], *arguments), ORDERED, WORD)

    return signature, generated


@intrinsic  # type: ignore[untyped-decorator]
def _give_way(typing: Context, numbers: types.Type, address: types.Type) -> Intrinsic:
    signature = types.int64(numbers, types.int64)

    def generated(
        context: BaseContext, builder: ir.IRBuilder, signature: Signature, arguments: Sequence[ir.Value]
    ) -> ir.Value:
        function_type = ir.FunctionType(ir.IntType(32), [])
        builder.call(builder.inttoptr(arguments[1], function_type.as_pointer()), [])
        return ir.Constant(ir.IntType(64), 0)

    return signature, generated


def add(numbers: Integers, index: int, amount: int) -> Any:
    """Add to a number of an array. Returns what it was before."""
    return _add(numbers, index, amount)


def look(numbers: Integers, index: int) -> Any:
    """A number of an array as another thread has left it."""
    return _look(numbers, index)


def give_way(numbers: Integers, address: int) -> Any:
    """Let other threads have the core, by a function of C with an address. The numbers are left as they are."""
    return _give_way(numbers, address)
