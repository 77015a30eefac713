// SPDX-License-Identifier: BSD-3-Clause
// Every entry of the schema is misspelled, repeated, mistyped, left out, pushed out of its range and given
// odd numbers.
#include "livens/io/scenario/schema/schema.h"

#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "livens/io/scenario/text/units.h"
#include "sanitized.h"
#include "unit/io/scenario_text.h"

namespace livens::schema_test {

namespace {

using test::find;
using test::shown;

/// Their meshes lie beside them.
ScenarioResult read(const std::string& text)
{
    return parse_scenario(text, "test.toml",
                          {std::filesystem::path(LIVENS_SOURCE_DIR) / "tests/fuzz/corpus"});
}

std::string file_text(const std::string& name)
{
    std::ifstream stream(std::string(LIVENS_SOURCE_DIR) + "/" + name, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

// Valid scenarios with one key on a line, which together use every key; headers tell the table.
const std::vector<std::string> documents{file_text("tests/fuzz/corpus/every_key_of_bodies.toml"),
                                         file_text("tests/fuzz/corpus/every_key_of_shapes.toml"),
                                         file_text("tests/fuzz/corpus/accuracy.toml"),
                                         file_text("tests/fuzz/corpus/periodic_but_for_a_turn.toml"),
                                         file_text("tests/fuzz/corpus/every_key_of_joints_and_loads.toml"),
                                         file_text("tests/fuzz/corpus/every_key_of_mechanisms.toml"),
                                         file_text("tests/fuzz/corpus/every_key_of_laws.toml"),
                                         file_text("tests/fuzz/corpus/every_key_of_events.toml"),
                                         file_text("tests/fuzz/corpus/every_key_of_controllers.toml"),
                                         file_text("tests/fuzz/corpus/every_key_of_mixed_two_ends.toml"),
                                         file_text("tests/fuzz/corpus/known_at_both_ends.toml")};

std::vector<std::string> lines_of(const std::string& text)
{
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

std::string joined(const std::vector<std::string>& lines)
{
    std::string text;
    for (const std::string& line : lines) text += line + "\n";
    return text;
}

/// A line `key = value` of a document and the schema's entry for it.
struct Occurrence {
    const Key* key;
    std::vector<std::string> lines;
    std::size_t line;     ///< of the key, from 0
    std::size_t header;   ///< of its table, from 0

    std::string value() const { return lines[line].substr(lines[line].find("= ") + 2); }
    int value_column() const { return static_cast<int>(lines[line].find("= ")) + 3; }
    std::string with_line(const std::string& text) const
    {
        std::vector<std::string> changed = lines;
        changed[line] = text;
        return joined(changed);
    }
    std::string with_value(const std::string& text) const
    {
        return with_line(std::string(key->name) + " = " + text);
    }
};

const Table& table_of(const std::string& header, const std::string& type)
{
    std::string heading = header.empty() ? "top of the file" : header;
    if (header == "[load.table]") heading = (type == "actuator" ? "table of an " : "table of a ") + type;
    if (header.starts_with("[drive.")) heading = header.substr(7, header.size() - 8) + " of a drive";
    if (header == "[time.periodic]") heading = "periodic of [time]";
    if (header == "[joint.curve]") heading = "curve of a slot";
    if (header == "[joint.law]") heading = "law of a coupling";
    if (header == "[[joint.over]]") heading = "point of a rope";
    if (header == "[joint.angle]" || header == "[joint.displacement]")
        heading = header.substr(7, header.size() - 8) + " of a joint";
    if (header.starts_with("[joint.angle_")) heading = "angle of a joint";
    if (header == "[[joint.frames]]") heading = "frame of a joint";
    if (header == "[[load.frames]]") heading = "frame of a bushing";
    if (header == "[body.shape]") heading = "shape of [[body]]";
    if (header == "[[body.visual]]" || header == "[world.visual]") heading = "visual";
    if (header == "[body.shape.parts.cylinder]")
        heading = "cylinder of shape";
    else if (header == "[[body.shape.parts]]")
        heading = "parts of shape";
    else if (header.starts_with("[body.shape."))
        heading = header.substr(12, header.size() - 13) + " of shape";
    for (const Table* table : schema_tables())
        if (table->heading == heading) return *table;
    throw std::logic_error("no table " + heading);
}

/// All entries but tables, with their tables.
std::vector<std::pair<const Table*, const Key*>> all_keys()
{
    std::vector<std::pair<const Table*, const Key*>> all;
    for (const Table* table : schema_tables())
        for (const Key* key : table->keys_of(any_kind)) all.emplace_back(table, key);
    return all;
}

std::vector<Occurrence> occurrences()
{
    std::vector<Occurrence> all;
    for (const std::string& document : documents) {
        const std::vector<std::string> lines = lines_of(document);
        std::string header, type;
        std::size_t header_line = 0;
        for (std::size_t i = 0; i < lines.size(); ++i) {
            if (lines[i].empty()) continue;
            if (lines[i].front() == '[') {
                header = lines[i];
                header_line = i;
                continue;
            }
            const std::string name = lines[i].substr(0, lines[i].find(' '));
            const std::string value = lines[i].substr(lines[i].find("= ") + 2);
            if (name == "type" || name == "family") type = value.substr(1, value.size() - 2);
            const Table& table = table_of(header, type);
            const Key* chooser = find_key(table.keys_of(any_kind), table.chooser);
            const int kind = chooser != nullptr ? index_of(chooser->choices, type) : any_kind;
            if (const Key* key = find_key(table.keys_of(kind), name))
                all.push_back({key, lines, i, header_line});
        }
    }
    return all;
}

/// Those that are spoilt: one of 25 under sanitizers, which see the same code for every key.
std::vector<Occurrence> spoilt()
{
    std::vector<Occurrence> some;
    const std::vector<Occurrence> all = occurrences();
    for (std::size_t i = 0; i < all.size(); i += is_sanitized ? 25 : 1) some.push_back(all[i]);
    return some;
}

void expect_at(const std::string& text, std::string_view code, std::size_t line, int column)
{
    const ScenarioResult result = read(text);
    EXPECT_FALSE(result.scenario.has_value()) << text;
    for (const Diagnostic& d : result.diagnostics)
        if (d.code == code && d.line == static_cast<int>(line) + 1 && d.column == column) return;
    ADD_FAILURE() << "no " << code << " at " << line + 1 << ":" << column << " in\n" << shown(result);
}

bool holds_tables(const Key& key)
{
    return key.type == types::table || key.type == types::tables || key.type == types::table_or_tables;
}

TEST(Schema, DocumentsAreValidAndUseEveryKey)
{
    for (const std::string& document : documents) {
        const ScenarioResult result = read(document);
        EXPECT_TRUE(result.scenario.has_value()) << shown(result);
        EXPECT_TRUE(result.diagnostics.empty()) << shown(result);
    }
    const std::vector<Occurrence> used = occurrences();
    for (const auto& [table, key] : all_keys()) {
        if (holds_tables(*key) || key->type == types::later) continue;
        const bool is_used = std::any_of(used.begin(), used.end(), [k = key](const Occurrence& o) {
            return o.key->name == k->name && o.key->doc == k->doc && o.key->unit == k->unit;
        });   // kinds share entries
        EXPECT_TRUE(is_used) << table->heading << " " << key->name;
    }
}

TEST(Schema, EveryMisspelledKeyIsUnknownAndTheRightOneProposed)
{
    for (const Occurrence& o : spoilt()) {
        const std::string name(o.key->name), line = o.lines[o.line];
        std::string wrong = name;
        wrong.insert(name.size() - 1, "q");
        SCOPED_TRACE(wrong);
        const std::string text = o.with_line(wrong + line.substr(name.size()));
        expect_at(text, "unknown-key", o.line, 1);
        const ScenarioResult result = read(text);
        if (const Diagnostic* d = find(result, "unknown-key")) {
            EXPECT_EQ(d->help, "did you mean '" + name + "'?");
            EXPECT_EQ(d->length, static_cast<int>(wrong.size()));
        }
    }
}

TEST(Schema, EveryKeyGivenTwiceIsAnErrorAtTheSecond)
{
    for (const Occurrence& o : spoilt()) {
        SCOPED_TRACE(o.key->name);
        expect_at(o.with_line(o.lines[o.line] + "\n" + o.lines[o.line]), "duplicate-key", o.line + 1, 1);
    }
}

TEST(Schema, LONG_EveryValueOfAnotherTypeIsAnErrorAtTheValue)
{
    for (const Occurrence& o : spoilt()) {
        SCOPED_TRACE(o.key->name);
        const bool is_text = o.key->type.form == Form::text || o.key->type == types::choice;
        for (const char* wrong : {"1979-05-27", "{ x = 1 }", "[[[1]]]", is_text ? "1.5" : "\"\"", "[]"}) {
            const std::string_view right = o.key->type == types::named_numbers ? "{ x = 1 }"
                                           : o.key->type == types::templates   ? "[]"
                                                                               : "";
            if (wrong == right) continue;
            const ScenarioResult result = read(o.with_value(wrong));
            EXPECT_FALSE(result.scenario.has_value()) << wrong;
            const bool is_told =
                std::any_of(result.diagnostics.begin(), result.diagnostics.end(), [&](const Diagnostic& d) {
                    return d.line == static_cast<int>(o.line) + 1 && d.column >= o.value_column() &&
                           (d.code == "wrong-type" || d.code == "unit" || d.code == "unknown-key" ||
                            d.code == "point-unknown" || d.code == "joint-unknown" ||
                            d.code == "conditions-unknown" || d.code == "event-condition" ||
                            d.code == "controller-name");
                });
            EXPECT_TRUE(is_told) << o.with_value(wrong) << shown(result);
        }
    }
}

TEST(Schema, EveryTableGivenAsANumberIsAnError)
{
    for (const Key& key : root_table().keys) {
        if (!holds_tables(key)) continue;
        const std::string text = "format = 1\n" + std::string(key.name) + " = 1\n";
        expect_at(text, "wrong-type", 1, static_cast<int>(key.name.size()) + 4);
    }
    test::expect_error(test::replaced(test::valid_scenario, "{ box = [1, 0.2, 0.1] }", "1"), "wrong-type",
                       "1\ndensity");
}

TEST(Schema, EveryNeededKeyIsMissedAtTheHeaderOfItsTable)
{
    for (const Occurrence& o : spoilt()) {
        if (!o.key->required) continue;
        SCOPED_TRACE(o.key->name);
        expect_at(o.with_line(""), "missing-key", o.header, 1);
    }
    expect_at("format = 1\n", "missing-key", 0, 1);   // [[body]] and [time]
    EXPECT_TRUE(test::read(test::replaced(test::valid_scenario, "elements = 10\n", "")).scenario)
        << "elements follow from an accuracy";
}

TEST(Schema, EveryRangeIsKept)
{
    for (const Occurrence& o : spoilt()) {
        const Range& range = o.key->range;
        if (!range.is_limited()) continue;
        SCOPED_TRACE(o.key->name);
        const std::string value = o.value();
        const bool is_list = value.front() == '[';
        const int column = o.value_column() + (is_list ? 1 : 0);
        const auto with_number = [&](const std::string& number) {
            return o.with_value(is_list ? "[" + number + value.substr(value.find(',')) : number);
        };
        const std::string code = o.key->name == "format" ? "format-version" : "out-of-range";
        const bool is_whole = o.key->type == types::integer || o.key->type == types::integer_or_choice;
        if (range.low > -1e300) {
            const double below = is_whole ? range.low - 1 : range.above ? range.low : range.low - 1e-3;
            expect_at(
                with_number(is_whole ? std::to_string(static_cast<long>(below)) : std::to_string(below)),
                code, o.line, column);
        }
        if (range.high < 1e300) {
            const double above = is_whole ? range.high + 1 : range.high * 1.001;
            expect_at(
                with_number(is_whole ? std::to_string(static_cast<long>(above)) : std::to_string(above)),
                code, o.line, column);
        }
    }
}

TEST(Schema, EveryChoiceRefusesOtherWords)
{
    for (const Occurrence& o : spoilt()) {
        if (o.key->type != types::choice) continue;
        SCOPED_TRACE(o.key->name);
        expect_at(o.with_value("\"nonsense\""), "unknown-choice", o.line, o.value_column());
    }
}

TEST(Schema, EveryNumberMustBeFinite)
{
    for (const Occurrence& o : spoilt()) {
        const std::string value = o.value();
        const bool is_number = o.key->type == types::number || o.key->type == types::number_or_list ||
                               o.key->type == types::number_or_table;
        if (value.front() != '[' && !is_number) continue;
        if (o.key->type.form == Form::names || value.find('"') != std::string::npos) continue;
        if (o.key->type == types::templates) continue;   // tables
        SCOPED_TRACE(o.key->name);
        const std::size_t digit = value.find_first_of("-0123456789");
        const std::size_t end = value.find_first_of(",]", digit);
        for (const char* odd : {"nan", "inf", "-inf"}) {
            if (o.key->may_be_infinite && odd != std::string_view("nan")) continue;
            std::string changed = value;
            changed.replace(digit, std::min(end, value.size()) - digit, odd);
            expect_at(o.with_value(changed), "not-finite", o.line,
                      o.value_column() + static_cast<int>(digit));
        }
    }
}

TEST(Schema, EveryQuantityChecksTheDimensionOfItsUnit)
{
    for (const Occurrence& o : spoilt()) {
        const std::string value = o.value();
        if (o.key->unit.empty() || value.find('"') != std::string::npos) continue;   // names of points
        SCOPED_TRACE(o.key->name);
        const std::size_t digit = value.find_first_of("-0123456789");
        const std::size_t end = std::min(value.find_first_of(",]", digit), value.size());
        const auto with_unit = [&](const std::string& unit) {
            std::string changed = value;
            changed.replace(digit, end - digit, "\"" + value.substr(digit, end - digit) + " " + unit + "\"");
            return o.with_value(changed);
        };
        const ScenarioResult right = read(with_unit(std::string(o.key->unit)));
        if (o.key->other_unit.empty()) {
            EXPECT_TRUE(right.scenario.has_value()) << shown(right);
        } else {   // one of both, as the coordinate is an angle or a length
            const ScenarioResult other = read(with_unit(std::string(o.key->other_unit)));
            EXPECT_NE(right.scenario.has_value(), other.scenario.has_value()) << shown(right) << shown(other);
        }
        const int column = o.value_column() + static_cast<int>(digit);
        expect_at(with_unit("kg^3"), "unit", o.line, column);
        expect_at(with_unit("furlong"), "unit", o.line, column);
    }
}

TEST(Schema, EveryKeyOfALaterVersionIsRefusedByName)
{
    for (const auto& [table, key] : all_keys()) {
        if (key->type != types::later) continue;
        SCOPED_TRACE(key->name);
        const std::string line = std::string(key->name) + " = 1\n";
        std::string text = test::valid_scenario;
        if (table == &root_table()) text = test::replaced(text, "gravity", line + "gravity");
        if (table->heading == "[[body]]") text = test::replaced(text, "density", line + "density");
        if (table->heading == "[[joint]]") text = test::replaced(text, "at = [0", line + "at = [0");
        if (table->heading == "[time]") text = test::replaced(text, "elements", line + "elements");
        if (table->heading == "[method]") text = test::replaced(text, "degree", line + "degree");
        if (table->heading == "shape of [[body]]")
            text = test::replaced(text, "box = ", std::string(key->name) + " = 1, box = ");
        test::expect_error(text, "not-in-this-version", std::string(key->name) + " = 1");
    }
}

TEST(Schema, UnitsOfTheSchemaAreUnits)
{
    for (const auto& [table, key] : all_keys()) {
        if (key->unit.empty()) continue;
        std::string reason;
        EXPECT_TRUE(parse_unit(key->unit, reason).has_value()) << key->name << ": " << reason;
    }
}

/// Section::pick() takes the place of a word among the choices for the enumerator.
TEST(Schema, WordsOfChoicesStandInTheOrderOfTheEnumerators)
{
    const auto expect_word = [](const char* table, std::string_view name, std::string_view word,
                                auto choice) {
        const Key* key = find_key(table_of(table, "").keys_of(any_kind), name);
        ASSERT_NE(key, nullptr) << name;
        ASSERT_LT(static_cast<std::size_t>(choice), key->choices.size()) << name;
        EXPECT_EQ(key->choices[static_cast<std::size_t>(choice)], word) << name;
    };
    using Estimate = SolveOptions::Estimate;
    expect_word("[method]", "basis", "lagrange", Mixed::Basis::lagrange);
    expect_word("[method]", "basis", "nurbs", Mixed::Basis::nurbs);
    expect_word("[method]", "momentum", "strong", Mixed::Start::strong);
    expect_word("[method]", "multipliers", "lower", Mixed::Multipliers::lower);
    expect_word("[method]", "end_multiplier", "zero", Mixed::EndMultiplier::zero);
    expect_word("[method]", "interfaces", "project", Mixed::Interfaces::project);
    expect_word("[method]", "first_guess", "steady", Mixed::FirstGuess::steady);
    expect_word("[method]", "linear_solver", "umfpack", SparseBackend::umfpack);
    expect_word("[method]", "estimate", "local", Estimate::local);
    expect_word("[method]", "estimate", "none", Estimate::none);
    expect_word("[[load]]", "frame", "body", Frame::body_fixed);
    expect_word("[start]", "initial", "project", StartPolicy::project);
    expect_word("[start]", "given", "positions", Known::positions);
    expect_word("[start]", "given", "state", Known::state);
}

/// What a result tells of its method: every key of it, and what the file says for each word of a choice.
TEST(Schema, ResolvedStatesEveryKeyOfTheMethod)
{
    const Table& method = table_of("[method]", "");
    for (std::size_t kind = 0; kind < method.kinds.size(); ++kind) {
        const std::string family(method.kinds[kind].word);
        if (family == "auto") continue;   // with an accuracy only
        const auto resolved = [&](const std::string& line) {
            const ScenarioResult result = read(
                test::replaced(test::valid_scenario, "degree = 4", "family = \"" + family + "\"\n" + line));
            EXPECT_TRUE(result.scenario.has_value()) << shown(result);
            return result.scenario ? result.scenario->resolved : "";
        };
        for (const Key* key : method.keys_of(static_cast<int>(kind))) {
            if (key->name == "knots" || key->name == "weights") continue;   // where there are some
            EXPECT_NE(resolved("").find("\"" + std::string(key->name) + "\": "), std::string::npos)
                << family << " " << key->name;
            if (!(key->type == types::choice) || key->name == "family" || key->name == "basis") continue;
            for (const std::string_view word : key->choices) {
                if (word == "umfpack" || (word == "local" && !family.starts_with("l"))) continue;
                const std::string told = std::string(key->name) + "\": \"" + std::string(word) + "\"";
                const std::string line = std::string(key->name) + " = \"" + std::string(word) + "\"";
                EXPECT_NE(resolved(line).find(told), std::string::npos) << family << " " << line;
            }
        }
    }
}

TEST(Schema, DefaultsAreThoseOfTheLibrary)
{
    const ScenarioResult result = read(test::replaced(test::valid_scenario, "[method]\ndegree = 4\n", ""));
    ASSERT_TRUE(result.scenario.has_value()) << shown(result);
    const SolveOptions library;
    const auto fallback = [](std::string_view name) {
        return fallback_numbers(*find_key(table_of("[method]", "").keys_of(any_kind), name)).front();
    };
    EXPECT_EQ(fallback("degree"), Lobatto().degree);
    EXPECT_EQ(fallback("tolerance"), library.tolerance);
    EXPECT_EQ(fallback("max_iterations"), library.max_iterations);
    EXPECT_EQ(result.scenario->options.tolerance, library.tolerance);
    EXPECT_EQ(result.scenario->options.max_iterations, library.max_iterations);
    EXPECT_EQ(result.scenario->options.initial, StartPolicy::check);
    EXPECT_EQ(std::get<Lobatto>(result.scenario->method).degree, Lobatto().degree);
}

TEST(Schema, ReferencePageIsTheOneInDocs)
{
    EXPECT_EQ(file_text("docs/scenario.md"), schema_markdown()) << "livens schema --md > docs/scenario.md";
}

TEST(Schema, EveryTypeHasItsOwnTableAndALinkOnThePage)
{
    const std::string page = schema_markdown();
    for (const std::string& type : schema_types()) {
        const std::size_t point = type.find('.');
        EXPECT_NE(schema_markdown(type).find("| `name` |"), std::string::npos) << type;
        EXPECT_NE(page.find("](" + type.substr(0, point) + "s/" + type.substr(point + 1) + ".md)"),
                  std::string::npos)
            << type;
    }
    EXPECT_NE(schema_markdown("joint.screw").find("| `pitch` |"), std::string::npos);
    EXPECT_EQ(schema_markdown("joint.weld").find("| `pitch` |"), std::string::npos);
    EXPECT_EQ(schema_markdown("joint.hinge"), "");
}

TEST(Schema, JsonNamesEveryKeyAndClosesEveryBracket)
{
    const std::string json = schema_json();
    for (const auto& [table, key] : all_keys()) {
        const bool is_named = json.find("\"" + std::string(key->name) + "\": {") != std::string::npos;
        EXPECT_TRUE(is_named || key->type == types::later) << key->name;
    }
    EXPECT_NE(json.find("https://json-schema.org/draft/2020-12/schema"), std::string::npos);
    int depth = 0;
    bool is_text = false;
    for (std::size_t i = 0; i < json.size(); ++i) {
        const char c = json[i];
        if (is_text && c == '\\')
            ++i;
        else if (c == '"')
            is_text = !is_text;
        else if (!is_text)
            depth += c == '{' || c == '[' ? 1 : c == '}' || c == ']' ? -1 : 0;
    }
    EXPECT_EQ(depth, 0);
}

/// What makes validators repeat a slip, or say only that nothing fitted.
TEST(Schema, JsonHasNothingThatHidesASlip)
{
    const std::string json = schema_json();
    for (const char* word : {"\"allOf\"", "\"oneOf\"", "\"additionalProperties\": false", "\": false"})
        EXPECT_EQ(json.find(word), std::string::npos) << word;
    // Alternatives are left where words stand beside numbers, two of each.
    int n_alternatives = 0;
    for (const auto& [table, key] : all_keys()) n_alternatives += key->type.other == Form::choice ? 1 : 0;
    int n_found = 0;
    for (std::size_t at = 0; (at = json.find("\"anyOf\"", at)) != std::string::npos; ++at) ++n_found;
    EXPECT_LE(n_found, n_alternatives);
    EXPECT_GT(n_alternatives, 0);
}

}   // namespace

}   // namespace livens::schema_test
