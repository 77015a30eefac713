// SPDX-License-Identifier: BSD-3-Clause
// Coordinates of loads on a tape. Their forms are sums of inner products of material vectors, of which a
// joint's have one or two (docs/theory.md, "Without a tangent",
// Loads in lanes).
#include <array>
#include <cmath>
#include <limits>
#include <vector>

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

/// The value where the square of a cosine tells that an angle is known; see is_known().
double known_by_square(double value, double square)
{
    return square >= 1e-4 ? value : std::numeric_limits<double>::quiet_NaN();
}

double known_by_angle(double value, double angle)
{
    return angle <= 3.05 ? value : std::numeric_limits<double>::quiet_NaN();
}

double arc_sine_of(double s, double) { return arc_sine(s); }

}   // namespace

/// coordinate_at() on a tape: theory.md, "Coordinates of joints".
struct LoadCoordinate::OnTape {
    const LoadCoordinate& of;
    LoadTape& tape;

    FormOnTape form(std::size_t k) const { return {of.coordinate_.forms[k], of.places_, of.n_ == 2, tape}; }
    TapeNumber q(std::size_t k) const { return form(k).value(); }
    TapeNumber square() const { return q(0) * q(0) + q(1) * q(1); }
    /// Of an arc sine.
    TapeNumber square_of_cosine() const { return 1.0 + -(q(0) * q(0)); }
    /// Of a rotation vector: the square of its sine, and its length.
    TapeNumber sigma() const { return q(0) * q(0) + q(1) * q(1) + q(2) * q(2); }
    TapeNumber length() const { return function_of(&arc_tangent, root(sigma()), q(3)); }

    TapeNumber value() const
    {
        switch (of.coordinate_.kind) {
        case CoordinateKind::displacement:
            return of.offset_ + q(0);
        case CoordinateKind::angle:
            return of.offset_ + turned();
        case CoordinateKind::outer_angle:
            return of.offset_ + function_of(&known_by_square, turned(), square());
        case CoordinateKind::arc_sine:
            return of.offset_ +
                   function_of(&known_by_square, function_of(&arc_sine_of, q(0), q(0)), square_of_cosine());
        case CoordinateKind::rotation_component:
            return of.offset_ + function_of(&known_by_angle, turn_of_sine(sigma(), q(3))[0] * q(0), length());
        case CoordinateKind::rotation_angle:
            break;
        }
        return of.offset_ + function_of(&known_by_angle, length(), length());
    }
    TapeNumber turned() const
    {
        const TapeNumber angle = function_of(&arc_tangent, q(1), q(0));
        return of.angle_ >= 0 ? tape.unwrapped(angle, of.angle_) : angle;
    }

    /// By each form, of what does not count turns.
    std::vector<TapeNumber> gradient() const
    {
        if (of.coordinate_.kind == CoordinateKind::arc_sine)
            return {tape.number(1) / root(square_of_cosine())};
        const TapeNumber r2 = sigma() + q(3) * q(3);
        if (of.coordinate_.kind == CoordinateKind::rotation_component) {
            const TapeVector turn = turn_of_sine(sigma(), q(3));
            const TapeNumber along = turn[1] * q(0);
            return {turn[0] + along * q(0), along * q(1), along * q(2), -(q(0) / r2)};
        }
        const TapeNumber S = root(sigma()), by_s = q(3) / r2 * inverse(S);
        return {by_s * q(0), by_s * q(1), by_s * q(2), -(S / r2)};
    }
};

TapeNumber LoadCoordinate::value(LoadTape& tape) const { return OnTape{*this, tape}.value(); }

TapeNumber LoadCoordinate::rate(LoadTape& tape) const
{
    const OnTape on{*this, tape};
    if (!coordinate_.is_angle()) return on.form(0).rate();
    if (coordinate_.counts_turns()) {
        const TapeNumber c = on.q(0), s = on.q(1);
        return (c * on.form(1).rate() - s * on.form(0).rate()) / (c * c + s * s);
    }
    const std::vector<TapeNumber> by = on.gradient();
    TapeNumber sum = by[0] * on.form(0).rate();
    for (std::size_t k = 1; k < by.size(); ++k) sum = sum + by[k] * on.form(k).rate();
    return sum;
}

/// dq = sum_k dq/dq_k dq_k; of an angle (c ds - s dc) / (c^2 + s^2).
void LoadCoordinate::pull(LoadTape& tape, TapeNumber Q) const
{
    const OnTape on{*this, tape};
    if (!coordinate_.is_angle()) return on.form(0).pull(Q);
    if (coordinate_.counts_turns()) {
        const TapeNumber c = on.q(0), s = on.q(1);
        const TapeNumber by_r2 = Q.place < 0 ? inverse(c * c + s * s) : Q / (c * c + s * s);
        on.form(1).pull(c * by_r2);
        return on.form(0).pull(-(s * by_r2));
    }
    const std::vector<TapeNumber> by = on.gradient();
    for (std::size_t k = by.size(); k-- > 0;) on.form(k).pull(Q.place < 0 ? by[k] : Q * by[k]);
}

}   // namespace livens
