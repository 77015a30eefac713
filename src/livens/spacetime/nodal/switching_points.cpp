// SPDX-License-Identifier: BSD-3-Clause
// The first instant of an element at which a law switches to another of its pieces: samples at 4 (p + 1)
// shares, then bisection where a guard has left its piece, golden section where it may have left it between
// two samples, and Newton's iteration where a vector passes through zero (docs/theory.md, "Laws that bend").
#include "livens/spacetime/nodal/switching_points.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "livens/spacetime/nodal/nodes.h"

namespace livens {

namespace {

/// Of an element's length: nearer to its start is where the one before ended, for a law bends there.
constexpr double behind_start = 1e-7;
/// Looks for each degree and one more.
constexpr int looks_a_degree = 4;
/// Of the way between two looks: a look so near to the first and to the last tells whether a guard comes
/// nearer there.
constexpr double beside_ends = 0.05;
/// Of the change from one of the few first looks to the next: what is farther from its places is not near.
constexpr double far = 2;
/// Of the change between two looks: how near a centre comes to zero that passes through it.
constexpr double is_through = 1e-9;

/// A law goes on between two looks that are as near as numbers are; `end` is some way behind.
struct Passage {
    double share = std::numeric_limits<double>::infinity();
    LawState before, after, end;
};

/// For the first passage of one law.
class Search {
public:
    Search(const WatchedLaw& law, ElementPath& path, const std::vector<double>& shares, double until)
        : law_(law), path_(path), shares_(shares), until_(until)
    {}
    /// `angles`: at the start of the element.
    Passage first(const std::vector<double>& angles);

private:
    LawState look(double share, const LawState& from) { return law_.at(path_, share, from); }
    bool is_inside(const LawState& look) const
    {
        for (std::size_t k = 0; k < pieces_.size(); ++k)
            if (!(pieces_[k].margin(look.numbers[k]) >= 0)) return false;
        return true;
    }
    bool is_calm(const LawState& start);
    Passage bisect(LawState inside, LawState outside);
    Passage graze(const LawState* three);
    Passage through_centre(const LawState& from, const LawState& to);

