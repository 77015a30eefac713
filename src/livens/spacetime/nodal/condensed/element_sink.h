// SPDX-License-Identifier: BSD-3-Clause
// Takes the tangent of one element after the other, body by body, and condenses it.
#pragma once

#include <vector>

#include "livens/spacetime/nodal/condensed/along_joints.h"

namespace livens::inline spacetime_internal {

/// Of a body in the null space of a node.
struct NullSpaceRows {
    const double* at;
    int n, f;
};

class ElementSink final : public TangentSink {
public:
    ElementSink(AlongJoints& all, int degree);

    /// What came of an element that was not finished.
    void forget() { e_ = -1; }
    void open(int e, int A, int B) override;
    void mass(int body, double factor, const double* H) override;
    void block(int i, int j, const double* values) override;
    void close() override {}
    void finish(int e) override;

private:
    /// A node of the element at hand: among those inside, or, at its ends, the first of its free motions.
    struct Place {
        int inside = -1, end = -1;
    };

    void begin(int e);
    Place place_of(int A, bool of_rows) const;
    Numbers& inside_block(int i, int j);
    bool set_motions();

    AlongJoints& all_;
    int q_, e_ = -1;
    ElementSizes sizes_;
    ElementBlocks blocks_;
    int A_ = 0, B_ = 0;   // the open pair, and where it stands
    Place row_, column_;
    Numbers product_;           // of a block and a null space
    Numbers own_, above_;       // gradients of rows that hold a body
    std::vector<int> places_;   // of rows in the bases of the nodes inside
};

}   // namespace livens::inline spacetime_internal
