// SPDX-License-Identifier: BSD-3-Clause
// One [[controller]] on its way into a model.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "livens/io/scenario/builder.h"
#include "livens/multibody/controllers.h"

namespace livens::inline io_internal {

/// Sizes of states by "controller.state".
using SizesOfStates = std::map<std::string, double>;

/// A name of a table of formulas, and its text.
struct NamedText {
    std::string name, text;
};

class ControllerReader {
public:
    /// What is wrong with its names. Throws InputError. References must outlive it.
    ControllerReader(Builder& builder, const Section& section, const SizesOfStates& sizes);

    const std::string& path() const { return path_; }

    /// The bodies that hold its states, and these by their names.
    void hold(const StateScale& scale);

    /// Its formulas, and what they make of its states.
    void make();

    /// How large its states are, as far as the start and time tell, whether it is stated or not.
    void measure(SizesOfStates& sizes) const;

private:
    [[noreturn]] void refuse(const std::string& code, std::string_view key, const std::string& message,
                             const std::string& value, const std::string& help) const;

    /// How fast state k falls by itself, 1/s.
    double decay_of(std::size_t k, const std::vector<double>& slopes) const;

    /// Of a sampled one also what it says, which holds until it is asked again.
    std::vector<NamedText> held() const;
    bool is_output(const std::string& name) const;

    ReadController& own() { return builder_.controllers()[index_]; }

    std::string part_name(const std::string& kind, std::size_t first) const;
    void check_names() const;
    void check_symbols(const Inputs& inputs) const;
    Expression read(const NamedText& one, const std::string& key, Inputs& inputs);
    bool is_named_later(const std::string& value) const;

    /// An input that nothing reads is a misspelt one in most cases.
    void check_use(const Inputs& inputs, const std::vector<Expression>& of_outputs,
                   const std::vector<Expression>& of_rates) const;

    /// What it tells of itself: states as they are, then outputs.
    std::vector<ReactionLaw::Reading> readings(const std::vector<Expression>& of_outputs);
    static bool is_same(const JointCoordinate& a, const JointCoordinate& b);
    void add_observer(const std::string& name, const std::vector<ReactionLaw::Reading>& told);
    /// What n formulas from the first one on do to a body that holds states.
    Load rates_of_body(std::size_t first, const std::vector<Expression>& of_rates,
                       const std::vector<double>& breaks) const;
    void make_rates(const std::vector<Expression>& of_rates, const std::vector<Expression>& of_outputs);
    void make_sampling();

    Builder& builder_;
    const Section& section_;
    std::string name_, path_;
    bool is_sampled_;
    std::vector<NamedText> rates_, outputs_;
    std::vector<ControllerState> states_{};
    StateScale scale_{};
    std::vector<int> bodies_{};
    std::size_t index_ = 0;   // among the controllers of the builder
    std::vector<std::string> used_{};
    std::vector<Expression> formulas_{};   // of states, in their order
    Inputs inputs_{};
};

}   // namespace livens::inline io_internal
