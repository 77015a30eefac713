// SPDX-License-Identifier: BSD-3-Clause
// glTF 2.0 in its binary form. [Khronos, glTF 2.0 Specification]
// Bodies as nodes with cubic splines through positions and orientations, made of values and rates of the
// motion, so that few output times give a smooth animation: docs/results.md.
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "livens/base/version.h"
#include "livens/diagnostics/sample.h"
#include "livens/io/exports/formats.h"
#include "livens/io/json.h"

namespace livens::inline io_internal {

namespace {

enum Component { unsigned_int = 5125, real = 5126 };
enum Target { of_vertices = 34962, of_indices = 34963 };
constexpr int lines = 1;   // mode of a primitive

/// Colours of bodies, which readers who confuse red and green tell apart. [Okabe and Ito 2008]
constexpr double colours[][3] = {{0, 0.447, 0.698},    {0.902, 0.624, 0},     {0, 0.62, 0.451},
                                 {0.8, 0.475, 0.655},  {0.337, 0.706, 0.914}, {0.835, 0.369, 0},
                                 {0.941, 0.894, 0.259}};
constexpr int n_colours = static_cast<int>(std::size(colours));

/// The binary part with the list of what stands where in it. Numbers are single precision.
class Buffer {
public:
    struct Accessor {
        const char* type;
        std::size_t n_in_one;
        int component = real;
        int target = 0;
        bool has_bounds = false;
    };

    int add(const Accessor& a, std::span<const float> values)
    {
        begin(a, values.size());
        if (a.has_bounds) put_bounds(a, values);
        for (const float x : values) put(bytes_, x);
        return end();
    }
    int add(const std::vector<std::array<int, 3>>& triangles)
    {
        begin({"SCALAR", 1, unsigned_int, of_indices}, 3 * triangles.size());
        for (const auto& corners : triangles)
            for (const int c : corners) put(bytes_, static_cast<std::uint32_t>(c));
        return end();
    }

    void write(JsonWriter& json) const
    {
        json.key("accessors").raw("[" + accessors_ + "]");
        json.key("bufferViews").raw("[" + views_ + "]");
        json.key("buffers").begin_array().begin_object();
        json.member("byteLength", bytes_.size()).end_object().end_array();
    }
    const std::string& bytes() const { return bytes_; }

private:
    /// All numbers have four bytes, so that every view begins at a multiple of four, as the format asks.
    void begin(const Accessor& a, std::size_t n_numbers)
    {
        JsonWriter view;
        view.begin_object().member("buffer", 0).member("byteOffset", bytes_.size());
        view.member("byteLength", 4 * n_numbers);
        if (a.target != 0) view.member("target", a.target);
        views_ += (n_ > 0 ? "," : "") + view.end_object().text();
        accessor_ = JsonWriter();
        accessor_.begin_object().member("bufferView", n_).member("componentType", a.component);
        accessor_.member("count", n_numbers / a.n_in_one).member("type", a.type);
    }
    void put_bounds(const Accessor& a, std::span<const float> values)
    {
        constexpr double infinite = std::numeric_limits<double>::infinity();
        std::vector<double> least(a.n_in_one, infinite), most(a.n_in_one, -infinite);
        for (std::size_t i = 0; i < values.size(); ++i) {
            least[i % a.n_in_one] = std::min(least[i % a.n_in_one], static_cast<double>(values[i]));
            most[i % a.n_in_one] = std::max(most[i % a.n_in_one], static_cast<double>(values[i]));
        }
        accessor_.key("min").value(std::span<const double>(least));
        accessor_.key("max").value(std::span<const double>(most));
    }
    int end()
    {
        accessors_ += (n_ > 0 ? "," : "") + accessor_.end_object().text();
        return n_++;
    }

