// SPDX-License-Identifier: BSD-3-Clause
// A tape holds each operation once: what is recorded again is found by its kind and operands.
#include "livens/multibody/loads/load_tape.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "livens/base/elementary.h"
#include "livens/multibody/loads/load_laws.h"

namespace livens::inline multibody_internal {

int TapeStep::size() const
{
    switch (kind) {
    case TapeKind::vector:
    case TapeKind::arm:
    case TapeKind::arm_rate:
    case TapeKind::sum:
    case TapeKind::difference:
    case TapeKind::stretched:
    case TapeKind::cross:
        return 3;
    case TapeKind::time:
    case TapeKind::outer:
        return b;
    case TapeKind::turn:
        return 2;
    case TapeKind::pull:
        return 0;
    default:
        return 1;
    }
}

void LoadTape::begin(const Load& load, int first_angle)
{
    load_ = {load.bodies, first_angle};
    watched_.emplace_back();
}

void LoadTape::watch_guard(TapeNumber number) { watched_.back().guards.push_back(number.place); }

void LoadTape::watch_centre(const std::array<TapeNumber, 3>& centre)
{
    for (const TapeNumber& number : centre) watched_.back().centre.push_back(number.place);
}

void LoadTape::watch_law(std::span<const TapeNumber> numbers, std::span<const TapeNumber> factors)
{
    for (const TapeNumber& number : numbers) watched_.back().numbers.push_back(number.place);
    for (const TapeNumber& factor : factors) watched_.back().factors.push_back(factor.place);
}

int LoadTape::add(TapeStep step)
{
    const bool is_one = step.kind == TapeKind::pull;   // forces add up, also where they are the same
    const std::tuple key{step.kind, step.a, step.b, step.index, step.number};
    if (const auto found = known_.find(key); !is_one && found != known_.end()) return found->second;
    step.place = size_;
    size_ += step.size();
    steps_.push_back(step);
    if (!is_one) known_.emplace(key, step.place);
    return step.place;
}

TapeVector LoadTape::vector(const Vector3& value)
{
    const auto found = std::ranges::find(vectors_, value);
    const int index = static_cast<int>(found - vectors_.begin());
    if (found == vectors_.end()) vectors_.push_back(value);
    const int place = add({TapeKind::vector, -1, -1, -1, index, 0});
    vector_at_[place] = index;
    return {this, place};
}

const Vector3* LoadTape::constant(TapeVector of) const
{
    const auto found = vector_at_.find(of.place);
    return found == vector_at_.end() ? nullptr : &vectors_[static_cast<std::size_t>(found->second)];
}

TapeNumber LoadTape::of_time(const TimeFunction& value)
{
    if (value.is_constant()) return number(value({}).value);
    times_.push_back([value](Instant at) { return Vector3{value(at).value, 0, 0}; });
    return {this, add({TapeKind::time, -1, -1, 1, static_cast<int>(times_.size()) - 1, 0})};
}

TapeVector LoadTape::of_time(const TimeVector& value)
{
    const auto all = [value](Instant at) {
        return Vector3{value[0](at).value, value[1](at).value, value[2](at).value};
    };
    if (std::ranges::all_of(value, [](const TimeFunction& f) { return f.is_constant(); }))
        return vector(all({}));
    return at_instant(all);
}

TapeVector LoadTape::at_instant(OfTime value)
{
    times_.push_back(std::move(value));
    return {this, add({TapeKind::time, -1, -1, 3, static_cast<int>(times_.size()) - 1, 0})};
}

/// Arms are shared by all loads of the tape: the same point of a body is evaluated once.
int LoadTape::find_arm(int side, const Vector4& w)
{
    const int body = load_.bodies[static_cast<std::size_t>(side)];
    const int index = static_cast<int>(arms_.size());
    const auto [at, is_new] = arm_at_.try_emplace({1.0 * body, w[0], w[1], w[2], w[3]}, index);
    if (is_new) arms_.push_back({body, w});
    return at->second;
}

TapeVector LoadTape::arm(int side, const Vector4& w, bool is_rate)
{
    if (load_.bodies[static_cast<std::size_t>(side)] == world)
        return vector(is_rate ? Vector3{} : world_configuration * w);
    const TapeVector v{this,
                       add({is_rate ? TapeKind::arm_rate : TapeKind::arm, -1, -1, -1, find_arm(side, w), 0})};
    return load_.frame.is_none() ? v : as_before(v, is_rate ? 0 : w[0]);
}

MovedLoad::MovedLoad(LoadTape& tape, const Displacement& by) : tape_(tape), before_(tape.load_.frame)
{
    tape.load_.frame = before_.after(by);
}

/// R^T (v - shift p): the columns of R are what its components are along.
TapeVector LoadTape::as_before(TapeVector v, double shift)
{
    v = v - vector(shift * load_.frame.position);
    const auto along = [&](int i) {
        Vector3 axis{};
        axis[i] = 1;
        return dot(vector(load_.frame.rotation.column(i)), v) * vector(axis);
    };
    return along(0) + along(1) + along(2);
}

/// R v.
TapeVector LoadTape::turned(TapeVector v)
{
    if (const Vector3* known = constant(v)) return vector(load_.frame.rotation * *known);
    const auto along = [&](int i) { return v[i] * vector(load_.frame.rotation.column(i)); };
    return along(0) + along(1) + along(2);
}

TapeNumber LoadTape::unwrapped(TapeNumber value, int angle)
{
    return {this, add({TapeKind::unwrapped, -1, value.place, -1, load_.first_angle + angle, 0})};
}

TapeVector LoadTape::outer(Outer call, const std::vector<TapeNumber>& of, int n)
{
    calls_.push_back(std::move(call));
    std::vector<int>& places = inputs_.emplace_back();
    for (const TapeNumber& one : of) places.push_back(one.place);
    return {this, add({TapeKind::outer, -1, -1, n, static_cast<int>(calls_.size()) - 1, 0})};
}

void LoadTape::pull(int side, const Vector4& w, TapeNumber s, TapeVector v)
{
    if (load_.bodies[static_cast<std::size_t>(side)] == world) return;
    if (s.place < 0) s = number(1);
    if (!load_.frame.is_none()) v = turned(v);
    add({TapeKind::pull, -1, s.place, v.place, find_arm(side, w), 0});
}

int LoadTape::index_of(Function function)
{
    const auto found = std::ranges::find(functions_, function);
    const int index = static_cast<int>(found - functions_.begin());
    if (found == functions_.end()) functions_.push_back(function);
    return index;
}

/// What has no place is the factor one, and costs no step.
TapeNumber operator*(TapeNumber a, TapeNumber b)
{
    if (a.place < 0) return b;
    return b.place < 0 ? a : made(TapeKind::times, a, b.place);
}

TapeNumber operator*(double a, TapeNumber b)
{
    if (b.place < 0) return b.tape->number(a);
    return a == 1 ? b : made(TapeKind::scaled, b, -1, a);
}

TapeNumber operator+(double a, TapeNumber b) { return a == 0 ? b : made(TapeKind::shifted, b, -1, a); }

TapeNumber function_of(LoadTape::Function function, TapeNumber a, TapeNumber b)
{
    LoadTape& tape = *a.tape;
    return {&tape, tape.add({TapeKind::function, -1, a.place, b.place, tape.index_of(function), 0})};
}

TapeVector operator+(TapeVector a, TapeVector b)
{
    return {a.tape, a.tape->add({TapeKind::sum, -1, a.place, b.place, -1, 0})};
}

/// Nothing is taken off for a constant zero, as for the world's origin.
TapeVector operator-(TapeVector a, TapeVector b)
{
    if (const Vector3* v = a.tape->constant(b); v != nullptr && *v == Vector3{}) return a;
    return {a.tape, a.tape->add({TapeKind::difference, -1, a.place, b.place, -1, 0})};
}

TapeVector operator*(TapeNumber a, TapeVector b)
{
    return {a.tape, a.tape->add({TapeKind::stretched, -1, a.place, b.place, -1, 0})};
}

TapeVector cross(TapeVector a, TapeVector b)
{
    return {a.tape, a.tape->add({TapeKind::cross, -1, a.place, b.place, -1, 0})};
}

int only_component(const Vector3& v)
{
    int only = -1;
    for (int i = 0; i < 3; ++i) {
        if (v[i] == 0) continue;
        if (only >= 0) return -1;
        only = i;
    }
    return only;
}

/// With a constant along one axis it is a component of the other, which is there already.
TapeNumber dot(TapeVector a, TapeVector b)
{
    const Vector3* c = a.tape->constant(a);
    if (const int axis = c == nullptr ? -1 : only_component(*c); axis >= 0) return (*c)[axis] * b[axis];
    return {a.tape, a.tape->add({TapeKind::dot, -1, a.place, b.place, -1, 0})};
}

}   // namespace livens::inline multibody_internal

