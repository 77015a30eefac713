// SPDX-License-Identifier: BSD-3-Clause
// What is drawn: surfaces of bodies, joints with their axes, lines of action of loads.
// Joints have no pictures of their own kind: an axis is read off their rows, each of which is a product of
// two directions (theory.md, "Joints are quadratic forms").
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "livens/diagnostics/coordinates.h"
#include "livens/diagnostics/sample.h"
#include "livens/io/exports/formats.h"
#include "livens/io/report/lines_of_action.h"
#include "livens/io/report/parts.h"
#include "livens/multibody/body.h"

namespace livens::inline io_internal {

namespace {

void add(JsonWriter& json, const char* key, const Vector3& v)
{
    json.key(key).value(std::span<const double>(v.a));
}

/// A surface in a box from -1 to 1; the body's is this one stretched and moved.
struct UnitSurface {
    Surface surface;
    Vector3 middle{}, half{1, 1, 1};
};

/// Normals are stretched the other way than points are, and made unit vectors again.
UnitSurface unit_surface(Surface surface)
{
    UnitSurface unit;
    for (int i = 0; i < 3; ++i) {
        const auto of = [i](const Vector3& p) { return p[i]; };
        const auto [least, most] = std::ranges::minmax(surface.points, {}, of);
        unit.middle[i] = 0.5 * (least[i] + most[i]);
        if (most[i] > least[i]) unit.half[i] = 0.5 * (most[i] - least[i]);
    }
    for (std::size_t k = 0; k < surface.points.size(); ++k) {
        Vector3 &p = surface.points[k], &n = surface.normals[k];
        for (int i = 0; i < 3; ++i) {
            p[i] = (p[i] - unit.middle[i]) / unit.half[i];
            n[i] *= unit.half[i];
        }
        n = (1 / norm(n)) * n;
    }
    unit.surface = std::move(surface);
    return unit;
}

/// What no picture shows takes no room: bytes of zeros nearly vanish as they are compressed.
constexpr double steps_of_points = 1 << 14, steps_of_normals = 1 << 8;
Vector3 rounded(Vector3 v, double steps)
{
    for (double& x : v.a) x = std::round(steps * x) / steps;
    return v;
}

/// Whether normals at corners are those of the faces as the page has them, none of which shares a corner.
/// Within 11 degrees they are: the cosine is above 0.98.
bool is_flat(const Surface& unit)
{
    std::size_t next = 0;
    for (const auto& corners : unit.triangles) {
        std::array<Vector3, 3> p{};
        for (std::size_t i = 0; i < 3; ++i) {
            if (corners[i] != static_cast<int>(next++)) return false;
            p[i] = rounded(unit.points[static_cast<std::size_t>(corners[i])], steps_of_points);
        }
        const Vector3 face = cross(p[1] - p[0], p[2] - p[0]);
        const double size = norm(face);
        for (const int corner : corners)   // a face without area is not seen
            if (size > 1e-12 && !(dot(face, unit.normals[static_cast<std::size_t>(corner)]) > 0.98 * size))
                return false;
    }
    return true;
}

/// Bodies of one form, whatever their sizes, share a surface.
class Shapes {
public:
    explicit Shapes(Payload& payload) : payload_(payload) {}

    int index_of(const Surface& unit)
    {
        std::vector<int> key;
        for (const auto* vectors : {&unit.points, &unit.normals})
            for (const Vector3& v : *vectors)
                // Rounded, since equal shapes of different sizes differ by rounding after their stretch is
                // taken off.
                for (const double x : v.a) key.push_back(static_cast<int>(std::lround(1e5 * x)));
        for (const auto& corners : unit.triangles) key.insert(key.end(), corners.begin(), corners.end());
        const auto [place, is_new] = known_.try_emplace(std::move(key), static_cast<int>(known_.size()));
        if (is_new) store(unit, std::to_string(place->second));
        return place->second;
    }
    std::size_t size() const { return known_.size(); }

private:
    void store(const Surface& unit, const std::string& number)
    {
        std::vector<double> points, normals, corners;
        const auto append = [](std::vector<double>& to, const Vector3& v) {
            to.insert(to.end(), std::begin(v.a), std::end(v.a));
        };
        for (const Vector3& p : unit.points) append(points, rounded(p, steps_of_points));
        if (!is_flat(unit))   // else the page finds them
            for (const Vector3& n : unit.normals) append(normals, rounded(n, steps_of_normals));
        for (const auto& t : unit.triangles) corners.insert(corners.end(), t.begin(), t.end());
        payload_.add("points " + number, Precision::single, points);
        payload_.add("normals " + number, Precision::single, normals);
        payload_.add("corners " + number, Precision::whole, corners);
    }

