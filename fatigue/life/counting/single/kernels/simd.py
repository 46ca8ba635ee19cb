"""The inner loops in vector instructions of x86-64 processors, up to 16 samples at a time.

The two steps of ``kernels.loops`` select: turning points among samples, closed ranges among turning points. A
comparison of vectors gives one bit per lane, integer arithmetic on these bits decides for all lanes at once what a loop
would decide one after the other, and the selected lanes are moved together (AVX-512: ``vcompressps``, AVX2: ``vpermps``
with a table of lane numbers). The results are bit for bit the same as in the plain loops, which run instead where this
file says so or is missing. With AVX-512 the matrix product is here, too: BLAS clears its result first and adds to it,
which takes as long as a third of the product of so few modes.
"""

import itertools
from collections.abc import Callable
from typing import Any, cast

import numpy as np
from llvmlite import ir
from numba import types
from numba.core import cgutils, config
from numba.core.codegen import get_host_cpu_features
from numba.extending import intrinsic
from numpy.typing import NDArray

from fatigue.compiled import compiled

Numbers = NDArray[np.floating]
Singles = NDArray[np.float32]

TILE, PANEL = 12, 32  # rows and columns of the product that are worked out at a time
CACHED = 16  # panels that stay near the processor while all tiles pass over them

I1, I8, I32, I64 = ir.IntType(1), ir.IntType(8), ir.IntType(32), ir.IntType(64)


def vector_bits() -> int:
    """Width of the vectors that numba compiles for: 512 with AVX-512, 256 with AVX2, 0 otherwise.

    By the features that numba gives to LLVM, those of this processor unless environment variables name others. They are
    part of the key of what it keeps on disk, so machine code of another width is never taken for this one.
    """
    chosen = vars(config)["CPU_FEATURES"]
    features = (get_host_cpu_features() if chosen is None else chosen).split(",")
    return 512 if "+avx512f" in features else 256 if "+avx2" in features else 0


WIDTH = vector_bits()


def lanes(array_type: Any) -> int:
    """Numbers of an array to a vector: 16 or 8 in single precision, 8 in double precision; 0: use the plain loops."""
    if array_type.dtype == types.float32:
        return WIDTH // 32
    return 8 if WIDTH == 512 else 0


def _lanes_of(typing: Any, array: Any) -> Any:
    """Give ``lanes`` to compiled code."""
    return types.int64(array), lambda *_: ir.Constant(I64, lanes(array))


