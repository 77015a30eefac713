// SPDX-License-Identifier: BSD-3-Clause
// The functions of time of one block, and their values at the points where elements are integrated.
#pragma once

#include <utility>
#include <vector>

#include "livens/time/time_space.h"

namespace livens::mixed {

inline constexpr int least_shared_functions = 16;   ///< that a thread takes, where there are several

/// The functions M_A of X and P and L_A of the multipliers, with what depends on them alone.
///
/// Multipliers are tested with L_A. What they are made of is the same, but that the function at the start of
/// a torn element is two: one that lives before, one that lives behind.
class BlockFunctions {
public:
    /// `tears`: elements at whose start multipliers may jump, ascending.
    BlockFunctions(TimeSpace space, TimeSpace multipliers, int gauss_points, const std::vector<int>& tears);

    const TimeSpace& space() const { return space_; }
    const TimeSpace& multipliers() const { return multipliers_; }
    int n_elements() const { return space_.n_elements(); }
    int n_gauss() const { return static_cast<int>(places_.size()); }
    int n_local() const { return space_.degree() + 1; }
    int n_local_multipliers() const { return multipliers_.degree() + 1; }
    int first(int e) const { return space_.first(e); }
    /// Elements first..last - 1 that have all of the functions begin..end - 1, and multipliers of these
    /// numbers.
    std::pair<int, int> elements_of(int begin, int end) const;
    /// Of the functions that multipliers are made of; test functions are those of multipliers().
    int first_multiplier(int e) const { return multipliers_.first(e) + n_tears_[e]; }

    /// At a Gauss point: values, derivatives by time, and the point's share of the element's integral.
    const double* M(int e, int g) const { return M_.data() + (e * n_gauss() + g) * n_local(); }
    const double* D(int e, int g) const { return D_.data() + (e * n_gauss() + g) * n_local(); }
    const double* L(int e, int g) const { return L_.data() + (e * n_gauss() + g) * n_local_multipliers(); }
    double weight(int e, int g) const { return weights_[g] * space_.length(e); }
    double time(int e, int g) const { return space_.ends()[e] + places_[g] * space_.length(e); }

    /// Time goes on beyond the ends, with elements of these lengths; 0: it does not.
    void go_on(double before, double behind);

    /// Mean length, and middle, of the elements where function A lives.
    double length(int A) const { return lengths_[A]; }
    double centre(int A) const { return centres_[A]; }

private:
    TimeSpace space_, multipliers_;
    std::vector<double> places_, weights_;   ///< of the Gauss rule on [0, 1]
    std::vector<double> M_, D_, L_;          ///< element, Gauss point, local function
    std::vector<double> lengths_, centres_;
    std::vector<int> n_tears_;   ///< up to the start of each element
};

}   // namespace livens::mixed
