// SPDX-License-Identifier: BSD-3-Clause
// livens. Settings: "DEGREE:ELEMENTS[:TOLERANCE]" is lobatto; "accuracy:A" leaves all to livens and includes
// the estimate, "all:A" also growth and judgement, as its program and its Python package have them.
// Mechanisms with loads are scenarios: what a user would write.
#include "livens/dynamics/start/prepared.h"
#include "livens/io/scenario.h"
#include "livens/spacetime/solve.h"

#include "serve.h"

namespace {

using namespace livens;
using peers::Mechanism;

Vector3 vec(const peers::Vec& a) { return {a[0], a[1], a[2]}; }
Matrix3 columns(const peers::Mat& R) { return {R[0], R[3], R[6], R[1], R[4], R[7], R[2], R[5], R[8]}; }

livens::Body body(const peers::Body& b, const std::string& name)
{
    if (b.inertia == peers::Vec{}) return point_mass(name, b.mass, vec(b.x), vec(b.v));
    const Matrix3 J{b.inertia[0], 0, 0, 0, b.inertia[1], 0, 0, 0, b.inertia[2]};
    return rigid_body(name, {b.mass, vec(b.center), J}, {vec(b.x), columns(b.R), vec(b.v), vec(b.w)});
}

livens::Joint joint(const peers::Joint& j, const std::string& name)
{
    const JointFrame frame{.point_first = vec(j.point_first),
                           .point_second = vec(j.point_second),
                           .axis_first = vec(j.axis_first),
                           .axis_second = vec(j.axis_second)};
    if (j.kind == "rod") return rod(name, j.first, j.second, frame, j.length);
    if (j.kind == "ball") return spherical(name, j.first, j.second, frame);
    return revolute(name, j.first, j.second, frame);
}

Model model_of(const Mechanism& m)
{
    Model model(vec(m.gravity));
    for (const peers::Body& b : m.bodies) {
        const bool is_lever = b.inertia == peers::Vec{} && b.center != peers::Vec{};
        if (is_lever) throw std::runtime_error("a point mass away from its joint");
        model.add_body(body(b, "b" + std::to_string(model.n_bodies())));
    }
    for (const peers::Joint& j : m.joints)
        model.add_joint(joint(j, "j" + std::to_string(&j - m.joints.data())));
    return model;
}

struct Run {
    Model model;
    Problem problem{};
    Method method = AutomaticFamily{};
    Time time{};
    SolveOptions options{};
};

Run read(const Mechanism& m)
{
    if (!m.is_loaded()) {
        Run run{.model = model_of(m)};
        run.problem.conditions.start = run.model.start();
        return run;
    }
    if (m.scenario.empty()) throw std::runtime_error("bodies without mass");
    ScenarioResult read = read_scenario(m.scenario);
    if (!read.scenario) throw std::runtime_error("scenario: " + read.diagnostics.at(0).message);
    Run run{.model = std::move(read.scenario->model)};
    run.problem.conditions = read.scenario->conditions;
    run.options.initial = read.scenario->options.initial;
    return run;
}

/// As others are timed, the solution alone: nobody else estimates its error, either.
Run run_of(const Mechanism& m, const std::vector<std::string>& setting)
{
    Run run = read(m);
    run.problem.prepared = std::make_shared<Prepared>();
    run.options.judge = run.options.growth = setting.at(0) == "all";
    if (setting.at(0) == "accuracy" || setting.at(0) == "all") {
        run.time = Span{.start = 0, .end = m.end, .accuracy = std::stod(setting.at(1))};
        return run;
    }
    run.method = Lobatto{std::stoi(setting[0])};
    run.time = make_time_mesh(0, m.end, std::stoi(setting.at(1)));
    run.options.estimate = SolveOptions::Estimate::none;
    if (setting.size() > 2) run.options.tolerance = std::stod(setting[2]);
    return run;
}

peers::Points ends(const Mechanism& m, const Solution& solution)
{
    if (!solution.report.converged()) throw std::runtime_error(solution.report.message);
    const State end = solution.motion.at_end(solution.motion.n_elements());
    peers::Points points;
    for (const peers::Point& p : m.points) {
        const Vector3 x = end.X[p.body] * point(vec(p.at));
        points.push_back({x[0], x[1], x[2]});
    }
    return points;
}

}   // namespace

int main()
{
    return peers::serve([](const Mechanism& m, const std::vector<std::string>& setting) {
        return [&m, run = run_of(m, setting)] {
            return ends(m, solve(run.model, run.problem, run.time, run.method, run.options));
        };
    });
}
