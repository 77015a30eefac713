// Every entry of the schema is misspelled, repeated, mistyped, left out, pushed out of its range and given
// odd numbers.
#include "livens/io/detail/schema.h"

#include <fstream>
#include <map>
#include <sstream>
#include <vector>

#include "livens/io/detail/units.h"
#include "unit/io/scenario_text.h"

namespace livens {

namespace {

using test::find;
using test::read;
using test::shown;

// Valid scenarios with one key on a line, which together use every key; headers tell the table.
const std::vector<std::string> documents{
    R"(format = 1
title = "everything of bodies"
gravity = [0, 0, -9.81]

[[body]]
name = "box"
density = 7850
center_of_mass = [0.1, 0, 0]
position = [0, 1, 0]
directors = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
velocity = [1, 0, 0]
angular_velocity = [0, 0, 1]
[body.shape]
box = [1, 1, 1]

[[body]]
name = "ball"
density = 1
quaternion = [1, 0, 0, 0]
angular_velocity_body = [0, 0, 1]
[body.shape]
sphere = 0.5

[[body]]
name = "other ball"
density = 1
rotation_vector = [0.1, 0, 0]
[body.shape.sphere]
radius = 0.5

[[body]]
name = "tube"
density = 1
[body.shape.cylinder]
radius = 0.5
length = 1
inner_radius = 0.25

[[body]]
name = "pill"
density = 1
[body.shape.capsule]
radius = 0.5
length = 1

[[body]]
name = "egg"
density = 1
[body.shape]
ellipsoid = [1, 2, 3]

[[body]]
name = "cone"
density = 1
[body.shape.cone]
radius = 0.5
height = 1

[[body]]
name = "bob"
mass = 1
[body.shape]
point = true

[[body]]
name = "given"
mass = 1
inertia = [1, 1, 1]
director_rates = [[0, 0, 0], [0, 0, 0], [0, 0, 0]]

[time]
start = 0
end = 1
elements = 4
output = 0.5
breaks = "from_loads"

[method]
family = "lobatto"
degree = 4
window = 2
tolerance = 1e-12
max_iterations = 20

[start]
initial = "check"
)",
    R"(format = 1

[[body]]
name = "a"
mass = 1
inertia = [1, 1, 1]

[[body]]
name = "b"
mass = 1
inertia = [1, 1, 1]
position = [1, 0, 0]

[[body]]
name = "c"
mass = 1
inertia = [1, 1, 1]
position = [2, 0, 0]

[[joint]]
name = "hinge"
type = "revolute"
between = ["world", "a"]
at = [0, 0, 0]
axis = [0, 0, 1]

[[joint]]
name = "cardan"
type = "universal"
between = ["a", "b"]
points = [[0.5, 0, 0], [-0.5, 0, 0]]
axes = [[0, 1, 0], [0, 0, 1]]

[[joint]]
name = "link"
type = "rod"
between = ["b", "c"]
length = 1

[[load]]
name = "push"
type = "force"
body = "c"
point = [0, 1, 0]
value = [0, 0, 1]
frame = "world"
from = 0.25
until = 0.5

[[load]]
name = "twist"
type = "torque"
body = "c"
value = [0, 0, 1]

[[load]]
name = "spring"
type = "spring"
between = ["a", "c"]
points = [[0, 0, 0], [0, 0, 0]]
stiffness = 10
damping = 1
free_length = 1

[[load]]
name = "history"
type = "force"
body = "c"
[load.table]
times = [0, 1]
values = [[0, 0, 0], [0, 0, 1]]
interpolation = "linear"

[[load]]
name = "torque history"
type = "torque"
body = "c"
[load.table]
times = [0, 1]
values = [[0, 0, 0], [0, 0, 1]]
interpolation = "spline"

[time]
end = 1
elements = 4
)",
    R"(format = 1

[[body]]
name = "a"
mass = 1
inertia = [1, 1, 1]
[body.end]
position = [1, 0, 0]
directors = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
velocity = [1, 0, 0]
angular_velocity = [0, 0, 1]

[[body]]
name = "b"
mass = 1
inertia = [1, 1, 1]
[body.end]
quaternion = [1, 0, 0, 0]
angular_velocity_body = [0, 0, 1]

[[body]]
name = "c"
mass = 1
inertia = [1, 1, 1]
[body.end]
rotation_vector = [0.1, 0, 0]

[time]
end = 1
elements = 4

[method]
family = "mixed"
basis = "nurbs"
degree = 2
momentum = "natural"
multipliers = "equal"
gauss_points = 6
window = "all"
interfaces = "carry"
first_guess = "march"
end_multiplier = "smooth"
knots = [0, 0, 0, 0.25, 0.5, 0.75, 1, 1, 1]
weights = [1, 1, 1, 1, 1, 1]
linear_solver = "eigen"
condition = true

[start]
given = "positions"

[end]
given = "positions"
)"};

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

