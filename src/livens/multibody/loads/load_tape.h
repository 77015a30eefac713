// SPDX-License-Identifier: BSD-3-Clause
// What loads do, as a tape: a list of operations on numbers and vectors, which lanes run at many instants
// side by side (docs/theory.md, "Without a tangent", Loads in lanes).
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <tuple>
#include <vector>

#include "livens/multibody/displacement.h"
#include "livens/multibody/loads.h"

namespace livens::inline multibody_internal {

class LoadTape;

/// A number of a tape: the place of what is evaluated there; as a factor that has none, 1.
struct TapeNumber {
    LoadTape* tape = nullptr;
    int place = -1;
};
/// Three numbers, one after the other.
struct TapeVector {
    LoadTape* tape = nullptr;
    int place = -1;

    TapeNumber operator[](int k) const { return {tape, place + k}; }
};

enum class TapeKind : std::uint8_t {
    // known before an element is solved
    number,   ///< `number`
    vector,   ///< vectors[index]
    time,     ///< times[index] at the instant, the first b of three
    // of the configuration: X w and X' w of arms[index]
    arm,
    arm_rate,
    // of numbers
    plus,
    minus,
    times,
    divided,
    scaled,      ///< number times a
    shifted,     ///< number plus a
    root,        ///< of a
    absolute,    ///< of a
    inverse,     ///< 1 / a, and 0 where a is not positive
    least,       ///< of a and b; b only if it is smaller
    greatest,    ///< of a and b; b only if it is larger
    chosen,      ///< b where a is not 0, else 0
    function,    ///< functions[index] of a and b
    turn,        ///< two numbers of a and b: see turn_of_sine()
    unwrapped,   ///< the angle a by whole turns next to what angle `index` is at the instant before
    outer,       ///< of the numbers inputs[index]: calls[index]; its results follow, b numbers
    // of vectors
    sum,
    difference,
    stretched,   ///< number a times vector b
    cross,
    dot,   ///< a number
    // without a value
    pull   ///< number a times vector b on arms[index]
};

struct TapeStep {
    TapeKind kind{};
    int place = -1;   ///< of its first number
    int a = -1, b = -1;
    int index = -1;
    double number = 0;

    /// How many numbers it has.
    int size() const;
};

/// A material vector of a body of the model: a direction (0, a) or a point (1, theta).
struct TapeArm {
    int body;
    Vector4 w;
};

/// What Load::guarded and Load::centre say, where a load has recorded it: places of their numbers. And, where
/// the tape is for looks, what LawInside says. And what is asked for by name.
struct TapeWatch {
    std::vector<int> guards, centre;
    std::vector<int> numbers, factors;
    std::vector<int> asked;
};

/// The load that is being recorded.
struct TapedLoad {
    std::vector<int> bodies{};
    int first_angle = 0;
    Displacement frame{};   ///< by which it was moved since it was stated
};

/// What is recorded twice is evaluated once. Forces leave by pull(): F of a body is the sum of s v w^T over
/// material vectors X w, its arms.
class LoadTape {   // named in a public header: what it does is still no library's
public:
    using OfTime = std::function<Vector3(Instant)>;
    using Function = double (*)(double, double);
    using Outer = std::function<void(Instant, std::span<const double>, std::span<double>)>;

    /// What follows is of this load: its bodies are meant by their places in it, its angles begin at number
    /// `first_angle` of the model's.
    [[gnu::visibility("hidden")]] void begin(const Load& load, int first_angle);

    TapeNumber number(double value) { return {this, add({TapeKind::number, -1, -1, -1, -1, value})}; }
    [[gnu::visibility("hidden")]] TapeVector vector(const Vector3& value);
    /// Asked once for each instant, however often forces are.
    [[gnu::visibility("hidden")]] TapeNumber of_time(const TimeFunction& value);
    [[gnu::visibility("hidden")]] TapeVector of_time(const TimeVector& value);
    [[gnu::visibility("hidden")]] TapeVector at_instant(OfTime value);
    [[gnu::visibility("hidden")]] TapeVector arm(int side, const Vector4& w, bool is_rate = false);
    /// A vector that is the same whenever and wherever; null: it is none.
    [[gnu::visibility("hidden")]] const Vector3* constant(TapeVector of) const;
    /// An angle with its turns; `angle`: its place in Load::angles.
    [[gnu::visibility("hidden")]] TapeNumber unwrapped(TapeNumber value, int angle);
    /// What no list of operations says. The place of the first of n results.
    [[gnu::visibility("hidden")]] TapeVector outer(Outer call, const std::vector<TapeNumber>& of, int n);
    [[gnu::visibility("hidden")]] void pull(int side, const Vector4& w, TapeNumber s, TapeVector v);
    /// The next number of Load::guarded; and Load::centre.
    [[gnu::visibility("hidden")]] void watch_guard(TapeNumber number);
    [[gnu::visibility("hidden")]] void watch_centre(const std::array<TapeNumber, 3>& centre);
    /// Numbers and factors of a law that need not be smooth.
    [[gnu::visibility("hidden")]] void watch_law(std::span<const TapeNumber> numbers,
                                                 std::span<const TapeNumber> factors);
    /// It is needed though no force hangs on it.
    void ask(TapeNumber number) { watched_.back().asked.push_back(number.place); }
    /// The same of an arm by its index.
    TapeVector arm_at(int index, bool is_rate = false)
    {
        return {this, add({is_rate ? TapeKind::arm_rate : TapeKind::arm, -1, -1, -1, index, 0})};
    }
    /// It is for looks: only what is watched is evaluated, and laws say all that they look at.
    void take_looks() { takes_looks_ = true; }
    bool takes_looks() const { return takes_looks_; }
    /// Any other step: the place of its value.
    [[gnu::visibility("hidden")]] int add(TapeStep step);

