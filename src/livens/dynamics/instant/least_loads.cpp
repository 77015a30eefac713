// SPDX-License-Identifier: BSD-3-Clause
// The least sum by the wrenches on bodies: lambda = M^-1 G y, of which y is found by a factor of G^T M^-1 G.
// M has a block for each joint: products of its rows in reactions (docs/theory.md, "Least reactions").
#include "livens/dynamics/instant/least_loads.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "livens/solvers/short_rows.h"

namespace livens {

namespace {

constexpr int most_rows_of_joint = 6;                    // whose reactions may say something of their own
constexpr double most_work_of_factor = 2e5;              // of a factor
constexpr double alike_rows = 1e-10;                     // of a joint: squared pivot
constexpr double free_pivot = 1e-9, held_pivot = 1e-6;   // squared
constexpr double most_of_second_pass = 1e-8;   // by the second pass, which leaves the square of that

/// L of L L^T, row by row; the smallest pivot over the row's own square.
double factorise_square(int n, double* a)
{
    double smallest = 1;
    for (int i = 0; i < n; ++i) {
        double* row = a + i * n;
        for (int k = 0; k < i; ++k) {
            double sum = row[k];
            for (int m = 0; m < k; ++m) sum -= row[m] * a[k * n + m];
            row[k] = sum / a[k * n + k];
        }
        double pivot = row[i];
        for (int m = 0; m < i; ++m) pivot -= row[m] * row[m];
        if (!(pivot > 0)) return 0;
        smallest = std::min(smallest, pivot / row[i]);
        row[i] = std::sqrt(pivot);
    }
    return smallest;
}

/// A vector of a body's own coordinates, in space.
Vector3 in_space(const Matrix34& X, const Vector3& v)
{
    return v[0] * X.column(1) + v[1] * X.column(2) + v[2] * X.column(3);
}

/// to += factor x, six numbers.
inline void add_scaled(double factor, const double* x, double* to)
{
    typedef double Two __attribute__((vector_size(16)));
    for (int i = 0; i < 6; i += 2) {
        Two a, b;
        std::memcpy(&a, x + i, sizeof a);
        std::memcpy(&b, to + i, sizeof b);
        b += factor * a;
        std::memcpy(to + i, &b, sizeof b);
    }
}

}   // namespace

/// Poles are the means of the bodies' joint points, as where rank is judged.
LeastLoads::LeastLoads(const Model& model, const RowTables& rows, int n_independent)
    : model_(model), tables_(rows), n_independent_(n_independent), length_(model.length()),
      poles_(static_cast<std::size_t>(model.n_bodies()))
{
    std::vector<int> n_points(poles_.size(), 0);
    const auto mean = [&](int body, const Vector3& at) {
        if (body != world) poles_[body] += (1.0 / ++n_points[body]) * (at - poles_[body]);
    };
    for (const Joint& joint : model.joints()) {
        mean(joint.first, joint.point_first);
        mean(joint.second, joint.point_second);
    }
    for (int j = 0; j < static_cast<int>(model.joints().size()); ++j) parts_.push_back(part_of(j));
    find_profile();
    lambda_.resize(static_cast<std::size_t>(model.n_rows()));
}

LeastLoads::Part LeastLoads::part_of(int joint)
{
    Part part{};
    part.first_row = model_.first_row(joint);
    part.n_rows = static_cast<int>(model_.joints()[joint].rows.size());
    for (int r = part.first_row; r < part.first_row + part.n_rows; ++r)
        for (const int body : tables_[static_cast<std::size_t>(r)].bodies)
            if (std::ranges::find(part.bodies, body) == part.bodies.end()) part.bodies.push_back(body);
    std::ranges::sort(part.bodies);
    const auto n = static_cast<std::size_t>(part.n_rows);
    part.reactions.resize(6 * n);
    part.square.resize(n * n);
    part.loads.resize(6 * n * part.bodies.size());
    part.scaled.resize(part.loads.size());
    part.sums.resize(n);
    part.poles.resize(part.bodies.size());
    serves_ = serves_ && part.n_rows <= most_rows_of_joint;
    return part;
}

/// A line begins at the first body that a joint ties to its own: outside of this profile the factor has no
/// fill. Where even that is too much work, nothing is served.
void LeastLoads::find_profile()
{
    const int n = 6 * model_.n_bodies();
    first_.resize(static_cast<std::size_t>(n));
    for (int i = 0; i < n; ++i) first_[i] = i - i % 6;
    for (const Part& part : parts_)
        for (const int body : part.bodies)
            for (int i = 6 * body; i < 6 * body + 6; ++i)
                first_[i] = std::min(first_[i], 6 * part.bodies.front());
    int size = 0;
    double work = 0;
    for (int i = 0; i < n; ++i) {
        const int width = i + 1 - first_[i];
        begin_.push_back(size - first_[i]);
        size += width;
        work += 0.5 * width * width;
        serves_ = serves_ && work < most_work_of_factor;
        if (!serves_) return;
    }
    matrix_.resize(static_cast<std::size_t>(size));
    push_.resize(static_cast<std::size_t>(n));
    left_ = y_ = push_;
}

const Reaction* LeastLoads::find(double t, std::span<const Matrix34> X, std::span<const double> multipliers)
{
    if (!serves_) return nullptr;
    std::ranges::fill(matrix_, 0.0);
    for (std::size_t j = 0; j < parts_.size(); ++j) {
        Part& part = parts_[j];
        form(model_.joints()[j], {t}, X, part);
        if (part.n_rows > 0 && !(factorise_square(part.n_rows, part.square.data()) > alike_rows))
            return nullptr;
        add(part);
    }
    if (!factorise()) return nullptr;
    const std::size_t n = lambda_.size(), n_sets = n > 0 ? multipliers.size() / n : 0;
    found_.resize(n_sets * parts_.size());
    for (std::size_t set = 0; set < n_sets; ++set) {
        const auto one = multipliers.subspan(set * n, n);
        Reaction* reactions = found_.data() + set * parts_.size();
        if (set > 0 && std::ranges::equal(one, multipliers.first(n)))
            std::copy_n(found_.data(), parts_.size(), reactions);
        else if (!find_set(one.data(), reactions))
            return nullptr;
    }
    return found_.data();
}

/// Reactions, loads and products of a joint's rows.
void LeastLoads::form(const Joint& joint, Instant at, std::span<const Matrix34> X, Part& part) const
{
    const int n = part.n_rows, n_bodies = static_cast<int>(part.bodies.size());
    std::ranges::fill(part.reactions, 0.0);
    std::ranges::fill(part.loads, 0.0);
    double g[RowTables::gradient_size];
    Vector3 point{};   // from the body's origin, in space, as poles are
    for (int b = 0; b < n_bodies; ++b) part.poles[b] = in_space(X[part.bodies[b]], poles_[part.bodies[b]]);
    if (joint.second != world) point = in_space(X[joint.second], joint.point_second);
    for (int r = 0; r < n; ++r) {
        const RowTable& row = tables_[static_cast<std::size_t>(part.first_row + r)];
        tables_.gradient(part.first_row + r, at, X.data()->data(), g);
        for (int side = 0; side < row.n_sides; ++side) {
            const int body = row.bodies[side];
            const double* of_body = g + 12 * side;
            Vector3 force{}, moment{};   // about the body's origin
            for (const int a : row.columns[side]) {
                const Vector3 column{of_body[a], of_body[a + 1], of_body[a + 2]};
                if (a == 0)
                    force = column;
                else
                    moment += cross(X[body].column(a / 3), column);
            }
            const auto put_about = [&](const Vector3& pole, double sign, double* to) {
                const Vector3 about = (sign / length_) * (moment - cross(pole, force));
                for (int i = 0; i < 3; ++i) to[i] = sign * force[i], to[3 + i] = about[i];
            };
            const auto place = std::ranges::find(part.bodies, body) - part.bodies.begin();
            put_about(part.poles[place], 1, part.loads.data() + 6 * (r * n_bodies + place));
            if (body == joint.second) put_about(point, -1, part.reactions.data() + 6 * r);
        }
    }
    for (int r = 0; r < n; ++r)
        for (int k = 0; k <= r; ++k) {
            double sum = 0;
            for (int i = 0; i < 6; ++i) sum += part.reactions[6 * r + i] * part.reactions[6 * k + i];
            part.square[r * n + k] = sum;
        }
}

/// What a joint adds to G^T M^-1 G.
void LeastLoads::add(Part& part)
{
    const int n = part.n_rows, n_bodies = static_cast<int>(part.bodies.size()), n_columns = 6 * n_bodies;
    part.scaled = part.loads;
    for (int r = 0; r < n; ++r)
        for (int b = 0; b < n_bodies; ++b) {
            double six[6];
            double* const to = part.scaled.data() + r * n_columns + 6 * b;
            std::copy_n(to, 6, six);
            for (int k = 0; k < r; ++k)
                add_scaled(-part.square[r * n + k], part.scaled.data() + k * n_columns + 6 * b, six);
            const double inverse = 1 / part.square[r * n + r];
            for (int i = 0; i < 6; ++i) to[i] = inverse * six[i];
        }
    for (int b = 0; b < n_bodies; ++b)
        for (int a = 0; a <= b; ++a)
            for (int i = 0; i < 6; ++i) {
                double sums[6] = {};
                const double* scaled = part.scaled.data();
                for (int r = 0; r < n; ++r, scaled += n_columns)
                    add_scaled(scaled[6 * b + i], scaled + 6 * a, sums);
                double* to = line(6 * part.bodies[b] + i) + 6 * part.bodies[a];
                for (int c = 0; c < (a < b ? 6 : i + 1); ++c) to[c] += sums[c];
            }
}

/// L of L L^T, where lines of what is free are zero. False: what is free is not clear.
bool LeastLoads::factorise()
{
    int n_held = 0;
    for (int i = 0; i < static_cast<int>(first_.size()); ++i) {
        double* row = line(i);
        const double square = row[i];
        double pivot = square;
        for (int k = first_[i]; k < i; ++k) {
            const double* above = line(k);
            const int from = std::max(first_[i], first_[k]);
            const double sum = row[k] - inner(row + from, above + from, k - from);
            row[k] = above[k] > 0 ? sum / above[k] : 0;
            pivot -= row[k] * row[k];
        }
        if (square == 0 || pivot <= free_pivot * square) {
            std::fill(row + first_[i], row + i + 1, 0.0);
            continue;
        }
        if (!(pivot >= held_pivot * square)) return false;
        row[i] = std::sqrt(pivot);
        ++n_held;
    }
    return n_held == n_independent_;
}

void LeastLoads::solve(double* y) const
{
    const int n = static_cast<int>(first_.size());
    const RowFunctions& rows = row_functions();
    for (int i = 0; i < n; ++i) {
        const double* row = line(i);
        const double sum = y[i] - inner(rows, row + first_[i], y + first_[i], i - first_[i]);
        y[i] = row[i] > 0 ? sum / row[i] : 0;
    }
    for (int i = n; i-- > 0;) {
        const double* row = line(i);
        y[i] = row[i] > 0 ? y[i] / row[i] : 0;
        subtract_scaled(rows, y + first_[i], y[i], row + first_[i], i - first_[i]);
    }
}

/// push += factor G^T lambda
void LeastLoads::add_push(const double* multipliers, double factor, std::vector<double>& push) const
{
    for (const Part& part : parts_) {
        const double* load = part.loads.data();
        for (int r = 0; r < part.n_rows; ++r)
            for (const int body : part.bodies) {
                add_scaled(factor * multipliers[part.first_row + r], load, push.data() + 6 * body);
                load += 6;
            }
    }
}

/// lambda += M^-1 G (G^T M^-1 G)^-1 push. Returns how large the reactions are that this adds.
double LeastLoads::add_least(const std::vector<double>& push)
{
    double largest = 0;
    y_ = push;
    solve(y_.data());
    for (Part& part : parts_) {
        const double* scaled = part.scaled.data();
        const int n = part.n_rows;
        for (int r = 0; r < n; ++r) {
            double sum = 0;
            for (const int body : part.bodies)
                for (int i = 0; i < 6; ++i) sum += y_[6 * body + i] * *scaled++;
            part.sums[r] = sum;
            largest = std::max(largest, std::abs(sum));
            if (std::isnan(sum)) return sum;
        }
        for (int r = n; r-- > 0;) {
            const double of_row = part.sums[r] /= part.square[r * n + r];
            for (int k = 0; k < r; ++k) part.sums[k] -= part.square[r * n + k] * of_row;
            lambda_[part.first_row + r] += of_row;
        }
    }
    return largest;
}

/// The second pass solves for what the first left of the push: where that is much the factor is not trusted.
bool LeastLoads::find_set(const double* multipliers, Reaction* reactions)
{
    std::ranges::fill(lambda_, 0.0);
    std::ranges::fill(push_, 0.0);
    add_push(multipliers, 1, push_);
    const double size = add_least(push_);
    left_ = push_;
    add_push(lambda_.data(), -1, left_);
    if (!(add_least(left_) <= most_of_second_pass * size)) return false;
    for (std::size_t j = 0; j < parts_.size(); ++j) {
        const Part& part = parts_[j];
        Reaction reaction;
        for (int r = 0; r < part.n_rows; ++r)
            for (int i = 0; i < 3; ++i) {
                const double lambda = lambda_[part.first_row + r];
                reaction.force[i] += lambda * part.reactions[6 * r + i];
                reaction.torque[i] += lambda * length_ * part.reactions[6 * r + 3 + i];
            }
        reactions[j] = reaction;
    }
    return true;
}

}   // namespace livens
