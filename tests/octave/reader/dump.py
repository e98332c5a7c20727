"""Writes all that an HDF5 file holds in a form that h5_contents.m reads: h5py reads it, not Octave.

A line per group, dataset and attribute, in the order of a walk from the root; behind those of datasets and attributes
the bytes of their values, of text each entry with its number of bytes on a line before it.
"""

import sys

import h5py
import numpy

CLASSES = {"f8": "double", "f4": "single", "i4": "int32", "u4": "uint32", "i8": "int64", "u8": "uint64"}


def values(out, word, name, stored, shape):
    """One line about the values, and the values."""
    sizes = ",".join(str(size) for size in shape) or "scalar"
    array = numpy.asarray(stored)
    if array.dtype.kind in "OSU":
        out.write(f"{word}\t{name}\ttext\t{sizes}\n".encode())
        for entry in array.reshape(-1):
            entry = entry if isinstance(entry, bytes) else entry.encode()
            out.write(b"%d\n" % len(entry) + entry)
    else:
        kind = CLASSES[array.dtype.str[1:]]
        out.write(f"{word}\t{name}\t{kind}\t{sizes}\n".encode())
        out.write(array.astype(array.dtype.newbyteorder("<")).tobytes())


def attributes(out, item):
    for name, value in item.attrs.items():
        values(out, "attribute", name, value, numpy.shape(value))


def group(out, item):
    out.write(f"group\t{item.name}\n".encode())
    attributes(out, item)
    for name, inner in item.items():
        if isinstance(inner, h5py.Dataset):
            values(out, "dataset", name, inner[()], inner.shape)
            attributes(out, inner)
    for inner in item.values():
        if isinstance(inner, h5py.Group):
            group(out, inner)
    out.write(b"end\n")


with h5py.File(sys.argv[1], "r") as file, open(sys.argv[2], "wb") as out:
    group(out, file)
