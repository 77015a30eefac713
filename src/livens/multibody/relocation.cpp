// SPDX-License-Identifier: BSD-3-Clause
// A mechanism is moved by X' = R X + p e_0^T for all of its bodies, e_0 = (1, 0, 0, 0). What it is made of,
// forms of X and functions of X and X', sees X = R^T (X' - p e_0^T): forms stay forms, and of functions the
// arguments are moved back, the forces forth.
#include "livens/multibody/relocation.h"

#include <memory>
#include <utility>

#include "livens/multibody/loads/load_tape.h"

namespace livens {

namespace {

/// With e_0 of both bodies: K stays, B' = R B - p e_0^T K and c' = c + 1/2 (e_0^T K e_0) |p|^2 - p . (R B
/// e_0).
QuadraticForm displaced(const QuadraticForm& form, const Displacement& by)
{
    const Vector3& p = by.position;
    // p e_0^T C is p times the first row of C; of C_ij^T it is the first column of C_ij.
    const auto first_row = [](const Matrix4& C) { return Vector4{C(0, 0), C(0, 1), C(0, 2), C(0, 3)}; };
    QuadraticForm moved = form;
    const Matrix34 turned_i = by.rotation * form.b_i, turned_j = by.rotation * form.b_j;
    moved.b_i = turned_i - outer(p, first_row(form.c_ii) + form.c_ij.column(0));
    moved.b_j = turned_j - outer(p, first_row(form.c_jj) + first_row(form.c_ij));
    moved.c += (form.c_ii(0, 0) / 2 + form.c_ij(0, 0) + form.c_jj(0, 0) / 2) * dot(p, p);
    moved.c -= dot(p, turned_i.column(0) + turned_j.column(0));
    return moved;
}

void relocate(PairForm& form, const Relocation& to)
{
    static_cast<QuadraticForm&>(form) = displaced(form, to.by);
    form.body_i = to.body(form.body_i);
    form.body_j = to.body(form.body_j);
}

void relocate(JointCoordinate& coordinate, const Relocation& to)
{
    for (PairForm& form : coordinate.forms) relocate(form, to);
}

void relocate(StateChange& change, const Relocation& to)
{
    if (change.load >= 0) change.load += to.first_load;
    for (JointCoordinate& state : change.states) relocate(state, to);
}

void relocate(ConstraintRow& row, const Relocation& to)
{
    for (Drive& drive : row.drives) drive.form = displaced(drive.form, to.by);
    for (PairForm& q : row.coordinates) relocate(q, to);
    relocate(static_cast<PairForm&>(row), to);
}

void relocate(std::vector<BodyPoint>& over, const Relocation& to)
{
    for (BodyPoint& at : over) {
        if (at.body == world) at.point = to.by.of_point(at.point);
        at.body = to.body(at.body);
    }
}

/// Of a load: what its functions see of bodies that were moved, and what becomes of what they say.
class SeenFrom {
public:
    SeenFrom(const Load& load, const Displacement& by) : by_(by), back_(by.inverse())
    {
        for (const int body : load.bodies) is_world_.push_back(body == world);
    }

    LoadArguments operator()(const LoadArguments& at) const
    {
        LoadArguments seen = at;
        for (std::size_t k = 0; k < is_world_.size(); ++k) {
            if (is_world_[k]) continue;   // it is the one that the load was made in
            seen.X[k] = back_.of_configuration(at.X[k]);
            seen.V[k] = back_.rotation * at.V[k];
        }
        return seen;
    }
    Matrix34 turned(const Matrix34& m) const { return by_.rotation * m; }
    /// A derivative of stacked columns by stacked columns.
    Matrix<12, 12> turned(const Matrix<12, 12>& m) const
    {
        Matrix<12, 12> moved;
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < 4; ++j) {
                Matrix3 block;
                for (int r = 0; r < 3; ++r)
                    for (int c = 0; c < 3; ++c) block(r, c) = m(3 * i + r, 3 * j + c);
                block = by_.rotation * block * back_.rotation;
                for (int r = 0; r < 3; ++r)
                    for (int c = 0; c < 3; ++c) moved(3 * i + r, 3 * j + c) = block(r, c);
            }
        return moved;
    }

private:
    Displacement by_, back_;
    std::vector<bool> is_world_;
};

/// A function of arguments alone, asked with what it sees.
/// Values of such functions are numbers, which no displacement changes.
template <class Result, class... More>
void look(std::function<Result(const LoadArguments&, More...)>& function, const SeenFrom& seen)
{
    if (!function) return;
    function = [function, seen](const LoadArguments& at, More... more) -> Result {
        return function(seen(at), std::forward<More>(more)...);
    };
}

void look_and_turn_forces(Load& load, const SeenFrom& seen)
{
    load.forces.evaluate = [forces = load.forces.evaluate, seen](const LoadArguments& at, LoadForces& F) {
        LoadForces own(F.size());
        forces(seen(at), own);
        for (std::size_t b = 0; b < F.size(); ++b) F[b] += seen.turned(own[b]);
    };
    if (!load.inside) return;
    look(load.inside->numbers, seen);
    load.inside->unit = [unit = load.inside->unit, seen](const LoadArguments& at, std::size_t k,
                                                         LoadForces& F) {
        LoadForces own(F.size());
        unit(seen(at), k, own);
        for (std::size_t b = 0; b < F.size(); ++b) F[b] += seen.turned(own[b]);
    };
}

void look_and_turn_tangent(Load& load, const SeenFrom& seen)
{
    if (!load.tangent) return;
    load.tangent = [tangent = load.tangent, seen](const LoadArguments& at, LoadTangent& out) {
        LoadTangent own(at.X.size(), out.X.size());
        tangent(seen(at), own);
        for (std::size_t b = 0; b < out.X.size(); ++b)
            for (std::size_t c = 0; c < at.X.size(); ++c) {
                out.X[b][c] += seen.turned(own.X[b][c]);
                out.V[b][c] += seen.turned(own.V[b][c]);
            }
    };
}

void look_and_turn_products(Load& load, const SeenFrom& seen)
{
    if (!load.products) return;
    load.products = [products = load.products, seen](const LoadArguments& at) {
        std::vector<ProductSlopes> all = products(seen(at));
        for (ProductSlopes& one : all) {
            for (Matrix34& u : one.direction) u = seen.turned(u);
            for (Matrix34& slope : one.by_X) slope = seen.turned(slope);
            for (Matrix34& slope : one.by_V) slope = seen.turned(slope);
        }
        return all;
    };
}

/// What was recorded is recorded again, among arms that are moved back.
template <class Result, class... More>
void record_moved(std::function<Result(LoadTape&, More...)>& record, const Displacement& by)
{
    if (!record) return;
    record = [record, by](LoadTape& tape, More... more) -> Result {
        const MovedLoad moved(tape, by);
        return record(tape, std::forward<More>(more)...);
    };
}

void displace(Load& load, const Displacement& by)
{
    const SeenFrom seen(load, by);
    look_and_turn_forces(load, seen);
    record_moved(load.forces.record, by);
    look_and_turn_tangent(load, seen);
    look_and_turn_products(load, seen);
    look(load.potential, seen);
    look(load.power, seen);
    record_moved(load.recorded_power, by);
    look(load.guarded, seen);
    look(load.centre, seen);
    for (LoadReading& reading : load.readings) look(reading.value, seen);
    for (std::size_t b = 0; b < load.points.size() && b < 2; ++b)
        if (load.bodies[b] == world) load.points[b] = by.of_point(load.points[b]);
}

}   // namespace

