// SPDX-License-Identifier: BSD-3-Clause
// A run made by hand that fills every part of a result file, and a folder to put it in.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "livens/io/results.h"
#include "livens/io/results/layout.h"
#include "livens/multibody/model.h"

namespace livens {

namespace fs = std::filesystem;
using RunFile = Run;   // testing::Test has a Run of its own

/// A folder of its own, empty at the end.
class Results : public testing::Test {
protected:
    Results()
    {
        std::string pattern = (fs::temp_directory_path() / "livens-results-XXXXXX").string();
        folder_ = ::mkdtemp(pattern.data());
    }
    ~Results() override { fs::remove_all(folder_); }

    fs::path in_folder(const std::string& name) const { return folder_ / name; }
    int n_files() const { return static_cast<int>(std::distance(fs::directory_iterator(folder_), {})); }

    fs::path folder_;
};

inline std::string bytes_of(const fs::path& file)
{
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

inline void put_bytes(const fs::path& file, const std::string& bytes)
{
    std::ofstream(file, std::ios::binary) << bytes;
}

inline std::string error_of_reading(const fs::path& file)
{
    try {
        read_run(file);
    } catch (const IoError& error) {
        return error.code() + ": " + error.what();
    }
    return "";
}

/// A sink into `image`, which must live as long.
inline ByteSink into(std::string& image)
{
    return [&image](std::uint64_t offset, std::string_view bytes) {
        image.resize(std::max<std::size_t>(image.size(), offset + bytes.size()));
        bytes.copy(image.data() + offset, bytes.size());
    };
}

/// The bytes of the file.
inline std::string image_of(const Model& model, const RunFile& run,
                            std::uint64_t largest = ClassicWriter::largest_in_cdf2)
{
    std::string image;
    write_run_to(into(image), model, run, largest);
    return image;
}

inline ByteSource source_of(const std::string& image)
{
    return {image.size(), [&image](std::uint64_t offset, std::span<char> out) {
                ASSERT_LE(offset + out.size(), image.size()) << "read beyond the end";
                image.copy(out.data(), out.size(), offset);
            }};
}

/// A file in memory, as other readers see it.
class Image {
public:
    explicit Image(std::string bytes) : bytes_(std::move(bytes)), reader_(source_of(bytes_)) {}

    const ClassicReader& reader() const { return reader_; }
    std::vector<double> doubles(const std::string& name, const std::vector<std::string>& dimensions) const
    {
        const ClassicVariable* v = reader_.variable(name);
        if (v == nullptr || v->dimensions != dimensions || v->type != NumberType::real) {
            ADD_FAILURE() << name << " is missing or of another shape";
            return {};
        }
        std::vector<double> values(v->n_values);
        reader_.read(*v, values);
        return values;
    }
    std::string text_of(const std::string& variable, const std::string& attribute) const
    {
        const AttributeValue* value = find_attribute(reader_.variable(variable)->attributes, attribute);
        return value == nullptr ? "" : std::get<std::string>(*value);
    }

private:
    std::string bytes_;
    ClassicReader reader_;
};

/// A rigid body that turns about z with angular velocity 2 and moves along x with velocity 3, and a point
/// mass above it, held by a rod whose multiplier is 5 before and 7 after each instant.
inline Model sample_model()
{
    Model model({0, 0, -9.81});
    Placement placement;
    placement.velocity = {3, 0, 0};
    placement.angular_velocity = {0, 0, 2};
    model.add_body(rigid_body("körper eins", with_center(box(2.0, {1, 2, 3}), {0, 0.5, 0}), placement));
    model.add_body(point_mass("bob", 0.25, {0, 0, 2}, {3, 0, 0}));
    model.add_joint(rod("rod", 0, 1, {{0, 0, 0}, {0, 0, 0}, {0, 0, 1}, {0, 0, 1}}, 2));
    Load counter;   // of no force, which counts the two angles that the motion has
    counter.name = "counter";
    counter.bodies = {0, world};
    const JointCoordinate turn = angle_between(world, {0, 1, 0, 0}, {0, 0, 1, 0}, 0, {0, 1, 0, 0});
    counter.angles = {turn, turn};
    counter.forces = [](const LoadArguments&, LoadForces&) {};
    model.add_load(counter);
    return model;
}

inline Matrix34 turned(double t)
{
    const double c = std::cos(2 * t), s = std::sin(2 * t);
    return {3 * t, 0, 0, c, s, 0, -s, c, 0, 0, 0, 1};
}

inline Matrix34 turned_rate(double t)
{
    const double c = 2 * std::cos(2 * t), s = 2 * std::sin(2 * t);
    return {3, 0, 0, -s, c, 0, -c, -s, 0, 0, 0, 0};
}

inline void push(std::vector<double>& out, const Matrix34& m) { out.insert(out.end(), m.a, m.a + 12); }

inline void fill_motion(Motion& m, const Model& model, int n_elements)
{
    m.n_bodies = 2;
    m.n_rows = 1;
    for (int e = 0; e <= n_elements; ++e) m.mesh.ends.push_back(0.5 * e);
    m.X = {24, 2, true, {}, {}};
    m.P = {24, 1, false, {}, {}};
    m.multipliers = {1, 0, false, {}, {}};
    const auto momentum = [&](double t, int b) {
        const Matrix34 V = b == 0 ? turned_rate(t) : Matrix34{3, 0, 0};
        return V * model.bodies()[b].mass;
    };
    for (int node = 0; node <= 2 * n_elements; ++node) {
        push(m.X.values, turned(0.25 * node));
        push(m.X.values, {3 * 0.25 * node, 0, 2});
    }
    for (int e = 0; e < n_elements; ++e) {
        for (const double t : {0.5 * e, 0.5 * e + 0.5})
            for (int b = 0; b < 2; ++b) push(m.P.values, momentum(t, b));
        m.multipliers.values.push_back(6 + e);
    }
    for (const double t : m.mesh.ends)
        for (int b = 0; b < 2; ++b) {
            m.momenta.push_back(momentum(t, b));
            m.velocities.push_back(b == 0 ? turned_rate(t) : Matrix34{3, 0, 0});
        }
    for (int i = 0; i < 4 * (n_elements + 1); ++i) m.accelerations.push_back({0.1 * i, 1, 2, 3});
    for (int i = 0; i <= n_elements; ++i) m.load_angles.insert(m.load_angles.end(), {0.5 * i, 7.0 * i});
    for (int i = 0; i <= n_elements; ++i) m.end_multipliers.insert(m.end_multipliers.end(), {5, 7});
    m.order_at_ends = 4;
    m.dense_order_X = 3;
    m.dense_order_V = 2;
    m.constraints_hold = ConstraintsHold::at_nodes;
    m.rigidity = {12, 1, false, {}, {}};
    for (int i = 0; i < 24 * n_elements; ++i) m.rigidity.values.push_back(0.5 * i);
    m.gauss_points = 3;
    if (n_elements > 1) m.impacts.ends = {1};
    for (int b = 0; n_elements > 1 && b < 2; ++b) {
        m.impacts.momenta.push_back(momentum(0.25, b));
        m.impacts.velocities.push_back(Matrix34{1, 2, 3});
    }
    for (int e = 0; e <= n_elements; e += 2) m.block_ends.push_back(e);
}

inline RunFile sample_run(const Model& model, int n_elements = 8)
{
    RunFile run;
    run.scenario_text = "format = 1\ntitle = \"Größe\"\n";
    run.meshes = "mesh 0 1 0 0 0 1 1 1 0 0 0 a.stl\n";
    run.title = "Größe";
    run.resolved = R"({"method": {"family": "lobatto", "degree": 2}})";
    run.body_names = {"körper eins", "bob"};
    run.body_is_point = {false, true};
    run.centers_of_mass = {{0, 0.5, 0}, {0, 0, 0}};
    run.joint_names = {"rod"};
    run.row_labels = {"rod: distance"};
    for (int i = 0; i <= n_elements; ++i) run.output.push_back(0.5 * i);
    fill_motion(run.motion, model, n_elements);
    run.report.status = SolveStatus::not_converged;
    run.report.message = "element 9 at 4 s: joint 'rod'";
    run.report.n_elements = n_elements;
    run.report.unknowns = 14;
    run.report.newton_iterations = 123456789012;
    run.report.most_iterations = 9;
    run.report.factorisations = 8;
    run.report.residual_norm = 1e-13;
    run.report.smallest_pivot = 0.25;
    run.report.failed_at = 4;
    run.report.iterations = std::vector<int>(static_cast<std::size_t>(n_elements), 3);
    run.report.notes = {"", "row 'distance' is implied"};
    run.report.condition_1 = 1e9;
    run.report.condition_2 = 5e8;
    run.report.scaled_condition = 2e6;
    run.report.factor_entries = 123456789013;
    run.method = "lobatto(2)";
    run.notes = {"first", "second\nline"};
    Verdict& v = run.verdict;
    v.max_constraint_violation = 2e-16;
    v.max_velocity_violation = 3e-15;
    v.energy_drift = 1e-9;
    v.angular_momentum_drift = std::numeric_limits<double>::quiet_NaN();
    v.max_weak_violation = 1e-5;
    v.zigzag_positions = 0.125;
    v.zigzag_momenta = 0.25;
    v.zigzag_time = 1.5;
    v.velocity_jump = 0.0625;
    v.velocity_jump_time = 3.5;
    v.linear_momentum_drift = 1e-11;
    v.balance.largest_kinetic = 12.5;
    v.balance.largest_moment = std::numeric_limits<double>::denorm_min();
    v.growth = 1e12;
    v.horizon = 2;
    run.events = {{"latch.until", "top"}, {0.25, 0.5}, {3e-12, 0}, {0, 2}, {0, 3}, {std::nan(""), 0.5}};
    run.numbers = {{"friction.damping", "time.end"}, {0.25, 1.5}, {3e-12, 1e-15}};
    for (int i = 0; i <= n_elements; ++i) run.growth.push_back(std::pow(1e12, i / double(n_elements)));
    ErrorEstimate& e = run.estimate;
    e.n_bodies = 2;
    e.n_joints = 1;
    for (int i = 0; i <= n_elements; ++i) {
        for (auto* errors : {&e.position, &e.orientation, &e.velocity})
            errors->insert(errors->end(), {1e-9 * i, 1e-8 / (i + 1)});
        e.reaction.push_back(1e-6 * i);
    }
    e.orientation.back() = 2e-7;
    e.length = 2.5;
    e.largest_reaction = 14;
    e.find_largest(run.motion.mesh);
    run.version = "0.1.0";
    return run;
}

}   // namespace livens
