// SPDX-License-Identifier: BSD-3-Clause
#include "livens/io/results.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <gtest/gtest.h>

#include "livens/base/error.h"
#include "livens/diagnostics/sample.h"
#include "livens/io/exports.h"
#include "livens/io/json.h"
#include "livens/io/results/figures.h"
#include "livens/spacetime/solve.h"
#include "livens/time/time_mesh.h"
#include "unit/io/sample_run.h"

namespace livens::results_test {
namespace {

// --- what is written is read
// ----------------------------------------------------------------------------------------

TEST_F(Results, RunComesBackToTheBit)
{
    const Model model = sample_model();
    RunFile run = sample_run(model);
    run.motion.redundant_rows = {0};
    write_run(in_folder("run.nc"), model, run);
    const RunFile back = read_run(in_folder("run.nc"));

    EXPECT_EQ(image_of(model, back), image_of(model, run));   // everything that is written
    EXPECT_EQ(back.scenario_text, run.scenario_text);
    EXPECT_EQ(back.meshes, run.meshes);
    EXPECT_EQ(back.body_names, run.body_names);
    EXPECT_EQ(back.body_is_point, run.body_is_point);
    EXPECT_EQ(back.output, run.output);
    EXPECT_EQ(back.motion.mesh.ends, run.motion.mesh.ends);
    EXPECT_EQ(back.motion.X.values, run.motion.X.values);
    EXPECT_EQ(back.motion.X.degree, 2);
    EXPECT_TRUE(back.motion.X.continuous);
    EXPECT_EQ(back.motion.P.values, run.motion.P.values);
    EXPECT_FALSE(back.motion.P.continuous);
    EXPECT_EQ(back.motion.multipliers.values, run.motion.multipliers.values);
    EXPECT_EQ(back.motion.momenta, run.motion.momenta);
    EXPECT_EQ(back.motion.velocities, run.motion.velocities);
    EXPECT_EQ(back.motion.accelerations, run.motion.accelerations);
    EXPECT_EQ(back.motion.end_multipliers, run.motion.end_multipliers);
    EXPECT_EQ(back.motion.load_angles, run.motion.load_angles);
    EXPECT_FALSE(run.motion.load_angles.empty());
    EXPECT_EQ(back.motion.redundant_rows, run.motion.redundant_rows);
    EXPECT_EQ(back.motion.rigidity.values, run.motion.rigidity.values);
    EXPECT_EQ(back.motion.rigidity.degree, 1);
    EXPECT_EQ(back.motion.gauss_points, 3);
    EXPECT_EQ(back.motion.block_ends, run.motion.block_ends);
    EXPECT_EQ(back.growth, run.growth);
    EXPECT_EQ(back.numbers.names, run.numbers.names);
    EXPECT_EQ(back.numbers.values, run.numbers.values);
    EXPECT_EQ(back.numbers.errors, run.numbers.errors);
    EXPECT_EQ(back.verdict.horizon, 2);
    EXPECT_EQ(back.report.factor_entries, 123456789013);
    EXPECT_EQ(back.report.scaled_condition, 2e6);
    EXPECT_EQ(back.verdict.zigzag_momenta, 0.25);
    EXPECT_EQ(back.report.condition_2, 5e8);
    EXPECT_EQ(back.report.status, SolveStatus::not_converged);
    EXPECT_EQ(back.report.newton_iterations, 123456789012);
    EXPECT_EQ(back.report.notes, run.report.notes);
    EXPECT_EQ(back.notes, run.notes);
    EXPECT_TRUE(std::isnan(back.verdict.angular_momentum_drift));
    EXPECT_EQ(back.verdict.balance.largest_moment, run.verdict.balance.largest_moment);
    const ErrorEstimate &e = back.estimate, &written = run.estimate;
    EXPECT_EQ(e.position, written.position);
    EXPECT_EQ(e.orientation, written.orientation);
    EXPECT_EQ(e.velocity, written.velocity);
    EXPECT_EQ(e.reaction, written.reaction);
    EXPECT_EQ(e.n_joints, 1);
    EXPECT_EQ(e.length, 2.5);
    EXPECT_EQ(e.largest, 2e-7);
    EXPECT_EQ(e.time, 4);
    EXPECT_EQ(e.body, 1);
}

TEST_F(Results, EstimatedErrorsStandBesideTheSamples)
{
    const Model model = sample_model();
    RunFile run = sample_run(model);
    run.output = {0.5, 0.75, 4};   // the second is no element end: nothing is known of the polynomial there
    const Image file(image_of(model, run));
    const auto errors = [&](const char* name, const char* over) {
        return file.doubles(name, {"time", over});
    };
    const std::vector<double> position = errors("estimated_position_error", "body");
    const std::vector<double> orientation = errors("estimated_orientation_error", "body");
    const std::vector<double> reaction = errors("estimated_reaction_error", "joint");
    ASSERT_EQ(position.size(), 6u);
    EXPECT_EQ(position[0], run.estimate.position[2]);
    EXPECT_TRUE(std::isnan(position[2]) && std::isnan(position[3]) && std::isnan(reaction[1]));
    EXPECT_EQ(orientation[5], 2e-7);
    EXPECT_EQ(reaction[2], run.estimate.reaction[8]);
    EXPECT_EQ(errors("estimated_velocity_error", "body")[4], run.estimate.velocity[16]);
    EXPECT_EQ(file.text_of("estimated_velocity_error", "units"), "m s-1");

    run.estimate = {};
    const Image without(image_of(model, run));
    EXPECT_EQ(without.reader().variable("estimated_position_error"), nullptr);
    EXPECT_EQ(without.reader().variable("end_reaction_error"), nullptr);
    EXPECT_TRUE(read_run_from(source_of(image_of(model, run))).estimate.empty());
}

TEST_F(Results, SamplesBeyondTheHorizonAreFlagged)
{
    const Model model = sample_model();
    RunFile run = sample_run(model);
    run.output = {0.5, 2, 2.5, 4};
    const auto flags = [](const Image& file) {
        const ClassicVariable* v = file.reader().variable("beyond_horizon");
        return v == nullptr ? std::string("none") : file.reader().bytes(*v);
    };
    EXPECT_EQ(flags(Image(image_of(model, run))), std::string("\0\0\1\1", 4));
    run.verdict.horizon = std::numeric_limits<double>::quiet_NaN();   // after the end
    EXPECT_EQ(flags(Image(image_of(model, run))), std::string(4, '\0'));
    run.growth.pop_back();
    EXPECT_THROW(image_of(model, run), IoError);
    run.growth.clear();
    EXPECT_EQ(flags(Image(image_of(model, run))), "none");
    EXPECT_TRUE(read_run_from(source_of(image_of(model, run))).growth.empty());
}

TEST_F(Results, EveryFigureComesBackAndStandsInJson)
{
    const Model model = sample_model();
    RunFile run = sample_run(model);
    double next = 1000;
    for (const Figure& figure : run_figures()) {
        const std::string name = figure.name;
        // Sizes of what is in the file, and a rule that exists.
        if (name == "n_bodies" || name == "n_rows" || name == "gauss_points") continue;
        ASSERT_TRUE(set_figure(run, figure, ++next)) << name;
    }
    const RunFile back = read_run_from(source_of(image_of(model, run)));
    JsonWriter json;
    json.begin_object();
    write_figures(json, back);
    json.end_object();
    for (const Figure& figure : run_figures()) {
        EXPECT_EQ(figure_of(back, figure), figure_of(run, figure)) << figure.name;
        const std::string member = std::string("\"") + figure.name + "\": " + to_text(figure_of(run, figure));
        EXPECT_NE(json.text().find(member), std::string::npos) << member << " in " << json.text();
    }
}

TEST_F(Results, KeepWhereConstraintsHoldAndRefuseOtherWords)
{
    const Model model = sample_model();
    RunFile run = sample_run(model);
    for (const auto& [where, word] : {std::pair{ConstraintsHold::unknown, ""},
                                      {ConstraintsHold::at_nodes, "element nodes"},
                                      {ConstraintsHold::at_element_ends, "element ends"},
                                      {ConstraintsHold::weakly, "weakly"}}) {
        run.motion.constraints_hold = where;
        const Image file(image_of(model, run));
        EXPECT_EQ(std::get<std::string>(*file.reader().attribute("constraints_hold_at")), word);
        EXPECT_EQ(read_run_from(source_of(image_of(model, run))).motion.constraints_hold, where);
    }
    std::string image = image_of(model, run);
    image.replace(image.find("weakly"), 6, "warmly");
    EXPECT_THROW(read_run_from(source_of(image), false), IoError);
}

TEST_F(Results, EventsAndImpactsComeBack)
{
    const Model model = sample_model();
    const RunFile run = sample_run(model);
    write_run(in_folder("run.nc"), model, run);
    const RunFile back = read_run(in_folder("run.nc"));
    EXPECT_EQ(back.events.names, run.events.names);
    EXPECT_EQ(back.events.times, run.events.times);
    EXPECT_EQ(back.events.errors, run.events.errors);
    EXPECT_EQ(back.events.impulses, run.events.impulses);
    EXPECT_EQ(back.events.speeds, run.events.speeds);
    EXPECT_EQ(back.motion.impacts.ends, run.motion.impacts.ends);
    EXPECT_EQ(back.motion.impacts.velocities, run.motion.impacts.velocities);
    EXPECT_EQ(back.motion.impacts.momenta, run.motion.impacts.momenta);
    EXPECT_EQ(back.motion.at_end(1, Side::left).V, back.motion.impacts.velocities);
    EXPECT_NE(back.motion.at_end(1).V, back.motion.impacts.velocities);
}

struct Anything {
    template <class T>
    operator T() const;
};

/// How many members an aggregate has.
template <class T, class... Given>
constexpr std::size_t n_members()
{
    if constexpr (requires { T{Given{}..., Anything{}}; })
        return n_members<T, Given..., Anything>();
    else
        return sizeof...(Given);
}

/// As many members as the table of figures and the walk of layout.h know: who adds one adds it there.
TEST_F(Results, EveryMemberOfARunIsInTheFile)
{
    static_assert(n_members<PartNames>() == 6);
    static_assert(n_members<RunFile>() == 16);   // one for its base
    [[maybe_unused]] const auto& [e1, e2, e3, e4, e5, e6] = EndValues{};
    [[maybe_unused]] const auto& [d1, d2, d3, d4, d5, d6] = Discretisation{};
    [[maybe_unused]] const auto& [f1, f2, f3, f4, f5, f6] = Field{};
    int report = 0, verdict = 0, balance = 0;
    for (const Figure& figure : run_figures()) {
        report += figure.member.index() < 4;
        verdict += std::holds_alternative<double Verdict::*>(figure.member);
        balance += std::holds_alternative<double BalanceFigures::*>(figure.member);
    }
    const std::size_t lists = 2 * sizeof(std::vector<int>);
    EXPECT_EQ(sizeof(Motion), sizeof(EndValues) + sizeof(Discretisation) + sizeof(TimeMesh) +
                                  4 * sizeof(Field) + lists / 2 + 2 * sizeof(int));
    // Seven values are there for the relative drifts alone, which are figures of the verdict.
    EXPECT_EQ(sizeof(BalanceFigures), static_cast<std::size_t>(balance + 7) * 8);
    EXPECT_EQ(sizeof(Balance), 12 * sizeof(std::vector<int>) + sizeof(BalanceFigures));
    const std::size_t series = sizeof(std::shared_ptr<const Balance>);   // in the file as what it is of
    EXPECT_EQ(sizeof(Verdict), lists + series + static_cast<std::size_t>(verdict) * 8 +
                                   sizeof(BalanceFigures) + sizeof(ViolationReport));
    // Not where ends were moved, nor a steep law; of the report itself when it failed, and the accuracy. Its
    // status, message, iterations, notes and why a second solution failed are no figures.
    EXPECT_EQ(static_cast<std::size_t>(report),
              n_members<SolveCounters>() + n_members<MeshChanges>() - 3 + n_members<Conditioning>() + 2);
}

TEST_F(Results, NurbsWithoutJointsAreWritten)
{
    Model model;
    model.add_body(rigid_body("box", box(1, {1, 2, 3})));
    Mixed method;
    method.basis = Mixed::Basis::nurbs;
    method.weights = {1, 1.1, 1.2, 1, 1, 1};
    const RunFile run =
        make_run(model, solve(model, {model.start()}, make_time_mesh(0, 1, 4), method), method);
    write_run(in_folder("run.nc"), model, run);
    EXPECT_EQ(image_of(model, read_run(in_folder("run.nc"))), image_of(model, run));
}

TEST_F(Results, DenominatorsComeBackAndBendTheSamples)
{
    const Model model = sample_model();
    RunFile run = sample_run(model, 2);
    run.motion.X.denominators = {1, 0.5, 2, 1, 1};
    run.motion.P.denominators = {1, 3, 1, 1};
    run.motion.multipliers.denominators = {2, 2};
    run.motion.rigidity.denominators = {1, 2, 3, 4};
    write_run(in_folder("run.nc"), model, run);
    const RunFile back = read_run(in_folder("run.nc"));
    EXPECT_EQ(image_of(model, back), image_of(model, run));
    EXPECT_EQ(back.motion.X.denominators, run.motion.X.denominators);
    EXPECT_EQ(back.motion.rigidity.denominators, run.motion.rigidity.denominators);
    // Halfway through the first element the middle node's weight of 1/2 and the end's of 2 do not matter, as
    // Lagrange polynomials are one or zero there; elsewhere they do.
    EXPECT_NEAR(sample_bodies(model, back.motion, 0.25)[0].position[0], 0.75, 1e-15);
    const double s = 0.25, M[] = {(1 - s) * (1 - 2 * s), 4 * s * (1 - s), s * (2 * s - 1)};
    const double top = M[1] * 0.5 * 0.75 + M[2] * 2 * 1.5, bottom = M[0] + M[1] * 0.5 + M[2] * 2;
    EXPECT_NEAR(sample_bodies(model, back.motion, 0.125)[0].position[0], top / bottom, 1e-14);
}

TEST_F(Results, MotionsOnRadauPointsComeBackAndAreSampledAsTheyAre)
{
    Model model({0, 0, -9.81});
    model.add_body(point_mass("bob", 2, {1, 0, 0}));
    model.add_joint(rod("rod", world, 0, {}, 1));
    const Method method = Radau{3};
    const RunFile run =
        make_run(model, solve(model, {model.start()}, make_time_mesh(0, 1, 8), method), method);
    EXPECT_EQ(run.method, "radau(3)");
    EXPECT_EQ(run.motion.order_at_ends, 5);
    write_run(in_folder("run.nc"), model, run);
    const RunFile back = read_run(in_folder("run.nc"));
    EXPECT_EQ(back.motion.X.points, Points::radau);
    EXPECT_EQ(back.motion.multipliers.points, Points::radau);
    EXPECT_EQ(image_of(model, back), image_of(model, run));
    for (const double t : {0.01, 0.2, 0.77}) EXPECT_EQ(back.motion.at(t).X[0], run.motion.at(t).X[0]);
    const std::vector<double> times = node_times(back.motion.X, back.motion.mesh);
    EXPECT_NEAR(times[1], (4 - std::sqrt(6.0)) / 80, 1e-16);
    // the rod is as long at the nodes as it should be, and would not be if they were others
    EXPECT_LE(violations(model, back.motion, 0).joints_at_nodes, 1e-14);
    EXPECT_NEAR(norm(back.motion.at(times[1]).X[0].column(0)), 1, 1e-14);
    Motion other = back.motion;
    other.X.points = Points::lobatto;
    EXPECT_GT(std::abs(norm(other.at(times[1]).X[0].column(0)) - 1), 1e-6);
}

TEST_F(Results, MotionsThatJumpBetweenBlocksComeBack)
{
    const Model model = sample_model();
    RunFile run = sample_run(model, 2);
    Field& X = run.motion.X;
    X.continuous = false;
    // The end of the first element, once more, a little beside.
    const std::vector<double> end(X.values.begin() + 48, X.values.begin() + 72);
    X.values.insert(X.values.begin() + 72, end.begin(), end.end());
    X.values[72] += 0.01;
    write_run(in_folder("run.nc"), model, run);
    const RunFile back = read_run(in_folder("run.nc"));
    EXPECT_EQ(image_of(model, back), image_of(model, run));
    EXPECT_EQ(back.motion.X.values, X.values);
    const Image file(bytes_of(in_folder("run.nc")));
    EXPECT_EQ(file.doubles("X_node", {"X_node"}), (std::vector<double>{0, 0.25, 0.5, 0.5, 0.75, 1}));
    EXPECT_EQ(file.doubles("joint_violation", {"X_node"}).size(), 6u);
    EXPECT_EQ(file.doubles("action_integral", {"element"}).size(), 2u);
}

TEST_F(Results, SameRunGivesSameBytes)
{
    const Model model = sample_model();
    const RunFile run = sample_run(model);
    write_run(in_folder("first.nc"), model, run);
    write_run(in_folder("second.nc"), model, run);
    EXPECT_EQ(bytes_of(in_folder("first.nc")), bytes_of(in_folder("second.nc")));
    EXPECT_EQ(n_files(), 2);
}

TEST_F(Results, LongTextsAndManyNamesComeBack)
{
    const Model model = sample_model();
    RunFile run = sample_run(model);
    run.title = std::string(100'000, 'x');
    run.method = std::string(16u << 10, 'y');
    run.report.message = std::string("a\0b", 3);
    run.scenario_text = std::string(3'000'000, '#');
    run.notes.assign(3000, "note");
    write_run(in_folder("run.nc"), model, run);
    EXPECT_EQ(image_of(model, read_run(in_folder("run.nc"))), image_of(model, run));
}

TEST_F(Results, EmptyPartsComeBack)
{
    Model model;
    model.add_body(point_mass("bob", 1, {0, 0, 0}));
    RunFile run;
    run.body_names = {"bob"};
    run.body_is_point = {true};
    run.centers_of_mass = {{0, 0, 0}};
    run.motion.n_bodies = 1;
    run.motion.mesh.ends = {0};   // nothing was solved: the start alone
    run.motion.X = {12, 4, true, std::vector<double>(12, 0.5), {}};
    run.motion.momenta = run.motion.velocities = {Matrix34{1, 2, 3}};
    run.output = {0, 1};
    write_run(in_folder("run.nc"), model, run);
    const RunFile back = read_run(in_folder("run.nc"));
    EXPECT_EQ(image_of(model, back), image_of(model, run));
    EXPECT_EQ(sample_bodies(model, back.motion, 0).front().velocity, (Vector3{1, 2, 3}));
    write_csv(in_folder("run.csv"), model, back);
}

// --- every reader finds its way
// -------------------------------------------------------------------------------------

TEST_F(Results, FileSaysWhatItHolds)
{
    const Model model = sample_model();
    const RunFile run = sample_run(model);
    const Image file(image_of(model, run));
    const std::string manual = bytes_of(fs::path(LIVENS_SOURCE_DIR) / "docs/results.md");
    for (const ClassicVariable& v : file.reader().variables()) {
        EXPECT_NE(manual.find("`" + v.name + "`"), std::string::npos)
            << v.name << " is missing in docs/results.md";
        for (const char* attribute : {"units", "long_name", "frame", "checksum"})
            EXPECT_FALSE(file.text_of(v.name, attribute).empty()) << v.name << ": " << attribute;
    }
    for (const Attribute& attribute : file.reader().attributes())
        EXPECT_NE(manual.find("`" + attribute.name + "`"), std::string::npos)
            << attribute.name << " is missing in docs/results.md";
    for (const Figure& figure : run_figures()) {
        const std::string row =
            std::string("| `") + figure.name + "` | " + figure.unit + " | " + figure.meaning;
        EXPECT_NE(manual.find(row + " |\n"), std::string::npos) << "missing in docs/results.md: " << row;
    }
    for (const ExportFormat& f : export_formats()) {
        const std::string row = std::string("| `--") + f.word + "` | `" + f.extension + "` | " + f.what;
        EXPECT_NE(manual.find(row + " |\n"), std::string::npos) << "missing in docs/results.md: " << row;
    }
    EXPECT_EQ(file.text_of("quaternion", "order"), "w, x, y, z");
    EXPECT_EQ(file.reader().number("livens_format"), 2);
    EXPECT_EQ(file.reader().number("converged"), 0);
    EXPECT_EQ(*file.reader().attribute("title"), AttributeValue("Größe"));
}

TEST_F(Results, TheHeadIsReadWithoutTheMotion)
{
    const Model model = sample_model();
    const RunFile run = sample_run(model, 1000);
    write_run(in_folder("run.nc"), model, run);
    std::string image = bytes_of(in_folder("run.nc"));
    const Image file(image);
    const std::size_t X = file.reader().variable("X")->begin;
    image[X + 8] = static_cast<char>(image[X + 8] ^ 1);
    put_bytes(in_folder("damaged.nc"), image);
    EXPECT_NE(error_of_reading(in_folder("damaged.nc")).find("'X'"), std::string::npos);
    const RunHead head = read_run_head(in_folder("damaged.nc"));
    EXPECT_EQ(head.run.body_names, run.body_names);
    EXPECT_EQ(head.run.notes, run.notes);
    EXPECT_EQ(head.run.resolved, run.resolved);
    EXPECT_EQ(head.run.report.n_elements, 1000);
    EXPECT_EQ(head.end, 500);
    EXPECT_EQ(head.n_output_times, 1001);
    EXPECT_TRUE(head.run.motion.X.empty());
}

TEST_F(Results, SamplesHoldPosesAndReactions)
{
    const Model model = sample_model();
    const RunFile run = sample_run(model);
    const Image file(image_of(model, run));
    const std::vector<double> t = file.doubles("time", {"time"});
    const std::vector<double> p = file.doubles("position", {"time", "body", "xyz"});
    const std::vector<double> c = file.doubles("center_of_mass", {"time", "body", "xyz"});
    const std::vector<double> d = file.doubles("directors", {"time", "body", "director", "xyz"});
    const std::vector<double> q = file.doubles("quaternion", {"time", "body", "quaternion_part"});
    const std::vector<double> w = file.doubles("angular_velocity_body", {"time", "body", "xyz"});
    const std::vector<double> f = file.doubles("reaction_force", {"time", "joint", "side", "xyz"});
    ASSERT_EQ(t, run.output);
    for (std::size_t i = 0; i < t.size(); ++i) {
        const double angle = 2 * t[i];
        EXPECT_NEAR(p[6 * i], 3 * t[i], 1e-14);
        EXPECT_NEAR(c[6 * i], 3 * t[i] - 0.5 * std::sin(angle), 1e-14);
        EXPECT_NEAR(c[6 * i + 1], 0.5 * std::cos(angle), 1e-14);
        EXPECT_NEAR(d[18 * i], std::cos(angle), 1e-14);   // d1
        EXPECT_NEAR(d[18 * i + 1], std::sin(angle), 1e-14);
        EXPECT_NEAR(d[18 * i + 3], -std::sin(angle), 1e-14);   // d2
        EXPECT_NEAR(q[8 * i], std::cos(angle / 2), 1e-14);     // w; its sign follows the motion through w = 0
        EXPECT_NEAR(q[8 * i + 3], std::sin(angle / 2), 1e-14);
        EXPECT_TRUE(std::isnan(d[18 * i + 9]) && std::isnan(q[8 * i + 4]))
            << "a point mass has no orientation";
        EXPECT_NEAR(w[6 * i + 2], 2, 1e-14);
        EXPECT_NEAR(f[6 * i + 2], -2 * 5, 1e-13);   // -lambda (x_bob - x_body) from the left
        EXPECT_NEAR(f[6 * i + 5], -2 * 7, 1e-13);   // and from the right
    }
}

TEST_F(Results, IntegralsOverElementsAreThoseOfTheDiagnostics)
{
    const Model model = sample_model();
    const RunFile run = sample_run(model);
    const Image file(image_of(model, run));
    const ActionSeries series = action(model, run.motion);
    EXPECT_EQ(file.doubles("action_integral", {"element"}), series.lagrangian);
    EXPECT_EQ(file.doubles("hamiltonian_integral", {"element"}), series.hamiltonian);
    const std::vector<double> moments = file.doubles("angular_momentum_integral", {"element", "xyz"});
    ASSERT_EQ(moments.size(), 24u);
    for (int e = 0; e < 8; ++e)
        for (int i = 0; i < 3; ++i)
            EXPECT_EQ(moments[static_cast<std::size_t>(3 * e + i)], series.angular_momentum[e][i]);
}

TEST_F(Results, SamplesInsideElementsComeFromThePolynomial)
{
    const Model model = sample_model();
    const RunFile run = sample_run(model);
    const double t = 0.5 + 0.1;
    const std::vector<BodySample> samples = sample_bodies(model, run.motion, t);
    EXPECT_NEAR(samples[0].position[0], 3 * t, 1e-14);
    EXPECT_NEAR(samples[0].velocity[0], 3, 1e-13);
    EXPECT_NEAR(samples[0].angular_velocity[2], 2, 0.1);
    EXPECT_GT(std::abs(norm(samples[0].directors_raw.column(0)) - 1),
              1e-6);   // the violation is there to be seen
    EXPECT_NEAR(norm(samples[0].directors.column(0)), 1, 1e-15);
    EXPECT_NEAR(determinant(samples[0].directors), 1, 1e-15);
    // Reactions follow from the equations of motion, unless the motion holds nothing of the kind at ends.
    EXPECT_TRUE(sample_joints(model, run.motion, t)[0].is_acceleration_level);
    Motion bare = run.motion;
    bare.accelerations.clear();
    const std::vector<JointSample> joints = sample_joints(model, bare, t);
    EXPECT_FALSE(joints[0].is_acceleration_level);
    EXPECT_NEAR(joints[0].left.force[2], -2 * 7, 1e-13);   // element 1 holds 7
}

TEST_F(Results, SamplingSnapsToElementEnds)
{
    const Model model = sample_model();
    const RunFile run = sample_run(model);
    const double beside = std::nextafter(0.5, 1.0);
    EXPECT_EQ(snap_to_element_end(run.motion.mesh, beside), 0.5);
    EXPECT_EQ(snap_to_element_end(run.motion.mesh, 0.5 + 1e-12), 0.5 + 1e-12);
    EXPECT_EQ(snap_to_element_end(run.motion.mesh, std::nextafter(4.0, 5.0)), 4.0);
    EXPECT_TRUE(sample_joints(model, run.motion, beside)[0].is_acceleration_level);
    for (const double t :
         {-0.1, 4.1, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
        EXPECT_THROW(sample_bodies(model, run.motion, t), InputError) << t;
}

TEST_F(Results, OutputBeyondTheMotionIsLeftOut)
{
    const Model model = sample_model();
    RunFile run = sample_run(model);
    run.output = {0, 1, 2, 77};
    const std::string image = image_of(model, run);
    EXPECT_EQ(Image(image).doubles("time", {"time"}), (std::vector<double>{0, 1, 2}));
    EXPECT_EQ(read_run_from(source_of(image)).output, run.output);
}

TEST_F(Results, CsvHasOneLinePerTime)
{
    const Model model = sample_model();
    RunFile run = sample_run(model);
    run.body_names[1] = "bob";
    write_csv(in_folder("run.csv"), model, run);
    const std::string text = bytes_of(in_folder("run.csv"));
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 10);
    EXPECT_EQ(text.substr(0, 7), "t [s],k");
    const std::string line =
        text.substr(text.find("\r\n") + 2, text.find("\r\n", text.find("\r\n") + 2) - text.find("\r\n") - 2);
    EXPECT_EQ(std::count(line.begin(), line.end(), ','), 2 * 19 + 3 + 6);   // bodies, energies, a joint
    EXPECT_EQ(line.substr(0, 25), "0,0,0,0,1,0,0,0,3,0,0,0,0");
}

// --- a run is made of a solution

/// A pendulum of length 2: a box on a rod, let go 1 rad from straight down.
Model pendulum()
{
    Model model({0, 0, -9.81});
    Placement placement;
    placement.position = {2 * std::sin(1.0), 0, -2 * std::cos(1.0)};
    model.add_body(rigid_body("bob", box(1000, {0.1, 0.2, 0.3}), placement));
    model.add_joint(rod("rod", world, 0, {}, 2));
    return model;
}

TEST_F(Results, RunHasTheNamesAndTheVerdictOfTheSolution)
{
    const Model model = pendulum();
    const Solution solution = solve(model, {model.start()}, make_time_mesh(0, 1, 10), Lobatto{4});
    const RunFile run = make_run(model, solution, Lobatto{4});
    EXPECT_EQ(run.report.status, SolveStatus::converged);
    EXPECT_EQ(run.method, "lobatto(4)");
    EXPECT_LT(run.verdict.energy_drift, 1e-6);
    EXPECT_EQ(run.body_names, std::vector<std::string>{"bob"});
    EXPECT_EQ(run.row_labels, std::vector<std::string>{"rod: distance"});
    EXPECT_EQ(run.output.size(), 11u);
}

TEST_F(Results, SuspectRunsComeBackSuspectWithTheirReason)
{
    const Model model = pendulum();
    const Solution solution = solve(model, {model.start()}, make_time_mesh(0, 2, 20), Endpoint{});
    RunFile run = make_run(model, solution, Endpoint{});
    run.output = {0, 2};
    write_run(in_folder("run.nc"), model, run);
    const RunFile back = read_run(in_folder("run.nc"));
    EXPECT_EQ(back.report.status, SolveStatus::suspect);
    EXPECT_TRUE(back.report.reached_end());
    EXPECT_NE(back.report.message.find("estimated error"), std::string::npos) << back.report.message;
    EXPECT_EQ(back.notes, run.notes);
    EXPECT_EQ(std::ranges::count(back.notes, back.report.message), 1);
}

TEST_F(Results, SeriesAreThoseOfTheMotion)
{
    const Model model = pendulum();
    RunFile run =
        make_run(model, solve(model, {model.start()}, make_time_mesh(0, 1, 5000), Lobatto{2}), Lobatto{2});
    run.motion.X.values[12 * 3] += 0.125;
    const Image file(image_of(model, run));
    const NodeViolations off = node_violations(model, run.motion);
    EXPECT_GT(off.joints[3], 0.01);
    EXPECT_EQ(file.doubles("joint_violation", {"X_node"}), off.joints);
    EXPECT_EQ(file.doubles("rigidity_violation", {"X_node"}), off.rigidity);
    const Balance whole = balance(model, run.motion);   // the file's is made in pieces, more than one here
    EXPECT_EQ(file.doubles("energy_error", {"element_end"}), whole.energy_drift);
    EXPECT_EQ(file.doubles("work", {"element_end"}), whole.work);
    EXPECT_EQ(file.doubles("balance_time", {"element_end"}), run.motion.mesh.ends);
    const std::span<const double> impulse = numbers(whole.linear_impulse);
    EXPECT_EQ(file.doubles("linear_impulse", {"element_end", "xyz"}),
              std::vector<double>(impulse.begin(), impulse.end()));
}

TEST_F(Results, RunsOfWhichNothingWasSolvedHoldTheirStart)
{
    const Model model = pendulum();
    SolveOptions hopeless;
    hopeless.max_iterations = 1;
    const Solution nothing = solve(model, {model.start()}, make_time_mesh(0, 20, 3), Mixed{}, hopeless);
    ASSERT_EQ(nothing.motion.n_elements(), 0);
    const RunFile run = make_run(model, nothing, Mixed{});
    EXPECT_EQ(run.report.status, SolveStatus::not_converged);
    EXPECT_TRUE(std::isnan(run.verdict.zigzag_momenta));
    write_run(in_folder("run.nc"), model, run);
    const RunFile back = read_run(in_folder("run.nc"));
    EXPECT_EQ(sample_bodies(model, back.motion, 0).front().position, model.bodies()[0].X.column(0));
}

}   // namespace
}   // namespace livens::results_test
