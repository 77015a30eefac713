// SPDX-License-Identifier: BSD-3-Clause
// [time]: elements, given or to be found, and output times.
// Output times and breaks of loads are element ends, where a motion has its highest order (theory.md, The
// element). All instants are compared with the slack of `make_time_mesh`.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>

#include "livens/base/text.h"
#include "livens/io/scenario/run/run.h"

namespace livens::inline io_internal {

namespace {

constexpr double resolution = 1e-9;   // of the interval: closer instants are one, as in make_time_mesh

/// mantissa * 10^exponent, as the number is written.
struct Decimal {
    long long mantissa = 0;
    int exponent = 0;
    bool is_exact = false;
};

Decimal to_decimal(double x)
{
    const std::string text = to_text(x);
    const std::size_t e = std::min(text.find('e'), text.size());
    Decimal d;
    if (e < text.size()) d.exponent = std::atoi(text.c_str() + e + 1);
    std::string digits;
    bool behind_point = false;
    for (const char c : text.substr(0, e)) {
        if (c == '.') {
            behind_point = true;
            continue;
        }
        digits += c;
        if (behind_point) --d.exponent;
    }
    const std::from_chars_result r =
        std::from_chars(digits.data(), digits.data() + digits.size(), d.mantissa);
    // Powers of ten are exact doubles up to 10^22, and mantissas that fit are whole numbers.
    d.is_exact = r.ec == std::errc() && std::abs(d.exponent) <= 22;
    return d;
}

/// The instants start + k step, rounded as the decimal number a person would write: 3 times 0.1 is 0.3, not
/// 0.30000000000000004. Instants are asked for by such numbers later.
class DecimalSteps {
public:
    DecimalSteps(double start, double step) : start_(start), step_(step)
    {
        Decimal a = to_decimal(start);
        const Decimal b = to_decimal(step);
        if (a.mantissa == 0) a.exponent = b.exponent;
        exponent_ = std::min(a.exponent, b.exponent);
        is_decimal_ = a.is_exact && b.is_exact && a.exponent <= 0 && b.exponent <= 0;
        if (!is_decimal_) return;
        whole_start_ = std::pow(10.0, a.exponent - exponent_) * static_cast<double>(a.mantissa);
        whole_step_ = std::pow(10.0, b.exponent - exponent_) * static_cast<double>(b.mantissa);
    }

