// SPDX-License-Identifier: BSD-3-Clause
// Formulas of loads and drives, and what they read of the motion.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "livens/io/scenario/builder.h"
#include "livens/io/scenario/joints/inputs.h"
#include "livens/multibody/loads/load_laws.h"
#include "livens/time/expression.h"

namespace livens::inline io_internal {

/// `expression` for one number, or for three, and `inputs`.
std::vector<Key> expression_keys(bool is_vector);
/// Of "latch.force", "latch.torque_x"; none: it is something else.
std::optional<ReactionInput> reaction_of(const Model& model, const std::string& name);
/// What a name with a point stands for becomes a symbol. Throws InputError at path.expression, path.inputs.
void add_input(const Builder& builder, Inputs& inputs, const std::string& symbol, const std::string& text,
               const std::string& path);
/// What stands under `inputs`; throws likewise.
void read_named_inputs(const Builder& builder, const Section& section, Inputs& inputs,
                       const std::string& path);
/// Throw InputError at path.inputs, path.expression.
Inputs read_inputs(const Builder& builder, const Section& section, const std::string& path);
std::vector<Expression> read_expressions(const Section& section, const Inputs& inputs,
                                         const std::string& path);
/// `breaks`, and the events of the expressions, ascending; a warning where symbols decide about kinks.
std::vector<double> breaks_of(const Builder& builder, const Section& section,
                              const std::vector<Expression>& expressions);
/// Instants at which they jump or bend by time alone, in the time of the run, are added.
void add_breaks(const Builder& builder, const std::vector<Expression>& expressions,
                std::vector<double>& breaks);
/// What symbols stand for.
std::vector<double> numbers_of(const Inputs& inputs, const LawArguments& at,
                               std::span<const double> reactions = {});
/// A number that is told.
ReactionNumber number_by(const Expression& formula, const Inputs& inputs);
/// The law, its smoothness and what of it depends on rates, but for units.
LoadParts parts_of(const std::vector<Expression>& expressions, const Inputs& inputs,
                   const std::vector<double>& breaks, const TimeFunction& acts);
/// The same of formulas that read reactions; but for units and readings, too.
ReactionLaw reaction_law_of(const std::vector<Expression>& expressions, const Inputs& inputs,
                            const std::vector<double>& breaks, const TimeFunction& acts);
/// A load that does nothing but say these numbers. It looks at bodies of its inputs.
Load telling(const Builder& builder, const std::string& name, const Inputs& inputs,
             const std::vector<ReactionLaw::Reading>& told);
/// A warning where they may jump or bend where no element ends.
void warn_of_kinks(Builder& builder, const Section& section, std::string_view key,
                   const std::vector<Expression>& expressions);
/// One factor for each expression.
RecordedLaw recorded_law_of(const std::vector<Expression>& expressions, const Inputs& inputs,
                            const std::vector<double>& breaks, const TimeFunction& acts);
LoadLaw law_of(const std::vector<Expression>& expressions, const Inputs& inputs,
               const std::vector<double>& breaks);
/// How steep they may be.
LawSteepness steepness_of(const std::vector<Expression>& expressions, const Inputs& inputs);
/// What decides on which smooth pieces they are; empty: they have but one.
LawGuards guards_of(const std::vector<Expression>& expressions, const Inputs& inputs);

}   // namespace livens::inline io_internal