TableId table_of(const std::string& header, const std::string& type)
{
    static const std::map<std::string, TableId> tables{{"[[body]]", TableId::body},
                                                       {"[body.shape]", TableId::shape},
                                                       {"[body.shape.sphere]", TableId::sphere},
                                                       {"[body.shape.cylinder]", TableId::cylinder},
                                                       {"[body.shape.capsule]", TableId::capsule},
                                                       {"[body.shape.cone]", TableId::cone},
                                                       {"[[joint]]", TableId::joint},
                                                       {"[[load]]", TableId::load},
                                                       {"[time]", TableId::time},
                                                       {"[method]", TableId::method},
                                                       {"[start]", TableId::start},
                                                       {"[end]", TableId::end},
                                                       {"[body.end]", TableId::body_end}};
    if (header == "[load.table]") return type == "\"torque\"" ? TableId::torque_table : TableId::force_table;
    return header.empty() ? TableId::root : tables.at(header);
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
            if (name == "type" || name == "family") type = lines[i].substr(lines[i].find("= ") + 2);
            const TableId table = table_of(header, type);
            for (const Key& key : schema_keys())
                if (key.table == table && key.name == name &&
                    (key.only.empty() || is_listed(key.only, type.substr(1, type.size() - 2))))
                    all.push_back({&key, lines, i, header_line});
        }
    }
    return all;
}

void expect_at(const std::string& text, std::string_view code, std::size_t line, int column)
{
    const ScenarioResult result = read(text);
    EXPECT_FALSE(result.scenario.has_value()) << text;
    for (const Diagnostic& d : result.diagnostics)
        if (d.code == code && d.line == static_cast<int>(line) + 1 && d.column == column) return;
    ADD_FAILURE() << "no " << code << " at " << line + 1 << ":" << column << " in\n" << shown(result);
}

bool holds_tables(const Key& key) { return key.type == KeyType::table || key.type == KeyType::tables; }

TEST(Schema, DocumentsAreValidAndUseEveryKey)
{
    for (const std::string& document : documents) {
        const ScenarioResult result = read(document);
        EXPECT_TRUE(result.scenario.has_value()) << shown(result);
        EXPECT_TRUE(result.diagnostics.empty()) << shown(result);
    }
    const std::vector<Occurrence> used = occurrences();
    for (const Key& key : schema_keys()) {
        if (holds_tables(key) || key.type == KeyType::later) continue;
        const bool is_used = std::any_of(used.begin(), used.end(),
                                         [&](const Occurrence& o) { return o.key == &key; });
        EXPECT_TRUE(is_used) << schema_table(key.table).heading << " " << key.name;
    }
}

