"""The counter in single precision: superposition, counting and damage in one pass over time.

================= ====================================================================================================
prepare           the modal coordinates of a record in single precision, once for all points
count             what is counted in single precision, what again in double precision, and what the sums mean
kernels.over_time the loop over chunks of time and, in each of them, over some points at a time
kernels.product   the stress of some points in a chunk: modal stress times modal coordinates
kernels.loops     one surface in a chunk: reversals, closed ranges, and the rest at the end of the record
kernels.doubt     the same where rounding may decide, with stresses in double precision
kernels.power     S^k and I(r)^(-k/m) of many ranges, and sums over them
kernels.simd      the steps of ``loops`` and ``product`` in vector instructions; without this file they do it themselves
kernels.state     what is known between two chunks, and the work space
================= ====================================================================================================
"""
