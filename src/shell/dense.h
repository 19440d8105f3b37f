// The dense blocks of a sparse factorisation, which take almost all of its time.
//
// K. Goto and R. van de Geijn, "Anatomy of High-Performance Matrix Multiplication", ACM TOMS 34 (2008):
// blocks that stay in a cache, packed so that a small tile of the result is summed up in registers. AVX2 is
// used where the processor has it. Every number is summed in the same order on each processor and with any
// number of threads, without fused multiply-add, so the bytes are the same, signs of zeros included.
#pragma once

#include <cstddef>

namespace plisse::shell {

// The choice of kernels. `plain` are those of processors without AVX2, on any processor: for tests that
// compare both.
enum class Kernels { widest, plain };
// Whether `widest` is something else than `plain` here.
bool has_wide_kernels();

// C −= A Aᵀ in the rows at and below the diagonal: C(i, j) −= Σ_p A(i, p) A(j, p) for j < columns, j ≤ i <
// rows. By columns, `a_stride` and `c_stride` numbers apart; A is rows × depth. Large ones on all cores.
void subtract_products(const double* a, std::ptrdiff_t a_stride, double* c, std::ptrdiff_t c_stride,
                       std::ptrdiff_t rows, std::ptrdiff_t columns, std::ptrdiff_t depth,
                       Kernels kernels = Kernels::widest);

// The first `width` columns of a Cholesky factor, in place: the square at the top, of which the lower half is
// read, becomes L with L Lᵀ = it, what lies below it becomes (below) L⁻ᵀ. False where the square is not
// positive definite.
bool factorise_columns(double* panel, std::ptrdiff_t stride, std::ptrdiff_t height, std::ptrdiff_t width,
                       Kernels kernels = Kernels::widest);

}  // namespace plisse::shell
