// SPDX-License-Identifier: BSD-3-Clause
// The compiled part of the Python package: few functions that take and give what Python has; names, units
// and messages for people are made in the package around it.
#include <nanobind/nanobind.h>

#include "livens/base/error.h"
#include "livens/base/version.h"
#include "result.h"
#include "tree.h"

namespace nb = nanobind;

/// livens._errors makes the exceptions that users see.
static void translate(const std::exception_ptr& thrown, void*)
{
    try {
        std::rethrow_exception(thrown);
    } catch (const livens::InputError& error) {
        const livens::Complaint& c = error.complaint();
        std::string message = c.message;
        if (!c.value.empty()) message += " (given: " + c.value + ")";
        if (!c.bound.empty()) message += " (allowed: " + c.bound + ")";
        const nb::object made = nb::module_::import_("livens._errors")
                                    .attr("from_engine")(c.code.c_str(), c.path.c_str(), message.c_str(),
                                                         c.note.c_str(), c.help.c_str());
        PyErr_SetObject(reinterpret_cast<PyObject*>(made.type().ptr()), made.ptr());
    } catch (const livens::IoError& error) {
        const nb::object made =
            nb::module_::import_("livens._errors").attr("from_files")(error.code().c_str(), error.what());
        PyErr_SetObject(reinterpret_cast<PyObject*>(made.type().ptr()), made.ptr());
    }
}

NB_MODULE(_core, m)
{
    // A function of Python that is a load, and knows the model that it is in, lives until the end: no fault
    // of users.
    nb::set_leak_warnings(false);
    m.attr("version") = livens::version;
    nb::register_exception_translator(translate);
    livens::python::add_tree(m);
    livens::python::add_importing(m);
    livens::python::add_solving(m);
    livens::python::add_results(m);
    livens::python::add_rest(m);
    livens::python::add_states(m);
}
