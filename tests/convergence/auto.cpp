// SPDX-License-Identifier: BSD-3-Clause
// The family that is taken for an accuracy, and what radau takes from vibrations that it does not resolve.
#include <sstream>

#include "convergence/studies.h"
#include "livens/base/error.h"

namespace livens::tests::auto_test {
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

Solution to_accuracy(const Model& model, double end, double accuracy,
                     const Method& method = AutomaticFamily{})
{
    return solve(model, {model.start()}, Span{0, end, accuracy}, method);
}

bool is_radau(const Solution& s) { return std::holds_alternative<Radau>(s.method); }

double gap(const State& a, const State& b) { return norm(a.X[0].column(0) - b.X[0].column(0)); }

TEST(AutomaticFamily, StopsAMassByAStrongDamperWithoutBeingTold)
{
    const Solution s = to_accuracy(slug(), 1, 1e-6);
    ASSERT_TRUE(s.report.converged()) << s.report.message;
    ASSERT_TRUE(is_radau(s));
    tell("v(1 s), m/s", s.motion.at(1).V[0](0, 0));
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

TEST(AutomaticFamily, TakesRadauForDecaysAndLobattoForVibrationsThatMatter)
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

/// k, damping by the critical one, and where the bob is after 0.5 s, by DOP853 and Radau IIA of another
/// package, whose two tolerances agree to 1e-13.
struct Elastic {
    double k, zeta, x, z;
};
constexpr Elastic elastic_pendulums[] = {
    {1e4, 0, 0.0151841942256, -1.0002742784603},  {1e4, 1, 0.0152089187468, -1.0011017131453},
    {1e4, 20, 0.0150191823437, -1.0006579403327}, {1e6, 0, 0.0146744291406, -0.9999121411493},
    {1e6, 1, 0.0146743254399, -0.9999045347029},  {1e6, 20, 0.0146746136757, -0.9999044010005},
    {1e8, 0, 0.0146691472886, -0.9998925110457},  {1e8, 1, 0.0146691474782, -0.9998925243659},
    {1e8, 20, 0.0146691478607, -0.9998925243236}};

TEST(AutomaticFamily, FollowsElasticPendulumsOrRefusesThemByName)
{
    int n_right = 0;
    for (const Elastic& one : elastic_pendulums)
        for (const double accuracy : {1e-4, 1e-6, 1e-8}) {
            const Solution s =
                to_accuracy(elastic_pendulum(one.k, 2 * std::sqrt(one.k) * one.zeta), 0.5, accuracy);
            if (!s.report.converged()) {
                EXPECT_NE(s.report.message.find("'bob'"), std::string::npos) << s.report.message;
                continue;
            }
            ++n_right;
            const Vector3 off = s.motion.at(0.5).X[0].column(0) - Vector3{one.x, 0, one.z};
            std::ostringstream what;
            what << "k = " << one.k << " N/m, zeta = " << one.zeta << ", to " << accuracy << ", m";
            tell(what.str(), norm(off));
            EXPECT_LE(norm(off), 3 * accuracy) << what.str();
        }
    tell("of 27 were solved", n_right);
    EXPECT_GE(n_right, 20);
}

TEST(AutomaticFamily, TakesRadauWhereLobattoDoesNotFollowAVibrationThatDoesNotMatter)
{
    const Model model = elastic_pendulum(5e9, 0, 1e-7);
    const Solution s = to_accuracy(model, 5, 1e-3);
    ASSERT_TRUE(s.report.converged()) << s.report.message;
    EXPECT_TRUE(is_radau(s));
    EXPECT_LT(s.motion.n_elements(), 100);
    const auto names = [](const std::string& note) { return note.find("vibrates") != note.npos; };
    EXPECT_TRUE(std::ranges::any_of(s.report.notes, names));
    // to a tenth of it lobatto may be as good with ten times the elements
    const Solution other = to_accuracy(model, 5, 1e-4), fine = to_accuracy(model, 5, 1e-6, Radau{8});
    ASSERT_TRUE(other.report.converged() && fine.report.converged());
    EXPECT_LE(gap(other.motion.at(5), fine.motion.at(5)), 1e-4);
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

TEST(AutomaticFamily, NeedsAnAccuracy)
{
    const Model model = slug();
    EXPECT_THROW(solve(model, {model.start()}, make_time_mesh(0, 1, 10), AutomaticFamily{}), InputError);
    EXPECT_THROW(to_accuracy(model, 1, 1e-6, AutomaticFamily{19}), InputError);
    const Solution s = to_accuracy(model, 1, 1e-6, AutomaticFamily{12});   // more than radau has
    EXPECT_EQ(std::get<Radau>(s.method).degree, 8);
}

}   // namespace
}   // namespace livens::tests::auto_test
