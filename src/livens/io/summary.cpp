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
// Bounds for the family mixed are drawn between right and wrong runs of the paper's pendulums, two bricks and
// a free box to 1 .. 20 s, with elements of 0.0025 to 0.1 s. Weak constraints hold as integrals and are off
// at points by what the discretisation is: runs with an energy off by less than 2 percent reached 6e-4 in the
// mean and 0.02 at nodes. Velocities of right runs alternated by 0.23 at most. By 0.7 and more did those of
// strong starts whose directors were off by 0.1 to 0.24 with an energy off by 1e-4, and of a motion that was
// metres from its place with an energy off by 0.8 percent: there no balance tells.
constexpr double acceptable_weak_violation = 1e-3;
constexpr double acceptable_nodal_violation = 0.05;
constexpr double acceptable_zigzag = 0.5;
constexpr double acceptable_drift = 0.05;
constexpr double acceptable_distance = 0.05;
constexpr double doubtful_pivot = 1e-6;

bool holds_weakly(const Motion& motion) { return motion.constraints_hold == "weakly"; }

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

/// Remarks, gathered.
class Doubts {
public:
    /// nan breaks every bound.
    void violation(double value, double bound, const char* what)
    {
        if (!(value <= bound)) notes_.push_back("constraints are violated by " + shortest(value) + what);
    }
    void drift(double value, const char* what)
    {
        if (value <= acceptable_drift) return;
        notes_.push_back(std::string("the balance of ") + what +
                         (std::isnan(value) ? " is not a number"
                                            : " is off by " + shortest(value) + " of its largest value") +
                         "; more elements or a higher degree may help");
    }
    void zigzag(double value, double t, const char* what)
    {
        if (value <= acceptable_zigzag) return;
        notes_.push_back(std::string(what) + " alternate from node to node near " + shortest(t) +
                         " s (indicator " + shortest(value) +
                         "): the equations have solutions that are no motions, and this may be one; "
                         "momentum = \"natural\", smaller blocks or more elements lead away from them");
    }
    void distance(double value, double t)
    {
        if (value <= acceptable_distance) return;
        notes_.push_back("the motion is " + shortest(value) +
                         " of the model's length away from a march of lobatto(2) over the same elements, "
                         "which it leaves near " +
                         shortest(t) +
                         " s: one of the two is wrong; smaller blocks, more elements or a higher degree may "
                         "help");
    }
    const std::vector<std::string>& notes() const { return notes_; }

private:
    std::vector<std::string> notes_;
};

/// Remarks on figures that break the bounds of acceptance.
std::vector<std::string> doubts(const RunSummary& s, const SolveReport& report, bool holds_weakly,
                                bool is_mixed, double linear_drift)
{
    Doubts doubts;
    doubts.distance(report.guess_distance, report.guess_distance_time);
    doubts.violation(s.max_constraint_violation,
                     holds_weakly ? acceptable_nodal_violation : acceptable_violation, " at element nodes");
    if (holds_weakly)
        doubts.violation(s.max_weak_violation, acceptable_weak_violation, " in the mean over an element");
    if (is_mixed) {
        doubts.zigzag(s.zigzag_positions, s.zigzag_time, "velocities");
        doubts.zigzag(s.zigzag_momenta, s.zigzag_time, "momenta");
    }
    doubts.drift(s.energy_drift, "energy");
    doubts.drift(linear_drift, "linear momentum");
    doubts.drift(s.angular_momentum_drift, "angular momentum");
    return doubts.notes();
}

/// What follows from the motion, if there is one.
void measure(RunSummary& s, const Model& model, const Motion& motion, const Balance& balance)
{
    if (motion.n_elements() == 0) {   // nothing was solved, so there is nothing to judge
        for (double* figure :
             {&s.max_constraint_violation, &s.max_velocity_violation, &s.energy_drift,
              &s.angular_momentum_drift, &s.max_weak_violation, &s.zigzag_positions, &s.zigzag_momenta})
            *figure = std::numeric_limits<double>::quiet_NaN();
        return;
    }
    const ViolationReport v = violations(model, motion, 0);
    s.max_constraint_violation = std::max(v.joints_at_nodes, v.rigidity_at_nodes);
    s.max_velocity_violation = v.velocity_level;
    if (holds_weakly(motion)) s.max_weak_violation = std::max(v.joints_weakly, v.rigidity_weakly);
    s.energy_drift = balance.relative_energy_drift();
    s.angular_momentum_drift = balance.relative_angular_momentum_drift();
    const Zigzag z = zigzag(model, motion);
    s.zigzag_positions = z.positions;
    s.zigzag_momenta = z.momenta;
    s.zigzag_time = z.worst_time;
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
    s.condition_1 = report.condition_1;
    s.condition_2 = report.condition_2;
    s.scaled_condition = report.scaled_condition;
    measure(s, model, solution.motion, balance);
    if (solution.motion.n_elements() == 0) return s;
    if (report.smallest_pivot < doubtful_pivot)
        s.notes.push_back("the constraints came close to losing rank (smallest pivot " +
                          shortest(report.smallest_pivot) +
                          "): the mechanism passes near a singular position");
    if (!s.converged) return s;
    const std::vector<std::string> doubtful =
        doubts(s, report, holds_weakly(solution.motion), std::holds_alternative<Mixed>(method),
               relative_linear_momentum_drift(model, solution.motion, balance));
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
