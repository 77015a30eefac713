// SPDX-License-Identifier: BSD-3-Clause
// Which coordinates tell a mechanism's state: theory.md, "States in coordinates". The test is that of starts
// by coordinates: a row is taken if a part of it is neither held by joints nor by what was taken before.
#include <algorithm>
#include <numeric>

#include "livens/base/error.h"
#include "livens/dynamics/coordinates/mechanism.h"
#include "livens/dynamics/rows/rank.h"
#include "livens/dynamics/start/free_directions.h"
#include "livens/multibody/joints/drives.h"
#include "livens/time/time_laws.h"

namespace livens::inline dynamics_internal {

namespace {

using Of = GeneralisedCoordinate::Of;

/// A coordinate that may be taken, and the place of its rows among those of all.
struct Candidate {
    GeneralisedCoordinate coordinate;
    int first_row = 0;
    bool is_numbered = false;   ///< see NamedCoordinate::is_numbered()
    bool is_taken = false;
};

/// Whether one of these is a component of its rotation vector.
bool is_wanted_by_rotation(const Joint& joint, const std::vector<std::string>& wanted)
{
    return std::ranges::any_of(joint.readings, [&](const NamedCoordinate& one) {
        return std::ranges::find(wanted, joint.name + "." + one.name) != wanted.end();
    });
}

/// Those of a rotation vector only where one of them is wanted: they end at half a turn.
std::vector<Candidate> candidates_of(const Model& model, const std::vector<std::string>& wanted)
{
    std::vector<Candidate> all;
    int rows = 0;
    const auto add = [&](Of of, int part, int index, const std::string& name) {
        all.push_back({{of, part, index, name}, rows});
        rows += all.back().coordinate.n_rates();
    };
    for (int b = 0; b < model.n_bodies(); ++b) {
        const Body& body = model.bodies()[b];
        if (body.holds_states()) continue;
        for (int i = 0; i < 3; ++i) add(Of::place, b, i, body.name + "." + "xyz"[i]);
        if (!body.is_point) add(Of::turn, b, 0, body.name + ".quaternion");
    }
    for (int j = 0; j < static_cast<int>(model.joints().size()); ++j) {
        const Joint& joint = model.joints()[j];
        const std::size_t n =
            joint.coordinates.size() + (is_wanted_by_rotation(joint, wanted) ? joint.readings.size() : 0);
        for (std::size_t k = 0; k < n; ++k) {
            const NamedCoordinate& one = joint.coordinate(k);
            if (find_coordinate(joint, one.name) == nullptr) continue;
            add(Of::joint, j, static_cast<int>(k), joint.name + "." + one.name);
            all.back().is_numbered = one.is_numbered();
        }
    }
    return all;
}

/// The model with a row for each rate of the candidates, behind those of its joints.
/// Only gradients are asked of them: laws are constant, and hold each coordinate where it is at X.
Model with_rows_of(const Model& model, const std::vector<Candidate>& candidates, std::span<const Matrix34> X)
{
    Model with = model;
    for (const Candidate& candidate : candidates) {
        const GeneralisedCoordinate& c = candidate.coordinate;
        const std::string name = "\n" + c.name;   // apart from the names of joints
        if (c.of == Of::joint) {
            const Joint& joint = model.joints()[c.part];
            const NamedCoordinate& counted = joint.coordinate(static_cast<std::size_t>(c.index));
            with.add_joint(driven_coordinate(name, joint, counted, ramp(counted.at_stated, 0, 0), X));
            continue;
        }
        Joint held;
        held.name = name;
        held.type = "held";
        held.second = c.part;
        if (c.of == Of::place) {
            held.rows = {coincidence_rows(world, point(X[c.part].column(0)), c.part, point({}), 1)[c.index]};
        } else {
            const Joint here = weld("", world, c.part, {}, world_configuration, X[c.part]);
            held.rows.assign(here.rows.begin() + 3, here.rows.end());
        }
        with.add_joint(std::move(held));
    }
    return frozen(with, {0});
}

/// What is free, and who takes it.
class Choice {
public:
    /// What is left are the freedoms of all bodies, less the independent rows of joints.
    Choice(const Model& model, const State& placed, const std::vector<int>& independent,
           const std::vector<std::string>& wanted)
        : all_(candidates_of(model, wanted)), n_left_(-static_cast<int>(independent.size()))
    {
        for (const Body& body : model.bodies())
            if (!body.holds_states()) n_left_ += body.is_point ? 3 : 6;
        const Model with = with_rows_of(model, all_, placed.X);
        std::vector<int> rows(static_cast<std::size_t>(with.n_rows() - model.n_rows()));
        std::iota(rows.begin(), rows.end(), model.n_rows());
        rows_ = twist_rows(with, placed.X, rows).rows;
        free_ = std::make_unique<FreeDirections>(with, placed.X, independent);
    }

    int n_left() const { return n_left_; }
    std::vector<Candidate>& all() { return all_; }
    Candidate* find(const std::string& name)
    {
        const auto at =
            std::ranges::find_if(all_, [&](const Candidate& c) { return c.coordinate.name == name; });
        return at == all_.end() ? nullptr : &*at;
    }

