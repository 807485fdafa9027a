"""Reads NanoVDB files into NumPy arrays: versions 32.x, uncompressed, ZIP or BLOSC; float, Fp4, Fp8, Fp16 and FpN.

Node layouts are those of NanoVDB.h; values are looked up as vkvol does: what lies outside the box of active voxels
is 0, and so is what is negative or no number."""
import ctypes
import ctypes.util
import dataclasses
import pathlib
import struct
import sys
import zlib

import numpy as np

CODEC_NONE, CODEC_ZIP, CODEC_BLOSC = 0, 1, 2
MAGIC = (b"NanoVDB0", b"NanoVDB2")
FLOAT, HALF, FP4, FP8, FP16, FPN = 1, 9, 13, 14, 15, 16
LOG2_BITS = {FP4: 2, FP8: 3, FP16: 4}

GRID_BYTES = 672  # of the header; the tree follows
ROOT_BYTES, TILE_BYTES = 64, 32
LEAF_FLAGS, LEAF_MINIMUM, LEAF_QUANTUM, LEAF_VALUES = 15, 80, 84, 96


@dataclasses.dataclass
class Node:
    """Where an internal node has what, in bytes, and how wide its children are, in voxels."""
    log2: int
    child_mask: int
    table: int
    child_width: int

    @property
    def children(self):
        return 1 << (3 * self.log2)

    def origins(self):
        """Of the children, relative to the node's own."""
        n, mask = np.arange(self.children), (1 << self.log2) - 1
        return np.stack([n >> (2 * self.log2), n >> self.log2 & mask, n & mask], axis=1) * self.child_width


UPPER = Node(5, 32 + 4096, 8256, 128)
LOWER = Node(4, 32 + 512, 1088, 8)


@dataclasses.dataclass
class Grid:
    """Density at integer index positions; the outermost layer of `values` is 0, as is everything beyond."""
    path: pathlib.Path
    name: str
    values: np.ndarray  # [x, y, z]
    first: np.ndarray  # index position of values[0, 0, 0]
    matrix: np.ndarray  # 4x4, index to world

    @property
    def voxel_size(self):
        return abs(np.linalg.det(self.matrix[:3, :3])) ** (1 / 3)

    def cell_box(self):
        """Index space from face to face of the voxels."""
        return self.first - 0.5, self.first + np.array(self.values.shape) - 0.5

    def support(self):
        """Index space where the interpolated density may be above 0."""
        return self.first.astype(float), self.first + np.array(self.values.shape) - 1.0

    def corners(self):
        low, high = self.support()
        points = np.array([[(low, high)[i >> axis & 1][axis] for axis in range(3)] for i in range(8)])
        return points @ self.matrix[:3, :3].T + self.matrix[:3, 3]

    def contains(self, point):
        index = np.linalg.solve(self.matrix[:3, :3], point - self.matrix[:3, 3])
        low, high = self.support()
        return bool(np.all(index > low) and np.all(index < high))


def blosc_decompress(chunk, size, path):
    try:
        library = ctypes.CDLL(ctypes.util.find_library("blosc") or "libblosc.so.1") # the latter where LD_LIBRARY_PATH leads
    except OSError:
        sys.exit(f"{path}: BLOSC data needs the library libblosc (Debian: libblosc1); or write the file with codec zip")
    out = ctypes.create_string_buffer(size)
    if library.blosc_decompress_ctx(chunk, out, ctypes.c_size_t(size), 1) != size:
        sys.exit(f"{path}: its BLOSC data does not decompress; copy the file again")
    return out.raw


def decompress(data, codec, size, path):
    if codec == CODEC_NONE:
        return data[:size]
    parts, at, done = [], 0, 0
    while done < size:
        length, = struct.unpack_from("<Q", data, at)
        chunk = data[at + 8:at + 8 + length]
        parts.append(zlib.decompress(chunk) if codec == CODEC_ZIP
                     else blosc_decompress(chunk, min(1 << 30, size - done), path))
        at, done = at + 8 + length, done + len(parts[-1])
    return b"".join(parts)


def grid_bytes(path, name):
    """The grid's bytes as in memory, from the file's list of segments."""
    data, at, found = pathlib.Path(path).read_bytes(), 0, []
    while at < len(data):
        magic, version, count, codec = struct.unpack_from("<8sIHH", data, at)
        if magic not in MAGIC or version >> 21 != 32:
            sys.exit(f"{path}: not a NanoVDB file of version 32; convert .vdb files with nanovdb_convert")
        at, entries = at + 16, []
        for _ in range(count):
            size, file_size = struct.unpack_from("<QQ", data, at)
            name_size, = struct.unpack_from("<I", data, at + 136)
            title = data[at + 176:at + 176 + name_size].rstrip(b"\0").decode()
            entries.append((title, size, file_size))
            at += 176 + name_size
        for title, size, file_size in entries:
            if title == name:
                return decompress(data[at:at + file_size], codec, size, path)
            found.append(title)
            at += file_size
    return sys.exit(f"{path}: has no grid \"{name}\"; it holds {', '.join(found)}")


