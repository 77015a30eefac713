// SPDX-License-Identifier: BSD-3-Clause
// What was stated at the ends of time against what the motion has there, component by component.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "livens/base/text.h"
#include "livens/diagnostics/estimate.h"
#include "livens/multibody/body.h"
#include "livens/multibody/model.h"
#include "livens/spacetime/march/components.h"
#include "livens/spacetime/march/ends.h"

namespace livens::inline spacetime_internal {

namespace {

constexpr double met_place = 1e-8;       // lengths of the model, or of directors
constexpr double met_momentum = 1e-6;    // of what the motion's largest speed makes of the body
constexpr double unknown_error = 1e-3;   // likewise, where nobody estimated the errors
constexpr double ends_safety = 10;       // by which these may be too small

/// A component that was stated.
struct Component {
    std::string what;   ///< "the x of its linear momentum"
    double stated = 0, found = 0;
    double off = 0;   ///< by what is allowed
    const char* unit = "";
};

/// One end of a motion.
struct End {
    const char* word;   ///< "start"
    Known known;
    const State& stated;
    int index;   ///< of an element end
};

class Comparison {
public:
    Comparison(const Model& model, const Motion& motion, const ErrorEstimate& estimate, const End& end)
        : model_(model), motion_(motion), end_(end), found_(motion.at_end(end.index)),
          length_(model.length()), speed_(fastest(end.stated)),
          allowed_(estimate.empty() ? unknown_error : met_momentum)
    {
        // of all the motion, which may come to rest
        for (int n = 0; n <= motion.n_elements(); ++n) speed_ = std::max(speed_, fastest(motion.at_end(n)));
        if (estimate.empty()) return;
        for (int b = 0; b < model.n_bodies(); ++b) {
            const std::size_t at = static_cast<std::size_t>(end.index * model.n_bodies() + b);
            const double error = estimate.position[at] + estimate.orientation[at] +
                                 (speed_ > 0 ? estimate.velocity[at] / speed_ : 0);
            if (std::isfinite(error)) allowed_ = std::max(allowed_, ends_safety * error);
        }
    }

    /// A sentence on what is met least; empty: all is.
    std::string reason() const
    {
        std::optional<Component> worst;
        int body = 0;
        for (int b = 0; b < model_.n_bodies(); ++b) {
            const auto take = [&](const Component& c) {
                if (c.off <= 1 || (worst && c.off <= worst->off)) return;
                worst = c;
                body = b;
            };
            if (knows_positions(end_.known)) compare_places(b, take);
            if (knows_momenta(end_.known)) compare_momenta(b, take);
        }
        if (!worst) return "";
        std::string text = std::string("what is given at the ") + end_.word + " is not met: body '" +
                           model_.body_name(body) + "' has " + worst->what + " " + to_text(worst->found, 6) +
                           worst->unit + ", given is " + to_text(worst->stated, 6) + worst->unit;
        if (end_.known == Known::momenta && !model_.joints().empty())
            text += std::string("; where the motion ") + (end_.index == 0 ? "begins" : "ends") +
                    " its joints hold this direction, so that of six momenta a body only as many can be "
                    "chosen as they leave free; give the positions at the " +
                    end_.word +
                    ", or the state at one end, or momenta that a motion of these joints has there";
        else
            text += "; try: more elements, or the state at one end";
        return text;
    }

private:
    /// m/s, of points and of the ends of directors that are as long as the model.
    double fastest(const State& state) const
    {
        double speed = 0;
        for (const Matrix34& V : state.V) {
            speed = std::max(speed, norm(V.column(0)));
            for (int i = 1; i < 4; ++i) speed = std::max(speed, norm(V.column(i)) * length_);
        }
        return speed;
    }

    template <class Take>
    void compare_places(int b, const Take& take) const
    {
        const Matrix34 &stated = end_.stated.X[b], &found = found_.X[b];
        for (int i = 0; i < (model_.bodies()[b].is_point ? 1 : 4); ++i)
            for (int k = 0; k < 3; ++k) {
                const std::string axis = std::string(1, "xyz"[k]);
                const double allowed = met_place * (i == 0 ? length_ : 1);
                take(Component{i == 0 ? "the " + axis + " of its position"
                                      : "the " + axis + " of its director d" + std::to_string(i),
                               stated(k, i), found(k, i), std::abs(found(k, i) - stated(k, i)) / allowed,
                               i == 0 ? " m" : ""});
            }
    }

    /// Six numbers in world axes, moments about the reference point, by what the largest speed makes of the
    /// body: M v, and M v times the reach of its mass.
    template <class Take>
    void compare_momenta(int b, const Take& take) const
    {
        const Body& body = model_.bodies()[b];
        if (body.holds_states()) return;   // which become others where they are sampled
        const Matrix34 stated = end_.stated.V[b] * body.mass, found = momentum(b);
        const double mass = body.mass(0, 0), arm = reach(body);
        for (const bool is_linear : {true, false}) {
            if (!is_linear && body.is_point) continue;
            const Vector3 p = is_linear ? stated.column(0) : moment(end_.stated.X[b], stated),
                          q = is_linear ? found.column(0) : moment(found_.X[b], found);
            const double allowed = allowed_ * speed_ * mass * (is_linear ? 1 : arm);
            for (int k = 0; k < 3; ++k) {
                const double off = std::abs(q[k] - p[k]);
                take(Component{"the " + std::string(1, "xyz"[k]) +
                                   (is_linear ? " of its linear momentum"
                                              : " of its moment of momentum about its reference point"),
                               p[k], q[k], off == 0 ? 0 : off / allowed, is_linear ? " N s" : " N m s"});
            }
        }
    }

    Matrix34 momentum(int b) const
    {
        if (motion_.momenta.empty()) return found_.V[b] * model_.bodies()[b].mass;
        return motion_.momenta[static_cast<std::size_t>(end_.index * model_.n_bodies() + b)];
    }

    static Vector3 moment(const Matrix34& X, const Matrix34& P)
    {
        Vector3 sum{};
        for (int i = 1; i < 4; ++i) sum += cross(X.column(i), P.column(i));
        return sum;
    }

    /// How far its mass lies from the reference point.
    static double reach(const Body& body)
    {
        double square = 0;
        for (int i = 1; i < 4; ++i) square += body.mass(i, i) / body.mass(0, 0);
        return std::sqrt(square);
    }

    const Model& model_;
    const Motion& motion_;
    const End& end_;
    State found_;
    double length_, speed_, allowed_;
};

}   // namespace

std::vector<std::string> unmet(const Model& model, const Ends& ends, const Motion& motion,
                               const ErrorEstimate& estimate)
{
    std::vector<std::string> reasons = unmet_components(model, ends, motion);
    const auto known = [&](Known at, Known whole) { return ends.has_components() ? whole : at; };
    for (const End& end : {End{"start", known(ends.at_start, ends.whole[0]), ends.start, 0},
                           End{"end", known(ends.at_end, ends.whole[1]), ends.end, motion.n_elements()}}) {
        if (end.known == Known::nothing) continue;
        const std::string reason = Comparison(model, motion, estimate, end).reason();
        if (!reason.empty()) reasons.push_back(reason);
    }
    return reasons;
}

}   // namespace livens::inline spacetime_internal
