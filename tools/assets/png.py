"""Writes 8-bit RGB PNGs."""
import struct
import zlib


def encode(width, height, rgb):
    """`rgb`: bytes, three a pixel, rows from top to bottom. Every row is filtered "up", which suits woven patterns."""
    rows = bytearray()
    stride = 3 * width
    above = bytes(stride)
    for y in range(height):
        row = rgb[y * stride:(y + 1) * stride]
        rows.append(2)
        rows.extend((a - b) & 255 for a, b in zip(row, above))
        above = row

    def chunk(kind, data):
        return struct.pack('>I', len(data)) + kind + data + struct.pack('>I', zlib.crc32(kind + data))

    header = struct.pack('>IIBBBBB', width, height, 8, 2, 0, 0, 0)
    return (b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', header) + chunk(b'IDAT', zlib.compress(bytes(rows), 9)) +
            chunk(b'IEND', b''))
