// SPDX-License-Identifier: BSD-3-Clause
// A file with unknown numbers is one that is read with their guesses, and with other values again.
#include "livens/io/scenario/text/unknown_nodes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "livens/base/text.h"

namespace livens::inline io_internal {

namespace {

using Kind = Node::Kind;

Node copied(const Node& node)
{
    Node copy{node.kind, node.is_unknown, node.place, node.number, nullptr};
    if (node.content == nullptr) return copy;
    copy.content = std::make_unique<NodeContent>();
    copy.content->text = node.content->text;
    for (const Node& item : node.content->items) copy.content->items.push_back(copied(item));
    for (const Entry& entry : node.content->entries)
        copy.content->entries.push_back({entry.key, entry.place, copied(entry.value)});
    return copy;
}

bool states_unknown(const Node& node) { return node.kind == Kind::table && node.find("unknown") != nullptr; }

/// A number, with its unit if the guess has one: so the key can tell whether it fits.
Node number_node(const StatedUnknown& unknown, double value)
{
    Node node{Kind::number, true, unknown.guess_place, value, nullptr};
    if (unknown.unit.empty()) return node;
    node.kind = Kind::text;
    node.content = std::make_unique<NodeContent>();
    node.content->text = to_text(value) + " " + unknown.unit;
    return node;
}

/// What a thing is called: by its name, or by its place among its like.
std::string called(const Entry& entry, std::size_t i)
{
    const Node& item = entry.value.items()[i];
    const Node* name = item.kind == Kind::table ? item.find("name") : nullptr;
    if (name != nullptr && name->kind == Kind::text) return name->text();
    return entry.key + "[" + std::to_string(i) + "]";
}

/// All unknown numbers of a tree. They are found again by their places among entries and items, which every
/// copy of the tree has as well.
class Collector {
public:
    explicit Collector(Findings& findings) : findings_(findings) {}

    std::vector<StatedUnknown> take(const Node& root)
    {
        for (const Entry& entry : root.entries()) {
            path_.push_back(static_cast<std::size_t>(&entry - root.entries().data()));
            is_parameter_ = entry.key == "parameters";
            const bool is_list = entry.value.kind == Kind::array;
            for (std::size_t i = 0; is_list && i < entry.value.items().size(); ++i) {
                path_.push_back(i);
                walk(entry.value.items()[i], called(entry, i));
                path_.pop_back();
            }
            if (!is_list) walk(entry.value, is_parameter_ ? "" : entry.key);
            path_.pop_back();
        }
        return std::move(found_);
    }

private:
    /// Three items are components x, y, z; items of other lists are counted from 0.
    void walk(const Node& node, const std::string& label)
    {
        if (states_unknown(node)) return take_one(node, label);
        if (node.kind == Kind::table)
            for (const Entry& entry : node.entries()) {
                path_.push_back(static_cast<std::size_t>(&entry - node.entries().data()));
                walk(entry.value, label + (label.empty() ? "" : ".") + entry.key);
                path_.pop_back();
            }
        if (node.kind != Kind::array) return;
        const std::size_t n = node.items().size();
        for (std::size_t i = 0; i < n; ++i) {
            path_.push_back(i);
            walk(node.items()[i], n == 3 ? label + "." + "xyz"[i] : label + "[" + std::to_string(i) + "]");
            path_.pop_back();
        }
    }

    void take_one(const Node& node, const std::string& label)
    {
        for (const Entry& entry : node.entries()) {
            if (entry.key != "unknown" && entry.key != "low" && entry.key != "high")
                findings_.error(
                    entry.place, "unknown-key", "an unknown number has no key '" + entry.key + "'",
                    {"", "it has a guess and perhaps bounds: { unknown = 1, low = 0, high = 2 }"});
            else if (entry.value.kind != Kind::number && entry.value.kind != Kind::integer &&
                     entry.value.kind != Kind::text)
                findings_.error(entry.value.place, "wrong-type",
                                "'" + entry.key + "' of the unknown '" + label + "' must be a number, not " +
                                    std::string(describe(entry.value.kind)),
                                {"", "a number, or a string with a unit"});
        }
        StatedUnknown one{.name = label, .path = path_, .place = node.place};
        one.guess_place = node.find("unknown")->place;
        one.is_parameter = is_parameter_;
        // Results and with_found_guesses() go by names, which must be different ones.
        while (std::ranges::find(found_, one.name, &StatedUnknown::name) != found_.end()) one.name += "'";
        found_.push_back(std::move(one));
    }

