#include "livens/spacetime/mixed/solve_mixed.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdio>
#include <memory>
#include <utility>

#include "livens/base/error.h"
#include "livens/spacetime/mixed/equations.h"
#include "livens/spacetime/mixed/guess.h"
#include "livens/spacetime/mixed/motion_of_blocks.h"
#include "livens/spacetime/mixed/newton.h"

namespace livens {

namespace {

using namespace mixed;

/// Of the model's length: beyond, a motion and its guess are two motions.
constexpr double doubtful_distance = 0.05;

std::string number(double x)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", x);
    return text;
}

/// Gauss points that integrate every product of fields in (P23) exactly, if they are polynomials: degree 3 p.
/// Quotients are integrated with p more.
int exact_points(const Mixed& method)
{
    const int p = method.degree;
    return (3 * p + 2) / 2 + (method.basis == Mixed::Basis::nurbs ? p : 0);
}

/// Element ends where blocks begin and end; the last block may be shorter, but never shorter than a spline's
/// degree.
std::vector<int> divide(const TimeMesh& mesh, const Mixed& method)
{
    const int n = mesh.n_elements(), length = method.block == 0 ? n : method.block;
    const int shortest = method.basis == Mixed::Basis::lagrange ? 1 : method.degree;
    std::vector<int> ends;
    for (int e = 0; e < n; e += length) ends.push_back(e);
    if (ends.size() > 1 && n - ends.back() < shortest) ends.pop_back();
    ends.push_back(n);
    return ends;
}

TimeSpace space_of(const Model& model, const Mixed& method, const std::vector<double>& ends)
{
    if (method.basis == Mixed::Basis::lagrange) return TimeSpace::lagrange(ends, method.degree);
    const std::vector<double> knots =
        method.knots.empty() ? clamped_knots(method.degree, ends, model.load_breaks()) : method.knots;
    if (method.basis == Mixed::Basis::bspline) return TimeSpace::bspline(method.degree, knots);
    return TimeSpace::nurbs(method.degree, knots, method.weights);
}

std::vector<double> ends_of_block(const TimeMesh& mesh, int first, int last)
{
    return {mesh.ends.begin() + first, mesh.ends.begin() + last + 1};
}

bool includes(Given given, Given what) { return given == what || given == Given::state; }

class BlockMarch {
public:
    BlockMarch(const Model& model, const Boundary& boundary, const TimeMesh& mesh, const Mixed& method,
               const SolveOptions& options)
        : model_(model), mesh_(mesh), method_(method), options_(options)
    {
        assemble_ends(boundary);
        mechanism_ = std::make_unique<Mechanism>(model, independent_);
    }

    Solution run()
    {
        const std::vector<int> division = divide(mesh_, method_);
        const int n = static_cast<int>(division.size()) - 1;
        const bool backwards = !given_.X_at_start && !given_.P_at_start;
        MotionOfBlocks motion(model_, *mechanism_, mesh_, method_);
        for (int i = 0; i < n && report_.converged(); ++i) {
            const int block = backwards ? n - 1 - i : i;
            try {
                solve_one(division[block], division[block + 1], backwards, motion);
            } catch (const InputError& error) {
                if (i == 0) throw;
                // About a state that a block handed on, not one that was given.
                report_.status = SolveStatus::not_converged;
                report_.failed_at = mesh_.ends[backwards ? division[block + 1] : division[block]];
                report_.message = "what the block before t = " + number(report_.failed_at) +
                                  " s hands on is no state to go on from: " + error.what();
            }
        }
        Solution solution;
        solution.motion =
            motion.take(n > 1 && method_.interfaces == Mixed::Interfaces::project, backwards ? end_ : start_);
        solution.motion.redundant_rows = redundant_;
        solution.report = std::move(report_);
        return solution;
    }

private:
    void assemble_ends(const Boundary& boundary)
    {
        given_ = {includes(boundary.at_start, Given::positions), includes(boundary.at_start, Given::momenta),
                  includes(boundary.at_end, Given::positions), includes(boundary.at_end, Given::momenta)};
        start_ = boundary.start;
        end_ = boundary.end;
        start_.t = mesh_.start();
        end_.t = mesh_.end();
        const auto close = [&](State& state, Given given) {
            if (given == Given::nothing) return;
            const std::vector<Matrix34> guessed = state.V;
            if (given == Given::positions) state.V.assign(guessed.size(), Matrix34{});
            const Assembly assembly = assemble(model_, state, options_.initial);
            state = assembly.start;
            if (given == Given::positions) state.V = guessed;
            independent_ = assembly.independent;
            redundant_ = assembly.redundant;
            report_.notes.insert(report_.notes.end(), assembly.notes.begin(), assembly.notes.end());
        };
        close(end_, boundary.at_end);
        close(start_, boundary.at_start);
        P_start_ = momenta(start_);
        P_end_ = momenta(end_);
    }

