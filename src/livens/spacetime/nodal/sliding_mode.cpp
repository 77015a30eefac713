// SPDX-License-Identifier: BSD-3-Clause
// Explicit steps from a state on a discontinuity: where the motion slides they change sides again and again,
// however short they are; elsewhere they leave it (docs/theory.md, "Laws that bend").
#include "livens/spacetime/nodal/sliding_mode.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "livens/multibody/body.h"
#include "livens/spacetime/nodal/element_end.h"

namespace livens::inline spacetime_internal {

namespace {

/// Of the element's length, and how many. Both lengths have to say the same: a stiff damper beside the jump
/// has the longer ones change sides, too.
constexpr double steps_of[] = {1e-5, 1e-9};
constexpr int most_steps = 512;
/// Changes of side by which it slides, and steps without one by which it does not: on one side it may be
/// driven back that many times as fast as on the other.
constexpr int enough = 16, most_alone = 64;
/// Of the largest acceleration: what changes less at a passage does not jump there.
constexpr double jump = 1e-6;

bool is_inside(const std::vector<Guard::Piece>& pieces, const std::vector<double>& numbers)
{
    for (std::size_t k = 0; k < pieces.size(); ++k)
        if (!(pieces[k].margin(numbers[k]) >= 0)) return false;
    return true;
}

/// Steps of Euler's method, and what a law sees of them.
class SmallSteps {
public:
    SmallSteps(const ModelTables& tables, bool sparse, const WatchedLaw& law, const State& at)
        : tables_(tables), law_(law), end_(tables, sparse), state_(at)
    {}
    bool change_sides(double step);

private:
    bool look();
    bool has_jumped(const std::vector<double>& before) const;
    void go(double step);

    const ModelTables& tables_;
    const WatchedLaw& law_;
    ElementEnd end_;
    State state_;
    LawState seen_;
};

/// Accelerations at the state, and the numbers of the law.
bool SmallSteps::look()
{
    InstantState& here = end_.here();
    if (!end_.set(here, state_)) return false;
    end_.accelerate(here);
    seen_ = law_.at({here.t, Side::right}, here.X.data(), end_.instant().rates(), here.angles, seen_);
    return true;
}

/// In lengths of the model and radians.
bool SmallSteps::has_jumped(const std::vector<double>& before) const
{
    const std::vector<double>& now = end_.here().acceleration[1];
    double change = 0, largest = 0;
    for (const auto& body : tables_.bodies)
        for (int i = body.first; i < body.first + body.dofs; ++i) {
            const double unit = i < body.first + 3 ? tables_.length : 1;
            change = std::max(change, std::abs(now[i] - before[i]) / unit);
            largest = std::max({largest, std::abs(now[i]) / unit, std::abs(before[i]) / unit});
        }
    return change > jump * largest;
}

void SmallSteps::go(double step)
{
    const InstantState& here = end_.here();
    const std::span<double> A = end_.work();
    tables_.bodies.rates_of(here.X.data(), here.acceleration[1].data(), A.data());
    state_.t += step;
    state_.angles = here.angles;
    for (std::size_t b = 0; b < state_.X.size(); ++b) {
        Matrix34 &X = state_.X[b], &V = state_.V[b];
        for (std::size_t i = 0; i < 12; ++i) {
            X.a[i] += step * end_.instant().rates()[12 * b + i];
            V.a[i] += step * (A[12 * b + i] + end_.instant().centripetal()[12 * b + i]);
        }
        if (tables_.bodies[b].dofs == 6) X = configuration(X.column(0), project_directors(directors(X)));
    }
}

bool SmallSteps::change_sides(double step)
{
    std::vector<Guard::Piece> pieces;
    std::vector<double> before;
    int changes = 0, last = 0;
    for (int i = 0; i < most_steps && i - last <= most_alone && changes < enough; ++i) {
        if (!look()) return false;
        if (pieces.empty() || !is_inside(pieces, seen_.numbers)) {
            if (!pieces.empty() && has_jumped(before)) {
                ++changes;
                last = i;
            }
            pieces.clear();
            for (std::size_t k = 0; k < law_.guards().size(); ++k)
                pieces.push_back(law_.guards()[k].piece_at(seen_.numbers[k]));
        }
        before = end_.here().acceleration[1];
        go(step);
    }
    return changes >= enough;
}

}   // namespace

bool slides(const ModelTables& tables, bool sparse, const WatchedLaw& law, const State& at, double length)
{
    return std::ranges::all_of(steps_of, [&](double step) {
        return SmallSteps(tables, sparse, law, at).change_sides(step * length);
    });
}

}   // namespace livens::inline spacetime_internal
