// One robot twice: with the plant's own solver, which takes Bullet's law of friction for it, and with Bullet's, both
// iterated to the end, with the same joint torques by the same rule, and how far the two are apart.
#pragma once

#include <algorithm>
#include <cmath>

#include "plant/bullet/solver/contact_row.h"
#include "plant/tulip_robot.h"

namespace kadans::test {

struct SolverPair {
  explicit SolverPair(Robot robot)
      : tree(with(robot, ContactSolver::tree)),
        stock(with(robot, ContactSolver::stock)),
        tree_hold(robot),
        stock_hold(robot) {}

  static BulletWorld with(Robot robot, ContactSolver solver) {
    robot.settings.solver = solver;
    robot.settings.solver_iterations = 400;
    return BulletWorld(robot.model, robot.settings, 1, bullet::FrictionLaw::pyramid);
  }

  void tick() {
    tree_hold.tick(tree);
    stock_hold.tick(stock);
  }
  void aim(std::size_t joint, double position_rad) {
    tree_hold.aim(joint, position_rad);
    stock_hold.aim(joint, position_rad);
  }
  void push(std::size_t link, const Vec3& force_N) {
    tree.push(link, force_N, {});
    stock.push(link, force_N, {});
  }

  double apart_m() const {
    const Vec3 &a = tree.truth().com_m, &b = stock.truth().com_m;
    return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
  }
  double objects_apart_m() const {
    double worst = 0;
    for (std::size_t i = 0; i < tree.truth().object_count; ++i) {
      const Vec3 &a = tree.truth().objects[i].pose.position_m, &b = stock.truth().objects[i].pose.position_m;
      worst = std::max(worst, std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]));
    }
    return worst;
  }
  double apart_rad() const {
    double worst = 0;
    for (std::size_t i = 0; i < tree.truth().joint_count; ++i) {
      worst = std::max(worst, std::abs(tree.truth().position_rad[i] - stock.truth().position_rad[i]));
    }
    return worst;
  }
  double apart_rad_s() const {
    double worst = 0;
    for (std::size_t i = 0; i < tree.truth().joint_count; ++i) {
      worst = std::max(worst, std::abs(tree.truth().velocity_rad_s[i] - stock.truth().velocity_rad_s[i]));
    }
    return worst;
  }
  double apart_N() const {
    double worst = 0;
    for (std::size_t i = 0; i < tree.truth().foot_count; ++i) {
      worst = std::max(worst, std::abs(tree.truth().foot_force_N[i][2] - stock.truth().foot_force_N[i][2]));
    }
    return worst;
  }

  BulletWorld tree, stock;
  JointHold tree_hold, stock_hold;
};

}  // namespace kadans::test
