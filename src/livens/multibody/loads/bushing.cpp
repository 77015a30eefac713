// SPDX-License-Identifier: BSD-3-Clause
// A bushing: stiffness and damping of all six motions between two frames, for turns up to half a turn.
// Potential and dissipation of displacements and rotation vector r give the factors of seven units along
// these forms: theory.md, "Coordinates of joints", Bushing. Nothing is small in it; at half a turn r jumps,
// and there it ends.
#include <array>
#include <cmath>

#include "livens/base/error.h"
#include "livens/base/text.h"
#include "livens/multibody/joints.h"
#include "livens/multibody/loads/load_coordinate.h"
#include "livens/multibody/loads/load_laws.h"
#include "livens/multibody/loads/load_values.h"
#include "livens/multibody/loads/relative_spin.h"
#include "livens/multibody/loads/rotation_vector.h"

namespace livens {

namespace {

/// Coordinates are three displacements, s1, s2, s3 and c.
struct BushingLaw {
    Bushing of;
    static constexpr std::size_t n = 7;

    /// u by the coordinates: ones for displacements, J for the turn.
    struct Motion {
        Turn turn;
        std::array<double, 6> u{}, rate{};
    };

    static Motion motion(const LawArguments& at)
    {
        Motion m{turn_of(at.values.data() + 3), {}, {}};
        for (std::size_t k = 0; k < 3; ++k) {
            m.u[k] = at.values[k];
            m.rate[k] = at.rates[k];
            m.u[3 + k] = m.turn.r[k].value;
            for (std::size_t l = 0; l < 4; ++l) m.rate[3 + k] += m.turn.J[k][l].value * at.rates[3 + l];
        }
        return m;
    }

    /// The generalised force on u.
    double force(const Motion& m, int k) const
    {
        double f = -of.preload[k];
        for (int l = 0; l < 6; ++l) f -= of.stiffness(k, l) * m.u[l] + of.damping(k, l) * m.rate[l];
        return f;
    }

    void operator()(const LawArguments& at, std::span<double> factors, std::span<double> slopes) const
    {
        const Motion m = motion(at);
        const auto J = [&](std::size_t k, std::size_t i) -> Dual {   // du_k by coordinate i
            if (k < 3 || i < 3) return {k == i ? 1.0 : 0.0, {}};
            return m.turn.J[k - 3][i - 3];
        };
        std::array<double, 6> f;
        for (int k = 0; k < 6; ++k) f[k] = force(m, k);
        for (std::size_t i = 0; i < n; ++i) {
            factors[i] = 0;
            // Virtual work f . du = f . J dq: the factor of coordinate i is (J^T f)_i.
            for (std::size_t k = 0; k < 6; ++k) factors[i] += J(k, i).value * f[k];
        }
        if (slopes.empty()) return;
        for (std::size_t j = 0; j < n; ++j) {   // by coordinate j and its rate
            std::array<double, 6> by_value{}, by_rate{};
            for (std::size_t l = 0; l < 6; ++l) {
                double turned = 0;   // of the rate of u by the coordinate, at fixed rates
                for (std::size_t i = 3; j >= 3 && i < n; ++i) turned += J(l, i).by[j - 3] * at.rates[i];
                for (int k = 0; k < 6; ++k) {
                    const int c = static_cast<int>(l);
                    by_value[k] -= of.stiffness(k, c) * J(l, j).value + of.damping(k, c) * turned;
                    by_rate[k] -= of.damping(k, c) * J(l, j).value;
                }
            }
            for (std::size_t i = 0; i < n; ++i) {
                double &value = slopes[2 * n * i + j], &rate = slopes[2 * n * i + n + j];
                value = rate = 0;
                for (std::size_t k = 0; k < 6; ++k) {
                    const Dual d = J(k, i);
                    value += d.value * by_value[k] + (j >= 3 ? d.by[j - 3] * f[k] : 0);
                    rate += d.value * by_rate[k];
                }
            }
        }
    }

