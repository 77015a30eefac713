// SPDX-License-Identifier: BSD-3-Clause
// How much a function of time alternates from sample to sample: what zigzag() is made of.
#pragma once

#include <span>
#include <vector>

#include "livens/multibody/model.h"

namespace livens::inline diagnostics_internal {

/// Twice the kinetic energy of velocities is their square in the mass matrices, which are the sum of two:
/// what the centres of mass have, and what the spins have about them. The same for momenta, with inverses.
/// Numbers whose squares add up to these are linear in the 12 numbers of each body: first those of the
/// centres of all bodies, then those of the spins.
class PartMetric {
public:
    static PartMetric of_velocities(const Model& model);
    static PartMetric of_momenta(const Model& model);   ///< no mass may be singular

    /// How many numbers, filled up with zeros to pairs; those of the centres come first.
    int size() const { return size_; }
    int n_centres() const { return n_centres_; }
    /// size() numbers of 12 a body.
    void apply(const double* g, double* out) const;

private:
    struct Row {
        int at;        ///< first of its three numbers
        int n_terms;   ///< that follow those of the row before
    };
    struct Term {
        int number;
        double value;
    };

    void add(const Matrix4& part, int body);
    void fill_up();

    int n_centres_ = 0, size_ = 0;
    std::vector<Row> rows_;
    std::vector<Term> terms_;
};

struct Alternation {
    double value = 0;   ///< see Zigzag
    double time = 0;    ///< middle of the worst window, s
};

/// A velocity or a momentum, one sample after the other.
class SampleSeries {
public:
    /// With fewer samples a smooth oscillation may look like any other.
    static constexpr int fewest = 6;

    /// `noise` times 1 / step is what rounding may make of a sample; `n` samples will come, all before
    /// worst().
    SampleSeries(const PartMetric& metric, double noise, int n);

    /// Numbers of the metric.
    void append(double t, double step, const double* sample);
    Alternation worst(int window) const;

private:
    /// Squares, of the centres and of the spins.
    struct Squares {
        std::vector<double> samples, differences;   // the second difference at the sample in its middle
    };

    double mean(const Squares& part) const;
    Alternation worst_of(const Squares& part, std::size_t n, double floor,
                         const std::vector<double>& steps) const;

    int n_centres_, size_;
    double noise_;
    std::size_t n_ = 0;   // samples so far
    Squares parts_[2];
    std::vector<double> times_, steps_, before_, last_;   // the last two samples
};

}   // namespace livens::inline diagnostics_internal