TEST(Schema, EveryMisspelledKeyIsUnknownAndTheRightOneProposed)
{
    for (const Occurrence& o : occurrences()) {
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
    for (const Occurrence& o : occurrences()) {
        SCOPED_TRACE(o.key->name);
        expect_at(o.with_line(o.lines[o.line] + "\n" + o.lines[o.line]), "duplicate-key", o.line + 1, 1);
    }
}

TEST(Schema, EveryValueOfAnotherTypeIsAnErrorAtTheValue)
{
    for (const Occurrence& o : occurrences()) {
        SCOPED_TRACE(o.key->name);
        const bool is_text = o.key->type == KeyType::text || o.key->type == KeyType::choice;
        for (const char* wrong : {"1979-05-27", "{ x = 1 }", "[[[1]]]", is_text ? "1.5" : "\"\"", "[]"}) {
            const ScenarioResult result = read(o.with_value(wrong));
            EXPECT_FALSE(result.scenario.has_value()) << wrong;
            const bool is_told = std::any_of(
                result.diagnostics.begin(), result.diagnostics.end(), [&](const Diagnostic& d) {
                    return d.line == static_cast<int>(o.line) + 1 && d.column >= o.value_column() &&
                           (d.code == "wrong-type" || d.code == "unit" || d.code == "unknown-key");
                });
            EXPECT_TRUE(is_told) << o.with_value(wrong) << shown(result);
        }
    }
}

TEST(Schema, EveryTableGivenAsANumberIsAnError)
{
    for (const Key& key : schema_keys()) {
        if (!holds_tables(key) || key.table != TableId::root) continue;
        const std::string text = "format = 1\n" + std::string(key.name) + " = 1\n";
        expect_at(text, "wrong-type", 1, static_cast<int>(key.name.size()) + 4);
    }
    test::expect_error(test::replaced(test::valid_scenario, "{ box = [1, 0.2, 0.1] }", "1"), "wrong-type",
                       "1\ndensity");
}

TEST(Schema, EveryNeededKeyIsMissedAtTheHeaderOfItsTable)
{
    for (const Occurrence& o : occurrences()) {
        if (!o.key->required) continue;
        SCOPED_TRACE(o.key->name);
        expect_at(o.with_line(""), "missing-key", o.header, 1);
    }
    expect_at("format = 1\n", "missing-key", 0, 1);   // [[body]] and [time]
    test::expect_error(test::replaced(test::valid_scenario, "elements = 10\n", ""), "missing-key", "[time]");
}

TEST(Schema, EveryRangeIsKept)
{
    for (const Occurrence& o : occurrences()) {
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
        const bool is_whole =
            o.key->type == KeyType::integer || o.key->type == KeyType::integer_or_choice;
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
    for (const Occurrence& o : occurrences()) {
        if (o.key->type != KeyType::choice) continue;
        SCOPED_TRACE(o.key->name);
        expect_at(o.with_value("\"nonsense\""), "unknown-choice", o.line, o.value_column());
        for (const std::string_view later : split_alternatives(o.key->later))
            expect_at(o.with_value("\"" + std::string(later) + "\""), "not-in-this-version", o.line,
                      o.value_column());
    }
}

TEST(Schema, EveryNumberMustBeFinite)
{
    for (const Occurrence& o : occurrences()) {
        const std::string value = o.value();
        const bool is_number = o.key->type == KeyType::number || o.key->type == KeyType::number_or_list ||
                               o.key->type == KeyType::number_or_table;
        if (value.front() != '[' && !is_number) continue;
        if (o.key->type == KeyType::names) continue;
        SCOPED_TRACE(o.key->name);
        const std::size_t digit = value.find_first_of("-0123456789");
        const std::size_t end = value.find_first_of(",]", digit);
        for (const char* odd : {"nan", "inf", "-inf"}) {
            std::string changed = value;
            changed.replace(digit, std::min(end, value.size()) - digit, odd);
            expect_at(o.with_value(changed), "not-finite", o.line,
                      o.value_column() + static_cast<int>(digit));
        }
    }
}

TEST(Schema, EveryQuantityChecksTheDimensionOfItsUnit)
{
    for (const Occurrence& o : occurrences()) {
        if (o.key->unit.empty()) continue;
        SCOPED_TRACE(o.key->name);
        const std::string value = o.value();
        const std::size_t digit = value.find_first_of("-0123456789");
        const std::size_t end = std::min(value.find_first_of(",]", digit), value.size());
        const auto with_unit = [&](const std::string& unit) {
            std::string changed = value;
            changed.replace(digit, end - digit, "\"" + value.substr(digit, end - digit) + " " + unit + "\"");
            return o.with_value(changed);
        };
        const ScenarioResult right = read(with_unit(std::string(o.key->unit)));
        EXPECT_TRUE(right.scenario.has_value()) << shown(right);
        const int column = o.value_column() + static_cast<int>(digit);
        expect_at(with_unit("kg^3"), "unit", o.line, column);
        expect_at(with_unit("furlong"), "unit", o.line, column);
    }
}

TEST(Schema, EveryKeyOfALaterVersionIsRefusedByName)
{
    for (const Key& key : schema_keys()) {
        if (key.type != KeyType::later) continue;
        SCOPED_TRACE(key.name);
        const std::string line = std::string(key.name) + " = 1\n";
        std::string text = test::valid_scenario;
        if (key.table == TableId::root) text = test::replaced(text, "gravity", line + "gravity");
        if (key.table == TableId::body) text = test::replaced(text, "density", line + "density");
        if (key.table == TableId::time) text = test::replaced(text, "elements", line + "elements");
        if (key.table == TableId::method) text = test::replaced(text, "degree", line + "degree");
        if (key.table == TableId::shape)
            text = test::replaced(text, "box = ", std::string(key.name) + " = 1, box = ");
        test::expect_error(text, "not-in-this-version", std::string(key.name) + " = 1");
    }
}

TEST(Schema, UnitsOfTheSchemaAreUnits)
{
    for (const Key& key : schema_keys()) {
        if (key.unit.empty()) continue;
        std::string reason;
        EXPECT_TRUE(parse_unit(key.unit, reason).has_value()) << key.name << ": " << reason;
    }
}

TEST(Schema, TablesStandAtTheirIndex)
{
    for (const Table& table : schema_tables()) EXPECT_EQ(&schema_table(table.id), &table) << table.heading;
}

TEST(Schema, DefaultsAreThoseOfTheLibrary)
{
    const ScenarioResult result = read(test::replaced(test::valid_scenario, "[method]\ndegree = 4\n", ""));
    ASSERT_TRUE(result.scenario.has_value()) << shown(result);
    const SolveOptions library;
    const auto fallback = [](TableId table, std::string_view name) {
        for (const Key& key : schema_keys())
            if (key.table == table && key.name == name) return fallback_numbers(key).front();
        return -1.0;
    };
    EXPECT_EQ(fallback(TableId::method, "degree"), Lobatto().degree);
    EXPECT_EQ(fallback(TableId::method, "tolerance"), library.tolerance);
    EXPECT_EQ(fallback(TableId::method, "max_iterations"), library.max_iterations);
    EXPECT_EQ(result.scenario->options.tolerance, library.tolerance);
    EXPECT_EQ(result.scenario->options.max_iterations, library.max_iterations);
    EXPECT_EQ(result.scenario->options.initial, StartPolicy::check);
    EXPECT_EQ(std::get<Lobatto>(result.scenario->method).degree, Lobatto().degree);
}

std::string file_text(const std::string& name)
{
    std::ifstream stream(std::string(LIVENS_SOURCE_DIR) + "/" + name, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(Schema, ReferencePageIsTheOneInDocs)
{
    EXPECT_EQ(file_text("docs/scenario.md"), schema_markdown()) << "livens schema --md > docs/scenario.md";
}

TEST(Schema, JsonNamesEveryKeyAndClosesEveryBracket)
{
    const std::string json = schema_json();
    for (const Key& key : schema_keys()) {
        const bool is_named = json.find("\"" + std::string(key.name) + "\": {") != std::string::npos;
        EXPECT_TRUE(is_named || key.type == KeyType::later) << key.name;
    }
    EXPECT_NE(json.find("https://json-schema.org/draft/2020-12/schema"), std::string::npos);
    int depth = 0;
    for (const char c : json) depth += c == '{' || c == '[' ? 1 : c == '}' || c == ']' ? -1 : 0;
    EXPECT_EQ(depth, 0);
}

}   // namespace

}   // namespace livens
