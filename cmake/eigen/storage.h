// SPDX-License-Identifier: BSD-3-Clause
// Eigen's matrices, where memory ends: DenseStorage::resize() (Eigen 3.4) frees what it holds before it asks
// for more, and where it gets nothing, its destructor frees the same once more: heap damage where
// std::bad_alloc is due. These stand in for it, for every type of entries that livens uses, in the namespace
// that is livens' alone (cmake/rooms.cmake). Included behind every header of Eigen's by the headers beside
// this one, which are found before Eigen's own.
#pragma once

namespace Eigen {

/// DIMENSIONS: what a change of size sets where the number of entries stays.
#define LIVENS_EIGEN_RESIZE(T, ROWS, COLUMNS, OPTIONS, SIZE, DIMENSIONS)               \
    template <>                                                                        \
    EIGEN_STRONG_INLINE void DenseStorage<T, Dynamic, ROWS, COLUMNS, OPTIONS>::resize( \
        Index size, [[maybe_unused]] Index rows, [[maybe_unused]] Index columns)       \
    {                                                                                  \
        if (size == (SIZE)) {                                                          \
            DIMENSIONS;                                                                \
            return;                                                                    \
        }                                                                              \
        {                                                                              \
            DenseStorage old;                                                          \
            swap(old);                                                                 \
        }                                                                              \
        DenseStorage made(size, rows, columns);                                        \
        swap(made);                                                                    \
    }
#define LIVENS_EIGEN_RESIZE_ALL(T)                                                                      \
    LIVENS_EIGEN_RESIZE(T, Dynamic, Dynamic, ColMajor, m_rows* m_cols, m_rows = rows; m_cols = columns) \
    LIVENS_EIGEN_RESIZE(T, Dynamic, Dynamic, RowMajor, m_rows* m_cols, m_rows = rows; m_cols = columns) \
    LIVENS_EIGEN_RESIZE(T, Dynamic, 1, ColMajor, m_rows, m_rows = rows)                                 \
    LIVENS_EIGEN_RESIZE(T, 1, Dynamic, RowMajor, m_cols, m_cols = columns)

LIVENS_EIGEN_RESIZE_ALL(double)
LIVENS_EIGEN_RESIZE_ALL(int)
LIVENS_EIGEN_RESIZE_ALL(long)
LIVENS_EIGEN_RESIZE_ALL(long long)

#undef LIVENS_EIGEN_RESIZE_ALL
#undef LIVENS_EIGEN_RESIZE

}   // namespace Eigen
