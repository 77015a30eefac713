// SPDX-License-Identifier: BSD-3-Clause
// What the matrix of a block is made of: integrals over one element for every pair of its functions.
#pragma once

#include <bitset>
#include <vector>

#include "livens/spacetime/mixed/fields.h"

namespace livens::mixed {

/// Integrals of the loads' tangents, 12 x 12 for each pair of bodies of a load; and of the reactions of rows
/// that are no quadratic forms, whose Hessians are not constant.
///
/// Which of these entries are ever other than zero no load tells beforehand: they are remembered as they
/// come.
class LoadSums {
public:
    struct Block {
        int load, row;   ///< one of them; -1: it is of the other kind
        int by, of;      ///< derivative of the force on body `by` by X of body `of`: places in Load::bodies
        int body_by, body_of;
        std::bitset<144> entries, seen;
    };
    explicit LoadSums(const FieldSpace& space);

    void clear();
    /// What a Gauss point adds.
    void add(const FieldSample& sample, int e, int g);
    /// Entries that are seen by now, also by others; whether some were not there when this was asked last.
    void see(const LoadSums& other);
    bool has_grown();
    /// Expects entries that another one has.
    void expect(const LoadSums& other);
    const std::vector<Block>& blocks() const { return blocks_; }
    const double* of(std::size_t pair, std::size_t block) const
    {
        return sums_.data() + (pair * blocks_.size() + block) * 144;
    }

private:
    void add_products(Block& block, std::size_t l, const Matrix<12, 12>& by_X, const Matrix<12, 12>& by_V,
                      int e, int g);

    const FieldSpace& space_;
    std::vector<Block> blocks_;
    std::vector<double> sums_;
};

/// All integrals of one element, by pair of local functions.
struct ElementSums {
    explicit ElementSums(const FieldSpace& space);

    const FieldSpace& space;
    std::vector<double> MM, MD;   ///< M_a M_b, M_a M_b'
    std::vector<double> G;        ///< M_a L_b times the gradient's entries
    std::vector<double> K;        ///< M_a M_b lambda, rows
    LoadSums loads;
    FieldSample sample;
    std::vector<double> gradients;   ///< at a Gauss point

    std::size_t pair(int a, int b) const
    {
        return static_cast<std::size_t>(a) * space.functions.n_local() + b;
    }
    void integrate(const Fields& fields, int e);

private:
    void clear();
    void add_point(int e, int g);
};

}   // namespace livens::mixed