class _Vector:
    """Shorthand for building instructions on vectors of the numbers of an array."""

    def __init__(self, context: Any, builder: Any, array_type: Any) -> None:
        self.context, self.builder = context, builder
        self.size = lanes(array_type)
        self.number = context.get_data_type(array_type.dtype)
        self.align = array_type.dtype.bitwidth // 8
        self.type = ir.VectorType(self.number, self.size)
        self.mask = ir.VectorType(I1, self.size)
        self.all = ir.Constant(I64, 2**self.size - 1)
        self.last = ir.Constant(I64, self.size - 1)

    def at(self, address: Any) -> Any:
        return self.builder.load(self.builder.bitcast(address, self.type.as_pointer()), align=self.align)

    def put(self, value: Any, address: Any) -> None:
        self.builder.store(value, self.builder.bitcast(address, self.type.as_pointer()), align=self.align)

    def address(self, array_type: Any, array: Any, index: Any) -> Any:
        return self.builder.gep(self.context.make_array(array_type)(self.context, self.builder, array).data, [index])

    def load(self, array_type: Any, array: Any, index: Any) -> Any:
        return self.at(self.address(array_type, array, index))

    def everywhere(self, number: Any) -> Any:
        if number.type != self.number:
            number = self.builder.fpext(number, self.number)
        one = self.builder.insert_element(ir.Constant(self.type, ir.Undefined), number, ir.Constant(I32, 0))
        lane_0 = ir.Constant(ir.VectorType(I32, self.size), [0] * self.size)
        return self.builder.shuffle_vector(one, ir.Constant(self.type, ir.Undefined), lane_0)

    def doubt(self, flat: Any, s: Any) -> Any:
        """Differences from stress s that rounding may have made."""
        flat = self.everywhere(flat)
        return self.builder.fadd(flat, self.builder.fmul(flat, self.absolute(s)))

    def absolute(self, number: Any) -> Any:
        return self.call("llvm.fabs", number)

    def stress(self, membrane: Any, side: Any, bending: Any) -> Any:
        """Membrane plus or minus bending: the product with 1 or -1 is exact, so one rounding is as good as two."""
        return self.call("llvm.fma", side, bending, membrane)

    def call(self, name: str, *numbers: Any) -> Any:
        kind = ir.FunctionType(self.type, [self.type] * len(numbers))
        name = f"{name}.v{self.size}f{8 * self.align}"
        return self.builder.call(cgutils.get_or_insert_function(self.builder.module, kind, name), numbers)

    def bits(self, mask: Any) -> Any:
        """One bit per lane, as an integer of 64 bits."""
        return self.builder.zext(self.builder.bitcast(mask, ir.IntType(self.size)), I64)

    def lanes(self, bits: Any) -> Any:
        return self.builder.bitcast(self.builder.trunc(bits, ir.IntType(self.size)), self.mask)

    def compare(self, how: str, a: Any, b: Any) -> Any:
        return self.bits(self.builder.fcmp_ordered(how, a, b))

    def store_selected(self, value: Any, bits: Any, array_type: Any, array: Any, index: Any) -> None:
        """Store the selected lanes side by side; what is behind them is overwritten with anything."""
        self.put(self._together(value, bits), self.address(array_type, array, index))

    def _together(self, value: Any, bits: Any) -> Any:
        module = self.builder.module
        if WIDTH == 512:
            name = f"llvm.x86.avx512.mask.compress.v{self.size}f{8 * self.align}"
            kind = ir.FunctionType(self.type, [self.type, self.type, self.mask])
            compress = cgutils.get_or_insert_function(module, kind, name)
            return self.builder.call(compress, [value, ir.Constant(self.type, ir.Undefined), self.lanes(bits)])
        numbers = ir.VectorType(I32, self.size)
        kind = ir.FunctionType(self.type, [self.type, numbers])
        permute = cgutils.get_or_insert_function(module, kind, "llvm.x86.avx2.permps")
        row = self.builder.gep(self._table(module), [ir.Constant(I64, 0), bits])
        row = self.builder.bitcast(row, ir.VectorType(I8, self.size).as_pointer())
        return self.builder.call(permute, [value, self.builder.zext(self.builder.load(row, align=8), numbers)])

    @staticmethod
    def _table(module: Any) -> Any:
        """Numbers of the selected lanes for each of the 256 selections of 8."""
        name = ".rainflow.selected_lanes"
        if name in module.globals:
            return module.globals[name]
        rows = [[lane for lane in range(8) if bits >> lane & 1] for bits in range(256)]
        table = np.array([row + [0] * (8 - len(row)) for row in rows], dtype=np.uint8)
        kind = ir.ArrayType(ir.ArrayType(I8, 8), 256)
        variable = cgutils.add_global_variable(module, kind, name)
        variable.initializer = ir.Constant(kind, [ir.Constant(kind.element, bytearray(row.tobytes())) for row in table])
        variable.global_constant, variable.linkage, variable.align = True, "internal", 8
        return variable