Body relocated(Body body, const Relocation& to)
{
    body.name = to.name(body.name);
    for (HeldState& state : body.states) {
        state.name = to.name(state.name);
        state.along = to.by.rotation * state.along;
    }
    body.X = to.by.of_configuration(body.X);
    body.V = to.by.rotation * body.V;
    body.upright = to.by.rotation * body.upright;
    return body;
}

NamedPoint relocated(NamedPoint point, const Relocation& to)
{
    point.name = to.name(point.name);
    if (point.body == world) point.position = to.by.of_point(point.position);
    point.body = to.body(point.body);
    return point;
}

Joint relocated(Joint joint, const Relocation& to)
{
    joint.name = to.name(joint.name);
    if (joint.first == world) {
        joint.point_first = to.by.of_point(joint.point_first);
        joint.axis_first = to.by.rotation * joint.axis_first;
        joint.triads.first = to.by.rotation * joint.triads.first;
        for (Vector3& x : joint.path) x = to.by.of_point(x);
    }
    relocate(joint.over, to);
    joint.first = to.body(joint.first);
    joint.second = to.body(joint.second);
    for (auto* rows : {&joint.rows, &joint.branches})
        for (ConstraintRow& row : *rows) relocate(row, to);
    for (auto* all : {&joint.coordinates, &joint.readings})
        for (NamedCoordinate& one : *all)
            for (JointCoordinate* q : {&one.coordinate, &one.apart}) relocate(*q, to);
    return joint;
}

ReactionInput relocated(ReactionInput reaction, const Relocation& to)
{
    if (reaction.joint >= 0) reaction.joint = to.joint(reaction.joint);
    reaction.along = to.by.rotation * reaction.along;
    return reaction;
}

namespace {

ReactionLaw relocated(ReactionLaw law, const Relocation& to)
{
    law.name = to.name(law.name);
    for (Load& unit : law.units) unit = livens::relocated(unit, to);
    for (LawCoordinate& q : law.coordinates) relocate(q.coordinate, to);
    for (ReactionInput& one : law.reactions) one = livens::relocated(one, to);
    return law;
}

}   // namespace

Load relocated(Load load, const Relocation& to)
{
    load.name = to.name(load.name);
    if (load.by_reactions != nullptr)
        load.by_reactions = std::make_shared<const ReactionLaw>(relocated(*load.by_reactions, to));
    if (!to.by.is_none()) displace(load, to.by);
    for (int& body : load.bodies) body = to.body(body);
    relocate(load.over, to);
    for (auto* all : {&load.angles, &load.rotations})
        for (JointCoordinate& one : *all) relocate(one, to);
    return load;
}

Sensor relocated(Sensor sensor, const Relocation& to)
{
    sensor.name = to.name(sensor.name);
    for (SensorComponent& one : sensor.components)
        for (JointCoordinate* q : {&one.coordinate.coordinate, &one.coordinate.apart}) relocate(*q, to);
    if (sensor.load >= 0) sensor.load += to.first_load;
    if (sensor.body >= 0) sensor.body += to.first_body;
    return sensor;
}

Event relocated(Event event, const Relocation& to)
{
    event.name = to.name(event.name);
    for (LawCoordinate& q : event.terms.coordinates) relocate(q.coordinate, to);
    for (ReactionInput& one : event.terms.reactions) one = relocated(one, to);
    if (event.action.joint >= 0) event.action.joint = to.joint(event.action.joint);
    if (event.action.load >= 0) event.action.load += to.first_load;
    relocate(event.change, to);
    return event;
}

Sampling relocated(Sampling sampling, const Relocation& to)
{
    sampling.name = to.name(sampling.name);
    relocate(sampling.change, to);
    return sampling;
}

JointCoordinate relocated(JointCoordinate coordinate, const Relocation& to)
{
    relocate(coordinate, to);
    return coordinate;
}

}   // namespace livens
