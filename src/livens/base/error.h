// SPDX-License-Identifier: BSD-3-Clause
// Wrong input, reported as data: what is wrong, where, by which bound, and what to do.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace [[gnu::visibility("default")]] livens {

/// Everything a reader of the message needs; `io` adds file, line and column to it from `path`.
struct Complaint {
    std::string code;      ///< stable, documented: "inertia-triangle"
    std::string path;      ///< the place in the model: `body[upper].mass`, `joint[elbow]`, `time.elements`
    std::string message;   ///< one sentence that names the object and the condition
    std::string value;     ///< what was given, as text; empty if there is none
    std::string bound;     ///< what is allowed, as text; empty if there is none
    std::string note;      ///< the law that is broken; may be empty
    std::string help;      ///< the likely fix; may be empty
};

/// Thrown by everything that takes input from a user; never for failures of the numerics (see SolveReport).
class InputError : public std::runtime_error {
public:
    explicit InputError(Complaint complaint)
        : std::runtime_error(text(complaint)), complaint_(std::move(complaint))
    {}

    const Complaint& complaint() const { return complaint_; }

private:
    static std::string text(const Complaint& c)
    {
        std::string s = c.message;
        if (!c.path.empty()) s = c.path + ": " + s;
        if (!c.value.empty()) s += " (given: " + c.value + ")";
        if (!c.bound.empty()) s += " (allowed: " + c.bound + ")";
        if (!c.note.empty()) s += "; " + c.note;
        if (!c.help.empty()) s += "; " + c.help;
        return s;
    }

    Complaint complaint_;
};

}   // namespace livens
