// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "livens/multibody/model.h"

namespace livens::inline multibody_internal {

/// acting_at() for who asks at many instants: made once for all with the same joints. The model must outlive
/// it.
class ActingModels {
public:
    explicit ActingModels(const Model& model) : model_(model) {}

    const Model& whole() const { return model_; }
    std::shared_ptr<const ActingModel> at(double t);

private:
    const Model& model_;
    std::mutex mutex_;
    std::vector<std::shared_ptr<const ActingModel>> known_;   // few: those of the phases
};

}   // namespace livens::inline multibody_internal
