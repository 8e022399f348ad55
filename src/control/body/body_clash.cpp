#include "body_clash.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kadans/model/kinematics.h"

namespace kadans {

using Eigen::Vector3d;

namespace {

constexpr double clash_margin_m = 0.003;

// A box in the shape's frame, and the radius around that, which hold the shape.
struct Hold {
  Vec3 center_m{};
  Vector3d half_m = Vector3d::Zero();
  double radius_m = 0;
};

Hold holding(const Shape& shape) {
  if (const auto* box = std::get_if<Box>(&shape)) return {.half_m = 0.5 * eigen(box->size_m)};
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return {.radius_m = sphere->radius_m};
  if (const auto* cylinder = std::get_if<Cylinder>(&shape))
    return {.half_m = {cylinder->radius_m, cylinder->radius_m, 0.5 * cylinder->length_m}};
  const Around around = box_around(std::get<Mesh>(shape));
  return {.center_m = around.center_m, .half_m = 0.5 * eigen(around.size_m)};
}

bool collides(const Geometry& geometry) {
  const auto* const mesh = std::get_if<Mesh>(&geometry.shape);
  return mesh == nullptr || !mesh->corners_m.empty();
}

}  // namespace

BodyClash::BodyClash(const RobotModel& model) {
  for (std::size_t link = 0; link < model.links.size(); ++link) {
    for (const Geometry& geometry : model.links[link].collisions) {
      if (!collides(geometry)) continue;
      const Hold hold = holding(geometry.shape);
      const Pose pose = compose(geometry.pose, {.position_m = hold.center_m});
      solids_.push_back({link, pose, hold.half_m, hold.radius_m, hold.half_m.norm() + hold.radius_m});
    }
  }
  place(BodyGeometry(model, true));
  std::vector<bool> apart(model.links.size() * model.links.size(), true);
  const auto at = [&](std::size_t a, std::size_t b) { return std::min(a, b) * model.links.size() + std::max(a, b); };
  for (std::size_t i = 0; i < model.joints.size(); ++i) apart[at(model.joints[i].parent, i + 1)] = false;
  for (const Solid& a : solids_) {
    for (const Solid& b : solids_) {
      if (a.link == b.link || near(a, b, 0)) apart[at(a.link, b.link)] = false;
    }
  }
  for (std::size_t i = 0; i < solids_.size(); ++i) {
    for (std::size_t k = i + 1; k < solids_.size(); ++k) {
      if (apart[at(solids_[i].link, solids_[k].link)]) candidates_.push_back({i, k});
    }
  }
}

void BodyClash::place(const BodyGeometry& posture) noexcept {
  for (Solid& solid : solids_) {
    const Pose pose = compose(posture.link(solid.link), solid.pose);
    solid.center_m = eigen(pose.position_m);
    solid.axes = matrix_of(pose.orientation);
  }
}

bool BodyClash::near(const Solid& a, const Solid& b, double margin_m) noexcept {
  const Vector3d way = b.center_m - a.center_m;
  const double room_m = a.radius_m + b.radius_m + margin_m;
  if (way.squaredNorm() > (a.reach_m + b.reach_m + margin_m) * (a.reach_m + b.reach_m + margin_m)) return false;
  const auto apart = [&](const Vector3d& axis) {
    const double length = axis.norm();
    if (!(length > 1e-9)) return false;
    const double spread =
        (a.axes.transpose() * axis).cwiseAbs().dot(a.half_m) + (b.axes.transpose() * axis).cwiseAbs().dot(b.half_m);
    return std::abs(way.dot(axis)) > spread + room_m * length;
  };
  if (apart(way)) return false;
  for (int i = 0; i < 3; ++i) {
    if (apart(a.axes.col(i)) || apart(b.axes.col(i))) return false;
    for (int k = 0; k < 3; ++k) {
      if (apart(a.axes.col(i).cross(b.axes.col(k)))) return false;
    }
  }
  return true;
}

void BodyClash::begin(const BodyGeometry& posture) noexcept {
  place(posture);
  for (Candidate& pair : candidates_) pair.counts = !near(solids_[pair.one], solids_[pair.other], clash_margin_m);
}

BodyClash::Pair BodyClash::find(const BodyGeometry& posture) noexcept {
  place(posture);
  for (const Candidate& pair : candidates_) {
    const Solid &one = solids_[pair.one], &other = solids_[pair.other];
    if (pair.counts && near(one, other, clash_margin_m)) return {one.link, other.link};
  }
  return {};
}

}  // namespace kadans
