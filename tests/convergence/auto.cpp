// SPDX-License-Identifier: BSD-3-Clause
// The family that is taken for an accuracy, and what radau takes from vibrations that it does not resolve.
#include "convergence/studies.h"
#include "livens/base/error.h"

namespace livens::tests {
namespace {

/// 1 kg on a spring of 1 m with stiffness k and damping c, released at 0.5 rad, stretched, in the field of
/// weight.
Model elastic_pendulum(double k, double c, double stretch = 0)
{
    Model model({0, 0, -9.81});
    const double r = 1 + stretch;
    model.add_body(point_mass("bob", 1, {r * std::sin(0.5), 0, -r * std::cos(0.5)}));
    model.add_load(spring_damper("strut", world, {}, 0, {}, {k, c, 1}));
    return model;
}

/// 1 kg with 1 m/s on a damper that takes it within 1 us.
void add_slug(Model& model)
{
    const int slug = model.add_body(point_mass("slug", 1, {1, 0, 0}, {1, 0, 0}));
    model.add_load(spring_damper("damper", world, {}, slug, {}, {0, 1e6, 1}));
}

Model slug()
{
    Model model;
    add_slug(model);
    return model;
}

Solution to_accuracy(const Model& model, double end, double accuracy, const Method& method = Auto{})
{
    return solve(model, {model.start()}, Span{0, end, accuracy}, method);
}

bool is_radau(const Solution& s) { return std::holds_alternative<Radau>(s.method); }

double gap(const State& a, const State& b) { return norm(a.X[0].column(0) - b.X[0].column(0)); }

TEST(Auto, StopsAMassByAStrongDamperWithoutBeingTold)
{
    const Solution s = to_accuracy(slug(), 1, 1e-6);
    ASSERT_TRUE(s.report.converged()) << s.report.message;
    ASSERT_TRUE(is_radau(s));
    EXPECT_LT(std::abs(s.motion.at(1).V[0](0, 0)), 1e-9);   // exp(-1e6)
    EXPECT_NEAR(s.motion.at(1).X[0](0, 0), 1 + 1e-6, 1e-9);
    const auto names = [](const std::string& note) {
        return note.find("radau") != note.npos && note.find("'slug'") != note.npos &&
               note.find("'damper'") != note.npos;
    };
    EXPECT_TRUE(std::ranges::any_of(s.report.notes, names));
    // Lobatto rings there, and is not called converged.
    const Solution rings = to_accuracy(slug(), 1, 1e-6, Lobatto{0});
    EXPECT_FALSE(rings.report.converged());
    EXPECT_GT(std::abs(rings.motion.at(1).V[0](0, 0)), 1e-9);
}

TEST(Auto, TakesRadauForDecaysAndLobattoForVibrationsThatMatter)
{
    for (const auto& [k, zeta, wants_radau] : {std::tuple{1e4, 0.0, false},
                                               {1e6, 0.0, false},
                                               {1e4, 1.0, true},
                                               {1e6, 1.0, true},
                                               {1e8, 20.0, true}}) {
        const Model model = elastic_pendulum(k, 2 * std::sqrt(k) * zeta);
        const Solution s = to_accuracy(model, 0.5, 1e-6);
        ASSERT_TRUE(s.report.converged()) << k << ' ' << zeta << ' ' << s.report.message;
        EXPECT_EQ(is_radau(s), wants_radau) << k << ' ' << zeta;
        const Method fine_method = wants_radau ? Method(Radau{8}) : Method(Lobatto{12});
        const Solution fine = to_accuracy(model, 0.5, 1e-9, fine_method);
        ASSERT_TRUE(fine.report.converged()) << fine.report.message;
        EXPECT_LE(gap(s.motion.at(0.5), fine.motion.at(0.5)), 1e-6) << k << ' ' << zeta;
    }
}

TEST(Auto, TakesRadauWhereLobattoDoesNotFollowAVibrationThatDoesNotMatter)
{
    const Model model = elastic_pendulum(3e10, 0, 1e-7);
    const Solution s = to_accuracy(model, 5, 1e-4);
    ASSERT_TRUE(s.report.converged()) << s.report.message;
    EXPECT_TRUE(is_radau(s));
    const auto names = [](const std::string& note) { return note.find("vibrates") != note.npos; };
    EXPECT_TRUE(std::ranges::any_of(s.report.notes, names));
}

/// A vibration of 1e-6 m at 1e4 rad/s, of which elements of 25 ms see nothing.
TEST(RadauEstimate, TellsVibrationsThatEveryDegreeDamps)
{
    const Model model = elastic_pendulum(1e8, 0, 1e-6);
    const double end = 0.1;
    const auto radau = [&](int degree) {
        return solve(model, {model.start()}, make_time_mesh(0, end, 8), Radau{degree});
    };
    const Solution s = radau(5), next = radau(6);
    const Solution fine = solve(model, {model.start()}, make_time_mesh(0, end, 2000), Lobatto{8});
    ASSERT_TRUE(s.report.converged() && fine.report.converged());
    double off = 0, apart = 0;
    for (int e = 0; e <= 8; ++e) {
        const double t = s.motion.mesh.ends[e];
        off = std::max(off, gap(s.motion.at(t), fine.motion.at(t)));
        apart = std::max(apart, gap(s.motion.at(t), next.motion.at(t)));
    }
    EXPECT_GT(off, 2e-7);
    EXPECT_LT(apart, 0.1 * off) << "the next degree alone would tell";
    EXPECT_GE(s.estimate.largest, off);
    EXPECT_LE(s.estimate.largest, 5 * off);
}

/// Damping is that of each form by itself: what dies fast beside the bob says nothing of the bob.
TEST(RadauEstimate, TellsAVibrationBesideAStrongDamper)
{
    Model model = elastic_pendulum(1e8, 0, 1e-6);
    add_slug(model);
    const Model alone = elastic_pendulum(1e8, 0, 1e-6);
    const auto mesh = make_time_mesh(0, 0.1, 8);
    const Solution s = solve(model, {model.start()}, mesh, Radau{5});
    const Solution fine = solve(alone, {alone.start()}, make_time_mesh(0, 0.1, 2000), Lobatto{8});
    ASSERT_TRUE(s.report.converged() && fine.report.converged());
    double off = 0;
    for (const double t : mesh.ends) off = std::max(off, gap(s.motion.at(t), fine.motion.at(t)));
    EXPECT_GT(off, 2e-7);
    const std::vector<double>& told = s.estimate.position;   // of bob and slug by turns
    double of_bob = 0;
    for (std::size_t i = 0; i < told.size(); i += 2) of_bob = std::max(of_bob, told[i]);
    EXPECT_GE(of_bob * s.estimate.length, off);
}

TEST(Auto, NeedsAnAccuracy)
{
    const Model model = slug();
    EXPECT_THROW(solve(model, {model.start()}, make_time_mesh(0, 1, 10), Auto{}), InputError);
    EXPECT_THROW(to_accuracy(model, 1, 1e-6, Auto{19}), InputError);
    const Solution s = to_accuracy(model, 1, 1e-6, Auto{12});   // more than radau has
    EXPECT_EQ(std::get<Radau>(s.method).degree, 8);
}

}   // namespace
}   // namespace livens::tests