    /// All rows of some, or none.
    bool take(std::span<Candidate* const> some)
    {
        FreeDirections tried = *free_;
        int n = 0;
        for (const Candidate* candidate : some)
            for (int i = 0; i < candidate->coordinate.n_rates(); ++i, ++n)
                if (!tried.take(rows_[candidate->first_row + i])) return false;
        *free_ = std::move(tried);
        n_left_ -= n;
        for (Candidate* candidate : some) candidate->is_taken = true;
        return true;
    }
    /// Whether a row would be taken.
    bool moves(int row) const
    {
        FreeDirections tried = *free_;
        return tried.take(rows_[row]);
    }
    bool take(Candidate& one)
    {
        Candidate* const alone[] = {&one};
        return one.is_taken || take(alone);
    }

private:
    std::vector<Candidate> all_;
    std::vector<BodyRow> rows_;
    std::unique_ptr<FreeDirections> free_;
    int n_left_;
};

void take_wanted(Choice& choice, const std::vector<std::string>& wanted)
{
    std::string before;
    for (const std::string& name : wanted) {
        Candidate* found = choice.find(name);
        const std::string path = "q[" + name + "]";
        if (found == nullptr)
            throw InputError({"coordinate-unknown", path, "there is no coordinate '" + name + "'", "", "", "",
                              "coordinates are those of joints, as 'elbow.angle' or, of a ball, "
                              "'hip.rotation_vector_x', and those of bodies, as 'base.x' and "
                              "'base.quaternion'"});
        if (found->is_taken)
            throw InputError({"coordinate-twice", path, "coordinate '" + name + "' is given twice", "", "",
                              "", "give it once"});
        if (!choice.take(*found))
            throw InputError(
                {"coordinates-dependent", path,
                 "coordinate '" + name + "' cannot be given: joints" +
                     (before.empty() ? "" : ", or the coordinates given before it (" + before + "),") +
                     " determine it" + (found->coordinate.of == Of::turn ? ", at least in part" : ""),
                 "", "", "", "leave it out, or give other coordinates that are independent"});
        before += (before.empty() ? "'" : ", '") + name + "'";
    }
}

/// Of bodies, as far as joints' coordinates do not tell: whole places and orientations first.
/// Then single axes of places; an orientation is taken whole or not at all.
void take_of_bodies(Choice& choice, const Model& model)
{
    std::vector<std::vector<Candidate*>> places(model.bodies().size()), turns(places);
    for (Candidate& c : choice.all()) {
        if (c.coordinate.of == Of::place && !c.is_taken) places[c.coordinate.part].push_back(&c);
        if (c.coordinate.of == Of::turn && !c.is_taken) turns[c.coordinate.part].push_back(&c);
    }
    for (std::size_t b = 0; b < places.size() && choice.n_left() > 0; ++b) {
        if (!places[b].empty()) choice.take(places[b]);
        if (!turns[b].empty()) choice.take(turns[b]);
    }
    for (const std::vector<Candidate*>& of_body : places)
        for (Candidate* one : of_body)
            if (choice.n_left() > 0) choice.take(*one);
}

[[noreturn]] void refuse_missing(Choice& choice, const Model& model)
{
    std::string bodies;
    for (const Candidate& c : choice.all()) {
        if (c.coordinate.of != Of::turn || c.is_taken) continue;
        for (int i = 0; i < 3; ++i) {
            if (!choice.moves(c.first_row + i)) continue;
            bodies += (bodies.empty() ? "'" : ", '") + model.body_name(c.coordinate.part) + "'";
            break;
        }
    }
    const int n = choice.n_left();
    throw InputError(
        {"coordinates-missing", bodies.empty() ? "" : "q",
         "coordinates do not tell where the mechanism is: " + std::to_string(n) +
             (n == 1 ? " freedom follows" : " freedoms follow") + " from none" +
             (bodies.empty() ? "" : ", which turn bodies " + bodies),
         "", "",
         "joints such as constant_velocity and perpendicular_axes leave turns free that are no coordinates",
         "give a spherical joint 'angles', or take its rotation vector; or place the body's reference point "
         "away from the joint"});
}

}   // namespace

std::vector<GeneralisedCoordinate> choose_coordinates(const Model& model, const State& placed,
                                                      const std::vector<int>& independent,
                                                      const std::vector<std::string>& wanted)
{
    Choice choice(model, placed, independent, wanted);
    take_wanted(choice, wanted);
    for (const bool is_numbered : {false, true})
        for (Candidate& c : choice.all())
            if (c.coordinate.of == Of::joint && c.is_numbered == is_numbered && choice.n_left() > 0)
                choice.take(c);
    if (choice.n_left() > 0) take_of_bodies(choice, model);
    if (choice.n_left() > 0) refuse_missing(choice, model);
    std::vector<GeneralisedCoordinate> taken;
    for (const Candidate& c : choice.all())
        if (c.is_taken) taken.push_back(c.coordinate);
    return taken;
}

}   // namespace livens::inline dynamics_internal
