// SPDX-License-Identifier: BSD-3-Clause
// Elements of a URDF, held against what may stand in them.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "livens/io/import/urdf_file.h"

namespace livens::inline io_internal {

using UrdfWords = std::vector<std::string_view>;

/// Words that are known and do not count.
struct UncountedWord {
    std::string_view word;
    const LossKind* loss;
};

/// What may stand in an element.
struct ElementContent {
    UrdfWords attributes, children;
    std::vector<UncountedWord> uncounted = {};
    bool is_free = false;   ///< others may be anything
};

/// What is known of a word decides: it is taken, told as lost, or refused where it is nearly one that is
/// known.
class UrdfElements {
public:
    UrdfElements(Losses& losses, Findings& findings) : losses_(losses), findings_(findings) {}

protected:
    /// Holds the words of an element against what may stand in it.
    void check(const XmlElement& e, const ElementContent& content, const std::string& owner);
    const XmlElement* only(const XmlElement& e, std::string_view name);
    std::string name_of(const XmlElement& e);
    std::string text(const XmlElement& e, std::string_view attribute);
    /// False without the attribute, and after an error.
    bool numbers(const XmlElement& e, std::string_view attribute, std::span<double> values);
    double number(const XmlElement& e, std::string_view attribute, double otherwise);
    double bounded(const XmlElement& e, std::string_view attribute, double otherwise);
    double size(const XmlElement& e, std::string_view attribute);
    Pose pose(const XmlElement& e, const std::string& owner);

    Losses& losses_;
    Findings& findings_;

private:
    void check_word(const XmlElement& e, const XmlElement& child, const ElementContent& content,
                    const std::string& owner);
};

/// 'name'
std::string in_marks(std::string_view name);

}   // namespace livens::inline io_internal
