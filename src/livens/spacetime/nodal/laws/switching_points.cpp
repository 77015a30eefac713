// SPDX-License-Identifier: BSD-3-Clause
// The first instant of an element at which a law switches to another of its pieces: samples at 4 (p + 1)
// shares, then bisection where a guard has left its piece, golden section where it may have left it between
// two samples, and Newton's iteration where a vector passes through zero (docs/theory.md, "Laws that bend").
#include "livens/spacetime/nodal/laws/switching_points.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "livens/multibody/model.h"
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
/// Of what a number changes on the way of an element: so far off it the state at the end is another motion.
constexpr double off = 0.1;
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
    /// `looks`: those at the shares were taken; null: they were not.
    Search(const WatchedLaw& law, ElementPath& path, const std::vector<double>& shares, int n_looks,
           double until, const LooksInLanes* looks)
        : law_(law), path_(path), shares_(shares), n_looks_(n_looks), until_(until), looks_(looks)
    {}
    /// `angles`: at the start of the element.
    Passage first(const std::vector<double>& angles);

private:
    LawState look(double share, const LawState& from) { return law_.at(path_, share, from); }
    LawState look_there(std::size_t i, const LawState& from);
    double margin(const LawState& look) const;
    bool comes_near(const LawState* three, std::size_t k) const;
    bool may_pass(const LawState* three, bool are_three);
    Passage pass(const LawState* three, bool are_three);
    void go_alone(std::size_t i, std::size_t& last, LawState* three);
    bool is_inside(const LawState& look);
    bool is_calm(const LawState& start);
    Passage bisect(LawState inside, LawState outside);
    Passage graze(const LawState* three);
    Passage through_centre(const LawState& from, const LawState& to);

    const WatchedLaw& law_;
    ElementPath& path_;
    const std::vector<double>& shares_;
    int n_looks_;   // of equal distance, on the way
    double until_;
    const LooksInLanes* looks_;
    std::vector<Guard::Piece> pieces_;   // of each guard, on which the element begins
    std::vector<double> rounding_;       // of their numbers, once one is outside
    LawState before_;                    // the last look before they were, be it by rounding
};

