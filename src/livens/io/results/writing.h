// SPDX-License-Identifier: BSD-3-Clause
// An archive (see layout.h) that writes: first everything is declared, then the values follow.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "livens/io/results/layout.h"

namespace livens::inline io_internal {

/// Values are kept as views where they are and as functions where they are made, so that no more memory is
/// taken than the header's and what a function needs at a time. Empty parts are left out.
class RunWriter {
public:
    explicit RunWriter(ClassicWriter& file) : file_(file) {}

    ClassicWriter& file() { return file_; }
    /// Declares a variable of so many values; dimensions come into being by the way.
    int declare(const VariableInfo& info, NumberType type, std::size_t n_values);
    /// Called in this order, when everything is declared.
    void later(std::function<void()> work) { work_.push_back(std::move(work)); }
    void write(const ByteSink& sink);

    void figures(const Run& run);
    template <class Choice>
    void choice(const std::string& name, Choice value, Choice)
    {
        file_.attribute(name, std::string(to_string(value)));
    }
    void word(const std::string& name, const std::string& value) { file_.attribute(name, value); }
    void text(const std::string& name, const char* meaning, const std::string& value);
    /// A name for each place along a dimension, by default one of that name.
    void names(const std::string& name, const char* meaning, const std::vector<std::string>& values,
               const std::string& dimension = "");
    void flags(const VariableInfo& info, const std::vector<bool>& values);
    void field(VariableInfo info, const Field& field);

    /// The values must live until write().
    template <class Number>
    void view(const VariableInfo& info, NumberType type, std::span<const Number> values)
    {
        if (values.empty()) return;
        const int variable = declare(info, type, values.size());
        later([this, variable, values] { file_.append(variable, values); });
    }
    template <class T>
    void list(const VariableInfo& info, const std::vector<T>& values)
    {
        if constexpr (is_matrix<T>)
            view(info, NumberType::real, numbers(values));
        else
            view(info, std::is_same_v<T, int> ? NumberType::integer : NumberType::real,
                 std::span<const T>(values));
    }

    /// The values are kept until then.
    template <class T>
    void list(const VariableInfo& info, std::vector<T>&& values)
    {
        const auto kept = std::make_shared<const std::vector<T>>(std::move(values));
        list(info, *kept);
        later([kept] {});
    }

private:
    void bytes(const VariableInfo& info, NumberType type, std::string values);

    ClassicWriter& file_;
    std::vector<std::function<void()>> work_;
};

/// What is in the file for readers other than livens, made from model and run while it is written: samples at
/// the output times, times of nodes, masses, integrals over elements.
/// Without samples: of a part of a motion, whose turns are not counted from its start.
void write_derived(RunWriter& archive, const Model& model, const Run& run, bool has_samples = true);
/// The samples among them.
void write_samples(RunWriter& archive, const Model& model, const Run& run);

}   // namespace livens::inline io_internal
