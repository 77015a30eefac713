// SPDX-License-Identifier: BSD-3-Clause
// Conditions by component: the momenta at both ends of a window as unknowns, and the rows that decide them.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "livens/dynamics/rows/tables.h"
#include "livens/solvers/linear_solver.h"
#include "livens/spacetime/march/end_point.h"
#include "livens/spacetime/march/ends.h"

namespace livens::inline spacetime_internal {

class Elimination;

/// What conditions by component miss at two ends of time.
class MissedConditions {
public:
    /// References must outlive it.
    MissedConditions(const ModelTables& tables, const Ends& ends);

    /// An angle at the end, followed from where it is at the start.
    using Followed = std::function<double(const NamedCoordinate& coordinate, double from)>;
    /// False: something is not finite, or without a value.
    bool compare(const EndPoint& first, const EndPoint& last, double duration, const Followed& followed);
    /// With the opposite sign, as rows.
    const std::vector<double>& rows() const { return rows_; }
    /// The largest of them, by its scale.
    double largest() const { return largest_; }
    double scale(std::size_t i) const;
    /// Of the rows that rounding may make.
    std::vector<double> roundings() const;
    /// Their derivatives by free motions and momenta along them, f and f, at one end.
    DenseMatrix derivatives(bool last, const EndPoint& point, const ConstraintBasis& basis) const;

private:
    bool are_known(Condition::At without, const EndPoint& point) const;

    const ModelTables& tables_;
    const Ends& ends_;
    std::array<std::vector<StateQuantity>, 2> quantities_;   // at the start, at the end
    double duration_ = 0, largest_ = 0;
    std::vector<double> rows_;
};

/// Places at an end of time, 12 numbers a body, and the element there.
struct EndPlaces {
    double t = 0;
    const double* X = nullptr;
    const double* X_low = nullptr;   ///< null: zeros
    double length = 0;               ///< of the element, s
    /// What is told of momenta as velocities; empty: what joints allow them to be.
    std::function<std::vector<Matrix34>(const std::vector<double>& momenta)> told{};
};

/// Where an angle is at the end that is `from` at the start, as configurations have it, one after the other.
class FollowedAngle {
public:
    /// `coordinate` must outlive it; stated: where its joint counts from.
    FollowedAngle(const NamedCoordinate& coordinate, std::span<const Matrix34> stated, double from)
        : coordinate_(coordinate), stated_(stated), now_(from - coordinate.at_stated), X_(stated.size())
    {}
    void pass(const double* X);
    double now() const { return coordinate_.at_stated + now_; }

private:
    const NamedCoordinate& coordinate_;
    std::span<const Matrix34> stated_;
    double now_;
    std::vector<Matrix34> X_;
};

/// Rows and unknowns that one rank of several has of conditions; see EndConditions.
struct ConditionsOfPart {
    ChainEnds* chain = nullptr;
    int n_joins = 0;
    std::vector<double> closing, missed;
};

/// Border and closing rows of a window (docs/theory.md, "Conditions by component"). Unknowns are momenta
/// along the free motions at the first node and at the last one, f each; rows what conditions miss. Of a
/// phase among others the rows say that its start is what it is.
class EndConditions {
public:
    /// References must outlive it.
    EndConditions(const ModelTables& tables, const Ends& ends);

    int n_border() const { return 2 * tables_.freedoms() + n_joins() + ends_.n_numbers; }
    /// Of an increment as Newton's iteration sees it: momenta in world axes at both ends, unknowns that join
    /// rows of ranks, unknown numbers.
    int n_numbers() const { return 2 * tables_.n_twists + n_joins() + ends_.n_numbers; }
    /// Rows are of one rank of several, by the unknowns of closing() and n_joins more.
    void be_part(ChainEnds& chain, int n_joins) { part_ = {{&chain, n_joins, {}, {}}}; }
    /// What closes the rank's chain; null: one has all of time.
    ChainEnds* chain() const { return part_ ? part_->chain : nullptr; }
    void close_part(std::vector<double> rows) { part_->closing = std::move(rows); }
    /// What the rank's rows miss, with the opposite sign.
    void miss_in_part(std::vector<double> rows) { part_->missed = std::move(rows); }
    /// In world axes, about reference points; after evaluate() what joints allow.
    const std::vector<double>& momenta(bool last) const { return current_[last ? 1 : 0]; }

    /// The momenta of a guess, whose places serve until nodes are there.
    bool begin(bool last, const State& guess);
    void move(std::span<const double> dp, double damping);
    void keep() { kept_ = current_; }
    void hold(bool last, const std::vector<double>& momenta) { current_[last ? 1 : 0] = momenta; }
    /// What others have kept.
    void adopt(const EndConditions& others) { current_ = kept_ = others.kept_; }
    /// States at both ends, and what conditions miss. False: something is not finite, or without a value.
    bool evaluate(const std::array<EndPlaces, 2>& ends, const MissedConditions::Followed& followed);
    /// Of all bodies, where joints count from.
    const std::vector<Matrix34>& stated() const { return stated_; }
    /// What they miss, with the opposite sign.
    const std::vector<double>& missed() const { return missed_.rows(); }
    /// Rows of the balances with what the conditions miss behind them, both with the opposite sign.
    std::vector<double> behind(std::vector<double> balances) const
    {
        const std::vector<double>& rows = part_ ? part_->missed : missed_.rows();
        balances.insert(balances.end(), rows.begin(), rows.end());
        if (ends_.is_phase() && !part_)
            balances.resize(balances.size() + static_cast<std::size_t>(2 * tables_.freedoms()));
        return balances;
    }
    /// The largest of what they miss, by its scale.
    double largest() const { return missed_.largest(); }
    std::vector<double> roundings() const;
    const EndPoint& point(bool last) const { return points_[last ? 1 : 0]; }

    /// Columns of unknown numbers, for a tangent that is formed in this sink: of balances, then conditions.
    void border_with(std::function<DenseMatrix(Elimination&)> columns) { columns_ = std::move(columns); }
    DenseMatrix columns(Elimination& formed) const { return columns_ ? columns_(formed) : DenseMatrix(); }

    /// Closing rows at the current point: unknowns of the first node, of the last, momenta; all by these free
    /// motions at both ends.
    void differentiate(const std::array<const ConstraintBasis*, 2>& bases);
    std::span<const double> closing() const { return part_ ? part_->closing : closing_; }
    /// Momenta of unit free motions, n_twists x f.
    const DenseMatrix& along(bool last) const { return along_[last ? 1 : 0]; }
    /// Increments of momenta from those along the free motions where closing rows were made; numbers as they
    /// are.
    void to_momenta(const double* along, double* dp) const;
    /// What moves by them in an element at the end, in lengths and radians.
    double size_of(std::span<const double> dp) const;

private:
    int n_joins() const { return part_ ? part_->n_joins : 0; }

    const ModelTables& tables_;
    const Ends& ends_;
    std::optional<ConditionsOfPart> part_;
    MissedConditions missed_;
    std::vector<Matrix34> stated_;
    std::array<EndPoint, 2> points_;
    std::array<std::vector<double>, 2> current_, kept_;
    std::array<double, 2> lengths_{};   // of the elements at the ends, s
    std::vector<double> closing_;
    std::array<DenseMatrix, 2> along_;                   // momenta along free motions
    std::function<DenseMatrix(Elimination&)> columns_;   // or none
};

}   // namespace livens::inline spacetime_internal
