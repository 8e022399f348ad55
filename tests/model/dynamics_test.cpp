#include "kadans/model/dynamics.h"

#include <cmath>

#include <Eigen/Cholesky>
#include <doctest/doctest.h>

#include "kadans/testing/allocation_count.h"
#include "random_state.h"

using namespace kadans;
using namespace kadans::test;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

void place(Dynamics& dynamics, const State& state) {
  dynamics.update(state.position_rad, state.velocity_rad_s, state.base);
}

// check(model, dynamics, state) for all robots, both kinds of base, ten states each.
template <typename Check>
void everywhere(Check&& check) {
  for (const RobotModel& model : {skew_tree(), bare_tree(), tulip()}) {
    for (const auto base : {Dynamics::Base::fixed, Dynamics::Base::floating}) {
      CAPTURE(model.name);
      Dynamics dynamics(model, {.base = base});
      RandomStream random(3, "states");
      for (int i = 0; i < 10; ++i) {
        State state = random_state(model, random);
        if (base == Dynamics::Base::fixed) state.base.velocity_m_s = state.base.angular_velocity_rad_s = {};
        place(dynamics, state);
        check(model, dynamics, state);
      }
    }
  }
}

Eigen::Vector3d point_of(const Dynamics& dynamics, std::size_t link, const Vec3& in_link_m) {
  const Vec3 at = transform(dynamics.link(link), in_link_m);
  return {at[0], at[1], at[2]};
}

double kinetic_energy_J(const RobotModel& model, const Dynamics& dynamics, const VectorXd& v) {
  double sum_J = 0;
  MatrixXd jacobian(6, v.size());
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const Inertia& inertia = model.links[i].inertia;
    dynamics.link_jacobian(i, inertia.com_m, jacobian);
    const VectorXd twist = jacobian * v;
    const Vec3 w = rotate_inverse(dynamics.link(i).orientation, {twist[3], twist[4], twist[5]});
    sum_J += 0.5 * inertia.mass_kg * twist.head<3>().squaredNorm();
    sum_J += 0.5 * (inertia.xx * w[0] * w[0] + inertia.yy * w[1] * w[1] + inertia.zz * w[2] * w[2]);
    sum_J += inertia.xy * w[0] * w[1] + inertia.xz * w[0] * w[2] + inertia.yz * w[1] * w[2];
  }
  return sum_J;
}

}  // namespace

TEST_CASE("Dynamics gives a pendulum's torque and inertia as its formula does") {
  RobotModel model;
  model.links.resize(2);
  model.links[1].inertia = {.mass_kg = 2, .com_m = {0, 0, -0.3}, .xx = 0.05, .yy = 0.04, .zz = 0.01};
  model.joints = {{.name = "hinge", .axis = {0, 1, 0}}};
  Dynamics dynamics(model, {.rotor_inertia_kg_m2 = {0.02}});
  const std::vector<double> at{0.7}, moving{1.5};
  dynamics.update(at, moving, {});
  CHECK(dynamics.mass_matrix()(0, 0) == doctest::Approx(0.04 + 2 * 0.09 + 0.02));
  CHECK(dynamics.bias()[0] == doctest::Approx(2 * 9.81 * 0.3 * std::sin(0.7)));
  MatrixXd gradient(1, 1);
  dynamics.gravity_gradient(gradient);
  CHECK(gradient(0, 0) == doctest::Approx(2 * 9.81 * 0.3 * std::cos(0.7)));
}

TEST_CASE("Dynamics' Jacobians are how points and the centre of mass move") {
  const Vec3 point_m{0.05, -0.1, 0.2};
  everywhere([&](const RobotModel&, Dynamics& dynamics, const State& state) {
    const auto n = static_cast<Index>(dynamics.size());
    const std::size_t link = state.position_rad.size();  // the last one
    MatrixXd jacobian(6, n), com(3, n);
    dynamics.link_jacobian(link, point_m, jacobian);
    dynamics.com_jacobian(com);
    const double h = 1e-6;
    for (Index i = 0; i < n; ++i) {
      place(dynamics, moved_on(state, VectorXd::Unit(n, i), -h));
      const Eigen::Vector3d before = point_of(dynamics, link, point_m);
      const Vec3 com_before = dynamics.com_m();
      place(dynamics, moved_on(state, VectorXd::Unit(n, i), h));
      const Eigen::Vector3d moves = (point_of(dynamics, link, point_m) - before) / (2 * h);
      CHECK((moves - jacobian.block<3, 1>(0, i)).norm() < 1e-8);
      for (Index k = 0; k < 3; ++k) {
        const auto part = static_cast<std::size_t>(k);
        CHECK(std::abs((dynamics.com_m()[part] - com_before[part]) / (2 * h) - com(k, i)) < 1e-8);
      }
    }
  });
}