    Payload& payload_;
    std::map<std::vector<int>, int> known_;
};

/// The box about something, in coordinates of its body.
struct Box {
    Vector3 least{}, most{};
    bool is_empty = true;

    void take(const Vector3& p)
    {
        for (int i = 0; i < 3; ++i) {
            least[i] = is_empty ? p[i] : std::min(least[i], p[i]);
            most[i] = is_empty ? p[i] : std::max(most[i], p[i]);
        }
        is_empty = false;
    }
    Vector3 middle() const { return 0.5 * (least + most); }
    Vector3 half() const
    {
        Vector3 h = 0.5 * (most - least);
        for (int i = 0; i < 3; ++i)
            if (!(h[i] > 0)) h[i] = 1;   // a plate has a side that is not stretched
        return h;
    }
};

/// "#rrggbb"
std::string hexadecimal(const Vector3& color)
{
    constexpr char digits[] = "0123456789abcdef";
    std::string text = "#";
    for (const double c : color.a) {
        const long level = std::lround(255 * c);
        text += digits[level / 16];
        text += digits[level % 16];
    }
    return text;
}

/// Bodies and the world, each with what is drawn of it.
class BodyWriter {
public:
    explicit BodyWriter(ReportData& data) : shapes_(data.payload), json_(data.json) {}

    void write(const Scenario& scenario)
    {
        std::vector<std::vector<Drawn>> all = drawn_of(scenario);
        std::vector<Surface> surfaces;
        for (const std::vector<Drawn>& drawn : all)
            for (const Drawn& one : drawn) surfaces.push_back(one.surface);
        most_triangles_ = triangles_of_each(surfaces);
        json_.key("bodies").begin_array();
        for (std::size_t b = 0; b + 1 < all.size(); ++b) {
            if (scenario.model.bodies()[b].holds_states()) continue;
            const Outline outline = b < scenario.outlines.size() ? scenario.outlines[b] : Outline{};
            write_body(scenario.model.bodies()[b], outline, all[b]);
        }
        json_.end_array();
        write_pieces("world", all.back());
        json_.member("shapes", shapes_.size());
    }

private:
    void write_body(const Body& body, const Outline& outline, std::vector<Drawn>& drawn)
    {
        json_.begin_object().member("name", body.name).member("point", body.is_point);
        json_.member("mark", outline.is_empty()).member("mass", body.mass(0, 0));
        json_.key("color");
        outline.color ? json_.value(hexadecimal(*outline.color)) : json_.null();
        write_pieces("pieces", drawn);
        add(json_, "middle", box_.middle());
        add(json_, "half", box_.half());
        json_.key("thinned");
        if (n_left_out_ == 0)
            json_.null();
        else
            json_.begin_array().value(n_drawn_ + n_left_out_).value(n_drawn_).value(moved_).end_array();
        add(json_, "centre", body.is_point ? Vector3{} : mass_properties(body.mass).center_of_mass);
        json_.end_object();
    }

    void write_pieces(const char* key, std::vector<Drawn>& drawn)
    {
        box_ = {};
        n_drawn_ = n_left_out_ = 0;
        moved_ = 0;
        json_.key(key).begin_array();
        for (Drawn& one : drawn) {
            one.surface = thinned(std::move(one.surface), most_triangles_);
            const Surface& thin = one.surface;
            for (const Vector3& p : thin.points) box_.take(one.place + one.axes * p);
            n_drawn_ += thin.triangles.size();
            n_left_out_ += thin.n_left_out;
            moved_ = std::max(moved_, thin.moved);
            const UnitSurface unit = unit_surface(std::move(one.surface));
            json_.begin_object().member("shape", shapes_.index_of(unit.surface));
            add(json_, "middle", one.place + one.axes * unit.middle);
            add(json_, "half", unit.half);
            // The columns of the matrix are the axes of the piece, one behind the other.
            json_.key("axes");
            if (norm(one.axes - identity<3>()) == 0)
                json_.null();
            else
                json_.value(std::span<const double>(one.axes.a));
            json_.key("color");
            one.color ? json_.value(hexadecimal(*one.color)) : json_.null();
            json_.member("opacity", one.opacity).end_object();
        }
        json_.end_array();
    }

