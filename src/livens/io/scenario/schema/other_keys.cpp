// SPDX-License-Identifier: BSD-3-Clause
// Keys that users of other programs write, by table. Words are spelled as without_case() has them. An entry
// that names a key (`meant`) counts only where the table has that key.
#include "livens/io/scenario/schema/other_keys.h"

#include <algorithm>
#include <cctype>

namespace livens::inline io_internal {

namespace {

/// What stands in for one of `words` in a table of this heading and kind (empty: of any kind). Without a help
/// the key is only called otherwise. `@` in a help stands for the name of the part, `%` for its coordinate.
struct OtherKey {
    std::string_view heading, kind, words, meant, help = {};
};

constexpr std::string_view no_step = "no step size is needed: `accuracy` chooses the time elements, `output` "
                                     "says at which instants results are "
                                     "wanted (an interval, as output = 0.01, or a list)";
constexpr std::string_view orientation =
    "an orientation is one of rotation_vector = [\"0 deg\", \"30 deg\", \"0 deg\"] (axis times angle), "
    "quaternion = [w, x, y, z] and directors = [d1, d2, d3] (the columns of the rotation matrix)";
constexpr std::string_view own_load =
    "this joint has no coordinate of its own to act along; between its bodies a [[load]] acts, of type "
    "\"spring\" between two points or \"bushing\"";
constexpr std::string_view along_which =
    "it has two coordinates: say along which, as in angle = { damping = 0.1 } or displacement = { stiffness "
    "= 100, rest = 0.2 }";
constexpr std::string_view stop =
    "joint limits are a stop of your own: [[load]] with type = \"actuator\", joint = \"@\", "
    "inputs = { q = \"@.%\" } and expression = \"-1e4*max(q - 1, 0) - 1e4*min(q + 1, 0)\"";
constexpr std::string_view friction =
    "friction is a load on the joint: [[load]] with type = \"actuator\", joint = \"@\", "
    "inputs = { w = \"@.%_rate\" } and expression = \"-0.1*tanh(w/0.01)\"; viscous: 'damping' of the joint "
    "itself";
constexpr std::string_view motor = "a motor of known motion is a [[drive]] with type = \"joint\", joint = "
                                   "\"@\" and 'rate', 'step' or 'expression'; "
                                   "of known torque, a [[load]] with type = \"actuator\" and joint = \"@\"";
constexpr std::string_view where_it_starts =
    "a joint starts where its bodies are placed; `coordinate` names that angle (or displacement), `rate` "
    "gives its "
    "speed, and [[start.coordinates]] moves the joint to another one";
constexpr std::string_view straight_slot = "a straight slot along an axis is \"point_on_line\"; "
                                           "\"point_in_plane\", where nothing has to hold the pin "
                                           "sideways";
constexpr std::string_view two_points =
    "its ends are 'points', one on each body in that body's own coordinates (on the world: in the world)";
constexpr std::string_view along_a_joint =
    "along a joint, between its bodies, acts type = \"actuator\": one number of 'value', 'table' or "
    "'expression'";
constexpr std::string_view free_length = "its length without force is 'free_length'";
constexpr std::string_view no_contact =
    "there is no contact between bodies; a floor or stop is a load whose expression holds max(..), as in "
    "expression = \"1e4*max(-z, 0)\" of a point sensor's z";
constexpr std::string_view along_words =
    "damping stiffness rest d c b k spring springstiffness springconstant springrate jointstiffness "
    "viscousdamping viscousfriction dampingcoefficient jointdamping damper dashpot springref springreference "
    "restangle springdamper dynamics compliance";
constexpr std::string_view two_bodies =
    "the bodies are between = [\"world\", \"arm\"]: the first one carries the second";
constexpr std::string_view of_body = "forces are [[load]] tables with body = \"@\"";
constexpr std::string_view vector_value =
    "'value' is the whole vector: value = [10, 0, 0] is 10 along x; frame = \"body\" turns it with the body";
constexpr std::string_view of_time = "it belongs into [time]";
constexpr std::string_view newton = "the error of the motion is bounded by `accuracy` in [time]; `tolerance` "
                                    "here is that of Newton's iteration";

constexpr std::string_view top = "top of the file";

// The first that fits counts: what has `meant` needs that key, and stands before what is said of the same
// word where the key is missing.
constexpr OtherKey other_keys[] = {
    // the file
    {top, "", "bodies rigidbody rigidbodies links link part parts", "body",
     "each body is a table [[body]] of its own"},
    {top, "", "joints constraint constraints connection connections", "joint",
     "each joint is a table [[joint]] of its own"},
    {top, "", "loads force forces springs spring torque damper dampers actuator actuators", "load",
     "each load is a table [[load]] of its own, with a 'type'"},
    {top, "", "drives motor motors motion motions", "drive",
     "a motor of known motion is a [[drive]]; of known torque, a [[load]] with type = \"actuator\""},
    {top, "", "sensors measure measures request requests marker markers outputs probe", "sensor",
     "what is measured is a table [[sensor]]; everything else is in the results anyway"},
    {top, "", "simulation solver integrator settings options config run", "time",
     "time and accuracy stand in [time], as end = 2; how it is solved, in [method]"},
    {top, "", "dt step stepsize timestep steps", "", no_step},
    {top, "", "duration tend tfinal endtime stoptime tstop", "", "it is 'end' in [time]: end = 2"},
    {top, "", "accuracy tolerance tol rtol atol", "", "it is 'accuracy' in [time]: accuracy = 1e-8"},
    {top, "", "name description comment", "title"},
    {top, "", "g gravitation gravityvector acceleration", "gravity", "gravity = [0, 0, -9.81]"},
    {top, "", "version schema fileformat", "format", "format = 1"},
    {top, "", "units unit", "",
     "numbers are in SI units; others are written with the number, in quotes: \"5 mm\", \"30 deg\""},
    {top, "", "world ground base inertialframe", "",
     "the world needs no table: joints name it, as between = [\"world\", \"arm\"]"},
    {top, "", "initial initialconditions ic state initialstate", "start",
     "bodies state where they start and how fast ('position', 'velocity', ..); joints by "
     "[[start.coordinates]]"},
    {top, "", "array arrays loop for foreach pattern copies repeats replicate", "repeat",
     "tables that stand many times: [[repeat]] with count = 10 and [[repeat.body]], [[repeat.joint]], .."},
    {top, "", "constants variables vars params param define defines let", "parameters",
     "constants stand in [parameters]"},
    // bodies
    {"[[body]]", "", "euler eulerangles rpy rollpitchyaw orientation rotation rot attitude angles angle ori",
     "", orientation},
    {"[[body]]", "", "r rotationmatrix matrix dcm rotmat axes frame triad basis", "directors",
     "directors = [d1, d2, d3], the columns of the rotation matrix one after the other"},
    {"[[body]]", "", "quat q quaternions orientationquaternion", "quaternion",
     "quaternion = [w, x, y, z], the scalar first"},
    {"[[body]]", "", "axisangle rotvec rotationaxis", "rotation_vector",
     "rotation_vector: the axis times the angle, as [0, \"30 deg\", 0]"},
    {"[[body]]", "", "pos xyz location origin translation place x coordinates", "position"},
    {"[[body]]", "", "com cm cg cog center centre centerofgravity centreofgravity centreofmass masscenter",
     "center_of_mass", "center_of_mass = [x, y, z], in the body's own coordinates"},
    {"[[body]]", "", "vel v initialvelocity linearvelocity speed xdot", "velocity"},
    {"[[body]]", "", "omega w angvel angularrate angularspeed spin rotationalvelocity initialangularvelocity",
     "angular_velocity"},
    {"[[body]]", "", "m weight", "mass", "mass = 3 (kg) or \"300 g\""},
    {"[[body]]", "", "rho", "density"},
    {"[[body]]", "", "material", "density",
     "density = 7850 (kg/m^3) of steel, 2700 of aluminium, 1000 of water"},
    {"[[body]]", "",
     "i j moi momentofinertia momentsofinertia inertiatensor inertiamatrix rotationalinertia ixx iyy izz",
     "inertia", "inertia = [Ixx, Iyy, Izz] about the centre of mass, or three rows of three numbers"},
    {"[[body]]", "", "box sphere cylinder capsule ellipsoid cone mesh", "shape",
     "it stands in the shape: shape = { box = [1, 0.1, 0.1] }"},
    {"[[body]]", "", "geometry geom solid type kind form size dimensions radius length file", "shape",
     "shape = { box = [1, 0.1, 0.1] }, { sphere = 0.1 }, { cylinder = { radius = 0.1, length = 1 } }, { mesh "
     "= \"part.stl\" }"},
    {"[[body]]", "", "fixed static grounded isfixed kinematic fixedbase immovable", "",
     "a body that stands still is welded to the world: [[joint]] with type = \"weld\" and between = "
     "[\"world\", \"@\"]"},
    {"[[body]]", "", "collision collisions contact restitution friction", "", no_contact},
    {"[[body]]", "", "force torque forces loads gravity damping", "", of_body},
    {"[[body]]", "", "parent joint joints", "",
     "bodies are tied by [[joint]] tables: between = [\"world\", \"@\"]"},
    {"[[body]]", "", "id label title", "name"},
    {"[[body]]", "", "colour", "color"},
    // joints
    {"[[joint]]", "gear", "between bodies", "joints",
     "it couples two joints by their names: joints = [\"a\", \"b\"]"},
    {"[[joint]]", "rack_and_pinion", "between bodies", "joints",
     "it couples two joints by their names: joints = [\"a\", \"b\"]"},
    {"[[joint]]", "coupling", "between bodies joints joint coordinates factors coefficients ratio polycoef",
     "terms", "terms = { \"left.angle\" = 1, \"right.angle\" = -2 }: a factor for each coordinate"},
    {"[[joint]]", "rod", "at", "points", two_points},
    {"[[joint]]", "rod", "distance l restlength", "length"},
    {"[[joint]]", "slot", "at", "points", straight_slot},
    {"[[joint]]", "slot", "at axis", "", straight_slot},
    {"[[joint]]", "spherical", "axis", "", "a ball joint has no axis; what turns about one is \"revolute\""},
    {"[[joint]]", "",
     "parent child bodies body body1 body2 bodya bodyb link link1 link2 links parentlink childlink base "
     "follower "
     "predecessor successor i j first second frame1 frame2 connects",
     "between", two_bodies},
    {"[[joint]]", "",
     "limit range lower upper min max stop stops jointlimits lowerlimit upperlimit limited hardstop "
     "jointrange",
     "limits",
     "limits = [\"-90 deg\", \"90 deg\"], of the coordinate: rigid stops, or springs by limit_law = "
     "\"penalty\""},
    {"[[joint]]", "", "armature rotor reflectedinertia motorinertia gearedinertia", "rotor_inertia"},
    {"[[joint]]", "", "limitspring limitk stopstiffness contactstiffness", "limit_stiffness"},
    {"[[joint]]", "", "limitc stopdamping contactdamping dissipation", "limit_damping"},
    {"[[joint]]", "",
     "limits limit range lower upper min max stop stops jointlimits lowerlimit upperlimit limited hardstop",
     "", stop},
    {"[[joint]]", "", "friction coulomb frictionloss mu coulombfriction stiction frictioncoefficient", "",
     friction},
    {"[[joint]]", "",
     "d c b viscousdamping viscousfriction dampingcoefficient jointdamping damper dashpot springdamper "
     "dynamics",
     "damping"},
    {"[[joint]]", "", "k spring springstiffness springconstant springrate jointstiffness compliance",
     "stiffness"},
    {"[[joint]]", "", "springref springreference restangle neutral equilibrium", "rest"},
    {"[[joint]]", "cylindrical", along_words, "", along_which},
    {"[[joint]]", "screw", along_words, "", along_which},
    {"[[joint]]", "", along_words, "", own_load},
    {"[[joint]]", "",
     "motor drive actuator actuation torque force effort speed velocity omega rpm motion control servo", "",
     motor},
    {"[[joint]]", "",
     "angle q q0 initial initialangle initialposition initialvalue displacement ref theta qpos phi state "
     "start",
     "", where_it_starts},
    {"[[joint]]", "", "initialvelocity initialrate qdot initialspeed", "rate"},
    {"[[joint]]", "", "origin location pos point position anchor pivot xyz center centre place", "at",
     "at = [x, y, z], the joint's point at the start, in the world"},
    {"[[joint]]", "", "direction dir normal rotationaxis axisofrotation hinge line", "axis",
     "axis = [0, 1, 0], at the start, in world axes"},
    {"[[joint]]", "", "axis1 axis2 axisa axisb", "axes"},
    {"[[joint]]", "", "kind jointtype", "type"},
    {"[[joint]]", "", "id label", "name"},
    {"[[joint]]", "", "lead", "pitch"},
    {"[[joint]]", "", "euler rpy orientation rotation quaternion", "",
     "a joint takes its directions from 'axis' (world axes, at the start), or from 'frames', one on each "
     "body"},
    // drives
    {"[[drive]]", "", "function func formula f expr motion angle position displacement", "expression",
     "expression = \"0.5*sin(2*t)\", a formula of the coordinate itself"},
    {"[[drive]]", "", "velocity speed omega rpm w angularvelocity", "rate",
     "rate = 6.28, constant, in rad/s or m/s"},
    {"[[drive]]", "", "sine sin oscillation", "harmonic", "harmonic = { amplitude = 0.5, frequency = 2 }"},
    {"[[drive]]", "", "ramp move smoothstep", "step", "step = { from = 0, until = 1, rise = 1.57 }"},
    {"[[drive]]", "", "constant hold target setpoint", "value"},
    {"[[drive]]", "", "start begin t0 tstart", "from"},
    {"[[drive]]", "", "end stop t1 tend", "until"},
    {"[[drive]]", "", "spline curve data profile trajectory", "table",
     "table = { times = [0, 1, 2], values = [0, 1, 0] }"},
    {"[[drive]]", "", "torque force", "",
     "a known torque or force is a [[load]] with type = \"actuator\" and a 'joint'"},
    {"[[drive]]", "", "kp kd p d gain gains stiffness damping", "",
     "a drive follows its law exactly; a controller is a [[load]] with type = \"actuator\", 'inputs' and an "
     "'expression'"},
    {"[[drive]]", "", "axis dof component", "coordinate",
     "coordinate = \"angle\" or \"displacement\", of a joint that has both"},
    // loads
    {"[[load]]", "torque", "joint between", "", along_a_joint},
    {"[[load]]", "force", "joint between", "", along_a_joint},
    {"[[load]]", "force", "points", "point", "one body, one 'point' in its coordinates"},
    {"[[load]]", "force", "at position location applicationpoint anchor r offset", "point",
     "'point', in the coordinates of the body"},
    {"[[load]]", "force", "magnitude force vector f direction dir axis fx fy fz x y z amplitude", "value",
     vector_value},
    {"[[load]]", "torque", "magnitude torque moment vector direction dir axis m tx ty tz x y z amplitude",
     "value", vector_value},
    {"[[load]]", "actuator", "torque force effort magnitude moment control ctrl u power amplitude", "value",
     "value = 1 (N m about an axis, N along one); a function of time is 'table' or 'expression'"},
    {"[[load]]", "actuator", "between body bodies", "joint",
     "it acts along a joint, between its bodies: joint = \"pivot\""},
    {"[[load]]", "actuator", "kp kd gain gains p d", "expression",
     "a controller is a formula: inputs = { q = \"pivot.angle\", w = \"pivot.angle_rate\" }, expression = "
     "\"-10*q - w\""},
    {"[[load]]", "actuator", "rate speed velocity angle position omega", "",
     "a known motion is a [[drive]] with type = \"joint\"; an actuator is given its force or torque"},
    {"[[load]]", "actuator", "function func formula f expr equation law", "expression"},
    {"[[load]]", "force", "function func formula expr equation law", "expression"},
    {"[[load]]", "torque", "function func formula expr equation law", "expression"},
    {"[[load]]", "spring", "at anchors ends attachments", "points", two_points},
    {"[[load]]", "spring",
     "length restlength naturallength l0 length0 equilibriumlength unstretchedlength freelength",
     "free_length", free_length},
    {"[[load]]", "spring", "k springconstant springrate springstiffness", "stiffness"},
    {"[[load]]", "spring", "c d b dampingcoefficient viscousdamping damper", "damping"},
    {"[[load]]", "spring", "restangle angle0 freeangle neutral theta0 reference equilibrium ref springref",
     "rest"},
    {"[[load]]", "spring", "body bodies body1 body2 bodya bodyb links parent child", "between",
     "between = [\"world\", \"arm\"]"},
    {"[[load]]", "spring", "force0 prestress pretension f0 offset", "preload"},
    {"[[load]]", "bushing", "k", "stiffness"},
    {"[[load]]", "bushing", "c", "damping"},
    {"[[load]]", "bushing", "body bodies body1 body2 bodya bodyb parent child", "between"},
    {"[[load]]", "drag", "c cd coefficient damping b viscosity", "linear",
     "'linear' in N s/m (force by speed), 'quadratic' in N s^2/m^2 (by its square, half the air's density "
     "times area times cd)"},
    {"[[load]]", "drag", "wind", "medium"},
    {"[[load]]", "", "target on to link appliedto part", "body", "'body', by its name"},
    {"[[load]]", "", "start begin t0 tstart starttime", "from"},
    {"[[load]]", "", "end stop t1 tend stoptime endtime", "until"},
    {"[[load]]", "", "relativeto local coordinates system csys axes", "frame",
     "frame = \"world\" (default) or \"body\": the axes of the values"},
    {"[[load]]", "", "kind loadtype", "type"},
    {"[[load]]", "", "id label", "name"},
    {"[[load]]", "", "spline curve data profile", "table"},
    // sensors
    {"[[sensor]]", "", "at position location", "point", "'point', in the coordinates of the body"},
    {"[[sensor]]", "", "id label", "name"},
    {"[[sensor]]", "", "kind quantity measure", "type"},
    {"[[sensor]]", "", "bodies body1 body2 from", "between"},
    // time
    {"[time]", "",
     "step dt h stepsize timestep steps nsteps numsteps numberofsteps fixedstep maxstep minstep hmax hmin "
     "hini "
     "initialstep firststep intervals substeps",
     "", no_step},
    {"[time]", "", "tolerance tol rtol atol reltol abstol eps error precision toleranceerror", "accuracy",
     "accuracy = 1e-8, the largest error of positions (in model lengths) and orientations (rad)"},
    {"[time]", "",
     "duration t tend stop stoptime final tfinal finaltime tf until length endtime to tstop tmax "
     "simulationtime",
     "end"},
    {"[time]", "", "t0 begin tstart from starttime initial", "start"},
    {"[time]", "",
     "fps rate outputinterval outputstep outputdt saveevery sampling sample samples sampletime dtout "
     "outputtimes teval "
     "saveat interval dtoutput outputs frames framerate hz",
     "output", "output = 0.01 (s, an interval), or a list of instants"},
    {"[time]", "", "nelements numberofelements", "elements"},
    {"[time]", "", "family method solver integrator degree type", "",
     "how it is solved stands in [method], as family = \"radau\"; it may be left out"},
    // method
    {"[method]", "", "type name method solver integrator scheme kind algorithm", "family"},
    {"[method]", "", "order p", "degree"},
    {"[method]", "", "rtol atol tol reltol abstol error precision", "", newton},
    {"[method]", "", "maxiter maxiterations iterations maxit nmax newtoniterations", "max_iterations"},
    {"[method]", "", "step dt h stepsize timestep maxstep steps nsteps", "", no_step},
    {"[method]", "", "accuracy elements end start output", "", of_time},
    // start
    {"[start]", "", "position velocity bodies body", "",
     "a body's start stands in its [[body]]: 'position', 'velocity', .."},
    {"[start]", "", "angle angles q joints joint coordinate", "coordinates",
     "coordinates of joints: [[start.coordinates]] with 'joint' and the coordinate's number"},
    {"[start]", "", "project projected assemble consistent", "initial", "initial = \"project\""},
};

bool holds_word(std::string_view words, std::string_view word)
{
    for (std::size_t at = 0; at < words.size();) {
        const std::size_t end = std::min(words.find(' ', at), words.size());
        if (words.substr(at, end - at) == word) return true;
        at = end + 1;
    }
    return false;
}

/// The help with the part's name where it says `@`, and its coordinate where it says `%`.
std::string about(std::string_view help, std::string_view name, std::string_view kind)
{
    const bool slides = kind == "prismatic" || kind == "point_on_line";
    std::string text;
    for (const char c : help) {
        if (c == '@')
            text += name.empty() ? "NAME" : name;
        else if (c == '%')
            text += slides ? "displacement" : "angle";
        else
            text += c;
    }
    return text;
}

}   // namespace

std::string without_case(std::string_view word)
{
    std::string plain;
    for (const char c : word)
        if (c != '_' && c != '-' && c != ' ')
            plain += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return plain;
}

KeyAdvice instead_of_key(const Table& table, int kind, std::string_view key, std::string_view name)
{
    const std::string word = without_case(key);
    if (word.empty()) return {};
    const std::string_view own =
        kind == any_kind ? std::string_view() : table.kinds[static_cast<std::size_t>(kind)].word;
    const std::vector<const Key*> keys = table.keys_of(kind);
    for (const OtherKey& other : other_keys) {
        if (other.heading != table.heading || (!other.kind.empty() && other.kind != own)) continue;
        if (!holds_word(other.words, word)) continue;
        if (!other.meant.empty() && find_key(keys, other.meant) == nullptr) continue;
        if (other.help.empty()) return {other.meant, "livens calls it '" + std::string(other.meant) + "'"};
        return {other.meant, about(other.help, name, own)};
    }
    return {};
}

}   // namespace livens::inline io_internal