    std::vector<Matrix34> momenta(const State& state) const
    {
        std::vector<Matrix34> P;
        for (std::size_t b = 0; b < state.V.size(); ++b) P.push_back(state.V[b] * model_.bodies()[b].mass);
        return P;
    }

    /// P where X is given, else the momenta of the state, which turn with the bodies.
    EndMomentum end_momentum(bool X_given, const State& state, const std::vector<Matrix34>& P) const
    {
        EndMomentum result{P, {}};
        for (std::size_t b = 0; !X_given && b < P.size(); ++b)
            result.turning.emplace_back(model_.bodies()[b], state.X[b], state.V[b]);
        return result;
    }

    bool from_start() const { return given_.X_at_start && given_.P_at_start; }
    bool has_state() const { return from_start() || (given_.X_at_end && given_.P_at_end); }

    /// Says whether the guess is a march that the motion can be compared with.
    Guess guess(const std::vector<double>& ends, bool& is_march) const
    {
        is_march = false;
        if (!has_state()) {
            if (given_.X_at_start && given_.X_at_end) return guess_between(start_, end_);
            return guess_steady(given_.X_at_start ? with_rates(start_, end_) : with_rates(end_, start_));
        }
        const State& given = from_start() ? start_ : end_;
        if (method_.first_guess == Mixed::FirstGuess::steady) return guess_steady(given);
        try {
            Guess march = guess_from_state(model_, given, ends);
            is_march = true;
            return march;
        } catch (const InputError&) {
            return guess_steady(given);   // what a block handed on is too far from a rigid state to march on
        }
    }

    /// Known coefficients of the fields, which the guess left as they came.
    void fix_known(const Equations& equations, Fields& fields) const
    {
        const Numbering& n = equations.numbering();
        const Mechanism& m = *mechanism_;
        const auto put = [&](const std::vector<Matrix34>& values, std::vector<double>& field, int A) {
            m.stack(values, field.data() + static_cast<std::size_t>(A) * m.n_coordinates);
        };
        const int last = n.n_functions() - 1;
        if (given_.X_at_start) m.stack(start_.X, fields.X0.data());   // x_0 is zero then
        for (const int A : {0, last}) {
            const bool known = A == 0 ? given_.X_at_start : given_.X_at_end;
            if (!known) continue;
            put(A == 0 ? start_.X : end_.X, fields.x, A);
            for (int i = 0; i < m.n_coordinates; ++i)
                fields.x[static_cast<std::size_t>(A) * m.n_coordinates + i] -= fields.X0[i];
        }
        if (n.P(0) < 0) put(P_start_, fields.P, 0);
        if (n.P(last) < 0) put(P_end_, fields.P, last);
        equations.tie(fields);
    }

