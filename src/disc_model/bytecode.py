"""Python code as compiled, by which a change of a source is told from one of its comments or layout."""

import dis
import functools
import os
import types
from collections.abc import Iterator

_DECISIVE = "name names varnames freevars cellvars argcount posonlyargcount kwonlyargcount flags"
_NOP = dis.opmap["NOP"]


@functools.cache
def bytecode_of(path: os.PathLike[str]) -> bytes:
    """Code of a file without comments, docstrings, layout and line numbers, as this version of Python compiles it."""
    with open(path, "rb") as file:
        code = compile(file.read(), os.path.basename(path), "exec", optimize=2, dont_inherit=True)
    return repr((*_contents(code),)).encode()


def _contents(code: types.CodeType) -> Iterator[object]:
    yield tuple(getattr(code, f"co_{name}") for name in _DECISIVE.split())
    pairs = (code.co_code[i : i + 2] for i in range(0, len(code.co_code), 2))
    yield b"".join(pair for pair in pairs if pair[0] != _NOP)  # which a docstring leaves
    for constant in code.co_consts:
        if isinstance(constant, types.CodeType):
            yield tuple(_contents(constant))
        else:  # the order within sets varies
            yield sorted(map(repr, constant)) if isinstance(constant, frozenset) else repr(constant)
