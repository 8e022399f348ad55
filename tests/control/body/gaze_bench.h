// A head of seven joints as config/head has it, whose joints go where they are told one tick later, and a gaze object
// ticked as the engines do it; the high level runs every tenth tick.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "control/made_objects.h"
#include "control/tested_object.h"
#include "kadans/model/kinematics.h"

namespace kadans::test {

inline RobotModel head() {
  RobotModel model;
  model.name = "head";
  struct Row {
    const char *joint, *link;
    std::size_t parent;
    Vec3 origin_m, axis;
    double limit_rad, velocity_max_rad_s;
  };
  const Row rows[] = {{"lower_tilt", "cross", 0, {0, 0, 0}, {0, 1, 0}, 0.8, 5},
                      {"pan", "neck", 1, {0, 0, 0}, {0, 0, 1}, 1.9, 5},
                      {"roll", "upper", 2, {0, 0, 0.12}, {1, 0, 0}, 0.7, 5},
                      {"upper_tilt", "skull", 3, {0, 0, 0}, {0, 1, 0}, 0.8, 5},
                      {"eye_tilt", "fork", 4, {0.08, 0, 0.1}, {0, 1, 0}, 0.6, 10},
                      {"left_pan", "left", 5, {0, 0.06, 0}, {0, 0, 1}, 0.7, 10},
                      {"right_pan", "right", 5, {0, -0.06, 0}, {0, 0, 1}, 0.7, 10}};
  model.links.resize(1);
  model.links[0].name = "trunk";
  for (const Row& row : rows) {
    Link link;
    link.name = row.link;
    model.links.push_back(link);
    Joint joint;
    joint.name = row.joint;
    joint.parent = row.parent;
    joint.origin.position_m = row.origin_m;
    joint.axis = row.axis;
    joint.lower_rad = -row.limit_rad;
    joint.upper_rad = row.limit_rad;
    joint.velocity_max_rad_s = row.velocity_max_rad_s;
    joint.effort_max_Nm = 1;
    model.joints.push_back(joint);
  }
  return model;
}

inline ObjectOptions eyes() { return {{{"head", "skull"}, {"left_eye", "left"}, {"right_eye", "right"}}}; }

class GazeBench : public TestedObject {
 public:
  static constexpr std::size_t joint_count = 7;

  GazeBench() : model(head()), object(make_gaze({model, {0, 1, 2, 3, 4, 5, 6}, eyes()})), kinematics_(model) {
    declare(*object, joint_count);
    object->parameters_changed();
    object->start(input());
  }

  void look(const Vec3& at_m, double duration_s = 0) {
    for (std::uint32_t i = 0; i < 3; ++i) object->set_point(i, at_m[i], duration_s);
  }
  // The larger angle between an eye and the target, of the joints as they are, in degrees.
  double error_deg() {
    std::vector<double> q(joint_count);
    for (std::size_t i = 0; i < joint_count; ++i) q[i] = joints.joints[i].position_rad;
    kinematics_.update(q);
    double worst_rad = 0;
    for (const std::size_t link : {6U, 7U}) {
      const Pose& pose = kinematics_.link(link);
      const Vec3 target_m{signal("target_x_m"), signal("target_y_m"), signal("target_z_m")};
      const Vec3 way{target_m[0] - pose.position_m[0], target_m[1] - pose.position_m[1],
                     target_m[2] - pose.position_m[2]};
      const Vec3 seen = rotate_inverse(pose.orientation, way);
      worst_rad = std::max(worst_rad, std::atan2(std::hypot(seen[1], seen[2]), seen[0]));
    }
    return worst_rad * 57.29577951308232;
  }

  void tick() {
    control_tick();
    for (std::size_t i = 0; i < joint_count; ++i) {
      JointState& joint = joints.joints[i];
      if (written.joints[i].mode != ActuationMode::position || i == pushed) continue;
      const double before_rad_s = joint.velocity_rad_s;
      joint.velocity_rad_s = (written.joints[i].position_rad - joint.position_rad) / 0.001;
      if (i < 4) hardest_rad_s2 = std::max(hardest_rad_s2, std::abs(joint.velocity_rad_s - before_rad_s) / 0.001);
      joint.position_rad = written.joints[i].position_rad;
      fastest_share = std::max(fastest_share, std::abs(joint.velocity_rad_s) / model.joints[i].velocity_max_rad_s);
      inside_rad = std::min(inside_rad, model.joints[i].upper_rad - std::abs(joint.position_rad));
    }
    time_ns += 1'000'000;
  }
  void run(double time_s) {
    for (int i = 0; i < static_cast<int>(std::lround(time_s * 1000)); ++i) tick();
  }

  RobotModel model;
  std::unique_ptr<ControlObject> object;
  std::size_t pushed = joint_count;           // a joint that the test moves
  double fastest_share = 0, inside_rad = 10;  // largest speed so far; least distance to a position limit
  double hardest_rad_s2 = 0;                  // largest acceleration of the neck

 private:
  Kinematics kinematics_;
};

}  // namespace kadans::test
