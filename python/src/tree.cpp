// SPDX-License-Identifier: BSD-3-Clause
#include "tree.h"

#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/string_view.h>
#include <nanobind/stl/vector.h>

#include "livens/base/error.h"
#include "livens/io/scenario/schema/other_keys.h"
#include "livens/io/scenario/schema/other_words.h"
#include "livens/io/scenario/schema/repeat.h"
#include "livens/io/scenario/schema/schema.h"
#include "livens/io/scenario/schema/section.h"
#include "livens/io/scenario/text/parameters.h"
#include "livens/io/scenario/text/units.h"
#include "livens/io/scenario/text/unknown_nodes.h"

namespace livens::python {

namespace {

/// "body[rod].shape": of a location as the messages of livens call it; without names, by number.
std::string path_of(const Location& at)
{
    std::string path = at.table;
    if (at.index >= 0) path += "[" + std::to_string(at.index) + "]";
    if (!at.key.empty()) path += (path.empty() ? "" : ".") + at.key;
    return path;
}

[[noreturn]] void refuse(const Location& at, const char* code, const std::string& message)
{
    throw InputError({code, path_of(at), message, "", "", "", ""});
}

std::string utf8(nb::handle text, const Location& at)
{
    Py_ssize_t size = 0;
    const char* bytes = PyUnicode_AsUTF8AndSize(text.ptr(), &size);
    if (bytes != nullptr) return {bytes, static_cast<std::size_t>(size)};
    PyErr_Clear();
    refuse(at, "not-text", "this string holds surrogates, which are not characters");
}

/// A value of a key: tuples and lists alike.
nb::object to_object(const Node& node);

nb::tuple place_tuple(const SourceLocation& place, nb::object nested)
{
    return nb::make_tuple(place.line, place.column, place.length, std::move(nested));
}

nb::object places_of(const Node& node)
{
    if (node.kind == Node::Kind::table) return tables_of(node)[1];
    if (node.kind != Node::Kind::array) return nb::none();
    nb::list all;
    for (const Node& item : node.items()) {
        if (item.kind != Node::Kind::table) return nb::none();
        all.append(place_tuple(item.place, tables_of(item)[1]));
    }
    return all;
}

nb::object to_object(const Node& node)
{
    switch (node.kind) {
    case Node::Kind::truth:
        return nb::bool_(node.number != 0);
    case Node::Kind::integer:
        return nb::int_(static_cast<long long>(node.number));
    case Node::Kind::number:
        return nb::float_(node.number);
    case Node::Kind::text:
        return nb::str(node.text().c_str(), node.text().size());
    case Node::Kind::table:
        return tables_of(node)[0];
    case Node::Kind::date:
        return nb::none();
    case Node::Kind::array:
        break;
    }
    nb::list items;
    for (const Node& item : node.items()) items.append(to_object(item));
    const bool is_of_tables = !node.items().empty() && node.items().front().kind == Node::Kind::table;
    if (is_of_tables) return items;
    return nb::tuple(items);
}

nb::dict to_python(const Key& key, nb::dict& indices)
{
    nb::dict d;
    d["name"] = key.name;
    d["words"] = key.type.words;
    d["form"] = static_cast<int>(key.type.form);
    d["other"] = static_cast<int>(key.type.other);
    d["count"] = key.type.count;
    d["type"] = describe_type(key);
    d["doc"] = key.doc;
    d["unit"] = key.unit;
    d["other_unit"] = key.other_unit;
    nb::list units;
    for (const std::string_view unit : key.units) units.append(unit);
    d["units"] = units;
    d["fallback"] = key.fallback;
    d["required"] = key.required;
    d["told_by"] = key.told_by;
    nb::list choices;
    for (const std::string_view word : key.choices) choices.append(word);
    d["choices"] = nb::tuple(choices);
    const auto child = nb::int_(reinterpret_cast<std::uintptr_t>(key.child.get()));
    d["child"] = key.child != nullptr ? nb::object(indices[child]) : nb::none();
    return d;
}

/// The tables of schema.h, children by their index.
nb::list schema()
{
    const std::vector<const Table*> tables = schema_tables();
    nb::dict indices;
    for (std::size_t i = 0; i < tables.size(); ++i)
        indices[nb::int_(reinterpret_cast<std::uintptr_t>(tables[i]))] = i;
    nb::list all;
    for (const Table* table : tables) {
        nb::dict d;
        d["heading"] = table->heading;
        d["doc"] = table->doc;
        d["chooser"] = table->chooser;
        nb::list keys, kinds;
        for (const Key& key : table->keys) keys.append(to_python(key, indices));
        for (const Kind& kind : table->kinds) {
            nb::dict k;
            nb::list own;
            for (const Key& key : kind.keys) own.append(to_python(key, indices));
            k["word"] = kind.word;
            k["doc"] = kind.doc;
            k["keys"] = own;
            kinds.append(k);
        }
        d["keys"] = keys;
        d["kinds"] = kinds;
        all.append(d);
    }
    return all;
}

/// With unknown numbers as they are guessed.
Node guessed(Node root, std::span<const Override> overrides, Findings& findings)
{
    std::optional<NumberedTree> numbered = with_guesses(root, overrides, findings);
    return numbered ? std::move(numbered->root) : std::move(root);
}

/// Those of a model, from its table.
struct ModelParameters {
    explicit ModelParameters(const nb::dict& table)
    {
        nb::dict root;
        root["parameters"] = table;
        tree = guessed(reader.read(root), {}, findings);
        if (findings.n_errors() == 0) parameters = Parameters(tree.find("parameters"), {}, findings);
    }

