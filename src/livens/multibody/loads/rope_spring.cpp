// SPDX-License-Identifier: BSD-3-Clause
// A spring and damper along a rope over several points: one tension in all spans, which is a law of the sum L
// of their lengths and of its rate. F_b = -T dL/dX_b (theory.md, "Coordinates of joints", Ropes).
#include <algorithm>
#include <cmath>

#include "livens/base/elementary.h"
#include "livens/multibody/loads/load_values.h"
#include "livens/multibody/rope.h"

namespace livens {

namespace {

/// A point on the rope: of a body of the load, by its place there.
struct RopePoint {
    int side;
    Vector4 p;
};

/// What spans do together, by X of the load's bodies.
struct RopeState {
    double length = 0, rate = 0;
    PerBody<Matrix34> by_X, rate_by_X;   ///< dL/dX, which is dL'/dX' as well, and dL'/dX

    explicit RopeState(std::size_t n) : by_X(n), rate_by_X(n) {}
};

struct RopeSpan {
    RopePoint a, b;

    Vector3 between(const PerBody<Matrix34>& X) const
    {
        return X[static_cast<std::size_t>(b.side)] * b.p - X[static_cast<std::size_t>(a.side)] * a.p;
    }
    double length(const LoadArguments& at) const
    {
        const Vector3 r = between(at.X);
        return hypotenuse(r[0], r[1], r[2]);
    }
};

struct Rope {
    std::vector<RopeSpan> spans;   ///< between different bodies
    double constant;               ///< what the others add to the length
    SpringDamper law;
    std::size_t n_acted;

    double length(const LoadArguments& at) const
    {
        double sum = constant;
        for (const RopeSpan& span : spans) sum += span.length(at);
        return sum;
    }
    double rate(const LoadArguments& at) const
    {
        double sum = 0;
        for (const RopeSpan& span : spans)
            sum += dot(span.between(at.X), span.between(at.V)) / span.length(at);
        return sum;
    }
    SpringValue elastic(double length) const
    {
        const double e = length - law.free_length;
        if (law.law) return law.law(e);
        return {law.stiffness * e, law.stiffness, 0.5 * law.stiffness * e * e};
    }
    double tension(const LoadArguments& at) const
    {
        return elastic(length(at)).force + law.preload + (law.damping > 0 ? law.damping * rate(at) : 0);
    }

    void forces(const LoadArguments& at, LoadForces& F) const
    {
        const double T = tension(at);
        for (const RopeSpan& span : spans) {
            const Vector3 pull = T / span.length(at) * span.between(at.X);
            for (const auto& [end, sign] : {std::pair{&span.a, 1.0}, {&span.b, -1.0}})
                if (static_cast<std::size_t>(end->side) < n_acted)
                    F[static_cast<std::size_t>(end->side)] += outer(sign * pull, end->p);
        }
    }

    void record(LoadTape& tape, TapeNumber factor) const
    {
        std::vector<TapeVector> r;
        std::vector<TapeNumber> by_l;
        TapeNumber length = tape.number(constant), rate = tape.number(0);
        for (const RopeSpan& span : spans) {
            r.push_back(tape.arm(span.b.side, span.b.p) - tape.arm(span.a.side, span.a.p));
            const TapeNumber l = root(dot(r.back(), r.back()));
            by_l.push_back(tape.number(1) / l);   // no number where the points meet
            length = length + l;
            if (law.damping > 0) rate = rate + by_l.back() * dot(r.back(), velocity(tape, span));
        }
        const TapeNumber e = length - law.free_length;
        TapeNumber T = law.preload + (law.law ? recorded(law.law, e) : law.stiffness * e);
        if (!law.law.bends.empty()) tape.watch_guard(e);
        if (law.damping > 0) T = T + law.damping * rate;
        for (std::size_t k = 0; k < spans.size(); ++k) {
            const TapeNumber s = factor * (T * by_l[k]);
            tape.pull(spans[k].a.side, spans[k].a.p, s, r[k]);
            tape.pull(spans[k].b.side, spans[k].b.p, -s, r[k]);
        }
    }
    static TapeVector velocity(LoadTape& tape, const RopeSpan& span)
    {
        return tape.arm(span.b.side, span.b.p, true) - tape.arm(span.a.side, span.a.p, true);
    }
    TapeNumber recorded_power(LoadTape& tape) const
    {
        if (law.damping == 0) return tape.number(0);
        TapeNumber rate = tape.number(0);
        for (const RopeSpan& span : spans) {
            const TapeVector r = tape.arm(span.b.side, span.b.p) - tape.arm(span.a.side, span.a.p);
            rate = rate + dot(r, velocity(tape, span)) / root(dot(r, r));
        }
        return -law.damping * (rate * rate);
    }

    RopeState state(const LoadArguments& at) const
    {
        RopeState all(at.X.size());
        all.length = constant;
        for (const RopeSpan& span : spans) {
            const double l = span.length(at);
            const Vector3 u = 1 / l * span.between(at.X), w = span.between(at.V);
            const Vector3 turn = 1 / l * (w - dot(u, w) * u);
            all.length += l;
            all.rate += dot(u, w);
            for (const auto& [end, sign] : {std::pair{&span.a, -1.0}, {&span.b, 1.0}}) {
                all.by_X[static_cast<std::size_t>(end->side)] += sign * outer(u, end->p);
                all.rate_by_X[static_cast<std::size_t>(end->side)] += sign * outer(turn, end->p);
            }
        }
        return all;
    }

