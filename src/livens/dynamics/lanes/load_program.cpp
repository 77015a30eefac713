// SPDX-License-Identifier: BSD-3-Clause
// From tapes to steps: what no force hangs on is left out, arms are taken about centres of mass, and forces
// on arms are gathered into the columns of F (docs/theory.md, "Without a tangent", Loads in lanes).
#include "livens/dynamics/lanes/load_program.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "livens/multibody/model.h"

namespace livens {

namespace {

bool is_bent(const Load& load) { return !load.guards.empty() || load.bends_at_centre; }

bool is_recorded(const Load& load, RecordedLoads which)
{
    if (!load.forces.record || (is_bent(load) && which == RecordedLoads::without_bends)) return false;
    return which != RecordedLoads::supplies || !load.power || load.recorded_power;
}

/// Sums of what pulls are.
class SupplySums {
public:
    explicit SupplySums(LoadTape& tape) : tape_(tape) {}

    void add_pull(const TapeStep& pull, double length, bool has_power)
    {
        const TapeVector f = TapeNumber{&tape_, pull.a} * TapeVector{&tape_, pull.b};
        const double at_point = tape_.arms()[static_cast<std::size_t>(pull.index)].w[0];
        const TapeVector x = tape_.arm_at(pull.index);
        const TapeNumber size = root(dot(f, f));
        if (at_point != 0) {   // others act on directors alone: moments
            add(force_, at_point == 1 ? f : tape_.number(at_point) * f);
            add(gross_, std::abs(at_point) * size);
        }
        add(moment_, cross(x, f));
        add(gross_moment_, size * (std::abs(at_point) * length + root(dot(x, x))));
        if (has_power) add_power(dot(tape_.arm_at(pull.index, true), f));
    }
    void add_power(TapeNumber power) { add(power_, power); }

    SupplyOnTape ask()
    {
        for (TapeVector* v : {&force_, &moment_})
            if (v->place < 0) *v = tape_.vector({});
        for (TapeNumber* number : {&gross_, &gross_moment_, &power_})
            if (number->place < 0) *number = tape_.number(0);
        for (const int place : {force_.place, moment_.place, gross_.place, gross_moment_.place, power_.place})
            tape_.ask({&tape_, place});
        return {force_.place, moment_.place, gross_.place, gross_moment_.place, power_.place};
    }

private:
    template <class Sum>
    static void add(Sum& sum, Sum more)
    {
        sum = sum.place < 0 ? more : sum + more;
    }