namespace livens {

namespace {

/// One operation of an expression on a tape, of operands that are there.
TapeNumber recorded(const Expression::Step& step, const std::vector<TapeNumber>& known)
{
    using Operation = Expression::Operation;
    const auto of = [&](int place) {
        return place >= 0 ? known[static_cast<std::size_t>(place)] : TapeNumber{};
    };
    const TapeNumber a = of(step.first), b = of(step.second);
    const auto applied = [&](LoadTape::Function function) { return function_of(function, a, a); };
    switch (step.operation) {
    case Operation::negative:
        return -a;
    case Operation::plus:
        return a + b;
    case Operation::minus:
        return a - b;
    case Operation::times:
        return a * b;
    case Operation::divided:
        return a / b;
    case Operation::power:
        return function_of(&power, a, b);
    case Operation::sine:
        return applied([](double x, double) { return sine_cosine(x).sine; });
    case Operation::cosine:
        return applied([](double x, double) { return sine_cosine(x).cosine; });
    case Operation::tangent:
        return recorded({Operation::sine, step.first}, known) /
               recorded({Operation::cosine, step.first}, known);
    case Operation::hyperbolic_tangent:
        return applied([](double x, double) { return hyperbolic_tangent(x); });
    case Operation::exponential:
        return applied([](double x, double) { return exponential(x); });
    case Operation::logarithm:
        return applied([](double x, double) { return logarithm(x); });
    case Operation::root:
        return root(a);
    case Operation::absolute:
        return made(TapeKind::absolute, a);
    case Operation::arc_tangent:
        return function_of(&arc_tangent, a, b);
    case Operation::least:
        return made(TapeKind::least, a, b.place);
    case Operation::greatest:
        return made(TapeKind::greatest, a, b.place);
    case Operation::sign:
        return applied([](double x, double) { return x > 0 ? 1.0 : x < 0 ? -1.0 : 0 * x; });
    case Operation::floor:
        return applied([](double x, double) { return std::floor(x); });
    default:
        return {};
    }
}

/// What Expression::guarded tells.
void watch(LoadTape& tape, const Expression& expression, const std::vector<TapeNumber>& known)
{
    using Operation = Expression::Operation;
    for (const int k : expression.guarded_steps()) {
        const Expression::Step& step = expression.steps()[static_cast<std::size_t>(k)];
        const TapeNumber first = known[static_cast<std::size_t>(step.first)];
        if (step.operation == Operation::arc_tangent)
            tape.watch_guard(known[static_cast<std::size_t>(k)]);
        else if (step.second < 0)
            tape.watch_guard(first);
        else
            tape.watch_guard(first - known[static_cast<std::size_t>(step.second)]);
    }
}

}   // namespace

/// At a break the time that expressions see is on the side of the instant, so that they take the piece of
/// that side.
RecordedLaw recorded_law(const std::vector<Expression>& expressions, const std::vector<LawRead>& reads,
                         const std::vector<double>& breaks, const TimeFunction& acts)
{
    const TimeFunction time([breaks](Instant at) { return TimeValue{beside_breaks(at, breaks), 1, 0}; }, {});
    return [expressions, reads, time, acts](const LawOnTape& at, std::span<TapeNumber> factors) {
        for (std::size_t i = 0; i < expressions.size(); ++i) {
            std::vector<TapeNumber> known;
            for (const Expression::Step& step : expressions[i].steps()) {
                if (step.operation == Expression::Operation::symbol) {
                    const LawRead& read = reads[static_cast<std::size_t>(step.first)];
                    known.push_back((read.is_rate ? at.rate : at.value)(read.coordinate));
                } else if (step.operation == Expression::Operation::number) {
                    known.push_back(at.tape.number(step.number));
                } else if (step.operation == Expression::Operation::time) {
                    known.push_back(at.tape.of_time(time));
                } else {
                    known.push_back(recorded(step, known));
                }
            }
            watch(at.tape, expressions[i], known);
            factors[i] = acts.is_constant() ? known.back() : chosen(at.tape.of_time(acts), known.back());
        }
    };
}

}   // namespace livens