TEST_CASE("Dynamics' gravity forces are the slope of the potential energy, and their gradient its curvature") {
  everywhere([](const RobotModel&, Dynamics& dynamics, const State& state) {
    const auto n = static_cast<Index>(dynamics.size()), joints = static_cast<Index>(state.position_rad.size());
    const VectorXd gravity = dynamics.gravity();
    MatrixXd gradient(joints, joints);
    dynamics.gravity_gradient(gradient);
    const double h = 1e-5;
    for (Index i = 0; i < n; ++i) {
      place(dynamics, moved_on(state, VectorXd::Unit(n, i), -h));
      const double before_J = dynamics.potential_energy_J();
      const VectorXd gravity_before = dynamics.gravity();
      place(dynamics, moved_on(state, VectorXd::Unit(n, i), h));
      CHECK(std::abs((dynamics.potential_energy_J() - before_J) / (2 * h) - gravity[i]) < 1e-7);
      if (i < n - joints) continue;
      const VectorXd curvature = (dynamics.gravity() - gravity_before).tail(joints) / (2 * h);
      CHECK((curvature - gradient.col(i - (n - joints))).norm() < 1e-7);
    }
  });
}

TEST_CASE("Dynamics' mass matrix holds the kinetic energy and is symmetric and positive definite") {
  everywhere([&](const RobotModel& model, Dynamics& dynamics, const State& state) {
    const MatrixXd& mass = dynamics.mass_matrix();
    const VectorXd v = velocities(state, dynamics);
    CHECK(0.5 * v.dot(mass * v) == doctest::Approx(kinetic_energy_J(model, dynamics, v)).epsilon(1e-12));
    CHECK((mass - mass.transpose()).cwiseAbs().maxCoeff() == 0);
    CHECK(Eigen::LLT<MatrixXd>(mass).info() == Eigen::Success);
  });
}

TEST_CASE("Dynamics' inverse dynamics is mass matrix times acceleration plus bias, rotors included") {
  for (const RobotModel& model : {skew_tree(), bare_tree(), tulip()}) {
    Dynamics dynamics(model, {.base = Dynamics::Base::floating,
                              .rotor_inertia_kg_m2 = std::vector<double>(model.joints.size(), 0.02)});
    RandomStream random(5, "states");
    place(dynamics, random_state(model, random));
    VectorXd acceleration(static_cast<Index>(dynamics.size())), force(acceleration.size());
    for (double& a : acceleration) a = random.uniform(-20, 20);
    dynamics.inverse_dynamics(acceleration, force);
    CHECK((dynamics.mass_matrix() * acceleration + dynamics.bias() - force).norm() < 1e-10 * force.norm());
  }
}

TEST_CASE("Dynamics of a floating base shows the whole robot's mass and weight at the base") {
  const RobotModel model = tulip();
  Dynamics dynamics(model, {.base = Dynamics::Base::floating});
  RandomStream random(9, "states");
  place(dynamics, random_state(model, random));
  CHECK(dynamics.mass_kg() == doctest::Approx(14));
  CHECK((dynamics.mass_matrix().block<3, 3>(0, 0) - 14 * Eigen::Matrix3d::Identity()).norm() < 1e-12);
  CHECK(dynamics.gravity()[2] == doctest::Approx(14 * 9.81));
}

TEST_CASE("Dynamics refuses rotors that are not one a joint") {
  const RobotModel model = skew_tree();
  CHECK_THROWS_WITH_AS(Dynamics(model, {.rotor_inertia_kg_m2 = {0.1}}),
                       "rotor_inertia_kg_m2 has 1 values, the model has 7 joints", std::invalid_argument);
}

TEST_CASE("A Jacobian's columns are the model's joints when its branches are numbered across each other") {
  RobotModel model;
  model.links.resize(5);
  for (const std::size_t parent : {0U, 0U, 1U, 2U}) {
    Joint& joint = model.joints.emplace_back();
    joint.parent = parent;
    joint.axis = {0, 1, 0};
    joint.origin.position_m = {0, parent == 0 ? 0.1 * static_cast<double>(model.joints.size()) : 0.0, -0.3};
  }
  Dynamics dynamics(model);
  const std::vector<double> at{0.1, 0.2, 0.3, 0.4}, still(4);
  MatrixXd jacobian(6, 4);
  for (std::size_t link = 0; link < 5; ++link) {
    dynamics.update(at, still, {});
    dynamics.link_jacobian(link, {0, 0, -0.2}, jacobian);
    for (std::size_t i = 0; i < 4; ++i) {
      std::vector<double> less = at, more = at;
      less[i] -= 1e-6, more[i] += 1e-6;
      dynamics.update(less, still, {});
      const Eigen::Vector3d before = point_of(dynamics, link, {0, 0, -0.2});
      dynamics.update(more, still, {});
      const Eigen::Vector3d moves = (point_of(dynamics, link, {0, 0, -0.2}) - before) / 2e-6;
      CHECK((moves - jacobian.block<3, 1>(0, static_cast<Index>(i))).norm() < 1e-8);
    }
  }
}

TEST_CASE("Dynamics allocates nothing once it is made") {
  const RobotModel model = tulip();
  Dynamics dynamics(model, {.base = Dynamics::Base::floating});
  RandomStream random(1, "states");
  const State state = random_state(model, random);
  const auto n = static_cast<Index>(dynamics.size());
  MatrixXd jacobian(6, n), com(3, n), gradient(14, 14);
  VectorXd acceleration = VectorXd::Ones(n), force(n);
  const kadans::testing::AllocationCount heap;
  place(dynamics, state);
  dynamics.inverse_dynamics(acceleration, force);
  dynamics.link_jacobian(6, {}, jacobian);
  dynamics.com_jacobian(com);
  dynamics.gravity_gradient(gradient);
  const auto allocations = heap.count();
  CHECK(allocations == 0);
}