/// Not even near: by a few looks.
bool Search::is_calm(const LawState& start)
{
    const int n = pieces_.empty() ? 2 : n_looks_ / looks_a_degree;
    std::vector<double> nearest(pieces_.size()), change(pieces_.size(), 0.0);
    for (std::size_t k = 0; k < pieces_.size(); ++k) nearest[k] = pieces_[k].margin(start.numbers[k]);
    double distance = norm(start.centre), way = 0;
    LawState before = start;
    for (int i = 1; before.share < until_; ++i) {
        // those at the ends have another beside them
        const int at = n_looks_ / n * i;
        const std::size_t there = static_cast<std::size_t>(at + (at < n_looks_ ? 1 : 2));
        const bool is_known = looks_ != nullptr && there < shares_.size() && shares_[there] <= until_;
        LawState after =
            is_known ? look_there(there, before) : look(std::min(static_cast<double>(i) / n, until_), before);
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

/// A number that stays where rounding moves it has not left: that of a coordinate which rests by symmetry, or
/// which other joints hold, goes to and fro about its place.
bool Search::is_inside(const LawState& look)
{
    for (std::size_t k = 0; k < pieces_.size(); ++k) {
        const double margin = pieces_[k].margin(look.numbers[k]);
        if (margin >= 0) continue;
        if (std::isnan(margin)) return false;
        if (rounding_.empty()) rounding_ = law_.rounding(path_, look);
        if (!(margin >= -rounding_[k])) return false;
    }
    return true;
}

/// The least of all guards; negative outside.
double Search::margin(const LawState& look) const
{
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < pieces_.size(); ++k)
        least = std::min(least, pieces_[k].margin(look.numbers[k]));
    return least;
}

/// Where the pieces are left for good between an inside and an outside look: bisection whose looks lie near
/// where a straight line leaves, at most one look more and few where guards are smooth
/// [OliveiraTakahashi2020].
Passage Search::bisect(LawState inside, LawState outside)
{
    constexpr double spacing = 1e-16;
    Passage passage;
    if (margin(inside) < 0) inside = before_;
    passage.end = outside;
    const double way = outside.share - inside.share;
    double slack = spacing * std::exp2(std::ceil(std::log2(way / spacing)));
    for (double middle = 0; middle = inside.share + 0.5 * (outside.share - inside.share),
                middle > inside.share && middle < outside.share;
         slack *= 0.5) {
        const double width = outside.share - inside.share, a = margin(inside), b = margin(outside);
        const double leaves = inside.share + width * (a / (a - b)), side = middle < leaves ? -1 : 1;
        // towards the middle from there, so that either end may move; no farther from the middle than `most`
        const double nudge = 0.2 * width * width / way, most = std::max(0.0, slack - 0.5 * width);
        double next = std::abs(middle - leaves) > nudge ? leaves + side * nudge : middle;
        if (!(std::abs(next - middle) <= most)) next = middle - side * most;
        if (!(next > inside.share && next < outside.share)) next = middle;
        LawState between = look(next, inside);
        (margin(between) >= 0 ? inside : outside) = std::move(between);
    }
    passage.share = outside.share;
    passage.before = std::move(inside);
    passage.after = std::move(outside);
    return passage;
}

/// Guard k is nearest to leaving its piece at the middle one of three looks.
bool Search::comes_near(const LawState* three, std::size_t k) const
{
    const double a = pieces_[k].margin(three[0].numbers[k]), b = pieces_[k].margin(three[1].numbers[k]),
                 c = pieces_[k].margin(three[2].numbers[k]);
    return b <= a && b <= c && b < (a - b) + (c - b);
}

/// A guard that comes nearest to leaving its piece at the middle one of three looks may have left it between
/// them.
Passage Search::graze(const LawState* three)
{
    constexpr double golden = 0.381966011250105;
    constexpr int most = 60;
    for (std::size_t k = 0; k < pieces_.size(); ++k) {
        const auto margin_of = [&](const LawState& look) { return pieces_[k].margin(look.numbers[k]); };
        if (!comes_near(three, k)) continue;
        LawState low = three[0], middle = three[1], high = three[2];
        for (int i = 0; i < most && high.share - low.share > 1e-10; ++i) {
            const bool is_left = middle.share - low.share > high.share - middle.share;
            const double to = is_left ? low.share : high.share;
            LawState next = look(middle.share + golden * (to - middle.share), middle);
            if (!is_inside(next)) return bisect(low, next);
            if (margin_of(next) < margin_of(middle)) {
                (is_left ? high : low) = std::move(middle);
                middle = std::move(next);
            } else {
                (is_left ? low : high) = std::move(next);
            }
        }
    }
    return {};
}

/// Whether the centre, going straight from look to look, comes near zero.
bool may_meet_centre(const LawState& from, const LawState& to)
{
    const Vector3 change = to.centre - from.centre;
    const double way = norm(change), place = -dot(from.centre, change) / (way * way);
    return place > -0.5 && place < 1.5 && norm(from.centre + place * change) <= 0.5 * way;
}

/// Where the centre passes through zero between two looks.
Passage Search::through_centre(const LawState& from, const LawState& to)
{
    constexpr int most = 12;
    constexpr double beside = 1e-3;   // of the way between two looks
    const Vector3 change = to.centre - from.centre;
    const double width = to.share - from.share, way = norm(change);
    const double place = -dot(from.centre, change) / (way * way);
    if (!may_meet_centre(from, to)) return {};
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

/// Look i of those that were taken. Angles stay as they are in `from`.
LawState Search::look_there(std::size_t i, const LawState& from)
{
    LawState state{shares_[i], std::vector<double>(pieces_.size()), {}, from.angles};
    looks_->guards(law_.load(), i, state.numbers.data());
    if (law_.has_centre()) looks_->centre(law_.load(), i, &state.centre[0]);
    for (std::size_t k = 0; k < pieces_.size(); ++k)
        state.numbers[k] = law_.guards()[k].following(state.numbers[k], from.numbers[k]);
    return state;
}

/// Whether pass() may find something.
bool Search::may_pass(const LawState* three, bool are_three)
{
    if (law_.has_centre() && may_meet_centre(three[1], three[2])) return true;
    for (std::size_t k = 0; are_three && k < pieces_.size(); ++k)
        if (comes_near(three, k)) return true;
    return !is_inside(three[2]);
}

/// Between the last ones of some looks.
Passage Search::pass(const LawState* three, bool are_three)
{
    Passage found;
    if (are_three && !is_inside(three[1])) return bisect(three[0], three[1]);   // lanes round otherwise
    if (law_.has_centre()) found = through_centre(three[1], three[2]);
    if (are_three && std::isinf(found.share)) found = graze(three);
    if (std::isinf(found.share) && !is_inside(three[2])) found = bisect(three[1], three[2]);
    return found;
}

/// From look `last` on to look i and the two before it.
void Search::go_alone(std::size_t i, std::size_t& last, LawState* three)
{
    for (; last < i; ++last) {
        three[0] = std::move(three[1]);
        three[1] = std::move(three[2]);
        const double share = std::min(
            last + 1 < shares_.size() ? shares_[last + 1] : three[1].share + shares_[3] - shares_[2], until_);
        if (last + 3 < i && last + 1 < shares_.size() && share == shares_[last + 1]) {   // only its angles
            three[2] = look_there(last + 1, three[1]);
            three[2].angles = law_.angles_at(path_, share, three[1].angles);
        } else {
            three[2] = look(share, three[1]);
        }
    }
}

Passage Search::first(const std::vector<double>& angles)
{
    LawState start;
    start.angles = angles;
    start = look(behind_start, start);
    for (std::size_t k = 0; k < law_.guards().size(); ++k)
        pieces_.push_back(law_.guards()[k].piece_at(start.numbers[k]));
    if (is_calm(start)) return {};
    LawState three[3], alone[3];   // as lanes have them, and by the law alone where something may be found
    three[2] = alone[2] = start;
    std::size_t last = 0;   // of those alone
    const double step = shares_[3] - shares_[2];
    for (std::size_t i = 1; three[2].share < until_; ++i) {
        three[0] = std::move(three[1]);
        three[1] = std::move(three[2]);
        const double share = std::min(i < shares_.size() ? shares_[i] : three[1].share + step, until_);
        const bool is_known = looks_ != nullptr && i < shares_.size() && share == shares_[i];
        three[2] = is_known ? look_there(i, three[1]) : look(share, three[1]);
        if (margin(three[2]) < 0 && margin(three[1]) >= 0) before_ = three[1];
        if (is_known && !may_pass(three, i > 1)) continue;
        if (looks_ != nullptr) go_alone(i, last, alone);
        const Passage found = pass(looks_ != nullptr ? alone : three, i > 1);
        if (!std::isinf(found.share)) return found;
    }
    return {};
}

}   // namespace

std::string SwitchingPoints::jumping_load() const
{
    return jumping_ < 0 ? "" : tables_.model->loads()[jumping_].name;
}

SwitchingPoints::SwitchingPoints(const ModelTables& tables, const ElementRule& rule, const CalmLaws& calm)
    : tables_(tables), rule_(rule), calm_(calm), path_(tables, rule)
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
    shares_beyond_ = shares_;
    for (int i = 1; i <= n / 2; ++i) shares_beyond_.push_back(1 + static_cast<double>(i) / n);
    n_looks_ = n;
    path_.expect(rule, shares_beyond_);
}

