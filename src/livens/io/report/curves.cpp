// SPDX-License-Identifier: BSD-3-Clause
// Series over time that the page cannot make of poses: energies, coordinates, reactions, loads, sensors.
// Numbers are bounded, so instants become fewer as channels become more. The page interpolates them with the
// degree of the elements (docs/program.md).
#include <algorithm>
#include <cmath>

#include "livens/diagnostics/coordinates.h"
#include "livens/diagnostics/diagnostics.h"
#include "livens/diagnostics/quantities.h"
#include "livens/diagnostics/sample.h"
#include "livens/io/report/lines_of_action.h"
#include "livens/io/report/parts.h"

namespace livens::inline io_internal {

namespace {

constexpr double most_numbers = 4e5;   // of all series, about: what they add to a page is to stay below 2 MB
constexpr double most_instants = 700, fewest_instants = 120;

struct Channel {
    const char* kind;   ///< "energy", "joint", "reaction", "drive", "body", "load", "sensor"
    int index;          ///< of the joint, body, load or sensor
    std::string name;
    std::string unit;
};

/// Instants in elements, or in several of them together: at the nodes of a polynomial through the series,
/// which the page evaluates in between. Both ends of an element are instants of it.
struct CurveInstants {
    std::vector<double> ends;
    int degree = 0;
    std::vector<double> nodes{0};

    CurveInstants(const TimeMesh& mesh, std::size_t n_channels, int most_degree)
    {
        const double wanted =
            std::clamp(most_numbers / static_cast<double>(n_channels), fewest_instants, most_instants);
        const double n = mesh.n_elements();
        // Elements are taken together where even two instants each would be too many.
        const auto merged = static_cast<std::size_t>(std::max(1.0, std::ceil(2 * n / wanted)));
        for (std::size_t e = 0; e < mesh.ends.size(); e += merged) ends.push_back(mesh.ends[e]);
        if (ends.back() != mesh.ends.back()) ends.push_back(mesh.ends.back());
        if (n < 1) return;
        degree = merged > 1 ? 1 : std::clamp(static_cast<int>(wanted / n) - 1, 1, most_degree);
        nodes = lobatto_basis(degree).nodes();
    }
    std::size_t n_elements() const { return std::max<std::size_t>(ends.size() - 1, 1); }
    double at(std::size_t element, std::size_t node) const
    {
        if (nodes[node] == 0) return ends[element];
        if (nodes[node] == 1) return ends[element + 1];
        return ends[element] + nodes[node] * (ends[element + 1] - ends[element]);
    }
};

/// What is told of accelerations and drives. Accelerations of many bodies would take most of a page, and of
/// the time to make it.
std::vector<NamedQuantity> of_equations(const Quantities& quantities, std::size_t n_bodies)
{
    constexpr std::size_t most_accelerated = 60;
    std::vector<NamedQuantity> all;
    for (const NamedQuantity& q : quantities.all())
        if (q.of == QuantityOf::drive ||
            (n_bodies <= most_accelerated && (q.of == QuantityOf::coordinate || q.of == QuantityOf::body) &&
             q.what.ends_with("acceleration")))
            all.push_back(q);
    return all;
}

class Curves {
public:
    Curves(const Scenario& scenario, const Run& run)
        : model_(scenario.model), motion_(run.motion), quantities_(model_, motion_, run.body_names),
          equations_(of_equations(quantities_, run.body_names.size())), coordinates_(model_, motion_),
          sensors_(model_, motion_), accelerations_(model_, motion_),
          joints_(model_, motion_, accelerations_), turns_(model_, motion_),
          lines_(lines_of_action(model_, motion_)),
          has_reactions_(!sample_joints(model_, motion_, motion_.start()).empty())
    {
        for (const char* const name : {"kinetic", "potential"}) channels_.push_back({"energy", 0, name, "J"});
        for (std::size_t i = 0; i < coordinates_.places().size(); ++i) {
            const std::string& name = coordinates_.coordinate(static_cast<int>(i)).name;
            const char* const unit = name == "angle" ? "rad" : "m";
            const int joint = coordinates_.places()[i].joint;
            channels_.push_back({"joint", joint, name, unit});
            channels_.push_back({"joint", joint, name + " rate", std::string(unit) + "/s"});
        }
        for (int j = 0; has_reactions_ && j < static_cast<int>(model_.joints().size()); ++j)
            for (const char* const name :
                 {"force x", "force y", "force z", "torque x", "torque y", "torque z"})
                channels_.push_back({"reaction", j, name, name[0] == 'f' ? "N" : "N m"});
        for (const NamedQuantity& q : equations_) add_channels(q);
        for (std::size_t l = 0; l < lines_.size(); ++l) {
            for (const char* const name : {"force x", "force y", "force z"})
                if (is_told(lines_[l])) channels_.push_back({"load", static_cast<int>(l), name, "N"});
            for (const char* const name : {"torque x", "torque y", "torque z"})
                if (lines_[l].place) channels_.push_back({"load", static_cast<int>(l), name, "N m"});
        }
        for (std::size_t s = 0; s < model_.sensors().size(); ++s)
            for (const SensorComponent& c : model_.sensors()[s].components)
                channels_.push_back({"sensor", static_cast<int>(s), c.name, c.unit});
    }

