#include "livens/io/detail/schema.h"

#include <array>
#include <charconv>
#include <cmath>

#include "livens/io/json.h"

namespace livens {

namespace {

using T = TableId;
using K = KeyType;

constexpr Range positive{.low = 0, .above = true};
constexpr Range not_negative{.low = 0};

constexpr std::array tables{
    Table{T::root, "top of the file", "", "Stands before the first table header; `format` comes first."},
    Table{T::body, "[[body]]", "",
          "A rigid body or a point mass. Body coordinates have their origin at the reference point and "
          "their axes along the three directors. Mass comes from `shape` with `density` or `mass`, or "
          "from `mass` and `inertia` without a shape. Orientation is given by one of `directors`, "
          "`quaternion`, `rotation_vector`; without any the axes are those of the world."},
    Table{T::shape, "shape of [[body]]", "", "Exactly one of these. Axes of revolution lie along d3."},
    Table{T::sphere, "sphere of shape", "", ""},
    Table{T::cylinder, "cylinder of shape", "", ""},
    Table{T::capsule, "capsule of shape", "", ""},
    Table{T::cone, "cone of shape", "", ""},
    Table{T::joint, "[[joint]]", "type",
          "A joint is placed in one of two ways. With `at`, by one point in the world, where the bodies "
          "are at the start; `axis` or `axes` are then directions in the world, too. Or with `points`, "
          "one point for each body in that body's coordinates (world coordinates for the world); `axes` "
          "are then one direction for each body in the same coordinates. Only the second way can describe "
          "a start that does not fit. Reactions are what the joint exerts on the second body of "
          "`between`, or on the only one of a joint to the world."},
    Table{T::load, "[[load]]", "type", "Gravity is not a load: it stands at the top of the file."},
    Table{T::force_table, "table of a force", "", "Values between the times; constant before and after."},
    Table{T::torque_table, "table of a torque", "", "Values between the times; constant before and after."},
    Table{T::time, "[time]", "",
          "What is solved: from `start` to `end` in at least `elements` time elements."},
    Table{T::method, "[method]", "family", "How it is solved."},
    Table{T::start, "[start]", "",
          "What is known at the start, and what to do with a start that does not fit the joints. What is "
          "not given there is a first guess: positions and velocities of `[[body]]` are needed all the "
          "same, and joints placed by `at` refer to them."},
    Table{T::end, "[end]", "",
          "What is known at the end of time, by `[body.end]` of every body. In all, positions and momenta "
          "must be given once each, at one end or at both: a state at the end alone asks where the motion "
          "came from, positions at both ends how to get from one to the other. Conditions at the end need "
          "the family mixed."},
    Table{T::body_end, "[body.end]", "",
          "The body at the end of time, below its `[[body]]`; needed for all bodies if `given` of `[end]` "
          "is not `nothing`. Momenta are those of the positions and velocities stated here."},
};

constexpr std::array keys{
    Key{T::root, "format", K::integer, "Version of this file format."}.needed().within({1, 1}),
    Key{T::root, "title", K::text, "One line for people; copied to results."},
    Key{T::root, "gravity", K::vector3,
        "Acceleration of free fall, world axes."}.in("m/s^2").otherwise("[0, 0, 0]"),
    Key{T::root, "body", K::tables, "Bodies, at least one."}.needed().holding(T::body),
    Key{T::root, "joint", K::tables, "Joints."}.holding(T::joint),
    Key{T::root, "load", K::tables, "Forces, torques and springs."}.holding(T::load),
    Key{T::root, "time", K::table, "Interval, elements and output."}.needed().holding(T::time),
    Key{T::root, "method", K::table, "Discretisation and its tolerances."}.holding(T::method),
    Key{T::root, "start", K::table, "Conditions at the start."}.holding(T::start),
    Key{T::root, "end", K::table, "Conditions at the end of time."}.holding(T::end),

    Key{T::body, "name", K::text, "How joints, loads and results call the body; not `world`."}.needed(),
    Key{T::body, "shape", K::table, "Solid of constant density, for mass and inertia."}.holding(T::shape),
    Key{T::body, "density", K::number, "Of the shape; instead of `mass`."}.in("kg/m^3").within(positive),
    Key{T::body, "mass", K::number, "Of the body; instead of `density`."}.in("kg").within(positive),
    Key{T::body, "center_of_mass", K::vector3,
        "In body coordinates. With a shape: where its centre of mass lies."}.in("m").otherwise("[0, 0, 0]"),
    Key{T::body, "inertia", K::principal_or_full,
        "About the centre of mass, in body axes: three principal moments or the matrix. Without a shape "
        "only."}.in("kg m^2"),
    Key{T::body, "position", K::vector3,
        "Of the reference point at the start, in the world."}.in("m").otherwise("[0, 0, 0]"),
    Key{T::body, "directors", K::triple, "Body axes at the start: [d1, d2, d3], each in world axes."},
    Key{T::body, "quaternion", K::vector4,
        "Orientation at the start (w, x, y, z), body to world, of norm 1."},
    Key{T::body, "rotation_vector", K::vector3, "Orientation at the start: axis times angle."}.in("rad"),
    Key{T::body, "velocity", K::vector3,
        "Of the reference point at the start, world axes."}.in("m/s").otherwise("[0, 0, 0]"),
    Key{T::body, "angular_velocity", K::vector3, "At the start, world axes."}.in("rad/s"),
    Key{T::body, "angular_velocity_body", K::vector3, "At the start, body axes."}.in("rad/s"),
    Key{T::body, "director_rates", K::triple,
        "Time derivatives of the directors at the start, [d1', d2', d3'], as they are. Rates that deform "
        "the triad need `initial = \"project\"`."}.in("1/s"),
    Key{T::body, "end", K::table, "The body at the end of time."}.holding(T::body_end),

    Key{T::shape, "box", K::vector3, "Edges along d1, d2, d3."}.in("m").within(positive),
    Key{T::shape, "sphere", K::number_or_table,
        "Radius, or a table with it."}.in("m").within(positive).holding(T::sphere),
    Key{T::shape, "cylinder", K::table, "Solid or tube."}.holding(T::cylinder),
    Key{T::shape, "capsule", K::table, "Cylinder between two half spheres."}.holding(T::capsule),
    Key{T::shape, "ellipsoid", K::vector3, "Semi-axes along d1, d2, d3."}.in("m").within(positive),
    Key{T::shape, "cone", K::table,
        "Solid cone, apex along +d3, origin at its centre of mass."}.holding(T::cone),
    Key{T::shape, "point", K::flag, "A point mass: no orientation, no inertia; needs `mass`."},
    Key{T::shape, "mesh", K::later, "A solid bounded by triangles."},
    Key{T::sphere, "radius", K::number, "Of the sphere."}.in("m").needed().within(positive),
    Key{T::cylinder, "radius", K::number, "Outer radius."}.in("m").needed().within(positive),
    Key{T::cylinder, "length", K::number, "Along d3."}.in("m").needed().within(positive),
    Key{T::cylinder, "inner_radius", K::number,
        "Of the bore of a tube."}.in("m").otherwise("0").within(not_negative),
    Key{T::capsule, "radius", K::number, "Of cylinder and half spheres."}.in("m").needed().within(positive),
    Key{T::capsule, "length", K::number,
        "Of the cylindrical part, along d3."}.in("m").needed().within(positive),
    Key{T::cone, "radius", K::number, "Of the base."}.in("m").needed().within(positive),
    Key{T::cone, "height", K::number, "From base to apex, along d3."}.in("m").needed().within(positive),

    Key{T::joint, "name", K::text,
        "Default: type and bodies, as in `rod world-upper`, where no other joint is called that."},
    Key{T::joint, "type", K::choice,
        "weld: nothing moves (6 rows); revolute: turns about one axis (5); universal: turns about two "
        "perpendicular axes (4); spherical: one common point (3); rod: fixed distance (1)."}
        .needed().one_of("weld|revolute|universal|spherical|rod"),
    Key{T::joint, "between", K::names, "Two different bodies, or one and `\"world\"`."}.needed(),
    Key{T::joint, "at", K::vector3,
        "The joint's point at the start, in the world."}
        .in("m").only_for("weld|revolute|universal|spherical"),
    Key{T::joint, "axis", K::vector3,
        "With `at`: the axis at the start, world axes, of any length."}.only_for("revolute"),
    Key{T::joint, "points", K::pair,
        "The joint's point on each body, in its coordinates. A rod's default: the reference points, for "
        "the world its origin."}.in("m"),
    Key{T::joint, "axes", K::pair,
        "One direction for each body, of any length: the common axis (revolute, with `points`) or the two "
        "perpendicular axes (universal)."}.only_for("revolute|universal"),
    Key{T::joint, "length", K::number,
        "Default: the distance of its points at the start."}.in("m").only_for("rod").within(positive),

    Key{T::load, "name", K::text, "For messages; default: type and bodies."},
    Key{T::load, "type", K::choice, "What acts."}.needed().one_of("force|torque|spring"),
    Key{T::load, "body", K::text, "On which body it acts."}.needed().only_for("force|torque"),
    Key{T::load, "point", K::vector3,
        "Where the force acts, in body coordinates."}.in("m").otherwise("[0, 0, 0]").only_for("force"),
    Key{T::load, "value", K::vector3, "Constant force; instead of `table`."}.in("N").only_for("force"),
    Key{T::load, "value", K::vector3, "Constant torque; instead of `table`."}.in("N m").only_for("torque"),
    Key{T::load, "table", K::table,
        "Force as a function of time."}.only_for("force").holding(T::force_table),
    Key{T::load, "table", K::table,
        "Torque as a function of time."}.only_for("torque").holding(T::torque_table),
    Key{T::load, "frame", K::choice,
        "Axes of the values: fixed in the world, or turning with the body."}
        .otherwise("world").only_for("force|torque").one_of("world|body"),
    Key{T::load, "from", K::number, "Acts from then on; default: always."}.in("s").only_for("force|torque"),
    Key{T::load, "until", K::number,
        "Acts until then; default: for ever."}.in("s").only_for("force|torque"),
    Key{T::load, "between", K::names,
        "The two bodies it connects; one may be `\"world\"`."}.needed().only_for("spring"),
    Key{T::load, "points", K::pair,
        "Its ends on each body, in the body's coordinates. Default: the reference points, for the world "
        "its origin."}.in("m").only_for("spring"),
    Key{T::load, "stiffness", K::number,
        "Force for each metre of elongation."}.in("N/m").needed().only_for("spring").within(not_negative),
    Key{T::load, "damping", K::number,
        "Force for each m/s of elongation."}
        .in("N s/m").otherwise("0").only_for("spring").within(not_negative),
    Key{T::load, "free_length", K::number,
        "Length without force."}.in("m").needed().only_for("spring").within(not_negative),
    Key{T::force_table, "times", K::list,
        "Ascending, two or more; two equal ones are a jump (linear only)."}.in("s").needed(),
    Key{T::force_table, "values", K::rows, "One force for each time."}.in("N").needed(),
    Key{T::force_table, "interpolation", K::choice,
        "Straight lines, or a cubic spline with two continuous derivatives."}
        .otherwise("linear").one_of("linear|spline"),
    Key{T::torque_table, "times", K::list,
        "Ascending, two or more; two equal ones are a jump (linear only)."}.in("s").needed(),
    Key{T::torque_table, "values", K::rows, "One torque for each time."}.in("N m").needed(),
    Key{T::torque_table, "interpolation", K::choice,
        "Straight lines, or a cubic spline with two continuous derivatives."}
        .otherwise("linear").one_of("linear|spline"),

    Key{T::time, "start", K::number, "Of the motion."}.in("s").otherwise("0"),
    Key{T::time, "end", K::number, "Of the motion, after `start`."}.in("s").needed(),
    Key{T::time, "elements", K::integer,
        "Of equal length (end - start) / elements; output times and jumps of loads add some where they do "
        "not fall on that grid. Needed, unless `knots` of `[method]` make the elements."}
        .within({1, max_elements}),
    Key{T::time, "output", K::number_or_list,
        "Interval between output times (start and end are output times, too), or their ascending list. "
        "They become element ends, where results are most accurate. Default: all element ends."}.in("s"),
    Key{T::time, "breaks", K::choice,
        "Whether elements end where loads jump or bend."}
        .otherwise("from_loads").one_of("from_loads|ignore"),
    Key{T::time, "accuracy", K::later, "The wished-for error, from which elements follow."},

    Key{T::method, "family", K::choice,
        "lobatto: space-time elements on Gauss-Lobatto points, order 2 degree at their ends; mixed: the "
        "elements of Hesch, Glas and Schuss, with positions, momenta and multipliers as separate fields "
        "and weak rigidity, all solved at once or by blocks; midpoint and endpoint: classical stepping, "
        "order 2 and 1."}
        .otherwise("lobatto").one_of("lobatto|mixed|midpoint|endpoint"),
    Key{T::method, "degree", K::integer,
        "Of the polynomial in each element."}.otherwise("4").only_for("lobatto").within({1, 16}),
    Key{T::method, "degree", K::integer,
        "Of polynomials or splines."}.otherwise("2").only_for("mixed").within({1, 8}),
    Key{T::method, "basis", K::choice,
        "Of all fields. lagrange: continuous polynomials with equidistant nodes; bspline: as smooth as the "
        "knots allow; nurbs: likewise, with `weights`."}
        .otherwise("lagrange").only_for("mixed").one_of("lagrange|bspline|nurbs"),
    Key{T::method, "momentum", K::choice,
        "How the momentum at the ends enters. natural: as the boundary term of Hamilton's law, which keeps "
        "the balances of momentum to rounding; strong: as a value of the momentum field."}
        .otherwise("natural").only_for("mixed").one_of("natural|strong"),
    Key{T::method, "multipliers", K::choice,
        "Functions of the multipliers. equal: those of the positions; lower: one degree less."}
        .otherwise("equal").only_for("mixed").one_of("equal|lower"),
    Key{T::method, "end_multiplier", K::choice,
        "The multiplier where the natural momentum of an end is defined, with equal multipliers: smooth, of "
        "one degree less in that element, or zero, which holds the order of every degree down to 4."}
        .otherwise("smooth").only_for("mixed").one_of("smooth|zero"),
    Key{T::method, "gauss_points", K::integer,
        "Of the quadrature in each element. Default: as many as integrate all polynomials exactly."}
        .only_for("mixed").within({1, 64}),
    Key{T::method, "window", K::integer_or_choice,
        "Number of elements that are solved together. Their equations are the same; conditions at both ends "
        "of time take all, whatever stands here."}
        .otherwise("1").only_for("lobatto").one_of("all").within({1, max_elements}),
    Key{T::method, "window", K::integer_or_choice,
        "Number of elements that are solved together, a block; positions and momenta at the end of a block "
        "begin the next. Conditions at both ends need all."}
        .otherwise("all").only_for("mixed").one_of("all").within({1, max_elements}),
    Key{T::method, "interfaces", K::choice,
        "Between blocks. carry: positions and momenta as they are, with what they violate; project: moved "
        "to the nearest that fulfil rigidity and joints, so that the motion jumps a little."}
        .otherwise("carry").only_for("mixed").one_of("carry|project"),
    Key{T::method, "first_guess", K::choice,
        "Where Newton begins if the state is given at one end. march: from lobatto(2) over the same "
        "elements, which the motion is compared with in the end; steady: straight on, for short blocks."}
        .otherwise("march").only_for("mixed").one_of("march|steady"),
    Key{T::method, "knots", K::list,
        "Of splines: from `start` to `end`, ascending, the first and the last degree + 1 times, others up "
        "to degree times. They make the elements: output times and breaks of loads must be among them. "
        "Default: as smooth as possible on equal elements, with kinks where loads break."}
        .in("s").only_for("mixed"),
    Key{T::method, "weights", K::list,
        "Of NURBS, positive, one for each function: as many as knots, less degree + 1."}.only_for("mixed"),
    Key{T::method, "linear_solver", K::choice,
        "Library for the sparse systems; umfpack is an option when livens is built."}
        .otherwise("eigen").only_for("mixed").one_of("eigen|umfpack"),
    Key{T::method, "tolerance", K::number,
        "Newton stops when its estimated error is below this fraction of the motion in the element; mixed: "
        "of the model's length."}
        .otherwise("1e-12").within({0, 0.1, true}),
    Key{T::method, "max_iterations", K::integer,
        "Of Newton in one element; mixed: in one block."}.otherwise("30").within({1, 1000}),
    Key{T::method, "condition", K::truth,
        "Whether condition numbers are computed: of the whole matrix of the last block (mixed), of that of "
        "all elements, reduced to the free motions (lobatto). They take tens to hundreds of solutions more."}
        .otherwise("false"),

    Key{T::start, "given", K::choice,
        "state: positions and velocities; positions or momenta: those alone, the others are first guesses; "
        "nothing: all are."}.otherwise("state").one_of("state|positions|momenta|nothing"),
    Key{T::start, "initial", K::choice,
        "check: refuse it, naming the joint; project: move positions and velocities to the nearest that "
        "fit, in the metric of the masses."}.otherwise("check").one_of("check|project"),

    Key{T::end, "given", K::choice,
        "Likewise, of `[body.end]`."}.otherwise("nothing").one_of("state|positions|momenta|nothing"),

    Key{T::body_end, "position", K::vector3,
        "Of the reference point, in the world."}.in("m").otherwise("[0, 0, 0]"),
    Key{T::body_end, "directors", K::triple, "Body axes: [d1, d2, d3], each in world axes."},
    Key{T::body_end, "quaternion", K::vector4, "Orientation (w, x, y, z), body to world, of norm 1."},
    Key{T::body_end, "rotation_vector", K::vector3, "Orientation: axis times angle."}.in("rad"),
    Key{T::body_end, "velocity", K::vector3,
        "Of the reference point, world axes."}.in("m/s").otherwise("[0, 0, 0]"),
    Key{T::body_end, "angular_velocity", K::vector3, "World axes."}.in("rad/s"),
    Key{T::body_end, "angular_velocity_body", K::vector3, "Body axes."}.in("rad/s"),
};

std::string_view count_text(KeyType type)
{
    switch (type) {
    case K::vector3: return "three numbers";
    case K::vector4: return "four numbers";
    case K::principal_or_full: return "three numbers or three rows of three numbers";
    case K::triple: return "three rows of three numbers";
    case K::pair: return "two rows of three numbers";
    case K::list: return "a list of numbers";
    case K::rows: return "rows of three numbers";
    case K::number_or_list: return "a number or a list of numbers";
    case K::number_or_table: return "a number or a table";
    default: return "a number";
    }
}

}   // namespace

std::string Range::text() const
{
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const auto number = [](double x) {   // whole numbers without exponent
        const bool is_whole = x == std::floor(x) && std::abs(x) < 1e15;
        return is_whole ? std::to_string(static_cast<long long>(x)) : to_text(x);
    };
    const std::string below = (above ? "> " : ">= ") + number(low);
    if (low == high) return number(low);
    if (high == infinity) return below;
    if (low == -infinity) return "<= " + number(high);
    return above ? below + " and <= " + number(high) : number(low) + " to " + number(high);
}

std::span<const Key> schema_keys() { return keys; }
std::span<const Table> schema_tables() { return tables; }
const Table& schema_table(TableId id) { return tables[static_cast<std::size_t>(id)]; }

std::vector<std::string_view> split_alternatives(std::string_view alternatives)
{
    std::vector<std::string_view> words;
    while (!alternatives.empty()) {
        const std::size_t end = std::min(alternatives.find('|'), alternatives.size());
        words.push_back(alternatives.substr(0, end));
        alternatives.remove_prefix(std::min(end + 1, alternatives.size()));
    }
    return words;
}

bool is_listed(std::string_view alternatives, std::string_view word)
{
    for (const std::string_view w : split_alternatives(alternatives))
        if (w == word) return true;
    return false;
}

std::string quoted_alternatives(std::string_view alternatives)
{
    const std::vector<std::string_view> words = split_alternatives(alternatives);
    std::string text;
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (i > 0) text += i + 1 == words.size() ? " or " : ", ";
        text += '"';
        text += words[i];
        text += '"';
    }
    return text;
}