    void solve_one(int first, int last, bool backwards, MotionOfBlocks& motion)
    {
        const std::vector<double> ends = ends_of_block(mesh_, first, last);
        start_.t = ends.front();
        end_.t = ends.back();
        const TimeSpace functions = space_of(model_, method_, ends);
        const bool is_equal = method_.multipliers == Mixed::Multipliers::equal;
        const Numbering numbering(given_, method_.start, method_.multipliers, functions.size(),
                                  mechanism_->n_coordinates, mechanism_->n_rows());
        Equations equations({mechanism_.get(), functions, is_equal ? functions : functions.lower(),
                             method_.gauss_points > 0 ? method_.gauss_points : exact_points(method_),
                             method_.start, method_.end_multiplier,
                             end_momentum(given_.X_at_start, start_, P_start_),
                             end_momentum(given_.X_at_end, end_, P_end_)},
                            numbering);
        Fields fields = equations.zero_fields();
        bool is_march = false;
        const Guess first_guess = guess(ends, is_march);
        take_guess(equations, first_guess, fields);
        fix_known(equations, fields);
        const bool is_last_block = backwards ? first == 0 : last == mesh_.n_elements();
        NewtonOptions newton{options_.tolerance,
                             options_.max_iterations,
                             method_.linear_solver,
                             options_.condition && is_last_block,
                             {}};
        if (options_.progress)   // a block may be the whole motion: it can be cancelled within
            newton.goes_on = [&](int iterations) {
                const int done = backwards ? mesh_.n_elements() - last : first;
                return options_.progress(
                    {done, mesh_.n_elements(), mesh_.ends[backwards ? last : first], iterations, 0});
            };
        const NewtonReport outcome = solve_block(equations, fields, newton);
        account(outcome, equations, first, last);
        if (!report_.converged()) return;
        motion.add(first, equations, fields);
        if (is_march) compare(first_guess, equations, fields);
        hand_on(equations, fields, backwards, is_last_block);
        progress(first, last, backwards, outcome);
    }

    /// How far the motion has left the march from the same state, at element ends: another method's opinion
    /// of the same block, which a wrong root does not share.
    void compare(const Guess& march, const Equations& equations, const Fields& fields)
    {
        const TimeSpace& space = equations.setup().space;
        const double length = model_.length();
        std::vector<double> x(static_cast<std::size_t>(mechanism_->n_coordinates));
        std::vector<Matrix34> X;
        for (int e = 0; e < space.n_elements(); ++e) {
            equations.evaluate_X(fields, e, 1, x.data());
            mechanism_->unstack(x.data(), X);
            const double t = space.ends()[static_cast<std::size_t>(e) + 1];
            const State state = march(t);
            double distance = 0;
            for (std::size_t b = 0; b < X.size(); ++b)
                for (int c = 0; c < 4; ++c)
                    distance = std::max(distance,
                                        norm(X[b].column(c) - state.X[b].column(c)) / (c == 0 ? length : 1));
            if (!(distance > report_.guess_distance)) continue;
            if (report_.guess_distance <= doubtful_distance) report_.guess_distance_time = t;
            report_.guess_distance = distance;
        }
    }

    /// The far end of a block becomes the given end of the next one.
    void hand_on(const Equations& equations, const Fields& fields, bool backwards, bool is_last_block)
    {
        if (is_last_block) return;
        State& state = backwards ? end_ : start_;
        std::vector<Matrix34>& P = backwards ? P_end_ : P_start_;
        state.X = equations.end_position(fields, !backwards);
        P = equations.end_momentum(fields, !backwards);
        for (int b = 0; b < model_.n_bodies(); ++b) state.V[b] = P[b] * mechanism_->inverse_masses[b];
        if (method_.interfaces == Mixed::Interfaces::carry) return;
        state = assemble(model_, state, StartPolicy::project).start;
        P = momenta(state);
    }

