// SPDX-License-Identifier: BSD-3-Clause
// The same of SparseLU, in its factors while they grow: Eigen's own frees the old array before it asks for
// the new one, and where it gets none it frees it once more: a crash where std::bad_alloc is due. It also
// copies twice.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <new>

namespace Eigen::internal {

/// Returns as Eigen's does: -1 makes memInit ask for less.
template <typename Vector>
Index grow(Vector& vector, Index& length, Index n_used, bool keep_length, Index& n_expansions)
{
    const bool first = n_expansions == 0;
    const Index wanted = first || keep_length ? length : std::max(length + 1, length + length / 2);
    if (first) vector.resize(0);   // of the factorisation before
    try {
        Vector grown(wanted);
        grown.head(n_used) = vector.head(n_used);
        vector.swap(grown);
    } catch (const std::bad_alloc&) {
        if (first) return -1;
        throw;
    }
    length = wanted;
    if (!first) ++n_expansions;
    return 0;
}

/// For what a matrix with entries double and this type of indices keeps: T.
#define LIVENS_EIGEN_EXPAND(INDEX, T)                                                                      \
    template <>                                                                                            \
    template <>                                                                                            \
    inline Index SparseLUImpl<double, INDEX>::expand(Matrix<T, Dynamic, 1>& vector, Index& length,         \
                                                     Index n_used, Index keep_length, Index& n_expansions) \
    {                                                                                                      \
        return grow(vector, length, n_used, keep_length != 0, n_expansions);                               \
    }

LIVENS_EIGEN_EXPAND(int, double)
LIVENS_EIGEN_EXPAND(int, int)
LIVENS_EIGEN_EXPAND(std::int64_t, double)
LIVENS_EIGEN_EXPAND(std::int64_t, std::int64_t)

#undef LIVENS_EIGEN_EXPAND

}   // namespace Eigen::internal

namespace Eigen {

/// Where columns are exchanged. Eigen's does not look whether it got what it asked for.
template <>
inline void SparseMatrix<double, ColMajor, int>::uncompress()
{
    if (m_innerNonZeros != nullptr) return;
    m_innerNonZeros = static_cast<int*>(std::malloc(static_cast<std::size_t>(m_outerSize) * sizeof(int)));
    if (m_innerNonZeros == nullptr) internal::throw_std_bad_alloc();
    for (Index i = 0; i < m_outerSize; ++i) m_innerNonZeros[i] = m_outerIndex[i + 1] - m_outerIndex[i];
}

}   // namespace Eigen
