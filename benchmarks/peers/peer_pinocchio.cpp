// SPDX-License-Identifier: BSD-3-Clause
// Pinocchio and DOP853. Settings: "local:TOLERANCE" or "world:TOLERANCE", the frames that its
// articulated-body algorithm works in; with closed loops its constrained dynamics take over, with gears its
// mass matrix, and there is one way. Springs and dampers are torques that are given to it. Quaternions are
// integrated as they are and made unit in each evaluation.
#include <pinocchio/multibody.hpp>

#include <pinocchio/algorithm/aba.hpp>
#include <pinocchio/algorithm/constrained-dynamics.hpp>
#include <pinocchio/algorithm/crba.hpp>
#include <pinocchio/algorithm/joint-configuration.hpp>
#include <pinocchio/algorithm/kinematics.hpp>
#include <pinocchio/algorithm/rnea.hpp>

#include <Eigen/Cholesky>

#include <algorithm>

#include "dop853.h"
#include "serve.h"

namespace {

namespace pin = pinocchio;
using Eigen::Vector3d;
using Eigen::VectorXd;
using peers::Mechanism;

Vector3d vec(const peers::Vec& a) { return {a[0], a[1], a[2]}; }
Eigen::Matrix3d turn(const peers::Mat& R)
{
    return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(R.data());
}

/// Hinges and slides along an axis of their body are quicker than others.
pin::JointModel joint_model(const peers::Joint& j)
{
    if (j.kind == "ball") return pin::JointModelSpherical();
    const Vector3d axis = vec(j.axis_second);
    if (j.kind == "slide") {
        if (axis.isApprox(Vector3d::UnitX())) return pin::JointModelPX();
        if (axis.isApprox(Vector3d::UnitY())) return pin::JointModelPY();
        if (axis.isApprox(Vector3d::UnitZ())) return pin::JointModelPZ();
        return pin::JointModelPrismaticUnaligned(axis);
    }
    if (axis.isApprox(Vector3d::UnitX())) return pin::JointModelRX();
    if (axis.isApprox(Vector3d::UnitY())) return pin::JointModelRY();
    if (axis.isApprox(Vector3d::UnitZ())) return pin::JointModelRZ();
    return pin::JointModelRevoluteUnaligned(axis);
}

class Tree {
public:
    explicit Tree(const Mechanism& m) : mechanism_(m), model_(model_of(m)), data_(model_)
    {
        balls_ = model_.nq != model_.nv;
        takes_time_ = std::ranges::any_of(m.springs, [](const peers::Spring& s) { return s.amplitude != 0; });
        start_ = VectorXd::Zero(model_.nq + model_.nv + takes_time_);
        start_.head(model_.nq) = pin::neutral(model_);
        for (std::size_t i = 0; i < m.bodies.size(); ++i) {
            const peers::Joint& j = m.joints[m.bodies[i].hung];
            if (j.kind == "hinge")
                start_[model_.nq + model_.idx_vs[i + 1]] =
                    peers::dot(j.axis_second, m.rate_in_parent(m.bodies[i]));
        }
        q_ = start_.head(model_.nq);
        torque_ = push_ = stiffness_ = damping_ = VectorXd::Zero(model_.nv);
        for (std::size_t i = 0; i < m.bodies.size(); ++i) {
            const peers::Joint& j = m.joints[m.bodies[i].hung];
            if (!j.has_coordinate()) continue;
            const int k = model_.idx_vs[i + 1];
            push_[k] = j.push, stiffness_[k] = j.stiffness, damping_[k] = j.damping;
        }
        is_loaded_ = m.is_loaded();
        if (!m.gears.empty()) couple();
        for (int j = 0; j < static_cast<int>(m.joints.size()); ++j)
            if (m.closes_loop(j)) close(m.joints[j]);
        if (!loops_.empty()) pin::initConstraintDynamics(model_, data_, loops_, loop_datas_);
    }

