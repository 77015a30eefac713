// SPDX-License-Identifier: BSD-3-Clause
// Loads of a model as steps of lanes (docs/theory.md, "Without a tangent", Loads in lanes).
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "livens/dynamics/lanes/load_lanes.h"
#include "livens/dynamics/rows/tables.h"
#include "livens/multibody/loads/load_tape.h"

namespace livens::inline dynamics_internal {

/// What a program for looks is about; in others what is to be evaluated beside forces.
inline std::array<const std::vector<int>*, 2> watched_of(const TapeWatch& watch, RecordedLoads which)
{
    if (which == RecordedLoads::laws) return {&watch.numbers, &watch.factors};
    if (which == RecordedLoads::supplies || which == RecordedLoads::without_bends)
        return {&watch.asked, &watch.asked};
    return {&watch.guards, &watch.centre};
}

/// Places on a tape of what loads supply together: N, N m about the world's origin, W of what has no
/// potential; and what rounding in the first two is relative to, sums of |F| and of |F| (|x| + length) over
/// all pulls.
struct SupplyOnTape {
    int force, moment, gross, gross_moment, power;
};

/// What is known of a model's loads before the numbers. Forces and places are about centres of mass.
class LoadProgram {
public:
    LoadProgram(const ModelTables& tables, RecordedLoads which);

    /// Of the model of these tables, which keep it.
    static std::shared_ptr<const LoadProgram> of(const ModelTables& tables, RecordedLoads which);

    const LoadTape& tape() const { return tape_; }
    /// Steps that time alone decides, for an element once; and those for whenever bodies move.
    const std::vector<lanes::LoadStep>& known_steps() const { return known_steps_; }
    const std::vector<lanes::LoadStep>& steps() const { return steps_; }
    const std::vector<lanes::LoadColumn>& columns() const { return columns_; }
    const std::vector<lanes::LoadArm>& arms() const { return arms_; }
    const std::vector<lanes::LoadForce>& forces() const { return forces_of_; }
    const std::vector<lanes::Term>& terms() const { return terms_; }
    /// Of a program for supplies.
    const SupplyOnTape& supply() const { return supply_; }
    int n_registers() const { return n_registers_; }
    /// Loads that are not in it: nobody recorded them.
    const std::vector<int>& others() const { return others_; }

private:
    void record(const Model& model, RecordedLoads which);
    std::vector<char> find_needed(RecordedLoads which) const;
    std::vector<char> find_known() const;
    std::vector<int> find_steps() const;
    void take_product(std::size_t i, lanes::LoadStep& made) const;
    lanes::LoadStep made_pull(const TapeStep& step, lanes::LoadStep made);
    void join(const std::vector<char>& needed, const std::vector<char>& known);
    void add_arms(const ModelTables& tables, const std::vector<char>& needed);
    void add_arm(const ModelTables& tables, const TapeStep& step);
    int& register_of(int& at, bool is_rate, const std::vector<lanes::Term>& terms);
    void add_forces(const ModelTables& tables);
    bool are_few(const ModelTables& tables, const std::vector<int>& arms) const;
    std::vector<std::vector<int>> by_body(const ModelTables& tables, const std::vector<char>& marked) const;
    std::vector<char> find_pulled() const;
    void add_terms(const ModelTables& tables, const TapeStep& step, lanes::LoadStep& made);
    void add_step(const ModelTables& tables, std::size_t i, std::vector<lanes::LoadStep>& to);
    void add_columns(const ModelTables& tables);

    LoadTape tape_;
    std::vector<lanes::LoadStep> known_steps_, steps_;
    std::vector<lanes::LoadColumn> columns_;
    std::vector<lanes::LoadArm> arms_;
    std::vector<lanes::LoadForce> forces_of_;
    /// Of each arm of the tape, and of each number where a column begins: 1 + its place in arms_, 0: it has
    /// none so far, -1: no arm is known.
    std::vector<int> arm_at_, column_at_;
    std::vector<lanes::Term> terms_;
    std::vector<int> forces_;   ///< first register of the force on each arm; -1: none
    std::vector<int> others_;
    SupplyOnTape supply_{};
    /// Of each step of the tape: a product that it takes in, -1: none; and whether another one takes it.
    std::vector<int> takes_;
    std::vector<char> is_taken_;
    int n_registers_ = 0;
};

}   // namespace livens::inline dynamics_internal
