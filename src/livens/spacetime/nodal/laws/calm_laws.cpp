// SPDX-License-Identifier: BSD-3-Clause
// Guards and centres at the load points of an element, as the lanes have them that evaluated the loads
// (docs/theory.md, "Laws that bend").
#include "livens/spacetime/nodal/laws/calm_laws.h"

#include <algorithm>
#include <cmath>

#include "livens/dynamics/lanes/load_program.h"
#include "livens/multibody/model.h"

namespace livens {

namespace {

/// Widest gaps between load points: a guard is farther from its places than it moves there. A centre is
/// farther from zero than it would move on the whole way.
constexpr double gaps_away = 2;
constexpr std::size_t fewest_points = 3;

}   // namespace

CalmLaws::CalmLaws(const ModelTables& tables, const ElementRule& rule)
    : tables_(tables), shares_(rule.loads.points), guards_(tables.model->loads().size(), 0), centres_(guards_)
{
    double before = 0;
    for (const double s : shares_) {
        widest_ = std::max(widest_, s - before);
        before = s;
    }
    widest_ = std::max(widest_, 1 - before);
    for (std::size_t l = 0; l < guards_.size(); ++l) {
        const Load& load = tables.model->loads()[l];
        if (!load.guards.empty() || load.centre) watched_.push_back(static_cast<int>(l));
    }
}

/// Calm is what is known to be: without lanes, or of fewer than three points, nothing is.
void CalmLaws::look(const LoadLanes* loads)
{
    const bool is_known = loads != nullptr && shares_.size() >= fewest_points;
    are_all_ = is_known || watched_.empty();
    for (const int l : watched_) {
        guards_[l] = is_known && are_guards_calm(*loads, l);
        centres_[l] = is_known && is_centre_calm(*loads, l);
        const bool bends = tables_.model->loads()[l].bends_at_centre;
        are_all_ = are_all_ && guards_[l] != 0 && (!bends || centres_[l] != 0);
    }
}

/// Numbers follow each other, as angles do through half a turn. Speeds are by shares of the element.
bool CalmLaws::are_guards_calm(const LoadLanes& loads, int load) const
{
    const std::vector<Guard>& guards = tables_.model->loads()[load].guards;
    const std::vector<int>& places = loads.program().tape().watched()[load].guards;
    if (places.size() != guards.size()) return false;
    for (std::size_t k = 0; k < guards.size(); ++k) {
        const double* number = loads.number(places[k]);
        const Guard::Piece piece = guards[k].piece_at(number[0]);
        double before = number[0], nearest = piece.margin(before), speed = 0;
        for (std::size_t c = 1; c < shares_.size(); ++c) {
            const double now = guards[k].following(number[c], before);
            nearest = std::min(nearest, piece.margin(now));
            speed = std::max(speed, std::abs(now - before) / (shares_[c] - shares_[c - 1]));
            if (std::isnan(now)) return false;
            before = now;
        }
        if (!(nearest > gaps_away * widest_ * speed)) return false;
    }
    return true;
}

bool CalmLaws::is_centre_calm(const LoadLanes& loads, int load) const
{
    const std::vector<int>& places = loads.program().tape().watched()[load].centre;
    if (places.empty()) return false;
    const double* numbers[3];
    for (std::size_t i = 0; i < 3; ++i) numbers[i] = loads.number(places[i]);
    const auto at = [&](std::size_t c) { return Vector3{numbers[0][c], numbers[1][c], numbers[2][c]}; };
    Vector3 before = at(0);
    double nearest = dot(before, before), speed = 0;   // squares
    for (std::size_t c = 1; c < shares_.size(); ++c) {
        const Vector3 now = at(c), moved = now - before;
        const double distance = dot(now, now), gap = shares_[c] - shares_[c - 1];
        if (std::isnan(distance)) return false;
        nearest = std::min(nearest, distance);
        speed = std::max(speed, dot(moved, moved) / (gap * gap));
        before = now;
    }
    return nearest > speed;
}

}   // namespace livens
