// SPDX-License-Identifier: BSD-3-Clause
// Simbody. Settings: "INTEGRATOR:ACCURACY" with merson, feldberg, cpodes (implicit) or verlet. Bodies on
// balls, hinges and slides are mobilised bodies of a tree; loops close by constraints, rods are constraints
// between free bodies, gears couple coordinates. Loads are its own.
#include <Simbody.h>

#include "serve.h"

namespace {

using namespace SimTK;
using peers::Mechanism;

Vec3 vec(const peers::Vec& a) { return {a[0], a[1], a[2]}; }
Rotation turn(const peers::Mat& R)
{
    return Rotation(Mat33(R[0], R[1], R[2], R[3], R[4], R[5], R[6], R[7], R[8]), true);
}

class Tree {
public:
    explicit Tree(const Mechanism& m) : mechanism_(m)
    {
        Force::UniformGravity(forces_, matter_, vec(m.gravity));
        for (const peers::Body& b : m.bodies) add(b);
        for (int j = 0; j < static_cast<int>(m.joints.size()); ++j)
            if (m.closes_loop(j)) add(m.joints[j]);
        for (const peers::Spring& spring : m.springs) add(spring);
        for (const peers::Bushing& bushing : m.bushings) add(bushing);
        for (const peers::Gear& gear : m.gears) add(gear);
        start_ = system_.realizeTopology();
        for (std::size_t i = 0; i < m.bodies.size(); ++i) put(m.bodies[i], bodies_[i]);
    }

    peers::Points solve(Integrator& integrator, double accuracy) const
    {
        integrator.setAccuracy(accuracy);
        integrator.setConstraintTolerance(std::max(accuracy, 1e-13));
        integrator.setFinalTime(mechanism_.end);
        TimeStepper stepper(system_, integrator);
        stepper.initialize(start_);
        stepper.stepTo(mechanism_.end);
        const State& state = stepper.getState();
        if (state.getTime() < mechanism_.end * (1 - 1e-12)) throw std::runtime_error("stopped early");
        system_.realize(state, Stage::Position);
        peers::Points points;
        for (const peers::Point& p : mechanism_.points) {
            const Vec3 x = bodies_[p.body].findStationLocationInGround(state, vec(p.at));
            points.push_back({x[0], x[1], x[2]});
        }
        return points;
    }

    const MultibodySystem& system() const { return system_; }

private:
    MobilizedBody body(int i) { return i == peers::ground ? matter_.Ground() : bodies_[i]; }

    /// In its parent a body lies at the start as if its coordinates were zero.
    void add(const peers::Body& b)
    {
        const Inertia central(b.inertia[0], b.inertia[1], b.inertia[2]);
        const Body::Rigid rigid(
            MassProperties(b.mass, vec(b.center), central.shiftFromMassCenter(vec(b.center), b.mass)));
        if (b.hung == peers::nothing) {
            bodies_.push_back(MobilizedBody::Free(matter_.Ground(), Transform(), rigid, Transform()));
            return;
        }
        const peers::Joint& j = mechanism_.joints[b.hung];
        const bool ball = j.kind == "ball", slide = j.kind == "slide";
        const CoordinateAxis axis = slide ? CoordinateAxis(XAxis) : CoordinateAxis(ZAxis);
        const Rotation frame = ball ? Rotation() : Rotation(UnitVec3(vec(j.axis_second)), axis);
        const Transform inboard(turn(mechanism_.turn_in_parent(b)) * frame, vec(j.point_first));
        MobilizedBody parent = body(b.parent);
        if (ball)
            bodies_.push_back(MobilizedBody::Ball(parent, inboard, rigid, Transform(frame)));
        else if (slide)
            bodies_.push_back(MobilizedBody::Slider(parent, inboard, rigid, Transform(frame)));
        else
            bodies_.push_back(MobilizedBody::Pin(parent, inboard, rigid, Transform(frame)));
        if (!ball) load(j, bodies_.back());
    }

    /// What closes a plane loop holds in that plane: the rest would be redundant.
    void add(const peers::Joint& j)
    {
        MobilizedBody first = body(j.first), second = body(j.second);
        if (j.kind == "rod") {
            Constraint::Rod(first, vec(j.point_first), second, vec(j.point_second), j.length);
        } else {
            const peers::Joint& hinge = mechanism_.joints[mechanism_.bodies[j.second].hung];
            const Rotation across(UnitVec3(vec(j.kind == "ball" ? hinge.axis_first : j.axis_first)), ZAxis);
            for (const UnitVec3& normal : {across.x(), across.y()})
                Constraint::PointInPlane(first, normal, dot(normal, vec(j.point_first)), second,
                                         vec(j.point_second));
        }
    }