    std::string bytes_, accessors_, views_;
    JsonWriter accessor_;
    int n_ = 0;
};

std::vector<float> floats(const std::vector<Vector3>& vectors)
{
    std::vector<float> all;
    for (const Vector3& v : vectors)
        for (const double x : v.a) all.push_back(static_cast<float>(x));
    return all;
}

/// glTF has its quaternions as (x, y, z, w).
std::array<double, 4> turned_round(const Vector4& q) { return {q[1], q[2], q[3], q[0]}; }

/// Positions and orientations at instants that single precision tells apart, with their rates: between them a
/// player has the cubic through both.
struct Tracks {
    std::vector<float> times;                                  ///< since the start, s
    std::vector<std::vector<float>> positions, orientations;   ///< of a body: rate, value, rate, time by time
    std::vector<BodySample> first;
    Vector3 least, most;   ///< of all reference points, m

    void add(const std::vector<BodySample>& bodies, const std::vector<Vector4>& quaternions)
    {
        for (std::size_t b = 0; b < positions.size(); ++b) {
            const BodySample& s = bodies[b];
            // The format asks for the tangent before, the value and the tangent behind; here both tangents
            // are the rate.
            for (const Vector3& v : {s.velocity, s.position, s.velocity})
                for (const double x : v.a) positions[b].push_back(static_cast<float>(x));
            for (int i = 0; i < 3; ++i) {
                least[i] = std::min(least[i], s.position[i]);
                most[i] = std::max(most[i], s.position[i]);
            }
            if (std::isnan(s.quaternion[0])) continue;   // a point mass
            // q' = (0, w) q / 2
            const Vector4& q = quaternions[b];
            const Vector3 w = 0.5 * s.angular_velocity, v{q[1], q[2], q[3]};
            const Vector3 turn = q[0] * w + cross(w, v);
            const Vector4 rate{-dot(w, v), turn[0], turn[1], turn[2]};
            for (const Vector4& x : {rate, q, rate})
                for (const double number : turned_round(x))
                    orientations[b].push_back(static_cast<float>(number));
        }
    }
};

Tracks tracks_of(const ExportInput& input)
{
    const Run& run = input.run;
    Tracks tracks;
    tracks.positions.resize(run.n_told_bodies());
    tracks.orientations.resize(run.n_told_bodies());
    constexpr double infinite = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 3; ++i) {
        tracks.least[i] = infinite;
        tracks.most[i] = -infinite;
    }
    std::vector<Vector4> previous(run.body_names.size(), Vector4{1, 0, 0, 0});
    for (const double t : reached_times(run)) {
        const auto time = static_cast<float>(t - run.motion.start());
        // Single precision may make two instants one, and the format wants them to ascend.
        if (!tracks.times.empty() && !(time > tracks.times.back())) continue;
        const std::vector<BodySample> bodies = sample_bodies(input.scenario.model, run.motion, t);
        for (std::size_t b = 0; b < bodies.size(); ++b)
            previous[b] = continued(previous[b], bodies[b].quaternion);
        if (tracks.times.empty()) tracks.first = bodies;
        tracks.times.push_back(time);
        tracks.add(bodies, previous);
    }
    return tracks;
}

class Scene {
public:
    Scene(const ExportInput& input)
        : run_(input.run), drawn_(drawn_of(input.scenario)), tracks_(tracks_of(input))
    {
        if (tracks_.times.empty())
            throw IoError("the run has reached no output time: there is nothing to show");
        const Vector3& g = input.scenario.model.gravity();
        if (norm(g) > 0) up_ = (-1 / norm(g)) * g;
    }

    std::string take()
    {
        JsonWriter json;
        json.begin_object();
        json.key("asset").begin_object().member("version", "2.0");
        json.member("generator", std::string("livens ") + version).end_object();
        json.member("scene", 0);
        json.key("scenes").begin_array().begin_object();
        if (!run_.title.empty()) json.member("name", run_.title);
        json.key("nodes").raw("[0]").end_object().end_array();
        add_nodes(json);
        add_meshes(json);
        add_materials(json);
        if (tracks_.times.size() > 1) add_animation(json);
        buffer_.write(json);
        json.end_object();
        return packed(json.text());
    }

private:
    int n_bodies() const { return static_cast<int>(run_.n_told_bodies()); }
    int n_worn() const { return std::min(n_bodies(), n_colours); }

