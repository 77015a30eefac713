// SPDX-License-Identifier: BSD-3-Clause
// A mechanism and the coordinates that tell its state, as rows beside those of its joints.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "livens/dynamics/coordinates/generalised_state.h"
#include "livens/dynamics/rows/body_tables.h"
#include "livens/dynamics/rows/load_tables.h"
#include "livens/multibody/rotors.h"
#include "livens/solvers/dense_matrix.h"
#include "livens/solvers/sparse.h"

namespace livens::inline dynamics_internal {

using Configuration = std::vector<Matrix34>;

/// A coordinate of a joint: its row's value and an offset are what the joint counts, up to turns.
struct CountedRow {
    ConstraintRow row;
    double offset = 0;
    bool is_angle = false, counts_turns = false;
    bool is_of_rotation = false;   ///< a component of a rotation vector
};

/// Constant once it is made.
struct Mechanism {
    Mechanism(const Model& the_model, const State& at, StartPolicy policy,
              const std::vector<std::string>& wanted);
    Mechanism(const Mechanism&) = delete;
    Mechanism& operator=(const Mechanism&) = delete;

    Model model;   ///< joints that act, without drives
    BodyTables bodies;
    LoadTables loads;
    std::vector<Rotor> rotors;
    double length;
    Configuration stated;                   ///< where coordinates of joints begin to count
    std::vector<NamedCoordinate> counted;   ///< of all joints
    State placed;                           ///< closed
    std::vector<GeneralisedCoordinate> coordinates;
    std::vector<CountedRow> rows;   ///< of those that are a joint's, else empty ones
    std::vector<double> numbers;    ///< where it is placed
    int rank = 0;                   ///< of the rows of joints, there
    int n_rates = 0;

    /// From X to the numbers: how far each coordinate has to go, n_rates; of a turn a rotation vector.
    std::vector<double> way_to(const Configuration& X, std::span<const double> target) const;
    /// Between numbers, turns of angles counted.
    std::vector<double> way(std::span<const double> from, std::span<const double> to) const;
    /// `from` and a part of the way.
    std::vector<double> gone(std::span<const double> from, std::span<const double> way, double part) const;
    /// Throws where a rotation vector is to be longer than it is known.
    void refuse_half_turns(std::span<const double> target) const;
    bool is_length(int coordinate) const;
    /// What a coordinate is measured in: 1 rad, or a length of the model.
    double unit_of(int coordinate) const;
    /// The largest of a way: rad, or lengths of the model.
    double size_of(std::span<const double> way) const;
    /// Likewise of twists of all bodies.
    double size_of_twists(std::span<const double> twists) const;
    /// The sum of what all coordinates turn any body by on a way, rad: no angle turns farther.
    double farthest_turn(const DenseMatrix& by_rates, std::span<const double> way) const;
    /// Of all rows the largest |Phi| over scale, and which.
    double open(const Configuration& X, int* row = nullptr) const;
};

/// Which coordinates are taken, and how many rows of joints are independent, for the constructor.
std::vector<GeneralisedCoordinate> choose_coordinates(const Model& model, const State& placed,
                                                      const std::vector<int>& independent,
                                                      const std::vector<std::string>& wanted);

/// Independent rows of the joints and the coordinates at one place, solved for twists [v, w] of all bodies
/// about their reference points.
class CoordinateSystem {
public:
    CoordinateSystem(const Mechanism& mechanism, const Configuration& X, std::vector<int> rows);

    /// False: singular to the library.
    bool is_regular() const { return is_regular_; }
    const std::vector<int>& rows() const { return rows_; }
    /// The matrix itself, of any number of rows, and what each row was multiplied by; by [v, L w] with the
    /// model's length L.
    DenseMatrix entries() const;
    double scale(int row) const { return scales_[static_cast<std::size_t>(row)]; }
    /// Twists with given rates of the rows of joints, and then of the coordinates.
    std::vector<double> twists(std::span<const double> rates) const;
    /// Twists by each rate alone: n_twists x n_rates.
    DenseMatrix twists_by_rates() const;

private:
    struct Entry {
        int column;
        double value;
    };
    void add_gradient(const ConstraintRow& row, const Configuration& X);
    void add(std::vector<Entry> entries);

    const Mechanism& mechanism_;
    std::vector<int> rows_;
    double placed_t_;
    std::vector<double> scales_;   // of rows
    std::vector<std::vector<std::pair<int, double>>> columns_;
    SparseMatrix matrix_;
    SparseLU lu_{SparseBackend::eigen};
    bool is_regular_ = true;
};

/// Bodies where the coordinates have their numbers, and where it can go from there.
struct Placed {
    Configuration X;
    std::vector<double> numbers;
    std::vector<double> angles;    ///< of loads
    std::vector<double> counted;   ///< all coordinates of joints, with their turns
    std::shared_ptr<const CoordinateSystem> system;
    DenseMatrix by_rates;   ///< twists of all bodies: n_twists x n_rates
};

/// Bodies moved by a part of a way along the screws of its coordinates, as they are at `from`.
Configuration along_screws(const Mechanism& mechanism, const Placed& from, std::span<const double> way,
                           double part);

/// Where a mechanism is placed; and led from one place to another. Throw as GeneralisedCoordinates::at()
/// does.
Placed placed_at_start(const Mechanism& mechanism);
Placed lead(const Mechanism& mechanism, const Placed& from, std::span<const double> numbers);
/// From nearby, in one step; nothing where that does not close. `numbers` are those that are given.
std::shared_ptr<Placed> led_nearby(const Mechanism& mechanism, const Placed& from,
                                   std::span<const double> numbers);

}   // namespace livens::inline dynamics_internal
