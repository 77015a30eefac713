// SPDX-License-Identifier: BSD-3-Clause
// The elements of the paper as a family: blocks of elements, what they hand on, and their motion.
#pragma once

#include <memory>

#include "livens/solvers/ranks.h"
#include "livens/spacetime/march/ends.h"
#include "livens/spacetime/march/part_of_ranks.h"
#include "livens/spacetime/mixed/coordinates.h"
#include "livens/spacetime/mixed/end_momentum.h"
#include "livens/spacetime/mixed/motion_of_blocks.h"
#include "livens/spacetime/mixed/numbering.h"
#include "livens/spacetime/nodal/bordered_window.h"
#include "livens/spacetime/nodal/unknowns_window.h"
#include "livens/time/time_space.h"

namespace livens::mixed {
class Block;
class Border;
class RankBlock;
}   // namespace livens::mixed

namespace livens::inline spacetime_internal {

/// Throws InputError for a method that makes no solvable system on this mesh: degree, gauss_points, block,
/// knots, weights, pairings (`mixed-pairing`), conditions at the ends.
void check_mixed(const Model& model, const Conditions& conditions, const TimeMesh& mesh, const Mixed& method);

/// The smallest number of elements that can be a block.
int shortest_block(const Mixed& method);

/// Functions of time on the elements first..last - 1 of a mesh.
TimeSpace space_of(const Model& model, const Mixed& method, const TimeMesh& mesh, int first, int last);

/// What is known at an end of the open block.
struct EndOfBlock {
    State state;
    std::vector<Matrix34> P;
};

class MixedWindow final : public BorderedWindow, public PartOfRanks {
public:
    /// References must outlive the window; `tables` are with rigidity.
    /// `ranks`: this one solves its part of all elements; null: all that are asked for.
    MixedWindow(const ModelTables& tables, const TimeMesh& mesh, const Ends& ends, const Mixed& method,
                Ranks* ranks = nullptr);
    ~MixedWindow() override;

    bool open(int first, int last, SolveReport& report) override;
    NewtonProblem& equations() override;
    bool start_from(const Guess& guess) override;
    void border_with(std::function<DenseMatrix(Formed)> columns) override;
    bool factorise() override;
    /// Places of all functions are unknowns, so that there is nothing to be pulled.
    bool adopt(const BorderedWindow& other, bool is_pulled) override;
    std::vector<double> rows_in(Formed formed) override;
    void solve_for(const BorderedWindow& other, std::span<double> dx) override;
    State at(int element_end) const override;
    AcceptedElements close(const AcceptanceCriteria& criteria, SolveReport& report) override;
    WorstResidual worst() const override;
    void describe(SolveReport& report) const override;
    Motion take_motion() override;
    /// Of a window among those of ranks.
    FiguresOfPart figures() const override;
    std::vector<double> values_of_conditions() const override;

private:
    mixed::EndMomentum momentum_of(bool X_known, const EndOfBlock& end) const;
    void take_guess(const Guess& guess);
    void put_multipliers(int A, const State& state);
    void fix_known();
    mixed::Given known_of_part() const;
    std::unique_ptr<mixed::Block> make_block(mixed::Equations equations);
    bool hand_on(SolveReport& report);

    const ModelTables& tables_;
    const TimeMesh& mesh_;
    const Ends& ends_;
    const Mixed& method_;
    std::unique_ptr<mixed::Border> border_;   // of conditions by component, or null
    mixed::Coordinates coordinates_;
    mixed::Given given_;
    EndOfBlock start_, end_;
    Ranks* ranks_;
    int first_ = 0, last_ = 0;   // elements of the block: of the window, or of this rank
    std::unique_ptr<mixed::Block> block_;
    mixed::MotionOfBlocks motion_;
};

/// Windows for problems with unknown numbers. `ranks`: see MixedWindow. References must outlive them.
UnknownsWindow::Maker mixed_windows(const Mixed& method, Ranks* ranks = nullptr);

}   // namespace livens::inline spacetime_internal
