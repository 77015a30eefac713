// SPDX-License-Identifier: BSD-3-Clause
// Matrices in blocks against their sum.
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "block_systems.h"

namespace livens::blocks_test {
namespace {

TEST(BlockMatrix, GivesEveryBlockAPlaceOfItsOwn)
{
    const BlockStructure s = random_structure(3, 5);
    BlockMatrix matrix;
    matrix.resize(s);
    for (int e = 0; e < s.n_elements(); ++e) {
        const auto [first, last] = s.elements[static_cast<std::size_t>(e)];
        EXPECT_EQ(matrix.storage(e).size(), static_cast<std::size_t>(matrix.n_rows(e) * matrix.n_columns(e)));
        EXPECT_EQ(matrix.block(e, first, first), matrix.storage(e).data());
        for (int a = first; a <= last; ++a)
            for (int b = first; b <= last; ++b)
                for (int i = 0; i < s.n_rows[static_cast<std::size_t>(a)]; ++i)
                    for (int j = 0; j < s.n_unknowns[static_cast<std::size_t>(b)]; ++j)
                        matrix.block(e, a, b)[i * matrix.stride(e) + j] += 1;
        for (double v : matrix.storage(e)) EXPECT_EQ(v, 1);
    }
    matrix.clear();
    for (double v : matrix.storage(0)) EXPECT_EQ(v, 0);
}

TEST(BlockMatrix, IsTheSumOfItsElements)
{
    for (const BlockStructure& s : {random_structure(1, 1), random_structure(6, 2), spline_structure(5, 3, 2),
                                    random_forward_structure(5, 3),
                                    mirrored(random_forward_structure(5, 3))}) {
        BlockMatrix matrix;
        matrix.resize(s);
        fill(s, 17, matrix);
        const SparseMatrix A = to_sparse(s, matrix), expected = sparse(dense(s, matrix));
        EXPECT_EQ(A.column_starts, expected.column_starts);
        EXPECT_EQ(A.rows, expected.rows);
        EXPECT_EQ(A.values, expected.values);
    }
}

TEST(BlockMatrix, LeavesZerosOutOfTheSparseMatrix)
{
    const BlockStructure s = spline_structure(3, 1, 2);
    BlockMatrix matrix;
    matrix.resize(s);
    EXPECT_EQ(to_sparse(s, matrix).n_entries(), 0);
    matrix.block(1, 1, 2)[1] = 3;
    const SparseMatrix A = to_sparse(s, matrix);
    ASSERT_EQ(A.n_entries(), 1);
    EXPECT_EQ(A.rows[0], 2);
    EXPECT_EQ(A.column_starts[5], 0);
    EXPECT_EQ(A.column_starts[6], 1);
}

std::string refusal(const BlockStructure& s)
{
    try {
        s.check();
    } catch (const std::invalid_argument& error) {
        return error.what();
    }
    return "";
}

TEST(BlockStructure, IsRefusedWhereNodesElementsOrCountsDoNotFit)
{
    const BlockStructure good = spline_structure(3, 1, 2);   // nodes 0..3
    EXPECT_EQ(refusal(good), "");
    EXPECT_EQ(refusal({}), "") << "nothing at all is a structure too";
    const auto with = [&](auto change) {
        BlockStructure s = good;
        change(s);
        return refusal(s);
    };
    const auto contains = [](const std::string& text, const char* part) {
        return text.find(part) != std::string::npos ? ::testing::AssertionSuccess()
                                                    : ::testing::AssertionFailure() << text;
    };
    EXPECT_TRUE(contains(with([](auto& s) { s.n_rows.pop_back(); }), "other nodes"));
    EXPECT_TRUE(contains(with([](auto& s) { s.n_rows[1] = -1; }), "negative"));
    EXPECT_TRUE(contains(with([](auto& s) { s.n_rows[1] = 7; }), "13 rows for 8 unknowns"));
    EXPECT_TRUE(contains(with([](auto& s) { s.elements[1] = {2, 2}; }), "element 1 spans nodes 2 to 2 of 4"));
    EXPECT_TRUE(contains(with([](auto& s) { s.elements[2] = {2, 4}; }), "element 2 spans nodes 2 to 4 of 4"));
    EXPECT_TRUE(contains(with([](auto& s) { std::swap(s.elements[0], s.elements[1]); }), "out of order"));
    EXPECT_TRUE(contains(with([](auto& s) { s.elements.erase(s.elements.begin() + 1); }), "shares no node"));
    EXPECT_TRUE(contains(with([](auto& s) { s.elements.pop_back(); }), "do not cover"));
    EXPECT_TRUE(contains(with([](auto& s) { s.elements.erase(s.elements.begin()); }), "do not cover"));
}

}   // namespace
}   // namespace livens::blocks_test
