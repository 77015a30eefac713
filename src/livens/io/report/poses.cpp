// SPDX-License-Identifier: BSD-3-Clause
// Positions and orientations of all bodies as polynomials in time elements.
// As quaternions where directors are orthonormal at all nodes, else X itself; rounded or on fewer elements
// where the page would grow too large. What that loses is measured and told.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "livens/diagnostics/sample.h"
#include "livens/io/report/parts.h"
#include "livens/multibody/body.h"

namespace livens::inline io_internal {

namespace {

/// What is stored of a body at a node.
enum class Form {
    position,     ///< 3 numbers: a point mass
    quaternion,   ///< 7: position and orientation, where directors are orthonormal
    directors     ///< 12: X itself
};
constexpr std::size_t numbers_of(Form form)
{
    return form == Form::position ? 3 : form == Form::quaternion ? 7 : 12;
}

/// What directors at nodes may lose by becoming a quaternion: the page shows poses to 1e-13.
constexpr double orthonormal = 1e-14;
/// Of their range: what single precision keeps of numbers of this size.
constexpr int bits_of_rounded = 23;
/// On the page, compressed and as text: what motions of robots take, a little more.
constexpr double bytes_in_double = 10, bytes_rounded = 2;
/// Instants in an element, beside its ends, at which a thinned motion is held against the whole one.
constexpr int checks = 3;

/// What the page makes of a quaternion, whatever its length.
Matrix3 rotation(const Vector4& q)
{
    const double s = 2 / dot(q, q), w = q[0], x = q[1], y = q[2], z = q[3];
    return {1 - s * (y * y + z * z), s * (x * y + w * z),     s * (x * z - w * y),
            s * (x * y - w * z),     1 - s * (x * x + z * z), s * (y * z + w * x),
            s * (x * z + w * y),     s * (y * z - w * x),     1 - s * (x * x + y * y)};
}

Matrix34 configuration(const double* numbers)
{
    Matrix34 X;
    std::copy_n(numbers, 12, X.a);
    return X;
}

/// nan counts as beyond everything.
double worse(double largest, double difference)
{
    return std::abs(difference) <= largest ? largest : std::abs(difference);
}

/// Polynomials of X, and what is stored of them.
struct Track {
    TimeMesh mesh;
    Field X;
};

/// A track through the states of a motion on every `merged`-th element end.
Track thinned(const Motion& motion, std::size_t merged, int degree)
{
    Track track;
    const std::vector<double>& ends = motion.mesh.ends;
    for (std::size_t e = 0; e + 1 < ends.size(); e += merged) track.mesh.ends.push_back(ends[e]);
    track.mesh.ends.push_back(ends.back());
    track.X.n_values = motion.X.n_values;
    track.X.degree = degree;
    for (const double t : node_times(track.X, track.mesh))
        for (const Matrix34& X : sample_state(motion, t).X)
            track.X.values.insert(track.X.values.end(), X.a, X.a + 12);
    return track;
}

/// By how much what the page shows is off.
struct Loss {
    double position = 0;      ///< m
    double orientation = 0;   ///< of the components of directors
    void add(const Matrix34& shown, const Matrix34& X)
    {
        for (int i = 0; i < 12; ++i) {
            double& largest = i < 3 ? position : orientation;
            largest = worse(largest, shown[i] - X[i]);
        }
    }
};

class Poses {
public:
    Poses(const Run& run, Track track)
        : run_(run), track_(std::move(track)),
          n_nodes_(track_.X.values.size() / static_cast<std::size_t>(track_.X.n_values))
    {
        for (std::size_t b = 0; b < run_.n_told_bodies(); ++b) {
            forms_.push_back(run_.body_is_point[b] ? Form::position : Form::quaternion);
            if (!run_.body_is_point[b] && !quaternions_suffice(b)) forms_.back() = Form::directors;
        }
    }

    std::size_t n_numbers() const
    {
        std::size_t n = 0;
        for (const Form form : forms_) n += n_nodes_ * numbers_of(form);
        return n;
    }
    std::size_t n_nodes() const { return n_nodes_; }
    const Track& track() const { return track_; }

    /// Number after number, each through all of time.
    void store(Payload& payload, bool is_rounded)
    {
        std::vector<double> all;
        for (std::size_t b = 0; b < forms_.size(); ++b)
            for (const std::vector<double>& numbers : numbers_through_time(b))
                all.insert(all.end(), numbers.begin(), numbers.end());
        if (is_rounded) {
            const Stepped stepped(all, all.size() / n_nodes_, bits_of_rounded);
            payload.add("pose", stepped, 2);
            all = stepped.values();
        } else {
            payload.add("pose", Precision::full, all);
        }
        payload.add("pose_weight", Precision::full, track_.X.denominators);
        payload.add("pose_end", Precision::full, track_.mesh.ends);
        // The loss is measured on what is stored, read as the page reads it.
        measure(all);
    }

    Loss loss_at_nodes() const { return loss_; }
    const std::vector<Form>& forms() const { return forms_; }
    /// The track as it is shown, after store().
    const Field& shown() const { return shown_; }

private:
    const double* numbers(std::size_t node, std::size_t body) const
    {
        return track_.X.values.data() + node * static_cast<std::size_t>(track_.X.n_values) + 12 * body;
    }

