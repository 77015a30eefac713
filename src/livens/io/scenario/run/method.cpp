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
        choice<Mixed::Start>(
            "momentum",
            "How the momentum at the ends enters. natural: as the boundary term of Hamilton's law, which "
            "keeps the balances of momentum to rounding; strong: as a value of the momentum field."),
        choice<Mixed::Multipliers>(
            "multipliers",
            "Functions of the multipliers. equal: those of the positions; lower: one degree less."),
        choice<Mixed::EndMultiplier>(
            "end_multiplier",
            "The multiplier where the natural momentum of an end is defined, with equal multipliers: "
            "smooth, of one degree less in that element, or zero, which holds the order of every degree "
            "down to 4."),
        Key{"gauss_points", types::integer,
            "Of the quadrature in each element. Default: as many as integrate all polynomials exactly."}
            .within({1, 64}),
        window("all", ", a block; positions and momenta at the end of a block begin the next. Conditions at "
                      "both ends need all."),
        choice<Mixed::Interfaces>(
            "interfaces",
            "Between blocks. carry: positions and momenta as they are, with what they violate; project: "
            "moved to the nearest that fulfil rigidity and joints, so that the motion jumps a little."),
        choice<Mixed::FirstGuess>(
            "first_guess",
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
        choice<SparseBackend>("linear_solver",
                              "Library for the sparse systems; umfpack is an option when livens is built.")};
}

const std::vector<MethodKind>& method_kinds()
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
             "The iteration stops when its estimated error is below this fraction of the motion in the "
             "element, at 1e-10 at the latest (lobatto, radau) unless `estimate` is \"none\" and `growth` is "
             "off; mixed: of the model's length. With an accuracy of 1e-9 to 1e-8 it is 1e-15 at most, and "
             "with a smaller one from the second try on.",
             "", "1e-14"}
             .within({0, 0.1, true}),
         &SolveOptions::tolerance},
        {Key{"max_iterations", types::integer, "Of Newton in one element; mixed: in one block.", "", "30"}
             .within({1, 1000}),
         &SolveOptions::max_iterations},
        {choice<SolveOptions::Estimate>(
             "estimate",
             "What tells the error of the motion: a second solution on the same elements (of degree + 1, "
             "lobatto from degree 4 under loads and drives, or on elements that hardly resolve the motion, "
             "of degree + 2; mixed: lobatto of degree + 2, midpoint: lobatto(3), endpoint: radau(3)); what "
             "its elements lose, grown as two neighbouring motions part (lobatto and radau with "
             "`elements` and the state at the start, beside loads of time alone; too large by ten often, "
             "nothing of velocities and reactions); or nothing."),
         &SolveOptions::estimate},
        {Key{"growth", types::truth,
             "Whether neighbouring motions tell how perturbations of the start grow, and the horizon beyond "
             "which double precision says nothing; half as costly as the motion, or up to three times "
             "where bodies turn over. "
             "Default: true with `accuracy` of `[time]`, else false."},
         &SolveOptions::growth},
        {Key{"looks", types::truth,
             "Whether laws of loads are looked at inside of elements, between the points at which they are "
             "evaluated; `false` takes all laws for smooth, and is there for comparison.",
             "", "true"},
         &SolveOptions::look_at_laws},
        {Key{"condition", types::truth,
             "Whether condition numbers are computed: of the whole matrix of the last block (mixed), of that "
             "of all elements, reduced to the free motions (lobatto), of that of the last element likewise "
             "(radau). They take tens to hundreds of solutions more.",
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
    std::vector<Key> keys{{"family", types::choice,
                           "With an `accuracy` auto, unless something else stands here", "", "lobatto"}};
    for (const OptionKey& one : option_keys()) keys.push_back(one.key);
    return Table{"[method]", "How it is solved.", std::move(keys)}.with_kinds(
        "family", {method_kinds().begin(), method_kinds().end()});
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