def _reversals_of_lanes(
    typing: Any, m: Any, b: Any, side: Any, flat: Any, i: Any, up: Any, z: Any, zm: Any, n: Any
) -> Any:
    """Do what ``kernels.loops.write_reversals`` does for the samples i to i + lanes - 1."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        m_, b_, side_, flat_, i_, up_, z_, zm_, n_ = args
        vector = _Vector(context, builder, m)
        following = builder.add(i_, ir.Constant(I64, 1))
        sign = vector.everywhere(side_)
        membrane = vector.load(m, m_, i_)
        s = vector.stress(membrane, sign, vector.load(b, b_, i_))
        next_membrane = vector.load(m, m_, following)
        s_next = vector.stress(next_membrane, sign, vector.load(b, b_, following))
        step = builder.fsub(s_next, s)
        zero = ir.Constant(vector.type, [0.0] * vector.size)
        rises, level = vector.compare(">", step, zero), vector.compare("==", step, zero)
        small = builder.and_(
            vector.compare("<=", vector.absolute(step), vector.doubt(flat_, s)),
            vector.compare("!=", next_membrane, membrane),
        )

        # The carry of the addition runs through level steps (0 + 1) and takes the direction before them along.
        rises_or_level = builder.or_(rises, level)
        total = builder.add(builder.add(rises_or_level, rises), up_)
        up_before = builder.xor(total, builder.xor(rises_or_level, rises))
        turns = builder.and_(builder.not_(level), builder.xor(rises, up_before))
        turns = builder.and_(turns, vector.all)
        peaks = vector.lanes(up_before)
        vector.store_selected(builder.select(peaks, s, builder.fneg(s)), turns, z, z_, n_)
        vector.store_selected(builder.select(peaks, membrane, builder.fneg(membrane)), turns, zm, zm_, n_)
        n_ = builder.add(n_, builder.ctpop(turns))
        up_ = builder.lshr(total, ir.Constant(I64, vector.size))
        return context.make_tuple(builder, signature.return_type, [n_, up_, small])

    integer = types.int64
    arguments = (m, b, types.float32, types.float32, integer, integer, z, zm, integer)
    return types.Tuple((integer,) * 3)(*arguments), generate


def _cycles_of_lanes(
    typing: Any,
    z: Any,
    zm: Any,
    S: Any,
    dm: Any,
    i: Any,
    n: Any,
    before: Any,
    taken: Any,
    kept: Any,
    cycles: Any,
    flat: Any,
) -> Any:
    """Do what ``kernels.loops.close_pass`` does for the reversals i to i + lanes - 1."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        z_, zm_, S_, dm_, i_, n_, before_, taken_, kept_, cycles_, flat_ = args
        vector = _Vector(context, builder, z)
        one = ir.Constant(I64, 1)
        next_, second = builder.add(i_, one), builder.add(i_, ir.Constant(I64, 2))
        z0, m0 = vector.load(z, z_, i_), vector.load(zm, zm_, i_)
        left = builder.sub(n_, i_)
        within = builder.icmp_signed("<", left, ir.Constant(I64, vector.size))
        there = builder.select(within, builder.sub(builder.shl(one, left), one), vector.all)
        z2, m2 = vector.load(z, z_, second), vector.load(zm, zm_, second)
        after = vector.compare(">=", z2, z0)
        difference = vector.absolute(builder.fsub(z2, z0))
        close_calls = builder.and_(
            builder.and_(vector.compare("<=", difference, vector.doubt(flat_, z0)), vector.compare("!=", m2, m0)), there
        )
        take = builder.and_(after, builder.not_(builder.or_(builder.shl(after, one), before_)))
        take = builder.and_(take, there)
        drop = builder.or_(take, builder.or_(builder.shl(take, one), taken_))
        keep = builder.and_(builder.not_(drop), there)

        S_lanes = builder.fadd(z0, vector.load(z, z_, next_))
        dm_lanes = builder.fadd(m0, vector.load(zm, zm_, next_))
        vector.store_selected(S_lanes, take, S, S_, cycles_)
        vector.store_selected(dm_lanes, take, dm, dm_, cycles_)
        vector.store_selected(z0, keep, z, z_, kept_)
        vector.store_selected(m0, keep, zm, zm_, kept_)
        results = [
            builder.add(kept_, builder.ctpop(keep)),
            builder.add(cycles_, builder.ctpop(take)),
            builder.lshr(after, vector.last),
            builder.lshr(take, vector.last),
            close_calls,
        ]
        return context.make_tuple(builder, signature.return_type, results)

    integer = types.int64
    return types.Tuple((integer,) * 5)(z, zm, S, dm, *(integer,) * 6, types.float32), generate


