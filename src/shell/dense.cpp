#include "shell/dense.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

namespace plisse::shell {
namespace {

using Index = std::ptrdiff_t;

#define PLISSE_INLINE [[gnu::always_inline]] inline
#if defined(__x86_64__)
#define PLISSE_AVX2 __attribute__((target("avx2")))
#endif

constexpr Index depth_block = 192;  // depth of a packed block
constexpr Index row_block = 128;    // rows of A that stay in the second cache: 192 kB
constexpr Index column_block = 48;  // columns of a panel that are factorised before the rest is updated
constexpr Index strip_rows = 64;    // rows below them at a time: 24 kB

// Tiles of Vectors·Lanes rows and Columns columns.
template <int Lanes, int Vectors, int Columns>
struct Tile {
  typedef double Vector __attribute__((vector_size(Lanes * sizeof(double))));
  static constexpr Index rows = Lanes * Vectors, columns = Columns;

  PLISSE_INLINE static void load(Vector& v, const double* from) { std::memcpy(&v, from, sizeof v); }
  PLISSE_INLINE static void store(double* to, const Vector& v) { std::memcpy(to, &v, sizeof v); }

  // into −= Σ_p a_p b_pᵀ, both packed p by p.
  PLISSE_INLINE static void subtract(const double* a, const double* b, Index depth, double* into,
                                     Index stride) {
    Vector sum[Columns][Vectors];
    for (int j = 0; j < Columns; ++j)
      for (int i = 0; i < Vectors; ++i) sum[j][i] = Vector{};
    for (Index p = 0; p < depth; ++p, a += rows, b += columns) {
      Vector left[Vectors];
      for (int i = 0; i < Vectors; ++i) load(left[i], a + i * Lanes);
#pragma GCC unroll 8
      for (int j = 0; j < Columns; ++j)
#pragma GCC unroll 4
        for (int i = 0; i < Vectors; ++i) sum[j][i] += left[i] * b[j];
    }
    for (int j = 0; j < Columns; ++j)
      for (int i = 0; i < Vectors; ++i) {
        Vector old;
        load(old, into + j * stride + i * Lanes);
        store(into + j * stride + i * Lanes, old - sum[j][i]);
      }
  }
};

// Both packed; the part at and below the diagonal of rows first … last − 1.
template <typename T>
PLISSE_INLINE void subtract_rows(const double* left, const double* right, Index depth, double* c,
                                 Index stride, Index rows, Index columns, Index first, Index last) {
  const Index end = std::min(columns, last);
  for (Index j = 0; j < end; j += T::columns)
    for (Index i = std::max(first, j / T::rows * T::rows); i < last; i += T::rows) {
      const double *a = left + i * depth, *b = right + j * depth;
      if (i >= j + T::columns - 1 && i + T::rows <= rows && j + T::columns <= columns) {
        T::subtract(a, b, depth, c + j * stride + i, stride);
        continue;
      }
      // Over an edge: in a copy, so that each number is made as it is inside. (To add what comes of zeros
      // would turn −0 into 0, and whether a number lies in such a tile depends on the tile's size.)
      double whole[T::rows * T::columns] = {};
      const Index end_column = std::min(j + T::columns, columns), end_row = std::min(i + T::rows, rows);
      for (Index column = j; column < end_column; ++column)
        for (Index row = std::max(i, column); row < end_row; ++row)
          whole[(column - j) * T::rows + row - i] = c[column * stride + row];
      T::subtract(a, b, depth, whole, T::rows);
      for (Index column = j; column < end_column; ++column)
        for (Index row = std::max(i, column); row < end_row; ++row)
          c[column * stride + row] = whole[(column - j) * T::rows + row - i];
    }
}

// Rows of A in bands of `band`, p by p, the last filled up with zeros.
void pack(const double* a, Index stride, Index rows, Index depth, Index band, double* packed) {
  for (Index i = 0; i < rows; i += band) {
    const Index here = std::min(band, rows - i);
    for (Index p = 0; p < depth; ++p, packed += band) {
      for (Index k = 0; k < here; ++k) packed[k] = a[p * stride + i + k];
      for (Index k = here; k < band; ++k) packed[k] = 0;
    }
  }
}

Index rounded_up(Index count, Index band) {
  return (count + band - 1) / band * band;
}

template <typename T, typename Rows>
void subtract_blocks(const double* a, Index a_stride, double* c, Index c_stride, Index rows, Index columns,
                     Index depth, const Rows& subtract) {
  thread_local std::vector<double> left_buffer, right_buffer;
  // While this thread waits it must not take other work, which would use the same buffers.
  std::vector<double> left, right;
  left.swap(left_buffer);
  right.swap(right_buffer);
  const bool large = static_cast<double>(rows) * static_cast<double>(columns) *
                         static_cast<double>(std::min(depth, depth_block)) >
                     4e6;
  for (Index p = 0; p < depth; p += depth_block) {
    const Index here = std::min(depth_block, depth - p);
    left.resize(static_cast<std::size_t>(rounded_up(rows, T::rows) * here));
    right.resize(static_cast<std::size_t>(rounded_up(columns, T::columns) * here));
    pack(a + p * a_stride, a_stride, rows, here, T::rows, left.data());
    pack(a + p * a_stride, a_stride, columns, here, T::columns, right.data());
    const auto block = [&](Index k) {
      subtract(left.data(), right.data(), here, c, c_stride, rows, columns, k * row_block,
               std::min(rows, (k + 1) * row_block));
    };
    const Index blocks = (rows + row_block - 1) / row_block;
    if (large) {
      tbb::this_task_arena::isolate([&] { tbb::parallel_for(Index{0}, blocks, block); });
    } else {
      for (Index k = 0; k < blocks; ++k) block(k);
    }
  }
  left.swap(left_buffer);
  right.swap(right_buffer);
}

PLISSE_INLINE bool factorise_square(double* square, Index stride, Index width) {
  for (Index j = 0; j < width; ++j) {
    double* column = square + j * stride;
    for (Index p = 0; p < j; ++p) {
      const double* other = square + p * stride;
      const double factor = other[j];
      for (Index i = j; i < width; ++i) column[i] -= other[i] * factor;
    }
    if (!(column[j] > 0) || !std::isfinite(column[j])) return false;
    const double root = std::sqrt(column[j]), inverse = 1 / root;
    column[j] = root;
    for (Index i = j + 1; i < width; ++i) column[i] *= inverse;
  }
  return true;
}

// (below) L⁻ᵀ for some rows of what lies below.
PLISSE_INLINE void solve_rows(const double* square, double* below, Index stride, Index rows, Index width) {
  for (Index j = 0; j < width; ++j) {
    double* column = below + j * stride;
    for (Index p = 0; p < j; ++p) {
      const double* other = below + p * stride;
      const double factor = square[p * stride + j];
      for (Index i = 0; i < rows; ++i) column[i] -= other[i] * factor;
    }
    const double inverse = 1 / square[j * stride + j];
    for (Index i = 0; i < rows; ++i) column[i] *= inverse;
  }
}

PLISSE_INLINE bool factorise_block(double* panel, Index stride, Index height, Index width) {
  if (!factorise_square(panel, stride, width)) return false;
  for (Index i = width; i < height; i += strip_rows)
    solve_rows(panel, panel + i, stride, std::min(strip_rows, height - i), width);
  return true;
}

using Plain = Tile<2, 2, 4>;

void subtract_rows_plain(const double* left, const double* right, Index depth, double* c, Index stride,
                         Index rows, Index columns, Index first, Index last) {
  subtract_rows<Plain>(left, right, depth, c, stride, rows, columns, first, last);
}

bool factorise_block_plain(double* panel, Index stride, Index height, Index width) {
  return factorise_block(panel, stride, height, width);
}

#ifdef PLISSE_AVX2
using Wide = Tile<4, 2, 6>;

PLISSE_AVX2 void subtract_rows_wide(const double* left, const double* right, Index depth, double* c,
                                    Index stride, Index rows, Index columns, Index first, Index last) {
  subtract_rows<Wide>(left, right, depth, c, stride, rows, columns, first, last);
}

PLISSE_AVX2 bool factorise_block_wide(double* panel, Index stride, Index height, Index width) {
  return factorise_block(panel, stride, height, width);
}

#endif

bool factorise_some(double* panel, Index stride, Index height, Index width,
                    [[maybe_unused]] Kernels kernels) {
#ifdef PLISSE_AVX2
  if (kernels == Kernels::widest && has_wide_kernels())
    return factorise_block_wide(panel, stride, height, width);
#endif
  return factorise_block_plain(panel, stride, height, width);
}

}  // namespace

bool has_wide_kernels() {
#ifdef PLISSE_AVX2
  static const bool has = __builtin_cpu_supports("avx2");
  return has;
#else
  return false;
#endif
}

void subtract_products(const double* a, Index a_stride, double* c, Index c_stride, Index rows, Index columns,
                       Index depth, [[maybe_unused]] Kernels kernels) {
  if (rows <= 0 || columns <= 0 || depth <= 0) return;
#ifdef PLISSE_AVX2
  if (kernels == Kernels::widest && has_wide_kernels())
    return subtract_blocks<Wide>(a, a_stride, c, c_stride, rows, columns, depth, subtract_rows_wide);
#endif
  subtract_blocks<Plain>(a, a_stride, c, c_stride, rows, columns, depth, subtract_rows_plain);
}

bool factorise_columns(double* panel, Index stride, Index height, Index width, Kernels kernels) {
  for (Index j = 0; j < width; j += column_block) {
    const Index here = std::min(column_block, width - j);
    double* corner = panel + j * stride + j;
    if (!factorise_some(corner, stride, height - j, here, kernels)) return false;
    subtract_products(corner + here, stride, corner + here * stride + here, stride, height - j - here,
                      width - j - here, here, kernels);
  }
  return true;
}

}  // namespace plisse::shell