    const std::vector<TapeStep>& steps() const { return steps_; }
    const std::vector<TapeArm>& arms() const { return arms_; }
    const std::vector<Vector3>& vectors() const { return vectors_; }
    const std::vector<OfTime>& times() const { return times_; }
    const std::vector<Function>& functions() const { return functions_; }
    const std::vector<Outer>& calls() const { return calls_; }
    const std::vector<std::vector<int>>& inputs() const { return inputs_; }
    /// Of all loads in the order of their begin().
    const std::vector<TapeWatch>& watched() const { return watched_; }
    int size() const { return size_; }
    [[gnu::visibility("hidden")]] int index_of(Function function);

private:
    [[gnu::visibility("hidden")]] int find_arm(int side, const Vector4& w);
    [[gnu::visibility("hidden")]] TapeVector as_before(TapeVector v, double shift);
    [[gnu::visibility("hidden")]] TapeVector turned(TapeVector v);

    std::vector<TapeStep> steps_;
    std::map<std::tuple<TapeKind, int, int, int, double>, int> known_;   ///< places
    std::vector<TapeArm> arms_;
    std::map<std::array<double, 5>, int> arm_at_;   ///< by body and w
    std::vector<Vector3> vectors_;
    std::map<int, int> vector_at_;   ///< by place
    std::vector<OfTime> times_;
    std::vector<Function> functions_;
    std::vector<Outer> calls_;
    std::vector<std::vector<int>> inputs_;
    std::vector<TapeWatch> watched_;
    TapedLoad load_;
    int size_ = 0;
    bool takes_looks_ = false;

    friend class MovedLoad;
};

/// As long as it lives, what is recorded is of a load that was displaced: arms are seen as they were before,
/// and what is pulled is turned.
class MovedLoad {
public:
    MovedLoad(LoadTape& tape, const Displacement& by);
    ~MovedLoad() { tape_.load_.frame = before_; }
    MovedLoad(const MovedLoad&) = delete;
    MovedLoad& operator=(const MovedLoad&) = delete;

private:
    LoadTape& tape_;
    Displacement before_;
};

inline TapeNumber made(TapeKind kind, TapeNumber a, int b = -1, double number = 0)
{
    return {a.tape, a.tape->add({kind, -1, a.place, b, -1, number})};
}
inline TapeNumber operator+(TapeNumber a, TapeNumber b) { return made(TapeKind::plus, a, b.place); }
inline TapeNumber operator-(TapeNumber a, TapeNumber b) { return made(TapeKind::minus, a, b.place); }
TapeNumber operator*(TapeNumber a, TapeNumber b);
inline TapeNumber operator/(TapeNumber a, TapeNumber b) { return made(TapeKind::divided, a, b.place); }
TapeNumber operator*(double a, TapeNumber b);
TapeNumber operator+(double a, TapeNumber b);
inline TapeNumber operator-(TapeNumber a, double b) { return -b + a; }
inline TapeNumber operator-(TapeNumber a) { return -1.0 * a; }
inline TapeNumber root(TapeNumber a) { return made(TapeKind::root, a); }
/// 0 where a is not positive.
inline TapeNumber inverse(TapeNumber a) { return made(TapeKind::inverse, a); }
/// b where a is not 0, else 0, whatever b is.
inline TapeNumber chosen(TapeNumber a, TapeNumber b) { return made(TapeKind::chosen, a, b.place); }
TapeNumber function_of(LoadTape::Function function, TapeNumber a, TapeNumber b);
/// Of a turn whose sine has the square sigma, and whose cosine is c: itself over its sine,
/// atan2(sqrt(sigma), c) / sqrt(sigma), and twice the slope of that by sigma. In [0] and [1].
TapeVector turn_of_sine(TapeNumber sigma, TapeNumber c);
/// The same of one turn.
void turn_of_sine(double sigma, double c, double* both);

TapeVector operator+(TapeVector a, TapeVector b);
TapeVector operator-(TapeVector a, TapeVector b);
TapeVector operator*(TapeNumber a, TapeVector b);
TapeVector cross(TapeVector a, TapeVector b);
TapeNumber dot(TapeVector a, TapeVector b);

/// The only component that is not zero; -1: there are none, or several.
int only_component(const Vector3& v);

}   // namespace livens::inline multibody_internal
