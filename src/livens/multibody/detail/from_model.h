// SPDX-License-Identifier: BSD-3-Clause
// What follows from a model alone and takes time to find. It is made when first asked for, and shared by
// copies of the model: what is solved again, or for a second time to tell the error, begins with it.
#pragma once

#include <atomic>
#include <cstring>
#include <memory>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

#include "livens/multibody/closing.h"
#include "livens/multibody/row_pattern.h"

namespace livens {

class FromModel {
public:
    /// Null: the model was moved from.
    static FromModel* of(const Model& model) { return model.from_this_.get(); }

    std::atomic<double> length{0};   ///< Model::length(), 0: not yet

    /// The last that was given, if it is of these rows; else null.
    std::shared_ptr<const RowPattern> pattern(const std::vector<int>& rows)
    {
        const std::lock_guard lock(mutex_);
        return pattern_ != nullptr && pattern_->chosen() == rows ? pattern_ : nullptr;
    }
    void keep(std::shared_ptr<const RowPattern> pattern)
    {
        const std::lock_guard lock(mutex_);
        pattern_ = std::move(pattern);
    }

    /// close_start() of a state and a policy.
    struct Closed {
        State state;
        StartPolicy policy;
        ClosedStart closed;
    };
    /// The last that was given, if it is of these; else null.
    std::shared_ptr<const Closed> closed(const State& state, StartPolicy policy)
    {
        const std::lock_guard lock(mutex_);
        const auto same = [](const auto& a, const auto& b) {   // to the signs of zeros
            const bool are_equal = a.size() == b.size();
            return are_equal && (a.empty() || std::memcmp(&a[0], &b[0], a.size() * sizeof(a[0])) == 0);
        };
        const bool is_known = closed_ != nullptr && closed_->policy == policy &&
                              same(std::span(&closed_->state.t, 1), std::span(&state.t, 1)) &&
                              same(closed_->state.X, state.X) && same(closed_->state.V, state.V) &&
                              same(closed_->state.angles, state.angles);
        return is_known ? closed_ : nullptr;
    }
    void keep(std::shared_ptr<const Closed> closed)
    {
        const std::lock_guard lock(mutex_);
        closed_ = std::move(closed);
    }

private:
    std::mutex mutex_;
    std::shared_ptr<const RowPattern> pattern_;
    std::shared_ptr<const Closed> closed_;
};

}   // namespace livens
