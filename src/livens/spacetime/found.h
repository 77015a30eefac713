// SPDX-License-Identifier: BSD-3-Clause
// Problems with unknown numbers once these are found: the model that they make, and what is asked of it.
#pragma once

#include <memory>
#include <string>

#include "livens/spacetime/march/ends.h"
#include "livens/spacetime/solve.h"

namespace livens::inline spacetime_internal {

/// The model that the motion belongs to.
const Model& found_model(const Model& model, const Solution& solution);

/// The problem that begins where unknown numbers were found; without any as it is.
Problem with_found(const Problem& problem, const FoundNumbers& numbers);

/// A problem over all of time, closed, with the model that it is for.
struct Stated {
    std::shared_ptr<const Model> model;
    Problem problem;
    Ends ends;
    Span span;
};

/// The same once numbers are found, as they make model, conditions, end of time and output times; null: its
/// ends do not close. Without unknown numbers the same.
std::shared_ptr<const Stated> stated_with(const std::shared_ptr<const Stated>& stated,
                                          const FoundNumbers& numbers, StartPolicy policy);

/// Of unknown numbers the largest estimated error, by what each is compared with or itself if that is more.
struct NumberError {
    double largest = 0;
    double rounding = 0;   ///< likewise of what rounding may move, whichever has most
    std::string name{};    ///< whose the largest is
};
/// `stated`: with what was found.
NumberError error_of_numbers(const UnknownNumbers& stated, const FoundNumbers& found);

/// Output times that elements of the next motion end at, whatever becomes of instants that are found: those
/// that stay apart from these if times are off by `error` of the duration.
std::vector<double> held_outputs(const Stated& stated, double error);

}   // namespace livens::inline spacetime_internal
