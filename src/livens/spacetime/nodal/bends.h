// SPDX-License-Identifier: BSD-3-Clause
// Where on the way of an element a law of a load or row goes on to another of its smooth pieces.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "livens/spacetime/nodal/way.h"

namespace livens {

/// Looks along the polynomials of an element that was solved as if no law bent there: what comes before the
/// first bend is about right, so that an element that ends there is smooth (docs/theory.md, "Laws that
/// bend").
class Bends {
public:
    /// References must outlive it.
    Bends(const Tables& tables, const ElementRule& rule);

    /// No law of the model has pieces.
    bool empty() const { return watches_.empty(); }
    /// The first share of the only element's length, up to `until` (beyond 1: as it goes on), from which on
    /// laws are on other pieces than just behind its start; infinite: none.
    double first(const Stretch& stretch, const Nodes& nodes, double until);
    /// The load whose force jumped there, when a bend was found last; empty: none was, or none jumps.
    std::string jumping_load() const { return jumping_ < 0 ? "" : tables_.model->loads()[jumping_].name; }

private:
    /// A load, or a row, whose guards and centre are looked at.
    struct Watch {
        int load = -1, row = -1;
        std::vector<int> bodies;
        std::vector<Guard> guards;
        bool has_centre = false;
    };
    struct Look {
        double share = 0;
        std::vector<double> numbers;   // of the guards
        Vector3 centre{};
        std::vector<double> angles;   // see Turns
    };
    /// The piece of each guard that the element begins on.
    using Pieces = std::vector<Guard::Piece>;
    /// A law goes on between two looks that are as near as numbers are; `end` is some way behind.
    struct Passage {
        double share = std::numeric_limits<double>::infinity();
        Look before, after, end;
    };

    void watch(int load, int row);
    Passage first_of(const Watch& watch, double until);
    /// Not even near: by a few looks.
    bool is_calm(const Watch& watch, const Pieces& pieces, const Look& start, double until);
    Look look(const Watch& watch, double share, const Look& from);
    /// Where the pieces are left for good between an inside and an outside look.
    Passage bisect(const Watch& watch, const Pieces& pieces, Look inside, Look outside);
    /// A guard that comes nearest to leaving its piece at the middle one of three looks may have left it
    /// between them.
    Passage graze(const Watch& watch, const Pieces& pieces, const Look* three);
    /// Where the centre passes through zero between two looks.
    Passage through_centre(const Watch& watch, const Look& from, const Look& to);
    bool is_jump(const Watch& watch, const Passage& passage);
    LoadForces forces(const Watch& watch, const Look& at);

    const Tables& tables_;
    std::vector<Watch> watches_;
    Way way_;
    std::vector<double> shares_;   // of looks
    const Stretch* stretch_ = nullptr;
    const Nodes* nodes_ = nullptr;
    int jumping_ = -1;
};

}   // namespace livens
