// SPDX-License-Identifier: BSD-3-Clause
// theory.md, "Unknown numbers": Errors; "An accuracy between both ends" says which element ends stay.
#include "livens/spacetime/found.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "livens/multibody/model.h"
#include "livens/spacetime/march/numbered.h"

namespace livens::inline spacetime_internal {

namespace {

constexpr double least_apart = 1e-3, by_errors = 10;   // of the duration; of what it is off by

/// As they are stated of this model, or those that are left of a time that ends elsewhere.
std::vector<double> outputs(const Span& span, const Rebuilt& rebuilt)
{
    if (!rebuilt.output.empty() || span.output.empty()) return rebuilt.output;
    std::vector<double> all;
    for (const double t : span.output)
        if (t > rebuilt.start && t < rebuilt.end && t != span.end) all.push_back(t);
    all.push_back(rebuilt.end);
    return all;
}

}   // namespace

const Model& found_model(const Model& model, const Solution& solution)
{
    if (solution.decided != nullptr) return *solution.decided;
    return solution.numbers.rebuilt.model != nullptr ? *solution.numbers.rebuilt.model : model;
}

Problem with_found(const Problem& problem, const FoundNumbers& numbers)
{
    const Rebuilt& rebuilt = numbers.rebuilt;
    if (rebuilt.model == nullptr) return problem;
    Problem found = problem;
    found.prepared = nullptr;
    found.conditions.components = rebuilt.components;
    if (!rebuilt.state.X.empty()) found.conditions.start = rebuilt.state;
    if (found.conditions.turn) found.conditions.turn->angle = rebuilt.turn;
    for (std::size_t i = 0; i < numbers.values.size(); ++i) {
        UnknownNumber& one = found.unknowns.numbers[i];
        one.scale = scale_of(one);   // a number that is found to be nothing still has a size
        one.guess = numbers.values[i];
    }
    return with_prepared(found);
}

std::shared_ptr<const Stated> stated_with(const std::shared_ptr<const Stated>& stated,
                                          const FoundNumbers& numbers, StartPolicy policy)
{
    const Rebuilt& rebuilt = numbers.rebuilt;
    if (rebuilt.model == nullptr) return stated;
    Span span{rebuilt.start, rebuilt.end, stated->span.accuracy, outputs(stated->span, rebuilt)};
    Problem problem = with_found(stated->problem, numbers);
    TriedEnds tried = try_close_ends(*rebuilt.model, problem, span.start, span.end, policy);
    if (!tried.ends) return nullptr;
    return std::make_shared<const Stated>(
        Stated{rebuilt.model, std::move(problem), std::move(*tried.ends), std::move(span)});
}

/// By the guessed size at least: a number that is found to be zero has no digits of its own.
NumberError error_of_numbers(const UnknownNumbers& stated, const FoundNumbers& found)
{
    NumberError worst;
    for (std::size_t i = 0; i < found.errors.size(); ++i) {
        const UnknownNumber& number = stated.numbers[i];
        const double size = std::max(scale_of(number), std::abs(found.values[i]));
        if (i < found.rounding.size()) worst.rounding = std::max(worst.rounding, found.rounding[i] / size);
        if (!(found.errors[i] > worst.largest * size)) continue;
        worst.largest = found.errors[i] / size;
        worst.name = number.name;
    }
    return worst;
}

/// Output times that no instant that is found may come near, by its error.
std::vector<double> held_outputs(const Stated& stated, double error)
{
    if (stated.problem.unknowns.is_empty() || !std::isfinite(error)) return {};
    const Span& span = stated.span;
    std::vector<double> found = stated.model->load_breaks(), held;
    found.push_back(span.start);
    found.push_back(span.end);
    const double apart = (least_apart + by_errors * error) * (span.end - span.start);
    for (const double t : span.output) {
        const auto is_near = [&](double other) { return std::abs(t - other) <= apart; };
        if (t > span.start && t < span.end && std::ranges::none_of(found, is_near)) held.push_back(t);
    }
    return held;
}

}   // namespace livens::inline spacetime_internal