    LoadTape& tape_;
    TapeVector force_, moment_;
    TapeNumber gross_, gross_moment_, power_;
};

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
                                                {arm_rate, Lane::arm},
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
                                                {turn, Lane::turn},
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
    const std::vector<char> needed = find_needed(which), known = find_known();
    join(needed, known);
    n_registers_ = tape_.size();
    forces_.assign(tape_.arms().size(), -1);
    add_arms(tables, needed);
    for (std::size_t i = 0; i < tape_.steps().size(); ++i) {
        const TapeStep& step = tape_.steps()[i];
        const bool is_arm = step.kind == TapeKind::arm || step.kind == TapeKind::arm_rate;
        if (is_arm && arm_at_[static_cast<std::size_t>(step.index)] >= 0) continue;   // in its register
        if (needed[i] && !is_taken_[i] && !is_given(step.kind))
            add_step(tables, i, known[i] ? known_steps_ : steps_);
    }
    add_columns(tables);
    add_forces(tables);
}

void LoadProgram::record(const Model& model, RecordedLoads which)
{
    int first_angle = 0;
    SupplySums sums(tape_);
    if (which == RecordedLoads::laws) tape_.take_looks();
    for (std::size_t l = 0; l < model.loads().size(); ++l) {
        const Load& load = model.loads()[l];
        tape_.begin(load, first_angle);
        first_angle += static_cast<int>(load.angles.size());
        if (!is_recorded(load, which)) {
            others_.push_back(static_cast<int>(l));
            continue;
        }
        const std::size_t first = tape_.steps().size();
        load.forces.record(tape_, TapeNumber{&tape_});
        if (which != RecordedLoads::supplies || acts_on_states(model, load)) continue;
        const bool has_power = !load.power && !load.potential;
        for (std::size_t i = first, end = tape_.steps().size(); i < end; ++i)
            if (const TapeStep step = tape_.steps()[i]; step.kind == TapeKind::pull)
                sums.add_pull(step, model.length(), has_power);
        if (load.recorded_power) sums.add_power(load.recorded_power(tape_));
    }
    if (which == RecordedLoads::supplies && !model.loads().empty()) supply_ = sums.ask();
}

/// Of each place the step whose number is there.
std::vector<int> LoadProgram::find_steps() const
{
    const std::vector<TapeStep>& steps = tape_.steps();
    std::vector<int> step_at(static_cast<std::size_t>(tape_.size()));
    for (std::size_t i = 0; i < steps.size(); ++i)
        for (int k = 0; k < steps[i].size(); ++k) step_at[steps[i].place + k] = static_cast<int>(i);
    return step_at;
}

/// Products that one sum alone takes are formed there: steps cost more than what they do.
void LoadProgram::join(const std::vector<char>& needed, const std::vector<char>& known)
{
    const std::vector<TapeStep>& steps = tape_.steps();
    const std::vector<int> step_at = find_steps();
    std::vector<int> n_uses(steps.size(), 0);
    for (std::size_t i = 0; i < steps.size(); ++i)
        if (needed[i]) for_operands(tape_, steps[i], [&](int place) { ++n_uses[step_at[place]]; });
    for (const TapeWatch& watch : tape_.watched())
        for (const auto* places :
             {&watch.guards, &watch.centre, &watch.numbers, &watch.factors, &watch.asked})
            for (const int place : *places) ++n_uses[step_at[place]];
    takes_.assign(steps.size(), -1);
    is_taken_.assign(steps.size(), 0);
    for (std::size_t i = 0; i < steps.size(); ++i) {
        const TapeStep& sum = steps[i];
        if (!needed[i] || known[i] || (sum.kind != TapeKind::plus && sum.kind != TapeKind::minus)) continue;
        const auto fits = [&](int place) {
            const int j = step_at[place];
            const TapeKind kind = steps[j].kind;
            const bool is_product = kind == TapeKind::scaled || kind == TapeKind::times ||
                                    (kind == TapeKind::dot && sum.kind == TapeKind::plus);
            return is_product && n_uses[j] == 1 && !known[j];
        };
        if (fits(sum.b))
            takes_[i] = step_at[sum.b];
        else if (sum.kind == TapeKind::plus && fits(sum.a))
            takes_[i] = step_at[sum.a];
        if (takes_[i] >= 0) is_taken_[static_cast<std::size_t>(takes_[i])] = 1;
    }
}

/// Steps that forces hang on, and those that are watched.
std::vector<char> LoadProgram::find_needed(RecordedLoads which) const
{
    const std::vector<TapeStep>& steps = tape_.steps();
    const std::vector<int> step_at = find_steps();
    std::vector<char> needed(steps.size(), 0);
    const bool are_forces = which == RecordedLoads::all || which == RecordedLoads::without_bends;
    for (const TapeWatch& watch : tape_.watched())
        for (const std::vector<int>* places : watched_of(watch, which))
            for (const int place : *places) needed[step_at[place]] = 1;
    // Backwards: operands come before the steps that take them.
    for (std::size_t i = steps.size(); i-- > 0;) {
        needed[i] = needed[i] || (steps[i].kind == TapeKind::pull && are_forces);
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

void LoadProgram::add_step(const ModelTables& tables, std::size_t i, std::vector<lanes::LoadStep>& to)
{
    const TapeStep& step = tape_.steps()[i];
    lanes::LoadStep made{in_lanes(step.kind), step.place, step.a,      step.b,
                         step.index,          step.b,     step.number, nullptr};
    switch (step.kind) {
    case TapeKind::arm:
    case TapeKind::arm_rate:
        add_terms(tables, step, made);
        break;
    case TapeKind::turn:
        made.turn = &turn_of_sine;
        break;
    case TapeKind::function:
        made.function = tape_.functions()[static_cast<std::size_t>(step.index)];
        break;
    case TapeKind::pull:
        made = made_pull(step, made);
        break;
    case TapeKind::plus:
    case TapeKind::minus:
        take_product(i, made);
        break;
    default:
        break;
    }
    to.push_back(made);
}

/// A sum with the product that it takes in.
void LoadProgram::take_product(std::size_t i, lanes::LoadStep& made) const
{
    if (takes_[i] < 0) return;
    const TapeStep &step = tape_.steps()[i], &product = tape_.steps()[static_cast<std::size_t>(takes_[i])];
    const double sign = step.kind == TapeKind::minus ? -1 : 1;
    made.a = product.place == step.b ? step.a : step.b;
    made.b = product.a;
    made.begin = product.b;
    made.number = sign;
    if (product.kind == TapeKind::scaled) {
        made.kind = lanes::LoadKind::plus_scaled;
        made.number = sign * product.number;
    } else {
        made.kind =
            product.kind == TapeKind::times ? lanes::LoadKind::plus_product : lanes::LoadKind::plus_dot;
    }
}

/// Onto the force of an arm, which begins with the first pull.
/// That one sets the registers, so that nobody has to clear them.
lanes::LoadStep LoadProgram::made_pull(const TapeStep& step, lanes::LoadStep made)
{
    int& force = forces_[static_cast<std::size_t>(step.index)];
    const Vector3* of = tape_.constant({nullptr, step.b});
    const int axis = of == nullptr ? -1 : only_component(*of);
    if (force < 0) {
        made.kind = lanes::LoadKind::first_pull;
        force = n_registers_;
        n_registers_ += 3;
    } else if (axis >= 0) {
        made.kind = lanes::LoadKind::pull_one;
        made.number = (*of)[axis];
        made.to = force + axis;
        return made;
    }
    made.to = force;
    return made;
}

std::shared_ptr<const LoadProgram> LoadProgram::of(const ModelTables& tables, RecordedLoads which)
{
    KnownPattern& all = *tables.known_pattern;
    if (which == RecordedLoads::without_bends && std::ranges::none_of(tables.model->loads(), &is_bent))
        which = RecordedLoads::all;
    std::shared_ptr<const LoadProgram>& known = all.loads[static_cast<std::size_t>(which)];
    if (known == nullptr) known = std::make_shared<LoadProgram>(tables, which);
    return known;
}

}   // namespace livens
