// SPDX-License-Identifier: BSD-3-Clause
// Every example of `livens explain` does what its page says.
#include <set>

#include "unit/io/scenario_text.h"

namespace livens::examples_of_codes_test {

namespace {

using test::find;
using test::read;
using test::shown;

struct Example {
    std::string text;
    bool is_file = false;     ///< nothing is left out
    bool has_bytes = false;   ///< `\x00` is a byte
};

/// The block behind a line `label`; none: nothing to run.
std::vector<Example> examples_behind(std::string_view page, std::string_view label)
{
    const std::string opening = std::string(label) + "\n\n```toml";
    const std::size_t at = page.find(opening);
    if (at == std::string_view::npos) return {};
    page.remove_prefix(at + opening.size());
    const std::size_t end_of_line = page.find('\n');
    const std::string_view kind = page.substr(0, end_of_line);
    page.remove_prefix(end_of_line);
    const std::string_view text = page.substr(1, page.find("\n```"));
    return {{std::string(text), kind.starts_with(" file"), kind.ends_with(" bytes")}};
}

/// What the head of docs/diagnostics.md says is left out.
std::string completed(const Example& example)
{
    std::string text = example.text;
    if (example.has_bytes)
        for (std::size_t at; (at = text.find("\\x00")) != std::string::npos;) text.replace(at, 4, 1, '\0');
    if (example.is_file) return text;
    text = "format = 1\n" + text;
    if (text.find("[[body]]") == std::string::npos)
        text +=
            "\n[[body]]\nname = \"rod\"\nshape = { box = [1, 0.1, 0.1] }\nmass = 2\nposition = [0.5, 0, 0]\n";
    if (text.find("[time]") == std::string::npos) text += "\n[time]\nend = 1\nelements = 10\n";
    return text;
}

TEST(ExamplesOfCodes, TheWrongOnesLeadToTheCodeAndTheRightOnesToNone)
{
    int n_examples = 0;
    for (const std::string_view code : diagnostic_codes()) {
        SCOPED_TRACE(code);
        for (const Example& wrong : examples_behind(explain(code), "Wrong:")) {
            const ScenarioResult result = read(completed(wrong));
            ASSERT_NE(find(result, code), nullptr) << completed(wrong) << shown(result);
            EXPECT_EQ(result.diagnostics.size(), 1u) << "an example shows one thing:\n" << shown(result);
            ++n_examples;
        }
        for (const Example& right : examples_behind(explain(code), "Right:")) {
            const ScenarioResult result = read(completed(right));
            EXPECT_TRUE(result.scenario.has_value() && result.diagnostics.empty())
                << completed(right) << shown(result);
            --n_examples;
        }
    }
    EXPECT_EQ(n_examples, 0) << "each wrong one has a right one";
}

/// Meshes are files of their own.
bool needs_file(std::string_view code)
{
    for (const char* include : {"include-file", "include-limit", "include-path", "include-ring"})
        if (code == include) return true;
    return code.starts_with("mesh-") || code == "surface-unknown" || code == "density-field";
}

/// Of files of other programs.
bool is_imported(std::string_view code)
{
    return code.starts_with("import-") || code.starts_with("mjcf-") || code.starts_with("urdf-") ||
           code.starts_with("xml-");
}

/// Codes without examples: no scenario leads to them, another code comes first, or it depends on the machine.
const std::set<std::string_view> without{
    "accuracy-out-of-range",
    "backend-missing",
    "basis-nodes",
    "browser",
    "browser-missing",
    "controller-ends",
    "controller-sampled",
    "coordinate-twice",
    "coordinate-unknown",
    "coordinate-value",
    "coordinates-dependent",
    "coordinates-missing",
    "coordinates-singular",
    "degree",
    "degree-out-of-range",
    "drives-method",
    "event-action",
    "gauss-points-out-of-range",
    "gear-ratio",
    "guess-bodies",
    "guess-time",
    "guess-unused",
    "impact-simultaneous",
    "internal",
    "io-directory",
    "io-damaged",
    "io-foreign",
    "io-not-a-file",
    "io-not-found",
    "io-truncated",
    "io-version",
    "io-unreadable",
    "joint-empty",
    "joint-method",
    "joint-row",
    "joint-scale",
    "joint-second",
    "knots-not-finite",
    "load-empty",
    "load-negative",
    "load-without-tangent",
    "loop-open",
    "mass-not-positive",
    "max-iterations-out-of-range",
    "no-elements",
    "no-such-port",
    "not-at-rest",
    "not-in-equilibrium",
    "not-in-this-version",
    "parameter-set",
    "parameter-unit",
    "picture",
    "point-with-directors",
    "pose-unreachable",
    "python-function",
    "quadrature-points",
    "quantity-unbounded",
    "quantity-unknown",
    "quaternion-zero",
    "sample-exact-method",
    "samples",
    "size-not-positive",
    "sensor-empty",
    "attraction-mu",
    "start-size",
    "stop-restitution",
    "time-elements",
    "time-out-of-range",
    "time-outside",
    "time-start",
    "ranks-conditions",
    "ranks-elements",
    "ranks-method",
    "threads-out-of-range",
    "tolerance-out-of-range",
    "unknown-order",
    "unknown-unseen",
    "window",
    "window-out-of-range",
};

TEST(ExamplesOfCodes, StandWhereverAScenarioLeads)
{
    for (const std::string_view code : diagnostic_codes())
        EXPECT_EQ(examples_behind(explain(code), "Wrong:").size(),
                  needs_file(code) || is_imported(code) ? 0 : 1 - without.count(code))
            << code;
}

}   // namespace

}   // namespace livens::examples_of_codes_test