    /// The shortest turn that brings `up` to y, which is up in glTF.
    Vector4 turn_upright() const
    {
        // The quaternion of the shortest turn from u to y is (1 + u . y, u x y) up to its length.
        const Vector4 q{1 + up_[1], -up_[2], 0, up_[0]};
        const double size = std::sqrt(dot(q, q));
        return size > 1e-6 ? (1 / size) * q : Vector4{0, 1, 0, 0};
    }

    void add_nodes(JsonWriter& json)
    {
        json.key("nodes").begin_array();
        json.begin_object().member("name", "world").key("rotation").value(turned_round(turn_upright()));
        json.member("mesh", n_bodies()).key("children").begin_array();
        for (int b = 0; b < n_bodies(); ++b) json.value(b + 1);
        json.end_array().end_object();
        for (int b = 0; b < n_bodies(); ++b) {
            const BodySample& s = tracks_.first[static_cast<std::size_t>(b)];
            json.begin_object()
                .member("name", run_.body_names[static_cast<std::size_t>(b)])
                .member("mesh", b);
            json.key("translation").value(std::span<const double>(s.position.a));
            if (!std::isnan(s.quaternion[0])) json.key("rotation").value(turned_round(s.quaternion));
            json.end_object();
        }
        json.end_array();
    }

    void add_meshes(JsonWriter& json)
    {
        json.key("meshes").begin_array();
        for (int b = 0; b < n_bodies(); ++b) {
            json.begin_object().member("name", run_.body_names[static_cast<std::size_t>(b)]);
            json.key("primitives").begin_array();
            for (const Drawn& one : drawn_[static_cast<std::size_t>(b)])
                add_primitive(json, one, b % n_colours);
            json.end_array().end_object();
        }
        json.begin_object().member("name", "ground").key("primitives").begin_array().begin_object();
        json.member("mode", lines).key("attributes").begin_object();
        json.member("POSITION", buffer_.add({"VEC3", 3, real, of_vertices, true}, floats(grid())));
        json.end_object().member("material", n_worn()).end_object();
        for (const Drawn& one : drawn_.back()) add_primitive(json, one, n_worn());
        json.end_array().end_object().end_array();
    }

    void add_primitive(JsonWriter& json, const Drawn& one, int worn)
    {
        const Surface s = united({one});
        const int points = buffer_.add({"VEC3", 3, real, of_vertices, true}, floats(s.points));
        const int normals = buffer_.add({"VEC3", 3, real, of_vertices}, floats(s.normals));
        json.begin_object().key("attributes").begin_object();
        json.member("POSITION", points).member("NORMAL", normals).end_object();
        json.member("indices", buffer_.add(s.triangles)).member("material", paint_of(one, worn)).end_object();
    }

    /// The material of what has a colour or can be seen through, else that which its body wears.
    int paint_of(const Drawn& one, int worn)
    {
        if (!one.color && one.opacity == 1) return worn;
        const std::array<double, 4> own = paint(worn);
        std::array<double, 4> rgba{own[0], own[1], own[2], one.opacity};
        // Factors are linear in light, colours of scenarios in sRGB. [IEC 61966-2-1]
        for (std::size_t i = 0; i < 3 && one.color; ++i) {
            const double c = (*one.color)[static_cast<int>(i)];
            rgba[i] = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
        }
        const auto known = std::ranges::find(paints_, rgba);
        const auto index = static_cast<int>(known - paints_.begin());
        if (known == paints_.end()) paints_.push_back(rgba);
        return n_worn() + 1 + index;
    }
    std::array<double, 4> paint(int worn) const
    {
        if (worn >= n_worn()) return {0.5, 0.5, 0.5, 1};
        const double* c = colours[worn];
        return {c[0], c[1], c[2], 1};
    }

