// SPDX-License-Identifier: BSD-3-Clause
// Element ends where laws of loads bend or jump, found by elements that step over them.
#pragma once

#include <limits>
#include <utility>
#include <vector>

namespace livens::inline spacetime_internal {

class Window;

/// Of a march forwards. An element that was solved over a bend is solved again up to there, and once or twice
/// more until that is where it bends: what comes before is then smooth, and so is what comes behind
/// (docs/theory.md, "Laws that bend").
class EventLocator {
public:
    explicit EventLocator(double duration) : shortest_(shortest * duration) {}

    /// Where the element from `start` ends that would end at `wanted`.
    double end(double start, double wanted);
    /// Element ends at which a motion nearby has bends: this one's own are near.
    void expect(std::vector<double> ends) { expected_ = std::move(ends); }
    /// Of an element that ends there: if that is about where a bend is, it moves to its own.
    void begin(double end);
    /// Whether an element end is where a bend was found.
    bool is_found(double end) const { return end == at_; }
    /// True: the solution of the element tells a better end, found().
    bool moves(Window& window, double start, double end);
    double found() const { return at_; }
    /// True: it ends at a bend.
    bool accepted(double start, double end);
    /// Elements have been short for so long that the motion rests on a jump or slides along it, if that is
    /// what bends.
    bool is_stuck() const { return n_tiny_ > most_tiny; }
    /// For so much longer that they will stay so, if a law is why.
    bool is_crawling() const { return n_tiny_ > most_crawling; }

private:
    static constexpr double infinite = std::numeric_limits<double>::infinity();
    /// Of the duration: shorter elements are none.
    static constexpr double shortest = 1e-9;
    /// Ends lie so far before a bend, as a share of the element's length but at least some spacings of
    /// numbers, that their states are on the near side: radau's last load point is there, and a law like
    /// x/abs(x) has no value in between. What is within three times as much is met.
    static constexpr double before = 2e-14;
    /// Of the length: how far beyond an end a bend may lie that it falls short of.
    static constexpr double beyond = 1.5;
    static constexpr int most_moves = 8;
    /// Ends in succession that leave elements less than a share of the length that they might have: the
    /// motion slides along the place, or rests there.
    static constexpr double crowded = 0.01;
    static constexpr int most_crowded = 12;

    /// Of the longest element so far, and how many in succession.
    static constexpr double tiny = 1e-3;
    static constexpr int most_tiny = 300, most_crawling = 2048;

    std::vector<double> expected_;   // ascending
    double shortest_, longest_so_far_ = 0;
    double at_ = -infinite, wanted_ = 0, longest_ = infinite;
    double moved_from_ = -infinite;   // start of the element whose end was moved last
    int n_moves_ = 0, n_crowded_ = 0, n_tiny_ = 0;
    bool is_met_ = false, is_expected_ = false;
};

}   // namespace livens::inline spacetime_internal