    void account(const NewtonReport& outcome, const Equations& equations, int first, int last)
    {
        report_.unknowns = std::max(report_.unknowns, equations.size());
        report_.newton_iterations += outcome.iterations;
        report_.most_iterations = std::max(report_.most_iterations, outcome.iterations);
        report_.factorisations += outcome.factorisations;
        report_.factor_entries = std::max(report_.factor_entries, outcome.factor_entries);
        report_.iterations.push_back(outcome.iterations);
        report_.residual_norm = std::max(report_.residual_norm, outcome.residual);
        if (outcome.status == SolveStatus::converged) {
            report_.n_elements += last - first;
            report_.condition_1 = outcome.condition.one;
            report_.condition_2 = outcome.condition.two;
            report_.scaled_condition = outcome.scaled_condition;
            return;
        }
        report_.status = outcome.status;
        report_.failed_at = mesh_.ends[first];
        const std::string where = " in the block from t = " + number(mesh_.ends[first]) + " s to " +
                                  number(mesh_.ends[last]) + " s";
        const std::string worst = outcome.worst.name.empty()
                                      ? ""
                                      : "; the largest residual is in " + outcome.worst.name +
                                            " near t = " + number(outcome.worst.t) + " s";
        const std::string help = advice(last - first);
        if (outcome.status == SolveStatus::cancelled)
            report_.message = "cancelled" + where;
        else if (!outcome.load.empty())
            report_.message = "the load '" + outcome.load + "' is not finite" + where;
        else if (outcome.status == SolveStatus::not_finite)
            report_.message = "the motion is not finite" + where + worst + help;
        else if (outcome.status == SolveStatus::singular)
            report_.message =
                "the whole matrix is singular" + where + worst +
                "; the joints may have lost rank, or the conditions at the ends fit many motions";
        else
            report_.message =
                (outcome.reached_limit ? "Newton's iteration had not converged after " +
                                             std::to_string(outcome.iterations) + " iterations, the limit,"
                                       : "Newton's iteration found no way on after " +
                                             std::to_string(outcome.iterations) + " steps") +
                where + worst + help;
    }

    /// What may help a block of n elements.
    std::string advice(int n_elements) const
    {
        if (!has_state())
            return "; conditions at both ends need a shorter time, more elements, or ends that are nearer";
        if (n_elements == 1) return "; take shorter elements";
        return "; solve fewer elements at once (block), or take shorter ones";
    }

    void progress(int first, int last, bool backwards, const NewtonReport& outcome)
    {
        if (!options_.progress) return;
        const int done = backwards ? mesh_.n_elements() - first : last;
        const double t = mesh_.ends[backwards ? first : last];
        if (options_.progress({done - 1, mesh_.n_elements(), t, outcome.iterations, outcome.residual}) ||
            done == mesh_.n_elements())
            return;
        report_.status = SolveStatus::cancelled;
        report_.failed_at = t;
        report_.message = "cancelled at t = " + number(t) + " s";
    }

    const Model& model_;
    const TimeMesh& mesh_;
    const Mixed& method_;
    const SolveOptions& options_;
    std::vector<int> independent_, redundant_;
    std::unique_ptr<Mechanism> mechanism_;
    Conditions given_;
    State start_, end_;
    std::vector<Matrix34> P_start_, P_end_;
    SolveReport report_;
};

}   // namespace

