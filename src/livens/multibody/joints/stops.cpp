// SPDX-License-Identifier: BSD-3-Clause
// A stop is a driven row that stands still, begun by the event that its coordinate passes the limit, and
// ended where its force would pull: theory.md, "Impacts".
#include "livens/multibody/joints/stops.h"

#include <cmath>
#include <utility>

#include "livens/base/error.h"
#include "livens/base/text.h"
#include "livens/multibody/joints/drives.h"
#include "livens/multibody/model.h"

namespace livens {

namespace {

TimeFunction constantly(double value)
{
    return {[value](Instant) { return TimeValue{value, 0, 0}; }, {}};
}

/// `look`: what the stop is of, of the coordinates; `terms` has these.
/// A term is positive where its condition is true: here, as far as the coordinate is beyond the limit.
int add_stop(Model& model, Joint stop, const StopLaw& law, EventTerms terms,
             std::function<double(std::span<const double> coordinates)> look)
{
    if (!(law.restitution >= 0 && law.restitution <= 1))
        throw InputError({"stop-restitution", "joint[" + stop.name + "].restitution",
                          "a restitution is the part of the speed with which bodies go apart again",
                          to_text(law.restitution), "0 to 1", "", ""});
    const int side = law.is_lowest ? 1 : -1;
    stop.type = "stop";
    stop.is_begun_by_event = stop.is_ended_by_event = true;
    stop.impact = {law.restitution, side, law.goes_together};
    const std::string name = stop.name;
    const int joint = model.add_joint(std::move(stop));
    terms.n_terms = 1;
    terms.when = {{0}};
    terms.values = [look = std::move(look), side,
                    limit = law.limit](const LawArguments& at, std::span<const double>,
                                       std::span<double> out) { out[0] = side * (limit - look(at.values)); };
    const std::string sign = law.is_lowest ? " < " : " > ";
    model.add_event(
        {name, name + sign + to_text(law.limit), std::move(terms), {EventAction::Does::begin, joint}});
    EventTerms pulls;   // its force would be towards its closed side
    pulls.reactions = {{joint, false, {}, true}};
    pulls.n_terms = 1;
    pulls.when = {{0}};
    pulls.values = [side](const LawArguments&, std::span<const double> reactions, std::span<double> out) {
        out[0] = side * reactions[0];
    };
    model.add_event({name + " opens", name + " pulls", std::move(pulls), {EventAction::Does::end, joint}});
    return joint;
}

}   // namespace

int add_coordinate_stop(Model& model, const std::string& name, const Joint& joint,
                        const NamedCoordinate& coordinate, const StopLaw& law, const Configurations& X)
{
    Joint stop = driven_coordinate(name, joint, coordinate, constantly(law.limit), X);
    EventTerms terms;
    terms.coordinates = {{coordinate.coordinate, coordinate.at_stated}};
    return add_stop(model, std::move(stop), law, std::move(terms),
                    [](std::span<const double> q) { return q[0]; });
}

/// The condition sees the root of three displacements along axes of the first body, and so a length as the
/// limit is one; the row is one of squares.
int add_distance_stop(Model& model, const std::string& name, const BodyPoint& first, const BodyPoint& second,
                      const StopLaw& law, const Configurations& X)
{
    const bool is_turned = second.body == world;   // what is held is a body
    const BodyPoint &a = is_turned ? second : first, &b = is_turned ? first : second;
    Joint stop = driven_distance(name, a.body, a.point, b.body, b.point, constantly(law.limit), X);
    EventTerms terms;
    for (int i = 0; i < 3; ++i) {
        Vector3 axis{};
        axis[i] = 1;
        const JointCoordinate along =
            displacement_along(a.body, direction(axis), point(a.point), b.body, point(b.point));
        terms.coordinates.push_back({along, coordinate_value(along, X)});
    }
    return add_stop(model, std::move(stop), law, std::move(terms), [](std::span<const double> q) {
        return std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2]);
    });
}

}   // namespace livens
