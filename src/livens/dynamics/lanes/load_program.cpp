// SPDX-License-Identifier: BSD-3-Clause
// From tapes to steps: what no force hangs on is left out, arms are taken about centres of mass, and forces
// on arms are gathered into the columns of F (docs/theory.md, "Without a tangent", Loads in lanes).
#include "livens/dynamics/lanes/load_program.h"

#include <algorithm>
#include <map>

#include "livens/multibody/model.h"

namespace livens {

namespace {

/// What is the same wherever bodies are.
bool is_given(TapeKind kind)
{
    return kind == TapeKind::number || kind == TapeKind::vector || kind == TapeKind::time;
}

lanes::LoadKind in_lanes(TapeKind kind)
{
    using enum TapeKind;
    using Lane = lanes::LoadKind;
    static const std::map<TapeKind, Lane> kinds{{arm, Lane::arm},
                                                {arm_rate, Lane::arm_rate},
                                                {plus, Lane::plus},
                                                {minus, Lane::minus},
                                                {times, Lane::times},
                                                {divided, Lane::divided},
                                                {scaled, Lane::scaled},
                                                {shifted, Lane::shifted},
                                                {root, Lane::root},
                                                {absolute, Lane::absolute},
                                                {inverse, Lane::inverse},
                                                {least, Lane::least},
                                                {greatest, Lane::greatest},
                                                {chosen, Lane::chosen},
                                                {function, Lane::function},
                                                {unwrapped, Lane::unwrapped},
                                                {outer, Lane::outer},
                                                {sum, Lane::sum},
                                                {difference, Lane::difference},
                                                {stretched, Lane::stretched},
                                                {cross, Lane::cross},
                                                {dot, Lane::dot},
                                                {pull, Lane::pull}};
    return kinds.at(kind);
}

/// X w = x_c w_0 + sum d_a (w_a - w_0 c_a) with the centre of mass (1, c): the factor of column a.
double centred(const ModelTables& tables, const TapeArm& arm, int a)
{
    return a == 0 ? arm.w[0] : arm.w[a] - arm.w[0] * tables.bodies[arm.body].center[a - 1];
}

/// act(place) for the numbers that a step takes.
template <class Act>
void for_operands(const LoadTape& tape, const TapeStep& step, const Act& act)
{
    if (step.kind == TapeKind::outer) {
        for (const int place : tape.inputs()[static_cast<std::size_t>(step.index)]) act(place);
        return;
    }
    if (step.kind == TapeKind::time) return;
    if (step.a >= 0) act(step.a);
    if (step.b >= 0) act(step.b);
}

}   // namespace

LoadProgram::LoadProgram(const ModelTables& tables, RecordedLoads which)
{
    record(*tables.model, which);
    const std::vector<char> needed = find_needed(), known = find_known();
    n_registers_ = tape_.size();
    forces_.assign(tape_.arms().size(), -1);
    for (std::size_t i = 0; i < tape_.steps().size(); ++i) {
        const TapeStep& step = tape_.steps()[i];
        if (needed[i] && !is_given(step.kind)) add_step(tables, step, known[i] ? known_steps_ : steps_);
    }
    add_columns(tables);
}

void LoadProgram::record(const Model& model, RecordedLoads which)
{
    int first_angle = 0;
    for (std::size_t l = 0; l < model.loads().size(); ++l) {
        const Load& load = model.loads()[l];
        tape_.begin(load, first_angle);
        first_angle += static_cast<int>(load.angles.size());
        const bool bends = !load.guards.empty() || load.bends_at_centre;
        if (load.forces.record && !(bends && which == RecordedLoads::without_bends))
            load.forces.record(tape_, TapeNumber{&tape_});
        else
            others_.push_back(static_cast<int>(l));
    }
}

/// Steps that forces hang on.
std::vector<char> LoadProgram::find_needed() const
{
    const std::vector<TapeStep>& steps = tape_.steps();
    std::vector<int> step_at(static_cast<std::size_t>(tape_.size()));
    for (std::size_t i = 0; i < steps.size(); ++i)
        for (int k = 0; k < steps[i].size(); ++k) step_at[steps[i].place + k] = static_cast<int>(i);
    std::vector<char> needed(steps.size(), 0);
    for (std::size_t i = steps.size(); i-- > 0;) {
        needed[i] = needed[i] || steps[i].kind == TapeKind::pull;
        if (needed[i]) for_operands(tape_, steps[i], [&](int place) { needed[step_at[place]] = 1; });
    }
    return needed;
}

/// Steps that time alone decides.
std::vector<char> LoadProgram::find_known() const
{
    std::vector<char> known(tape_.steps().size(), 0), known_at(static_cast<std::size_t>(tape_.size()), 0);
    for (std::size_t i = 0; i < known.size(); ++i) {
        const TapeStep& step = tape_.steps()[i];
        using enum TapeKind;
        bool is_known = step.kind != arm && step.kind != arm_rate && step.kind != pull && step.kind != outer;
        for_operands(tape_, step, [&](int place) { is_known = is_known && known_at[place]; });
        known[i] = is_known;
        for (int k = 0; k < step.size(); ++k) known_at[step.place + k] = is_known;
    }
    return known;
}

void LoadProgram::add_arm(const ModelTables& tables, const TapeArm& arm, std::int32_t& begin,
                          std::int32_t& end)
{
    begin = static_cast<std::int32_t>(terms_.size());
    for (int a = 0; a < 4; ++a)
        if (const double w = centred(tables, arm, a); w != 0) terms_.push_back({12 * arm.body + 3 * a, w});
    end = static_cast<std::int32_t>(terms_.size());
}

void LoadProgram::add_step(const ModelTables& tables, const TapeStep& step, std::vector<lanes::LoadStep>& to)
{
    lanes::LoadStep made{in_lanes(step.kind), step.place, step.a,      step.b,
                         step.index,          step.b,     step.number, nullptr};
    switch (step.kind) {
    case TapeKind::arm:
    case TapeKind::arm_rate:
        add_arm(tables, tape_.arms()[static_cast<std::size_t>(step.index)], made.begin, made.end);
        break;
    case TapeKind::function:
        made.function = tape_.functions()[static_cast<std::size_t>(step.index)];
        break;
    case TapeKind::pull: {
        int& force = forces_[static_cast<std::size_t>(step.index)];
        if (force < 0) {
            made.kind = lanes::LoadKind::first_pull;
            force = n_registers_;
            n_registers_ += 3;
        }
        made.to = force;
        break;
    }
    default:
        break;
    }
    to.push_back(made);
}

/// Four columns for each body with loads, zero where no arm reaches.
void LoadProgram::add_columns(const ModelTables& tables)
{
    std::vector<char> is_loaded(static_cast<std::size_t>(tables.n_bodies()), 0);
    for (const Load& load : tables.model->loads())
        for (const int body : load.bodies)
            if (body != world) is_loaded[static_cast<std::size_t>(body)] = 1;
    std::vector<std::vector<std::size_t>> arms_of(is_loaded.size());
    for (std::size_t k = 0; k < forces_.size(); ++k)
        if (forces_[k] >= 0) arms_of[static_cast<std::size_t>(tape_.arms()[k].body)].push_back(k);
    for (int b = 0; b < tables.n_bodies(); ++b)
        for (int a = 0; is_loaded[static_cast<std::size_t>(b)] && a < 4; ++a) {
            const auto begin = static_cast<std::int32_t>(terms_.size());
            for (const std::size_t k : arms_of[static_cast<std::size_t>(b)])
                if (const double w = centred(tables, tape_.arms()[k], a); w != 0)
                    terms_.push_back({forces_[k], w});
            columns_.push_back({12 * b + 3 * a, begin, static_cast<std::int32_t>(terms_.size())});
        }
}

std::shared_ptr<const LoadProgram> LoadProgram::of(const ModelTables& tables, RecordedLoads which)
{
    KnownPattern& all = *tables.known_pattern;
    std::shared_ptr<const LoadProgram>& known =
        which == RecordedLoads::all ? all.loads : all.loads_without_bends;
    if (known == nullptr) known = std::make_shared<LoadProgram>(tables, which);
    return known;
}

}   // namespace livens
