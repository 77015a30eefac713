#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>

#include "livens/io/detail/builder.h"
#include "livens/io/json.h"

namespace livens {

namespace {

constexpr double max_motion_bytes = 8.0 * (1u << 30);
constexpr double resolution = 1e-9;   // of the interval: closer instants are one, as in make_time_mesh

/// mantissa * 10^exponent, as the number is written.
struct Decimal {
    long long mantissa = 0;
    int exponent = 0;
    bool is_exact = false;
};

Decimal to_decimal(double x)
{
    const std::string text = shortest(x);
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
    const std::from_chars_result r = std::from_chars(digits.data(), digits.data() + digits.size(),
                                                     d.mantissa);
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
    const long long n = static_cast<long long>(std::floor((end - start) / step * (1 + 1e-12)));
    for (long long k = 0; k <= n; ++k) {
        const double t = instant(k);
        if (t < end - resolution * (end - start)) times.push_back(t);
    }
    times.push_back(end);
    return times;
}

bool check_output_list(const Section& time, const Value& output, Findings& findings)
{
    const double start = time.number("start"), end = time.number("end");
    const std::vector<double>& times = output.numbers;
    for (std::size_t i = 0; i < times.size(); ++i) {
        const Place place = output.node->items()[i].place;
        if (times[i] < start || times[i] > end) {
            findings.error(place, "time-output",
                           "the output time " + shortest(times[i]) + " s lies outside the motion",
                           {"it lasts from " + shortest(start) + " s to " + shortest(end) + " s", ""});
            return false;
        }
        if (i > 0 && times[i] <= times[i - 1]) {
            findings.error(place, "time-output",
                           "output times must ascend: " + shortest(times[i]) + " s follows " +
                               shortest(times[i - 1]) + " s");
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
        times = output->numbers;
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
}

/// What the motion will take at least; a scenario of a few lines must not fill the memory of a machine.
bool check_size(Builder& builder, const Section& time, const Method& method, double n_elements)
{
    const Lobatto* lobatto = std::get_if<Lobatto>(&method);
    const double degree = lobatto != nullptr ? lobatto->degree : 1;
    const double bodies = builder.model().n_bodies(), rows = builder.model().n_rows();
    const double inside = degree * (12 * bodies + rows);
    const double at_ends = 48 * bodies + 2 * rows;   // P, V, and X'' on both sides
    const double bytes = sizeof(double) * n_elements * (inside + at_ends);
    if (bytes <= max_motion_bytes) return true;
    const auto gibibytes = [](double b) {
        return std::to_string(static_cast<long long>(b / (1u << 30))) + " GiB";
    };
    builder.findings().error(
        time.place("elements"), "resource-limit",
        "the motion would take " + gibibytes(bytes) + ", more than " + gibibytes(max_motion_bytes),
        {std::to_string(static_cast<long long>(n_elements)) + " time elements for " +
             std::to_string(builder.model().n_bodies()) + " bodies",
         "use fewer elements; a higher degree makes up for it"});
    return false;
}

/// Looks at start and end even if something else in [time] is wrong.
bool check_end(const Section& time, Findings& findings)
{
    const double start = time.number("start"), end = time.number("end");
    if (time.find("end") == nullptr || (time.has("start") && time.find("start") == nullptr) || end > start)
        return true;
    findings.error(time.place("end"), "time-end",
                   "'end' of [time] must lie after 'start': " + shortest(end) + " s is not after " +
                       shortest(start) + " s");
    return false;
}

bool make_mesh(Builder& builder, const Section& time, Scenario& scenario)
{
    Findings& findings = builder.findings();
    if (!check_end(time, findings) || !time.is_valid()) return false;
    const double start = time.number("start"), end = time.number("end");
    if (!check_size(builder, time, scenario.method, time.number("elements"))) return false;
    if (!read_output(time, scenario.output, findings)) return false;
    std::vector<double> required;
    if (time.text("breaks") == "from_loads") required = builder.model().load_breaks();
    required.insert(required.end(), scenario.output.begin(), scenario.output.end());
    if (!builder.guard(
            "time", [&] { scenario.mesh = make_time_mesh(start, end, time.integer("elements"), required); }))
        return false;
    if (!check_size(builder, time, scenario.method, scenario.mesh.n_elements())) return false;
    snap_to_ends(scenario.output, scenario.mesh);
    if (scenario.output.empty()) scenario.output = scenario.mesh.ends;
    return true;
}

Method read_method(const Section* method)
{
    if (method == nullptr) return Lobatto{};
    const std::string family = method->text("family");
    if (family == "midpoint") return Midpoint{};
    if (family == "endpoint") return Endpoint{};
    return Lobatto{method->integer("degree")};
}

const Section* only_section(const Section& top, std::string_view key)
{
    const std::span<const Section> sections = top.sections(key);
    return sections.empty() ? nullptr : &sections.front();
}

std::string resolve(const Builder& builder, const Section& time, const Scenario& scenario)
{
    const Vector3 gravity = builder.top().vector("gravity");
    const Lobatto* lobatto = std::get_if<Lobatto>(&scenario.method);
    const bool is_midpoint = std::holds_alternative<Midpoint>(scenario.method);
    JsonWriter json;
    json.begin_object().member("format", 1).member("title", scenario.title);
    json.member("gravity", std::span<const double>(gravity.a));
    json.key("time").begin_object();
    json.member("start", scenario.mesh.start()).member("end", scenario.mesh.end());
    json.member("elements", time.integer("elements")).key("output");
    const Value* output = time.find("output");
    if (output == nullptr) json.value("element ends");
    else if (output->n_rows == 1) json.value(std::span<const double>(output->numbers));
    else json.value(output->numbers.front());
    json.member("breaks", time.text("breaks")).end_object();
    json.key("method").begin_object();
    json.member("family", lobatto != nullptr ? "lobatto" : is_midpoint ? "midpoint" : "endpoint");
    if (lobatto != nullptr) json.member("degree", lobatto->degree);
    json.member("tolerance", scenario.options.tolerance)
        .member("max_iterations", scenario.options.max_iterations);
    json.end_object().key("start").begin_object();
    json.member("initial", scenario.options.initial == StartPolicy::check ? "check" : "project");
    return json.end_object().end_object().text();
}

}   // namespace

void read_run(Builder& builder, Scenario& scenario)
{
    const Section* time = only_section(builder.top(), "time");
    const Section* method = only_section(builder.top(), "method");
    const Section* start = only_section(builder.top(), "start");
    scenario.title = builder.top().text("title");
    scenario.method = read_method(method);
    if (method != nullptr && method->has("tolerance"))
        scenario.options.tolerance = method->number("tolerance");
    if (method != nullptr && method->has("max_iterations"))
        scenario.options.max_iterations = method->integer("max_iterations");
    if (start != nullptr && start->text("initial") == "project")
        scenario.options.initial = StartPolicy::project;
    if (time == nullptr) return;
    if (!make_mesh(builder, *time, scenario)) return;
    scenario.resolved = resolve(builder, *time, scenario);
}

}   // namespace livens