    peers::Points solve(pin::Convention convention, double tolerance)
    {
        std::vector<double> y(start_.data(), start_.data() + start_.size());
        const auto f = [&](const double* at, double* rates) { evaluate(convention, at, rates); };
        peers::Dop853().integrate(f, y, mechanism_.end, tolerance);
        take(y.data());
        pin::forwardKinematics(model_, data_, q_);
        peers::Points points;
        for (const peers::Point& p : mechanism_.points) {
            const Vector3d x = data_.oMi[p.body + 1].act(vec(p.at));
            points.push_back({x[0], x[1], x[2]});
        }
        return points;
    }

private:
    static pin::Model model_of(const Mechanism& m)
    {
        pin::Model model;
        model.gravity.linear() = vec(m.gravity);
        for (const peers::Body& b : m.bodies) {
            if (b.hung == peers::nothing) throw std::runtime_error("a body that hangs on nothing");
            const peers::Joint& j = m.joints[b.hung];
            const pin::SE3 place(turn(m.turn_in_parent(b)), vec(j.point_first));
            const auto joint =
                model.addJoint(b.parent + 1, joint_model(j), place, "j" + std::to_string(b.hung));
            const Eigen::Matrix3d J = vec(b.inertia).asDiagonal();
            model.appendBodyToJoint(joint, pin::Inertia(b.mass, vec(b.center), J));
        }
        return model;
    }

    /// Points that coincide: in a plane loop the rows across it are redundant, which its proximal steps
    /// stand.
    void close(const peers::Joint& j)
    {
        const auto place = [](const peers::Vec& at) {
            return pin::SE3(Eigen::Matrix3d::Identity(), vec(at));
        };
        loops_.emplace_back(pin::CONTACT_3D, model_, j.first + 1, place(j.point_first), j.second + 1,
                            place(j.point_second), pin::LOCAL);
        loop_datas_.emplace_back(loops_.back());
    }

    /// The velocities by those that gears leave free.
    void couple()
    {
        const int n = model_.nv;
        Eigen::MatrixXd all = Eigen::MatrixXd::Identity(n, n);
        std::vector<bool> is_free(n, true);
        for (const peers::Gear& gear : mechanism_.gears) {   // in order, from the motor on
            const int first = model_.idx_vs[mechanism_.joints[gear.first].second + 1];
            const int second = model_.idx_vs[mechanism_.joints[gear.second].second + 1];
            all.row(second) = gear.ratio * all.row(first);
            is_free[second] = false;
        }
        free_.resize(n, std::ranges::count(is_free, true));
        for (int k = 0, column = 0; k < n; ++k)
            if (is_free[k]) free_.col(column++) = all.col(k);
    }

    /// The torques of all that acts along and between joints.
    void load(const Eigen::Map<const VectorXd>& v, double t)
    {
        torque_ = push_ - stiffness_.cwiseProduct(q_) - damping_.cwiseProduct(v);
        if (mechanism_.springs.empty()) return;
        pin::forwardKinematics(model_, data_, q_, v);
        for (const peers::Spring& spring : mechanism_.springs) {
            const auto [x2, v2] = moving(spring.second, vec(spring.point_second));
            auto [x1, v1] = moving(spring.first, vec(spring.point_first));
            if (spring.first == peers::ground) x1 += vec(spring.lift(t)), v1 += vec(spring.lift_rate(t));
            const Vector3d way = x2 - x1;
            const double length = way.norm(), rate = way.dot(v2 - v1) / length;
            const Vector3d f =
                way * ((spring.stiffness * (length - spring.free_length) + spring.damping * rate) / length);
            pull(spring.second, x2, -f);
            pull(spring.first, x1, f);
        }
    }

    std::pair<Vector3d, Vector3d> moving(int body, const Vector3d& at) const
    {
        if (body == peers::ground) return {at, Vector3d::Zero()};
        const pin::Motion& V = data_.v[body + 1];
        return {data_.oMi[body + 1].act(at),
                data_.oMi[body + 1].rotation() * (V.linear() + V.angular().cross(at))};
    }