    Shapes shapes_;
    JsonWriter& json_;
    std::size_t most_triangles_ = 0;
    // Of what was written last.
    Box box_;
    std::size_t n_drawn_ = 0, n_left_out_ = 0;
    double moved_ = 0;
};

/// The two directions of a row a . b = 0, or a . (x - y) = 0, in coordinates of its bodies: its form is one
/// product. Zero where it is not.
struct RowDirections {
    Vector3 first{}, second{};
};
RowDirections directions_of(const ConstraintRow& row)
{
    Matrix<3, 4> product{};   // rows: components of the first direction
    for (int i = 0; i < 3; ++i)
        // The form of a row a . b is the outer product of both directions, here or folded into B_j.
        for (int j = 0; j < 4; ++j) product(i, j) = row.body_i == world ? row.b_j(i, j) : row.c_ij(i + 1, j);
    int largest = 0;
    for (int k = 1; k < 12; ++k)
        if (std::abs(product[k]) > std::abs(product[largest])) largest = k;
    const Vector3 first = product.column(largest / 3);
    const Vector3 second{product(largest % 3, 1), product(largest % 3, 2), product(largest % 3, 3)};
    const auto unit = [](const Vector3& v) { return norm(v) > 0 ? (1 / norm(v)) * v : Vector3{}; };
    return {unit(first), unit(second)};
}

/// Directions of a joint in coordinates of its first and of its second body; zero where it has none.
RowDirections axes_of(const Joint& joint)
{
    const auto lines = [&](std::size_t r) { return directions_of(joint.rows[r]); };
    if (norm(joint.axis_first) > 0) return {joint.axis_first, joint.axis_second};
    if (joint.type == "universal" || joint.type == "perpendicular_axes" || joint.type == "constant_angle")
        return lines(joint.rows.size() - 1);
    if (joint.type == "point_in_plane") return {lines(0).first, {}};
    if (joint.type == "point_on_line" && joint.rows.size() == 2)
        return {cross(lines(0).first, lines(1).first), {}};
    return {};
}

/// The points that a rope runs over.
void write_over(JsonWriter& json, const std::vector<BodyPoint>& over)
{
    json.key("over").begin_array();
    for (const BodyPoint& at : over) {
        json.begin_object().member("body", at.body);
        add(json, "point", at.point);
        json.end_object();
    }
    json.end_array();
}

void write_joints(JsonWriter& json, const Model& model)
{
    json.key("joints").begin_array();
    for (const Joint& joint : model.joints()) {
        const RowDirections axes = axes_of(joint);
        json.begin_object().member("name", joint.name).member("type", joint.type);
        const auto is_driven = [](const ConstraintRow& row) { return row.label == "driven distance"; };
        json.member("bar", (joint.type == "rod" && joint.over.empty()) ||
                               std::ranges::any_of(joint.rows, is_driven));
        json.member("first", joint.first).member("second", joint.second);
        add(json, "point_first", joint.point_first);
        add(json, "point_second", joint.point_second);
        add(json, "axis_first", axes.first);
        add(json, "axis_second", axes.second);
        const std::vector<TimeSpan> spans = joint.spans();
        const double never = std::numeric_limits<double>::max(), from = spans.empty() ? never : spans[0].from,
                     until = spans.empty() ? never : spans.back().until;
        for (const auto& [key, t] : {std::pair{"from", from}, {"until", until}}) {
            json.key(key);
            std::isfinite(t) ? json.value(t) : json.null();
        }
        json.key("path").begin_array();
        for (const Vector3& place : joint.path) json.value(std::span<const double>(place.a));
        json.end_array();
        write_over(json, joint.over);
        json.end_object();
    }
    json.end_array();
}

void write_loads(JsonWriter& json, const Model& model, const Motion& motion)
{
    const std::vector<LineOfAction> lines = lines_of_action(model, motion);
    json.key("loads").begin_array();
    for (std::size_t l = 0; l < lines.size(); ++l) {
        const Load& load = model.loads()[l];
        if (load.type == controller_type) continue;
        json.begin_object().member("name", load.name).member("type", load.type);
        json.member("first", load.bodies[0]).member("second", load.bodies[1]);
        for (const int side : {0, 1}) {
            const char* const key = side == 0 ? "point_first" : "point_second";
            if (const auto& point = lines[l].points[static_cast<std::size_t>(side)])
                add(json, key, *point);
            else
                json.key(key).null();
        }
        if (lines[l].place)
            add(json, "place", *lines[l].place);
        else
            json.key("place").null();
        write_over(json, load.over);
        json.end_object();
    }
    json.end_array();
}

void write_sensors(JsonWriter& json, const Model& model)
{
    json.key("sensors").begin_array();
    for (const Sensor& sensor : model.sensors()) {
        json.begin_object().member("name", sensor.name).member("type", sensor.type);
        json.key("components").begin_array();
        for (const SensorComponent& component : sensor.components) json.value(component.name);
        json.end_array().end_object();
    }
    json.end_array();
}

}   // namespace

void write_scene(ReportData& data, const Scenario& scenario, const Run& run)
{
    BodyWriter(data).write(scenario);
    write_joints(data.json, scenario.model);
    write_loads(data.json, scenario.model, run.motion);
    write_sensors(data.json, scenario.model);
    add(data.json, "gravity", scenario.model.gravity());
    data.json.member("length", scenario.model.length());
}

}   // namespace livens::inline io_internal
