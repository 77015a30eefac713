// SPDX-License-Identifier: BSD-3-Clause
// A model: bodies, joints, loads and sensors, each checked as it is added, so that everything below may take
// them for granted. Which bodies may be named, where rows of joints begin and which joints act at an instant
// is known here.
#include "livens/multibody/model.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "livens/base/error.h"
#include "livens/multibody/controllers.h"
#include "livens/multibody/directors.h"
#include "livens/multibody/wording.h"
#include "livens/solvers/spectral.h"

namespace livens {

namespace {

template <typename T>
int find_by_name(const std::vector<T>& all, const std::string& name)
{
    for (std::size_t i = 0; i < all.size(); ++i)
        if (all[i].name == name) return static_cast<int>(i);
    return -2;
}

template <typename T>
void check_name(const std::vector<T>& all, const std::string& name, const std::string& kind)
{
    if (name.empty())
        throw InputError({"name-empty", kind + "[]", "a " + kind + " needs a name", "", "", "", ""});
    if (name == "world")
        throw InputError(
            {"name-reserved", kind + "[world]", "the name is reserved for the fixed world", "", "", "", ""});
    if (find_by_name(all, name) >= 0)
        throw InputError({"name-duplicate", kind + "[" + name + "]",
                          "the name is given twice among this kind", name, "",
                          "results and joints refer to a " + kind + " by its name", "rename one of them"});
}

void refuse(const std::string& code, const std::string& path, const std::string& message,
            const std::string& help = "")
{
    throw InputError({code, path, message, "", "", "", help});
}

/// Second moments about the centre of mass, E - S S^T / M.
Matrix3 central_moments(const Matrix4& m)
{
    Matrix3 central;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) central(i, j) = m(i + 1, j + 1) - m(i + 1, 0) * m(0, j + 1) / m(0, 0);
    return central;
}

bool uses_directors(const Matrix34& m)
{
    return std::any_of(m.a + 3, m.a + 12, [](double entry) { return entry != 0; });
}

/// The first row belongs to the reference point; the rest is the directors'.
bool uses_directors(const Matrix4& m)
{
    for (int j = 0; j < 4; ++j)
        for (int i = 1; i < 4; ++i)
            if (m(i, j) != 0) return true;
    return false;
}

void check_mass(const Body& body, const std::string& path)
{
    const Matrix4& m = body.mass;
    if (!(m(0, 0) > 0))
        throw InputError({"mass-not-positive", path + ".mass", "the mass of a body must be positive",
                          to_text(m(0, 0)), "> 0", "", ""});
    double largest = 0;
    for (const double entry : m.a) largest = std::max(largest, std::abs(entry));
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < i; ++j)
            if (std::abs(m(i, j) - m(j, i)) > 1e-12 * largest)
                refuse("inertia-not-symmetric", path + ".mass", "the mass matrix must be symmetric");
    // Second moments that are not negative say the same as the triangle inequality of J = tr(E) I - E. The
    // slack is relative to the moments about the reference point, whose rounding the shift to the centre lays
    // bare.
    const double smallest = symmetric_values(central_moments(m))[0];
    const double slack = 1e-12 * (m(1, 1) + m(2, 2) + m(3, 3));
    if (smallest < -std::abs(slack))
        throw InputError(
            {"inertia-triangle", path + ".mass",
             "the largest principal moment exceeds the sum of the other two", "", "J1 + J2 >= J3",
             "principal moments of inertia satisfy the triangle inequality for every distribution of mass",
             ""});
}

void check_body(const Body& body, const std::string& path)
{
    require_finite(body.mass, path + ".mass", "the mass matrix");
    require_finite(body.X, path + ".position", "position and directors");
    require_finite(body.V, path + ".velocity", "velocity and rates of the directors");
    check_mass(body, path);
    if (body.is_point) {
        if (uses_directors(body.X) || uses_directors(body.V) || uses_directors(body.mass) ||
            uses_directors(transpose(body.mass)))
            refuse("point-with-directors", path, "a point mass has no directors and no moments of inertia");
        return;
    }
    check_directors(directors(body.X), path + ".directors");
}

void check_body_index(int body, int n_bodies, const std::string& path)
{
    if (body >= world && body < n_bodies) return;
    throw InputError({"body-unknown", path, "there is no body of this index", std::to_string(body),
                      "-1 (the world) to " + std::to_string(n_bodies - 1), "",
                      "add bodies before what refers to them"});
}

