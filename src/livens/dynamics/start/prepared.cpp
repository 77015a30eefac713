// SPDX-License-Identifier: BSD-3-Clause
// What was found of a model once, its closed start and the pattern of its rows, for whoever solves it again
// (docs/architecture.md, "The rooms"). The model's version tells whether it still is that model.
#include "livens/dynamics/start/prepared.h"

#include <cstring>
#include <span>
#include <utility>

#include "livens/dynamics/rows/tables.h"
#include "livens/dynamics/start/singular.h"
#include "livens/multibody/model.h"

namespace livens {

namespace {

/// To the signs of zeros.
bool are_same(const State& a, const State& b)
{
    const auto same = [](const auto& x, const auto& y) {
        // Bytes and not values: a start that differs in the sign of a zero may end in other bits.
        return x.size() == y.size() && (x.empty() || std::memcmp(&x[0], &y[0], x.size() * sizeof(x[0])) == 0);
    };
    return same(std::span(&a.t, 1), std::span(&b.t, 1)) && same(a.X, b.X) && same(a.V, b.V) &&
           same(a.angles, b.angles);
}

}   // namespace

Prepared::Prepared() = default;
Prepared::~Prepared() = default;

/// All that is kept is of one version of a model, and goes with it.
void Prepared::serve(const Model& model)
{
    if (version_ == model.version()) return;
    version_ = model.version();
    closed_.reset();
    regular_.reset();
    pattern_ = std::make_shared<KnownPattern>();
}

TriedStart Prepared::try_close(const Model& model, const State& start, StartPolicy policy)
{
    serve(model);
    if (closed_ && closed_->policy == policy && are_same(closed_->state, start)) return {closed_->closed, {}};
    TriedStart tried = try_consistent_start(model, start, policy);
    if (tried.closed) closed_ = AcceptedElements{start, policy, *tried.closed};
    return tried;
}

ConsistentStart Prepared::close(const Model& model, const State& start, StartPolicy policy)
{
    TriedStart tried = try_close(model, start, policy);
    if (!tried.closed) throw InputError(std::move(tried.why));
    return std::move(*tried.closed);
}

std::optional<Complaint> Prepared::why_singular(const Model& model, const ConsistentStart& closed)
{
    serve(model);
    if (regular_ && are_same(*regular_, closed.start)) return {};
    std::optional<Complaint> why = livens::why_singular(model, closed);
    if (!why) regular_ = closed.start;
    return why;
}

std::shared_ptr<KnownPattern> Prepared::pattern(const Model& model)
{
    serve(model);
    return pattern_;
}

}   // namespace livens
