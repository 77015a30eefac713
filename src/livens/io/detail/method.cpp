// [method]: the family and its choices, and what they take of memory.
#include <algorithm>

#include "livens/io/detail/builder.h"
#include "livens/time/time_space.h"

namespace livens {

namespace {

constexpr double gibibyte = 1u << 30;
constexpr double max_motion_bytes = 8 * gibibyte;
constexpr double max_matrix_bytes = 8 * gibibyte;
// The whole solution of 20,000 linear elements of one rigid body (56 entries of the factors an unknown, and
// the matrix, its pattern and copies) took 2.3 kB an unknown, as much as 150 entries of 16 bytes. Bodies that
// hang together fill the factors: chains on ball joints had 76 entries an unknown for each body (1 to 16
// bodies, linear). Higher degrees take more: the bound refuses nothing that would fit.
constexpr double least_entries_per_unknown = 150;
constexpr double entries_per_unknown_and_body = 76;
constexpr double bytes_per_factor_entry = 16;

Mixed::Basis basis_of(const Section& section)
{
    const std::string basis = section.text("basis");
    if (basis == "bspline") return Mixed::Basis::bspline;
    return basis == "nurbs" ? Mixed::Basis::nurbs : Mixed::Basis::lagrange;
}

Mixed read_mixed(const Section& section)
{
    Mixed mixed;
    mixed.basis = basis_of(section);
    mixed.degree = section.integer("degree");
    if (section.text("momentum") == "strong") mixed.start = Mixed::Start::strong;
    if (section.text("multipliers") == "lower") mixed.multipliers = Mixed::Multipliers::lower;
    if (section.text("end_multiplier") == "zero") mixed.end_multiplier = Mixed::EndMultiplier::zero;
    if (section.has("gauss_points")) mixed.gauss_points = section.integer("gauss_points");
    if (section.has("window")) mixed.window = section.integer("window");   // 0 for the word all
    if (section.text("interfaces") == "project") mixed.interfaces = Mixed::Interfaces::project;
    if (section.text("first_guess") == "steady") mixed.first_guess = Mixed::FirstGuess::steady;
    if (const Value* knots = section.find("knots")) mixed.knots = knots->numbers;
    if (const Value* weights = section.find("weights")) mixed.weights = weights->numbers;
    if (section.text("linear_solver") == "umfpack") mixed.linear_solver = SparseBackend::umfpack;
    return mixed;
}

/// Keys that belong to some bases only. Nothing is ignored silently.
void check_basis(const Section& section, const Mixed& mixed, Findings& findings)
{
    if (section.has("basis") && section.find("basis") == nullptr) return;
    if (mixed.basis == Mixed::Basis::lagrange)
        refuse_keys(section, {"knots"}, "misplaced-key", "Lagrange polynomials have no knots", findings);
    if (mixed.basis != Mixed::Basis::nurbs)
        refuse_keys(section, {"weights"}, "misplaced-key", "only nurbs have weights", findings);
    else if (!section.has("weights"))
        findings.error(section.place("basis"), "missing-key", section.label() + " lacks 'weights'",
                       {"nurbs are B-splines with weights", "without weights they are basis = \"bspline\""});
}

/// The multiplier of an end is undetermined with the natural start and equal multipliers only.
void check_end_multiplier(const Section& section, const Mixed& mixed, Findings& findings)
{
    if (mixed.start == Mixed::Start::natural && mixed.multipliers == Mixed::Multipliers::equal) return;
    refuse_keys(section, {"end_multiplier"}, "misplaced-key",
                "no multiplier is left open with momentum = \"strong\" or multipliers = \"lower\"", findings);
}

/// Numbers of Field and end values a node and an element end, see Motion.
double motion_bytes(const Model& model, const Method& method, double n_elements)
{
    const double bodies = model.n_bodies(), rows = model.n_rows();
    const double at_ends = 48 * bodies + 2 * rows;   // P, V, and X'' on both sides
    double inside = 12 * bodies + rows;
    if (const Lobatto* lobatto = std::get_if<Lobatto>(&method)) inside *= lobatto->degree;
    if (const Mixed* mixed = std::get_if<Mixed>(&method))   // momenta and rigidity have fields of their own
        inside = (30 * bodies + rows) * mixed->degree;
    return sizeof(double) * n_elements * (inside + at_ends);
}

/// Of the factors of one block's matrix, which outweigh all else.
double matrix_bytes(const Model& model, const Mixed& mixed, double n_elements)
{
    const double at_once = mixed.window > 0 ? std::min<double>(mixed.window, n_elements) : n_elements;
    double unknowns = model.n_rows();   // a node
    for (const Body& body : model.bodies()) unknowns += body.is_point ? 6 : 30;
    const double entries = model.joints().empty() ? least_entries_per_unknown
                                                  : std::max(least_entries_per_unknown,
                                                             entries_per_unknown_and_body * model.n_bodies());
    return unknowns * mixed.degree * at_once * entries * bytes_per_factor_entry;
}

std::string gibibytes(double bytes)
{
    return std::to_string(static_cast<long long>(bytes / gibibyte)) + " GiB";
}

}   // namespace

Method read_method(const Section* section, Findings& findings)
{
    if (section == nullptr) return Lobatto{};
    const std::string family = section->text("family");
    if (family == "midpoint") return Midpoint{};
    if (family == "endpoint") return Endpoint{};
    if (family == "lobatto") {
        Lobatto lobatto{section->integer("degree")};
        if (section->has("window")) lobatto.window = section->integer("window");   // 0 for the word all
        return lobatto;
    }
    const Mixed mixed = read_mixed(*section);
    check_basis(*section, mixed, findings);
    check_end_multiplier(*section, mixed, findings);
    return mixed;
}

bool has_knots(const Method& method)
{
    const Mixed* mixed = std::get_if<Mixed>(&method);
    return mixed != nullptr && mixed->basis != Mixed::Basis::lagrange && !mixed->knots.empty();
}

TimeMesh mesh_of_knots(const Mixed& mixed)
{
    const bool is_rational = mixed.basis == Mixed::Basis::nurbs && !mixed.weights.empty();
    return {is_rational ? TimeSpace::nurbs(mixed.degree, mixed.knots, mixed.weights).ends()
                        : TimeSpace::bspline(mixed.degree, mixed.knots).ends()};
}

bool check_size(const Model& model, const Method& method, double n_elements, const Place& place,
                Findings& findings)
{
    const std::string what = std::to_string(static_cast<long long>(n_elements)) + " time elements for " +
                             std::to_string(model.n_bodies()) + " bodies";
    const double motion = motion_bytes(model, method, n_elements);
    if (motion > max_motion_bytes) {
        findings.error(place, "resource-limit",
                       "the motion would take " + gibibytes(motion) + ", more than " +
                           gibibytes(max_motion_bytes),
                       {what, "use fewer elements; a higher degree makes up for it"});
        return false;
    }
    const Mixed* mixed = std::get_if<Mixed>(&method);
    const double matrix = mixed != nullptr ? matrix_bytes(model, *mixed, n_elements) : 0;
    if (matrix <= max_matrix_bytes) return true;
    findings.error(place, "resource-limit",
                   "the system of one block would take " + gibibytes(matrix) + ", more than " +
                       gibibytes(max_matrix_bytes),
                   {what, "solve fewer of them at once, for instance with window = 1000 in [method]"});
    return false;
}

}   // namespace livens
