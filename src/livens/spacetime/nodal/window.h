// SPDX-License-Identifier: BSD-3-Clause
// lobatto(p) and radau(p) as families: their windows, what they hand on, and its motion.
#pragma once

#include <optional>

#include "livens/dynamics/instant/instant.h"
#include "livens/spacetime/march/ends.h"
#include "livens/spacetime/march/window.h"
#include "livens/spacetime/nodal/switching_points.h"
#include "livens/spacetime/nodal/branches.h"
#include "livens/spacetime/nodal/inside.h"
#include "livens/spacetime/nodal/kernel/march_kernel.h"
#include "livens/spacetime/nodal/record.h"
#include "livens/spacetime/nodal/series.h"
#include "livens/spacetime/nodal/system.h"

namespace livens {

/// Windows from the end where the state is known, or one window of all elements; radau: single elements from
/// the state at the start.
class NodalWindow final : public Window, private ElementMonitor {
public:
    /// References must outlive the window.
    NodalWindow(const Tables& tables, const TimeMesh& mesh, const Ends& ends, const ElementRule& rule);

    /// Nobody asks what laws of loads do inside of elements.
    void ignore_laws() { breaks_.inside.reset(); }
    /// A motion nearby, which has to outlive the window, as the guess where its elements are the same.
    void follow(const Motion& motion) { kernel_.follow(motion); }
    /// Goes on from the state that the ends have now, over the elements that the mesh has now, as another
    /// motion. What was learnt of the last element stays.
    void restart();
    bool open(int first, int last, SolveReport& report) override;
    NewtonProblem& equations() override { return system_; }
    bool start_from(const Guess& guess) override;
    State at(int element_end) const override;
    Closed close(const Trust& trust, SolveReport& report) override;
    WorstResidual worst() const override;
    void describe(SolveReport& report) const override;
    Motion take_motion() override { return record_.take(ends_.start); }

private:
    bool solve(const NewtonOptions& options, bool soon, NewtonReport& report) override;
    double tangent_cost() const override;
    /// Nodes that are far from their constraints say nothing of it.
    RankLoss rank_loss() const override { return system_.nodes().is_near() ? rank_loss(0) : RankLoss::none; }
    double bend(double until) override
    {
        return breaks_.bends.empty() ? ElementMonitor::bend(until)
                                     : breaks_.bends.first(stretch_, system_.nodes(), until);
    }
    std::string jumping_load() const override { return breaks_.bends.jumping_load(); }
    void divided(int element) override { record_.divided(element); }
    std::vector<Unseen> take_unseen() override { return std::move(breaks_.unseen); }
    const Motion* so_far() override { return &record_.so_far(); }

    /// What is passed on from element to element.
    struct Front {
        explicit Front(const Tables& tables)
        {
            for (InstantState& state : states) state.resize(tables);
        }
        InstantState states[2];
        int now = 0;
        bool is_ready = false;   // the state at hand is known and in the motion
        InstantState& here() { return states[now]; }
        const InstantState& here() const { return states[now]; }
        InstantState& next() { return states[1 - now]; }
    };
    /// Of loads.
    struct Breaks {
        std::vector<double> jumps;   // instants
        SwitchingPoints bends;
        std::optional<InsideLaws> inside{};   // where a law need not be smooth, and is not ignored
        std::vector<Unseen> unseen;
    };
    struct Rank {
        Branches branches;
        double smallest_pivot = 1;   // of all closed elements
    };
    struct Work {
        std::vector<double> lambda, end_lambda;   // all rows of the model
        std::vector<double> impulse;              // h w_0 lambda of the element's first node, in its basis
        std::vector<double> momentum, wrench;     // twist rows about the centres of mass
        std::vector<double> raw;                  // 12 a body
    };

    int mesh_end(int end) const;
    bool is_radau() const { return stretch_.points == Points::radau; }
    bool is_jump(double t) const;
    void set_momenta(const State& given, std::vector<double>& momenta) const;
    bool set_state(InstantState& state, const State& given, SolveReport& report);
    bool begin_front(SolveReport& report);
    bool start_by_series();
    bool find_first_state(SolveReport& report);
    void begin_newton();
    void accelerate(InstantState& state);
    void sum_momentum(int e);
    void take_spin_of_polynomial(int e);
    bool end_element(int e, SolveReport& report);
    double velocity_jump(int e, bool refuse_turns) const;
    Unseen look_at_laws(int e, Closed& closed);
    double rank_left(int e, int first, int last) const;
    RankLoss rank_loss(int e) const;
    void close_element(int e);
    void record_element(int e);
    std::string contradiction(const InstantState& state) const;
    bool fail(SolveReport& report, const std::string& message) const;

    const Tables& tables_;
    const Ends& ends_;
    NodalSystem system_;
    Series series_;
    MarchKernel kernel_;
    InstantSystem instant_;
    Record record_;
    Stretch stretch_;
    Front front_;
    InstantState far_;   // where X is known at the far end
    int first_ = 0, last_ = 0;
    Work work_;
    Breaks breaks_;
    Rank rank_;
};

}   // namespace livens
