// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>

#include "livens/multibody/loads/load_tape.h"
#include "properties/load_kit.h"

namespace livens::load_kit_test {
namespace {

class EveryLoad : public testing::TestWithParam<LoadCase> {};

TEST_P(EveryLoad, Passes) { EXPECT_EQ(joined(check_load(GetParam())), ""); }

INSTANTIATE_TEST_SUITE_P(LoadKit, EveryLoad, testing::ValuesIn(load_cases()),
                         [](const auto& of) { return test_name(of.param.type + " " + of.param.what); });

TEST(LoadKit, EveryFileOfALoadIsInTheRegistry)
{
    expect_sources_in(load_cases(), "src/livens/multibody/loads", {"spring_laws", "load_coordinate_on_tape"},
                      10);
}

const LoadCase& find_case(const std::string& what)
{
    return *std::ranges::find_if(load_cases(), [&](const LoadCase& c) { return c.what == what; });
}

/// A load of the registry, changed after it is made.
template <typename Change>
LoadCase broken(const std::string& what, Change change)
{
    LoadCase result = find_case(what);
    result.make = [make = result.make, change](Random& random) {
        Load load = make(random);
        change(load);
        return load;
    };
    return result;
}

TEST(LoadKit, OneWrongSignFailsTheTangent)
{
    const LoadCase load = broken("torque in body axes", [](Load& l) {
        l.tangent = [tangent = l.tangent](const LoadArguments& at, LoadTangent& T) {
            tangent(at, T);
            T.X[0][0](4, 8) *= -1;
        };
    });
    EXPECT_FALSE(check_load_tangent(load).empty());
}

TEST(LoadKit, OneWrongSlopeFailsTheProducts)
{
    int n = 0;
    for (const LoadCase& each : load_cases()) {
        Random random(1);
        if (!each.make(random).products) continue;
        ++n;
        for (const bool of_V : {false, true}) {
            const LoadCase load = broken(each.what, [of_V](Load& l) {
                l.products = [products = l.products, of_V](const LoadArguments& at) {
                    std::vector<ProductSlopes> found = products(at);
                    (of_V ? found[0].by_V : found[0].by_X)[0][4] += 1e-6;
                    return found;
                };
            });
            EXPECT_FALSE(check_load_products(load).empty()) << each.what;
        }
    }
    EXPECT_GT(n, 3);
}

TEST(LoadKit, AFaultOnTheTapeFailsTheLanes)
{
    const LoadCase load = broken("torque in body axes", [](Load& l) {
        l.forces.record = [record = l.forces.record](LoadTape& tape, const TapeNumber& factor) {
            record(tape, (1 + 1e-13) * factor);
        };
    });
    EXPECT_FALSE(check_load_lanes(load).empty());
}

TEST(LoadKit, AWrongPowerOnTheTapeFailsTheSupply)
{
    int n = 0;
    for (const LoadCase& each : load_cases()) {
        Random random(3);
        if (!each.make(random).recorded_power) continue;
        const LoadCase load = broken(each.what, [](Load& l) {
            l.recorded_power = [power = l.recorded_power](LoadTape& tape) { return 1e-3 + power(tape); };
        });
        EXPECT_FALSE(check_load_supply(load).empty()) << each.what;
        ++n;
    }
    EXPECT_GT(n, 4);
}

TEST(LoadKit, AMissingTermFailsTheTangent)
{
    const LoadCase load = broken("spring and damper", [](Load& l) {
        l.tangent = [tangent = l.tangent](const LoadArguments& at, LoadTangent& T) {
            LoadArguments still = at;
            still.V = PerBody<Matrix34>(2);   // the damper's geometric part is gone
            tangent(still, T);
        };
    });
    EXPECT_FALSE(check_load_tangent(load).empty());
}

TEST(LoadKit, AFlagThatIsDownFailsTheTangent)
{
    EXPECT_FALSE(check_load_tangent(broken("torque", [](Load& l) { l.depends_on_X = false; })).empty());
    EXPECT_FALSE(check_load_tangent(broken("damper", [](Load& l) { l.depends_on_V = false; })).empty());
}

TEST(LoadKit, AWrongSignOfPowerFailsTheEnergy)
{
    const LoadCase load = broken("spring and damper", [](Load& l) {
        l.power = [power = l.power](const LoadArguments& at) { return -power(at); };
    });
    EXPECT_FALSE(check_load_energy(load).empty());
    EXPECT_TRUE(check_load_potential(load).empty()) << "at rest nothing is lost";
}

TEST(LoadKit, AWrongSignOfThePotentialFails)
{
    const LoadCase load = broken("spring", [](Load& l) {
        l.potential = [potential = l.potential](const LoadArguments& at) { return -potential(at); };
    });
    EXPECT_FALSE(check_load_energy(load).empty());
    EXPECT_FALSE(check_load_potential(load).empty());
}

TEST(LoadKit, AMissingBreakFails)
{
    for (std::size_t missing = 0; missing < 4; ++missing) {
        const LoadCase load = broken("torque that varies", [=](Load& l) {
            l.breaks.erase(l.breaks.begin() + static_cast<long>(missing));
        });
        EXPECT_FALSE(check_load_breaks(load).empty()) << missing;
    }
}

TEST(LoadKit, AnUndeclaredNeedOfDirectorsFails)
{
    EXPECT_FALSE(check_load_directors(broken("torque", [](Load& l) { l.needs_directors = {}; })).empty());
}

}   // namespace
}   // namespace livens::load_kit_test
