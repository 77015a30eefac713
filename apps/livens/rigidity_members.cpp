// SPDX-License-Identifier: BSD-3-Clause
#include "rigidity_members.h"

#include <span>

namespace livens::program {

void add_triad(JsonWriter& json, const char* key, const Matrix3& d)
{
    json.key(key).begin_array();
    for (int i = 0; i < 3; ++i) json.value(std::span<const double>(d.column(i).a));
    json.end_array();
}

void rigidity_members(JsonWriter& json, const Body& body, const RigiditySample& s)
{
    json.key("rigidity").begin_object();
    add_triad(json, "left", s.left);
    add_triad(json, "right", s.right);
    json.member("unique", s.is_unique);
    json.end_object();
    if (body.volume > 0)
        add_triad(json, "mean_stress", 1 / body.volume * s.right);
    else
        json.key("mean_stress").null();
}

}   // namespace livens::program
