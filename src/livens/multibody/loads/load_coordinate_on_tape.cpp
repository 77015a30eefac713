// SPDX-License-Identifier: BSD-3-Clause
// Coordinates of loads on a tape. Their forms are sums of inner products of material vectors, of which a
// joint's have one or two (docs/theory.md, "Without a tangent",
// Loads in lanes).
#include <cmath>

#include "livens/base/elementary.h"
#include "livens/multibody/loads/load_coordinate.h"

namespace livens {

namespace {

/// Calls act(u, v) for the terms of A = sum u v^T, by elimination with the largest pivots: entries that are
/// zero stay so, and a form of two vectors has one term.
template <int Rows, int Cols, class Act>
void for_rank_one_terms(Matrix<Rows, Cols> A, const Act& act)
{
    constexpr double rounding = 1e-15;   // of the largest: nothing but what is left of it
    double first = 0;
    for (int term = 0; term < (Rows < Cols ? Rows : Cols); ++term) {
        int row = 0, col = 0;
        for (int i = 0; i < Rows; ++i)
            for (int j = 0; j < Cols; ++j)
                if (std::abs(A(i, j)) > std::abs(A(row, col))) row = i, col = j;
        const double pivot = A(row, col);
        if (term == 0) first = std::abs(pivot);
        if (std::abs(pivot) <= rounding * first) return;
        const Matrix<Rows, 1> u = A.column(col);
        Matrix<Cols, 1> v{};
        for (int j = 0; j < Cols; ++j) v[j] = A(row, j) / pivot;
        for (int j = 0; j < Cols; ++j)
            for (int i = 0; i < Rows; ++i) A(i, j) = i == row || j == col ? 0 : A(i, j) - u[i] * v[j];
        act(u, v);
    }
}

/// Calls of_two(side, u, side, v) for terms (X u) . (X v) of a form, and of_one(side, w, c) for c . X w.
template <class OfTwo, class OfOne>
void for_arms(const PairForm& form, const std::array<int, 2>& places, bool has_two, const OfTwo& of_two,
              const OfOne& of_one)
{
    const int j = places[0], i = places[1];
    const auto add = [&](int side_u, int side_v, const Matrix4& C) {
        for_rank_one_terms(C, [&](const Vector4& u, const Vector4& v) { of_two(side_u, u, side_v, v); });
    };
    const auto add_one = [&](int side, const Matrix34& B) {
        for_rank_one_terms(B, [&](const Vector3& c, const Vector4& w) { of_one(side, w, c); });
    };
    if (has_two) {
        add(i, j, form.c_ij);
        add(i, i, 0.5 * form.c_ii);
        add_one(i, form.b_i);
    }
    add(j, j, 0.5 * form.c_jj);
    add_one(j, form.b_j);
}

struct FormOnTape {
    const PairForm& form;
    std::array<int, 2> places;
    bool has_two;
    LoadTape& tape;

    static void add(TapeNumber& sum, TapeNumber term) { sum = sum.place < 0 ? term : sum + term; }

    TapeNumber value() const
    {
        TapeNumber sum{&tape};
        for_arms(
            form, places, has_two,
            [&](int side_u, const Vector4& u, int side_v, const Vector4& v) {
                add(sum, dot(tape.arm(side_u, u), tape.arm(side_v, v)));
            },
            [&](int side, const Vector4& w, const Vector3& c) {
                add(sum, dot(tape.vector(c), tape.arm(side, w)));
            });
        return sum.place < 0 ? tape.number(form.c) : form.c + sum;
    }
    TapeNumber rate() const
    {
        TapeNumber sum{&tape};
        for_arms(
            form, places, has_two,
            [&](int side_u, const Vector4& u, int side_v, const Vector4& v) {
                add(sum, dot(tape.arm(side_u, u, true), tape.arm(side_v, v)));
                add(sum, dot(tape.arm(side_u, u), tape.arm(side_v, v, true)));
            },
            [&](int side, const Vector4& w, const Vector3& c) {
                add(sum, dot(tape.vector(c), tape.arm(side, w, true)));
            });
        return sum.place < 0 ? tape.number(0) : sum;
    }
    void pull(TapeNumber Q) const
    {
        for_arms(
            form, places, has_two,
            [&](int side_u, const Vector4& u, int side_v, const Vector4& v) {
                tape.pull(side_u, u, Q, tape.arm(side_v, v));
                tape.pull(side_v, v, Q, tape.arm(side_u, u));
            },
            [&](int side, const Vector4& w, const Vector3& c) { tape.pull(side, w, Q, tape.vector(c)); });
    }
};

}   // namespace

TapeNumber LoadCoordinate::value(LoadTape& tape) const
{
    const auto form = [&](std::size_t k) {
        return FormOnTape{coordinate_.forms[k], places_, n_ == 2, tape}.value();
    };
    if (!coordinate_.is_angle()) return offset_ + form(0);
    const TapeNumber angle = function_of(&arc_tangent, form(1), form(0));
    return offset_ + (angle_ >= 0 ? tape.unwrapped(angle, angle_) : angle);
}

TapeNumber LoadCoordinate::rate(LoadTape& tape) const
{
    const auto form = [&](std::size_t k) { return FormOnTape{coordinate_.forms[k], places_, n_ == 2, tape}; };
    if (!coordinate_.is_angle()) return form(0).rate();
    const TapeNumber c = form(0).value(), s = form(1).value();
    return (c * form(1).rate() - s * form(0).rate()) / (c * c + s * s);
}

/// Of an angle dq = (c ds - s dc) / (c^2 + s^2).
void LoadCoordinate::pull(LoadTape& tape, TapeNumber Q) const
{
    const auto form = [&](std::size_t k) { return FormOnTape{coordinate_.forms[k], places_, n_ == 2, tape}; };
    if (!coordinate_.is_angle()) return form(0).pull(Q);
    const TapeNumber c = form(0).value(), s = form(1).value();
    const TapeNumber by_r2 = Q.place < 0 ? inverse(c * c + s * s) : Q / (c * c + s * s);
    form(1).pull(c * by_r2);
    form(0).pull(-(s * by_r2));
}

}   // namespace livens
