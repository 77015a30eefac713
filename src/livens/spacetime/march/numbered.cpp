// SPDX-License-Identifier: BSD-3-Clause
// theory.md, "Unknown numbers".
#include "livens/spacetime/march/numbered.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "livens/base/text.h"
#include "livens/multibody/model.h"

namespace livens {

double scale_of(const UnknownNumber& number)
{
    if (number.scale > 0) return number.scale;
    if (number.guess != 0) return std::abs(number.guess);
    const double width = number.high - number.low;
    if (std::isfinite(width) && width > 0) return width;
    return 1;
}

inline namespace spacetime_internal {

namespace {

constexpr double difference = 1e-4;   // of a number or its scale

/// t, which lies between two of these instants, as far between the same two of others.
double moved_with(const std::vector<double>& from, double t, const std::vector<double>& to)
{
    std::size_t i = 1;
    while (i + 1 < from.size() && t > from[i]) ++i;
    if (t == from[i]) return to[i];
    if (from[i - 1] == to[i - 1] && from[i] == to[i]) return t;   // to the bit: it may be an output time
    return to[i - 1] + (t - from[i - 1]) / (from[i] - from[i - 1]) * (to[i] - to[i - 1]);
}

}   // namespace

NumberedProblem::Anchors NumberedProblem::anchors_of(const Model& model, double start, double end) const
{
    Anchors all{{start}, {}};
    const std::vector<double> events = model.event_times();
    std::vector<double> inside = model.load_breaks();
    inside.insert(inside.end(), unknowns_.held.begin(), unknowns_.held.end());
    std::ranges::sort(inside);
    for (const double t : inside) {
        if (!(t > start && t < end)) continue;
        if (std::ranges::binary_search(events, t)) all.events.push_back(all.instants.size());
        all.instants.push_back(t);
    }
    all.instants.push_back(end);
    return all;
}

NumberedProblem::NumberedProblem(const Model& model, const Ends& ends, const TimeMesh& mesh,
                                 const UnknownNumbers& unknowns)
    : model_(model), ends_(ends), mesh_(mesh), unknowns_(unknowns), numbers_(unknowns.numbers)
{
    for (const std::string& name : ends.periodic.conserved) numbers_.push_back({"change of " + name});
    if (size() > 0) anchors_ = anchors_of(model, mesh.start(), mesh.end());
}

std::vector<double> NumberedProblem::guesses() const
{
    std::vector<double> all;
    for (const UnknownNumber& number : numbers_) all.push_back(number.guess);
    return all;
}

/// Anchors are found anew in the rebuilt model and paired with those of the stated one by their order, so
/// there must be as many, and the same of them events of joints. Between two of them the mesh is stretched
/// ("Unknown numbers", Time).
NumberedProblem::Tried NumberedProblem::try_at(std::span<const double> values) const
{
    const auto n = static_cast<std::size_t>(n_stated());
    Instance made{n > 0 ? unknowns_.rebuild(values.first(n)) : as_it_is(), ends_, mesh_};
    const Rebuilt& rebuilt = made.rebuilt;
    if (rebuilt.refused) return {{}, *rebuilt.refused};
    if (!(rebuilt.end > rebuilt.start))
        return {{},
                {"time-end", "time.end", "the end of time is not after its start", to_text(rebuilt.end, 6),
                 "> " + to_text(rebuilt.start, 6), "", ""}};
    // any state is the one in which a motion of no length ends
    if (ends_.periodic.n_alike > 0 && rebuilt.end - rebuilt.start < 0.1 * (mesh_.end() - mesh_.start()))
        return {{},
                {"time-end", "time.end", "the period is less than a tenth of its guess",
                 to_text(rebuilt.end - rebuilt.start, 6), "", "",
                 "give a better guess of it, or of the state at the start"}};
    const Anchors anchors = anchors_of(*rebuilt.model, rebuilt.start, rebuilt.end);
    if (anchors.instants.size() != anchors_.instants.size() || anchors.events != anchors_.events)
        return {{},
                {"unknown-order", "time",
                 "an instant at which a load or a joint switches leaves the time, or meets another", "", "",
                 "elements end there, and their order does not change", ""}};
    for (auto* instants : {&made.mesh.ends, &made.mesh.required, &made.mesh.bends})
        for (double& t : *instants) t = moved_with(anchors_.instants, t, anchors.instants);
    made.ends.end.t = rebuilt.end;
    if (!rebuilt.state.X.empty()) made.ends.start = rebuilt.state;
    made.ends.start.t = rebuilt.start;
    put_components(rebuilt, values.subspan(n), made.ends.components);
    return {std::move(made), {}};
}

/// Derivatives ask for models on either side of a guess, unless its bounds say that there are none.
NumberedProblem::Instance NumberedProblem::beside_guesses(int i, double value) const
{
    std::vector<double> values = guesses();
    values[i] = value;
    Tried tried = try_at(values);
    if (tried.made) return std::move(*tried.made);
    const UnknownNumber& number = numbers_[i];
    Complaint& why = tried.why;
    why.path = "unknown[" + number.name + "]";
    why.message = "where the unknown '" + number.name + "' is " + to_text(value, 6) + ", beside its guess " +
                  to_text(number.guess, 6) + ", there is no model: " + why.message;
    why.help = "give bounds ('low', 'high') inside of which there is one, or another guess" +
               (why.help.empty() ? "" : "; " + why.help);
    throw InputError(std::move(why));
}

/// The model itself, by a pointer that does not own it.
Rebuilt NumberedProblem::as_it_is() const
{
    const auto n = static_cast<std::ptrdiff_t>(n_given());
    return {std::shared_ptr<const Model>(std::shared_ptr<const Model>(), &model_),
            {ends_.components.begin(), ends_.components.begin() + n},
            mesh_.start(),
            mesh_.end(),
            {},
            ends_.periodic.n_alike > 0 && ends_.components.back().turn ? ends_.components.back().turn->angle
                                                                       : 0};
}

/// Those of a periodic motion follow, of the same names in this model; none is more off than what unfolds it.
void NumberedProblem::put_components(const Rebuilt& rebuilt, std::span<const double> unfolded,
                                     std::vector<Condition>& all) const
{
    const std::size_t n = n_given();
    std::copy(rebuilt.components.begin(), rebuilt.components.end(), all.begin());
    for (std::size_t i = n; i < all.size(); ++i) {
        Condition& one = all[i];
        if (n_stated() > 0) one.quantity = state_quantities(*rebuilt.model, one.quantity.name).front();
        if (one.turn) one.turn->angle = rebuilt.turn;
        one.value = 0;
        for (std::size_t c = 0; c < unfolded.size(); ++c)
            one.value += unfolded[c] * ends_.periodic.unfolding[c][i - n];
    }
}

/// Where two steps on either side would pass a bound, five points on the other side are taken; their step is
/// short enough for the last of them to keep within the bound there.
std::vector<NumberedProblem::Sample> NumberedProblem::samples(int i, double value) const
{
    // the derivative of the polynomial through these: between them, or at the first one
    constexpr std::array<Sample, 4> inside{{{-2, 1.0 / 12}, {-1, -8.0 / 12}, {1, 8.0 / 12}, {2, -1.0 / 12}}};
    constexpr std::array<Sample, 5> aside{{{0, -25.0 / 12}, {1, 4}, {2, -3}, {3, 4.0 / 3}, {4, -0.25}}};
    const UnknownNumber& number = numbers_[i];
    const double size = scale(i), h = difference * std::max(std::abs(value), size);
    const bool is_low = value - 2 * h<number.low, is_high = value + 2 * h> number.high;
    std::vector<Sample> all;
    if (!is_low && !is_high) all.assign(inside.begin(), inside.end());
    if (is_low || is_high) all.assign(aside.begin(), aside.end());
    const double step = is_low    ? std::min(h, (number.high - value) / 4)
                        : is_high ? -std::min(h, (value - number.low) / 4)
                                  : h;
    for (Sample& one : all) one = {value + one.value * step, one.weight * size / step};
    return all;
}

double carried_to(const TimeMesh& from, double t, const TimeMesh& to)
{
    if (t <= from.start()) return to.start() + (t - from.start());
    if (t >= from.end()) return to.end() + (t - from.end());
    const int e = from.element_at(t);
    return to.ends[e] + (t - from.ends[e]) / from.length(e) * to.length(e);
}

}   // namespace spacetime_internal

}   // namespace livens
