#include <algorithm>
#include <array>

#include "livens/io/detail/explain.h"
#include "livens/io/diagnostic.h"

namespace livens {

namespace {

struct Page {
    std::string_view code;
    std::string_view text;
};

// Sorted by code. A page says what is wrong, by which law or limit, and what to do.
constexpr std::array pages{
    Page{"axes-not-perpendicular", R"(
A universal joint holds one axis of each body perpendicular to the other. The two `axes` given in the
world are not, so the joint could not be closed at the start. Choose axes with a . b = 0.)"},
    Page{"axis-zero", R"(
A direction of length zero is no direction. Axes may have any other length; they are normalised.)"},
    Page{"backend-missing", R"(
The library for sparse systems that `linear_solver` names was not there when this livens was built. Use
`linear_solver = "eigen"`, which always is, or build with UMFPACK and METIS.)"},
    Page{"basis-nodes", R"(
Nodes of a time basis must ascend. Scenario files cannot lead to it; calls of the library can.)"},
    Page{"body-unknown", R"(
A joint or load refers to a body by a name that no `[[body]]` has. Names are compared to the letter. The
fixed world is called "world".)"},
    Page{"boundary-conditions", R"(
Conditions at start and end must leave one motion: in all, two of positions and momenta at the start and at
the end. The state at the start, or the state at the end ("where did it come from"), or one half at each end.
Momenta at both ends leave the place of everything that can move freely open; then positions are needed at
one end, and the elements mixed need them in any case. `given` in `[start]` and `[end]` says what is known;
the default is the state at the start and nothing at the end, so that a condition at the end needs one less
at the start. `[body.end]` without `[end]` would mean nothing and is refused as well.)"},
    Page{"boundary-method", R"(
The classical rules march from the state at the start. Conditions at the end of time are for the families
`lobatto` and `mixed`; with conditions at both ends all elements are one window.)"},
    Page{"curve-crosses-itself", R"(
A point slides along a curve that crosses itself, or nearly: where it does, the point would be on two
branches, and which one it follows could not be told. Divide the curve, or round it. Calls of the library
only.)"},
    Page{"degree", R"(There is no time basis of this degree.)"},
    Page{"degree-out-of-range", R"(
Elements of the family lobatto have degree 1 to 16, those of the family mixed 1 to 8. A degree p of lobatto
has order 2p at element ends.)"},
    Page{"directors-left-handed", R"(
The directors are perpendicular unit vectors, but d3 = -(d1 x d2): a mirror image, which no rotation
reaches. Swap two of them or change the sign of one.)"},
    Page{"directors-not-orthonormal", R"(
The three directors of a body must be perpendicular unit vectors within 1e-10. Give all sixteen digits, or
a `quaternion` or `rotation_vector` instead.)"},
    Page{"drive-jumps", R"(
A joint cannot follow a drive that jumps, or whose rate does: bodies would need an infinite force. Let it
begin and end smoothly. Calls of the library only.)"},
    Page{"drives-method", R"(
Only elements of the family lobatto follow drives, joints that depend on time. Calls of the library only.)"},
    Page{"duplicate-key", R"(
A key may be given once in its table; TOML has no rule by which one of two values would win.)"},
    Page{"empty-file", R"(
The file has no content. A scenario needs at least `format`, one `[[body]]` and `[time]`.)"},
    Page{"format-first", R"(
A warning: `format` should be the first key of the file, because it decides how everything else is read.)"},
    Page{"format-version", R"(
The file says that it is written in a version of the format that this livens does not know. Nothing else
of it is checked. A newer livens may read it.)"},
    Page{"gauss-points-out-of-range", R"(
The number of Gauss points in an element is out of range. Without `gauss_points` there are as many as
integrate all polynomials of the method exactly; far fewer leave functions that no point sees.)"},
    Page{"gear-ratio", R"(
Angles are coupled in a ratio that is not one of whole numbers up to 10000, as numbers of teeth are. After a
turn of one wheel the other would stand anywhere, and positions would not tell whether the coupling holds.
Calls of the library only.)"},
    Page{"inertia-negative", R"(
A principal moment of inertia is negative. It is an integral of squares times mass.)"},
    Page{"inertia-not-symmetric", R"(The matrix of inertia must equal its transpose.)"},
    Page{"inertia-triangle", R"(
Principal moments satisfy the triangle inequality J1 + J2 >= J3 for every distribution of mass, because J1
+ J2 - J3 is twice an integral of a square. Moments that break it belong to no body. Equality is allowed:
it is a flat body or a needle. Common causes: moments about another point than the centre of mass,
products of inertia with the wrong sign, or moments and axes in different order.)"},
    Page{"internal", R"(A fault of livens itself. Please report it with the scenario.)"},
    Page{"io-damaged", R"(
A result file does not fit the checksums in it, or its parts contradict each other: it was damaged on its
way or edited by another program. The message names the part. Solve the scenario again; if the header and
the variable `scenario` can still be read (`ncdump -v scenario`), it is in there.)"},
    Page{"io-directory", R"(The path leads to a directory where a scenario file is expected.)"},
    Page{"io-foreign", R"(
The file is no run of livens: it is no classic NetCDF (CDF-1, CDF-2, CDF-5), or has no `livens_format`. Runs
are what `livens solve` writes. NetCDF-4 is HDF5, another format.)"},
    Page{"io-not-a-file", R"(
Results are files on a disk, which are replaced as a whole and read where needed. Devices, pipes and
/dev/stdout cannot be that. Write to a file and copy it.)"},
    Page{"io-not-found", R"(There is no file of this name.)"},
    Page{"io-truncated", R"(
A result file is shorter than its header says: a copy or a download was not finished, or a disk was full.)"},
    Page{"io-unreadable", R"(
The file exists, but reading it failed: permission is missing or the device reports an error.)"},
    Page{"io-version", R"(
The file was written by a livens with another major format. Solve its scenario again, or use that livens.)"},
    Page{"joint-branch", R"(
A revolute joint makes one axis of each body coincide. Its conditions also hold when one of the two points the
other way, and at the start they do. Reverse one of the two `axes`, or turn one of the bodies.)"},
    Page{"joint-contradiction", R"(
Joints are redundant where some of their conditions follow from others; that is legal, and such conditions
are dropped. Here one of them contradicts the others: no position of the bodies fulfils them all. Check
points, axes and lengths of the joint named and of those that close a loop with it.)"},
    Page{"joint-empty", R"(
A joint without any row holds nothing. Scenario files cannot lead to it; calls of the library can.)"},
    Page{"joint-method", R"(
Only elements of the family lobatto hold joints whose rows are no quadratic forms: screws, gears and slots.
Calls of the library only.)"},
    Page{"joint-needs-directors", R"(
A point mass has no orientation and no other point than its own. It takes spherical joints and rods at its
own point; weld, revolute and universal joints need a rigid body.)"},
    Page{"joint-placement", R"(
A joint is placed either by `at` (a point in the world at the start) or by `points` (a point on each
body). A revolute joint needs `axis` with `at` and `axes` with `points`, a universal joint always `axes`.
A rod takes `points` and `length` only.)"},
    Page{"joint-row", R"(
A row of a joint is inconsistent. Scenario files cannot lead to it; calls of the library can.)"},
    Page{"joint-scale", R"(The length that violations of a joint are measured by must be positive.)"},
    Page{"joint-second", R"(
The second of a joint must be a body. Scenario files cannot lead to it; calls of the library can.)"},
    Page{"joint-self", R"(A joint connects two different bodies, or a body and the world.)"},
    Page{"knots-decreasing", R"(
Knots of splines ascend; equal ones may follow each other. See `knots` in docs/scenario.md.)"},
    Page{"knots-few", R"(
A clamped knot vector of degree p has at least 2 p + 2 knots: the first and the last p + 1 times.)"},
    Page{"knots-mesh", R"(
Knots make the time elements, so that everything that must be an element end must be a knot: start and end of
`[time]`, output times, and instants where loads jump or bend (unless `breaks = "ignore"`). `elements` may be
left out; if it is given, it must be the number of knot spans that are not empty. Without `output` all knots
are output times.)"},
    Page{"knots-multiplicity", R"(
An inner knot may stand at most degree times. Once makes the smoothest splines, degree times a kink, as the
momentum has where a load jumps; once more would tear the motion apart.)"},
    Page{"knots-not-clamped", R"(
The first and the last knot must stand degree + 1 times, so that the splines have positions at both ends.)"},
    Page{"knots-not-finite", R"(
Knots are instants; nan and inf are none.)"},
    Page{"load-empty", R"(
A load needs a function for its forces. Scenario files cannot lead to it; calls of the library can.)"},
    Page{"load-needs-directors", R"(
The load needs the orientation of a body, but this one is a point mass. A point mass takes forces in world
axes at its own point, and springs that end there; no torques and no forces that turn with it.)"},
    Page{"load-negative", R"(Stiffness, damping and free length of a spring must not be negative.)"},
    Page{"load-never-acts", R"(
A warning: the interval in which the load acts lies outside the time that is solved for, so that the load
does nothing. Check `from` and `until` against `start` and `end` of `[time]`.)"},
    Page{"load-self", R"(
A load acts on a body, a spring between two different bodies or a body and the world.)"},
    Page{"load-value", R"(
A force or torque needs either a constant `value` or a `table` of values, not both.)"},
    Page{"load-without-tangent", R"(
A load that depends on position or velocity must bring its derivative. Scenario files cannot lead to it;
calls of the library can.)"},
    Page{"mass-conflict", R"(
Mass and inertia must follow from one set of keys: `shape` with `density`, `shape` with `mass`, or `mass`
with `inertia` and without a shape.)"},
    Page{"mass-missing", R"(
The body's mass properties do not follow from what is given. With a shape it needs `density` or `mass`,
without one both `mass` and `inertia`; a point mass needs `mass`.)"},
    Page{"mass-not-positive", R"(The mass of a body must be positive.)"},
    Page{"mass-singular", R"(
The method divides by the mass matrix of every body, and this one is singular: a needle, a lamina or any body
with J1 + J2 = J3, whose Euler tensor has no inverse. The family lobatto takes such bodies as they are; or
give the body a little thickness.)"},
    Page{"max-iterations-out-of-range", R"(Newton's method needs at least one iteration in each element.)"},
    Page{"misplaced-key", R"(
The key exists in this table, but not for the `type` or `family` that is chosen: a rod has no axis, a
torque no point. Livens ignores nothing silently, so this is an error.)"},
    Page{"missing-key", R"(
The table lacks a key that has no default. The line shown is the table's header.)"},
    Page{"mixed-block", R"(
The number of elements that are solved at once is out of range. It is at least 1 (splines: at least the
degree) and at most the number of elements; a knot vector or weights belong to the whole time and need
`window = "all"`, as conditions at the end do.)"},
    Page{"mixed-pairing", R"(
This choice of momentum, multipliers, basis and quadrature makes a system that has no solution, or more than
one. Regular are: natural with equal or lower multipliers, strong with equal multipliers on Lagrange
polynomials, strong with lower ones on splines; all with exact quadrature.)"},
    Page{"name-duplicate", R"(
Two bodies, two joints or two loads have one name. A joint without a name is called by its type and its
bodies, as in `rod world-upper`; where that is not unique, give names.)"},
    Page{"name-empty", R"(A name must have at least one character.)"},
    Page{"name-invalid", R"(A name has at most 200 bytes and no control characters.)"},
    Page{"name-reserved", R"("world" is the fixed world, to which joints and springs may be attached.)"},
    Page{"no-bodies", R"(A scenario without bodies has no motion. Add a `[[body]]`.)"},
    Page{"no-elements", R"(At least one time element is needed.)"},
    Page{"not-finite", R"(nan and inf can be written in TOML, but are no value of any quantity here.)"},
    Page{"not-in-this-version", R"(
The key or choice is known and planned, but this version of livens cannot do it. It is refused rather than
ignored.)"},
    Page{"not-text", R"(
A scenario is text in UTF-8 without control characters. The first byte that breaks this is shown; binary
files contain zeros.)"},
    Page{"number-overflow", R"(
The number is larger than the largest or smaller than the smallest of 64 bits.)"},
    Page{"orientation-conflict", R"(
A body's orientation at the start is given by one of `directors`, `quaternion` and `rotation_vector`.)"},
    Page{"out-of-range", R"(
The value lies outside the range that the reference page docs/scenario.md states for its key.)"},
    Page{"point-mass", R"(
A point mass has a mass, a position and a velocity. Everything that needs an orientation or an extent has
no meaning for it, and joints can hold it at its own point only.)"},
    Page{"point-with-directors", R"(
A point mass has no directors. Scenario files cannot lead to it; calls of the library can.)"},
    Page{"quadrature-points", R"(
There is no such quadrature rule. Scenario files cannot lead to it; calls of the library can.)"},
    Page{"quaternion-norm", R"(
Rotations are quaternions of norm 1. This one is off by more than 1e-6, which is more than rounded digits
explain; the parts may be in another order than (w, x, y, z). Within 1e-6 it is normalised.)"},
    Page{"quaternion-zero", R"(The zero quaternion is no rotation.)"},
    Page{"rates-conflict", R"(
A body's spin at the start is given by one of `angular_velocity` (world axes), `angular_velocity_body` and
`director_rates`.)"},
    Page{"resource-limit", R"(
The scenario asks for more than livens is prepared to take: 16 MiB of text, 2 000 000 values, 1000 bodies,
joints or loads, 10 000 000 time elements or output times, 8 GiB of motion, or 8 GiB for the system of one
block of mixed elements (72 kB a rigid body and time node; use smaller blocks). The limits keep a slip of the
pen, or a hostile file, from filling the memory of the machine. The program ends with exit code 5.)"},
    Page{"rod-length", R"(
A rod holds two points at a fixed positive distance. Points that coincide are a spherical joint.)"},
    Page{"sample-exact-method", R"(
`livens sample --exact` solves one shortened element from its start. The elements of the family mixed depend
on all others of their block, so this cannot be had for them. Sample without `--exact`, or make the instant
an output time.)"},
    Page{"samples", R"(A number of samples must not be negative. Calls of the library only.)"},
    Page{"shape", R"(A shape is exactly one of box, sphere, cylinder, capsule, ellipsoid, cone and point.)"},
    Page{"size-inner-radius", R"(The bore of a tube must be narrower than the tube.)"},
    Page{"size-not-positive", R"(Edges, radii and lengths of a shape must be positive.)"},
    Page{"spin-without-inertia", R"(
The mass matrix may be singular (a needle does not resist a spin about itself), but then joints must hold
that motion. Here a motion is neither held nor carries inertia, so its acceleration is not determined.
Give the body a small moment of inertia, make it a point mass, or hold it by another joint.)"},
    Page{"spline-degree", R"(
Splines of degree p need at least p elements. Take more elements, larger blocks or a lower degree.)"},
    Page{"start-position", R"(
The bodies as placed do not fulfil a joint: `|Phi| / scale` is above 1e-9. Correct positions or points, or
let livens move the bodies to the nearest position that fits with `initial = "project"` in `[start]`. A
joint that cannot be closed at all says the same.)"},
    Page{"start-size", R"(
A start needs the state of every body. Scenario files cannot lead to it; calls of the library can.)"},
    Page{"start-velocity", R"(
The velocities at the start break a joint, or `director_rates` deform the triad: a rigid body has d_a .
d_b constant, so d_a' . d_b + d_a . d_b' = 0. Correct them, or take the nearest velocities that fit, in
the metric of the masses, with `initial = "project"` in `[start]`. The nearest are not always those that
were meant: look at the note of the run.)"},
    Page{"table-order", R"(
Times of a table must ascend. Two equal times are a jump, in linear tables only.)"},
    Page{"table-size", R"(A table needs at least two rows and one row of values for each time.)"},
    Page{"table-slope", R"(
Two rows of a table are so close in time that the slope between them is no finite number.)"},
    Page{"time-elements", R"(The number of time elements is out of range.)"},
    Page{"time-end", R"(The end of time must be finite and lie after its start.)"},
    Page{"time-out-of-range", R"(The instant lies outside the motion.)"},
    Page{"time-output", R"(
Output times must be finite, ascend and lie between start and end of the motion; an interval between them
must be positive.)"},
    Page{"time-outside", R"(
The motion is not known at this instant: it lies outside the interval that was solved.)"},
    Page{"time-resolution", R"(
Time elements would be so short that their ends cannot be told apart in double precision. Use fewer
elements, or a start nearer to zero.)"},
    Page{"time-start", R"(The start of time must be finite.)"},
    Page{"tolerance-out-of-range", R"(
The tolerance of Newton's method is relative and must lie between 0 and 1.)"},
    Page{"toml-syntax", R"(
The file is not TOML 1.0. Reading stops at the first such error, so there may be more. Frequent causes: a
number with a unit without quotes, a decimal comma, a text without quotes, a bracket that is not closed.)"},
    Page{"too-deep", R"(Lists, tables and dotted keys may be nested 64 levels deep. Scenarios need four.)"},
    Page{"unit", R"(
A text stands for a number with a unit, as in "5 mm" or "30 deg". The text could not be read that way, or
the unit is that of another quantity. The page docs/scenario.md lists the units.)"},
    Page{"unknown-choice", R"(The key takes one of a few words. Letters count as they are.)"},
    Page{"unknown-key", R"(This table has no key of that name. The nearest known one is proposed.)"},
    Page{"weights-count", R"(
NURBS have one weight for each function: as many as there are knots, less degree + 1.)"},
    Page{"weights-not-positive", R"(
Weights of NURBS must be positive and finite: otherwise the denominator could vanish inside an element.)"},
    Page{"window", R"(
A window of the zig-zag indicator holds a few samples at least. Calls of the library only.)"},
    Page{"window-order", R"(
A load that acts `from` one instant `until` another needs the second to be later.)"},
    Page{"window-out-of-range", R"(
The number of elements that are solved together is at least one, or "all".)"},
    Page{"wrong-type", R"(
The value is of another kind than its key takes: a text for a number, two numbers for three.)"},
};

}   // namespace

std::string_view explain(std::string_view code)
{
    const auto found = std::lower_bound(pages.begin(), pages.end(), code,
                                        [](const Page& page, std::string_view c) { return page.code < c; });
    if (found == pages.end() || found->code != code) return {};
    std::string_view text = found->text;
    if (text.front() == '\n') text.remove_prefix(1);   // a long page begins below its code
    return text;
}

std::vector<std::string_view> diagnostic_codes()
{
    std::vector<std::string_view> codes;
    for (const Page& page : pages) codes.push_back(page.code);
    return codes;
}

std::string diagnostics_markdown()
{
    std::string out = R"(# What livens says about scenarios and files

Every message has a code, `error[unknown-key]: ...`; `livens explain CODE` prints its page. Up to twenty are
shown in one run. `--diagnostics=json` and `--diagnostics=gnu` print them for machines and editors.
)";
    for (const Page& page : pages) {
        out += "\n## " + std::string(page.code) + "\n\n";
        out += std::string(explain(page.code)) + "\n";
    }
    return out;
}

}   // namespace livens
