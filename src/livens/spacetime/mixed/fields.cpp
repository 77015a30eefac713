// SPDX-License-Identifier: BSD-3-Clause
// Fields of one block: X = X0 + sum_A M_A x_A, P = sum_A M_A P_A and lambda = sum_A L_A lambda_A, the
// functions that (P23) is solved for; and the multipliers that no row determines, which are tied to others
// (docs/theory.md, "The elements of the paper": The multiplier at an end, Loads that jump).
#include "livens/spacetime/mixed/fields.h"

#include <algorithm>
#include <array>
#include <utility>

namespace livens::mixed {

namespace {

/// out += sum_a weights[a] * (row first + a of a table with n columns).
void combine(const std::vector<double>& table, int first, int n, std::span<const double> weights, double* out)
{
    for (std::size_t a = 0; a < weights.size(); ++a) {
        const double* row =
            table.data() + (static_cast<std::size_t>(first) + a) * static_cast<std::size_t>(n);
        for (int i = 0; i < n; ++i) out[i] += weights[a] * row[i];
    }
}

/// The same with the values of the functions at a place of an element.
void combine_at(const TimeSpace& functions, int element, double s, const std::vector<double>& table,
                int first, int n, double* out)
{
    std::array<double, 9> values{}, rates{};
    const std::size_t count = static_cast<std::size_t>(functions.degree()) + 1;
    functions.evaluate(element, s, {values.data(), count}, {rates.data(), count});
    combine(table, first, n, {values.data(), count}, out);
}

/// Where a row defines the momentum, and on one side of a tear, the multiplier of a function is no unknown.
/// It is tied to the others of its element, where it lives alone, so that the multipliers are of degree p - 1
/// there: their p-th derivative vanishes. In the strong form the one at an end keeps its value.
std::vector<Tie> find_ties(const FieldSpace& space, Mixed::EndMultiplier end_multiplier)
{
    std::vector<Tie> ties;
    const BlockFunctions& functions = space.functions;
    const Numbering& numbering = space.numbering;
    const int p = functions.multipliers().degree(), last = numbering.n_multiplier_functions() - 1;
    for (int e = 0; e < functions.n_elements(); ++e) {
        const int first = functions.first_multiplier(e);
        for (const int frozen : {first, first + p}) {
            const bool is_end = frozen == 0 || frozen == last;
            if (numbering.lambda(frozen) >= 0 || (is_end && !space.is_natural)) continue;
            Tie& tie = ties.emplace_back(Tie{frozen, {}});
            if (is_end && end_multiplier == Mixed::EndMultiplier::zero) continue;
            const std::vector<double> derivative = functions.multipliers().highest_derivative(e);
            // Both of an element that has no unknown one between them are zero.
            for (int a = 0; a <= p; ++a)
                if (numbering.lambda(first + a) >= 0)
                    tie.terms.emplace_back(first + a, -derivative[a] / derivative[frozen - first]);
        }
    }
    return ties;
}

}   // namespace

FieldSpace::FieldSpace(const Coordinates& the_coordinates, BlockFunctions the_functions,
                       const Numbering& the_numbering, Mixed::Start start,
                       Mixed::EndMultiplier end_multiplier)
    : coordinates(the_coordinates), functions(std::move(the_functions)), numbering(the_numbering),
      is_natural(start == Mixed::Start::natural), ties(find_ties(*this, end_multiplier))
{}

Fields FieldSpace::zero() const
{
    const std::size_t n = static_cast<std::size_t>(coordinates.size), n_functions = functions.space().size();
    const std::size_t n_lambda = numbering.n_multiplier_functions();
    const auto zeros = [](std::size_t size) { return std::vector<double>(size, 0.0); };
    return {zeros(n), zeros(n * n_functions), zeros(n * n_functions), zeros(coordinates.n_rows() * n_lambda)};
}

void FieldSpace::add(Fields& fields, std::span<const double> increment, double factor) const
{
    const auto move = [&](std::vector<double>& values, int A, int from, int count) {
        if (from < 0) return;
        double* to = values.data() + static_cast<std::size_t>(A) * count;
        for (int i = 0; i < count; ++i) to[i] += factor * increment[from + i];
    };
    for (int A = 0; A < numbering.n_functions(); ++A) {
        move(fields.x, A, numbering.X(A), coordinates.size);
        move(fields.P, A, numbering.P(A), coordinates.size);
    }
    for (int A = 0; A < numbering.n_multiplier_functions(); ++A)
        move(fields.lambda, A, numbering.lambda(A), coordinates.n_rows());
    tie(fields);
}

void FieldSpace::tie(Fields& fields) const
{
    const std::size_t n = static_cast<std::size_t>(coordinates.n_rows());
    for (const Tie& tie : ties)
        for (std::size_t k = 0; k < n; ++k) {
            double sum = 0;
            for (const auto& [B, factor] : tie.terms) sum += factor * fields.lambda[B * n + k];
            fields.lambda[tie.function * n + k] = sum;
        }
}

const Tie* FieldSpace::tie_of(int function) const
{
    for (const Tie& tie : ties)
        if (tie.function == function) return &tie;
    return nullptr;
}

std::vector<Matrix34> FieldSpace::end_position(const Fields& fields, bool at_end) const
{
    // At an end of the block its function alone is not zero, and it is one there.
    const std::size_t A = at_end ? static_cast<std::size_t>(numbering.n_functions()) - 1 : 0;
    std::vector<double> x = fields.X0;
    for (int i = 0; i < coordinates.size; ++i) x[i] += fields.x[A * coordinates.size + i];
    return coordinates.bodies(x.data());
}

void FieldSpace::evaluate_X(const Fields& fields, int element, double s, double* X) const
{
    std::copy(fields.X0.begin(), fields.X0.end(), X);
    combine_at(functions.space(), element, s, fields.x, functions.first(element), coordinates.size, X);
}

void FieldSpace::evaluate_P(const Fields& fields, int element, double s, double* P) const
{
    std::fill_n(P, coordinates.size, 0.0);
    combine_at(functions.space(), element, s, fields.P, functions.first(element), coordinates.size, P);
}

void FieldSpace::evaluate_multipliers(const Fields& fields, int element, double s, double* lambda) const
{
    std::fill_n(lambda, coordinates.n_rows(), 0.0);
    combine_at(functions.multipliers(), element, s, fields.lambda, functions.first_multiplier(element),
               coordinates.n_rows(), lambda);
}

void FieldSample::take(const FieldSpace& space, const Fields& fields, int e, int g)
{
    const BlockFunctions& functions = space.functions;
    const Coordinates& m = space.coordinates;
    const int first = functions.first(e), n = m.size;
    const std::span<const double> values(functions.M(e, g), functions.n_local());
    const std::span<const double> rates(functions.D(e, g), functions.n_local());
    x = fields.X0;
    for (auto* numbers : {&v, &p}) numbers->assign(n, 0.0);
    lambda.assign(m.n_rows(), 0.0);
    combine(fields.x, first, n, values, x.data());
    combine(fields.x, first, n, rates, v.data());
    combine(fields.P, first, n, values, p.data());
    if (!space.is_natural) {
        p_rate.assign(n, 0.0);
        combine(fields.P, first, n, rates, p_rate.data());
    }
    combine(fields.lambda, functions.first_multiplier(e), m.n_rows(),
            {functions.L(e, g), static_cast<std::size_t>(functions.n_local_multipliers())}, lambda.data());
    X.resize(m.n_X());
    V.resize(m.n_X());
    m.spread(x.data(), X.data());
    m.spread(v.data(), V.data());
}

}   // namespace livens::mixed