    Findings& findings_;
    std::vector<std::size_t> path_;
    std::vector<StatedUnknown> found_;
    bool is_parameter_ = false;
};

Node& at(Node& root, std::span<const std::size_t> path)
{
    Node* node = &root;
    for (const std::size_t i : path)
        node = node->kind == Kind::table ? &node->content->entries[i].value : &node->content->items[i];
    return *node;
}

/// Amount of a guess or a bound; false after an error.
bool compute(const Node& node, const Parameters& parameters, const std::string& name, Amount& amount,
             Findings& findings)
{
    if (node.kind != Kind::text) {
        amount.value = node.number;
        return std::isfinite(node.number) ||
               findings.error(node.place, "not-finite", "the unknown '" + name + "' must be finite");
    }
    const Computed computed = compute(node.text(), parameters);
    amount = computed.amount;
    return computed.code.empty() || computed.error.empty() ||
           findings.error(node.place, computed.code,
                          "the unknown '" + name + "' cannot be \"" + node.text() + "\": " + computed.error,
                          {"", computed.help});
}

/// Guess and bounds as numbers. False after an error.
bool evaluate(const Node& table, const Parameters& parameters, StatedUnknown& one, Findings& findings)
{
    Amount guess;
    const Parameters::One* parameter = one.is_parameter ? parameters.find(one.name) : nullptr;
    if (parameter != nullptr)
        guess = parameter->amount;
    else if (!compute(*table.find("unknown"), parameters, one.name, guess, findings))
        return false;
    one.guess = guess.value;
    if (guess.has_unit) one.unit = si_unit_of(guess);
    for (const auto& [key, to] : {std::pair{"low", &one.low}, {"high", &one.high}}) {
        const Node* node = table.find(key);
        if (node == nullptr) continue;
        Amount bound;
        if (!compute(*node, parameters, one.name, bound, findings)) return false;
        if (bound.has_unit && bound.powers != guess.powers)
            return findings.error(node->place, "unit",
                                  "'" + std::string(key) + "' of the unknown '" + one.name + "' is " +
                                      described(bound) + ", and its guess is " + described(guess));
        *to = bound.value;
    }
    return true;
}

}   // namespace

std::optional<NumberedTree> with_guesses(const Node& root, std::span<const Override> overrides,
                                         Findings& findings)
{
    const int before = findings.n_errors();
    NumberedTree tree{{}, Collector(findings).take(root)};
    if (tree.unknowns.empty() || findings.n_errors() > before) return {};
    tree.root = copied(root);
    // Parameters first, as guesses of the file have them: others are computed from them.
    for (const StatedUnknown& one : tree.unknowns)
        if (one.is_parameter) {
            Node& node = at(tree.root, one.path);
            Node guess = copied(*node.find("unknown"));
            if (guess.kind == Kind::integer) guess.kind = Kind::number;
            node = std::move(guess);
        }
    // For guesses alone: whoever reads the tree computes parameters again, and warns of them then.
    Findings told_later;
    const Parameters parameters(tree.root.find("parameters"), overrides, told_later);
    if (told_later.n_errors() > 0) {   // guesses would be made of them
        Parameters(tree.root.find("parameters"), overrides, findings);
        return {};
    }
    // Guesses and bounds of parameters stand in the file's tree; in the other one they are numbers already.
    Node original = copied(root);
    for (StatedUnknown& one : tree.unknowns)
        if (!evaluate(at(original, one.path), parameters, one, findings)) return {};
    for (const StatedUnknown& one : tree.unknowns) at(tree.root, one.path) = number_node(one, one.guess);
    return tree;
}

Node with_numbers(const NumberedTree& tree, std::span<const double> values)
{
    Node root = copied(tree.root);
    for (std::size_t i = 0; i < values.size(); ++i)
        at(root, tree.unknowns[i].path) = number_node(tree.unknowns[i], values[i]);
    return root;
}

std::string with_found_guesses(std::string text, std::span<const std::string> names,
                               std::span<const double> values)
{
    Findings none;
    const std::optional<Node> root = parse_toml(text, none);
    if (!root) return text;
    const std::optional<NumberedTree> tree = with_guesses(*root, {}, none);
    if (!tree) return text;
    std::vector<std::pair<SourceLocation, std::string>> found;
    for (const StatedUnknown& one : tree->unknowns)
        for (std::size_t i = 0; i < names.size(); ++i)
            if (names[i] == one.name)
                found.emplace_back(one.guess_place, one.unit.empty()
                                                        ? to_text(values[i])
                                                        : '"' + to_text(values[i]) + " " + one.unit + '"');
    return with_values_at(std::move(text), found);
}

}   // namespace livens::inline io_internal