namespace {

[[noreturn]] void refuse_pairing(const std::string& path, const std::string& message,
                                 const std::string& value, const std::string& bound, const std::string& help)
{
    throw InputError({"mixed-pairing", path, message, value, bound,
                      "the whole matrix would be singular (docs/theory.md, \"The elements of the paper\")",
                      help});
}

void check_quadrature(const Mixed& method)
{
    if (method.gauss_points == 0) return;
    if (method.gauss_points < 0 || method.gauss_points > 64)
        throw InputError({"gauss-points-out-of-range", "method.gauss_points",
                          "the number of Gauss points in an element is out of range",
                          std::to_string(method.gauss_points), "1 to 64", "", ""});
    const bool is_natural = method.start == Mixed::Start::natural;
    const int fewest = is_natural ? method.degree + 1 : method.degree;
    if (method.gauss_points < fewest)
        refuse_pairing("method.gauss_points",
                       std::string("a ") + (is_natural ? "natural" : "strong") + " start of degree " +
                           std::to_string(method.degree) + " needs more Gauss points",
                       std::to_string(method.gauss_points), ">= " + std::to_string(fewest),
                       is_natural
                           ? "use momentum = \"strong\" for collocation at as many Gauss points as the degree"
                           : "");
}

/// Positions at both ends leave one function fewer than lower multipliers constrain; the strong start
/// prescribes P = V m, which unknown directors would have to turn.
void check_conditions(const Boundary& boundary, const Mixed& method)
{
    const bool is_two_point = boundary.at_start == Given::positions && boundary.at_end == Given::positions;
    if (is_two_point && method.multipliers == Mixed::Multipliers::lower)
        refuse_pairing("method.multipliers",
                       "multipliers of lower degree constrain more than positions at both ends leave free",
                       "lower", "equal", "use multipliers = \"equal\"");
    if (method.start == Mixed::Start::natural) return;
    for (const auto& [given, path] :
         {std::pair{boundary.at_start, "start.given"}, {boundary.at_end, "end.given"}})
        if (given == Given::momenta)
            refuse_pairing(path, "the strong start needs positions where it is given momenta", "momenta",
                           "state", "use momentum = \"natural\"");
}

/// The momentum that the law hands on has a part that only a multiplier of the next block's first function
/// can take up; those of lower degree cannot, and their energy drifts by a tenth whatever the mesh.
void check_interfaces(const TimeMesh& mesh, const Mixed& method)
{
    const bool is_single = method.block == 0 || method.block >= mesh.n_elements();
    if (is_single || method.multipliers == Mixed::Multipliers::equal ||
        method.interfaces == Mixed::Interfaces::project)
        return;
    throw InputError({"mixed-pairing", "method.interfaces",
                      "multipliers of lower degree cannot take up what blocks carry over", "carry", "project",
                      "docs/theory.md, \"The elements of the paper\"",
                      "use interfaces = \"project\", multipliers = \"equal\", or a single block"});
}

/// Knots are element ends, all of them and no others.
void check_knots(const TimeMesh& mesh, const TimeSpace& space)
{
    const double tolerance = 1e-9 * (mesh.end() - mesh.start());
    bool fits = space.ends().size() == mesh.ends.size();
    for (std::size_t i = 0; fits && i < mesh.ends.size(); ++i)
        fits = std::abs(space.ends()[i] - mesh.ends[i]) <= tolerance;
    if (!fits)
        throw InputError({"knots-mesh", "method.knots", "the knots are not the ends of the time elements",
                          std::to_string(space.n_elements()) + " knot spans",
                          std::to_string(mesh.n_elements()) + " elements", "", "make the mesh of the knots"});
}

void check_blocks(const Boundary& boundary, const TimeMesh& mesh, const Mixed& method)
{
    const auto refuse = [&](const std::string& message, const std::string& bound, const std::string& help) {
        throw InputError(
            {"mixed-block", "method.block", message, std::to_string(method.block), bound, "", help});
    };
    if (method.block < 0) refuse("a block has at least one element", "1 to all", "");
    const bool is_single = method.block == 0 || method.block >= mesh.n_elements();
    if (is_single) return;
    if (!method.knots.empty() || !method.weights.empty())
        refuse("knots and weights belong to a single block", "all", "leave `block` out");
    if (boundary.at_start != Given::state && boundary.at_end != Given::state)
        refuse("conditions at both ends need a single block", "all", "leave `block` out");
    if (method.basis != Mixed::Basis::lagrange && method.block < method.degree)
        throw InputError({"spline-degree", "method.degree",
                          "the degree of a spline cannot exceed the number of elements of a block",
                          std::to_string(method.degree), "<= " + std::to_string(method.block), "",
                          "use larger blocks or a lower degree"});
}

}   // namespace

void check_mixed(const Model& model, const Boundary& boundary, const TimeMesh& mesh, const Mixed& method)
{
    if (method.degree < 1 || method.degree > 8)
        throw InputError({"degree-out-of-range", "method.degree",
                          "there are no such elements of the family mixed", std::to_string(method.degree),
                          "1 to 8", "", ""});
    check_quadrature(method);
    check_conditions(boundary, method);
    check_blocks(boundary, mesh, method);
    check_interfaces(mesh, method);
    const Mechanism refuses_singular_masses(model, {});
    const SparseLU refuses_missing_backend(method.linear_solver);
    const std::vector<int> division = divide(mesh, method);
    for (const std::size_t block : {std::size_t{0}, division.size() - 2}) {
        const TimeSpace space =
            space_of(model, method, ends_of_block(mesh, division[block], division[block + 1]));
        if (!method.knots.empty()) check_knots(mesh, space);
    }
}

Solution solve_mixed(const Model& model, const Boundary& boundary, const TimeMesh& mesh, const Mixed& method,
                     const SolveOptions& options)
{
    return BlockMarch(model, boundary, mesh, method, options).run();
}

}   // namespace livens
