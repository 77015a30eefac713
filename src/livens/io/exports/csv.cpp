// SPDX-License-Identifier: BSD-3-Clause
// A table of a motion, a row an instant, as spreadsheets read it: docs/results.md. Units stand in the header;
// what is no number is an empty cell.
#include <algorithm>
#include <iterator>

#include "livens/diagnostics/quantities.h"
#include "livens/io/exports.h"
#include "livens/io/exports/formats.h"
#include "livens/io/json.h"
#include "livens/io/results/atomic_file.h"
#include "livens/io/shown_unit.h"

namespace livens {

namespace {

/// RFC 4180: quotes around what holds a separator; line breaks cannot be in a header that other programs
/// should read. Spreadsheets take text in quotes for formulas too: an apostrophe says that it is none.
std::string header_cell(const std::string& name)
{
    const std::size_t first = name.find_first_not_of(" \t");
    bool needs_quotes = first != std::string::npos && std::string_view("=+-@").find(name[first]) < 4;
    needs_quotes |= name.starts_with('\t');
    std::string quoted = needs_quotes ? "'" : "";
    for (const char c : name) {
        if (c == ',' || c == '"' || c == ';') needs_quotes = true;
        if (c == '"') quoted += '"';
        quoted += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
    return needs_quotes ? '"' + quoted + '"' : quoted;
}

/// What the table has of a motion, in its order.
std::vector<NamedQuantity> columns_of(const Quantities& quantities)
{
    constexpr std::string_view left_out[] = {"center_of_mass", "linear_momentum", "angular_momentum"};
    std::vector<NamedQuantity> all;
    const auto take = [&](QuantityOf first, QuantityOf last) {
        for (const NamedQuantity& q : quantities.all())
            if (q.of >= first && q.of <= last && (q.of != QuantityOf::load || q.what == "effort") &&
                !q.is_on_request &&
                std::ranges::find(left_out, q.what) == std::end(left_out))
                all.push_back(q);
    };
    take(QuantityOf::body, QuantityOf::body);
    take(QuantityOf::model, QuantityOf::model);
    take(QuantityOf::coordinate, QuantityOf::sensor);
    return all;
}

/// Of each column.
std::vector<ShownUnit> units_of(const std::vector<NamedQuantity>& columns,
                                std::span<const std::string> wished)
{
    std::vector<std::string> units;
    for (const NamedQuantity& q : columns) units.push_back(q.unit);
    check_shown_units(wished, units);
    std::vector<ShownUnit> shown;
    for (const std::string& unit : units) shown.push_back(shown_unit(unit, wished));
    return shown;
}

std::string header(const std::vector<NamedQuantity>& columns, const std::vector<ShownUnit>& units)
{
    std::string line = "t [s]";
    for (std::size_t k = 0; k < columns.size(); ++k) {
        const NamedQuantity& q = columns[k];
        const std::string name = q.of != QuantityOf::model ? q.name()
                                 : q.what == "energy"      ? "energy"
                                                           : q.what + " energy";
        for (int i = 0; i < q.size; ++i)
            line += "," + header_cell(name + (q.size > 1 ? "." : "") + component_of(q, i) + " [" +
                                      units[k].unit + "]");
    }
    return line + "\r\n";
}

constexpr std::size_t largest_piece = std::size_t{1} << 20;   // of the table that is held in memory
void add_cell(std::string& line, double x)
{
    line += ',';
    if (x == x) line += to_text(x);   // nan: an empty cell, which every reader takes for "none"
}

/// Of q and -q the one that is nearer to the row before: columns have no jumps of sign.
void continue_quaternion(std::span<double> numbers, const NamedQuantity& q, Vector4& before)
{
    double* const mine = numbers.data() + q.first;
    before = continued(before, {mine[0], mine[1], mine[2], mine[3]});
    std::copy_n(before.data(), 4, mine);
}

/// Where something jumps, what follows is told, and at the very end what was.
std::vector<SeenInstant> output_instants(const Run& run)
{
    std::vector<SeenInstant> all;
    for (const double t : reached_times(run)) {
        const bool is_last = snap_to_element_end(run.motion.mesh, t) == run.motion.end();
        all.push_back({t, is_last ? Side::left : Side::right});
    }
    return all;
}

}   // namespace

std::vector<SeenInstant> instants_of(const Scenario& scenario, const Run& run, Instants which)
{
    if (which == Instants::automatic) which = scenario.lists_output ? Instants::output : Instants::dense;
    if (which == Instants::dense) return dense_instants(run.motion);
    return which == Instants::ends ? end_instants(run.motion) : output_instants(run);
}

void write_csv(const std::filesystem::path& file, const Model& model, const Run& run,
               std::vector<SeenInstant> instants, std::span<const std::string> units)
{
    if (instants.empty()) instants = output_instants(run);
    const Quantities quantities(model, run.motion, run.body_names);
    const std::vector<NamedQuantity> columns = columns_of(quantities);
    const std::vector<ShownUnit> shown = units_of(columns, units);
    AtomicFile out(file);
    std::uint64_t n_written = 0;
    const auto write = [&](std::string& text) {   // a small run may have a large table
        out.write(n_written, text);
        n_written += text.size();
        text.clear();
    };
    std::string text = header(columns, shown);
    std::vector<Vector4> previous(run.body_names.size(), Vector4{1, 0, 0, 0});
    std::vector<double> numbers(static_cast<std::size_t>(quantities.n_numbers()));
    for (const SeenInstant& seen : instants) {
        text += to_text(seen.t);
        quantities.at(sample_state(run.motion, seen.t), seen.side, columns, numbers);
        for (std::size_t k = 0; k < columns.size(); ++k) {
            const NamedQuantity& q = columns[k];
            if (q.of == QuantityOf::body && q.size == 4)
                continue_quaternion(numbers, q, previous[static_cast<std::size_t>(q.index)]);
            for (int i = 0; i < q.size; ++i)
                add_cell(text, shown[k].factor * numbers[static_cast<std::size_t>(q.first + i)]);
        }
        text += "\r\n";
        if (text.size() > largest_piece) write(text);
    }
    write(text);
    out.commit();
}

}   // namespace livens
