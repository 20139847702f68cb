"""Reads the PNG files that the program writes: 8 bits, RGB, not interlaced."""

import struct
import zlib


def read_png(path):
    """Width, height and the rows of bytes; raises ValueError for any other PNG."""
    data = path.read_bytes()
    if data[:8] != b"\x89PNG\r\n\x1a\n":
        raise ValueError("not a PNG")
    at, packed, header = 8, b"", None
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + size]
        if kind == b"IHDR":
            header = struct.unpack(">IIBBBBB", body)
        if kind == b"IDAT":
            packed += body
        at += 12 + size
    width, height, depth, color, _, _, interlace = header
    if (depth, color, interlace) != (8, 2, 0):
        raise ValueError(f"unexpected kind of PNG: {header}")
    return width, height, unfilter(zlib.decompress(packed), width * 3, height)


def unfilter(raw, stride, height):
    rows, above = [], bytearray(stride)
    for y in range(height):
        start = y * (stride + 1)
        row = bytearray(raw[start + 1:start + 1 + stride])
        for x in range(stride):
            row[x] = (row[x] + predict(raw[start], row, above, x)) & 255
        rows.append(bytes(row))
        above = row
    return rows


def predict(kind, row, above, x):
    left = row[x - 3] if x >= 3 else 0
    up = above[x]
    corner = above[x - 3] if x >= 3 else 0
    if kind == 4:
        base = left + up - corner
        return min((left, up, corner), key=lambda value: abs(base - value))
    return (0, left, up, (left + up) // 2)[kind]
