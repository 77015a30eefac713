// SPDX-License-Identifier: BSD-3-Clause
// Which elements a march solves next: windows of a mesh that is given, or elements whose lengths it finds.
#pragma once

#include <optional>
#include <vector>

#include "livens/solvers/newton.h"
#include "livens/solvers/report.h"
#include "livens/spacetime/march/event_locator.h"
#include "livens/spacetime/march/step_size_controller.h"
#include "livens/spacetime/march/window.h"
#include "livens/time/time_mesh.h"

namespace livens::inline spacetime_internal {

/// Elements first..last - 1 of a mesh, solved together.
struct Elements {
    int first = 0, last = 0;
    int size() const { return last - first; }
};

/// The remedies that a march has for a window which was not accepted, in the two ways to divide time. Each
/// changes the mesh, and next() then returns what is to be tried instead.
class Partition {
public:
    virtual ~Partition() = default;

    /// The next window from t on. None: t is the end of time, or elements have vanished.
    virtual std::optional<Elements> next(double t) = 0;
    virtual AcceptanceCriteria criteria(const Elements&) const = 0;
    /// Whether the far end may be elsewhere.
    virtual bool may_move_end(const Elements&) const = 0;
    /// Whether an element may be replaced by shorter ones.
    virtual bool may_shorten(const Elements&) const = 0;
    /// Where the element would end if no law of a load bent in it; `is_found`: it ends at such a bend.
    virtual double wanted_end(const Elements&, bool is_found) const = 0;

    /// The only element ends at t, inside of it or, if its end was found at a bend, near that end.
    virtual void end_at(const Elements&, double t, bool is_found) = 0;
    /// Nodes of the only element leave a singular position.
    virtual void avoid(const Elements&, RankLoss) = 0;
    /// The only element was not accepted: shorter ones are tried, if they can help. False: they cannot.
    virtual bool reject(const Elements&, double velocity_jump, bool can_help, SolveReport&) = 0;
    /// A window is solved in two, the first of which ends before element `middle`.
    virtual void split(const Elements&, int middle) = 0;
    virtual void accepted(const Elements&, const AcceptedElements&, const NewtonReport&) = 0;
};

/// How windows of a mesh are divided.
struct DivisionOptions {
    int length = 1;            ///< elements in a window; 0: all
    int shortest = 1;          ///< a window of fewer elements has no equations (splines)
    int direction = 1;         ///< -1: from the end of time
    bool may_split = true;     ///< a window that fails is solved in two halves
    bool may_divide = false;   ///< an element that fails or is refused is divided into two
    AcceptanceCriteria criteria{};
};

/// The mesh gets an end more for every element that is divided.
class GivenMesh final : public Partition {
public:
    GivenMesh(TimeMesh& mesh, ElementMonitor& monitor, const DivisionOptions& options);

    std::optional<Elements> next(double t) override;
    AcceptanceCriteria criteria(const Elements&) const override { return options_.criteria; }
    bool may_move_end(const Elements&) const override;
    bool may_shorten(const Elements&) const override;
    double wanted_end(const Elements&, bool is_found) const override;
    void end_at(const Elements&, double t, bool is_found) override;
    void avoid(const Elements&, RankLoss) override;
    bool reject(const Elements&, double velocity_jump, bool can_help, SolveReport&) override;
    void split(const Elements&, int middle) override;
    void accepted(const Elements&, const AcceptedElements&, const NewtonReport&) override {}

private:
    int far(const Elements& of) const { return options_.direction > 0 ? of.last : of.first; }
    void insert(const Elements&, double t);

    TimeMesh& mesh_;
    ElementMonitor& monitor_;
    const DivisionOptions& options_;
    std::vector<double> far_ends_;   // of windows to come, the next one last
    int last_ = 0;                   // the far end of the window before
    int n_divided_ = 0, most_divided_;
};

/// The mesh begins with the start alone and grows, one element a window.
class AdaptiveElements final : public Partition {
public:
    AdaptiveElements(TimeMesh& mesh, StepSizeController& controller, EventLocator& bends)
        : mesh_(mesh), controller_(controller), events_(bends)
    {}

    std::optional<Elements> next(double t) override;
    AcceptanceCriteria criteria(const Elements&) const override;
    bool may_move_end(const Elements&) const override;
    bool may_shorten(const Elements&) const override { return true; }
    double wanted_end(const Elements&, bool) const override { return wanted_end_; }
    void end_at(const Elements&, double, bool) override { mesh_.ends.pop_back(); }   // which bends_ knows
    void avoid(const Elements&, RankLoss) override;
    bool reject(const Elements&, double velocity_jump, bool can_help, SolveReport&) override;
    void split(const Elements&, int) override {}
    void accepted(const Elements&, const AcceptedElements&, const NewtonReport&) override;

private:
    TimeMesh& mesh_;
    StepSizeController& controller_;
    EventLocator& events_;
    double wanted_end_ = 0;
};

/// Element ends where windows of the given length begin and end; the last may be longer or shorter, but never
/// shorter than `shortest`.
std::vector<int> divide(int n_elements, int length, int shortest);

}   // namespace livens::inline spacetime_internal
