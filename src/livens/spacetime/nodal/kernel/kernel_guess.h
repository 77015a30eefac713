// SPDX-License-Identifier: BSD-3-Clause
// Initial guesses of the march kernel for an element.
#pragma once

#include <vector>

#include "livens/spacetime/nodal/kernel/extrapolation.h"
#include "livens/spacetime/nodal/kernel/reference_predictor.h"
#include "livens/spacetime/nodal/series.h"

namespace livens::inline spacetime_internal {

/// Guesses: a motion nearby where one is followed, else the Taylor series at the start or the polynomial of
/// the element before, whichever was nearer to the end of the last element (docs/theory.md, "Without a
/// tangent", Guesses). Places are those of lanes::Values.
class KernelGuess {
public:
    /// References must outlive it; functions null: it is not asked for guesses.
    KernelGuess(const ModelTables& tables, const ElementRule& rule, const lanes::Functions* functions);

    void follow(const Motion& motion)
    {
        following_ = ReferencePredictor(motion, tables_, rule_, *functions_);
    }
    /// To be called once an element.
    void begin()
    {
        if (n_alone_ > 0) --n_alone_;
    }
    /// Places of all nodes of the element of `stretch` from `start`.
    void place(const WindowLayout& layout, const InstantState& start, double* place);
    /// The last guess was that of the motion that is followed.
    bool was_followed() const { return was_followed_; }
    /// Nothing is followed for some elements from this one on: the motion is too near for steps that shrink
    /// fast, or too far.
    void part();
    /// Learns from the solved element, if a polynomial serves; `place` must stay as it is.
    bool learns() const { return polynomial_.serves(); }
    void compare(const double* place);
    void remember(const double* place, const WindowLayout& layout);
    /// The next element does not continue the last one.
    void forget();
    void forget_polynomial() { polynomial_.forget(); }

private:
    struct End {
        std::vector<double> place;   // 7 numbers a body
        bool is_known = false;
    };

    void place_series(const TwistSeries& series, double tau, const InstantState& start, int stride,
                      double* place);
    void keep_end(End& end, const double* place) const;
    double moved_from(const End& end, const double* place) const;

    const ModelTables& tables_;
    const ElementRule& rule_;
    const lanes::Functions* functions_;
    End by_series_, by_polynomial_;
    Extrapolation polynomial_;
    ReferencePredictor following_;
    bool was_followed_ = false;
    int n_alone_ = 0;              // elements for which nothing is followed
    bool is_polynomial_ = false;   // as that was nearer to the end of the last element
    std::vector<double> twist_;
};

}   // namespace livens::inline spacetime_internal
