// SPDX-License-Identifier: BSD-3-Clause
// What a program looks at of bodies, and forces on them: by material vectors, or by columns of X where these
// are fewer (docs/theory.md, "Without a tangent", Loads in lanes).
#include <algorithm>

#include "livens/dynamics/lanes/load_program.h"
#include "livens/multibody/model.h"

namespace livens {

namespace {

/// X w = x_c w_0 + sum d_a (w_a - w_0 c_a) with the centre of mass (1, c): the factor of column a.
double centred(const ModelTables& tables, const TapeArm& arm, int a)
{
    return a == 0 ? arm.w[0] : arm.w[a] - arm.w[0] * tables.bodies[arm.body].center[a - 1];
}

std::vector<lanes::Term> terms_of(const ModelTables& tables, const TapeArm& arm)
{
    std::vector<lanes::Term> terms;
    for (int a = 0; a < 4; ++a)
        if (const double w = centred(tables, arm, a); w != 0) terms.push_back({12 * arm.body + 3 * a, w});
    return terms;
}

}   // namespace

/// Whether some arms of a body are fewer than the columns that they reach.
bool LoadProgram::are_few(const ModelTables& tables, const std::vector<int>& arms) const
{
    std::size_t n_columns = 0;
    for (int a = 0; a < 4; ++a)
        n_columns += std::ranges::any_of(
            arms, [&](int k) { return centred(tables, tape_.arms()[static_cast<std::size_t>(k)], a) != 0; });
    return arms.size() <= n_columns;
}

/// Arms of each body, of those that are marked.
std::vector<std::vector<int>> LoadProgram::by_body(const ModelTables& tables,
                                                   const std::vector<char>& marked) const
{
    std::vector<std::vector<int>> arms(tables.bodies.size());
    for (std::size_t k = 0; k < marked.size(); ++k)
        if (marked[k]) arms[static_cast<std::size_t>(tape_.arms()[k].body)].push_back(static_cast<int>(k));
    return arms;
}

/// What loads look at of each body.
void LoadProgram::add_arms(const ModelTables& tables, const std::vector<char>& needed)
{
    arm_at_.assign(tape_.arms().size(), -1);
    column_at_.assign(12 * tables.bodies.size(), 0);
    std::vector<char> used(tape_.arms().size(), 0);
    for (std::size_t i = 0; i < needed.size(); ++i) {
        const TapeStep& step = tape_.steps()[i];
        if (needed[i] && (step.kind == TapeKind::arm || step.kind == TapeKind::arm_rate))
            used[static_cast<std::size_t>(step.index)] = 1;
    }
    for (const std::vector<int>& arms : by_body(tables, used))
        for (const int k : arms)
            if (are_few(tables, arms)) arm_at_[static_cast<std::size_t>(k)] = 0;
    for (std::size_t i = 0; i < needed.size(); ++i) {
        const TapeStep& step = tape_.steps()[i];
        if (needed[i] && (step.kind == TapeKind::arm || step.kind == TapeKind::arm_rate))
            add_arm(tables, step);
    }
}

/// Of what loads look at: an arm or a column.
int& LoadProgram::register_of(int& at, bool is_rate, const std::vector<lanes::Term>& terms)
{
    if (at == 0) {
        const auto begin = static_cast<std::int32_t>(terms_.size());
        terms_.insert(terms_.end(), terms.begin(), terms.end());
        arms_.push_back({begin, static_cast<std::int32_t>(terms_.size()), -1, -1});
        at = static_cast<int>(arms_.size());
    }
    lanes::LoadArm& arm = arms_[static_cast<std::size_t>(at - 1)];
    return is_rate ? arm.rate : arm.to;
}

/// An arm that is known, or the columns that it is made of.
void LoadProgram::add_arm(const ModelTables& tables, const TapeStep& step)
{
    const TapeArm& arm = tape_.arms()[static_cast<std::size_t>(step.index)];
    const bool is_rate = step.kind == TapeKind::arm_rate;
    const std::vector<lanes::Term> terms = terms_of(tables, arm);
    if (int& at = arm_at_[static_cast<std::size_t>(step.index)]; at >= 0) {
        register_of(at, is_rate, terms) = step.place;
        return;
    }
    for (const lanes::Term& term : terms) {
        int& column =
            register_of(column_at_[static_cast<std::size_t>(term.number)], is_rate, {{term.number, 1}});
        if (column >= 0) continue;
        column = n_registers_;
        n_registers_ += 3;
    }
}

/// Of an arm that is made of columns.
void LoadProgram::add_terms(const ModelTables& tables, const TapeStep& step, lanes::LoadStep& made)
{
    made.begin = static_cast<std::int32_t>(terms_.size());
    for (const lanes::Term& term : terms_of(tables, tape_.arms()[static_cast<std::size_t>(step.index)])) {
        const int at = column_at_[static_cast<std::size_t>(term.number)];
        const lanes::LoadArm& column = arms_[static_cast<std::size_t>(at - 1)];
        terms_.push_back({step.kind == TapeKind::arm ? column.to : column.rate, term.factor});
    }
    made.end = static_cast<std::int32_t>(terms_.size());
}

/// Arms that forces are on.
std::vector<char> LoadProgram::find_pulled() const
{
    std::vector<char> pulled;
    for (const int force : forces_) pulled.push_back(force >= 0);
    return pulled;
}

/// Four columns for each body with loads, zero where no arm reaches.
void LoadProgram::add_columns(const ModelTables& tables)
{
    std::vector<char> is_loaded(static_cast<std::size_t>(tables.n_bodies()), 0);
    for (const Load& load : tables.model->loads())
        for (const int body : load.bodies)
            if (body != world) is_loaded[static_cast<std::size_t>(body)] = 1;
    const std::vector<std::vector<int>> arms_of = by_body(tables, find_pulled());
    for (int b = 0; b < tables.n_bodies(); ++b)
        for (int a = 0; is_loaded[static_cast<std::size_t>(b)] && a < 4; ++a) {
            const auto begin = static_cast<std::int32_t>(terms_.size());
            for (const int k : arms_of[static_cast<std::size_t>(b)])
                if (const double w = centred(tables, tape_.arms()[k], a); w != 0)
                    terms_.push_back({forces_[k], w});
            columns_.push_back({12 * b + 3 * a, begin, static_cast<std::int32_t>(terms_.size())});
        }
}

/// Forces on each body by its arms, or by its columns where these are fewer.
void LoadProgram::add_forces(const ModelTables& tables)
{
    const std::vector<std::vector<int>> pulled = by_body(tables, find_pulled());
    const auto add = [this](lanes::Term from, const std::vector<lanes::Term>& to) {
        const auto begin = static_cast<std::int32_t>(terms_.size());
        terms_.push_back(from);
        terms_.insert(terms_.end(), to.begin(), to.end());
        forces_of_.push_back({begin, begin + 1, begin + 1, static_cast<std::int32_t>(terms_.size())});
    };
    for (const lanes::LoadColumn& column : columns_) {
        const std::vector<int>& arms = pulled[static_cast<std::size_t>(column.number / 12)];
        const bool is_few = are_few(tables, arms);
        if (!is_few && column.begin < column.end) {
            const auto first = static_cast<std::int32_t>(terms_.size());
            terms_.push_back({column.number, 1});
            forces_of_.push_back({column.begin, column.end, first, first + 1});
        }
        if (!is_few || column.number % 12 != 0) continue;
        for (const int k : arms)
            add({forces_[k], 1}, terms_of(tables, tape_.arms()[static_cast<std::size_t>(k)]));
    }
}

}   // namespace livens
