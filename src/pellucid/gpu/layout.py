"""One source for a memory layout: a NumPy dtype makes the WGSL struct, padding included."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

# WGSL type -> (NumPy base, NumPy shape, size, alignment), W3C WGSL, section "Alignment and Size".
_TYPES: dict[str, tuple[type, tuple[int, ...], int, int]] = {
    "f32": (np.float32, (), 4, 4),
    "u32": (np.uint32, (), 4, 4),
    "i32": (np.int32, (), 4, 4),
    "vec2f": (np.float32, (2,), 8, 8),
    "vec3f": (np.float32, (3,), 12, 16),
    "vec4f": (np.float32, (4,), 16, 16),
    "vec2u": (np.uint32, (2,), 8, 8),
    "vec3u": (np.uint32, (3,), 12, 16),
    "vec4u": (np.uint32, (4,), 16, 16),
    "vec4i": (np.int32, (4,), 16, 16),
    "mat3x3f": (np.float32, (3, 4), 48, 16),
    "mat4x4f": (np.float32, (4, 4), 64, 16),
}

Field = tuple[str, str | tuple[str, int]]


def struct(fields: Sequence[Field]) -> np.dtype:
    """A NumPy dtype laid out as WGSL lays out a struct of the same fields, for uniform and storage buffers.

    Parameters
    ----------
    fields : (name, WGSL type) or (name, (WGSL type, count)); matrices are fields of COLUMNS (transpose a row-major
        matrix before writing it; a mat3x3f has four numbers a column, the last unused); arrays need an element size
        that is a multiple of 16 bytes, as uniforms do.

    Raises
    ------
    ValueError : for a type that is not known, or an array that uniforms do not allow.
    """
    if not fields:
        raise ValueError("WGSL has no empty structs")
    names, formats, offsets, titles = [], [], [], []
    offset, alignment = 0, 1
    for name, kind in fields:
        wgsl, count = (kind, None) if isinstance(kind, str) else kind
        if wgsl not in _TYPES:
            raise ValueError(f"{name}: no type '{wgsl}'; there are {', '.join(_TYPES)}")
        base, shape, size, align = _TYPES[wgsl]
        if count is not None:
            if size % 16 or count < 1:
                raise ValueError(f"{name}: an array of {count} {wgsl} is not allowed in uniforms")
            shape, size = (count, *shape), size * count
        # The struct is as wide as its widest member asks, no more: arrays of it have that stride in WGSL.
        alignment = max(alignment, align)
        offset = -(-offset // align) * align
        names.append(name)
        formats.append((base, shape))
        offsets.append(offset)
        titles.append(wgsl if count is None else f"array<{wgsl}, {count}>")
        offset += size
    total = -(-offset // alignment) * alignment
    dtype = np.dtype({"names": names, "formats": formats, "offsets": offsets, "itemsize": total})
    return np.dtype(dtype, metadata={"wgsl": tuple(zip(names, titles, strict=True))})


def wgsl_struct(name: str, dtype: np.dtype) -> str:
    """The WGSL text of a struct whose dtype came from `struct`."""
    if dtype.metadata is None or "wgsl" not in dtype.metadata:
        raise ValueError(f"{name}: the dtype was not made by pellucid.gpu.layout.struct")
    members = ", ".join(f"{field}: {kind}" for field, kind in dtype.metadata["wgsl"])
    return f"struct {name} {{ {members} }}"


def offset_of(layout: np.dtype, field: str) -> int:
    """Bytes from the beginning of a struct to one of its fields."""
    assert layout.fields is not None
    return layout.fields[field][1]