void check_form(const QuadraticForm& form, int body_i, int body_j, const std::vector<Body>& bodies,
                const std::string& path)
{
    require_finite(form.c_ii, path, "the coefficients of a row");
    require_finite(form.c_ij, path, "the coefficients of a row");
    require_finite(form.c_jj, path, "the coefficients of a row");
    require_finite(form.b_i, path, "the coefficients of a row");
    require_finite(form.b_j, path, "the coefficients of a row");
    require_finite(Matrix<1, 1>{form.c}, path, "the constant of a row");
    if (form.c_ii != transpose(form.c_ii) || form.c_jj != transpose(form.c_jj))
        refuse("joint-row", path, "C_ii and C_jj of a row must be symmetric");
    if (body_i == world && (form.c_ii != Matrix4{} || form.c_ij != Matrix4{} || form.b_i != Matrix34{}))
        refuse("joint-row", path, "a row has terms in the world that are not folded into B_j and c");

    const auto is_point = [&](int body) { return body != world && bodies[body].is_point; };
    const bool i_turns = uses_directors(form.c_ii) || uses_directors(form.c_ij) || uses_directors(form.b_i);
    const bool j_turns =
        uses_directors(form.c_jj) || uses_directors(transpose(form.c_ij)) || uses_directors(form.b_j);
    for (const auto& [body, turns] : {std::pair(body_i, i_turns), std::pair(body_j, j_turns)})
        if (turns && is_point(body))
            refuse("joint-needs-directors", path,
                   "the joint needs the orientation of '" + bodies[body].name + "', a point mass",
                   "a point mass takes spherical joints and rods at its own point, [0, 0, 0] in its "
                   "coordinates");
}

/// A jump of the factor, or of its rate, would be a jump of positions or velocities, which no force makes.
/// Both sides of a break lie some digits of t apart, by which a smooth law changes as well; what is no more
/// than rounding of the row (unit and `scale`: of Phi) is no jump.
void check_drive(const Drive& drive, double scale, const std::string& path)
{
    for (const double t : drive.factor.breaks()) {
        const TimeValue before = drive.factor({t, Side::left}), after = drive.factor({t, Side::right});
        const auto larger = [](double a, double b) { return std::max(std::abs(a), std::abs(b)); };
        const double apart = 1e-14 * std::abs(t), value = larger(before.value, after.value),
                     rate = larger(before.first, after.first), bend = larger(before.second, after.second);
        if (std::abs(after.value - before.value) <= std::max({1e-9 * value, apart * rate, 1e-13 * scale}) &&
            std::abs(after.first - before.first) <= std::max(1e-9 * rate, apart * bend))
            continue;
        throw InputError({"drive-jumps", path, "a drive jumps, or its rate does",
                          "at t = " + to_text(t) + " s", "", "bodies would need an infinite force to follow",
                          "let the drive begin and end smoothly"});
    }
}

void check_rotor(double inertia, bool has_events, const std::string& path)
{
    if (!(inertia >= 0) || !std::isfinite(inertia))
        throw InputError({"rotor-inertia", path + ".rotor_inertia",
                          "the inertia of a rotor must be finite and not negative", to_text(inertia), ">= 0",
                          "", ""});
    if (inertia > 0 && has_events)
        refuse("rotor-inertia", path + ".rotor_inertia",
               "a joint that acts for a part of the time has no rotor: nothing would turn it when the "
               "joint has ended",
               "leave out the times of the joint, or its 'rotor_inertia'");
}

/// Forms with bodies of their own, which need not be the joint's: gears turn about other joints.
void check_coordinates(const ConstraintRow& row, const std::vector<Body>& bodies, const std::string& path)
{
    std::size_t n = 0;
    for (const SmoothFunction& F : row.functions) {
        if (!F.at || !F.moved || F.n < 1 || F.n > SmoothFunction::most)
            refuse("joint-row", path,
                   "a function of a row needs its values, and is of 1 to " +
                       std::to_string(SmoothFunction::most) + " coordinates");
        n += F.n;
    }
    if (n != row.coordinates.size())
        refuse("joint-row", path, "the functions of a row are of as many coordinates as it has");
    for (const PairForm& q : row.coordinates) {
        for (const int body : {q.body_i, q.body_j})
            check_body_index(body, static_cast<int>(bodies.size()), path);
        if (q.body_j == world || q.body_i == q.body_j)
            refuse("joint-row", path,
                   "the second body of a coordinate must be a body, and not its first one");
        check_form(q, q.body_i, q.body_j, bodies, path);
    }
    row_bodies(row);
}

