// SPDX-License-Identifier: BSD-3-Clause
// The steps of a LoadProgram on registers of lanes, one lane a load point: constants are set once, what time
// alone decides once an element, the rest whenever bodies move (docs/theory.md, "Without a tangent", Loads in
// lanes).
#include "livens/dynamics/lanes/load_lanes.h"

#include <algorithm>
#include <cassert>

#include "livens/dynamics/lanes/lane_loads.h"
#include "livens/dynamics/lanes/load_program.h"
#include "livens/multibody/model.h"

namespace livens {

namespace {

/// About the reference points, from what is about centres of mass in lane c.
void take_point(const ModelTables& tables, const double* lanes, int width, int c, std::vector<double>& x)
{
    for (int b = 0; b < tables.n_bodies(); ++b) {
        double* of = x.data() + 12 * b;
        for (int i = 0; i < 12; ++i) of[i] = lanes[(12 * b + i) * width + c];
        const BodyTable& body = tables.bodies[b];
        for (int i = 0; body.offset && i < 3; ++i)
            for (int a = 0; a < 3; ++a) of[i] -= body.center[a] * of[3 + 3 * a + i];
    }
}

}   // namespace

LoadLanes::LoadLanes(const ModelTables& tables, Run run, int width, int n, RecordedLoads which)
    : tables_(tables), program_(LoadProgram::of(tables, which)),
      run_(run != nullptr ? run : &lanes::run_loads<1>), width_(width), n_(n),
      registers_(static_cast<std::size_t>(program_->n_registers() * width), 0.0),
      X_(program_->others().empty() ? 0 : 12 * tables.bodies.size()), V_(X_), F_(X_)
{
    for (const TapeStep& step : program_->tape().steps()) {
        double* to = registers_.data() + step.place * width_;
        if (step.kind == TapeKind::number) std::fill_n(to, width_, step.number);
        if (step.kind != TapeKind::vector) continue;
        const Vector3& value = program_->tape().vectors()[static_cast<std::size_t>(step.index)];
        for (int i = 0; i < 3; ++i) std::fill_n(to + i * width_, width_, value[i]);
    }
}

lanes::LoadProgram LoadLanes::view(const std::vector<lanes::LoadStep>& steps)
{
    return {n_,
            static_cast<int>(steps.size()),
            static_cast<int>(program_->columns().size()),
            static_cast<int>(program_->arms().size()),
            static_cast<int>(program_->forces().size()),
            steps.data(),
            program_->columns().data(),
            program_->arms().data(),
            program_->forces().data(),
            program_->terms().data(),
            registers_.data(),
            turns_.data(),
            &LoadLanes::call,
            this};
}

void LoadLanes::begin(std::span<const Instant> points)
{
    const auto are_same = [](const Instant& a, const Instant& b) { return a.t == b.t && a.side == b.side; };
    if (std::ranges::equal(points, points_, are_same)) return;
    points_.assign(points.begin(), points.end());
    for (const TapeStep& step : program_->tape().steps()) {
        if (step.kind != TapeKind::time) continue;
        const auto& of = program_->tape().times()[static_cast<std::size_t>(step.index)];
        for (int l = 0; l < width_; ++l) {
            const Vector3 value = of(points_[static_cast<std::size_t>(std::min(l, n_ - 1))]);
            for (int i = 0; i < step.b; ++i) registers_[(step.place + i) * width_ + l] = value[i];
        }
    }
    if (!program_->known_steps().empty())
        run_(view(program_->known_steps()), nullptr, nullptr, nullptr, nullptr);
}

void LoadLanes::evaluate(const double* X, const double* V, const double* factors,
                         std::span<const double> turns, double* F)
{
    assert(turns.size() == tables_.loads.turns.size());
    turns_.assign(turns.begin(), turns.end());
    run_(view(program_->steps()), X, V, factors, F);
    if (program_->others().empty()) return;
    // The run has left turns at the last point; others begin at the start of the element again.
    turns_.assign(turns.begin(), turns.end());
    add_others(X, V, factors, F);
}

void LoadLanes::run_steps(std::span<const double> turns)
{
    turns_.assign(turns.begin(), turns.end());
    run_(view(program_->steps()), nullptr, nullptr, nullptr, nullptr);
}

const std::vector<lanes::LoadStep>& LoadLanes::program_steps() const { return program_->steps(); }

bool LoadLanes::has_others() const { return !program_->others().empty(); }

void LoadLanes::evaluate_others(const double* X, const double* V, const double* factors,
                                std::span<const double> turns, double* F)
{
    for (const lanes::LoadColumn& column : program_->columns())
        std::fill_n(F + column.number * width_, 3 * width_, 0.0);
    turns_.assign(turns.begin(), turns.end());
    add_others(X, V, factors, F);
}

void LoadLanes::add_up(const double* factors, const double* others, double* F) const
{
    const auto sum = [&](std::size_t first, const double* by) {   // of lanes
        double all = 0;
        for (int c = 0; c < n_; ++c) all += by == nullptr ? others[first + c] : by[c] * registers_[first + c];
        return all;
    };
    std::fill_n(F, 12 * tables_.bodies.size(), 0.0);
    for (const lanes::LoadColumn& column : program_->columns())
        for (int i = 0; i < 3; ++i) {
            double& to = F[column.number + i];
            if (others != nullptr) to = sum(static_cast<std::size_t>((column.number + i) * width_), nullptr);
            for (std::int32_t t = column.begin; t < column.end; ++t) {
                const lanes::Term& term = program_->terms()[static_cast<std::size_t>(t)];
                to += term.factor * sum(static_cast<std::size_t>((term.number + i) * width_), factors);
            }
        }
}

void LoadLanes::go_on(std::span<double> turns, const double* X, const double* V)
{
    turns_.assign(turns.begin(), turns.end());
    run_(view(program_->steps()), X, V, nullptr, nullptr);
    std::ranges::copy(turns_, turns.begin());
}

/// Point after point, about reference points, as loads know bodies. With the centre of mass x = phi +
/// sum c_a d_a a director has the force F_a - c_a F_0.
void LoadLanes::add_others(const double* X, const double* V, const double* factors, double* F)
{
    for (int c = 0; c < n_; ++c) {
        take_point(tables_, X, width_, c, X_);
        take_point(tables_, V, width_, c, V_);
        tables_.loads.turns.follow(Configurations(X_.data()), turns_);
        std::ranges::fill(F_, 0.0);
        for (const int load : program_->others())
            tables_.loads.add_one(load, points_[static_cast<std::size_t>(c)], X_.data(), V_.data(),
                                  factors[c], F_.data(), turns_);
        for (const lanes::LoadColumn& column : program_->columns()) {
            const int b = column.number / 12, a = column.number % 12 / 3;
            const double shift = a == 0 ? 0 : tables_.bodies[b].center[a - 1];
            for (int i = 0; i < 3; ++i)
                F[(column.number + i) * width_ + c] += F_[column.number + i] - shift * F_[12 * b + i];
        }
    }
}

LoadsAtInstant::LoadsAtInstant(const ModelTables& tables)
    : tables_(tables), lanes_(tables, nullptr, 1, 1, RecordedLoads::without_bends),
      all_(tables, nullptr, 1, 1, RecordedLoads::all), X_(12 * tables.bodies.size()), V_(X_), F_(X_)
{}

/// Where turns are not known loads are asked one by one, as LoadTables does.
void LoadsAtInstant::add(Instant at, const double* X, const double* V, double* raw,
                         std::span<const double> turns, bool far_from_bends)
{
    if (tables_.model->loads().empty()) return;
    if (turns.empty() && !tables_.loads.turns.empty()) return tables_.loads.add(at, X, V, 1, raw, turns);
    const auto to_centres = [this](const double* of, std::vector<double>& x) {
        std::copy_n(of, x.size(), x.begin());
        for (int b = 0; b < tables_.n_bodies(); ++b)
            for (int a = 0; tables_.bodies[b].offset && a < 3; ++a)
                for (int i = 0; i < 3; ++i)
                    x[12 * b + i] += tables_.bodies[b].center[a] * x[12 * b + 3 + 3 * a + i];
    };
    to_centres(X, X_);
    to_centres(V, V_);
    const double one = 1;
    LoadLanes& lanes = far_from_bends ? all_ : lanes_;
    lanes.begin({&at, 1});
    lanes.evaluate(X_.data(), V_.data(), &one, turns, F_.data());
    for (int b = 0; b < tables_.n_bodies(); ++b)
        for (int i = 0; i < 12; ++i) {
            const double centre = i < 3 ? 0 : tables_.bodies[b].center[i / 3 - 1];
            raw[12 * b + i] += F_[12 * b + i] + centre * F_[12 * b + i % 3];
        }
}

void LoadLanes::call(void* self, const lanes::LoadStep& step, int lane)
{
    LoadLanes& me = *static_cast<LoadLanes*>(self);
    const auto which = static_cast<std::size_t>(step.begin);
    const std::vector<int>& inputs = me.program_->tape().inputs()[which];
    me.in_.resize(inputs.size());
    me.out_.resize(static_cast<std::size_t>(step.end));
    for (std::size_t i = 0; i < inputs.size(); ++i) me.in_[i] = me.registers_[inputs[i] * me.width_ + lane];
    me.program_->tape().calls()[which](me.points_[static_cast<std::size_t>(lane)], me.in_, me.out_);
    for (std::size_t i = 0; i < me.out_.size(); ++i)
        me.registers_[(step.to + static_cast<int>(i)) * me.width_ + lane] = me.out_[i];
}

}   // namespace livens
