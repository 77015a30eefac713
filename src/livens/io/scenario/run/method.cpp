// SPDX-License-Identifier: BSD-3-Clause
// [method]: the family and its choices, and options: as they are read, and as a result tells them.
#include <type_traits>
#include <utility>
#include <variant>

#include "livens/io/json.h"
#include "livens/io/scenario/run/run.h"
#include "livens/spacetime/mixed/bases.h"

namespace livens::inline io_internal {

namespace {

struct MethodKind : Kind {
    Method (*make)(const Section&);
};

Method make_lobatto(const Section& section)
{
    return Lobatto{section.integer("degree"), section.integer("window")};   // 0 for the word all
}

Method make_auto(const Section& section)
{
    return AutomaticFamily{section.has("degree") ? section.integer("degree") : 0};
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
    return {
        "window", types::integer_or_choice, "Number of elements solved together" + doc, "", otherwise, false,
        {"all"},  {1, max_elements}};
}

Key basis()
{
    Words words;
    std::string doc = "Basis functions of all fields.";
    for (const mixed::Basis& one : mixed::bases()) {
        doc += (words.empty() ? " " : "; ") + std::string(one.word) + ": " + std::string(one.doc);
        words.push_back(one.word);
    }
    return choice("basis", words, doc + ".");
}

std::vector<Key> mixed_keys()
{
    return {
        Key{"degree", types::integer, "Degree of the polynomials or splines.", "", "2"}.within({1, 8}),
        basis(),
        choice<Mixed::Start>(
            "momentum",
            "How the momenta at the initial and final time enter the equations. natural: in the boundary "
            "terms of "
            "Hamilton's law, so that momentum and angular momentum balance to rounding; strong: as "
            "prescribed values of the momentum field, which loses angular momentum."),
        choice<Mixed::Multipliers>(
            "multipliers",
            "Basis functions of the multipliers. equal: those of the positions; lower: one degree less."),
        choice<Mixed::EndMultiplier>(
            "end_multiplier",
            "With natural momentum and equal multipliers, no equation determines the last value of a "
            "multiplier, where the motion ends. smooth: it continues the other values of its element, as a "
            "polynomial of one degree less; zero: it is zero, which limits the order of the whole motion to "
            "4, whatever the degree."),
        Key{"gauss_points", types::integer,
            "Number of Gauss points per element. Default: enough to integrate all polynomials exactly."}
            .within({1, 64}),
        window("all", ", called a block; positions and momenta at the end of a block are the initial values "
                      "of the next. Conditions at both ends need \"all\"."),
        choice<Mixed::Interfaces>("interfaces",
                                  "Transfer between blocks. carry: positions and momenta are passed on "
                                  "unchanged, with their constraint errors; project: they are projected onto "
                                  "rigidity and joints, which makes the motion jump slightly."),
        choice<Mixed::FirstGuess>("first_guess",
                                  "First guess of Newton's iteration if the state is given at one end. "
                                  "march: a lobatto solution on the same elements, with which the result is "
                                  "finally compared; steady: constant velocities, for short blocks."),
        Key{"knots", types::list,
            "Knot vector of the splines, ascending from `start` to `end`: the first and the last knot degree "
            "+ 1 times, others up to degree times. The knots define the elements; output times and breaks of "
            "loads must be among them. Default: splines as smooth as possible on equal elements, with kinks "
            "at breaks of loads.",
            "s"},
        Key{"weights", types::list,
            "Weights of NURBS, positive, one per basis function: the number of knots minus (degree + 1)."},
        choice<SparseBackend>(
            "linear_solver",
            "Library for sparse systems; umfpack is available if livens was built with it.")};
}

const std::vector<MethodKind>& method_kinds()
{
    static const std::vector<MethodKind> all{
        {{"lobatto",
          "space-time finite elements on Gauss-Lobatto points; their order at element ends is twice the "
          "degree",
          {Key{"degree", types::integer,
               "Polynomial degree of the elements. With `accuracy` it is chosen unless given.", "", "4"}
               .within({1, 16}),
           window("1", "; it does not change the equations. With conditions at both ends all elements are "
                       "solved together in any case.")}},
         make_lobatto},
        {{"radau",
          "space-time finite elements on Radau points; their order at element ends is twice the degree minus "
          "1; they damp vibrations that they do not resolve, and need the state at the initial time",
          {Key{"degree", types::integer,
               "Polynomial degree of the elements. With `accuracy` it is chosen unless given.", "", "4"}
               .within({1, 8})}},
         make_radau},
        {{"auto",
          "lobatto, or radau if fast decay or irrelevant vibrations would dictate the length of lobatto's "
          "elements; with `accuracy` only",
          {Key{"degree", types::integer,
               "Polynomial degree of the elements; radau uses at most 8. Default: chosen for the accuracy."}
               .within({1, 16})}},
         make_auto},
        {{"mixed",
          "the space-time elements of Hesch, Glas and Schuss: positions, momenta and multipliers are "
          "independent fields, rigidity is imposed weakly, and elements are solved all at once or in blocks",
          mixed_keys()},
         make_mixed},
        {{"midpoint", "classical time stepping, order 2", {}},
         [](const Section&) { return Method(Midpoint{}); }},
        {{"endpoint", "classical time stepping, order 1", {}},
         [](const Section&) { return Method(Endpoint{}); }}};
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

Key threads()
{
    return Key{"threads", types::integer,
               "Number of threads that solve one motion; 0: one per processor. They share elements that are "
               "solved together: with conditions at both ends, in the blocks of mixed, and in lobatto with a "
               "`window`. From a given state elements are otherwise solved one after the other, which gains "
               "nothing. No bit of a result depends on the number of threads.",
               "", "1"}
        .within({0, 256});
}

/// A key of every family that is an option of solve(), or what is told of a motion.
struct OptionKey {
    Key key;
    std::variant<double SolveOptions::*, int SolveOptions::*, bool SolveOptions::*,
                 SolveOptions::Estimate SolveOptions::*>
        member;
};

const std::vector<OptionKey>& option_keys()
{
    static const std::vector<OptionKey> all{
        {Key{"tolerance", types::number,
             "Newton's iteration stops when the estimated remaining correction is below this fraction of the "
             "displacement of the bodies within the element (mixed: of the model length). Larger values than "
             "1e-10 count as 1e-10 in lobatto and radau, because the error estimate needs it "
             "(unless `estimate` is \"none\" and `growth` false). An `accuracy` of 1e-8 or less lowers it to "
             "1e-15; below 1e-9 only if the first try was not accurate enough.",
             "", "1e-14"}
             .within({0, 0.1, true}),
         &SolveOptions::tolerance},
        {Key{"max_iterations", types::integer,
             "Maximum number of Newton iterations in one element (mixed: in one block).", "", "30"}
             .within({1, 1000}),
         &SolveOptions::max_iterations},
        {threads(), &SolveOptions::threads},
        {choice<SolveOptions::Estimate>(
             "estimate",
             "How the error of the motion is estimated. second: everything is solved once more on the same "
             "elements by a method of higher order, and the distance of the two motions is the estimate. "
             "That method has degree + 1; lobatto from degree 4 on takes degree + 2 under loads and drives, "
             "or where elements barely resolve the motion; mixed is compared with lobatto of degree + 2, "
             "midpoint with lobatto and endpoint with radau of degree 3. local: the error that each element "
             "adds is estimated and propagated to later times with the divergence of neighbouring motions. "
             "It is for lobatto and radau with `elements`, from a given initial state, under no loads but "
             "those that depend on time alone; it is often ten times too large and gives no estimate for "
             "velocities and reactions. none: no estimate."),
         &SolveOptions::estimate},
        {Key{"growth", types::truth,
             "Whether to measure how a small change of the initial state grows, by motions that begin beside "
             "this one. From it follows the horizon: the time after which rounding errors, which no computer "
             "avoids, have grown so large that the motion can no longer be predicted. Costs half as much as "
             "the motion, "
             "or up to three times as much where bodies turn over. Default: true with `accuracy` of "
             "`[time]`, else false."},
         &SolveOptions::growth},
        {Key{"looks", types::truth,
             "Whether the laws of loads and drives are inspected inside elements, between the points at "
             "which they are "
             "evaluated. `false` treats all laws as smooth; it exists for comparison.",
             "", "true"},
         &SolveOptions::look_at_laws},
        {Key{"roots", types::integer,
             "How many motions are looked for between conditions at both ends, from guesses with other rates "
             "and turns. Those that are found are ordered by their effort, the kinetic energy over all of "
             "time; the least is the result. There may be more than are found.",
             "", "1"}
             .within({1, 32}),
         &SolveOptions::roots},
        {Key{"condition", types::truth,
             "Whether condition numbers are computed: of the matrix of the last block (mixed), of all "
             "elements (lobatto) or of the last element (radau), the latter two reduced to the motions that "
             "the joints leave free. They cost as much as tens to hundreds of solutions.",
             "", "false"},
         &SolveOptions::condition}};
    return all;
}

/// Calls `work` with the option itself.
template <class Options, class Work>
void with_option(Options& options, const OptionKey& one, const Work& work)
{
    std::visit([&](const auto member) { work(options.*member); }, one.member);
}

/// A count, or the word for what none stands for.
void write_count(JsonWriter& json, const char* key, int count, const char* none)
{
    json.key(key);
    if (count > 0)
        json.value(count);
    else
        json.value(none);
}

void write_window(JsonWriter& json, int window) { write_count(json, "window", window, "all"); }

void write_mixed(JsonWriter& json, const Mixed& mixed)
{
    json.member("family", "mixed");
    json.member("basis", mixed::basis_of(mixed).word);
    json.member("degree", mixed.degree);
    json.member("momentum", word_of(mixed.start));
    json.member("multipliers", word_of(mixed.multipliers));
    json.member("end_multiplier", word_of(mixed.end_multiplier));
    write_count(json, "gauss_points", mixed.gauss_points, "exact");
    write_window(json, mixed.window);
    json.member("interfaces", word_of(mixed.interfaces));
    json.member("first_guess", word_of(mixed.first_guess));
    if (!mixed.knots.empty()) json.member("knots", std::span<const double>(mixed.knots));
    if (!mixed.weights.empty()) json.member("weights", std::span<const double>(mixed.weights));
    json.member("linear_solver", word_of(mixed.linear_solver));
}

void write_degree(JsonWriter& json, int degree) { write_count(json, "degree", degree, "by accuracy"); }

}   // namespace

Table method_table()
{
    std::vector<Key> keys{{"family", types::choice, "Default: lobatto; with `accuracy` auto", "", "lobatto"}};
    for (const OptionKey& one : option_keys()) keys.push_back(one.key);
    return Table{"[method]",
                 "Integration method and its options. The defaults suit most models. Choose radau to damp "
                 "fast vibrations or for strong damping, mixed to reproduce the elements of Hesch, Glas and "
                 "Schuss, midpoint and endpoint for comparison with classical methods.",
                 std::move(keys)}
        .with_kinds("family", {method_kinds().begin(), method_kinds().end()});
}

void write_method(JsonWriter& json, const Method& method)
{
    if (const Mixed* mixed = std::get_if<Mixed>(&method))
        write_mixed(json, *mixed);
    else if (const Lobatto* lobatto = std::get_if<Lobatto>(&method)) {
        json.member("family", "lobatto");
        write_degree(json, lobatto->degree);
        write_window(json, lobatto->window);
    } else if (const Radau* radau = std::get_if<Radau>(&method)) {
        json.member("family", "radau");
        write_degree(json, radau->degree);
    } else if (const AutomaticFamily* either = std::get_if<AutomaticFamily>(&method)) {
        json.member("family", "auto");
        write_degree(json, either->degree);
    } else
        json.member("family", std::holds_alternative<Midpoint>(method) ? "midpoint" : "endpoint");
}

void read_options(const Section& section, SolveOptions& options)
{
    for (const OptionKey& one : option_keys()) {
        const std::string_view name = one.key.name;
        if (!section.has(name)) continue;
        with_option(options, one, [&]<class Number>(Number& option) {
            if constexpr (std::is_enum_v<Number>)
                option = section.pick<Number>(name);
            else
                option = static_cast<Number>(section.number(name));
        });
    }
}

void write_options(JsonWriter& json, const SolveOptions& options)
{
    for (const OptionKey& one : option_keys()) {
        json.key(one.key.name);
        with_option(options, one, [&]<class Number>(const Number& option) {
            if constexpr (std::is_enum_v<Number>)
                json.value(word_of(option));
            else
                json.value(option);
        });
    }
}

Method read_method(const Section* section, Findings&)
{
    if (section == nullptr || section->kind() == any_kind) return Lobatto{};
    const Method method = method_kinds()[static_cast<std::size_t>(section->kind())].make(*section);
    if (const Mixed* mixed = std::get_if<Mixed>(&method)) check_mixed(*section, *mixed);
    return method;
}

bool has_knots(const Method& method)
{
    const Mixed* mixed = std::get_if<Mixed>(&method);
    return mixed != nullptr && mixed::basis_of(*mixed).has_knots && !mixed->knots.empty();
}

}   // namespace livens::inline io_internal
