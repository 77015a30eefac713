// SPDX-License-Identifier: BSD-3-Clause
// Codes that other tests than scenario_test.cpp provoke, or no scenario does.
#pragma once

#include <set>
#include <string_view>

namespace livens {

/// Of mesh_scenario_test.cpp and parameters_test.cpp, but for the last lines.
inline const std::set<std::string_view> codes_of_others{
    "parameter-name",     "parameter-ring",    "parameter-set",     "parameter-unit", "parameter-unused",
    "repeat-braces",      "repeat-index",      "density-field",     "mesh-file",      "mesh-format",
    "mesh-inverted",      "mesh-open",         "mesh-path",         "mesh-region",    "mesh-unit",
    "surface-unknown",    "mesh-non-manifold", "mesh-self-contact",   // soundness_test.cpp of geometry
    "not-in-this-version"};                                           // see schema_test.cpp

/// The reader refuses these before the core sees them, or only calls of the library lead to them; a missing
/// backend depends on the build, and files of results have tests of their own.
inline const std::set<std::string_view> codes_of_the_core{"accuracy-out-of-range",
                                                          "backend-missing",
                                                          "basis-nodes",
                                                          "browser",
                                                          "browser-missing",
                                                          "picture",
                                                          "degree",
                                                          "drives-method",
                                                          "degree-out-of-range",
                                                          "gauss-points-out-of-range",
                                                          "gear-ratio",
                                                          "internal",
                                                          "io-damaged",
                                                          "io-foreign",
                                                          "io-not-a-file",
                                                          "io-truncated",
                                                          "io-version",
                                                          "joint-empty",
                                                          "joint-method",
                                                          "joint-row",
                                                          "joint-scale",
                                                          "joint-second",
                                                          "knots-not-finite",
                                                          "load-empty",
                                                          "load-negative",
                                                          "load-without-tangent",
                                                          "mass-not-positive",
                                                          "max-iterations-out-of-range",
                                                          "no-elements",
                                                          "no-such-port",
                                                          "not-at-rest",
                                                          "quantity-unbounded",
                                                          "quantity-unknown",
                                                          "not-in-equilibrium",
                                                          "point-with-directors",
                                                          "python-function",
                                                          "quadrature-points",
                                                          "quaternion-zero",
                                                          "sample-exact-method",
                                                          "samples",
                                                          "size-not-positive",
                                                          "sensor-empty",
                                                          "attraction-mu",
                                                          "start-size",
                                                          "time-elements",
                                                          "time-out-of-range",
                                                          "time-outside",
                                                          "time-start",
                                                          "tolerance-out-of-range",
                                                          "window",
                                                          "window-out-of-range"};

}   // namespace livens
