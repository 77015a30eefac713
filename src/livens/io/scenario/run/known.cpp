// SPDX-License-Identifier: BSD-3-Clause
// Conditions by component: [start.known] and [end.known] say numbers under the names of quantities.
#include <algorithm>
#include <iterator>
#include <utility>

#include "livens/io/scenario/run/run.h"
#include "livens/io/scenario/text/amount.h"

namespace livens::inline io_internal {

namespace {

/// Texts with a unit must have that of the quantity.
/// kg m^2/s^2 of energies, else m or rad, over s of rates. Whether an angle has its rad is not asked; hertz
/// are no rad/s.
void check_unit(const Node& node, const Section& table, const StateQuantity& quantity)
{
    if (node.kind != Node::Kind::text) return;
    const Amount amount = compute(node.text(), table.parameters()).amount;
    if (!amount.has_unit) return;
    const bool is_energy = quantity.is_energy();
    const double length = quantity.is_angle() ? 0
                          : is_energy         ? 2
                                              : 1,
                 time = is_energy            ? -2
                        : quantity.is_rate() ? -1
                                             : 0;
    const bool fits = amount.powers[0] == length && amount.powers[1] == (is_energy ? 1 : 0) &&
                      amount.powers[2] == time && (quantity.is_angle() || amount.powers[3] == 0) &&
                      !amount.has_hertz;
    if (!fits)
        throw InputError({"unit", "", "'" + quantity.name + "' is in " + quantity.unit, node.text(), "",
                          "it is given as " + described(amount), ""});
}

void read_one(const Entry& entry, const Section& table, Condition::At at, const double* numbers,
              Builder& builder, Conditions& boundary)
{
    const std::vector<StateQuantity> quantities = state_quantities(builder.model(), entry.key);
    const bool is_list = entry.value.kind == Node::Kind::array;
    const std::size_t n = is_list ? entry.value.items().size() : 1;
    if (quantities.size() != n)
        throw InputError(
            {"wrong-type", "",
             "'" + entry.key + "' takes " + (quantities.size() == 1 ? "one number" : "three numbers"), "", "",
             "", ""});
    for (std::size_t i = 0; i < n; ++i) {
        check_unit(is_list ? entry.value.items()[i] : entry.value, table, quantities[i]);
        const std::string where = at == Condition::At::end ? "end" : "start";
        builder.remember(where + ".known[" + quantities[i].name + "]", entry.place);
        boundary.components.push_back({quantities[i], numbers[i], at});
    }
}

}   // namespace

Key known_key(const std::string& where)
{
    return Key{
        "known", types::quantities,
        "Conditions by component at the " + where +
            ", in place of `given`: numbers under the names of quantities in quotes, as `\"pivot.angle\" = "
            "\"90 deg\"`. A quantity is a coordinate of a joint or its rate, what a sensor reads of "
            "places and velocities, or of a body `x`, `y`, `z`, `vx`, `vy`, `vz`, the rotation vector from "
            "where `[[body]]` places it (`rotation_x` ..) and `angular_velocity_x` .., all in world axes; "
            "`position`, `velocity`, `rotation` and `angular_velocity` are three at once. A body has also "
            "`speed`, `kinetic_energy` and `energy` (with that of its weight), and `energy` alone is that of "
            "all "
            "bodies with what loads store. At both ends "
            "together there must be twice as many as the joints leave motions free. The bodies as they are "
            "placed, and their velocities, are a first guess. Angles at the end count turns from the "
            "start. At an end without quantities `given` may say positions or momenta of all bodies. For the "
            "family lobatto."};
}

void read_known(Builder& builder, const Section& table, Condition::At at, Conditions& boundary)
{
    const Value* known = table.find("known");
    if (known == nullptr) return;
    const bool is_faulty = builder.findings().n_errors() > 0;   // what is not found has been told of
    // Of all entries one after the other: one number each, or as many as its list has.
    const double* numbers = known->numbers.data();
    for (const Entry& entry : known->node->entries()) {
        const std::string path =
            std::string(at == Condition::At::end ? "end" : "start") + ".known[" + entry.key + "]";
        builder.remember(path, entry.place);
        builder.guard(path, [&] {
            try {
                read_one(entry, table, at, numbers, builder, boundary);
            } catch (const InputError& error) {
                Complaint complaint = error.complaint();
                complaint.path = path;
                if (is_faulty && complaint.code == "conditions-unknown") complaint.code = "";
                throw InputError(std::move(complaint));
            }
        });
        numbers += entry.value.kind == Node::Kind::array ? std::ssize(entry.value.items()) : 1;
    }
}

}   // namespace livens::inline io_internal
