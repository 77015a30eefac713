// SPDX-License-Identifier: BSD-3-Clause
// The refusal of a start in a singular position, in words: how many motions and conditions there are, and
// where the branches lead (theory.md, "Singular positions", "A start in such a position").
#include <algorithm>
#include <cmath>
#include <string>

#include "livens/base/error.h"
#include "livens/base/text.h"
#include "livens/dynamics/start/singular.h"
#include "livens/multibody/body.h"
#include "livens/multibody/model.h"
#include "livens/multibody/wording.h"

namespace livens {

namespace {

constexpr double still = 1e-6;   // of a speed

/// How the bodies of a branch move: angular velocities, or velocities of points, of those that do.
std::string words_of(const Model& model, const State& state, const std::vector<Matrix34>& branch)
{
    std::string words;
    int told = 0;
    for (int b = 0; b < model.n_bodies(); ++b) {
        const bool is_point = model.bodies()[b].is_point;
        const Vector3 turn = is_point ? Vector3{} : angular_velocity(state.X[b], branch[b]);
        const bool turns = norm(turn) > still;
        Vector3 v = turns ? turn : branch[b].column(0);
        if (norm(v) <= still) continue;
        if (++told > 4) return words + ", ...";
        words += (told > 1 ? ", '" : "'") + model.body_name(b) + (turns ? "' turns by [" : "' moves by [");
        for (int i = 0; i < 3; ++i)
            words += (i > 0 ? ", " : "") + to_text(std::abs(v[i]) < still ? 0.0 : v[i], 3);
        words += "]";
    }
    return words;
}

}   // namespace

std::optional<Complaint> why_singular(const Model& model, const ConsistentStart& closed)
{
    const Mobility m = mobility(model, closed);
    if (!m.is_singular()) return {};
    const std::size_t n = m.branches.size();
    const auto count = [](std::size_t k, const std::string& what) {
        return std::to_string(k) + " " + what + (k == 1 ? "" : "s");
    };
    std::string what = count(m.first_order, "motion") + " in first order under " +
                       count(m.conditions, "condition") + " of second order";
    if (m.is_locked)
        what += ": nothing can move";
    else if (n > 0)
        what += ": " + std::to_string(n) + (n == 1 ? " branch" : " branches") + " of single motions";
    std::string help = m.is_locked ? "move points or axes, so that the joints hold here as they do beside"
                                   : "start beside this position";
    if (n > 0) help += ", on the branch that is meant: ";
    for (std::size_t i = 0; i < std::min<std::size_t>(n, 2); ++i)
        help += (i > 0 ? "; or " : "") + words_of(model, closed.start, m.branches[i]);
    if (n > 2) help += "; or another";
    return Complaint{"start-singular", "joint[" + model.joints()[model.row_joint(m.row)].name + "]",
                      "the joints are in a singular position at the start" +
                          std::string(!m.are_possible   ? ", and velocities lead out of them in second order"
                                      : m.choose_branch ? ", from which no method can start"
                                                        : ", and the velocities choose no motion"),
                      what, "", "the joints hold less there than beside it, and several motions may meet",
                      help};
}

void refuse_singular_start(const Model& model, const ConsistentStart& closed)
{
    if (std::optional<Complaint> why = why_singular(model, closed)) throw InputError(std::move(*why));
}

}   // namespace livens
