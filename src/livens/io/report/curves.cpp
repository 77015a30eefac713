// SPDX-License-Identifier: BSD-3-Clause
// Series over time that the page cannot make of poses: energies, coordinates, reactions, loads, sensors.
// Numbers are bounded: where all that the elements have is too much, the page gets fewer instants of each
// element, then of several together, and is told what that loses (docs/results.md).
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "livens/diagnostics/coordinates.h"
#include "livens/diagnostics/diagnostics.h"
#include "livens/diagnostics/quantities.h"
#include "livens/diagnostics/sample.h"
#include "livens/io/report/lines_of_action.h"
#include "livens/io/report/parts.h"

namespace livens::inline io_internal {

namespace {

constexpr double bytes_of_number = 4;   // of what poses may take: a series takes half as much as they do
// Of the range of a series, and of its largest number: a constant with its rounding stays a constant.
constexpr int bits_of_number = 23;
constexpr double least_step = 0x1p-25;
constexpr double fewest_instants = 120;
constexpr double no_signal = 1e-12;   // of the largest number of all: rounding
constexpr double no_force = 1e-8;     // of what moves the whole model: what is left of forces that cancel
constexpr double flat = 2e-6;         // of itself: what plots show at the least
constexpr int n_places = 400;         // at what series lose between their instants

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
    bool is_whole = true;   ///< as many instants as the elements resolve
    std::vector<double> nodes{0};

