// SPDX-License-Identifier: BSD-3-Clause
#include "livens/spacetime/accuracy/settled_bends.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "livens/base/text.h"
#include "livens/solvers/dense_matrix.h"
#include "livens/spacetime/accuracy/remeshing.h"
#include "livens/spacetime/accuracy/until_accurate.h"
#include "livens/spacetime/found.h"
#include "livens/spacetime/march/numbered.h"
#include "livens/spacetime/nodal/kernel/acceleration.h"
#include "livens/spacetime/solve_mesh.h"

namespace livens::inline spacetime_internal {

namespace {

constexpr int most_solved = 16;   // times
// Of the duration: bends this near to element ends are there, or are if another try brings them no nearer.
constexpr double settled = 1e-14, no_nearer = 1e-9;
constexpr double nearer = 0.25;      // times as far as at the try before
constexpr double farthest = 10;      // times the way to the bends, of a step
constexpr int most_halved = 2;       // times, of elements on which the motion is not found
constexpr int most_bends_each = 4;   // of a stated element: beyond, a motion slides or hops
constexpr double thinnest = 1e-6;    // of an element: a stated end nearer to a bend gives way to it

/// How far any of them is from the other one; infinite where they are not as many.
double apart(const std::vector<double>& a, const std::vector<double>& b)
{
    double most = a.size() == b.size() ? 0 : infinite;
    for (std::size_t i = 0; i < a.size() && i < b.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
    return most;
}

double nearest_end(const TimeMesh& mesh, double t)
{
    return *std::ranges::min_element(mesh.ends, {}, [t](double end) { return std::abs(end - t); });
}

/// What was stated, in the time of the motion, with these instants.
TimeMesh ending_at(const TimeMesh& stated, const std::vector<double>& bends)
{
    TimeMesh mesh = stated;
    mesh.bends = bends;
    for (const double t : bends) {
        const int e = stated.element_at(t);
        const double near = thinnest * stated.length(e);
        std::erase_if(mesh.ends, [&](double end) {
            return std::abs(end - t) <= near && end > stated.start() && end < stated.end() &&
                   !std::ranges::binary_search(stated.required, end);
        });
    }
    mesh.ends.insert(mesh.ends.end(), bends.begin(), bends.end());
    std::ranges::sort(mesh.ends);
    return mesh;
}

/// Where elements are to end next. A bend that is where elements end moves with these, by far less than they
/// do; a jump by the impulse that it has lost, which with conditions at both ends has changed all of the
/// motion before it. So steps are accelerated.
class NextEnds {
public:
    /// `found`: the bends of the motion whose elements ended at `ends`.
    std::vector<double> after(const std::vector<double>& ends, const std::vector<double>& found)
    {
        if (ends.size() != found.size()) {
            n_ = 0;
            return found;
        }
        if (n_ != found.size()) steps_.begin(n_ = found.size());
        std::vector<double> step = found, next = ends;
        add_scaled(step, -1, ends);
        const double most = farthest * largest_size(step);
        steps_.apply(step.data());
        add_scaled(next, 1, step);
        if (largest_size(step) <= most && std::ranges::is_sorted(next)) return next;
        n_ = 0;   // what it has seen says nothing here
        return found;
    }

private:
    Acceleration steps_;
    std::size_t n_ = 0;
};

class SettlingEnds {
public:
    SettlingEnds(const std::shared_ptr<const Stated>& stated, const TimeMesh& mesh, const Lobatto& lobatto,
                 const SolveOptions& options, Solution first)
        : of_(stated), lobatto_(lobatto), options_(options), notes_(first.report.notes)
    {
        become(mesh, std::move(first));
    }

    SettledBends run()
    {
        Look look = Look::moved;
        for (int n = 1; n < most_solved && look == Look::moved; ++n) {
            look = look_along();
            if (look == Look::moved && !solve_again()) look = Look::lost;
        }
        const bool is_settled = look == Look::settled || moved_ <= no_nearer;
        const double near = next_.empty() ? found_.motion.start() : next_.front();
        found_.report.notes = std::move(notes_);
        found_.report.evaluations_in_all = evaluations_;
        return {std::move(found_), is_settled, near, n_halved_};
    }

private:
    enum class Look { settled, moved, lost };

    /// The elements without those that bends have made, in the time of what was found.
    TimeMesh stated() const
    {
        TimeMesh mesh = found_.motion.mesh;
        std::erase_if(mesh.ends, [&](double t) { return std::ranges::binary_search(bends_, t); });
        mesh.bends = {};
        return mesh;
    }

    Look look_along()
    {
        of_now_ = stated_with(of_, found_.numbers, options_.initial);
        if (of_now_ == nullptr) return Look::lost;
        const TimeMesh mesh = stated();
        const double duration = mesh.end() - mesh.start();
        std::vector<double> bends = bends_of(*of_now_, found_.motion, bends_, lobatto_, options_);
        const auto is_held = [&](double t) {   // by an end that stays
            const auto is_near = [&](double end) { return std::abs(end - t) <= nearest_ends * duration; };
            return is_near(mesh.start()) || is_near(mesh.end()) ||
                   std::ranges::any_of(mesh.required, is_near);
        };
        std::erase_if(bends, is_held);
        std::ranges::sort(bends);
        const double moved = apart(bends, bends_) / duration, before = std::exchange(moved_, moved);
        if (moved <= settled || (moved <= no_nearer && moved > nearer * before)) return Look::settled;
        next_ = next_ends_.after(bends_, bends);
        const int most = most_bends_each * mesh.n_elements();
        return static_cast<int>(next_.size()) > most ? Look::lost : Look::moved;
    }

    /// False, and what was found stays: the motion is not found on them, nor on shorter ones.
    bool solve_again()
    {
        Problem problem = of_now_->problem;
        problem.guess = [this](double t) { return found_.motion.at(t); };
        problem.is_only_guess = true;
        TimeMesh mesh = stated();
        for (int k = 0;; ++k) {
            const TimeMesh divided = ending_at(mesh, next_);
            Solution next = solve_mesh(*of_now_->model, problem, divided, of_now_->ends, lobatto_, options_);
            if (next.report.converged()) {
                n_halved_ += k;
                of_ = of_now_;
                become(divided, std::move(next));
                return true;
            }
            if (next.report.status == SolveStatus::cancelled) {
                found_.report.status = SolveStatus::cancelled;
                found_.report.failed_at = next.report.failed_at;
                found_.report.message = "stopped as asked before elements ended where laws bend";
            }
            if (k == most_halved || found_.report.status == SolveStatus::cancelled) return false;
            mesh = halved(mesh);
        }
    }

    /// With unknown instants what was found has a time of its own.
    void become(const TimeMesh& mesh, Solution next)
    {
        for (const std::string& note : next.report.notes)
            if (std::ranges::find(notes_, note) == notes_.end()) notes_.push_back(note);
        if (found_.motion.n_elements() > 0) {   // it is the first one whose guess was another motion
            next.report.guess_distance = found_.report.guess_distance;
            next.report.guess_distance_time = found_.report.guess_distance_time;
        }
        found_ = std::move(next);
        evaluations_ += found_.report.evaluations;
        bends_.clear();
        for (const double t : mesh.bends)
            bends_.push_back(nearest_end(found_.motion.mesh, carried_to(mesh, t, found_.motion.mesh)));
        found_.motion.mesh.bends = bends_;
    }

    std::shared_ptr<const Stated> of_, of_now_;
    Lobatto lobatto_;
    const SolveOptions& options_;
    Solution found_;
    std::vector<std::string> notes_;
    NextEnds next_ends_;
    std::vector<double> bends_, next_;   // where elements of what was found end, and of the next
    double moved_ = infinite;            // of the duration, by the last try
    int n_halved_ = 0;
    long long evaluations_ = 0;
};

void tell(const SettledBends& settled, SolveReport& report)
{
    if (const std::size_t n = settled.solution.motion.mesh.bends.size(); n > 0)
        report.notes.push_back("elements end at " + std::to_string(n) + (n == 1 ? " instant" : " instants") +
                               " where a law of a load bends or jumps" +
                               (settled.n_halved > 0 ? "; for these all were halved" : ""));
    if (settled.is_settled || !report.converged()) return;
    report.status = SolveStatus::suspect;
    report.failed_at = settled.near;
    report.message =
        "a law of a load bends or jumps inside of elements, near t = " + to_text(settled.near, 6) +
        " s, and elements that end there do not settle; try: more elements, or an accuracy "
        "instead of them";
}

}   // namespace

SettledBends settle_bends(const std::shared_ptr<const Stated>& stated, const TimeMesh& mesh,
                          const Lobatto& lobatto, const SolveOptions& options, Solution first)
{
    if (!options.end_at_bends || !stated->model->has_pieces() || !first.report.converged())
        return {std::move(first)};
    return SettlingEnds(stated, mesh, lobatto, options, std::move(first)).run();
}

Solution solve_with_bends(const Model& model, const Problem& problem, const TimeMesh& mesh, const Ends& ends,
                          const Method& method, const SolveOptions& options)
{
    Solution first = solve_mesh(model, problem, mesh, ends, method, options);
    const auto* lobatto = std::get_if<Lobatto>(&method);
    if (lobatto == nullptr) return first;
    const std::shared_ptr<const Model> own(std::shared_ptr<const Model>(), &model);
    const Span span{mesh.start(), mesh.end()};
    SettledBends found = settle_bends(std::make_shared<const Stated>(Stated{own, problem, ends, span}), mesh,
                                      *lobatto, options, std::move(first));
    tell(found, found.solution.report);
    return std::move(found.solution);
}

}   // namespace livens::inline spacetime_internal