    /// u on a tape, and the few sums that J is made of.
    struct MotionOnTape {
        TapeNumber s[3], factor, twice_by_sigma, by_c;
        TapeNumber u[6], rate[6];
    };
    static TapeNumber product(const TapeNumber* a, const TapeNumber* b)
    {
        return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    }
    MotionOnTape motion(const LawOnTape& at) const
    {
        MotionOnTape m{{at.value(3), at.value(4), at.value(5)}, {}, {}, {}, {}, {}};
        const TapeNumber c = at.value(6), sigma = product(m.s, m.s);
        m.by_c = -(at.tape.number(1) / (sigma + c * c));
        const TapeVector turn = turn_of_sine(sigma, c);
        m.factor = turn[0];
        m.twice_by_sigma = turn[1];
        for (std::size_t k = 0; k < 3; ++k) {
            m.u[k] = at.value(k);
            m.u[3 + k] = m.factor * m.s[k];
        }
        if (!of_rates()) return m;
        const TapeNumber s_rate[3] = {at.rate(3), at.rate(4), at.rate(5)};
        const TapeNumber along = m.twice_by_sigma * product(m.s, s_rate) + m.by_c * at.rate(6);
        for (std::size_t k = 0; k < 3; ++k) {
            m.rate[k] = at.rate(k);
            m.rate[3 + k] = m.factor * s_rate[k] + along * m.s[k];
        }
        return m;
    }
    /// The same on a tape: J^T f.
    void record(const LawOnTape& at, std::span<TapeNumber> factors) const
    {
        const MotionOnTape m = motion(at);
        TapeNumber f[6];
        for (int k = 0; k < 6; ++k) f[k] = recorded_force(at.tape, m, k);
        const TapeNumber along = product(m.s, f + 3);
        for (std::size_t k = 0; k < 3; ++k) {
            factors[k] = f[k];
            factors[3 + k] = m.factor * f[3 + k] + m.twice_by_sigma * along * m.s[k];
        }
        factors[6] = m.by_c * along;
    }
    bool of_rates() const { return of.damping != Matrix<6, 6>{}; }
    TapeNumber recorded_force(LoadTape& tape, const MotionOnTape& m, int k) const
    {
        TapeNumber f = tape.number(-of.preload[k]);
        for (int l = 0; l < 6; ++l) {
            if (of.stiffness(k, l) != 0) f = f - of.stiffness(k, l) * m.u[l];
            if (of.damping(k, l) != 0) f = f - of.damping(k, l) * m.rate[l];
        }
        return f;
    }
    TapeNumber recorded_power(const LawOnTape& at) const
    {
        TapeNumber sum = at.tape.number(0);
        if (!of_rates()) return sum;
        const MotionOnTape m = motion(at);
        for (int k = 0; k < 6; ++k)
            for (int l = 0; l < 6; ++l)
                if (of.damping(k, l) != 0) sum = sum - of.damping(k, l) * (m.rate[k] * m.rate[l]);
        return sum;
    }

    static std::array<double, 6> u(const LawArguments& at) { return motion(at).u; }
    /// What acts on the second body along the first frame's axes, at the second frame's origin: forces, and
    /// the couple whose power is that of f along r'.
    std::array<double, 6> acting(const LawArguments& at) const
    {
        const Motion m = motion(at);
        std::array<double, 6> f;
        for (int k = 0; k < 6; ++k) f[k] = force(m, k);
        const Vector3 couple = couple_of({f[3], f[4], f[5]}, {m.u[3], m.u[4], m.u[5]});
        return {f[0], f[1], f[2], couple[0], couple[1], couple[2]};
    }
    /// Whether anything acts along the rotation vector, which ends at half a turn.
    bool acts_on_rotation() const
    {
        for (int k = 3; k < 6; ++k)
            for (int l = 0; l < 6; ++l)
                if (of.stiffness(k, l) != 0 || of.damping(k, l) != 0 || of.preload[k] != 0) return true;
        return false;
    }

    double potential(const LawArguments& at) const
    {
        const Motion m = motion(at);
        double energy = 0;
        for (int k = 0; k < 6; ++k) {
            energy += of.preload[k] * m.u[k];
            for (int l = 0; l < 6; ++l) energy += 0.5 * m.u[k] * of.stiffness(k, l) * m.u[l];
        }
        return energy;
    }

    double power(const LawArguments& at) const
    {
        const Motion m = motion(at);
        double sum = 0;
        for (int k = 0; k < 6; ++k)
            for (int l = 0; l < 6; ++l) sum -= m.rate[k] * of.damping(k, l) * m.rate[l];
        return sum;
    }
};

/// Springs by u and dampers by (displacement', w), along displacements and R alone, of which s and c are
/// sums: what is a factor of them is one of each R_lm by its share.
struct SpinningBushing {
    BushingLaw springs;
    SpinDamping dampers;
    static constexpr std::size_t n = 12;

