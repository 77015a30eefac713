// SPDX-License-Identifier: BSD-3-Clause
// Pinocchio and DOP853. Settings: "local:TOLERANCE" or "world:TOLERANCE", the frames that its
// articulated-body algorithm works in; with closed loops its constrained dynamics take over, and there is one
// way. Quaternions are integrated as they are and made unit in each evaluation.
#include <pinocchio/multibody.hpp>

#include <pinocchio/algorithm/aba.hpp>
#include <pinocchio/algorithm/constrained-dynamics.hpp>
#include <pinocchio/algorithm/joint-configuration.hpp>
#include <pinocchio/algorithm/kinematics.hpp>

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

/// Hinges along an axis of their body are quicker than others.
pin::JointModel joint_model(const peers::Joint& j)
{
    if (j.kind == "ball") return pin::JointModelSpherical();
    const Vector3d axis = vec(j.axis_second);
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
        start_ = VectorXd::Zero(model_.nq + model_.nv);
        start_.head(model_.nq) = pin::neutral(model_);
        for (std::size_t i = 0; i < m.bodies.size(); ++i) {
            const peers::Joint& j = m.joints[m.bodies[i].hung];
            if (j.kind == "hinge")
                start_[model_.nq + model_.idx_vs[i + 1]] =
                    peers::dot(j.axis_second, m.rate_in_parent(m.bodies[i]));
        }
        q_ = start_.head(model_.nq);
        torque_ = VectorXd::Zero(model_.nv);
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
        Eigen::Map<VectorXd> accelerations(rates + model_.nq, model_.nv);
        if (loops_.empty())
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
    bool balls_ = false;
    VectorXd start_, q_, torque_;
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
