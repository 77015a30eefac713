// SPDX-License-Identifier: BSD-3-Clause
// Numbers in lanes, on registers of whatever instructions a source that includes this is compiled with. All
// names are the source's own: no two sources may share code through the linker.
#pragma once

#include <cstdint>

#ifndef LIVENS_REGISTER
#define LIVENS_REGISTER 2   // doubles in a register
#endif
#define LIVENS_INLINE inline __attribute__((always_inline))
#define LIVENS_LAMBDA __attribute__((always_inline))

namespace livens::lanes {
namespace {

template <int N>
struct Register {
    typedef double type __attribute__((vector_size(8 * N), may_alias));
};
template <>
struct Register<1> {
    typedef double type;
};

/// W doubles in registers.
template <int W>
struct Lanes {
    static constexpr int width = W, size = W < LIVENS_REGISTER ? W : LIVENS_REGISTER, count = W / size;
    using Part = typename Register<size>::type;
    Part part[count];
};

template <int W>
LIVENS_INLINE Lanes<W> load(const double* x)
{
    Lanes<W> v;
    for (int i = 0; i < v.count; ++i) v.part[i] = reinterpret_cast<const typename Lanes<W>::Part*>(x)[i];
    return v;
}

template <int W>
LIVENS_INLINE void store(double* x, const Lanes<W>& v)
{
    for (int i = 0; i < v.count; ++i) reinterpret_cast<typename Lanes<W>::Part*>(x)[i] = v.part[i];
}

template <int W>
LIVENS_INLINE typename Lanes<W>::Part spread(double x)
{
    typename Lanes<W>::Part part{};
    if constexpr (Lanes<W>::size == 1)
        part = x;
    else
        for (int i = 0; i < Lanes<W>::size; ++i) part[i] = x;
    return part;
}

template <int W>
LIVENS_INLINE Lanes<W> all(double x)
{
    Lanes<W> v;
    for (int i = 0; i < v.count; ++i) v.part[i] = spread<W>(x);
    return v;
}

#define LIVENS_OPERATOR(op)                                                   \
    template <int W>                                                          \
    LIVENS_INLINE Lanes<W> operator op(const Lanes<W>& a, const Lanes<W>& b)  \
    {                                                                         \
        Lanes<W> v;                                                           \
        for (int i = 0; i < v.count; ++i) v.part[i] = a.part[i] op b.part[i]; \
        return v;                                                             \
    }                                                                         \
    template <int W>                                                          \
    LIVENS_INLINE Lanes<W> operator op(double a, const Lanes<W>& b)           \
    {                                                                         \
        Lanes<W> v;                                                           \
        const auto s = spread<W>(a);                                          \
        for (int i = 0; i < v.count; ++i) v.part[i] = s op b.part[i];         \
        return v;                                                             \
    }
LIVENS_OPERATOR(+)
LIVENS_OPERATOR(-)
LIVENS_OPERATOR(*)
LIVENS_OPERATOR(/)
#undef LIVENS_OPERATOR

template <int W>
LIVENS_INLINE void operator+=(Lanes<W>& a, const Lanes<W>& b)
{
    a = a + b;
}
template <int W>
LIVENS_INLINE void operator-=(Lanes<W>& a, const Lanes<W>& b)
{
    a = a - b;
}

template <int W>
LIVENS_INLINE Lanes<W> root(Lanes<W> v)
{
    for (int i = 0; i < v.count; ++i) {
        if constexpr (Lanes<W>::size == 1)
            v.part[i] = __builtin_sqrt(v.part[i]);
        else
            for (int j = 0; j < v.size; ++j) v.part[i][j] = __builtin_sqrt(v.part[i][j]);
    }
    return v;
}

/// The larger of a and |b|; loses a nan.
template <int W>
LIVENS_INLINE void raise_to_size(Lanes<W>& a, const Lanes<W>& b)
{
    for (int i = 0; i < a.count; ++i) {
        typename Lanes<W>::Part size;
        if constexpr (Lanes<W>::size == 1) {
            size = __builtin_fabs(b.part[i]);
        } else {
            typedef long long Bits __attribute__((vector_size(8 * Lanes<W>::size)));
            size = (typename Lanes<W>::Part)((Bits)b.part[i] & 0x7fffffffffffffffLL);
        }
        a.part[i] = a.part[i] < size ? size : a.part[i];
    }
}

/// Lane after lane. A single one not through memory: it would be kept as an integer, too.
template <int W, class Action>
LIVENS_INLINE void for_lanes(const Lanes<W>& v, Action&& action)
{
    if constexpr (W == 1) {
        action(v.part[0]);
    } else {
        double x[W];
        __builtin_memcpy(x, &v, sizeof x);
        for (int i = 0; i < W; ++i) action(x[i]);
    }
}

template <int W>
double largest(const Lanes<W>& v)
{
    double size = 0;
    for_lanes(v, [&](double x) LIVENS_LAMBDA { size = size < x ? x : size; });
    return size;
}

template <int W>
double sum(const Lanes<W>& v)
{
    double s = 0;
    for_lanes(v, [&](double x) LIVENS_LAMBDA { s += x; });
    return s;
}

/// Lane 0 becomes that of the start, behind which there must be three numbers more.
template <int W>
LIVENS_INLINE Lanes<W> with_start(Lanes<W> v, const double* start)
{
    if constexpr (Lanes<W>::size == 1) {
        v.part[0] = *start;
    } else if constexpr (Lanes<W>::size == 4) {   // in one instruction
        typename Lanes<W>::Part from;
        __builtin_memcpy(&from, start, sizeof from);
        v.part[0] = __builtin_shufflevector(v.part[0], from, 4, 1, 2, 3);
    } else {
        v.part[0][0] = *start;
    }
    return v;
}

template <int W>
struct Three {
    Lanes<W> x[3];
};

template <int W>
LIVENS_INLINE Lanes<W> dot(const Three<W>& a, const Three<W>& b)
{
    return a.x[0] * b.x[0] + a.x[1] * b.x[1] + a.x[2] * b.x[2];
}

/// A quantity at the columns, at the rows, whose lane 0 is the start.
template <int W, bool rows>
struct At {
    const double *nodes, *start;
    LIVENS_INLINE Lanes<W> operator[](int i) const
    {
        const Lanes<W> v = load<W>(nodes + static_cast<std::int64_t>(i) * W);
        if constexpr (rows) return with_start(v, start + i);
        return v;
    }
    LIVENS_INLINE Three<W> column(int i) const { return {{(*this)[i], (*this)[i + 1], (*this)[i + 2]}}; }
};

template <int W>
LIVENS_INLINE Lanes<W> times_here(const double* x, const double* m)
{
    Lanes<W> s = x[0] * load<W>(m);
    for (int l = 1; l < W; ++l) s += x[l] * load<W>(m + l * W);
    return s;
}
template <int W>
__attribute__((noinline)) Lanes<W> times_apart(const double* x, const double* m)
{
    return times_here<W>(x, m);
}

/// sum_l x_l m_l over lanes l, m an array of lanes. Many lanes are many instructions: in one place.
template <int W>
LIVENS_INLINE Lanes<W> times(const double* x, const double* m)
{
    if constexpr (W > 8)
        return times_apart<W>(x, m);
    else
        return times_here<W>(x, m);
}

}   // namespace
}   // namespace livens::lanes
