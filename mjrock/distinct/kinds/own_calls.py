"""Own laws compiled, and calls of them by address. Importing this module imports numba."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numba
from llvmlite import ir  # type: ignore[import-untyped]
from numba.core import types
from numba.core.base import BaseContext
from numba.core.errors import NumbaError
from numba.core.typing import Context, Signature
from numba.extending import intrinsic

from ...problem.wall.user_law import layout

C_NUMBER, C_BYTES, C_NOTHING = ir.DoubleType(), ir.IntType(8).as_pointer(), ir.VoidType()
OF_COMPILER = {"nogil": True, "error_model": "numpy", "no_cpython_wrapper": True, "no_cfunc_wrapper": True}


@intrinsic  # type: ignore[untyped-decorator]
def _call(
    context: Context, values: types.Type, address: types.Type, closing: types.Type, rate: types.Type
) -> tuple[Signature, Callable[[BaseContext, ir.IRBuilder, Signature, Sequence[ir.Value]], ir.Value]]:
    """A call of a function of C by its address, with the address of numbers and two numbers."""
    signature = types.void(values, types.int64, types.float64, types.float64)

    def generated(
        context: BaseContext, builder: ir.IRBuilder, signature: Signature, arguments: Sequence[ir.Value]
    ) -> ir.Value:
        values, address, closing, rate = arguments
        array = context.make_array(signature.args[0])(context, builder, values)
        function_type = ir.FunctionType(C_NOTHING, [C_BYTES, C_NUMBER, C_NUMBER])
        function = builder.inttoptr(address, function_type.as_pointer())
        builder.call(function, [builder.bitcast(array.data, C_BYTES), closing, rate])
        return context.get_dummy_value()

    return signature, generated


def called(values: Any, address: int, closing: float, rate: float) -> None:
    """Let a law answer whose text has an address, see `own.call_law`."""
    _call(values, address, closing, rate)


def compiled_text(kind: Any) -> Any:
    """The text of a law as a function of C.

    Raises:
        TypeError: with the name of the law, for what numba cannot compile.
    """
    row = numba.from_dtype(layout(kind))
    methods = {}
    for name, count in kind.methods.items():
        method = numba.njit(**OF_COMPILER)(getattr(kind, name))
        try:
            method.compile((row, *[types.float64] * count))
        except NumbaError as error:
            lines = [line.strip() for line in str(error).splitlines() if line.strip()]
            reason = next((line for line in lines if not line.startswith(("Failed in", "During:"))), lines[0])
            raise TypeError(
                f"{kind.__name__}.{name} cannot be compiled: {reason}. A law takes numbers and functions of math, and "
                "functions of its own under numba.njit; MJROCK_INTERPRET=laws runs it as plain Python"
            ) from None
        methods[getattr(kind, name)] = method
    answer, kinds = numba.njit(**OF_COMPILER)(kind.answering(methods.__getitem__)), layout(kind)

    def text(values: Any, closing: float, rate: float) -> None:
        answer(numba.carray(values, (1,), kinds)[0], closing, rate)

    signature = types.void(types.voidptr, types.float64, types.float64)
    return numba.cfunc(signature, error_model="numpy")(text)