    /// Lines of a square below everything that moves.
    std::vector<Vector3> grid() const
    {
        constexpr int n = 10;
        double reach = 0;
        for (std::size_t b = 0; b + 1 < drawn_.size(); ++b)
            for (const Drawn& one : drawn_[b])
                for (const Vector3& p : one.surface.points)
                    reach = std::max(reach, norm(one.place + one.axes * p));
        const Vector3 middle = 0.5 * (tracks_.least + tracks_.most), span = tracks_.most - tracks_.least;
        const double half = 0.5 * norm(span) + 2 * reach;
        double below = reach;
        for (int i = 0; i < 3; ++i) below += 0.5 * std::abs(up_[i]) * span[i];
        const Vector3 side = std::abs(up_[0]) < 0.6 ? Vector3{1, 0, 0} : Vector3{0, 1, 0};
        const Vector3 across = (1 / norm(cross(up_, side))) * cross(up_, side), along = cross(across, up_);
        const Vector3 centre = middle - below * up_;
        std::vector<Vector3> points;
        for (int i = 0; i <= n; ++i) {
            const double at = half * (2.0 * i / n - 1);
            for (const double end : {-half, half}) points.push_back(centre + at * across + end * along);
            for (const double end : {-half, half}) points.push_back(centre + end * across + at * along);
        }
        return points;
    }

    /// As many as there are bodies to wear them, then the ground's, then those of colours that were stated.
    void add_materials(JsonWriter& json) const
    {
        std::vector<std::array<double, 4>> all;
        for (int i = 0; i <= n_worn(); ++i) all.push_back(paint(i));
        all.insert(all.end(), paints_.begin(), paints_.end());
        json.key("materials").begin_array();
        for (const std::array<double, 4>& rgba : all) {
            json.begin_object().key("pbrMetallicRoughness").begin_object();
            json.key("baseColorFactor").value(rgba);
            json.member("metallicFactor", 0.1).member("roughnessFactor", 0.6).end_object();
            if (rgba[3] < 1) json.member("alphaMode", "BLEND");
            json.end_object();
        }
        json.end_array();
    }

    void add_animation(JsonWriter& json)
    {
        const int times = buffer_.add({"SCALAR", 1, real, 0, true}, tracks_.times);
        JsonWriter samplers, channels;
        samplers.begin_array();
        channels.begin_array();
        int n = 0;
        const auto add = [&](int body, const char* path, int values) {
            samplers.begin_object().member("input", times).member("output", values);
            samplers.member("interpolation", "CUBICSPLINE").end_object();
            channels.begin_object().member("sampler", n++).key("target").begin_object();
            channels.member("node", body + 1).member("path", path).end_object().end_object();
        };
        for (int b = 0; b < n_bodies(); ++b) {
            const auto i = static_cast<std::size_t>(b);
            add(b, "translation", buffer_.add({"VEC3", 3}, tracks_.positions[i]));
            if (!tracks_.orientations[i].empty())
                add(b, "rotation", buffer_.add({"VEC4", 4}, tracks_.orientations[i]));
        }
        json.key("animations").begin_array().begin_object().member("name", "motion");
        json.key("samplers").raw(samplers.end_array().text());
        json.key("channels").raw(channels.end_array().text()).end_object().end_array();
    }

    /// Head, JSON and binary part, each filled up to a multiple of four.
    std::string packed(std::string json) const
    {
        json.append((4 - json.size() % 4) % 4, ' ');
        const std::uint64_t size = 12 + 8 + json.size() + 8 + buffer_.bytes().size();
        if (size > std::numeric_limits<std::uint32_t>::max())
            throw IoError("the animation would be larger than the 4 GiB that the format knows; fewer output "
                          "times need less");
        std::string out = "glTF";
        put(out, std::uint32_t{2});
        put(out, static_cast<std::uint32_t>(size));
        const auto chunk = [&](const char* kind, const std::string& bytes) {
            put(out, static_cast<std::uint32_t>(bytes.size()));
            out += std::string(kind, 4) + bytes;
        };
        chunk("JSON", json);
        chunk("BIN\0", buffer_.bytes());
        return out;
    }

    const Run& run_;
    std::vector<std::vector<Drawn>> drawn_;       ///< of the bodies, then of the world
    std::vector<std::array<double, 4>> paints_;   ///< beside those of n_worn() bodies and of the ground
    Tracks tracks_;
    Vector3 up_{0, 0, 1};
    Buffer buffer_;
};

}   // namespace

void write_gltf(const std::filesystem::path& file, const ExportInput& input)
{
    replace_file(file, Scene(input).take());
}

}   // namespace livens::inline io_internal