class Tree:
    """Collects the values below the root: 8^3 blocks, and larger constant tiles."""

    def __init__(self, data, path):
        self.data, self.bytes = data, np.frombuffer(data, np.uint8)
        self.type, = struct.unpack_from("<I", data, 636)
        if self.type not in (FLOAT, HALF, FP4, FP8, FP16, FPN):
            sys.exit(f"{path}: its grid is not of floats; convert it to float, Fp4, Fp8, Fp16 or FpN")
        offsets = struct.unpack_from("<4q", data, GRID_BYTES)
        self.root = GRID_BYTES + offsets[3]
        *box, self.tiles = struct.unpack_from("<6iI", data, self.root)
        self.low, self.high = np.array(box[:3]), np.array(box[3:])
        self.background, = struct.unpack_from("<f", data, self.root + 28)
        self.blocks, self.offsets = [], []  # origins of leaves, and where they are
        self.constant = []  # origin, width and value

    def collect(self):
        for i in range(self.tiles):
            at = self.root + ROOT_BYTES + i * TILE_BYTES
            key, child, _, value = struct.unpack_from("<QqIf", self.data, at)
            origin = np.array([key >> shift & 0x1fffff for shift in (42, 21, 0)]) << 12
            origin = np.where(origin >= 1 << 31, origin - (1 << 32), origin)
            if child:
                self.collect_upper(self.root + child, origin)
            else:
                self.constant.append((origin, 4096, value))

    def table(self, node, at):
        """Which children there are, their offsets, and the tiles' values."""
        mask = np.unpackbits(self.bytes[at + node.child_mask:][:node.children // 8], bitorder="little").astype(bool)
        child = np.frombuffer(self.data, np.int64, node.children, at + node.table) + at
        value = np.frombuffer(self.data, np.float32, 2 * node.children, at + node.table)[::2]
        return mask, child, value

    def collect_upper(self, at, origin):
        mask, child, value = self.table(UPPER, at)
        for n in np.flatnonzero(~mask & (value != self.background)):
            self.constant.append((origin + UPPER.origins()[n], 128, value[n]))
        for n in np.flatnonzero(mask):
            lower = origin + UPPER.origins()[n]
            inner, leaf, tile = self.table(LOWER, child[n])
            self.blocks.append(lower + LOWER.origins()[inner])
            self.offsets.append(leaf[inner])
            for m in np.flatnonzero(~inner & (tile != self.background)):
                self.constant.append((lower + LOWER.origins()[m], 8, tile[m]))

    def leaf_values(self, offsets):
        if self.type in (FLOAT, HALF):  # 32.x keeps halves as floats
            return np.frombuffer(self.data, np.float32)[offsets[:, None] // 4 + LEAF_VALUES // 4 + np.arange(512)]
        values = np.empty((len(offsets), 512), np.float32)
        log2 = np.full(len(offsets), LOG2_BITS.get(self.type, 0))
        if self.type == FPN:
            log2 = self.bytes[offsets + LEAF_FLAGS] >> 5
        words = np.frombuffer(self.data, np.float32)
        for bits_log2 in np.unique(log2):
            at, bits = offsets[log2 == bits_log2], 1 << bits_log2
            packed = self.bytes[at[:, None] + LEAF_VALUES + np.arange(64 * bits)]
            codes = np.unpackbits(packed, axis=1, bitorder="little").reshape(len(at), 512, bits) @ (1 << np.arange(bits))
            values[log2 == bits_log2] = (codes * words[(at + LEAF_QUANTUM) // 4][:, None]
                                         + words[(at + LEAF_MINIMUM) // 4][:, None])
        return values

    def dense(self):
        """Values of the box of active voxels, [x, y, z]."""
        base = self.low & ~7
        size = (self.high >> 3) - (base >> 3) + 1  # in blocks
        field = np.full((size[0], 8, size[1], 8, size[2], 8), self.background, np.float32)
        flat = field.reshape(size * 8)
        for origin, width, value in self.constant:
            begin, end = np.maximum(origin - base, 0), np.minimum(origin + width - base, size * 8)
            if np.all(begin < end):
                flat[begin[0]:end[0], begin[1]:end[1], begin[2]:end[2]] = value
        if self.blocks:
            place, offsets = (np.concatenate(self.blocks) - base) >> 3, np.concatenate(self.offsets)
            inside = np.all((place >= 0) & (place < size), axis=1)
            x, y, z = place[inside].T
            field[x, :, y, :, z, :] = self.leaf_values(offsets[inside]).reshape(-1, 8, 8, 8)
        begin, end = self.low - base, self.high - base + 1
        return flat[begin[0]:end[0], begin[1]:end[1], begin[2]:end[2]]


def read(path, name="density"):
    if pathlib.Path(path).suffix.lower() == ".vdb":
        sys.exit(f"{path}: .vdb files are not read here; convert it with nanovdb_convert")
    try:
        data = grid_bytes(path, name)
    except OSError as error:
        sys.exit(f"{path}: cannot be read: {error.strerror}; check the path, or make the field with build/make_field")
    tree = Tree(data, path)
    if np.any(tree.low > tree.high):
        sys.exit(f"{path}: the grid is empty; there is nothing to compare")
    tree.collect()
    values = tree.dense()
    values = np.where(np.isfinite(values) & (values > 0), values, np.float32(0))
    matrix = np.eye(4)
    # The map: 3x3 and inverse as floats, translation and taper, then the same as doubles.
    matrix[:3, :3] = np.frombuffer(data, np.float64, 9, 296 + 88).reshape(3, 3)
    matrix[:3, 3] = np.frombuffer(data, np.float64, 3, 296 + 88 + 144)
    return Grid(pathlib.Path(path), name, np.pad(values, 1), tree.low - 1, matrix)