    void pull(int body, const Vector3d& at, const Vector3d& f)
    {
        for (int i = body; i != peers::ground; i = mechanism_.bodies[i].parent) {
            const peers::Joint& j = mechanism_.joints[mechanism_.bodies[i].hung];
            const Vector3d axis = data_.oMi[i + 1].rotation() * vec(j.axis_second);
            const Vector3d moment = (at - data_.oMi[i + 1].translation()).cross(f);
            torque_[model_.idx_vs[i + 1]] += axis.dot(j.kind == "slide" ? f : moment);
        }
    }

    void take(const double* y)
    {
        q_ = Eigen::Map<const VectorXd>(y, model_.nq);
        if (!balls_) return;
        for (int k = 0; k < model_.nq; k += 4) q_.segment<4>(k).normalize();
    }

    void evaluate(pin::Convention convention, const double* y, double* rates)
    {
        take(y);
        const Eigen::Map<const VectorXd> v(y + model_.nq, model_.nv);
        if (balls_) {
            for (int k = 0; k < model_.nq / 4; ++k)
                turn_rates(q_.data() + 4 * k, v.data() + 3 * k, rates + 4 * k);
        } else {
            Eigen::Map<VectorXd>(rates, model_.nq) = v;
        }
        if (is_loaded_) load(v, takes_time_ ? y[model_.nq + model_.nv] : 0);
        if (takes_time_) rates[model_.nq + model_.nv] = 1;
        Eigen::Map<VectorXd> accelerations(rates + model_.nq, model_.nv);
        if (free_.size() != 0) {
            const VectorXd left = torque_ - pin::nonLinearEffects(model_, data_, q_, v);
            data_.M.setZero();
            pin::crba(model_, data_, q_, convention);
            data_.M.triangularView<Eigen::StrictlyLower>() = data_.M.transpose();
            const Eigen::MatrixXd M = free_.transpose() * data_.M * free_;
            accelerations = free_ * M.llt().solve(free_.transpose() * left);
        } else if (loops_.empty())
            accelerations = pin::aba(model_, data_, q_, v, torque_, convention);
        else
            accelerations =
                pin::constraintDynamics(model_, data_, q_, v, torque_, loops_, loop_datas_, proximal_);
    }

    /// Quaternions are x, y, z, w, angular velocities along the body's axes.
    static void turn_rates(const double* q, const double* w, double* d)
    {
        d[0] = 0.5 * (q[3] * w[0] + q[1] * w[2] - q[2] * w[1]);
        d[1] = 0.5 * (q[3] * w[1] + q[2] * w[0] - q[0] * w[2]);
        d[2] = 0.5 * (q[3] * w[2] + q[0] * w[1] - q[1] * w[0]);
        d[3] = -0.5 * (q[0] * w[0] + q[1] * w[1] + q[2] * w[2]);
    }

    const Mechanism& mechanism_;
    pin::Model model_;
    pin::Data data_;
    std::vector<pin::RigidConstraintModel> loops_;
    std::vector<pin::RigidConstraintData> loop_datas_;
    pin::ProximalSettings proximal_{1e-12, 1e-10, 5};
    bool balls_ = false, takes_time_ = false, is_loaded_ = false;
    VectorXd start_, q_, torque_, push_, stiffness_, damping_;
    Eigen::MatrixXd free_;
};

}   // namespace

int main()
{
    return peers::serve([](const Mechanism& m, const std::vector<std::string>& setting) {
        const auto convention = setting.at(0) == "world" ? pin::Convention::WORLD : pin::Convention::LOCAL;
        return [tree = std::make_shared<Tree>(m), convention, tolerance = std::stod(setting.at(1))] {
            return tree->solve(convention, tolerance);
        };
    });
}
