"""Reads single-part scan-line EXR files (none, ZIPS or ZIP compression) with Python alone: an independent check of what
ebru writes."""

import struct
import zlib

_SIZES = {0: 4, 1: 2, 2: 4}  # uint, half, float
_FORMATS = {0: "I", 1: "e", 2: "f"}


def _text(data, at):
    end = data.index(b"\0", at)
    return data[at:end].decode(), end + 1


def _undo_predictor(raw):
    """ZIP's two steps backwards: differences to values, then the halves woven together."""
    values = bytearray(raw)
    for i in range(1, len(values)):
        values[i] = (values[i - 1] + values[i] - 128) & 0xFF
    half = (len(values) + 1) // 2
    woven = bytearray(len(values))
    woven[0::2] = values[:half]
    woven[1::2] = values[half:]
    return bytes(woven)


def read(path):
    """@return (header: name -> (type, bytes), width, height, channels: name -> list of rows * columns values)"""
    data = open(path, "rb").read()
    if data[:4] != b"\x76\x2f\x31\x01":
        raise ValueError(f"{path}: no EXR file")
    header, at = {}, 8
    while data[at] != 0:
        name, at = _text(data, at)
        kind, at = _text(data, at)
        (size,) = struct.unpack_from("<i", data, at)
        header[name] = (kind, data[at + 4 : at + 4 + size])
        at += 4 + size
    at += 1

    xmin, ymin, xmax, ymax = struct.unpack("<4i", header["dataWindow"][1])
    width, height = xmax - xmin + 1, ymax - ymin + 1
    channels, raw, place = [], header["channels"][1], 0
    while raw[place] != 0:
        name, place = _text(raw, place)
        channels.append((name, struct.unpack_from("<i", raw, place)[0]))
        place += 16
    compression = header["compression"][1][0]
    lines = {0: 1, 2: 1, 3: 16}[compression]

    planes = {name: [0.0] * (width * height) for name, _ in channels}
    blocks = (height + lines - 1) // lines
    for (offset,) in struct.iter_unpack("<Q", data[at : at + 8 * blocks]):
        top, size = struct.unpack_from("<ii", data, offset)
        block = data[offset + 8 : offset + 8 + size]
        rows = min(lines, ymax - top + 1)
        full = rows * width * sum(_SIZES[kind] for _, kind in channels)
        if compression and len(block) < full:
            block = _undo_predictor(zlib.decompress(block))
        if len(block) != full:
            raise ValueError(f"{path}: a block of {len(block)} bytes, expected {full}")
        place = 0
        for row in range(top - ymin, top - ymin + rows):
            for name, kind in channels:
                count = width * _SIZES[kind]
                planes[name][row * width : (row + 1) * width] = struct.unpack(
                    f"<{width}{_FORMATS[kind]}", block[place : place + count]
                )
                place += count
    return header, width, height, planes


def text_attribute(header, name):
    return header[name][1].decode()