/// Nowhere near a bend in the element itself.
bool SwitchingPoints::is_calm(const WatchedLaw& law) const
{
    return law.load() >= 0 && calm_.has_calm_guards(law.load()) &&
           (!law.has_centre() || calm_.has_calm_centre(law.load()));
}

double SwitchingPoints::first(const WindowLayout& layout, const NodePositions& nodes, double until)
{
    path_.begin(layout, nodes, 0);
    double share = std::numeric_limits<double>::infinity();
    bool has_looked = false;
    const std::vector<double>& shares = until <= 1 ? shares_ : shares_beyond_;
    std::optional<LooksInLanes>& looks = until <= 1 ? looks_ : beyond_;
    for (const WatchedLaw& law : laws_) {
        if (until <= 1 && is_calm(law)) continue;
        if (!looks) looks.emplace(tables_, rule_, RecordedLoads::guards, shares);
        const bool is_seen =
            law.load() >= 0 && looks->knows_guards(law.load(), law.guards().size(), law.has_centre());
        if (is_seen && !std::exchange(has_looked, true)) looks->look(layout, nodes, 0, layout.angles);
        // of later laws only what comes before counts
        Search search(law, path_, shares, n_looks_, std::min(until, share), is_seen ? &*looks : nullptr);
        const Passage found = search.first(layout.angles);
        if (!(found.share < share)) continue;
        share = found.share;
        jumping_ = law.jumps(path_, found.before, found.after, found.end) ? law.load() : -1;
    }
    return share;
}

/// A number of the law is out of the piece on which the way ends, and not by rounding.
bool SwitchingPoints::is_off(const WatchedLaw& law, const LawState& last, const LawState& there)
{
    for (std::size_t k = 0; k < law.guards().size(); ++k) {
        const double out = -law.guards()[k].piece_at(last.numbers[k]).margin(there.numbers[k]);
        if (!(out > 0)) continue;
        const LawState middle = law.at(path_, 0.5, last), first = law.at(path_, behind_start, middle);
        const auto [low, high] = std::minmax({first.numbers[k], middle.numbers[k], last.numbers[k]});
        if (out > off * (high - low) && out > law.rounding(path_, last)[k]) return true;
    }
    return false;
}

SwitchingPoints::OffTheWay SwitchingPoints::off_the_way(const WindowLayout& layout,
                                                        const NodePositions& nodes, int e, const double* X,
                                                        const double* V, const std::vector<double>& angles)
{
    const bool is_alone = layout.n_elements() == 1;
    path_.begin(layout, nodes, e);
    for (const WatchedLaw& law : laws_) {
        if (law.load() < 0 || law.guards().empty() || (is_alone && is_calm(law))) continue;
        LawState near;
        near.angles = angles;
        const LawState last = law.at(path_, 1, near);
        const Instant end{path_.start() + path_.h(), Side::left};
        if (!is_off(law, last, law.at(end, X, V, angles, last))) continue;
        path_.go(1, law.bodies());
        std::vector<double> jump = law.jump_between(end, X, {path_.V(), V}, last);
        if (!jump.empty()) return {law.load(), std::move(jump)};
    }
    return {};
}

}   // namespace livens