    /// dF_b/dX_c = -dL/dX_b (T_L dL/dX_c + T_L' dL'/dX_c)^T - T d2L/dX_b dX_c.
    void tangent(const LoadArguments& at, LoadTangent& out) const
    {
        const RopeState now = state(at);
        const SpringValue value = elastic(now.length);
        const double T = value.force + law.preload + law.damping * now.rate;
        for (std::size_t b = 0; b < n_acted; ++b)
            for (std::size_t c = 0; c < at.X.size(); ++c) {
                add_outer(out.X[b][c], -1 * now.by_X[b],
                          value.stiffness * now.by_X[c] + law.damping * now.rate_by_X[c]);
                add_outer(out.V[b][c], -1 * now.by_X[b], law.damping * now.by_X[c]);
            }
        for (const RopeSpan& span : spans) {
            const double l = span.length(at);
            const Vector3 u = 1 / l * span.between(at.X);
            const Matrix3 turn = T / l * (identity<3>() - outer(u, u));
            for (const RopePoint* on : {&span.a, &span.b})
                for (const RopePoint* by : {&span.a, &span.b}) {
                    if (static_cast<std::size_t>(on->side) >= n_acted) continue;
                    Matrix<12, 12>& block =
                        out.X[static_cast<std::size_t>(on->side)][static_cast<std::size_t>(by->side)];
                    for (int i = 0; i < 4; ++i)
                        for (int j = 0; j < 4; ++j)
                            add_block(block, i, j, (on == by ? -1.0 : 1.0) * on->p[i] * by->p[j] * turn);
                }
        }
    }

    double potential(const LoadArguments& at) const
    {
        const double l = length(at);
        return elastic(l).energy + law.preload * (l - law.free_length);
    }
    double damper_power(const LoadArguments& at) const
    {
        if (law.damping == 0) return 0;
        const double speed = rate(at);
        return -law.damping * speed * speed;
    }
};

/// The bodies that it acts on, each once; behind them the world, if the rope is held there.
/// A load has two bodies at least: of a rope that has one body alone the second is the world, where it is
/// held (see check_rope()).
void place_bodies(Load& load, const std::vector<BodyPoint>& over)
{
    load.bodies.clear();
    for (const BodyPoint& at : over)
        if (at.body != world && std::ranges::find(load.bodies, at.body) == load.bodies.end())
            load.bodies.push_back(at.body);
    load.n_acted = std::max<std::size_t>(load.bodies.size(), 2);
    const bool is_held = std::ranges::any_of(over, [](const BodyPoint& at) { return at.body == world; });
    if (is_held) load.bodies.push_back(world);
}

Rope rope_of(const Load& load, const SpringDamper& spring)
{
    Rope rope{{}, constant_length(load.over), spring, load.n_acted};
    const auto placed = [&](const BodyPoint& at) {
        const auto side = std::ranges::find(load.bodies, at.body) - load.bodies.begin();
        return RopePoint{static_cast<int>(side), point(at.point)};
    };
    for (std::size_t k = 1; k < load.over.size(); ++k)
        if (load.over[k].body != load.over[k - 1].body)
            rope.spans.push_back({placed(load.over[k - 1]), placed(load.over[k])});
    return rope;
}

}   // namespace

Load rope_spring(const std::string& name, const std::vector<BodyPoint>& over, const SpringDamper& spring,
                 const Configurations& X)
{
    check_rope("load[" + name + "].over", over, X);
    Load load;
    load.name = name;
    load.type = "rope_spring";
    load.over = over;
    place_bodies(load, over);
    check_not_negative(load, spring.stiffness, "stiffness");
    check_not_negative(load, spring.damping, "damping");
    check_not_negative(load, spring.free_length, "free_length");
    check_load_vector(load, {spring.preload, 0, 0}, "the preload");
    const Rope rope = rope_of(load, spring);
    load.depends_on_X = spring.stiffness > 0 || spring.damping > 0 || spring.preload != 0 || spring.law;
    load.depends_on_V = spring.damping > 0;
    load.needs_directors = PerBody<char>(load.n_acted);
    for (const RopeSpan& span : rope.spans)
        for (const RopePoint& end : {span.a, span.b})
            if (static_cast<std::size_t>(end.side) < load.n_acted && end.p != point({}))
                load.needs_directors[static_cast<std::size_t>(end.side)] =
                    load.bodies[static_cast<std::size_t>(end.side)] != world;
    load.domain = "two of its points that follow each other meet, and no direction is left to pull along";
    load.forces = [rope](const LoadArguments& at, LoadForces& F) { rope.forces(at, F); };
    load.forces.record = [rope](LoadTape& tape, const TapeNumber& factor) { rope.record(tape, factor); };
    load.tangent = [rope](const LoadArguments& at, LoadTangent& tangent) { rope.tangent(at, tangent); };
    if (!spring.law.bends.empty()) {
        load.guards = {{spring.law.bends}};
        load.guarded = [rope](const LoadArguments& at, std::span<double> e) {
            e[0] = rope.length(at) - rope.law.free_length;
        };
    }
    load.potential = [rope](const LoadArguments& at) { return rope.potential(at); };
    load.power = [rope](const LoadArguments& at) { return rope.damper_power(at); };
    load.recorded_power = [rope](LoadTape& tape) { return rope.recorded_power(tape); };
    load.readings = {{"force", "N", [rope](const LoadArguments& at) { return rope.tension(at); }},
                     {"length", "m", [rope](const LoadArguments& at) { return rope.length(at); }}};
    return load;
}

}   // namespace livens