std::string describe_type(const Key& key)
{
    switch (key.type) {
    case K::flag: return "true";
    case K::truth: return "true or false";
    case K::integer_or_choice:
        return "a whole number, " + key.range.text() + ", or " + quoted_alternatives(key.choices);
    case K::text: return "a text";
    case K::choice: return quoted_alternatives(key.choices);
    case K::names: return "two texts";
    case K::table: return "a table";
    case K::tables: return "tables";
    case K::later: return "";
    case K::integer: return key.range.is_limited() ? "a whole number, " + key.range.text() : "a whole number";
    default: break;
    }
    std::string text(count_text(key.type));
    if (!key.unit.empty()) text += " in " + std::string(key.unit);
    if (key.range.is_limited()) text += (key.type == K::number ? ", " : ", each ") + key.range.text();
    return text;
}

std::vector<double> fallback_numbers(const Key& key)
{
    std::vector<double> numbers;
    const char* p = key.fallback.data();
    const char* const end = p + key.fallback.size();
    while (p < end) {
        double x = 0;
        const std::from_chars_result r = std::from_chars(p, end, x);
        if (r.ec == std::errc()) numbers.push_back(x);
        p = r.ec == std::errc() ? r.ptr : p + 1;
    }
    return numbers;
}

}   // namespace livens
