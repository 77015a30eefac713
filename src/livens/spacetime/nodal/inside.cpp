// SPDX-License-Identifier: BSD-3-Clause
// The velocity change h alpha(D_n) that the quadrature missed, where alpha is the acceleration by the missed
// moments D_n of all laws with the joints at the end of the element, and the error h^2 |alpha| / 2 that goes
// with it (docs/theory.md, "Looks at laws").
#include "livens/spacetime/nodal/inside.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "livens/diagnostics/largest.h"
#include "livens/dynamics/instant/instant.h"
#include "livens/multibody/model.h"
#include "livens/spacetime/nodal/nodes.h"

namespace livens {

namespace {

/// Of what is not seen: below, it is rounding.
constexpr double rounding = 1e-15;

}   // namespace

InsideLaws::InsideLaws(const ModelTables& tables, const ElementRule& rule, const CalmLaws& calm)
    : tables_(tables), rule_(rule), calm_(calm), laws_(laws_to_inspect(tables)), path_(tables, rule),
      along_(tables, rule), missed_(rule), V_(12 * tables.bodies.size())
{
    along_.use(missed_.shares());
}

/// A law that is smooth except where its centre is near.
bool InsideLaws::is_calm(const InspectedLaw& law)
{
    constexpr double far = 2;
    if (!law.inside.only_at_centre) return false;
    if (calm_.has_calm_centre(law.load)) return true;
    const Load& load = tables_.model->loads()[law.load];
    double least = 0, change = 0;
    Vector3 before{};
    for (int i = 0; i < 3; ++i) {
        path_.go(0.5 * i, law.bodies);
        const Vector3 c = load.centre(tables_.loads.arguments(law.load, path_.at(), path_.X(), path_.V()));
        least = i == 0 ? norm(c) : std::min(least, norm(c));
        if (i > 0) change = std::max(change, norm(c - before));
        before = c;
    }
    return least > far * change;
}

/// Moments of factors times units, as these are at the end.
void InsideLaws::add_forces(const InspectedLaw& law, const std::vector<double>& moments,
                            const InstantState& end)
{
    const Load& load = tables_.model->loads()[law.load];
    tables_.bodies.rates_of(end.X.data(), end.velocity.data(), V_.data());
    const LoadArguments at = tables_.loads.arguments(law.load, {end.t}, end.X.data(), V_.data(), end.angles);
    for (std::size_t k = 0; k < law.inside.n_factors; ++k) {
        LoadForces F(load.n_acted);
        law.inside.unit(at, k, F);
        for (std::size_t n = 0; n < MissedMoments::n_moments; ++n)
            for (std::size_t b = 0; b < load.n_acted; ++b)
                for (int i = 0; i < 12 && load.bodies[b] != world; ++i)
                    forces_[n][12 * load.bodies[b] + i] += moments[n * law.inside.n_factors + k] * F[b].a[i];
    }
}

/// The largest shifts and turns of bodies, with those of one more acceleration.
void InsideLaws::kick(const double* twist, const InstantState& end, Unseen& found)
{
    tables_.bodies.rates_of(end.X.data(), twist, V_.data());
    for (int b = 0; b < tables_.n_bodies(); ++b) {
        const auto& body = tables_.bodies[b];
        const double* dX = V_.data() + 12 * b;
        Vector3 centre{};
        double turn = 0;
        for (int i = 0; i < 3; ++i)
            centre[i] =
                dX[i] + body.center[0] * dX[3 + i] + body.center[1] * dX[6 + i] + body.center[2] * dX[9 + i];
        for (int i = 3; i < 12 && body.dofs == 6; ++i) turn += dX[i] * dX[i];
        const double shift = norm(centre) / tables_.length;
        turn = std::sqrt(0.5 * turn);   // |[w]_x|^2 = 2 |w|^2
        raise_to(found.shift[b], found.duration * shift);
        raise_to(found.turn[b], found.duration * turn);
        raise_to(found.error, 0.5 * found.duration * found.duration * std::max(shift, turn));
    }
}

Unseen InsideLaws::look(const WindowLayout& layout, const NodePositions& nodes, int e,
                        const std::vector<double>& angles, InstantSystem& instant, InstantState& end)
{
    Unseen found;
    double largest = 0;
    path_.begin(layout, nodes, e);
    bool has_looked = false;
    for (const InspectedLaw& law : laws_) {
        if (is_calm(law)) continue;
        if (!looks_) looks_.emplace(tables_, rule_, RecordedLoads::laws, missed_.shares());
        // what has no bounds is looked at elsewhere, nearer to the ends
        const bool is_seen =
            looks_->knows(law.load) && law.inside.steepest && angles.size() == tables_.loads.turns.size();
        if (is_seen && !std::exchange(has_looked, true)) looks_->look(layout, nodes, e, angles);
        along_.follow(law, path_, angles, is_seen ? &*looks_ : nullptr);
        const std::vector<double> moments = missed_.of(along_, is_seen ? &*looks_ : nullptr);
        double own = 0;
        for (std::size_t i = 0; i < moments.size(); ++i)
            own = std::max(own, std::abs(moments[i]) * law.mobility[i % law.mobility.size()] * along_.h() *
                                    along_.h());
        if (own <= rounding) continue;
        if (found.load < 0)
            for (auto& forces : forces_) forces.assign(end.X.size(), 0.0);
        if (raise_to(largest, own)) found.load = law.load;
        add_forces(law, moments, end);
    }
    if (found.load < 0) return found;
    found.t = end.t;
    found.duration = std::abs(layout.h(e));
    found.shift.assign(tables_.bodies.size(), 0.0);
    found.turn = found.shift;
    std::vector<double> twist(end.velocity.size());
    for (const auto& forces : forces_) {
        instant.respond(end, forces.data(), twist.data());
        kick(twist.data(), end, found);
    }
    return found;
}

}   // namespace livens
