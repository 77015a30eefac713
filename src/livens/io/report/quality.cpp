// SPDX-License-Identifier: BSD-3-Clause
// Series that tell how right a run is. Series that are longer than a screen keep the largest of neighbours.
// Errors, growth, violations, balances, lengths and iterations over time, with the bounds of the verdict
// (theory.md, "What is diagnosed"), so that the page draws where a bound is passed.
#include <algorithm>
#include <cmath>

#include "livens/diagnostics/acceptance.h"
#include "livens/diagnostics/acceptance_bounds.h"
#include "livens/diagnostics/diagnostics.h"
#include "livens/io/report/parts.h"

namespace livens::inline io_internal {

namespace {

constexpr std::size_t most_values = 2000;

/// A series in groups of neighbours, of each of which the largest is shown; one value is a group of its own
/// in runs of up to `most_values`.
class Series {
public:
    explicit Series(ReportData& data, const std::vector<double>& ends) : data_(data), n_(ends.size())
    {
        group_ = (n_ + most_values - 1) / most_values;
        std::vector<double> times;
        for (std::size_t k = 0; k < n_; k += group_) times.push_back(ends[std::min(k + group_, n_) - 1]);
        data_.payload.add("quality_time", Precision::full, times);
        data_.json.member("every", group_ == 1);
        data_.json.key("series").begin_array();
    }
    ~Series() { data_.json.end_array(); }
    Series(const Series&) = delete;
    Series& operator=(const Series&) = delete;

    /// `values` at element ends.
    void add(const char* name, const std::vector<double>& values)
    {
        if (values.size() != n_) return;   // not known
        std::vector<double> largest;
        for (std::size_t k = 0; k < n_; ++k) {
            if (k % group_ == 0) largest.push_back(values[k]);
            // Written so that nan wins: a value that is no number must not hide behind its neighbours.
            if (!(values[k] <= largest.back())) largest.back() = values[k];
        }
        data_.payload.add(std::string("quality ") + name, Precision::single, largest);
        data_.json.value(name);
    }
    /// Several at an element end, of which the largest is shown.
    void add_largest(const char* name, const std::vector<double>& values)
    {
        if (values.empty() || values.size() % n_ != 0) return;
        const std::size_t n = values.size() / n_;
        std::vector<double> largest;
        for (std::size_t k = 0; k < n_; ++k)
            largest.push_back(*std::max_element(values.begin() + static_cast<std::ptrdiff_t>(k * n),
                                                values.begin() + static_cast<std::ptrdiff_t>((k + 1) * n)));
        add(name, largest);
    }

private:
    ReportData& data_;
    std::size_t n_, group_ = 1;
};

/// The largest of an element's nodes, at its later end; at the start that of the first node.
std::vector<double> at_ends(const Field& X, int n_elements, const std::vector<double>& at_nodes)
{
    if (at_nodes.empty()) return {};
    std::vector<double> all{at_nodes.front()};
    for (int e = 0; e < n_elements; ++e) {
        double largest = 0;
        for (int a = 0; a <= X.degree; ++a)
            if (const double x = at_nodes[static_cast<std::size_t>(X.index(e, a))]; !(x <= largest))
                largest = x;
        all.push_back(largest);
    }
    return all;
}

void write_balances(Series& series, const Model& model, const Run& run)
{
    Balance all;
    const auto append = [&](const Balance& piece) {
        const auto join = [](std::vector<double>& to, const std::vector<double>& from) {
            to.insert(to.end(), from.begin(), from.end());
        };
        join(all.energy_drift, piece.energy_drift);
        join(all.linear_momentum_drift, piece.linear_momentum_drift);
        join(all.angular_momentum_drift, piece.angular_momentum_drift);
    };
    if (run.verdict.series)
        append(run.verdict.series->balance);
    else
        balance(model, run.motion, 1 << 12, append);
    series.add("energy balance", all.energy_drift);
    series.add("momentum balance", all.linear_momentum_drift);
    series.add("angular momentum balance", all.angular_momentum_drift);
}

/// Of blocks of elements to the ends of elements; elements alone where they are no blocks.
std::vector<double> iterations_at_ends(const Run& run)
{
    const std::vector<int>& ends = run.motion.block_ends;
    const std::vector<int>& of_blocks = run.report.iterations;
    std::vector<double> all{0};
    const auto n = static_cast<std::size_t>(run.motion.n_elements());
    if (ends.empty() && of_blocks.size() < n) return {};
    for (std::size_t e = 0; e < n; ++e) {
        const auto block = ends.empty()
                               ? static_cast<std::ptrdiff_t>(e)
                               : std::ranges::upper_bound(ends, static_cast<int>(e)) - ends.begin() - 1;
        if (block < 0 || block >= static_cast<std::ptrdiff_t>(of_blocks.size())) return {};
        all.push_back(of_blocks[static_cast<std::size_t>(block)]);
    }
    return all;
}

/// What acceptance.h says of them; a bound is for the figure of its name.
void write_bounds(JsonWriter& json, const Run& run)
{
    const bool is_weak = run.motion.constraints_hold == ConstraintsHold::weakly;
    json.key("bounds").begin_object();
    json.member("estimated_error", run.report.accuracy > 0 ? run.report.accuracy : acceptable_error);
    json.member("max_constraint_violation", is_weak ? acceptable_nodal_violation : acceptable_violation);
    if (is_weak) json.member("max_weak_violation", acceptable_weak_violation);
    for (const char* const drift : {"energy_drift", "linear_momentum_drift", "angular_momentum_drift"})
        json.member(drift, acceptable_drift);
    if (!run.motion.damps()) json.member("zigzag_positions", acceptable_zigzag);
    json.member("zigzag_momenta", acceptable_zigzag).member("guess_distance", acceptable_distance);
    if (!is_weak) json.member("velocity_jump", acceptable_velocity_jump);
    json.end_object();
}

}   // namespace

void write_quality(ReportData& data, const Scenario& scenario, const Run& run)
{
    const Motion& motion = run.motion;
    JsonWriter& json = data.json;
    json.key("quality").begin_object();
    write_bounds(json, run);
    const ErrorEstimate& e = run.estimate;
    json.member("worst_body", e.body);
    {
        Series series(data, motion.mesh.ends);
        series.add_largest("position error", e.position);
        series.add_largest("orientation error", e.orientation);
        series.add_largest("reaction error", e.reaction);
        series.add("growth", run.growth);
        const NodeViolations violations = node_violations(scenario.model, motion);
        if (scenario.model.n_rows() > 0)
            series.add("joint violation", at_ends(motion.X, motion.n_elements(), violations.joints));
        series.add("rigidity violation", at_ends(motion.X, motion.n_elements(), violations.rigidity));
        write_balances(series, scenario.model, run);
        std::vector<double> lengths{0};
        for (int k = 0; k < motion.n_elements(); ++k) lengths.push_back(motion.mesh.length(k));
        if (lengths.size() > 1) lengths.front() = lengths[1];
        series.add("element length", lengths);
        series.add("iterations", iterations_at_ends(run));
    }
    json.end_object();
}

}   // namespace livens::inline io_internal