void check_row(const ConstraintRow& row, const Joint& joint, const std::vector<Body>& bodies,
               const std::string& path)
{
    check_coordinates(row, bodies, path);
    const auto known = [&](int body) {
        return !row.functions.empty() || body == joint.first || body == joint.second;
    };
    for (const int body : {row.body_i, row.body_j})
        check_body_index(body, static_cast<int>(bodies.size()), path);
    if (!known(row.body_i) && row.body_i != world)
        refuse("joint-row", path, "a row acts on a body that is not the joint's");
    if (!known(row.body_j) || row.body_j == world)
        refuse("joint-row", path, "the second body of a row must be a body of the joint",
               "the makers of rows see to it");
    if (row.body_i == row.body_j) refuse("joint-self", path, "a row needs two different bodies");
    require_finite(Matrix<1, 1>{row.scale}, path, "the scale of a row");
    if (!(row.scale > 0)) refuse("joint-scale", path, "the scale of a row must be positive");
    check_form(row, row.body_i, row.body_j, bodies, path);
    for (const Drive& drive : row.drives) {
        check_form(drive.form, row.body_i, row.body_j, bodies, path);
        check_drive(drive, row.scale, path);
    }
}

}   // namespace

Model::Model(const Vector3& gravity) : gravity_(gravity) { changed(); }

void Model::changed()
{
    // One number for all models of the program: two models with one version are the same.
    static std::atomic<std::uint64_t> last{0};
    version_ = ++last;
    length_ = {};
}

int Model::add_body(Body body)
{
    check_name(bodies_, body.name, "body");
    require_finite(gravity_, "gravity", "gravity");
    check_body(body, "body[" + body.name + "]");
    bodies_.push_back(std::move(body));
    changed();
    return n_bodies() - 1;
}

int Model::add_joint(Joint joint)
{
    check_name(joints_, joint.name, "joint");
    const std::string path = "joint[" + joint.name + "]";
    check_body_index(joint.first, n_bodies(), path);
    check_body_index(joint.second, n_bodies(), path);
    if (joint.first == joint.second) refuse("joint-self", path, "a joint needs two different bodies");
    if (joint.second == world)
        refuse("joint-second", path, "the second of a joint must be a body",
               "exchange the world and the body");
    if (joint.rows.empty()) refuse("joint-empty", path, "a joint needs at least one row");
    require_finite(joint.point_first, path, "the point on the first body");
    require_finite(joint.point_second, path, "the point on the second body");
    for (const auto* rows : {&joint.rows, &joint.branches})
        for (const ConstraintRow& row : *rows) check_row(row, joint, bodies_, path);

    if (!(joint.from < joint.until))
        refuse("joint-time", path, "a joint must begin to act before it ends", "exchange 'from' and 'until'");

    const int index = static_cast<int>(joints_.size());
    const bool has_events = joint.is_partial();
    has_.events = has_.events || has_events;
    // A joint that does not always act leaves its axes apart; then the angle is that of the turn between both
    // triads.
    for (NamedCoordinate& one : joint.coordinates)
        if (has_events && !one.apart.forms.empty()) one.coordinate = one.apart;
    for (const NamedCoordinate& one : joint.coordinates) {
        check_rotor(one.rotor_inertia, has_events, path);
        has_.rotors = has_.rotors || one.rotor_inertia > 0;
    }
    first_rows_.push_back(n_rows());
    for (int k = 0; k < static_cast<int>(joint.rows.size()); ++k) rows_.push_back({index, k});
    for (const ConstraintRow& row : joint.rows) {
        has_.drives = has_.drives || !row.drives.empty();
        has_.pieces = has_.pieces || row.guard;
    }
    joints_.push_back(std::move(joint));
    changed();
    return index;
}

