// SPDX-License-Identifier: BSD-3-Clause
// Closing a start from elsewhere, where it does not close as it stands: theory.md, "Starting", "From
// elsewhere". Driven angles lead by the angle itself instead of its sine, then up to twelve disturbed starts
// follow, always the same ones.
#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <utility>

#include "livens/base/error.h"
#include "livens/base/text.h"
#include "livens/dynamics/rows/rank.h"
#include "livens/dynamics/rows/reach.h"
#include "livens/dynamics/rows/rows.h"
#include "livens/multibody/body.h"

namespace livens::inline dynamics_internal {

namespace {

bool is_driven_angle(const Joint& joint)
{
    return joint.type == "drive" && joint.rows.size() == 1 && joint.branches.size() == 1;
}

/// Also by its sine alone, up to a quarter turn.
bool drives_angle(const Model& model, int row) { return model.row(row).label.starts_with("driven angle"); }

/// The row of a driven angle is the sine of what it is off, its branch the cosine: the gradient of the sine
/// vanishes at a quarter of a turn and leads to half a turn beyond. The angle itself leads back.
Joint by_angle(const Joint& joint)
{
    Joint made = joint;
    const ConstraintRow &sine = joint.rows[0], &cosine = joint.branches[0];
    made.rows[0] = coupling_row({{1, {{cosine, sine}}}}, 0, sine.scale, sine.label);
    return made;
}

Model by_angles(const Model& model)
{
    Model made(model.gravity());
    for (const Body& body : model.bodies()) made.add_body(body);
    for (const Joint& joint : model.joints())
        made.add_joint(is_driven_angle(joint) ? by_angle(joint) : joint);
    return made;
}

const ConstraintRow* other_branch(const Joint& joint, std::span<const Matrix34> X)
{
    for (const ConstraintRow& row : joint.branches)
        if (!(constraint_value(row, X) > 0)) return &row;
    return nullptr;
}

bool has_opposite_axes(const Joint& joint, std::span<const Matrix34> X)
{
    if (dot(joint.axis_first, joint.axis_first) == 0) return false;
    const Matrix34& first = joint.first == world ? world_configuration : X[joint.first];
    return !(dot(first * direction(joint.axis_first), X[joint.second] * direction(joint.axis_second)) > 0);
}

/// Numbers from -1 to 1, the same on every machine.
class Shaker {
public:
    /// Bodies turned by up to `size` rad and moved by up to as many lengths.
    std::vector<Matrix34> operator()(const Model& model, std::span<const Matrix34> X, double size)
    {
        std::vector<Matrix34> moved;
        const double length = model.length();
        for (std::size_t b = 0; b < X.size(); ++b) {
            const Vector3 shift = size * length * vector(), turn = size * vector();
            const Matrix3 turned = directors_from_rotation_vector(turn) * directors(X[b]);
            moved.push_back(model.bodies()[b].is_point ? configuration(X[b].column(0) + shift, Matrix3{})
                                                       : configuration(X[b].column(0) + shift, turned));
        }
        return moved;
    }

private:
    Vector3 vector()
    {
        Vector3 v{};
        for (double& x : v.a)
            x = 2 * static_cast<double>(random_()) / static_cast<double>(std::minstd_rand::max()) - 1;
        return v;
    }