    const WatchedLaw& law_;
    ElementPath& path_;
    const std::vector<double>& shares_;
    double until_;
    std::vector<Guard::Piece> pieces_;   // of each guard, on which the element begins
};

/// Not even near: by a few looks.
bool Search::is_calm(const LawState& start)
{
    const int n = pieces_.empty() ? 2 : static_cast<int>(shares_.size() - 3) / looks_a_degree;
    std::vector<double> nearest(pieces_.size()), change(pieces_.size(), 0.0);
    for (std::size_t k = 0; k < pieces_.size(); ++k) nearest[k] = pieces_[k].margin(start.numbers[k]);
    double distance = norm(start.centre), way = 0;
    LawState before = start;
    for (int i = 1; before.share < until_; ++i) {
        LawState after = look(std::min(static_cast<double>(i) / n, until_), before);
        for (std::size_t k = 0; k < pieces_.size(); ++k) {
            nearest[k] = std::min(nearest[k], pieces_[k].margin(after.numbers[k]));
            change[k] = std::max(change[k], std::abs(after.numbers[k] - before.numbers[k]));
        }
        distance = std::min(distance, norm(after.centre));
        way = std::max(way, norm(after.centre - before.centre));
        before = std::move(after);
    }
    for (std::size_t k = 0; k < pieces_.size(); ++k)
        if (!(nearest[k] > far * change[k])) return false;
    return !law_.has_centre() || distance > far * way;
}

/// Where the pieces are left for good between an inside and an outside look.
Passage Search::bisect(LawState inside, LawState outside)
{
    Passage passage;
    passage.end = outside;
    for (double middle = 0; middle = inside.share + 0.5 * (outside.share - inside.share),
                middle > inside.share && middle < outside.share;) {
        LawState between = look(middle, inside);
        (is_inside(between) ? inside : outside) = std::move(between);
    }
    passage.share = outside.share;
    passage.before = std::move(inside);
    passage.after = std::move(outside);
    return passage;
}

/// A guard that comes nearest to leaving its piece at the middle one of three looks may have left it between
/// them.
Passage Search::graze(const LawState* three)
{
    constexpr double golden = 0.381966011250105;
    constexpr int most = 60;
    for (std::size_t k = 0; k < pieces_.size(); ++k) {
        const auto margin = [&](const LawState& look) { return pieces_[k].margin(look.numbers[k]); };
        const double a = margin(three[0]), b = margin(three[1]), c = margin(three[2]);
        if (!(b <= a && b <= c && b < (a - b) + (c - b))) continue;   // else it does not come near
        LawState low = three[0], middle = three[1], high = three[2];
        for (int i = 0; i < most && high.share - low.share > 1e-10; ++i) {
            const bool is_left = middle.share - low.share > high.share - middle.share;
            const double to = is_left ? low.share : high.share;
            LawState next = look(middle.share + golden * (to - middle.share), middle);
            if (!is_inside(next)) return bisect(low, next);
            if (margin(next) < margin(middle)) {
                (is_left ? high : low) = std::move(middle);
                middle = std::move(next);
            } else {
                (is_left ? low : high) = std::move(next);
            }
        }
    }
    return {};
}

/// Where the centre passes through zero between two looks.
Passage Search::through_centre(const LawState& from, const LawState& to)
{
    constexpr int most = 12;
    constexpr double beside = 1e-3;   // of the way between two looks
    const Vector3 change = to.centre - from.centre;
    const double width = to.share - from.share, way = norm(change);
    const double place = -dot(from.centre, change) / (way * way);
    if (!(place > -0.5 && place < 1.5) || norm(from.centre + place * change) > 0.5 * way) return {};
    double s = from.share + std::clamp(place, 0.0, 1.0) * width;
    Passage passage;
    for (int i = 0; i < most; ++i) {   // the nearest place, by Newton's iteration
        passage.before = look(s - beside * width, from);
        passage.after = look(s + beside * width, from);
        const Vector3 slope = (0.5 / (beside * width)) * (passage.after.centre - passage.before.centre);
        const Vector3 here = look(s, from).centre;
        const double step = -dot(here, slope) / dot(slope, slope);
        if (!(std::abs(step) < width)) return {};
        s += step;
        if (!(std::abs(step) > 1e-15)) break;
    }
    if (!(s > behind_start && s >= from.share && s < to.share)) return {};
    if (!(norm(look(s, from).centre) <= is_through * way)) return {};
    passage.share = s;
    passage.end = to;
    return passage;
}

Passage Search::first(const std::vector<double>& angles)
{
    LawState start;
    start.angles = angles;
    start = look(behind_start, start);
    for (std::size_t k = 0; k < law_.guards().size(); ++k)
        pieces_.push_back(law_.guards()[k].piece_at(start.numbers[k]));
    if (is_calm(start)) return {};
    LawState three[3];
    three[2] = start;
    const double step = shares_[3] - shares_[2];
    for (std::size_t i = 1; three[2].share < until_; ++i) {
        three[0] = std::move(three[1]);
        three[1] = std::move(three[2]);
        const double share = i < shares_.size() ? shares_[i] : three[1].share + step;
        three[2] = look(std::min(share, until_), three[1]);
        Passage found;
        if (law_.has_centre()) found = through_centre(three[1], three[2]);
        if (i > 1 && std::isinf(found.share)) found = graze(three);
        if (std::isinf(found.share) && !is_inside(three[2])) found = bisect(three[1], three[2]);
        if (!std::isinf(found.share)) return found;
    }
    return {};
}

}   // namespace

SwitchingPoints::SwitchingPoints(const ModelTables& tables, const ElementRule& rule)
    : tables_(tables), path_(tables, rule)
{
    if (!tables.model->has_pieces()) return;
    const auto watch = [this](WatchedLaw law) {
        if (law.has_pieces()) laws_.push_back(std::move(law));
    };
    for (std::size_t l = 0; l < tables.model->loads().size(); ++l) watch({tables, static_cast<int>(l), -1});
    for (int r = 0; r < tables.model->n_rows(); ++r) watch({tables, -1, r});
    const int n = looks_a_degree * rule.size();
    shares_ = {behind_start, beside_ends / n};
    for (int i = 1; i < n; ++i) shares_.push_back(static_cast<double>(i) / n);
    shares_.push_back(1 - beside_ends / n);
    shares_.push_back(1);
}

double SwitchingPoints::first(const WindowLayout& layout, const NodePositions& nodes, double until)
{
    path_.begin(layout, nodes, 0);
    double share = std::numeric_limits<double>::infinity();
    for (const WatchedLaw& law : laws_) {
        // of later laws only what comes before counts
        const Passage found = Search(law, path_, shares_, std::min(until, share)).first(layout.angles);
        if (!(found.share < share)) continue;
        share = found.share;
        jumping_ = law.jumps(path_, found.before, found.after, found.end) ? law.load() : -1;
    }
    return share;
}

}   // namespace livens
