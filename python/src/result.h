// SPDX-License-Identifier: BSD-3-Clause
// A run that Python holds: what its arrays are views of.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include "livens/io/results.h"
#include "livens/io/scenario.h"

namespace livens::python {

namespace nb = nanobind;

struct Result {
    std::shared_ptr<const Scenario> scenario;
    Run run;
    Method method;   ///< that was taken
    double solve_seconds = 0;
    double estimate_seconds = 0;
    std::vector<std::shared_ptr<Result>> roots{};   ///< the others that were found, see Solution::roots
};

/// A view of numbers that `owner` keeps alive: nothing is copied, and NumPy refuses to write to it.
nb::object view(const double* data, std::vector<std::size_t> shape, nb::handle owner,
                std::vector<std::int64_t> strides = {});
/// Numbers that become Python's.
nb::object array(std::vector<double>&& numbers, const std::vector<std::size_t>& shape);

using Times = nb::ndarray<const double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

void add_solving(nb::module_& m);
void add_results(nb::module_& m);
void add_rest(nb::module_& m);
void add_states(nb::module_& m);
/// The columns of drives_at(), and their units.
std::map<std::string, std::string> drive_columns(const Result& r);
/// Methods that sample a motion.
void add_samples(nb::class_<Result>& result);

}   // namespace livens::python