    // The standard fixes the numbers of this generator; distributions differ from library to library.
    std::minstd_rand random_{1};
};

constexpr double disturbances[] = {0.03, 0.1, 0.3, 0.3, 1, 1, 1, 2, 2, 2, 3, 3};   // rad, lengths

/// Bodies times tries.
constexpr int most_work = 2000;

/// Nearest to X on the rows, beginning with what fulfils them.
Closing nearest_from(const Model& model, Closing found, std::span<const Matrix34> X,
                     std::span<const int> rows)
{
    Closing near = close_rows_from(model, found.X, X, rows, true);
    return near.closed && is_in_its_branch(model, near.X) ? near : std::move(found);
}

constexpr double closed_to = 1e-9;

Complaint complaint(const Model& model, int row, const char* code, const std::string& message,
                    double violation, const std::string& note, const std::string& help)
{
    return {code,
            "joint[" + model.joints()[model.row_joint(row)].name + "]",
            message,
            "violation " + to_text(violation, 3),
            to_text(closed_to),
            note,
            help};
}

/// What the law of a drive is to be more at the start, rad or m; empty: it is no single number.
std::optional<double> missing(const Model& model, int row, std::span<const Matrix34> X)
{
    const Joint& joint = model.joints()[model.row_joint(row)];
    if (joint.type != "drive") return {};
    if (is_driven_angle(joint)) return constraint_value(by_angle(joint).rows[0], X);
    const bool is_linear =
        model.row(row).label != "driven distance" && joint.branches.empty() && !drives_angle(model, row);
    if (is_linear) return constraint_value(model.row(row), X);
    return {};
}

}   // namespace

bool is_in_its_branch(const Model& model, std::span<const Matrix34> X)
{
    return std::ranges::none_of(model.joints(), [&](const Joint& joint) {
        return other_branch(joint, X) != nullptr || has_opposite_axes(joint, X);
    });
}

bool drives_are_turned(const Model& model, std::span<const Matrix34> X)
{
    return std::ranges::any_of(model.joints(), [&](const Joint& joint) {
        return is_driven_angle(joint) && other_branch(joint, X) != nullptr;
    });
}

std::optional<Complaint> why_in_other_branch(const Model& model, std::span<const Matrix34> X)
{
    for (int j = 0; j < static_cast<int>(model.joints().size()); ++j) {
        const Joint& joint = model.joints()[j];
        if (const ConstraintRow* row = other_branch(joint, X))
            return Complaint{"joint-branch",
                             "joint[" + joint.name + "]." + row->label,
                             "the " + row->label + " of joint '" + joint.name +
                                 "' is off by half a turn at the start",
                             "",
                             "",
                             "its constraints can hold, but on another branch",
                             drive_help(model, model.first_row(j), X) + "turn one of the bodies"};
        if (has_opposite_axes(joint, X))
            return Complaint{"joint-branch",
                             "joint[" + joint.name + "].axes",
                             "the axes of joint '" + joint.name +
                                 "' point in opposite directions at the start",
                             "",
                             "",
                             "its constraints can hold, but turned by half a turn",
                             "reverse one of the two axes, or turn one of the bodies"};
    }
    return {};
}

Reach reach(const Model& model, std::span<const Matrix34> X)
{
    const Model led = by_angles(model);
    const std::vector<int> rows = all_rows(led);
    const auto is_good = [&](const Closing& closing) {
        return closing.closed && is_in_its_branch(model, closing.X);
    };
    Reach reached{close_rows(led, X, rows, true), 0, ""};
    if (is_good(reached.closing)) return reached;
    Shaker shaken;
    for (const double size : disturbances) {
        // A large model gets one try at least, but not minutes of them.
        if (reached.n_tries > 0 && reached.n_tries * model.n_bodies() > most_work) break;
        ++reached.n_tries;
        Closing found = close_rows(led, shaken(model, X, size), rows, false);
        if (!is_good(found)) continue;
        // A disturbed start closes anywhere on its branch; the nearest place to the stated one is meant.
        reached.closing = nearest_from(led, std::move(found), X, rows);
        reached.how =
            "the joints did not close from the start as given; from one that was disturbed by up to " +
            to_text(size, 1) + " rad and model lengths they did";
        return reached;
    }
    reached.closing.closed = false;
    return reached;
}

Complaint why_open(const Model& model, const Closing& open, std::span<const Matrix34> X, int n_tries)
{
    const std::string tried =
        "tried from the start as given and from " + std::to_string(n_tries) + " that were disturbed";
    // If the independent rows close without the others, the others contradict them: that is a better reason
    // than a residual.
    const RowRank rank = row_rank(model, open.X, all_rows(model));
    const Closing rest = close_rows(model, open.X, rank.independent, false);
    if (rest.closed) {
        const Gap worst = widest_gap(model, rest.X, rank.dependent);
        if (worst.violation > closed_to)
            return complaint(model, worst.row, "joint-contradiction",
                             "no position was found in which " + model.row_name(worst.row) +
                                 " holds together with the other joints" + drive_words(model, worst.row, X),
                             worst.violation, tried,
                             drive_help(model, worst.row, X) +
                                 "make its points, axes and lengths fit the others, remove it, or place the "
                                 "bodies nearer to where the mechanism closes");
    }
    const Gap worst = widest_gap(model, open.X, all_rows(model));
    return complaint(
        model, worst.row, "start-position",
        model.row_name(worst.row) + " stays open: no position was found that closes the joints" +
            drive_words(model, worst.row, X),
        worst.violation, tried,
        drive_help(model, worst.row, X) +
            "check lengths and joint points, or place the bodies nearer to where the mechanism closes");
}

std::string drive_words(const Model& model, int row, std::span<const Matrix34> X)
{
    const Joint& joint = model.joints()[model.row_joint(row)];
    if (joint.type != "drive") return "";
    const std::optional<double> by = missing(model, row, X);
    const char* const unit = drives_angle(model, row) ? " rad" : " m";
    return ": its law is " + (by ? to_text(std::abs(*by), 4) + unit + " from" : "elsewhere, not") +
           " where the bodies stand";
}

std::string drive_help(const Model& model, int row, std::span<const Matrix34> X)
{
    const Joint& joint = model.joints()[model.row_joint(row)];
    if (joint.type != "drive") return "";
    const std::optional<double> by = missing(model, row, X);
    const bool is_angle = drives_angle(model, row);
    const std::string law =
        by ? "add " + to_text(*by) + (is_angle ? " rad" : " m") + " to its law" : "let its law begin there";
    const bool is_of_joint = is_angle || model.row(row).label == "driven displacement";
    return law + (is_of_joint ? ", lead its joint there by coordinates of the start, or " : ", or ");
}

}   // namespace livens::inline dynamics_internal
