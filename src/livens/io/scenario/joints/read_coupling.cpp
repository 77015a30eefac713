// SPDX-License-Identifier: BSD-3-Clause
// [[joint]] of coordinates of other joints: by `joints` two of them, by `terms` any number with factors.
#include <algorithm>
#include <utility>

#include "livens/io/scenario/joints/joint_kinds.h"
#include "livens/io/scenario/joints/joints.h"

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
            const std::size_t point = entry.key.rfind('.');   // the last: names may have points
            const std::string name = entry.key.substr(0, point);
            const Joint* joint = find_joint(builder, section, name, entry.place);
            if (joint != nullptr && point == std::string::npos) {
                builder.findings().error(entry.place, "joint-coordinate",
                                         "'" + entry.key + "' in 'terms' of " + section.label() +
                                             " does not say which coordinate of the joint is meant",
                                         {"", "\"" + name + ".angle\" or \"" + name + ".displacement\""});
                joint = nullptr;
            }
            all.push_back(
                {terms->numbers[i], joint, point == std::string::npos ? "" : entry.key.substr(point + 1)});
        }
    return all;
}

/// Factors with a unit make terms of one dimension; those without may be of any.
void check_units_of_terms(Builder& builder, const Section& section, const std::vector<CoupledJoint>& terms)
{
    const Value* given = section.find("terms");
    const Amount* first = nullptr;
    std::vector<Amount> amounts;
    amounts.reserve(terms.size());
    for (std::size_t i = 0; given != nullptr && i < terms.size(); ++i) {
        const Node& node = given->node->entries()[i].value;
        if (node.kind != Node::Kind::text) continue;
        Amount amount = compute(node.text(), section.parameters()).amount;
        if (!amount.has_unit) continue;
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

}   // namespace

void read_coupling(Builder& builder, const Section& section, const std::string& name, const std::string& path)
{
    if (section.find("joints") == nullptr && section.find("terms") == nullptr) return;
    std::vector<CoupledJoint> coupled = coupled_joints(builder, section);
    const bool are_known =
        std::ranges::all_of(coupled, [](const auto& term) { return term.joint != nullptr; });
    if (!are_known || !section.is_valid()) return;
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
                                                                                    X});
        read_times(builder, section, joint);
        builder.model().add_joint(std::move(joint));
    });
}

}   // namespace livens::inline io_internal
