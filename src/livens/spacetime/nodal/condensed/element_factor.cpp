// SPDX-License-Identifier: BSD-3-Clause
// With P = [T, z] of all bodies, outwards from the roots, twists that joints let be are P theta, and rows of
// which joints take nothing are P^T r. From the leaves inwards, of a body b with the parent p,
//
//     J_pp += T^T J_bb T + T^T J_bp + J_pb T,    D = z^T J_bb z,
//     J_pp -= (J_pb + T^T J_bb) z D^-1 z^T (J_bp + J_bb T),
//
// and the ends of the element are a neighbour that all bodies have, which stays.
#include "livens/spacetime/nodal/condensed/element_factor.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "livens/spacetime/nodal/kernel/joint_motion.h"

namespace livens {

namespace {

/// Of freedoms by what is left of their neighbours: far above 1 the element is near a motion that needs
/// nothing of its ends, and row exchanges between bodies would be needed.
constexpr double most_growth = 1e6;

Numbers transposed(const Numbers& A, int rows, int columns)
{
    Numbers out(A.size());
    for (int r = 0; r < rows; ++r)
        for (int c = 0; c < columns; ++c) out[c * rows + r] = A[r * columns + c];
    return out;
}

bool is_small(const Numbers& values)
{
    return std::ranges::all_of(values, [](double v) { return std::abs(v) <= most_growth; });
}

}   // namespace

void ElementFactor::resize(const JointForest& forest, const ElementSizes& sizes)
{
    sizes_ = sizes;
    functions_ = lanes::functions(sizes.q)->blocks;
    gone_.assign(forest.bodies.size(), {});
    first_.assign(1, 0);
    for (const JointForest::Body& body : forest.bodies) first_.push_back(first_.back() + body.d * sizes.q);
}

/// Nodes inside have both rows and unknowns, so that one T and one z serve either side.
bool ElementFactor::set_motion(const JointForest& forest, int b, const double* own, const double* above)
{
    const auto& [parent, rows, d, f] = forest.bodies[b];
    const int n = parent == world ? 0 : forest.bodies[parent].d, q = sizes_.q;
    gone_[b].z.resize(static_cast<std::size_t>(d * f * q));
    gone_[b].T.resize(static_cast<std::size_t>(d * n * q));
    return find_motion(*functions_, {d - f, d, n, q}, {own, above}, gone_[b].z.data(), gone_[b].T.data());
}

/// What the body has by itself and by others goes to its parent, as far as both move alike.
void ElementFactor::pass_to_parent(const JointForest& forest, int b, const Numbers& Jz, ElementBlocks& blocks)
{
    const auto& [p, rows, d, f] = forest.bodies[b];
    ElementBlocks::OfBody &own = blocks.bodies[b], &above = blocks.bodies[p];
    Gone& gone = gone_[b];
    const int q = sizes_.q, n = forest.bodies[p].d, of_above = n * q;
    const lanes::BlockSize of_T{d, n, q}, of_z{d, f, q};
    Numbers by_parent = std::move(own.by_parent);   // J_bp + J_bb T
    by_parent.resize(static_cast<std::size_t>(d * q * of_above), 0.0);
    functions_->add_from_right(own.own.data(), d * q, gone.T.data(), of_T, false, by_parent.data());
    functions_->add_from_left(gone.T.data(), of_T, by_parent.data(), of_above, above.own.data(), of_above);
    gone.of_parent.assign(static_cast<std::size_t>(of_above * f * q), 0.0);
    functions_->add_from_left(gone.T.data(), of_T, Jz.data(), f * q, gone.of_parent.data(), f * q);
    if (!own.of_parent.empty()) {
        functions_->add_from_right(own.of_parent.data(), of_above, gone.T.data(), of_T, false,
                                   above.own.data());
        functions_->add_from_right(own.of_parent.data(), of_above, gone.z.data(), of_z, false,
                                   gone.of_parent.data());
    }
    gone.by_parent.assign(gone.of_parent.size(), 0.0);
    functions_->add_from_left(gone.z.data(), of_z, by_parent.data(), of_above, gone.by_parent.data(),
                              of_above);
    functions_->add_from_left(gone.T.data(), of_T, own.by_ends.data(), sizes_.n_columns, above.by_ends.data(),
                              sizes_.n_columns);
    functions_->add_from_left(gone.T.data(), of_T, own.of_ends.data(), sizes_.n_rows, above.of_ends.data(),
                              sizes_.n_rows);
}

bool ElementFactor::eliminate(const JointForest& forest, int b, ElementBlocks& blocks)
{
    const auto& [p, rows, d, f] = forest.bodies[b];
    ElementBlocks::OfBody& own = blocks.bodies[b];
    Gone& gone = gone_[b];
    const int q = sizes_.q, fq = f * q, columns = sizes_.n_columns, n_rows = sizes_.n_rows;
    const lanes::BlockSize of_z{d, f, q};
    Numbers Jz(static_cast<std::size_t>(d * q * fq), 0.0);
    functions_->add_from_right(own.own.data(), d * q, gone.z.data(), of_z, false, Jz.data());
    if (p != world) pass_to_parent(forest, b, Jz, blocks);
    if (f == 0) return true;
    gone.D.A.assign(static_cast<std::size_t>(fq * fq), 0.0);
    functions_->add_from_left(gone.z.data(), of_z, Jz.data(), fq, gone.D.A.data(), fq);
    if (!gone.D.factorise(*functions_, fq)) return false;
    Numbers of_ends(static_cast<std::size_t>(fq * n_rows), 0.0);   // transposed
    functions_->add_from_left(gone.z.data(), of_z, own.of_ends.data(), n_rows, of_ends.data(), n_rows);
    gone.of_ends = transposed(of_ends, fq, n_rows);
    gone.by_ends.assign(static_cast<std::size_t>(fq * columns), 0.0);
    functions_->add_from_left(gone.z.data(), of_z, own.by_ends.data(), columns, gone.by_ends.data(), columns);
    gone.D.solve(*functions_, gone.by_ends.data(), columns);
    functions_->subtract_product(blocks.ends.data(), gone.of_ends.data(), gone.by_ends.data(), n_rows, fq,
                                 columns);
    if (!is_small(gone.by_ends)) return false;
    if (p == world) return true;
    ElementBlocks::OfBody& above = blocks.bodies[p];
    const int of_above = forest.bodies[p].d * q;
    gone.D.solve(*functions_, gone.by_parent.data(), of_above);
    functions_->subtract_product(above.own.data(), gone.of_parent.data(), gone.by_parent.data(), of_above, fq,
                                 of_above);
    functions_->subtract_product(above.by_ends.data(), gone.of_parent.data(), gone.by_ends.data(), of_above,
                                 fq, columns);
    const Numbers left = transposed(gone.by_parent, fq, of_above);
    functions_->subtract_product(above.of_ends.data(), left.data(), of_ends.data(), of_above, fq, n_rows);
    return is_small(gone.by_parent);
}

bool ElementFactor::factorise(const JointForest& forest, ElementBlocks& blocks)
{
    return std::ranges::all_of(forest.order, [&](int b) { return eliminate(forest, b, blocks); });
}

/// What neighbours have by a body's freedoms has no D^-1 in it, what the freedoms have by neighbours does.
/// Transposed, these change their parts: then D^-T comes on the way out.
void ElementFactor::go_inwards(const JointForest& forest, bool is_transposed, std::span<double> inside,
                               double* ends)
{
    const int q = sizes_.q;
    for (const int b : forest.order) {
        const auto& [p, rows, d, f] = forest.bodies[b];
        Gone& gone = gone_[b];
        const double* own = inside.data() + first(b);
        double* const above = p == world ? nullptr : inside.data() + first(p);
        const int n = p == world ? 0 : forest.bodies[p].d;
        if (above != nullptr) functions_->add_from_right(own, 1, gone.T.data(), {d, n, q}, false, above);
        gone.theta.assign(static_cast<std::size_t>(f * q), 0.0);
        double* const theta = gone.theta.data();
        if (f == 0) continue;
        functions_->add_from_right(own, 1, gone.z.data(), {d, f, q}, false, theta);
        if (is_transposed) {
            if (above != nullptr)
                functions_->subtract_product(above, theta, gone.by_parent.data(), 1, f * q, n * q);
            functions_->subtract_product(ends, theta, gone.by_ends.data(), 1, f * q, sizes_.n_columns);
        } else {
            gone.D.solve(*functions_, theta, 1);
            if (above != nullptr)
                functions_->subtract_times(above, gone.of_parent.data(), n * q, f * q, theta);
            functions_->subtract_times(ends, gone.of_ends.data(), sizes_.n_rows, f * q, theta);
        }
    }
}

void ElementFactor::go_outwards(const JointForest& forest, bool is_transposed, const double* ends,
                                std::span<double> inside)
{
    const int q = sizes_.q;
    for (std::size_t i = forest.order.size(); i-- > 0;) {
        const int b = forest.order[i];
        const auto& [p, rows, d, f] = forest.bodies[b];
        Gone& gone = gone_[b];
        double* const own = inside.data() + first(b);
        const double* const above = p == world ? nullptr : inside.data() + first(p);
        const int n = p == world ? 0 : forest.bodies[p].d;
        double* const theta = gone.theta.data();
        std::fill_n(own, d * q, 0.0);
        if (above != nullptr) functions_->add_from_right(above, 1, gone.T.data(), {n, d, q}, true, own);
        if (f == 0) continue;
        if (is_transposed) {
            if (above != nullptr)
                functions_->subtract_product(theta, above, gone.of_parent.data(), 1, n * q, f * q);
            functions_->subtract_product(theta, ends, gone.of_ends.data(), 1, sizes_.n_rows, f * q);
            gone.D.solve_transposed(theta);
        } else {
            if (above != nullptr)
                functions_->subtract_times(theta, gone.by_parent.data(), f * q, n * q, above);
            functions_->subtract_times(theta, gone.by_ends.data(), f * q, sizes_.n_columns, ends);
        }
        functions_->add_from_right(theta, 1, gone.z.data(), {f, d, q}, true, own);
    }
}

long long ElementFactor::n_entries() const
{
    std::size_t n = 0;
    for (const Gone& one : gone_)
        n += one.T.size() + one.z.size() + one.D.A.size() + one.of_parent.size() + one.by_parent.size() +
             one.of_ends.size() + one.by_ends.size();
    return static_cast<long long>(n);
}

}   // namespace livens