    const std::vector<Channel>& channels() const { return channels_; }

    /// The values of all channels. `is_before`: from the left, where they jump.
    std::vector<double> at(double t, bool is_before) const
    {
        const State given = sample_state(motion_, t), state = accelerations_.on_joints(given);
        const std::vector<double> angles = turns_.at(state);
        const Instant instant{t, is_before ? Side::left : Side::right};
        std::vector<double> all{kinetic_energy(model_, state.X, state.V),
                                potential_energy(model_, instant, state.X, state.V, angles)};
        for (const CoordinateValue& c : coordinates_.at(state)) {
            all.push_back(c.value);
            all.push_back(c.rate);
        }
        if (has_reactions_) add_reactions(all, given, is_before);
        std::vector<double> numbers(static_cast<std::size_t>(quantities_.n_numbers()));
        quantities_.at(given, instant.side, equations_, numbers);
        for (const NamedQuantity& q : equations_)
            for (int i = 0; i < q.size; ++i) all.push_back(numbers[static_cast<std::size_t>(q.first + i)]);
        if (std::ranges::any_of(lines_, is_told)) {
            const std::vector<Reaction> forces = load_reactions(model_, lines_, state, angles, instant.side);
            for (std::size_t l = 0; l < lines_.size(); ++l) {
                if (is_told(lines_[l])) all.insert(all.end(), forces[l].force.a, forces[l].force.a + 3);
                if (lines_[l].place) all.insert(all.end(), forces[l].torque.a, forces[l].torque.a + 3);
            }
        }
        for (const double x : sensors_.at(state, instant.side)) all.push_back(x);
        return all;
    }

private:
    /// "angle acceleration", "acceleration x", "torque" and "power" of drives.
    void add_channels(const NamedQuantity& q)
    {
        const bool is_coordinate = q.of == QuantityOf::coordinate;
        std::string name = q.what.starts_with("drive_") ? q.what.substr(6) : q.what;
        std::ranges::replace(name, '_', ' ');
        const char* const kind = is_coordinate ? "joint" : q.of == QuantityOf::body ? "body" : "drive";
        const int index =
            is_coordinate ? coordinates_.places()[static_cast<std::size_t>(q.index)].joint : q.index;
        for (int i = 0; i < q.size; ++i)
            channels_.push_back({kind, index, name + (q.size > 1 ? " " : "") + component_of(q, i), q.unit});
    }
    static bool is_told(const LineOfAction& line) { return line.points[0] || line.place; }
    void add_reactions(std::vector<double>& all, const State& state, bool is_before) const
    {
        const std::vector<JointSample> joints = joints_.at(state);
        for (std::size_t j = 0; j < model_.joints().size(); ++j) {
            const double nan = std::numeric_limits<double>::quiet_NaN();
            Reaction r{{nan, nan, nan}, {nan, nan, nan}};
            if (!joints.empty() && joints[j].is_bounded) r = is_before ? joints[j].left : joints[j].right;
            for (const Vector3& v : {r.force, r.torque}) all.insert(all.end(), v.a, v.a + 3);
        }
    }

    const Model& model_;
    const Motion& motion_;
    Quantities quantities_;
    std::vector<NamedQuantity> equations_;
    JointCoordinates coordinates_;
    SensorReadings sensors_;
    Accelerations accelerations_;
    JointSampler joints_;
    LoadTurns turns_;
    std::vector<LineOfAction> lines_;
    bool has_reactions_;
    std::vector<Channel> channels_;
};

}   // namespace

void write_curves(ReportData& data, const Scenario& scenario, const Run& run)
{
    const Curves curves(scenario, run);
    const CurveInstants instants(run.motion.mesh, curves.channels().size(), std::max(run.motion.X.degree, 2));
    std::vector<std::vector<double>> columns(curves.channels().size());
    for (std::size_t e = 0; e < instants.n_elements(); ++e)
        for (std::size_t a = 0; a < instants.nodes.size(); ++a) {
            // An element end is told twice, from the left as the last node and from the right as the first:
            // jumps stay jumps.
            const std::vector<double> values = curves.at(instants.at(e, a), a > 0 && instants.nodes[a] == 1);
            for (std::size_t c = 0; c < columns.size(); ++c) columns[c].push_back(values[c]);
        }
    std::vector<double> all;
    for (const std::vector<double>& column : columns) all.insert(all.end(), column.begin(), column.end());
    data.payload.add("curve", Precision::single, all);
    data.payload.add("curve_end", Precision::full, instants.ends);
    JsonWriter& json = data.json;
    json.key("curves").begin_object();
    json.member("every", instants.ends.size() == run.motion.mesh.ends.size());
    json.key("nodes").value(std::span<const double>(instants.nodes)).end_object();
    json.key("channels").begin_array();
    for (const Channel& c : curves.channels()) {
        json.begin_object().member("kind", c.kind).member("index", c.index);
        json.member("name", c.name).member("unit", c.unit).end_object();
    }
    json.end_array();
}

}   // namespace livens::inline io_internal