    /// Which coordinate of the springs coordinate j is part of, and how much of it counts.
    struct Share {
        std::size_t of;
        double factor;
    };
    static Share share(std::size_t j)
    {
        if (j < 3) return {j, 1};
        const std::size_t l = (j - 3) % 3, m = (j - 3) / 3;
        if (l == m) return {6, 0.5};                         // c = (R_11 + R_22 + R_33 - 1) / 2
        return {6 - l - m, (l + 1) % 3 == m ? -0.5 : 0.5};   // s_1 = (R_32 - R_23) / 2 and so on
    }
    /// Calls see(arguments of the springs).
    template <class See>
    static auto springs_see(const LawArguments& at, const See& see)
    {
        std::array<double, BushingLaw::n> values{}, rates{};
        values[6] = -0.5;
        for (std::size_t j = 0; j < n; ++j) {
            values[share(j).of] += share(j).factor * at.values[j];
            rates[share(j).of] += share(j).factor * at.rates[j];
        }
        return see(LawArguments{at.at, values, rates});
    }
    void operator()(const LawArguments& at, std::span<double> factors, std::span<double> slopes) const
    {
        constexpr std::size_t k = BushingLaw::n;
        std::array<double, k> of_springs{};
        std::array<double, 2 * k * k> by_springs{};
        const bool asks = !slopes.empty();
        dampers(at, factors, slopes);
        springs_see(at, [&](const LawArguments& seen) {
            springs(seen, of_springs, asks ? std::span<double>(by_springs) : std::span<double>());
        });
        for (std::size_t i = 0; i < n; ++i) {
            const Share of = share(i);
            factors[i] += of.factor * of_springs[of.of];
            for (std::size_t j = 0; asks && j < n; ++j)
                slopes[2 * n * i + j] +=   // springs alone do not see rates
                    of.factor * by_springs[2 * k * of.of + share(j).of] * share(j).factor;
        }
    }
    static LawOnTape springs_on(const LawOnTape& at)
    {
        const auto sum = [](const LawOnTape& on, const auto& part, std::size_t of, TapeNumber all) {
            for (std::size_t j = 0; j < n; ++j)
                if (share(j).of == of) {
                    const TapeNumber more = share(j).factor * part(on, j);
                    all = all.place < 0 ? more : all + more;
                }
            return all;
        };
        return {at.tape,
                [at, sum](std::size_t of) {
                    const TapeNumber first = of == 6 ? at.tape.number(-0.5) : TapeNumber{&at.tape};
                    return sum(
                        at, [](const LawOnTape& on, std::size_t j) { return on.value(j); }, of, first);
                },
                [at, sum](std::size_t of) {
                    const TapeNumber none{&at.tape};
                    return sum(
                        at, [](const LawOnTape& on, std::size_t j) { return on.rate(j); }, of, none);
                }};
    }
    void record(const LawOnTape& at, std::span<TapeNumber> factors) const
    {
        std::vector<TapeNumber> of_springs(BushingLaw::n, TapeNumber{&at.tape});
        springs.record(springs_on(at), of_springs);
        dampers.record(at, factors);
        for (std::size_t j = 0; j < n; ++j)
            factors[j] = factors[j] + share(j).factor * of_springs[share(j).of];
    }
    std::array<double, 6> u(const LawArguments& at) const
    {
        return springs_see(at, [&](const LawArguments& q) { return springs.u(q); });
    }
    std::array<double, 6> acting(const LawArguments& at) const
    {
        std::array<double, 6> f = springs_see(at, [&](const LawArguments& q) { return springs.acting(q); });
        const Matrix<6, 1> damped = dampers.force(at);
        for (int k = 0; k < 6; ++k) f[k] += damped[k];
        return f;
    }
    bool acts_on_rotation() const { return springs.acts_on_rotation(); }
    double potential(const LawArguments& at) const
    {
        return springs_see(at, [&](const LawArguments& q) { return springs.potential(q); });
    }
    double power(const LawArguments& at) const { return dampers.power(at); }
    TapeNumber recorded_power(const LawOnTape& at) const { return dampers.recorded_power(at); }
};

/// What the parts of the load are made of.
template <class Law>
void add_law(LoadParts& parts, const Law& law)
{
    parts.law = law;
    parts.recorded_law = [law](const LawOnTape& on, std::span<TapeNumber> factors) {
        law.record(on, factors);
    };
    parts.potential = [law](const LawArguments& q) { return law.potential(q); };
    parts.power = [law](const LawArguments& q) { return law.power(q); };
    parts.recorded_power = [law](const LawOnTape& on) { return law.recorded_power(on); };
    if (law.acts_on_rotation()) parts.domain = "its rotation vector changes its sign at half a turn";
    // What acts on the second body, and u.
    for (int k = 0; k < 6; ++k) {
        const std::string letter(1, "xyz"[k % 3]);
        parts.readings.push_back({(k < 3 ? "force_" : "torque_") + letter, k < 3 ? "N" : "N m",
                                  [law, k](const LawArguments& q) { return law.acting(q)[k]; }});
        parts.readings.push_back({(k < 3 ? "displacement_" : "rotation_") + letter, k < 3 ? "m" : "rad",
                                  [law, k](const LawArguments& q) { return law.u(q)[k]; }});
    }
}

/// Whether x . A x may be negative, by what is left of the diagonal in Cholesky's elimination.
bool is_negative(Matrix<6, 6> A)
{
    const Matrix<6, 6> given = A;
    for (int k = 0; k < 6; ++k) {
        const double slack = 1e-12 * std::abs(given(k, k));
        if (A(k, k) < -slack || !std::isfinite(A(k, k))) return true;
        for (int i = k + 1; i < 6; ++i) {
            // Where a pivot is zero its row must be as well, or the form is negative somewhere.
            if (A(k, k) <= slack && std::abs(A(i, k)) > 1e-9 * std::sqrt(given(k, k) * given(i, i)))
                return true;
            for (int j = k + 1; A(k, k) > slack && j < 6; ++j) A(i, j) -= A(i, k) * A(k, j) / A(k, k);
        }
    }
    return false;
}

void check_matrix(const std::string& name, const Matrix<6, 6>& A, const std::string& key)
{
    const auto refuse = [&](const std::string& message, const std::string& value) {
        throw InputError({"bushing-matrix", "load[" + name + "]." + key, key + " of a bushing " + message,
                          value, "symmetric and not negative", "else it would gain energy by going round",
                          ""});
    };
    for (int k = 0; k < 6; ++k)
        for (int l = 0; l < k; ++l)
            if (!(std::abs(A(k, l) - A(l, k)) <= 1e-12 * (std::abs(A(k, l)) + std::abs(A(l, k)))))
                refuse("is not symmetric", to_text(A(k, l)) + " and " + to_text(A(l, k)));
    if (is_negative(A)) refuse("is negative for some displacement", "");
}

}   // namespace

Load bushing(const std::string& name, int first, const BodyFrame& frame_first, int second,
             const BodyFrame& frame_second, const Bushing& law, const Configurations& X)
{
    check_matrix(name, law.stiffness, "stiffness");
    check_matrix(name, law.damping, "damping");
    if (first == second) start_load(name, "bushing", {first, second});   // says why not
    LoadParts parts;
    // The law takes the values of the forms, not their changes since the start.
    const auto add = [&](const PairForm& form) {
        parts.coordinates.push_back({{{form}}, form_value(form, form.body_i, form.body_j, X)});
    };
    for (int k = 0; k < 3; ++k)
        add(plane_row(first, direction(frame_first.axes.column(k)), point(frame_first.point), second,
                      point(frame_second.point), 0, 1));
    parts.is_smooth = true;   // up to half a turn, where it ends
    parts.depends_on_rates = BushingLaw{law}.of_rates();
    if (law.by_angular_velocity) {
        for (const LawCoordinate& q : turned_axes(first, frame_first.axes, second, frame_second.axes, X))
            parts.coordinates.push_back(q);
        add_law(parts, SpinningBushing{{{law.stiffness, {}, law.preload}}, {law.damping, true}});
    } else {
        for (const PairForm& form :
             rotation_angle(first, second, {frame_first.axes, frame_second.axes}).forms)
            add(form);
        add_law(parts, BushingLaw{law});
    }
    for (const LawCoordinate& q : parts.coordinates) parts.units.push_back(unit_along(name, q.coordinate, X));
    return modulated(name, "bushing", parts, X);
}

Load ball_spring(const std::string& name, const Joint& joint, double stiffness, double damping,
                 const Configurations& X)
{
    const Load checked = start_load(name, "bushing", {joint.second, joint.first});
    check_not_negative(checked, stiffness, "stiffness");
    check_not_negative(checked, damping, "damping");
    Bushing law;
    law.by_angular_velocity = true;
    for (int k = 3; k < 6; ++k) {
        law.stiffness(k, k) = stiffness;
        law.damping(k, k) = damping;
    }
    Load load = bushing(name, joint.first, {joint.point_first, joint.triads.first}, joint.second,
                        {joint.point_second, joint.triads.second}, law, X);
    std::erase_if(load.readings, [](const LoadReading& reading) {
        return reading.name.starts_with("force") || reading.name.starts_with("displacement");
    });
    return load;
}

}   // namespace livens
