// SPDX-License-Identifier: BSD-3-Clause
// A law is judged at the start that is solved, not where the bodies are placed before coordinates lead them
// there.
#include "livens/dynamics/start/laws_at_start.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "livens/base/text.h"
#include "livens/multibody/body.h"

namespace livens::inline dynamics_internal {

namespace {

/// The first function of a row that has no value there; null: all have one.
const SmoothFunction* function_without_value(const ConstraintRow& row, const Configurations& X,
                                             std::size_t& first_coordinate)
{
    const SmoothFunction* found = nullptr;
    for_each_function(row, [&](const SmoothFunction& function, std::size_t first) {
        if (found != nullptr || std::isfinite(function.at(function_point(row, function, first, X)).value))
            return;
        found = &function;
        first_coordinate = first;
    });
    return found;
}

bool has_values(const Joint& joint, const Configurations& X)
{
    std::size_t first = 0;
    return std::ranges::none_of(joint.rows, [&](const ConstraintRow& row) {
        return function_without_value(row, X, first) != nullptr;
    });
}

}   // namespace

std::optional<Complaint> why_without_law(const Model& model, std::span<const Matrix34> X)
{
    for (int r = 0; r < model.n_rows(); ++r) {
        const ConstraintRow& row = model.row(r);
        std::size_t first = 0;
        const SmoothFunction* function = function_without_value(row, X, first);
        if (function == nullptr) continue;
        const std::string& name = model.joints()[static_cast<std::size_t>(model.row_joint(r))].name;
        const auto m = static_cast<std::size_t>(function - row.functions.data());
        if (m < row.edges.size())
            if (const double margin = row.edges[m].margin(function_point(row, *function, first, X));
                margin < 0)
                return Complaint{
                    "coupling-range",
                    "joint[" + name + "].law",
                    "at the start " + row.edges[m].what,
                    "by " + to_text(-margin, 6) + (function->n == 2 ? " rad" : " m"),
                    "",
                    "",
                    "continue the table to there, nothing is extrapolated; or state another start"};
        return Complaint{"coupling-law",
                         "joint[" + name + "].law",
                         "the law of '" + name + "' has no value at the start",
                         "",
                         "",
                         "",
                         ""};
    }
    return {};
}

/// By the joints that have values where bodies are placed; rates are left out on the way. Velocities and
/// spins of bodies that are stated stay as they are, in world axes.
std::optional<State> led_to_laws(const Model& model, const std::vector<StartCoordinate>& wanted,
                                 StartPolicy policy, double t)
{
    const State placed = model.start();
    if (!why_without_law(model, placed.X)) return {};
    Model others(model.gravity());
    for (Body body : model.bodies()) {
        body.V = {};
        others.add_body(std::move(body));
    }
    std::vector<int> numbers;   // of joints among the others; -1: it has no value yet
    for (const Joint& joint : model.joints())
        numbers.push_back(has_values(joint, placed.X) ? others.add_joint(joint) : -1);
    std::vector<StartCoordinate> led;
    for (StartCoordinate one : wanted) {
        if (!one.value || one.joint < 0 || one.joint >= std::ssize(numbers)) continue;
        one.joint = numbers[static_cast<std::size_t>(one.joint)];
        one.rate.reset();
        led.push_back(one);
    }
    if (led.empty()) return {};
    State there = move_start(others, led, policy, t).model.start();
    for (std::size_t b = 0; b < there.X.size(); ++b) {
        const Matrix34& V = placed.V[b];
        there.V[b] =
            model.bodies()[b].is_point ? V : rate(there.X[b], V.column(0), angular_velocity(placed.X[b], V));
    }
    return there;
}

}   // namespace livens::inline dynamics_internal

namespace livens {

MovedStart move_start(const Model& model, const std::vector<StartCoordinate>& wanted, StartPolicy policy,
                      double t, const std::vector<StatedVelocity>& stated)
{
    const std::optional<State> there = led_to_laws(model, wanted, policy, t);
    if (!there) return move_start_with_laws(model, wanted, policy, t, stated, false);
    if (std::optional<Complaint> why = why_without_law(model, there->X)) throw InputError(std::move(*why));
    return move_start_with_laws(restated(model, *there, wanted), wanted, policy, t, stated, true);
}

}   // namespace livens
