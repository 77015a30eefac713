// SPDX-License-Identifier: BSD-3-Clause
// Loads of a model as steps of lanes (docs/theory.md, "Without a tangent", Loads in lanes).
#pragma once

#include <memory>
#include <vector>

#include "livens/dynamics/lanes/load_lanes.h"
#include "livens/dynamics/rows/tables.h"
#include "livens/multibody/loads/load_tape.h"

namespace livens::inline dynamics_internal {

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
    const std::vector<lanes::Term>& terms() const { return terms_; }
    int n_registers() const { return n_registers_; }
    /// Loads that are not in it: nobody recorded them.
    const std::vector<int>& others() const { return others_; }

private:
    void record(const Model& model, RecordedLoads which);
    std::vector<char> find_needed() const;
    std::vector<char> find_known() const;
    void add_arm(const ModelTables& tables, const TapeArm& arm, std::int32_t& begin, std::int32_t& end);
    void add_step(const ModelTables& tables, const TapeStep& step, std::vector<lanes::LoadStep>& to);
    void add_columns(const ModelTables& tables);

    LoadTape tape_;
    std::vector<lanes::LoadStep> known_steps_, steps_;
    std::vector<lanes::LoadColumn> columns_;
    std::vector<lanes::Term> terms_;
    std::vector<int> forces_;   ///< first register of the force on each arm; -1: none
    std::vector<int> others_;
    int n_registers_ = 0;
};

}   // namespace livens::inline dynamics_internal
