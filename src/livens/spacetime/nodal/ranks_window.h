// SPDX-License-Identifier: BSD-3-Clause
// A window of lobatto of which every rank has a stretch of elements: theory.md, "Lobatto windows on ranks".
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "livens/solvers/ranks/rank_ends.h"
#include "livens/spacetime/march/part_of_ranks.h"
#include "livens/spacetime/march/partition.h"
#include "livens/spacetime/nodal/unknowns_window.h"
#include "livens/spacetime/nodal/window.h"

namespace livens::inline spacetime_internal {

/// What is known at an end of time that this rank has.
struct KnownEndOfRank {
    bool has_X = false, has_momenta = false;
    std::vector<double> X, momenta;
};
/// Rows of conditions by component that this rank has, by the start and by the end of time, and columns
/// that join these; -1: it has none.
struct ConditionsOfRank {
    std::array<std::vector<int>, 2> rows;
    std::vector<int> joins;
    int n_rows = 0, n_own_joins = 0, n_joins = 0;   ///< of the rank; of all ranks
};

/// The first node of a rank is the last one of the rank before, with its momenta: both are unknowns of the
/// two, and what conditions say of the ends of time are rows of the first and of the last rank. All numbers
/// that decide are those of all ranks, which call everything but at(), worst() and figures() together.
class RanksWindow final : public BorderedWindow, public PartOfRanks, private NewtonProblem {
public:
    /// References must outlive the window; mesh and ends are those of all ranks.
    RanksWindow(const ModelTables& tables, const TimeMesh& mesh, const Ends& ends, const Lobatto& method,
                Ranks& ranks);

    bool open(int first, int last, SolveReport& report) override;
    NewtonProblem& equations() override { return *this; }
    bool start_from(const Guess& guess) override;
    State at(int element_end) const override { return window_.at(element_end - elements_.first); }
    AcceptedElements close(const AcceptanceCriteria& criteria, SolveReport& report) override;
    WorstResidual worst() const override { return window_.worst(); }
    void describe(SolveReport& report) const override { window_.describe(report); }
    Motion take_motion() override { return window_.take_motion(); }

    void border_with(std::function<DenseMatrix(Formed)> columns) override;
    bool factorise() override;
    bool adopt(const BorderedWindow& other, bool is_pulled) override;
    std::vector<double> rows_in(Formed formed) override { return system().rows_in(*formed.front()); }
    void solve_for(const BorderedWindow& other, std::span<double> dx) override;

    FiguresOfPart figures() const override;
    std::vector<double> values_of_conditions() const override;

private:
    int n_unknowns() const override { return window_.equations().n_unknowns(); }
    bool residual() override;
    void solve(std::span<double> dx) override { solve_for(*this, dx); }
    bool move(std::span<const double> dx, double damping) override;
    void keep() override { system().keep(); }
    double size_of(std::span<const double> dx) const override;
    double scale() const override;
    NewtonProblem::Rows rows() const override;

    NodalSystem& system() { return window_.equations(); }
    const NodalSystem& system() const { return window_.equations(); }
    int last_node() const { return system().layout().n_nodes() - 1; }
    bool has(bool last) const { return last ? ranks_.is_last() : ranks_.is_first(); }
    static TimeMesh stretch_of(const TimeMesh& whole, const Elements& of);
    static Ends ends_of_part(const Ends& whole, const TimeMesh& part);
    static ConditionsOfRank places_of(const Ends& ends, int n_free, const Ranks& ranks);
    std::vector<int> others() const;
    void hold_known();
    bool meet_neighbours();
    void relay_angles();
    bool compare();
    double followed(const NamedCoordinate& coordinate, double from) const;
    void miss();
    std::vector<double> closing_rows() const;
    std::vector<double> free_motions(int node) const;

    const ModelTables& tables_;
    const Ends& ends_;
    Ranks& ranks_;
    Elements elements_;
    TimeMesh whole_, mesh_;
    Ends part_;
    std::array<KnownEndOfRank, 2> known_;
    ConditionsOfRank places_;
    RankEnds chain_;
    NodalWindow window_;
    MissedConditions missed_;
    std::array<EndPoint, 2> points_;   // of time, on all ranks
    std::vector<Matrix34> stated_;
};

/// Windows for problems with unknown numbers. References must outlive them.
UnknownsWindow::Maker windows_of_ranks(const Lobatto& method, Ranks& ranks);

}   // namespace livens::inline spacetime_internal
