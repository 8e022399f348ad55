#include "leg_load.h"

#include "body_ahead.h"

namespace kadans {
namespace {

Vec3 moment(const Vec3& a, const Vec3& b) noexcept {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double along(const Vec3& a, const Vec3& b) noexcept { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

}  // namespace

LegLoad::LegLoad(const RobotModel& model, std::size_t foot) : model_(&model) {
  for (std::size_t link = foot; link != 0; link = model.joints[link - 1].parent) {
    bearings_.push_back({.joint = link - 1});
  }
}

void LegLoad::update(const Kinematics& kinematics, const Vec3& force_N, const Vec3& point_m) noexcept {
  Vec3 force = force_N;
  Vec3 about_origin = moment(point_m, force_N);  // about the origin
  for (Bearing& bearing : bearings_) {
    const std::size_t link = bearing.joint + 1;
    const Pose& pose = kinematics.link(link);
    const Inertia& inertia = model_->links[link].inertia;
    const Vec3 weight{0, 0, -gravity_of_balance_m_s2 * inertia.mass_kg};
    const Vec3 weight_moment = moment(transform(pose, inertia.com_m), weight);
    for (std::size_t k = 0; k < 3; ++k) {
      force[k] += weight[k];
      about_origin[k] += weight_moment[k];
    }
    const Vec3 shift = moment(pose.position_m, force);
    const Vec3 about{about_origin[0] - shift[0], about_origin[1] - shift[1], about_origin[2] - shift[2]};
    bearing.effort_Nm = -along(rotate(pose.orientation, model_->joints[bearing.joint].axis), about);
  }
}

}  // namespace kadans