    double operator()(long long k) const
    {
        constexpr double limit = 9007199254740992.0;   // 2^53: whole numbers are exact below
        const double n = static_cast<double>(k), moved = whole_step_ * n;
        if (!is_decimal_ || std::abs(whole_start_) + std::abs(moved) >= limit) return start_ + n * step_;
        return (whole_start_ + moved) /
               std::pow(10.0, -exponent_);   // one rounding: powers are exact to 10^22
    }

private:
    double start_, step_;
    double whole_start_ = 0, whole_step_ = 0;   ///< in units of 10^exponent
    int exponent_ = 0;
    bool is_decimal_ = false;
};

std::vector<double> output_by_interval(double start, double end, double step)
{
    std::vector<double> times;
    const DecimalSteps instant(start, step);
    // The quotient may be rounded below a whole number, and the last interval must not get lost.
    const long long n = static_cast<long long>(std::floor((end - start) / step * (1 + 1e-12)));
    for (long long k = 0; k <= n; ++k) {
        const double t = instant(k);
        // The end itself is the last instant, to the bit; one just before it is dropped.
        if (t < end - resolution * (end - start)) times.push_back(t);
    }
    times.push_back(end);
    return times;
}

/// Whether start or end is found with the motion.
bool is_found(const Section& time, const char* key)
{
    const Value* value = time.find(key);
    return value != nullptr && value->node != nullptr && value->node->is_unknown;
}

bool check_output_list(const Section& time, const Value& output, Findings& findings)
{
    const double start = time.number("start"), end = time.number("end");
    const std::vector<double>& times = output.numbers;
    for (std::size_t i = 0; i < times.size(); ++i) {
        const SourceLocation place = output.node->items()[i].place;
        if ((times[i] < start && !is_found(time, "start")) || (times[i] > end && !is_found(time, "end"))) {
            findings.error(place, "time-output",
                           "the output time " + to_text(times[i]) + " s lies outside the motion",
                           {"it lasts from " + to_text(start) + " s to " + to_text(end) + " s", ""});
            return false;
        }
        if (i > 0 && times[i] <= times[i - 1]) {
            findings.error(place, "time-output",
                           "output times must ascend: " + to_text(times[i]) + " s follows " +
                               to_text(times[i - 1]) + " s");
            return false;
        }
    }
    return true;
}

/// False after an error. No times: all element ends.
bool read_output(const Section& time, std::vector<double>& times, Findings& findings)
{
    const Value* output = time.find("output");
    if (output == nullptr) return true;
    if (output->n_rows == 1) {
        if (!check_output_list(time, *output, findings)) return false;
        const auto is_outside = [&](double t) { return t < time.number("start") || t > time.number("end"); };
        times = output->numbers;
        std::erase_if(times, is_outside);   // of a time that is found
        return true;
    }
    const double start = time.number("start"), end = time.number("end"), step = output->numbers.front();
    if (!(step > 0)) {
        findings.error(output->node->place, "time-output",
                       "the interval between output times must be positive",
                       {"", "give a list with a single time to have just that one"});
        return false;
    }
    if ((end - start) / step > max_elements) {
        findings.error(output->node->place, "resource-limit",
                       "this interval makes more than " + std::to_string(max_elements) + " output times");
        return false;
    }
    times = output_by_interval(start, end, step);
    return true;
}

/// Output times that are not element ends to the bit because a jump of a load is next to them take its
/// instant.
void snap_to_ends(std::vector<double>& times, const TimeMesh& mesh)
{
    const double slack = resolution * (mesh.end() - mesh.start());
    for (double& t : times) {
        const auto next = std::lower_bound(mesh.ends.begin(), mesh.ends.end(), t);
        for (const auto& end : {next, next == mesh.ends.begin() ? next : next - 1})
            if (end != mesh.ends.end() && std::abs(*end - t) <= slack) {
                t = *end;
                break;
            }
    }
    times.erase(std::unique(times.begin(), times.end()), times.end());   // instants so close are one
}

/// Looks at start and end even if something else in [time] is wrong.
bool check_end(const Section& time, Findings& findings)
{
    const double start = time.number("start"), end = time.number("end");
    if (time.find("end") == nullptr || (time.has("start") && time.find("start") == nullptr) || end > start)
        return true;
    findings.error(time.place("end"), "time-end",
                   "'end' of [time] must lie after 'start': " + to_text(end) + " s is not after " +
                       to_text(start) + " s");
    return false;
}

/// Equal elements, and ends at all instants that need one.
bool make_even_mesh(Builder& builder, const Section& time, Scenario& scenario)
{
    Findings& findings = builder.findings();
    const auto fits = [&](double n_elements) {
        return check_size(builder.model(), scenario.method, n_elements, time.place("elements"), findings);
    };
    // The size is checked twice: with the elements stated, before any memory is taken, and with those that
    // output times and breaks add.
    if (!fits(time.number("elements")) || !read_output(time, scenario.output, findings)) return false;
    std::vector<double> required;
    if (time.text("breaks") == "from_loads") required = builder.model().load_breaks();
    required.insert(required.end(), scenario.output.begin(), scenario.output.end());
    const double start = time.number("start"), end = time.number("end");
    return builder.guard("time", [&] {
        scenario.time = make_time_mesh(start, end, time.integer("elements"), required);
    }) && fits(std::get<TimeMesh>(scenario.time).n_elements());
}

/// Elements that follow from an accuracy.
bool make_span(Builder& builder, const Section& time, Scenario& scenario)
{
    if (!read_output(time, scenario.output, builder.findings())) return false;
    Span span{time.number("start"), time.number("end"), time.number("accuracy"), scenario.output};
    // the instants that will be element ends, for output times next to a jump
    std::vector<double> required = builder.model().load_breaks();
    required.insert(required.end(), scenario.output.begin(), scenario.output.end());
    TimeMesh stops;
    if (!builder.guard("time", [&] { stops = make_time_mesh(span.start, span.end, 1, required); }))
        return false;
    snap_to_ends(scenario.output, stops);
    span.output = scenario.output;
    scenario.time = std::move(span);
    return true;
}

/// Whether elements made of knots fit what [time] says.
bool check_knot_mesh(Builder& builder, const Section& time, const Section& method, const TimeMesh& mesh,
                     Findings& findings)
{
    const auto refuse = [&](const SourceLocation& place, const std::string& message, const Advice& advice) {
        findings.error(place, "knots-mesh", message, advice);
        return false;
    };
    const double start = time.number("start"), end = time.number("end");
    if (mesh.start() != start || mesh.end() != end)
        return refuse(method.place("knots"),
                      "'knots' of [method] go from " + to_text(mesh.start()) + " s to " +
                          to_text(mesh.end()) + " s, the motion from " + to_text(start) + " s to " +
                          to_text(end) + " s",
                      {"the first and the last knots are start and end of [time]", ""});
    if (time.has("elements") && time.integer("elements") != mesh.n_elements())
        return refuse(time.place("elements"),
                      "'elements' of [time] is " + to_text(time.number("elements")) +
                          ", but the knots of [method] make " + std::to_string(mesh.n_elements()),
                      {"", "leave it out"});
    if (time.text("breaks") != "from_loads") return true;
    const std::vector<double> breaks = missed(mesh, builder.model().load_breaks());
    if (breaks.empty()) return true;
    return refuse(method.place("knots"),
                  "a load breaks at " + to_text(breaks[0]) + " s, where there is no knot",
                  {"elements end where loads jump or bend, or lose their order",
                   "add a knot there, degree times for a jump, or set breaks = \"ignore\" in [time]"});
}

/// Elements made of the knots of splines.
bool make_knot_mesh(Builder& builder, const Section& time, const Section& method, Scenario& scenario)
{
    Findings& findings = builder.findings();
    if (!method.is_valid()) return false;   // told already
    TimeMesh mesh;
    const auto make = [&] { mesh = mesh_of_knots(std::get<Mixed>(scenario.method)); };
    if (!builder.guard("method", make)) return false;
    if (!check_knot_mesh(builder, time, method, mesh, findings)) return false;
    if (!check_size(builder.model(), scenario.method, mesh.n_elements(), method.place("knots"), findings))
        return false;
    if (!read_output(time, scenario.output, findings)) return false;
    const std::vector<double> outputs = missed(mesh, scenario.output);
    scenario.time = std::move(mesh);
    if (outputs.empty()) return true;
    findings.error(time.place("output"), "knots-mesh",
                   "the output time " + to_text(outputs[0]) + " s is no knot of [method]",
                   {"output times are element ends, and knots make the elements",
                    "add a knot there, or leave 'output' out: then all knots are output times"});
    return false;
}

/// What does not go with an accuracy.
bool check_span(const Section& time, const Section* method, Findings& findings)
{
    const auto refuse = [&](const SourceLocation& place, const std::string& message) {
        return findings.error(place, "accuracy-elements", message,
                              {"elements follow from the accuracy", "leave out one of the two"});
    };
    if (time.has("elements"))
        return refuse(time.place("accuracy"), "'accuracy' of [time] and 'elements' exclude each other");
    if (time.text("breaks") == "ignore")
        return refuse(time.place("breaks"), "elements that follow from an accuracy end where loads break");
    if (method != nullptr && method->has("window"))
        return refuse(method->place("window"), "'window' of [method] goes with 'elements' of [time] only");
    return true;
}

}   // namespace

bool follows_accuracy(const Section& time, const Method& method)
{
    return time.has("accuracy") || (!time.has("elements") && !has_knots(method));
}

bool read_time(Builder& builder, const Section& time, const Section* method, Scenario& scenario)
{
    if (!check_end(time, builder.findings()) || !time.is_valid()) return false;
    scenario.lists_output = time.find("output") != nullptr;
    if (follows_accuracy(time, scenario.method))
        return check_span(time, method, builder.findings()) && make_span(builder, time, scenario);
    const bool is_made = has_knots(scenario.method) ? make_knot_mesh(builder, time, *method, scenario)
                                                    : make_even_mesh(builder, time, scenario);
    if (!is_made) return false;
    const TimeMesh& mesh = std::get<TimeMesh>(scenario.time);
    snap_to_ends(scenario.output, mesh);
    if (scenario.output.empty()) scenario.output = mesh.ends;
    return true;
}

}   // namespace livens::inline io_internal