    bool quaternions_suffice(std::size_t body) const
    {
        for (std::size_t n = 0; n < n_nodes_; ++n) {
            const Matrix3 R = directors(configuration(numbers(n, body)));
            const Matrix3 lost = rotation(quaternion_from_directors(R)) - R;
            for (const double x : lost.a)
                if (!(std::abs(x) <= orthonormal)) return false;
        }
        return true;
    }

    std::vector<std::vector<double>> numbers_through_time(std::size_t body) const
    {
        std::vector<std::vector<double>> all(numbers_of(forms_[body]));
        Vector4 last{1, 0, 0, 0};
        for (std::size_t n = 0; n < n_nodes_; ++n) {
            const double* const X = numbers(n, body);
            const bool is_turned = forms_[body] == Form::quaternion;
            for (std::size_t i = 0; i < (is_turned ? 3 : all.size()); ++i) all[i].push_back(X[i]);
            if (!is_turned) continue;
            // A polynomial goes through the quaternions of an element, so their signs must not jump.
            last = continued(last, quaternion_from_directors(directors(configuration(X))));
            for (int i = 0; i < 4; ++i) all[static_cast<std::size_t>(3 + i)].push_back(last[i]);
        }
        return all;
    }

    /// Reads what was stored as the page does.
    void measure(const std::vector<double>& all)
    {
        shown_ = track_.X;
        std::size_t channel = 0;
        for (std::size_t b = 0; b < forms_.size(); ++b) {
            const std::size_t count = numbers_of(forms_[b]);
            for (std::size_t n = 0; n < n_nodes_; ++n) {
                std::array<double, 12> x{};
                for (std::size_t i = 0; i < count; ++i) x[i] = all[(channel + i) * n_nodes_ + n];
                const Matrix34 X = configuration(numbers(n, b));
                Matrix34 seen = forms_[b] == Form::directors ? configuration(x.data()) : X;
                for (int i = 0; i < 3; ++i) seen[i] = x[static_cast<std::size_t>(i)];
                if (forms_[b] == Form::quaternion) {
                    const Matrix3 R = rotation({x[3], x[4], x[5], x[6]});
                    std::copy_n(R.a, 9, seen.a + 3);
                }
                loss_.add(seen, X);
                std::copy_n(
                    seen.a, 12,
                    shown_.values.begin() +
                        static_cast<std::ptrdiff_t>(n * static_cast<std::size_t>(shown_.n_values) + 12 * b));
            }
            channel += count;
        }
    }

    const Run& run_;
    Track track_;
    std::size_t n_nodes_;
    std::vector<Form> forms_;
    Field shown_;
    Loss loss_;
};

/// Of a thinned motion against the whole one, inside and at the ends of its elements.
Loss loss_between(const Motion& motion, const Track& track, const Field& shown)
{
    Loss loss;
    std::vector<double> x(static_cast<std::size_t>(shown.n_values));
    for (int e = 0; e < motion.n_elements(); ++e)
        for (int k = 0; k <= checks; ++k) {
            const double t = motion.mesh.ends[e] + motion.mesh.length(e) * k / (checks + 1);
            const int element = track.mesh.element_at(t);
            shown.evaluate(element, (t - track.mesh.ends[element]) / track.mesh.length(element), 0, x);
            const State state = sample_state(motion, t);
            for (std::size_t b = 0; b < state.X.size(); ++b) loss.add(configuration(&x[12 * b]), state.X[b]);
        }
    return loss;
}

}   // namespace

void write_poses(ReportData& data, const Run& run, double most_bytes)
{
    const Motion& motion = run.motion;
    std::optional<Poses> poses(std::in_place, run, Track{motion.mesh, motion.X});
    const double n_numbers = static_cast<double>(poses->n_numbers()), n_rounded = most_bytes / bytes_rounded;
    const bool is_rounded = n_numbers * bytes_in_double > most_bytes,
               is_thinned = n_numbers > n_rounded && motion.n_elements() > 1;
    if (is_thinned) {
        const int degree = std::max(motion.X.degree, 3);
        const double n = static_cast<double>(motion.n_elements());
        const double fit = n_rounded / static_cast<double>(poses->n_numbers() / poses->n_nodes());
        const double elements = std::max(1.0, std::floor((fit - 1) / degree));
        poses.emplace(run, thinned(motion, static_cast<std::size_t>(std::ceil(n / elements)), degree));
    }
    poses->store(data.payload, is_rounded);
    const Field& X = poses->track().X;
    const Loss loss =
        is_thinned ? loss_between(motion, poses->track(), poses->shown()) : poses->loss_at_nodes();
    JsonWriter& json = data.json;
    json.key("pose").begin_object();
    json.member("precision", is_thinned ? "thinned" : is_rounded ? "rounded" : "double");
    json.member("position_loss", loss.position).member("orientation_loss", loss.orientation);
    json.member("elements", motion.n_elements());
    json.member("degree", X.degree).member("continuous", X.continuous);
    json.key("nodes").value(std::span<const double>(X.basis().nodes()));
    json.key("forms").begin_array();
    for (const Form form : poses->forms()) json.value(static_cast<int>(numbers_of(form)));
    json.end_array().end_object();
}

}   // namespace livens::inline io_internal
