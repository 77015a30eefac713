// SPDX-License-Identifier: BSD-3-Clause
// Angles that loads count with their turns, which positions alone do not tell.
#pragma once

#include <span>
#include <vector>

#include "livens/multibody/joint_coordinates.h"

namespace [[gnu::visibility("default")]] livens {

class Model;
struct State;

/// Load::angles of all loads of a model. A row holds a number for each, less what it is where the bodies are
/// stated; whoever goes along a motion carries it with him.
class UnwrappedAngles {
public:
    explicit UnwrappedAngles(const Model& model);

    bool empty() const { return angles_.empty(); }
    std::size_t size() const { return angles_.size(); }
    /// The row where nothing has turned yet, or that of a state.
    std::vector<double> begin() const { return std::vector<double>(angles_.size(), 0.0); }
    std::vector<double> begin(const State& state) const;
    /// Goes on to X, each angle the shorter way.
    void follow(const Configurations& X, std::span<double> row) const;
    /// The same of the angles of one load, for which X of its bodies is enough.
    void follow_of(int load, const Configurations& X, std::span<double> row) const;
    /// The part of a load; of an empty row nothing.
    std::span<const double> of(int load, std::span<const double> row) const
    {
        return row.empty() ? row
                           : row.subspan(static_cast<std::size_t>(first_[load]),
                                         static_cast<std::size_t>(first_[load + 1] - first_[load]));
    }

private:
    /// What of a form is not zero; places among the numbers of X.
    struct Terms {
        explicit Terms(const PairForm& form);
        double value(const double* X) const;

        struct Product {
            int x, y;   ///< columns
            double factor;
        };
        struct Entry {
            int place;
            double factor;
        };
        double constant;
        std::vector<Product> products;
        std::vector<Entry> entries;
    };
    struct Angle {
        Terms cosine, sine;
    };

    void follow_some(const Configurations& X, std::span<double> row, int from, int until) const;

    std::vector<Angle> angles_;
    std::vector<int> first_;   ///< of each load, and their number
};

}   // namespace gnu::visibility("default")]]livens
