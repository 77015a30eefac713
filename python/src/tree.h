// SPDX-License-Identifier: BSD-3-Clause
// Between Python's containers and the tree that the reader of scenarios takes.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <nanobind/nanobind.h>

#include "livens/io/scenario.h"
#include "livens/io/scenario/text/document.h"

namespace livens::python {

namespace nb = nanobind;

/// Where a node stands in the tree: `line` of its SourceLocation is an index into these.
struct Location {
    std::string table;                ///< key of the root, empty: the root itself
    int index = -1;                   ///< among the tables of an array, or -1
    std::string key;                  ///< of the table, empty: the table itself
    std::vector<std::string> inner;   ///< from its value inwards: keys, and numbers from 0 in lists
};

/// Dicts, tuples, lists, texts, numbers and truths as a tree.
class TreeReader {
public:
    /// Throws what C++ throws for a tree that is too deep or too large, or holds what is no value (all
    /// InputError).
    Node read(nb::dict root);

    const std::vector<Location>& locations() const { return locations_; }
    /// Files by the names that meshes have: of texts with an attribute `path` (MeshFile of _meshes.py).
    const std::map<std::string, std::filesystem::path>& named() const { return named_; }

private:
    Node value(nb::handle object, const Location& location, int depth);
    Node table(nb::dict object, const Location& location, int depth);
    Node array(nb::handle object, const Location& location, int depth);
    bool read_scalar(nb::handle object, const Location& location, Node& node);
    void count(const Location& location);
    SourceLocation place(const Location& location);

    std::vector<Location> locations_{{}};   // 0: nothing is known
    std::map<std::string, std::filesystem::path> named_;
    int n_values_ = 0;
};

/// What a text holds: (table, places), or None after an error; places have the shape of the table:
/// {key: (line, column, length, nested places)}. Lists of tables have lists of places.
nb::tuple tables_of(const Node& root);

/// As dicts; with `locations` lines are indices into them.
nb::list to_python(const std::vector<Diagnostic>& diagnostics, const std::vector<Location>* locations);

/// Functions for the module.
void add_tree(nb::module_& m);
void add_importing(nb::module_& m);

}   // namespace livens::python
