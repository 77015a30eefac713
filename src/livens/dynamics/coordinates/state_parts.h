// SPDX-License-Identifier: BSD-3-Clause
// What a state in coordinates is made of.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "livens/dynamics/coordinates/mechanism.h"

namespace livens::inline dynamics_internal {

struct StateParts {
    StateParts(std::shared_ptr<const Mechanism> the_mechanism, Placed the_placed,
               std::span<const double> the_rates);

    std::shared_ptr<const Mechanism> mechanism;
    Placed placed;
    std::vector<double> rates;
    State state;
    std::vector<Matrix34> centripetal;   ///< [0, w x (w x d_i)] of each body
    std::vector<double> drifts;          ///< twist accelerations without q''

    /// X' of twists.
    std::vector<Matrix34> rates_of_bodies(std::span<const double> twists) const;
    /// J^T N^T of forces on all bodies.
    std::vector<double> along(std::span<const Matrix34> forces) const;
    std::vector<Matrix34> weights() const;
    std::vector<Matrix34> load_forces() const;
    /// Forces along the coordinates that give accelerations, beside weight and the given loads (empty: none).
    std::vector<double> less_loads(std::span<const double> accelerations,
                                   std::span<const Matrix34> loads) const;
    DenseMatrix mass() const;
    /// Its Cholesky factor. Throws InputError.
    DenseMatrix mass_factor() const;
    /// Throws InputError where there is no such body.
    const BodyTable& table_of(int body) const;
    /// One finite number for each rate; throws InputError.
    void check(std::span<const double> given, const std::string& what) const;

private:
    std::vector<double> drifting_twists() const;
    std::vector<Matrix34> inertia_of(std::span<const double> accelerations) const;
    void add_rotors(std::span<const double> accelerations, std::vector<double>& along_rates) const;
};

}   // namespace livens::inline dynamics_internal
