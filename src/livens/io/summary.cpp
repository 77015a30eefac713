#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "livens/base/version.h"
#include "livens/io/json.h"
#include "livens/io/results.h"

namespace livens {

namespace {

constexpr double acceptable_violation = 1e-6;
constexpr double acceptable_drift = 0.05;
constexpr double doubtful_pivot = 1e-6;

std::string name_of(const Method& method)
{
    if (const auto* lobatto = std::get_if<Lobatto>(&method))
        return "lobatto(" + std::to_string(lobatto->degree) + ")";
    return std::holds_alternative<Midpoint>(method) ? "midpoint" : "endpoint";
}

/// nan if one is nan.
double largest(const std::vector<double>& values)
{
    double result = 0;
    for (const double x : values)
        if (std::isnan(x) || x > result) result = x;
    return result;
}

/// Largest drift over the largest momentum or impulse seen. For a mechanism at rest both are rounding: then
/// it is the impulse of all weights that counts, or the momentum of crossing the mechanism once.
double relative_linear_momentum_drift(const Model& model, const Motion& motion, const Balance& balance)
{
    const double drift = largest(balance.linear_momentum_drift);
    double mass = 0, scale = 0;
    for (const Body& body : model.bodies()) mass += body.mass(0, 0);
    for (const Vector3& p : balance.linear_momentum) scale = std::max(scale, norm(p));
    for (const Vector3& p : balance.linear_impulse) scale = std::max(scale, norm(p));
    const double duration = motion.end() - motion.start();
    const double reference = mass * (norm(model.gravity()) * duration + model.length() / duration);
    return drift == 0 ? 0 : drift / (scale > 1e-9 * reference ? scale : reference);
}

/// Remarks on figures that break the bounds of acceptance; nan breaks every bound.
std::vector<std::string> doubts(const RunSummary& s, double linear_drift)
{
    std::vector<std::string> notes;
    if (!(s.max_constraint_violation <= acceptable_violation))
        notes.push_back("constraints are violated by " + shortest(s.max_constraint_violation) +
                        " at element nodes");
    const auto doubt = [&](const char* what, double drift) {
        if (drift <= acceptable_drift) return;
        notes.push_back(std::string("the balance of ") + what +
                        (std::isnan(drift) ? " is not a number"
                                           : " is off by " + shortest(drift) + " of its largest value") +
                        "; more elements or a higher degree may help");
    };
    doubt("energy", s.energy_drift);
    doubt("linear momentum", linear_drift);
    doubt("angular momentum", s.angular_momentum_drift);
    return notes;
}

}   // namespace

RunSummary summarise(const Model& model, const Solution& solution, const Method& method,
                     const Balance& balance)
{
    const SolveReport& report = solution.report;
    RunSummary s;
    s.converged = report.converged();
    s.status = to_string(report.status);
    s.method = name_of(method);
    s.elements = solution.motion.n_elements();
    s.unknowns = report.unknowns;
    s.newton_iterations = report.newton_iterations;
    s.factorisations = report.factorisations;
    s.residual_norm = report.residual_norm;
    s.notes = report.notes;
    s.message = report.message;
    if (solution.motion.n_elements() == 0) {   // nothing was solved, so there is nothing to judge
        s.max_constraint_violation = s.max_velocity_violation = s.energy_drift = s.angular_momentum_drift =
            std::numeric_limits<double>::quiet_NaN();
        return s;
    }
    const ViolationReport v = violations(model, solution.motion, 0);
    s.max_constraint_violation = std::max(v.joints_at_nodes, v.rigidity_at_nodes);
    s.max_velocity_violation = v.velocity_level;
    s.energy_drift = balance.relative_energy_drift();
    s.angular_momentum_drift = balance.relative_angular_momentum_drift();
    if (report.smallest_pivot < doubtful_pivot)
        s.notes.push_back("the constraints came close to losing rank (smallest pivot " +
                          shortest(report.smallest_pivot) +
                          "): the mechanism passes near a singular position");
    if (!s.converged) return s;
    const std::vector<std::string> doubtful =
        doubts(s, relative_linear_momentum_drift(model, solution.motion, balance));
    s.notes.insert(s.notes.end(), doubtful.begin(), doubtful.end());
    if (!doubtful.empty()) s.status = "suspect";
    return s;
}

Run make_run(const Model& model, Solution solution, const Method& method)
{
    Run run;
    for (const Body& body : model.bodies()) {
        run.body_names.push_back(body.name);
        run.body_is_point.push_back(body.is_point);
        run.centers_of_mass.push_back(body.is_point ? Vector3{} : mass_properties(body.mass).center_of_mass);
    }
    for (const Joint& joint : model.joints()) run.joint_names.push_back(joint.name);
    for (int r = 0; r < model.n_rows(); ++r)
        run.row_labels.push_back(model.joints()[model.row_joint(r)].name + ": " + model.row(r).label);
    if (solution.motion.n_elements() > 0) run.balance = balance(model, solution.motion);
    run.summary = summarise(model, solution, method, run.balance);
    run.output = solution.motion.mesh.ends;
    run.motion = std::move(solution.motion);
    run.report = std::move(solution.report);
    run.version = version;
    return run;
}

}   // namespace livens
