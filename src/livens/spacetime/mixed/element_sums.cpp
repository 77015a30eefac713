// SPDX-License-Identifier: BSD-3-Clause
// The integrals behind d(P23)/d(unknowns), element by element. Functions of time and numbers of the bodies
// part: masses and Hessians are constant, so that M_a M_b and M_a M_b lambda are enough for them; gradients
// and tangents of loads are summed number by number (docs/theory.md, "The elements of the paper").
#include "livens/spacetime/mixed/element_sums.h"

#include "livens/multibody/model.h"

namespace livens::mixed {

/// A block of 12 x 12 for each body that a load acts on and each that it depends on; likewise of rows that
/// are no quadratic forms, whose Hessians are not constant. The world has no coordinates.
LoadSums::LoadSums(const FieldSpace& space) : space_(space)
{
    const Coordinates& m = space.coordinates;
    const std::vector<Load>& loads = m.tables.model->loads();
    for (int l = 0; l < static_cast<int>(loads.size()); ++l) {
        if (!loads[l].depends_on_X && !loads[l].depends_on_V) continue;
        for (int by = 0; by < static_cast<int>(loads[l].n_acted); ++by)
            for (int of = 0; of < static_cast<int>(loads[l].bodies.size()); ++of)
                if (loads[l].bodies[by] != world && loads[l].bodies[of] != world)
                    blocks_.push_back({l, -1, by, of, loads[l].bodies[by], loads[l].bodies[of], {}, {}});
    }
    for (int k = 0; k < m.n_rows(); ++k) {
        const RowTable& row = m.tables.rows[m.rows[k]];
        for (const int by : row.bodies)
            for (const int of : row.bodies)
                if (!row.is_quadratic) blocks_.push_back({-1, k, 0, 0, by, of, {}, {}});
    }
}

void LoadSums::clear()
{
    const std::size_t n = static_cast<std::size_t>(space_.functions.n_local());
    sums_.assign(n * n * blocks_.size() * 144, 0.0);
}

/// Blocks of one load stand side by side, so that its tangent is made once a point.
void LoadSums::add(const FieldSample& sample, int e, int g)
{
    const Coordinates& m = space_.coordinates;
    const ModelTables& tables = m.tables;
    LoadTangent tangent;
    int of_load = -1;
    for (std::size_t l = 0; l < blocks_.size(); ++l) {
        Block& block = blocks_[l];
        if (block.row >= 0) {   // of -lambda G
            const Matrix<12, 12> H =
                constraint_hessian(*tables.rows[m.rows[block.row]].row, {}, Configurations(sample.X.data()),
                                   block.body_by, block.body_of);
            add_products(block, l, -sample.lambda[block.row] * H, {}, e, g);
            continue;
        }
        const Load& load = tables.model->loads()[block.load];
        if (block.load != of_load) {
            tangent = LoadTangent(load.bodies.size(), load.n_acted);
            load.tangent(tables.loads.arguments(block.load, {space_.functions.time(e, g), Side::middle},
                                                sample.X.data(), sample.V.data()),
                         tangent);
            of_load = block.load;
        }
        add_products(block, l, tangent.X[block.by][block.of], tangent.V[block.by][block.of], e, g);
    }
}

/// The entries of block l, times all products of functions.
void LoadSums::add_products(Block& block, std::size_t l, const Matrix<12, 12>& by_X,
                            const Matrix<12, 12>& by_V, int e, int g)
{
    const BlockFunctions& functions = space_.functions;
    const double *M = functions.M(e, g), *D = functions.D(e, g);
    const int n = functions.n_local();
    for (int i = 0; i < 144; ++i) {
        if (by_X.a[i] == 0 && by_V.a[i] == 0) continue;
        block.seen.set(static_cast<std::size_t>(i));
        for (int a = 0; a < n; ++a)
            for (int b = 0; b < n; ++b) {
                const double value = functions.weight(e, g) * M[a];
                const std::size_t pair = static_cast<std::size_t>(a) * n + b;
                sums_[(pair * blocks_.size() + l) * 144 + i] += value * (M[b] * by_X.a[i] + D[b] * by_V.a[i]);
            }
    }
}

void LoadSums::see(const LoadSums& other)
{
    for (std::size_t l = 0; l < blocks_.size(); ++l) blocks_[l].seen |= other.blocks_[l].seen;
}

void LoadSums::expect(const LoadSums& other)
{
    for (std::size_t l = 0; l < blocks_.size(); ++l) blocks_[l].entries = other.blocks_[l].entries;
}

bool LoadSums::has_grown()
{
    bool has_grown = false;
    for (Block& block : blocks_) {
        has_grown = has_grown || block.seen != block.entries;
        block.entries = block.seen;
    }
    return has_grown;
}

ElementSums::ElementSums(const FieldSpace& the_space) : space(the_space), loads(the_space) { clear(); }

void ElementSums::clear()
{
    const Coordinates& m = space.coordinates;
    const std::size_t n = static_cast<std::size_t>(space.functions.n_local());
    MM.assign(n * n, 0.0);
    MD.assign(n * n, 0.0);
    G.assign(n * space.functions.n_local_multipliers() * m.gradient_entries.size(), 0.0);
    K.assign(n * n * m.n_rows(), 0.0);
    loads.clear();
}

void ElementSums::integrate(const Fields& fields, int e)
{
    clear();
    for (int g = 0; g < space.functions.n_gauss(); ++g) {
        sample.take(space, fields, e, g);
        space.coordinates.gradients(sample.X.data(), gradients);
        add_point(e, g);
        if (!loads.blocks().empty()) loads.add(sample, e, g);
    }
}

/// What a Gauss point adds to all but the loads.
void ElementSums::add_point(int e, int g)
{
    const BlockFunctions& functions = space.functions;
    const int n_rows = space.coordinates.n_rows(), n_L = functions.n_local_multipliers();
    const double *M = functions.M(e, g), *D = functions.D(e, g), *L = functions.L(e, g);
    for (int a = 0; a < functions.n_local(); ++a) {
        const double value = functions.weight(e, g) * M[a];
        for (int b = 0; b < functions.n_local(); ++b) {
            const double of_pair = value * M[b];
            MM[pair(a, b)] += of_pair;
            MD[pair(a, b)] += value * D[b];
            double* of_rows = K.data() + pair(a, b) * n_rows;
            for (int k = 0; k < n_rows; ++k) of_rows[k] += of_pair * sample.lambda[k];
        }
        for (int b = 0; b < n_L; ++b) {
            const double of_pair = value * L[b];
            double* of_entries = G.data() + (static_cast<std::size_t>(a) * n_L + b) * gradients.size();
            for (std::size_t i = 0; i < gradients.size(); ++i) of_entries[i] += of_pair * gradients[i];
        }
    }
}

}   // namespace livens::mixed
