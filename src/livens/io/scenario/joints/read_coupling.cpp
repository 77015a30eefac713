// SPDX-License-Identifier: BSD-3-Clause
// [[joint]] of coordinates of other joints: by `joints` two of them, by `terms` any number with factors, by
// `law` one that these follow.
#include <algorithm>
#include <optional>
#include <utility>

#include "livens/io/scenario/joints/expressions.h"
#include "livens/io/scenario/joints/joint_kinds.h"
#include "livens/io/scenario/joints/joints.h"
#include "livens/multibody/joints/coordinate_laws.h"

namespace livens::inline io_internal {

namespace {

/// The joint of a name that stands at a place of a coupling; an unknown one is reported.
const Joint* find_joint(Builder& builder, const Section& section, const std::string& name,
                        const SourceLocation& place)
{
    std::vector<std::string_view> known;
    for (const Joint& joint : builder.model().joints()) {
        if (joint.name == name) return &joint;
        known.push_back(joint.name);
    }
    bool is_stated = false;   // but wrong: told already
    for (const Section& other : builder.top().sections("joint"))
        is_stated = is_stated || (&other != &section && other.has("name") && other.text("name") == name);
    if (builder.is_excused(name)) return nullptr;
    if (!is_stated || builder.findings().n_errors() == 0)
        builder.findings().error(
            place, "joint-unknown", section.label() + " refers to '" + name + "', but there is no such joint",
            {is_stated ? "couplings can be coupled to other joints only" : "", suggest(name, known)});
    return nullptr;
}

/// "left.angle" of a key, at a place. Its joint is null if something is wrong, which is told.
CoupledJoint find_coordinate_of(Builder& builder, const Section& section, const std::string& text,
                                const SourceLocation& place, const std::string& key)
{
    const std::size_t point = text.rfind('.');   // the last: names may have points
    const std::string name = text.substr(0, point);
    const Joint* joint = find_joint(builder, section, name, place);
    if (joint == nullptr || point != std::string::npos)
        return {0, joint, point == std::string::npos ? "" : text.substr(point + 1)};
    builder.findings().error(place, "joint-coordinate",
                             "'" + text + "' in '" + key + "' of " + section.label() +
                                 " does not say which coordinate of the joint is meant",
                             {"", "\"" + name + ".angle\" or \"" + name + ".displacement\""});
    return {};
}

/// By `joints` two of them, by `terms` any number, with coordinates and factors. Null joints were reported.
std::vector<CoupledJoint> coupled_joints(Builder& builder, const Section& section)
{
    std::vector<CoupledJoint> all;
    if (const Value* names = section.find("joints"))
        for (std::size_t i = 0; i < names->texts.size(); ++i)
            all.push_back({0, find_joint(builder, section, names->texts[i], names->node->items()[i].place)});
    if (const Value* terms = section.find("terms"))
        for (std::size_t i = 0; i < terms->numbers.size(); ++i) {
            const Entry& entry = terms->node->entries()[i];
            all.push_back(find_coordinate_of(builder, section, entry.key, entry.place, "terms"));
            all.back().factor = terms->numbers[i];
        }
    return all;
}

/// Factors with a unit make terms of one dimension; those without may be of any.
void check_units_of_terms(Builder& builder, const Section& section, const std::vector<CoupledJoint>& terms)
{
    const Value* given = section.find("terms");
    const Amount* first = nullptr;
    std::vector<Amount> amounts;
    // `first` points into it.
    amounts.reserve(terms.size());
    for (std::size_t i = 0; given != nullptr && i < terms.size(); ++i) {
        const Node& node = given->node->entries()[i].value;
        if (node.kind != Node::Kind::text) continue;
        Amount amount = compute(node.text(), section.parameters()).amount;
        if (!amount.has_unit) continue;
        // A term is factor times coordinate.
        if (terms[i].coordinate == "displacement") amount.powers[0] += 1;
        amount.powers[3] = 0;   // a radius is in m or in m/rad
        amounts.push_back(amount);
        if (first == nullptr) first = &amounts.back();
        if (first->powers == amount.powers) continue;
        builder.findings().error(node.place, "unit",
                                 "'" + given->node->entries()[i].key + "' in 'terms' of " + section.label() +
                                     " makes the term " + described(amount) + ", but another one is " +
                                     described(*first),
                                 {"angles are in rad, displacements in m", "all terms have one dimension"});
        return;
    }
}

/// Whether terms are angles or pure numbers, by the first of them.
bool is_sum_of_angles(const JointParts& p)
{
    const Node& node = p.section.find("terms")->node->entries().front().value;
    const bool is_displacement = p.coupled.front().coordinate == "displacement";
    if (node.kind != Node::Kind::text) return !is_displacement;
    const Amount amount = compute(node.text(), p.section.parameters()).amount;
    return !amount.has_unit ? !is_displacement : amount.powers[0] + (is_displacement ? 1 : 0) == 0;
}

/// That texts in a list have the unit of an angle, or that of a length.
void check_unit_of(const Section& law, const char* key, bool is_angle, const std::string& path)
{
    const Value* v = law.find(key);
    if (v == nullptr || !(is_angle ? v->has_unit : v->has_other_unit)) return;
    throw InputError(
        {"unit", path + "." + key,
         "'" + std::string(key) + "' of " + law.label() + " are of " + (is_angle ? "an angle" : "a length"),
         "", "", "", "give them in " + std::string(is_angle ? "rad" : "m")});
}

/// Of `angle` or `displacement`, or of the whole name.
CoordinateLaw read_formula(const JointParts& p, const Section& law, const std::string& path)
{
    const std::string text = law.text("expression"), whole = law.text("of");
    const std::vector<std::string> names = names_with_points(text);
    Inputs inputs;
    inputs.symbols = {std::ranges::find(names, whole) != names.end() ? whole : p.leader.coordinate};
    for (const std::string& name : names)
        if (name != whole)
            throw InputError({"coupling-law", path + ".expression",
                              "the law of a coupling is one of the coordinate that 'of' names",
                              "'" + name + "'", "'" + p.leader.coordinate + "' or '" + whole + "'", "", ""});
    return formula_law(read_expressions(law, inputs, path).front(), p.leader.coordinate == "angle");
}

CoordinateLaw read_law(const JointParts& p, const Section& law)
{
    const std::string path = "joint[" + p.name + "].law";
    const auto refuse = [&](const std::string& message, const std::string& help) {
        throw InputError({"coupling-law", path, message, "", "", "", help});
    };
    const bool has_table = law.has("coordinates") || law.has("values");
    if (has_table == law.has("expression"))
        refuse(has_table ? "the law has a formula and a table" : "the law has neither a formula nor a table",
               "give 'expression', or 'coordinates' and 'values'");
    if (law.has("expression")) {
        if (law.has("periodic")) refuse("a formula is periodic by itself", "leave out 'periodic'");
        return read_formula(p, law, path);
    }
    if (law.find("coordinates") == nullptr || law.find("values") == nullptr)
        refuse("the table of the law lacks '" + std::string(law.has("values") ? "coordinates" : "values") +
                   "'",
               "give one value for each coordinate");
    check_unit_of(law, "coordinates", p.leader.coordinate == "angle", path);
    check_unit_of(law, "values", is_sum_of_angles(p), path);
    return tabulated_law(law.find("coordinates")->numbers, law.find("values")->numbers,
                         law.truth("periodic"));
}

}   // namespace

Key law_key()
{
    return Key{"law", types::table,
               "What the sum of `terms` is, instead of a constant: a function of one more coordinate."}
        .holding(
            {"law of a coupling",
             "A formula, or a cubic spline through a table. Coordinates are what their joints say, with "
             "`coordinate`: the start must fulfil the law. Outside of a table it has no value.",
             {Key{"of", types::text, "The coordinate that the others follow, as in `\"cam.angle\"`."}
                  .needed(),
              Key{"expression", types::text,
                  "A formula of `angle` or `displacement`, in rad or m, with two continuous derivatives "
                  "([syntax](joints.md#expressions)). Instead of a table."},
              Key{"coordinates", types::list, "Values of the coordinate, two or more, ascending.", "m"}.or_in(
                  "rad"),
              Key{"values", types::list, "What the sum is there: one value for each.", "m"}.or_in("rad"),
              Key{"periodic", types::truth,
                  "Whether the table begins again behind its last row, which is its first one. Of an "
                  "angle, its length is a turn or a whole part of one.",
                  "", "false"}}});
}

Joint make_coupling(const JointParts& p)
{
    const Section* law = only_section(p.section, "law");
    return law == nullptr ? coupling(p.name, p.coupled, p.X, p.scale)
                          : coupling(p.name, p.coupled, p.leader, read_law(p, *law), p.X, p.scale);
}

void read_coupling(Builder& builder, const Section& section, const std::string& name, const std::string& path)
{
    if (section.find("joints") == nullptr && section.find("terms") == nullptr) return;
    std::vector<CoupledJoint> coupled = coupled_joints(builder, section);
    const bool are_known =
        std::ranges::all_of(coupled, [](const auto& term) { return term.joint != nullptr; });
    const Section* law = only_section(section, "law");
    CoupledJoint leader;
    if (law != nullptr && law->find("of") != nullptr)
        leader = find_coordinate_of(builder, section, law->text("of"), law->place("of"), "law");
    if (!are_known || !section.is_valid() || (law != nullptr && leader.joint == nullptr)) return;
    check_units_of_terms(builder, section, coupled);
    const std::vector<Matrix34> X = builder.start_configurations();
    builder.guard(path, [&] {
        Joint joint = joint_kinds()[static_cast<std::size_t>(section.kind())].make({section,
                                                                                    name,
                                                                                    world,
                                                                                    world,
                                                                                    {},
                                                                                    world_configuration,
                                                                                    world_configuration,
                                                                                    builder.length(),
                                                                                    false,
                                                                                    std::move(coupled),
                                                                                    leader,
                                                                                    X});
        read_times(builder, section, joint);
        builder.model().add_joint(std::move(joint));
    });
}

}   // namespace livens::inline io_internal