def _product_of_tile(typing: Any, tiles: Any, tile: Any, samples: Any, panel: Any, stress: Any) -> Any:
    """Multiply a tile of 12 rows with a panel of 32 samples: 24 sums stay in the 32 registers of AVX-512.

    Samples are laid out in panels, or they are rows as in the product, from column 1 on.
    """

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        tiles_, tile_, samples_, panel_, stress_ = args
        vector = _Vector(context, builder, stress)
        parts = range(PANEL // vector.size)
        left, right, out = (
            context.make_array(kind)(context, builder, array)
            for kind, array in ((tiles, tiles_), (samples, samples_), (stress, stress_))
        )
        modes = cgutils.unpack_tuple(builder, left.shape)[1]
        column = builder.add(builder.mul(panel_, ir.Constant(I64, PANEL)), ir.Constant(I64, 1))
        nothing = ir.Constant(vector.type, [0.0] * vector.size)
        sums = [[cgutils.alloca_once_value(builder, nothing) for _ in parts] for _ in range(TILE)]
        for total in itertools.chain(*sums):
            builder.store(nothing, total)
        with cgutils.for_range(builder, modes) as loop:
            weights = _element(builder, left.data, [tile_, modes, loop.index, TILE])
            if samples.ndim == 3:
                q = _element(builder, right.data, [panel_, modes, loop.index, PANEL])
            else:
                length = cgutils.unpack_tuple(builder, right.shape)[1]
                q = builder.gep(right.data, [builder.add(builder.mul(loop.index, length), column)])
            q_parts = [vector.at(builder.gep(q, [ir.Constant(I64, vector.size * k)])) for k in parts]
            for row in range(TILE):
                weight = vector.everywhere(builder.load(builder.gep(weights, [ir.Constant(I64, row)])))
                for total, part in zip(sums[row], q_parts, strict=True):
                    builder.store(vector.call("llvm.fma", weight, part, builder.load(total)), total)
        width = cgutils.unpack_tuple(builder, out.shape)[1]
        for row in range(TILE):
            number = builder.add(builder.mul(tile_, ir.Constant(I64, TILE)), ir.Constant(I64, row))
            start = builder.gep(out.data, [builder.add(builder.mul(number, width), column)])
            for k in parts:
                vector.put(builder.load(sums[row][k]), builder.gep(start, [ir.Constant(I64, vector.size * k)]))
        return context.get_dummy_value()

    return types.void(tiles, types.int64, samples, types.int64, stress), generate


def _element(builder: Any, data: Any, at: list[Any]) -> Any:
    """Address of the row ``at[2]`` of block ``at[0]`` where a block has ``at[1]`` rows of ``at[3]`` numbers."""
    block, rows, row, length = at
    return builder.gep(data, [builder.mul(builder.add(builder.mul(block, rows), row), ir.Constant(I64, length))])


lanes_of = cast(Callable[[Numbers], int], intrinsic(_lanes_of))
reversals_of_lanes = cast(Callable[..., tuple[int, int, int]], intrinsic(_reversals_of_lanes))
cycles_of_lanes = cast(Callable[..., tuple[int, int, int, int, int]], intrinsic(_cycles_of_lanes))
product_of_tile = cast(Callable[..., None], intrinsic(_product_of_tile))


@compiled()
def write_reversals(
    m: Numbers, b: Numbers, side: np.float32, flat: np.float32, samples: int, up: int, room: Any, n: int
) -> tuple[int, int, bool]:
    """Do what ``kernels.loops.write_reversals`` does."""
    z, zm = room.numbers[0], room.numbers[1]
    small_steps = 0
    for i in range(0, samples, lanes_of(m)):
        n, up, small = reversals_of_lanes(m, b, side, flat, i, up, z, zm, n)
        small_steps |= small
    return n, up, small_steps != 0


@compiled()
def close_pass(room: Any, n: int, cycles: int, flat: np.float32) -> tuple[int, int, bool]:
    """Do what ``kernels.loops.close_pass`` does."""
    z, zm, S, dm = room.numbers[0], room.numbers[1], room.numbers[2], room.numbers[3]
    z[n] = z[n + 1] = -np.inf
    kept = 0
    before, taken = 1, 0
    close_calls = 0
    for i in range(0, n, lanes_of(z)):
        kept, cycles, before, taken, close = cycles_of_lanes(z, zm, S, dm, i, n, before, taken, kept, cycles, flat)
        close_calls |= close
    return kept, cycles, close_calls != 0


def tiles_of(matrix: Singles) -> Singles:
    """Lay a matrix (n, m) out as ``multiply`` reads them: (n / 12, m, 12), filled up with zeros."""
    rows, modes = matrix.shape
    tiles = np.zeros((-(-rows // TILE), TILE, modes), np.float32)
    tiles.reshape(len(tiles) * TILE, modes)[:rows] = matrix
    return np.ascontiguousarray(tiles.transpose(0, 2, 1))


def panels_for(modes: int, samples: int) -> Singles:
    """Memory for modal coordinates as ``multiply`` reads them: (t / 32, m, 32)."""
    return np.empty((-(-samples // PANEL), modes, PANEL), np.float32)


@compiled()
def lay_out(q: Singles, panels: Singles) -> Singles:
    """Copy modal coordinates (m, t) into panels, the last one filled up with zeros; returns those in use."""
    whole = q.shape[1] // PANEL
    rest = q.shape[1] - PANEL * whole
    for mode in range(len(q)):
        for panel in range(whole):
            for j in range(PANEL):
                panels[panel, mode, j] = q[mode, PANEL * panel + j]
        if rest > 0:
            for j in range(PANEL):
                panels[whole, mode, j] = q[mode, PANEL * whole + j] if j < rest else np.float32(0)
    return panels[: whole + int(rest > 0)]


@compiled()
def multiply(tiles: Singles, panels: Singles, stress: Singles) -> None:
    """``stress[:, 1:] = tiles @ panels``; rows and columns are as many as tiles and panels."""
    for first in range(0, len(panels), CACHED):
        for tile in range(len(tiles)):
            for panel in range(first, min(first + CACHED, len(panels))):
                product_of_tile(tiles, tile, panels, panel, stress)


@compiled("contract")
def multiply_rows(tile: Singles, samples: Singles, columns: int, stress: Singles) -> None:
    """``stress[:, :columns] = tile @ samples[:, :columns]`` of a tile (h 12,) and samples (h, w) as they are.

    Up to 31 more columns of both are touched: w is that much larger.
    """
    tiles = tile.reshape(1, len(samples), TILE)
    for row in range(TILE):
        stress[row, 0] = 0.0
        for k in range(len(samples)):
            stress[row, 0] += tiles[0, k, row] * samples[k, 0]
    for panel in range(-(-(columns - 1) // PANEL)):
        product_of_tile(tiles, 0, samples, panel, stress)
