// SPDX-License-Identifier: BSD-3-Clause
// Models out of other programs' files, as the tables that the package edits.
#include <nanobind/nanobind.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include "livens/io/import/urdf_scenario.h"
#include "tree.h"

namespace livens::python {

namespace {

using Numbers = std::map<std::string, double>;
using Loops = std::vector<std::tuple<std::string, std::string, std::string>>;

/// (tables and places, or None after an error; what was told; the folder of meshes).
nb::tuple read_urdf_text(nb::bytes text, const std::filesystem::path& file, const Numbers& at,
                         const Numbers& rates, bool is_free,
                         const std::map<std::string, std::filesystem::path>& packages, bool draws, bool stops,
                         bool mends, const Loops& loops, bool is_strict)
{
    UrdfOptions options;
    options.at = at;
    options.rates = rates;
    options.base = is_free ? UrdfOptions::Base::free : UrdfOptions::Base::fixed;
    options.packages = packages;
    options.meshes = draws ? UrdfOptions::Meshes::draw : UrdfOptions::Meshes::none;
    options.limits = stops ? UrdfOptions::Limits::stop : UrdfOptions::Limits::ignore;
    options.inertias = mends ? UrdfOptions::Inertias::mend : UrdfOptions::Inertias::strict;
    for (const auto& [first, second, type] : loops) options.loops.push_back({first, second, type});
    options.is_strict = is_strict;
    const ImportedTree tree = import_urdf({text.c_str(), text.size()}, file, options, false);
    return nb::make_tuple(tree.root ? nb::object(tables_of(*tree.root)) : nb::none(),
                          to_python(tree.diagnostics, nullptr), tree.folder.string());
}

}   // namespace

void add_importing(nb::module_& m)
{
    m.def("read_urdf", &read_urdf_text, nb::arg("text"), nb::arg("file"), nb::arg("at"), nb::arg("rates"),
          nb::arg("free"), nb::arg("packages"), nb::arg("draw"), nb::arg("stop"), nb::arg("mend"),
          nb::arg("loops"), nb::arg("strict"));
}

}   // namespace livens::python
