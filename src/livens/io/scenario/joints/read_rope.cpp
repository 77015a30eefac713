// SPDX-License-Identifier: BSD-3-Clause
// Ropes: `over` of a rod, and of a spring.
#include "livens/io/scenario/joints/joints.h"

namespace livens::inline io_internal {

std::optional<std::vector<BodyPoint>> read_over(Builder& builder, const Section& section)
{
    std::vector<BodyPoint> over;
    bool is_good = section.is_valid() &&
                   section.refuse({"between", "points"}, "rope-points", "'over' says where the rope is");
    for (const Section& at : section.sections("over")) {
        const Value* named = at.find("body");
        if (named == nullptr) return {};   // a name of no point, which was told
        const BodyReference body = builder.find_body(named->text, named->node->place, section);
        is_good = is_good && body.is_usable;
        if (body.is_usable) over.push_back({body.index, builder.in_axes(body.index, at.vector("point"))});
    }
    return is_good ? std::optional(over) : std::nullopt;
}

void read_rope(Builder& builder, const Section& section, const std::string& name, const std::string& path)
{
    const std::optional<std::vector<BodyPoint>> over = read_over(builder, section);
    if (!over) return;
    builder.guard(path, [&] {
        const std::vector<Matrix34> X = builder.start_configurations();
        const double length = section.has("length") ? section.number("length") : rope_length(*over, X);
        if (!section.has("length")) check_rope(path + ".over", *over, X);
        Joint joint = rod(name, *over, length, X);
        read_times(builder, section, joint);
        builder.model().add_joint(std::move(joint));
    });
}

}   // namespace livens::inline io_internal
