// SPDX-License-Identifier: BSD-3-Clause
// Whether a run fits together: sizes, orders of ends, denominators, indices. Files may come from anywhere,
// and everything behind takes these for granted without looking again.
#include <cmath>

#include "livens/io/results/layout.h"

namespace livens::inline io_internal {

namespace {

/// As in Motion: the degrees that bases exist for.
constexpr int max_degree = 32;

void require(bool truth, const char* what)
{
    if (!truth) throw IoError(std::string("the run contradicts itself: ") + what, "io-damaged");
}

void check_mesh(const TimeMesh& mesh)
{
    require(!mesh.ends.empty(), "it has no element ends");
    require(std::isfinite(mesh.ends.back() - mesh.ends.front()), "its duration is not finite");
    for (std::size_t i = 0; i < mesh.ends.size(); ++i) {
        require(std::isfinite(mesh.ends[i]), "an element end is not finite");
        require(i == 0 || mesh.ends[i] > mesh.ends[i - 1], "element ends do not ascend");
    }
}

/// `n_values`: what a coefficient must hold. A motion of no elements may hold its start.
void check_field(const Field& field, std::size_t n_values, std::size_t n_elements, const char* what)
{
    require(!field.empty() || field.denominators.empty(), "denominators of nothing");
    if (field.empty()) return;
    require(field.degree >= 0 && field.degree <= max_degree, what);
    require(!(field.continuous && field.degree == 0), what);
    require(field.n_values >= 0 && static_cast<std::size_t>(field.n_values) == n_values && n_values > 0,
            what);
    const std::size_t degree = static_cast<std::size_t>(field.degree);
    // Neighbouring elements share a node where the field is continuous.
    const std::size_t n_coefficients = field.continuous ? n_elements * degree + 1 : n_elements * (degree + 1);
    require(field.values.size() % n_values == 0 && field.values.size() / n_values == n_coefficients, what);
    if (field.denominators.empty()) return;
    require(field.denominators.size() == n_coefficients, "the number of denominators");
    for (const double w : field.denominators)
        require(std::isfinite(w) && w > 0, "a denominator is not positive");
}

void check_blocks(const std::vector<int>& block_ends, int n_elements)
{
    for (std::size_t i = 0; i < block_ends.size(); ++i) {
        require(block_ends[i] >= 0 && block_ends[i] <= n_elements, "a block ends outside the motion");
        require(i == 0 || block_ends[i] > block_ends[i - 1], "block ends do not ascend");
    }
}

void check_motion(const Motion& m)
{
    check_mesh(m.mesh);
    require(m.n_bodies >= 0 && m.n_rows >= 0, "negative numbers of bodies or rows");
    const std::size_t bodies = static_cast<std::size_t>(m.n_bodies),
                      rows = static_cast<std::size_t>(m.n_rows);
    const std::size_t ends = m.mesh.ends.size();
    require(m.X.empty() == (bodies == 0), "the configuration is missing");
    check_field(m.X, 12 * bodies, ends - 1, "the size of the configuration X");
    check_field(m.P, 12 * bodies, ends - 1, "the size of the momentum P");
    check_field(m.multipliers, rows, ends - 1, "the size of the multipliers");
    check_field(m.rigidity, 6 * bodies, ends - 1, "the size of the multipliers of rigidity");
    require(m.gauss_points >= 0 && m.gauss_points <= 64, "no rule of so many Gauss points");
    check_blocks(m.block_ends, m.n_elements());
    require(m.momenta.size() == ends * bodies, "the number of momenta at element ends");
    require(m.velocities.size() == ends * bodies, "the number of velocities at element ends");
    require(m.accelerations.empty() || m.accelerations.size() == 2 * ends * bodies,
            "the number of accelerations at element ends");
    for (std::size_t k = 0; k < m.impacts.ends.size(); ++k)
        require(m.impacts.ends[k] > (k == 0 ? 0 : m.impacts.ends[k - 1]) &&
                    m.impacts.ends[k] <= m.n_elements(),
                "impacts at element ends, in order");
    for (const auto* before : {&m.impacts.momenta, &m.impacts.velocities})
        require(before->size() == m.impacts.ends.size() * bodies, "the number of velocities before impacts");
    require(m.load_angles.size() % ends == 0, "angles of loads at all element ends");
    require(m.end_multipliers.empty() || m.end_multipliers.size() == 2 * ends * rows,
            "the number of multipliers at element ends");
    for (const int row : m.redundant_rows)
        require(row >= 0 && row < m.n_rows, "a redundant row that does not exist");
}

void check_estimate(const ErrorEstimate& e, std::size_t ends)
{
    const std::size_t n = ends * static_cast<std::size_t>(e.n_bodies);
    for (const auto* errors : {&e.position, &e.orientation, &e.velocity})
        require(errors->size() == (e.empty() ? 0 : n), "the number of estimated errors of bodies");
    require(e.reaction.size() == ends * static_cast<std::size_t>(e.n_joints),
            "the number of estimated errors of reactions");
}

}   // namespace

void check_run(const Run& run)
{
    check_motion(run.motion);
    const std::size_t bodies = static_cast<std::size_t>(run.motion.n_bodies);
    require(run.body_names.size() == bodies && run.body_is_point.size() == bodies &&
                run.centers_of_mass.size() == bodies &&
                (run.body_holds_states.empty() || run.body_holds_states.size() == bodies),
            "the number of bodies");
    require(run.row_labels.size() == static_cast<std::size_t>(run.motion.n_rows),
            "the number of constraint rows");
    check_estimate(run.estimate, run.motion.mesh.ends.size());
    require(run.growth.empty() || run.growth.size() == run.motion.mesh.ends.size(),
            "the number of growths at element ends");
    for (const auto* of_events :
         {&run.events.times, &run.events.errors, &run.events.impulses, &run.events.speeds, &run.events.rests})
        require(of_events->size() == run.events.names.size(), "the number of events");
    for (const auto* of_numbers : {&run.numbers.values, &run.numbers.errors})
        require(of_numbers->size() == run.numbers.names.size(), "the number of unknown numbers");
    for (std::size_t i = 0; i < run.output.size(); ++i) {
        require(std::isfinite(run.output[i]), "an output time is not finite");
        require(i == 0 || run.output[i] > run.output[i - 1], "output times do not ascend");
    }
}

}   // namespace livens::inline io_internal