    void load(const peers::Joint& j, const MobilizedBody& body)
    {
        if (j.stiffness != 0)
            Force::MobilityLinearSpring(forces_, body, MobilizerQIndex(0), j.stiffness, j.push / j.stiffness);
        if (j.damping != 0) Force::MobilityLinearDamper(forces_, body, MobilizerUIndex(0), j.damping);
    }

    /// A road is a slide that is led.
    void add(const peers::Spring& spring)
    {
        MobilizedBody first = body(spring.first), second = body(spring.second);
        Vec3 from = vec(spring.point_first);
        if (spring.amplitude != 0) {
            const Rotation up(UnitVec3(0, 0, 1), XAxis);
            first = MobilizedBody::Slider(matter_.Ground(), Transform(up, from),
                                          Body::Rigid(MassProperties(1, Vec3(0), Inertia(1))), Transform(up));
            Motion::Sinusoid(first, Motion::Position, spring.amplitude, spring.omega, 0);
            from = Vec3(0);
        }
        const Vec3 to = vec(spring.point_second);
        Force::TwoPointLinearSpring(forces_, first, from, second, to, spring.stiffness, spring.free_length);
        Force::TwoPointLinearDamper(forces_, first, from, second, to, spring.damping);
    }

    /// By body-fixed angles: in a plane its law is that of a rotation vector.
    void add(const peers::Bushing& bushing)
    {
        const auto frame = [&](int i) {
            const Rotation turned = ~turn(mechanism_.turn(i));
            return Transform(turned, turned * (vec(bushing.at) - vec(mechanism_.place(i))));
        };
        const auto six = [](const std::array<double, 6>& a) {   // turns first
            return Vec6(a[3], a[4], a[5], a[0], a[1], a[2]);
        };
        Force::LinearBushing(forces_, body(bushing.first), frame(bushing.first), body(bushing.second),
                             frame(bushing.second), six(bushing.stiffness), six(bushing.damping));
    }

    void add(const peers::Gear& gear)
    {
        const auto hung = [&](int joint) {
            return bodies_[mechanism_.joints[joint].second].getMobilizedBodyIndex();
        };
        Constraint::CoordinateCoupler(matter_, new Function::Linear(Vector(Vec3(gear.ratio, -1, 0))),
                                      Array_<MobilizedBodyIndex>{hung(gear.first), hung(gear.second)},
                                      Array_<MobilizerQIndex>{MobilizerQIndex(0), MobilizerQIndex(0)});
    }

    void put(const peers::Body& b, const MobilizedBody& body)
    {
        if (b.hung == peers::nothing) {
            body.setQToFitTransform(start_, Transform(turn(b.R), vec(b.x)));
            body.setUToFitVelocity(start_, SpatialVec(vec(b.w), vec(b.v)));
        } else if (mechanism_.joints[b.hung].kind == "hinge") {
            body.setOneU(start_, 0,
                         peers::dot(mechanism_.joints[b.hung].axis_second, mechanism_.rate_in_parent(b)));
        }
    }

    const Mechanism& mechanism_;
    MultibodySystem system_;
    SimbodyMatterSubsystem matter_{system_};
    GeneralForceSubsystem forces_{system_};
    std::vector<MobilizedBody> bodies_;
    State start_;
};

std::unique_ptr<Integrator> integrator(const std::string& kind, const MultibodySystem& system)
{
    if (kind == "merson") return std::make_unique<RungeKuttaMersonIntegrator>(system);
    if (kind == "feldberg") return std::make_unique<RungeKuttaFeldbergIntegrator>(system);
    if (kind == "verlet") return std::make_unique<VerletIntegrator>(system);
    return std::make_unique<CPodesIntegrator>(system);
}

}   // namespace

int main()
{
    return peers::serve([](const Mechanism& m, const std::vector<std::string>& setting) {
        return [tree = std::make_shared<Tree>(m), setting] {
            return tree->solve(*integrator(setting.at(0), tree->system()), std::stod(setting.at(1)));
        };
    });
}