    TreeReader reader{};
    Node tree{};
    Findings findings{};
    Parameters parameters{};
};

/// ({name: value in SI units}, what is wrong).
nb::tuple parameters_of(const nb::dict& table)
{
    ModelParameters all(table);
    nb::dict values;
    for (const Parameters::One& one : all.parameters.all()) values[one.name.c_str()] = one.amount.value;
    return nb::make_tuple(values, python::to_python(all.findings.take(""), &all.reader.locations()));
}

/// (the text of a scenario with other values of its parameters, what is wrong).
nb::tuple with_parameters(const std::string& text,
                          const std::vector<std::pair<std::string, std::string>>& values)
{
    Findings findings;
    std::string set = text;
    std::optional<Node> root;
    if (text.size() <= max_scenario_bytes && scan(text, findings)) root = parse_toml(text, findings);
    if (root) {
        std::vector<Override> overrides;
        for (const auto& [name, value] : values) overrides.push_back({.name = name, .text = value});
        const Node tree = guessed(std::move(*root), overrides, findings);
        const Parameters parameters(tree.find("parameters"), overrides, findings);
        set = with_set_values(text, parameters);
    }
    return nb::make_tuple(set, python::to_python(findings.take(""), nullptr));
}

/// What the schema alone says of a table of the scenario, as in ("joint", {...}).
nb::list check_table(const std::string& name, nb::dict table, const nb::dict& parameters)
{
    const Key* key = find_key(root_table().keys_of(any_kind), name);
    if (key == nullptr || key->child == nullptr) throw nb::key_error(name.c_str());
    nb::dict root;
    nb::list one;
    one.append(table);
    root[name.c_str()] = key->type.form == Form::tables ? nb::object(one) : nb::object(table);
    TreeReader reader;
    const Node tree = reader.read(root);
    const Node& value = tree.entries().front().value;
    const Node& node = key->type.form == Form::tables ? value.items().front() : value;
    const Node* title = node.find("name");
    const bool is_named = title != nullptr && title->kind == Node::Kind::text;
    Findings findings;
    const ModelParameters all(parameters);
    const Section section(node, *key->child,
                          key->type.form == Form::tables ? name + (is_named ? " '" + title->text() + "'" : "")
                                                         : "[" + name + "]",
                          findings, all.parameters);
    return python::to_python(findings.take(""), &reader.locations());
}

/// (table, places) or None, and what is wrong.
nb::tuple parse(nb::bytes text)
{
    const std::string_view view(text.c_str(), text.size());
    Findings findings;
    std::optional<Node> root;
    if (view.size() > max_scenario_bytes)
        findings.error({}, "resource-limit",
                       "the scenario has more than " + std::to_string(max_scenario_bytes) + " bytes");
    else if (view.find_first_not_of(" \t\r\n") == std::string_view::npos)
        findings.error({}, "empty-file", "the file is empty",
                       {"", "the folder examples holds scenarios to begin with"});
    else if (scan(view, findings))
        root = parse_toml(view, findings);
    if (root && root->find("repeat") != nullptr) {
        Findings told_later;   // of parameters, by whatever builds the model
        const Node tree = guessed(std::move(*parse_toml(view, told_later)), {}, told_later);
        const Parameters parameters(tree.find("parameters"), {}, told_later);
        root = without_repeats(*root, parameters, findings);
    }
    nb::object tables = root ? nb::object(tables_of(*root)) : nb::none();
    return nb::make_tuple(tables, python::to_python(findings.take(""), nullptr));
}

/// In SI units; of a text in either unit, or computed.
double quantity(std::string_view text, std::string_view unit, std::string_view other_unit,
                const nb::dict& parameters)
{
    const ModelParameters all(parameters);
    if (is_computed(text, all.parameters)) {
        Computed found = compute(text, other_unit.empty() ? unit : other_unit, all.parameters);
        if (!found.code.empty() && !other_unit.empty()) found = compute(text, unit, all.parameters);
        if (!found.code.empty())
            throw InputError(
                {found.code, "", "\"" + std::string(text) + "\": " + found.error, "", "", "", found.help});
        return found.amount.value;
    }
    if (!other_unit.empty()) {
        const Quantity other = parse_quantity(text, other_unit);
        if (other.error.empty()) return other.value;
    }
    const Quantity q = parse_quantity(text, unit);
    if (!q.error.empty())
        throw InputError({"unit", "", "\"" + std::string(text) + "\": " + q.error, "", "", "", q.help});
    return q.value;
}

std::string suggestion(std::string_view word, nb::list known)
{
    std::vector<std::string> words;
    for (nb::handle w : known) words.push_back(nb::cast<std::string>(w));
    const std::vector<std::string_view> views(words.begin(), words.end());
    return suggest(word, views);
}

/// (the choice that a word of another program means, with what); empty where nothing is known.
nb::tuple other_word(std::string_view word, nb::list choices)
{
    std::vector<std::string> words;
    for (nb::handle w : choices) words.push_back(nb::cast<std::string>(w));
    std::string_view with;
    const std::string_view choice = in_other_words(word, {words.begin(), words.end()}, with);
    return nb::make_tuple(std::string(choice), std::string(with));
}

/// What to type instead of a key, in a table by its heading and a kind by its word; empty: nothing is known.
std::string other_key(std::string_view heading, std::string_view kind, std::string_view key,
                      std::string_view name)
{
    for (const Table* table : schema_tables()) {
        if (table->heading != heading) continue;
        int index = any_kind;
        for (std::size_t i = 0; i < table->kinds.size(); ++i)
            if (table->kinds[i].word == kind) index = static_cast<int>(i);
        return instead_of_key(*table, index, key, name).help;
    }
    return {};
}

}   // namespace

nb::tuple tables_of(const Node& root)
{
    nb::dict table, places;
    for (const Entry& entry : root.entries()) {
        const nb::str key(entry.key.c_str(), entry.key.size());
        table[key] = to_object(entry.value);
        places[key] = place_tuple(entry.value.place, places_of(entry.value));
    }
    return nb::make_tuple(table, places);
}

SourceLocation TreeReader::place(const Location& location)
{
    locations_.push_back(location);
    return {static_cast<int>(locations_.size()) - 1, 1, 1};
}

Node TreeReader::read(nb::dict root) { return table(root, {}, 1); }

Node TreeReader::table(nb::dict object, const Location& location, int depth)
{
    Node node;
    node.place = place(location);
    node.content = std::make_unique<NodeContent>();
    for (const auto& [name, content] : object) {
        Location at = location;
        if (at.table.empty())
            at.table = utf8(name, location);
        else if (at.key.empty())
            at.key = utf8(name, location);
        else
            at.inner.push_back(utf8(name, location));
        Entry& entry = node.content->entries.emplace_back();
        entry.key = utf8(name, location);
        entry.place = place(at);
        entry.value = value(content, at, depth + 1);
    }
    return node;
}

/// Numbers, truths and texts. False for others.
bool TreeReader::read_scalar(nb::handle object, const Location& location, Node& node)
{
    if (PyBool_Check(object.ptr())) {
        node.kind = Node::Kind::truth;
        node.number = object.is(Py_True) ? 1 : 0;
    } else if (PyLong_Check(object.ptr())) {
        node.kind = Node::Kind::integer;
        const long long number = PyLong_AsLongLong(object.ptr());
        if (PyErr_Occurred() != nullptr) {
            PyErr_Clear();
            refuse(location, "number-overflow", "this whole number does not fit into 64 bits");
        }
        node.number = static_cast<double>(number);
    } else if (PyFloat_Check(object.ptr())) {
        node.kind = Node::Kind::number;
        node.number = PyFloat_AsDouble(object.ptr());
    } else if (PyUnicode_Check(object.ptr())) {
        node.kind = Node::Kind::text;
        node.content = std::make_unique<NodeContent>();
        node.content->text = utf8(object, location);
        if (PyUnicode_CheckExact(object.ptr()) == 0 && nb::hasattr(object, "path"))
            named_[node.content->text] = nb::cast<std::string>(nb::str(object.attr("path")));
    } else {
        return false;
    }
    return true;
}

Node TreeReader::array(nb::handle object, const Location& location, int depth)
{
    Node node;
    node.kind = Node::Kind::array;
    node.place = place(location);
    node.content = std::make_unique<NodeContent>();
    node.content->items.reserve(nb::len(object));
    const bool is_of_tables = location.key.empty() && location.index < 0;
    int index = 0;
    for (nb::handle item : nb::borrow<nb::object>(object)) {
        Node& child = node.content->items.emplace_back();
        child.place = node.place;   // a long list has one place
        count(location);
        if (!read_scalar(item, location, child)) {
            Location at = location;
            if (is_of_tables)
                at.index = index;
            else
                at.inner.push_back(std::to_string(index));
            child = value(item, at, depth + 1);
        }
        ++index;
    }
    return node;
}

void TreeReader::count(const Location& location)
{
    if (++n_values_ > max_scenario_values)
        refuse(location, "resource-limit",
               "the model has more than " + std::to_string(max_scenario_values) + " values");
}

Node TreeReader::value(nb::handle object, const Location& location, int depth)
{
    if (depth > max_scenario_depth)
        refuse(location, "too-deep",
               "values are nested deeper than " + std::to_string(max_scenario_depth) + " levels");
    if (PyDict_Check(object.ptr())) return table(nb::borrow<nb::dict>(object), location, depth);
    if (PyTuple_Check(object.ptr()) || PyList_Check(object.ptr())) return array(object, location, depth);
    Node node;
    count(location);
    if (!read_scalar(object, location, node))
        refuse(location, "wrong-type",
               "a " + nb::cast<std::string>(nb::str(object.type().attr("__name__"))) + " is no value here");
    node.place = place(location);
    return node;
}

nb::list to_python(const std::vector<Diagnostic>& diagnostics, const std::vector<Location>* locations)
{
    nb::list all;
    for (const Diagnostic& d : diagnostics) {
        nb::dict item;
        item["severity"] = d.severity == Severity::error ? "error" : "warning";
        item["code"] = d.code;
        item["message"] = d.message;
        item["line"] = d.line;
        item["column"] = d.column;
        item["length"] = d.length;
        item["note"] = d.note;
        item["help"] = d.help;
        item["file"] = d.file;
        item["source_line"] = d.source_line;
        const bool is_known = locations != nullptr && d.file.empty() && d.line > 0 &&
                              static_cast<std::size_t>(d.line) < locations->size();
        const Location at = is_known ? (*locations)[static_cast<std::size_t>(d.line)] : Location{};
        nb::list inner;
        for (const std::string& step : at.inner) inner.append(nb::str(step.c_str(), step.size()));
        item["location"] = nb::make_tuple(at.table, at.index, at.key, inner);
        all.append(item);
    }
    return all;
}

void add_tree(nb::module_& m)
{
    m.def("schema", &schema);
    m.def("parse", &parse, nb::arg("text"));
    m.def("check_table", &check_table, nb::arg("name"), nb::arg("table"), nb::arg("parameters"));
    m.def("quantity", &quantity, nb::arg("text"), nb::arg("unit"), nb::arg("other_unit") = "",
          nb::arg("parameters") = nb::dict());
    m.def("parameters", &parameters_of, nb::arg("table"));
    m.def("with_parameters", &with_parameters, nb::arg("text"), nb::arg("values"));
    m.def("suggestion", &suggestion, nb::arg("word"), nb::arg("known"));
    m.def("other_word", &other_word, nb::arg("word"), nb::arg("choices"));
    m.def("other_key", &other_key, nb::arg("heading"), nb::arg("kind"), nb::arg("key"), nb::arg("name") = "");
    m.def(
        "explain", [](const std::string& code) { return std::string(explain(code)); }, nb::arg("code"));
    m.def("diagnostic_codes", [] {
        nb::list all;
        for (const std::string_view code : diagnostic_codes()) all.append(code);
        return all;
    });
}

}   // namespace livens::python
