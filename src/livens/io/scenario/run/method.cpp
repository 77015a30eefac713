// SPDX-License-Identifier: BSD-3-Clause
// [method]: the family and its choices, and what they take of memory.
// Memory is bounded before the solution begins, by formulas that were fitted to measured peaks: a computer
// that swaps or kills the program tells nothing. The numbers are estimates, not inequalities.
#include <algorithm>

#include "livens/io/scenario/builder.h"
#include "livens/spacetime/mixed/bases.h"

namespace livens {

namespace {

constexpr double gibibyte = 1u << 30;
constexpr double max_motion_bytes = 8 * gibibyte;
constexpr double max_matrix_bytes = 8 * gibibyte;
// The whole solution of 20,000 linear elements of one rigid body (56 entries of the factors an unknown, and
// the matrix, its pattern and copies) took 2.3 kB an unknown, as much as 150 entries of 16 bytes. Bodies that
// hang together fill the factors: chains of 2, 4 and 8 hinges took 240, 400 and 770 entries, linear elements.
constexpr double least_entries_per_unknown = 150;
constexpr double entries_per_unknown = 2.57;   // beyond 60, for each unknown of a node
constexpr double bytes_per_factor_entry = 16;

struct MethodKind : Kind {
    Method (*make)(const Section&);
};

Method make_lobatto(const Section& section)
{
    return Lobatto{section.integer("degree"), section.integer("window")};   // 0 for the word all
}

Method make_auto(const Section& section)
{
    return Auto{section.has("degree") ? section.integer("degree") : 0};
}

Method make_radau(const Section& section) { return Radau{section.integer("degree")}; }

Method make_mixed(const Section& section)
{
    Mixed mixed;
    mixed.basis = section.pick<Mixed::Basis>("basis");
    mixed.degree = section.integer("degree");
    mixed.start = section.pick<Mixed::Start>("momentum");
    mixed.multipliers = section.pick<Mixed::Multipliers>("multipliers");
    mixed.end_multiplier = section.pick<Mixed::EndMultiplier>("end_multiplier");
    mixed.gauss_points = section.integer("gauss_points");   // 0: exact
    mixed.window = section.integer("window");               // 0 for the word all
    mixed.interfaces = section.pick<Mixed::Interfaces>("interfaces");
    mixed.first_guess = section.pick<Mixed::FirstGuess>("first_guess");
    if (const Value* knots = section.find("knots")) mixed.knots = knots->numbers;
    if (const Value* weights = section.find("weights")) mixed.weights = weights->numbers;
    mixed.linear_solver = section.pick<SparseBackend>("linear_solver");
    return mixed;
}

/// Number of elements solved together.
Key window(std::string_view otherwise, const std::string& doc)
{
    return {"window",
            types::integer_or_choice,
            "Number of elements that are solved together" + doc,
            "",
            otherwise,
            false,
            {"all"},
            {1, max_elements}};
}

Key basis()
{
    Words words;
    std::string doc = "Of all fields.";
    for (const mixed::Basis& one : mixed::bases()) {
        doc += (words.empty() ? " " : "; ") + std::string(one.word) + ": " + std::string(one.doc);
        words.push_back(one.word);
    }
    return choice("basis", words, doc + ".");
}

std::vector<Key> mixed_keys()
{
    return {
        Key{"degree", types::integer, "Of polynomials or splines.", "", "2"}.within({1, 8}),
        basis(),
        choice("momentum", {"natural", "strong"},
               "How the momentum at the ends enters. natural: as the boundary term of Hamilton's law, which "
               "keeps the balances of momentum to rounding; strong: as a value of the momentum field."),
        choice("multipliers", {"equal", "lower"},
               "Functions of the multipliers. equal: those of the positions; lower: one degree less."),
        choice("end_multiplier", {"smooth", "zero"},
               "The multiplier where the natural momentum of an end is defined, with equal multipliers: "
               "smooth, of one degree less in that element, or zero, which holds the order of every degree "
               "down to 4."),
        Key{"gauss_points", types::integer,
            "Of the quadrature in each element. Default: as many as integrate all polynomials exactly."}
            .within({1, 64}),
        window("all", ", a block; positions and momenta at the end of a block begin the next. Conditions at "
                      "both ends need all."),
        choice("interfaces", {"carry", "project"},
               "Between blocks. carry: positions and momenta as they are, with what they violate; project: "
               "moved to the nearest that fulfil rigidity and joints, so that the motion jumps a little."),
        choice("first_guess", {"march", "steady"},
               "Where Newton begins if the state is given at one end. march: from a lobatto march over the "
               "same elements, which the motion is compared with in the end; steady: straight on, for short "
               "blocks."),
        Key{"knots", types::list,
            "Of splines: from `start` to `end`, ascending, the first and the last degree + 1 times, others "
            "up to degree times. They make the elements: output times and breaks of loads must be among "
            "them. Default: as smooth as possible on equal elements, with kinks where loads break.",
            "s"},
        Key{"weights", types::list,
            "Of NURBS, positive, one for each function: as many as knots, less degree + 1."},
        choice("linear_solver", {"eigen", "umfpack"},
               "Library for the sparse systems; umfpack is an option when livens is built.")};
}

const std::vector<MethodKind>& kinds()
{
    static const std::vector<MethodKind> all{
        {{"lobatto",
          "space-time elements on Gauss-Lobatto points, order 2 degree at their ends",
          {Key{"degree", types::integer, "Of the polynomial in each element.", "", "4"}.within({1, 16}),
           window("1", ". Their equations are the same; conditions at both ends of time take all, whatever "
                       "stands here.")}},
         make_lobatto},
        {{"radau",
          "the same on Radau points, order 2 degree - 1, which damps vibrations that its elements do not "
          "resolve; from the state at the start",
          {Key{"degree", types::integer, "Of the polynomial in each element.", "", "4"}.within({1, 8})}},
         make_radau},
        {{"auto",
          "lobatto, or radau where fast decays, or vibrations that do not matter, would rule its elements; "
          "with an `accuracy` only",
          {Key{"degree", types::integer,
               "Of the polynomial in each element; radau takes 8 of it at most. Default: as the accuracy has "
               "it."}
               .within({1, 16})}},
         make_auto},
        {{"mixed",
          "the elements of Hesch, Glas and Schuss, with positions, momenta and multipliers as separate "
          "fields and weak rigidity, all solved at once or by blocks",
          mixed_keys()},
         make_mixed},
        {{"midpoint", "classical stepping, order 2", {}}, [](const Section&) { return Method(Midpoint{}); }},
        {{"endpoint", "classical stepping, order 1", {}}, [](const Section&) { return Method(Endpoint{}); }}};
    return all;
}

/// Keys that belong to some choices only. Nothing is ignored silently.
void check_mixed(const Section& section, const Mixed& mixed)
{
    if (mixed.start == Mixed::Start::strong || mixed.multipliers == Mixed::Multipliers::lower)
        section.refuse({"end_multiplier"}, "misplaced-key",
                       "no multiplier is left open with momentum = \"strong\" or multipliers = \"lower\"");
    // The word of the basis is none: told already.
    if (section.has("basis") && section.find("basis") == nullptr) return;
    const mixed::Basis& basis = mixed::basis_of(mixed);
    if (!basis.has_knots)
        section.refuse({"knots"}, "misplaced-key",
                       "no knots belong to a " + std::string(basis.word) + " basis");
    if (!basis.has_weights)
        section.refuse({"weights"}, "misplaced-key", "only quotients (nurbs) have weights");
    else if (!section.has("weights"))
        section.error("basis", "missing-key", section.label() + " lacks 'weights'",
                      {"nurbs are B-splines with weights", "without weights they are basis = \"bspline\""});
}

int degree_of(const Method& method)
{
    if (const auto* lobatto = std::get_if<Lobatto>(&method)) return lobatto->degree;
    if (const auto* radau = std::get_if<Radau>(&method)) return radau->degree;
    const auto* mixed = std::get_if<Mixed>(&method);
    return mixed != nullptr ? mixed->degree : 1;
}

double elements_at_once(int window, double n_elements)
{
    return window > 0 ? std::min<double>(window, n_elements) : n_elements;
}

/// Numbers of Field and end values a node and an element end, see Motion.
double motion_bytes(const Model& model, const Method& method, double n_elements)
{
    const double bodies = model.n_bodies(), rows = model.n_rows();
    const double at_ends = 48 * bodies + 2 * rows;   // P, V, and X'' on both sides
    // The elements mixed have fields of momenta and of rigidity of their own.
    const double inside = (std::holds_alternative<Mixed>(method) ? 30 : 12) * bodies + rows;
    return sizeof(double) * n_elements * (inside * std::max(degree_of(method), 1) + at_ends);
}

/// Of lobatto's elements that are solved together: blocks of the unknowns of one node, a row of 6 (3 for
/// point masses) a body, and what belongs to a node besides. Chains of 1, 4 and 8 bodies took 4.4, 29 and 87
/// kB a node.
double window_bytes(const Model& model, const Lobatto& lobatto, double n_elements)
{
    if (lobatto.window == 1) return 0;
    double unknowns = 0;
    for (const Body& body : model.bodies()) unknowns += body.is_point ? 3 : 6;
    return lobatto.degree * elements_at_once(lobatto.window, n_elements) * unknowns * (600 + 24 * unknowns);
}

/// What condition numbers of a march take beside the motion: of all elements together the blocks of their
/// matrix, its factors, its entries that are not zero, null spaces, and what belongs to a node besides. One
/// free body took 24 kB an element of degree 4, chains of 1, 4 and 10 hinges what follows within 3 percent.
double condition_bytes(const Model& model, const Method& method, double n_elements)
{
    const double bodies = model.n_bodies(), rows = model.n_rows();
    double twists = 0;
    for (const Body& body : model.bodies()) twists += body.is_point ? 3 : 6;
    // The matrix is reduced to the free motions, f of them a node (theory.md, The whole matrix of lobatto).
    const double f = std::max(twists - rows, 1.0), p = degree_of(method);
    const bool is_free = model.joints().empty() && model.loads().empty();
    const double density = is_free ? 1 / (3 * bodies) : 1;   // of the blocks
    const double blocks = 8 * (p + 1) * (p + 1) * f * f, factors = 8 * f * f * (p * p + 2 * p + 1),
                 entries = 12 * density * p * (p + 1) * f * f,
                 node = 8 * twists * f + (12 * twists + 550) * rows + 600 * bodies + 650;
    return n_elements * (blocks + factors + entries + p * node);
}

/// Conditions at both ends take one window of all elements, and its condition number, which tells whether
/// they determine the motion; those of a second solution are of one degree more. Free bodies (1 to 6) and
/// chains of 1 to 8 hinges, degrees 1 to 4, took what follows within a quarter.
double both_ends_bytes(const Model& model, const Lobatto& lobatto, double n_elements, bool is_estimated)
{
    double twists = 0;
    for (const Body& body : model.bodies()) twists += body.is_point ? 3 : 6;
    const double f = std::max(twists - model.n_rows(), 1.0), p = lobatto.degree + (is_estimated ? 1 : 0);
    return n_elements * p * (twists * (600 + 24 * twists) + (40 + 18 * p) * f * f + 550 * f + 1000);
}

/// Of the factors of one block's matrix, which outweigh all else.
double matrix_bytes(const Model& model, const Mixed& mixed, double n_elements)
{
    double unknowns = model.n_rows();   // a node
    for (const Body& body : model.bodies()) unknowns += body.is_point ? 6 : 30;
    // Bodies without joints do not fill each other's factors.
    const bool is_free = model.joints().empty();
    const double entries = is_free ? least_entries_per_unknown
                                   : std::max(least_entries_per_unknown, 60 + entries_per_unknown * unknowns);
    // the factors fill a band as wide as an element: degrees 1 to 8 took 1.1, 1.3, .. 3.4 times the entries,
    // 2.7 times of free bodies, 4.2 times of chains
    const double p = mixed.degree, of_chain = std::clamp(unknowns / 35 - 1, 0.0, 1.0),
                 width = is_free ? 0.75 + 0.25 * p
                                 : std::max(1.0, 0.65 + 0.34 * p) + of_chain * 0.012 * (p * p - 1);
    return unknowns * mixed.degree * elements_at_once(mixed.window, n_elements) * entries * width *
           bytes_per_factor_entry;
}

double system_bytes(const Model& model, const Method& method, double n_elements)
{
    if (const auto* lobatto = std::get_if<Lobatto>(&method)) return window_bytes(model, *lobatto, n_elements);
    const auto* mixed = std::get_if<Mixed>(&method);
    return mixed != nullptr ? matrix_bytes(model, *mixed, n_elements) : 0;
}

std::string gibibytes(double bytes)
{
    return std::to_string(static_cast<long long>(bytes / gibibyte)) + " GiB";
}

}   // namespace

Table method_table()
{
    return Table{
        "[method]",
        "How it is solved.",
        {Key{"family", types::choice, "With an `accuracy` auto, unless something else stands here", "",
             "lobatto"},
         Key{"tolerance", types::number,
             "The iteration stops when its estimated error is below this fraction of the motion in the "
             "element, at 1e-10 at the latest (lobatto, radau) unless `estimate` is \"none\" and `growth` is "
             "off; mixed: of the model's length. With an accuracy of 1e-9 to 1e-8 it is 1e-15 at most, and "
             "with a smaller one from the second try on.",
             "", "1e-14"}
             .within({0, 0.1, true}),
         Key{"max_iterations", types::integer, "Of Newton in one element; mixed: in one block.", "", "30"}
             .within({1, 1000}),
         Key{"estimate",
             types::choice,
             "What tells the error of the motion: a second solution on the same elements (of degree + 1, "
             "lobatto from degree 4 under loads and drives, or on elements that hardly resolve the motion, "
             "of degree + 2; mixed: lobatto of degree + 2, midpoint: lobatto(3), endpoint: radau(3)); what "
             "its elements lose, grown as two neighbouring motions part (lobatto and radau with "
             "`elements` and the state at the start, beside loads of time alone; too large by ten often, "
             "nothing of velocities and reactions); or nothing.",
             "",
             "second",
             false,
             {"second", "local", "none"}},
         Key{"growth", types::truth,
             "Whether neighbouring motions tell how perturbations of the start grow, and the horizon beyond "
             "which double precision says nothing; one to three times as costly as the motion. "
             "Default: true with `accuracy` of `[time]`, else false."},
         Key{"looks", types::truth,
             "Whether laws of loads are looked at inside of elements, between the points at which they are "
             "evaluated; `false` takes all laws for smooth, and is there for comparison.",
             "", "true"},
         Key{"condition", types::truth,
             "Whether condition numbers are computed: of the whole matrix of the last block (mixed), of that "
             "of all elements, reduced to the free motions (lobatto), of that of the last element likewise "
             "(radau). They take tens to hundreds of solutions more.",
             "", "false"}}}
        .with_kinds("family", {kinds().begin(), kinds().end()});
}

Method read_method(const Section* section, Findings&)
{
    if (section == nullptr || section->kind() == any_kind) return Lobatto{};
    const Method method = kinds()[static_cast<std::size_t>(section->kind())].make(*section);
    if (const Mixed* mixed = std::get_if<Mixed>(&method)) check_mixed(*section, *mixed);
    return method;
}

bool has_knots(const Method& method)
{
    const Mixed* mixed = std::get_if<Mixed>(&method);
    return mixed != nullptr && mixed::basis_of(*mixed).has_knots && !mixed->knots.empty();
}

bool check_size(const Model& model, const Method& method, double n_elements, const SourceLocation& place,
                Findings& findings)
{
    const std::string what = std::to_string(static_cast<long long>(n_elements)) + " time elements for " +
                             std::to_string(model.n_bodies()) + " bodies";
    const auto fits = [&](const char* thing, double bytes, double most, const char* help) {
        return bytes <= most || findings.error(place, "resource-limit",
                                               std::string(thing) + " would take " + gibibytes(bytes) +
                                                   ", more than " + gibibytes(most),
                                               {what, help});
    };
    return fits("the motion", motion_bytes(model, method, n_elements), max_motion_bytes,
                "use fewer elements; a higher degree makes up for it") &&
           fits("the system of one block", system_bytes(model, method, n_elements), max_matrix_bytes,
                "solve fewer of them at once, for instance with window = 1000 in [method]");
}

MemoryNeed memory_needed(const Scenario& scenario)
{
    const Model& model = scenario.model;
    const Method& method = scenario.method;
    const bool is_march =
        scenario.conditions.at_start == Known::state || scenario.conditions.at_end == Known::state;
    const auto* mesh = std::get_if<TimeMesh>(&scenario.time);
    const double n_output = static_cast<double>(scenario.output.size());
    // for an accuracy at least one between output times is found
    const double n = mesh != nullptr ? mesh->n_elements() : std::max(n_output - 1, 1.0);
    const bool is_estimated = scenario.options.estimate != SolveOptions::Estimate::none;
    const double estimates =
        is_estimated ? 3 * model.n_bodies() + static_cast<int>(model.joints().size()) : 0;
    MemoryNeed need;
    need.motion =
        motion_bytes(model, method, n) + sizeof(double) * (2 * n + n_output);   // ends and iterations
    need.system = system_bytes(model, method, n);
    const auto* lobatto = std::get_if<Lobatto>(&method);
    if (lobatto != nullptr && !is_march)
        need.system = both_ends_bytes(model, *lobatto, n, is_estimated);
    else if (lobatto != nullptr && scenario.options.condition)
        need.system = std::max(need.system, condition_bytes(model, method, n));
    // What estimates and checks keep of each element, and 8 MiB besides.
    need.checks = sizeof(double) * (estimates * n + 6 * n * degree_of(method)) + (8u << 20);
    return need;
}

}   // namespace livens
