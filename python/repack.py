"""Packs wheels again, each in its place, with the smallest deflate there is (zopfli): ``python repack.py WHEEL...``

What a wheel holds, the names and the order stay; each file is read back and compared.
"""

import copy
import os
import sys
import zipfile

import zopfli.zlib

HEADER, CHECKSUM = 2, 4  # bytes that zlib's format has around a raw deflate stream


class Compressor:
    """Compresses one file for ``zipfile``, once all of it is there."""

    def __init__(self):
        self.data = bytearray()

    def compress(self, data):
        self.data += data
        return b""

    def flush(self):
        return zopfli.zlib.compress(bytes(self.data), numiterations=5)[HEADER:-CHECKSUM]


def repack(wheel):
    before = os.path.getsize(wheel)
    packed = wheel + ".part"
    with zipfile.ZipFile(wheel) as old:
        with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as new:
            for entry in old.infolist():
                new.writestr(copy.copy(entry), old.read(entry))
        with zipfile.ZipFile(packed) as new:
            for entry in old.infolist():
                if new.read(entry.filename) != old.read(entry):
                    raise SystemExit(f"{wheel}: {entry.filename} was not packed as it is")
    os.replace(packed, wheel)
    print(f"{wheel}: {before} bytes before, {os.path.getsize(wheel)} after")


zipfile._get_compressor = lambda *_: Compressor()  # zipfile takes no compressor of one's own
for name in sys.argv[1:]:
    repack(name)
