// SPDX-License-Identifier: BSD-3-Clause
// Criteria by which a solved element is refused: the velocity jump at its end and turns between nodes, which
// detect spurious roots (docs/theory.md, "Spurious elements"), pivots of the constraints and the branch of
// the motion ("Singular positions"), laws between load points ("Looks at laws").
#include "livens/spacetime/nodal/element_checks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "livens/diagnostics/largest.h"
#include "livens/multibody/model.h"
#include "livens/spacetime/march/step_size_controller.h"
#include "livens/spacetime/nodal/element_end.h"
#include "livens/spacetime/nodal/system.h"

namespace livens {

namespace {

/// Of the largest pivot in an element: below, reactions at its end have no digit left (docs/theory.md,
/// "Singular positions").
constexpr double least_for_reactions = 1e-4;

}   // namespace

ElementChecks::ElementChecks(const ModelTables& tables, const ElementRule& rule)
    : tables_(tables), degree_(rule.degree), branches_(tables, rule), calm_(tables, rule),
      switching_points_(tables, rule, calm_)
{
    if (!std::ranges::all_of(tables.model->loads(), &Load::is_smooth)) inside_.emplace(tables, rule, calm_);
}

/// Less than 90 degrees, where |R_B - R_A|^2 = 4, from node to node.
bool ElementChecks::has_small_turns(const Nodes& nodes, int e) const
{
    for (int b = 0; b < tables_.n_bodies(); ++b)
        for (int B = 1; tables_.bodies[b].dofs == 6 && B <= degree_; ++B) {
            const double *d = nodes.dX(e, B) + 12 * b, *before = nodes.dX(e, B - 1) + 12 * b;
            double turn = 0;
            for (int i = 3; i < 12; ++i) turn += (d[i] - before[i]) * (d[i] - before[i]);
            if (!(turn <= 4)) return false;
        }
    return true;
}

/// h |V - X_h'| at the end; with radau at the start, as its polynomial meets the velocity at the end but for
/// the projection ("Spurious elements"). Lengths of the model, of centres of mass, or radians.
double ElementChecks::velocity_jump(const NodalSystem& system, int e, const ElementEnd& end,
                                    bool refuse_turns) const
{
    if (refuse_turns && !has_small_turns(system.nodes(), e)) return std::numeric_limits<double>::infinity();
    const ElementRule& rule = system.rule();
    const bool at_start = rule.points == Points::radau;
    const double *D = rule.D.data() + (at_start ? 0 : rule.degree * rule.size()), h = system.layout().h(e);
    const double* V = end.instant().rates();
    std::vector<double> first_V(at_start ? 12 * tables_.bodies.size() : 0);
    if (at_start) {
        tables_.bodies.rates_of(end.here().X.data(), end.here().velocity.data(), first_V.data());
        V = first_V.data();
    }
    double of_centres = 0, of_directors = 0;   // squares
    for (int b = 0; b < tables_.n_bodies(); ++b) {
        const auto& body = tables_.bodies[b];
        const int n = body.dofs == 6 ? 12 : 3;
        double jump[12] = {};
        for (int i = 0; i < n; ++i) jump[i] = h * V[12 * b + i];
        for (int B = 1; B <= rule.degree; ++B) {
            const double* d = system.nodes().dX(e, B) + 12 * b;
            for (int i = 0; i < n; ++i) jump[i] -= D[B] * d[i];
        }
        double of_centre = 0;
        for (int i = 0; i < 3; ++i) {
            const double x = jump[i] + body.center[0] * jump[3 + i] + body.center[1] * jump[6 + i] +
                             body.center[2] * jump[9 + i];
            of_centre += x * x;
        }
        raise_to(of_centres, of_centre);
        for (int a = 3; a < 12; a += 3)
            raise_to(of_directors, jump[a] * jump[a] + jump[a + 1] * jump[a + 1] + jump[a + 2] * jump[a + 2]);
    }
    double largest = std::sqrt(of_centres) / tables_.length;
    raise_to(largest, std::sqrt(0.5 * of_directors));   // |[w]_x|^2 = 2 |w|^2: radians
    return largest;
}

bool ElementChecks::leaves(const NodalSystem& system, int e, const ElementEnd& end)
{
    return branches_.leaves(system.layout(), system.nodes(), end.here().held.rows, e);
}

/// The joints may take the whole jump: of what it would do to bodies without them a billionth moves them.
std::string ElementChecks::jumps_back(const NodalSystem& system, int e, ElementEnd& end)
{
    constexpr double taken = 1e-9;
    if (switching_points_.empty()) return {};
    InstantState& there = end.next();
    const auto [load, jump] = switching_points_.off_the_way(
        system.layout(), system.nodes(), e, there.X.data(), end.instant().rates(), there.angles);
    if (load < 0) return {};
    // free: F' M^-1 F as if there were no joints; held: with them
    std::vector<double> twist(there.velocity.size()), scaled(twist), rates(jump.size());
    tables_.bodies.twist_rows(there.X.data(), there.maps.data(), jump.data(), twist.data());
    tables_.bodies.to_scaled_rows(there.maps.data(), twist.data(), scaled.data());
    const double free = std::inner_product(scaled.begin(), scaled.end(), scaled.begin(), 0.0);
    end.instant().respond(there, jump.data(), twist.data());
    tables_.bodies.rates_of(there.X.data(), twist.data(), rates.data());
    const double held = std::inner_product(jump.begin(), jump.end(), rates.begin(), 0.0);
    return held > taken * taken * free ? tables_.model->loads()[load].name : "";
}

Unseen ElementChecks::look_at_laws(const NodalSystem& system, int e, ElementEnd& end,
                                   AcceptedElements& closed)
{
    if (!inside_) return {};
    Unseen unseen =
        inside_->look(system.layout(), system.nodes(), e, end.here().angles, end.instant(), end.next());
    if (!(unseen.error > 0)) return unseen;
    const double jump = velocity_jump_of(system.rule().points, degree_, unseen.error);
    if (raise_to(closed.velocity_jump, jump)) closed.load = tables_.model->loads()[unseen.load].name;
    return unseen;
}

/// Pivots at local nodes first..last of an element: the smallest of them by the largest of all its nodes.
double ElementChecks::rank_left(const Nodes& nodes, int e, int first, int last) const
{
    double largest = 0, smallest = std::numeric_limits<double>::infinity();
    for (int a = 0; a <= degree_; ++a) {
        const double pivot = nodes.pivot(e * degree_ + a);
        raise_to(largest, pivot);
        if (a >= first && a <= last) smallest = std::min(smallest, pivot);
    }
    return smallest / largest;
}

RankLoss ElementChecks::rank_loss(const Nodes& nodes, int e) const
{
    constexpr double least = 1e-2;   // docs/theory.md, "Singular positions"
    if (rank_left(nodes, e, degree_, degree_) < least) return RankLoss::at_end;
    return rank_left(nodes, e, 1, degree_ - 1) < least ? RankLoss::inside : RankLoss::none;
}

bool ElementChecks::has_reactions(const Nodes& nodes, int e) const
{
    return !(rank_left(nodes, e, degree_, degree_) < least_for_reactions);
}

double ElementChecks::bend(const NodalSystem& system, double until)
{
    if (switching_points_.empty()) return std::numeric_limits<double>::infinity();
    return switching_points_.first(system.layout(), system.nodes(), until);
}

void ElementChecks::take(const Nodes& nodes, int e, Unseen&& unseen)
{
    if (unseen.load >= 0) unseen_.push_back(std::move(unseen));
    for (int A = e * degree_; A <= (e + 1) * degree_; ++A)
        smallest_pivot_ = std::min(smallest_pivot_, nodes.pivot(A));
}

}   // namespace livens