int Model::add_load(Load load)
{
    check_name(loads_, load.name, "load");
    const std::string path = "load[" + load.name + "]";
    if (load.n_acted < 2 || load.n_acted > load.bodies.size() || load.needs_directors.size() != load.n_acted)
        refuse("load-empty", path, "a load acts on one body or between two");
    for (const int body : load.bodies) check_body_index(body, n_bodies(), path);
    if (load.bodies[0] == load.bodies[1])
        refuse("load-self", path,
               load.bodies[0] == world ? "a load needs a body to act on"
                                       : "a load needs two different bodies");
    if (!load.forces) refuse("load-empty", path, "a load needs a function for its forces");
    if ((load.depends_on_X || load.depends_on_V) && !load.tangent)
        refuse("load-without-tangent", path,
               "a load that depends on position or velocity needs its derivative");
    for (const double t : load.breaks) require_finite(Matrix<1, 1>{t}, path, "an instant");
    for (std::size_t b = 0; b < load.n_acted; ++b)
        if (load.needs_directors[b] && load.bodies[b] != world && bodies_[load.bodies[b]].is_point)
            refuse("load-needs-directors", path,
                   "the load needs the orientation of '" + body_name(load.bodies[b]) + "', a point mass",
                   "a point mass takes forces in world axes at its own point");
    has_.pieces = has_.pieces || !load.guards.empty() || load.bends_at_centre;
    has_.events = has_.events || load.is_decided_by_events();
    if (load.is_decided_by_events() && !load.whenever && !load.by_reactions) load = for_its_time(load);
    loads_.push_back(std::move(load));
    changed();
    return static_cast<int>(loads_.size()) - 1;
}

int Model::add_sensor(Sensor sensor)
{
    check_name(sensors_, sensor.name, "sensor");
    const std::string path = "sensor[" + sensor.name + "]";
    const int n_loads = static_cast<int>(loads_.size());
    if (sensor.components.empty() || sensor.load < -1 || sensor.load >= n_loads)
        refuse("sensor-empty", path, "a sensor needs something to read");
    if (sensor.body != -1) check_body_index(sensor.body, n_bodies(), path);
    for (const SensorComponent& component : sensor.components)
        for (const PairForm& form : component.coordinate.coordinate.forms) {
            check_body_index(form.body_i, n_bodies(), path);
            check_body_index(form.body_j, n_bodies(), path);
        }
    sensors_.push_back(std::move(sensor));
    changed();
    return static_cast<int>(sensors_.size()) - 1;
}

int Model::add_point(NamedPoint point)
{
    check_name(points_, point.name, "point");
    const std::string path = "point[" + point.name + "]";
    check_body_index(point.body, n_bodies(), path);
    require_finite(point.position, path + ".position", "the place of a point");
    if (find_by_name(bodies_, point.name) >= 0)
        throw InputError({"name-duplicate", path, "a body has this name", point.name, "",
                          "the name of a point stands for its body, too", "rename one of them"});
    if (point.body != world && bodies_[point.body].is_point && point.position != Vector3{})
        refuse("point-mass", path + ".position", "a point mass has no other point than its own",
               "leave the position out");
    points_.push_back(std::move(point));
    changed();
    return static_cast<int>(points_.size()) - 1;
}

int Model::add_event(Event event)
{
    check_name(events_, event.name, "event");
    check_event(event, joints_, loads_);
    if (event.action.does == EventAction::Does::set)
        check_change(event.change, bodies_, loads_, "event[" + event.name + "]");
    has_.events = true;
    events_.push_back(std::move(event));
    changed();
    return static_cast<int>(events_.size()) - 1;
}

int Model::add_sampling(Sampling sampling)
{
    check_name(samplings_, sampling.name, "controller");
    check_sampling(sampling, bodies_, loads_);
    has_.events = true;
    samplings_.push_back(std::move(sampling));
    changed();
    return static_cast<int>(samplings_.size()) - 1;
}

int Model::find_body(const std::string& name) const
{
    return name == "world" ? world : find_by_name(bodies_, name);
}

int Model::find_joint(const std::string& name) const { return find_by_name(joints_, name); }

int Model::find_point(const std::string& name) const { return find_by_name(points_, name); }

State Model::start() const
{
    State state;
    for (const Body& body : bodies_) {
        state.X.push_back(body.X);
        state.V.push_back(body.V);
    }
    return state;
}

Matrix34 weight(const Body& body, const Vector3& gravity)
{
    return !body.is_matter() ? Matrix34{} : outer(gravity, body.mass.column(0));
}

}   // namespace livens