    CurveInstants(const TimeMesh& mesh, std::size_t n_channels, int most_degree, double most_bytes)
    {
        const double wanted =
            std::max(most_bytes / bytes_of_number / static_cast<double>(n_channels), fewest_instants);
        const double n = mesh.n_elements();
        // Elements are taken together where even two instants each would be too many.
        const auto merged = static_cast<std::size_t>(std::max(1.0, std::ceil(2 * n / wanted)));
        for (std::size_t e = 0; e < mesh.ends.size(); e += merged) ends.push_back(mesh.ends[e]);
        if (ends.back() != mesh.ends.back()) ends.push_back(mesh.ends.back());
        if (n < 1) return;
        degree =
            merged > 1 ? 1 : std::clamp(static_cast<int>(std::min(wanted / n, 99.0)) - 1, 1, most_degree);
        is_whole = degree == most_degree;
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
            const NamedCoordinate& q = coordinates_.coordinate(static_cast<int>(i));
            std::string name = q.name;
            std::ranges::replace(name, '_', ' ');
            const char* const unit = q.coordinate.is_angle() ? "rad" : "m";
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
    const Model& model() const { return model_; }

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
        for (const double x : sensors_.at(given, instant.side)) all.push_back(x);
        return all;
    }

private:
    /// "angle acceleration", "acceleration x", "torque" and "power" of drives.
    void add_channels(const NamedQuantity& q)
    {
        const bool is_coordinate = q.of == QuantityOf::coordinate;
        std::string name = q.what != "effort" ? q.what : q.unit == "N m" ? "torque" : "force";
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

using Columns = std::vector<std::vector<double>>;   // of channels, node after node

/// By unit, what a series of it has at the least that is no rounding. In a free fall, say, joints bear
/// differences of weights and accelerations: nothing, but for their last digits.
std::map<std::string, double> rounding_of_units(const Model& model, double acceleration)
{
    double mass = 0;
    for (const Body& body : model.bodies()) mass += body.mass(0, 0);
    const double a = std::max(acceleration, norm(model.gravity())), length = model.length();
    const double rate = std::sqrt(a / length), force = mass * a;
    std::map<std::string, double> all{
        {"rad/s", rate}, {"m/s", rate * length},  {"rad/s^2", a / length}, {"m/s^2", a},
        {"N", force},    {"N m", force * length}, {"J", force * length},   {"W", force * rate * length}};
    for (auto& [unit, least] : all) least *= no_force;
    return all;
}

/// What the page shows between instants, and how far it is off.
class Between {
public:
    Between(const Curves& curves, const CurveInstants& instants, const Columns& columns)
        : curves_(curves), instants_(instants), columns_(columns), basis_(lobatto_basis(instants.degree)),
          weights_(instants.nodes.size())
    {
        for (std::size_t c = 0; c < columns.size(); ++c) {
            double low = columns[c][0], high = low;
            for (const double x : columns[c]) {   // reactions that are not bounded are no numbers
                low = x < low ? x : low;
                high = x > high ? x : high;
                largest_ = std::abs(x) > largest_ ? std::abs(x) : largest_;
            }
            // What is constant but for rounding is shown as a line.
            const double shown = std::max(high - low, flat * std::max(std::abs(high), std::abs(low)));
            const std::string& unit = curves.channels()[c].unit;
            double& range = ranges_[unit];
            if (shown > range) range = shown;
            if (unit == "m/s^2") fastest_ = std::max({fastest_, std::abs(low), std::abs(high)});
        }
        rounding_ = rounding_of_units(curves.model(), fastest_);
    }

    /// At a place of an element, as a part of the largest range that a series of the same unit has.
    double loss(std::size_t e, double s)
    {
        basis_.values(s, weights_);
        const double t = instants_.ends[e] + s * (instants_.ends[e + 1] - instants_.ends[e]);
        const std::vector<double> truth = curves_.at(t, false);
        const std::size_t n_nodes = weights_.size();
        double loss = 0;
        for (std::size_t c = 0; c < columns_.size(); ++c) {
            double shown = 0;
            for (std::size_t a = 0; a < n_nodes; ++a) shown += weights_[a] * columns_[c][e * n_nodes + a];
            const double range = ranges_[curves_.channels()[c].unit], off = std::abs(shown - truth[c]);
            const auto rounding = rounding_.find(curves_.channels()[c].unit);
            const double least =
                std::max(no_signal * largest_, rounding == rounding_.end() ? 0.0 : rounding->second);
            if (range > least && off / range > loss) loss = off / range;
        }
        return loss;
    }
    double largest_loss()
    {
        const std::size_t n = instants_.n_elements();
        double all = 0;
        for (int look = 0; look < n_places; ++look) {
            // Places that no motion keeps step with.
            const double place = std::fmod(0.5 + look * std::numbers::phi, 1.0) * static_cast<double>(n);
            const std::size_t e = std::min(static_cast<std::size_t>(place), n - 1);
            all = std::max(all, loss(e, place - static_cast<double>(e)));
        }
        return all;
    }

private:
    const Curves& curves_;
    const CurveInstants& instants_;
    const Columns& columns_;
    LagrangeBasis basis_;
    std::vector<double> weights_;
    std::map<std::string, double> ranges_, rounding_;   // of units
    double largest_ = 0, fastest_ = 0;
};

/// All channels at the nodes of an element.
void take(const Curves& curves, const CurveInstants& instants, std::size_t e, Columns& columns)
{
    for (std::size_t a = 0; a < instants.nodes.size(); ++a) {
        // An element end is told twice, from the left as the last node and from the right as the first:
        // jumps stay jumps.
        const std::vector<double> values = curves.at(instants.at(e, a), a > 0 && instants.nodes[a] == 1);
        for (std::size_t c = 0; c < columns.size(); ++c) columns[c].push_back(values[c]);
    }
}

/// Halves elements in which series do what no polynomial follows, as where a steep law turns over, as long as
/// there is room. False: some are left.
bool refine(const Curves& curves, CurveInstants& instants, Columns& columns, double most_bytes)
{
    constexpr double seen = 2e-3;   // of the range
    constexpr double places[] = {0.23, 0.61, 0.86};
    const double most = most_bytes / bytes_of_number / static_cast<double>(columns.size());
    for (int round = 0; round < 8; ++round) {
        Between between(curves, instants, columns);
        const std::size_t n = instants.n_elements(), n_nodes = instants.nodes.size();
        std::vector<bool> is_halved(n);
        std::size_t n_halved = 0;
        for (std::size_t e = 0; e < n; ++e) {
            is_halved[e] = std::ranges::any_of(places, [&](double s) { return between.loss(e, s) > seen; });
            n_halved += is_halved[e] ? 1 : 0;
        }
        if (n_halved == 0) return true;
        if (static_cast<double>((n + n_halved) * n_nodes) > most) return false;
        CurveInstants finer = instants;
        finer.ends = {instants.ends[0]};
        Columns all(columns.size());
        for (std::size_t e = 0; e < n; ++e) {
            if (is_halved[e]) finer.ends.push_back(0.5 * (instants.ends[e] + instants.ends[e + 1]));
            finer.ends.push_back(instants.ends[e + 1]);
            const std::size_t last = finer.ends.size() - 2;
            if (is_halved[e])
                for (const std::size_t half : {last - 1, last}) take(curves, finer, half, all);
            for (std::size_t c = 0; c < all.size() && !is_halved[e]; ++c)
                all[c].insert(all[c].end(), columns[c].begin() + static_cast<std::ptrdiff_t>(e * n_nodes),
                              columns[c].begin() + static_cast<std::ptrdiff_t>((e + 1) * n_nodes));
        }
        instants = std::move(finer);
        columns = std::move(all);
    }
    return false;
}

}   // namespace

void write_curves(ReportData& data, const Scenario& scenario, const Run& run, double most_bytes)
{
    const Curves curves(scenario, run);
    CurveInstants instants(run.motion.mesh, curves.channels().size(), std::max(run.motion.X.degree, 2),
                           most_bytes);
    Columns columns(curves.channels().size());
    for (std::size_t e = 0; e < instants.n_elements(); ++e) take(curves, instants, e, columns);
    const bool is_every = instants.ends.size() == run.motion.mesh.ends.size(),
               is_seen = run.motion.n_elements() < 1 ||
                         (instants.is_whole && refine(curves, instants, columns, most_bytes));
    std::vector<double> all;
    for (const std::vector<double>& column : columns) all.insert(all.end(), column.begin(), column.end());
    data.payload.add("curve", Stepped(all, columns.size(), bits_of_number, least_step), 1);
    data.payload.add("curve_end", Precision::full, instants.ends);
    JsonWriter& json = data.json;
    json.key("curves").begin_object();
    json.member("every", is_every);
    json.member("loss", is_seen ? 0.0 : Between(curves, instants, columns).largest_loss());
    json.key("nodes").value(std::span<const double>(instants.nodes)).end_object();
    json.key("channels").begin_array();
    for (const Channel& c : curves.channels()) {
        json.begin_object().member("kind", c.kind).member("index", c.index);
        json.member("name", c.name).member("unit", c.unit).end_object();
    }
    json.end_array();
}

}   // namespace livens::inline io_internal
