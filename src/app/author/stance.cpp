#include "stance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include <Eigen/Dense>

#include "control/body/body_model.h"
#include "kadans/model/dynamics.h"

namespace kadans {
namespace {

using Eigen::Vector3d;

constexpr double g_m_s2 = 9.81;

// Points of a shape that are outermost: corners, points of rims, of spheres some all around.
std::vector<Vec3> tips(const Geometry& geometry) {
  std::vector<Vec3> points;
  const auto add = [&](double x, double y, double z) { points.push_back(transform(geometry.pose, {x, y, z})); };
  if (const auto* box = std::get_if<Box>(&geometry.shape)) {
    for (int i = 0; i < 8; ++i)
      add(((i & 1) != 0 ? 0.5 : -0.5) * box->size_m[0], ((i & 2) != 0 ? 0.5 : -0.5) * box->size_m[1],
          ((i & 4) != 0 ? 0.5 : -0.5) * box->size_m[2]);
  } else if (const auto* sphere = std::get_if<Sphere>(&geometry.shape)) {
    for (int i = 0; i < 200; ++i) {
      const double z = 1 - (2.0 * i + 1) / 200, angle = 2.399963 * i, r = std::sqrt(1 - z * z);
      add(sphere->radius_m * r * std::cos(angle), sphere->radius_m * r * std::sin(angle), sphere->radius_m * z);
    }
  } else if (const auto* cylinder = std::get_if<Cylinder>(&geometry.shape)) {
    for (int i = 0; i < 16; ++i) {
      const double angle = i * std::numbers::pi / 8;
      for (const double end : {-0.5, 0.5})
        add(cylinder->radius_m * std::cos(angle), cylinder->radius_m * std::sin(angle), end * cylinder->length_m);
    }
  } else {
    for (const Vec3& corner : std::get<Mesh>(geometry.shape).corners_m) add(corner[0], corner[1], corner[2]);
  }
  return points;
}

// The robot at rest, its base where the world begins.
class Body {
 public:
  explicit Body(const RobotModel& model)
      : model_(model), dynamics_(model), at_rest_(model.joints.size()), tips_(model.links.size()) {
    for (std::size_t i = 0; i < model.links.size(); ++i) {
      for (const Geometry& geometry : model.links[i].collisions) {
        const std::vector<Vec3> more = tips(geometry);
        tips_[i].insert(tips_[i].end(), more.begin(), more.end());
      }
    }
  }

  void place(std::vector<double> position) {
    model_.lead_mimics(position);
    dynamics_.update(position, at_rest_, {});
  }
  const Dynamics& dynamics() const { return dynamics_; }
  const Pose& link(std::size_t index) const { return dynamics_.link(index); }
  Vector3d point(std::size_t link, const Vec3& in_link_m) const {
    return eigen(transform(dynamics_.link(link), in_link_m));
  }
  Vector3d com() const { return eigen(dynamics_.com_m()); }
  const std::vector<Vec3>& tips_of(std::size_t link) const { return tips_[link]; }
  double lowest(std::size_t link) const {
    double lowest = std::numeric_limits<double>::infinity();
    for (const Vec3& tip : tips_[link]) lowest = std::min(lowest, point(link, tip).z());
    return lowest;
  }
  // Around the points of a link that are lowest when it is turned by `turn` about its frame, in the world's axes.
  Eigen::AlignedBox3d resting(std::size_t link, const Quat& turn) const {
    constexpr double near_m = 0.003;
    const Pose& pose = dynamics_.link(link);
    const auto turned = [&](const Vec3& tip) -> Vector3d {
      return eigen(rotate(turn, rotate(pose.orientation, tip))) + eigen(pose.position_m);
    };
    double low = std::numeric_limits<double>::infinity();
    for (const Vec3& tip : tips_[link]) low = std::min(low, turned(tip).z());
    Eigen::AlignedBox3d around;
    for (const Vec3& tip : tips_[link]) {
      const Vector3d at = turned(tip);
      if (at.z() <= low + near_m) around.extend(at);
    }
    return around;
  }
  // The turn about the robot's x and y that lays the link on its largest side, of those that are not far.
  Quat to_sole(std::size_t link) const {
    constexpr int most_deg = 25;
    constexpr double deg = std::numbers::pi / 180, clearly = 1.2;
    const auto area = [&](const Quat& turn) {
      const Vector3d size = resting(link, turn).sizes();
      return size.x() * size.y();
    };
    std::vector<std::pair<int, int>> turns;  // the nearest first
    for (int roll = -most_deg; roll <= most_deg; ++roll)
      for (int pitch = -most_deg; pitch <= most_deg; ++pitch) turns.emplace_back(roll, pitch);
    std::ranges::stable_sort(turns, {},
                             [](const auto& turn) { return turn.first * turn.first + turn.second * turn.second; });
    Quat best{1, 0, 0, 0};
    double best_m2 = clearly * area(best);
    for (const auto& [roll, pitch] : turns) {
      const Quat turn = from_roll_pitch_yaw(roll * deg, pitch * deg, 0);
      const double m2 = area(turn);
      if (m2 <= best_m2) continue;
      best = turn;
      best_m2 = 1.01 * m2;
    }
    return best;
  }
  // The middle of what stands on the ground once the link is turned so, in the link's frame.
  Vec3 sole(std::size_t link, const Quat& turn = {1, 0, 0, 0}) const {
    const Eigen::AlignedBox3d around = resting(link, turn);
    const Pose& pose = dynamics_.link(link);
    const Vector3d middle(around.center().x(), around.center().y(), around.min().z());
    return rotate_inverse(pose.orientation, rotate_inverse(turn, vec3(middle - eigen(pose.position_m))));
  }
  // The rectangle around what stands on the ground, along the robot's x and y; a ball has one of 2 cm.
  std::array<Vec3, 4> sole_corners(std::size_t link) const {
    constexpr double least_m = 0.01;
    const double low = lowest(link);
    const Eigen::AlignedBox3d around = resting(link, Quat{1, 0, 0, 0});
    const Vector3d middle = around.center();
    const double half_x = std::max(around.sizes().x() / 2, least_m), half_y = std::max(around.sizes().y() / 2, least_m);
    const double outward = middle.y() < 0 ? -1 : 1;
    const Pose& pose = dynamics_.link(link);
    const auto corner = [&](double forward, double out) {
      const Vector3d at(middle.x() + forward * half_x, middle.y() + out * outward * half_y, low);
      return rotate_inverse(pose.orientation, vec3(at - eigen(pose.position_m)));
    };
    return {corner(-1, -1), corner(-1, 1), corner(1, -1), corner(1, 1)};
  }
  Vector3d axis(std::size_t joint) const {
    return eigen(rotate(link(joint + 1).orientation, model_.joints[joint].axis));
  }
  Vector3d place_of(std::size_t joint) const { return eigen(link(joint + 1).position_m); }
  bool swings(std::size_t joint) const { return std::abs(axis(joint).y()) > 0.7; }  // forward and back

 private:
  const RobotModel& model_;
  Dynamics dynamics_;
  std::vector<double> at_rest_;
  std::vector<std::vector<Vec3>> tips_;
};

struct Leg {
  std::size_t foot;                 // link
  std::vector<std::size_t> joints;  // from the base on
  Vec3 sole{};                      // in the foot's frame
  Quat level{};                     // the foot's orientation at the beginning
  Vector3d target = Vector3d::Zero();
};

class StanceSearch {
 public:
  explicit StanceSearch(const RobotModel& model) : model_(model), body_(model), position_(model.joints.size()) {
    for (std::size_t i = 0; i < position_.size(); ++i) position_[i] = within(i, 0, 0);
  }

  StandingPose run() {
    StandingPose stance;
    body_.place(position_);
    if (is_fixed()) {
      stance.why_held = "its root is 'world', or fixed to it";
    } else if (const auto [low, high] = extent(); high < low) {
      stance.why_held = "none of its links has a shape to touch with";
    } else {
      find_wheels(stance);
      if (stance.wheels.empty()) find_legs(stance);
    }
    if (legs_.size() < 2) {
      stance.stand = stance.low = position_;
      for (std::size_t i = 0; i < position_.size(); ++i) {
        if (model_.joints[i].passive() || stance.is_wheel(i)) continue;
        const double way = std::min(0.3, 0.8 * model_.joints[i].velocity_max_rad_s * sway_s / peak_speed);
        const double aside = within(i, position_[i] + way, 0.1);
        stance.low[i] = aside > position_[i] + way / 3 ? aside : within(i, position_[i] - way, 0.1);
      }
      relieve(stance.stand);
      relieve(stance.low);
      if (stance.held) lift(stance);
      return stance;
    }
    relieve(position_);
    bend();
    stance.stand = solve(0);
    body_.place(stance.stand);
    for (const Leg& leg : legs_) {
      stance.height_m = std::max(stance.height_m, -body_.lowest(leg.foot));
      StandingFoot& foot = stance.feet.emplace_back();
      foot.link = leg.foot;
      foot.name = model_.links[leg.foot].name;
      foot.leg = leg.joints;
      foot.corners_m = body_.sole_corners(leg.foot);
      for (const std::size_t joint : leg.joints) {
        if (!model_.joints[joint].passive() && std::abs(body_.axis(joint).z()) < 0.7) foot.bearing.push_back(joint);
      }
      const Vector3d frame = body_.point(leg.foot, {});
      foot.toe_m = body_.point(leg.foot, foot.corners_m[2]).x() - frame.x();
      foot.heel_m = frame.x() - body_.point(leg.foot, foot.corners_m[0]).x();
      foot.below_m = frame.z() - body_.point(leg.foot, foot.corners_m[0]).z();
      stance.com_m += (body_.com().z() - frame.z()) / static_cast<double>(legs_.size());
    }
    stance.width_m = width_m(stance.feet);
    stance.held = stance.width_m < narrowest_m;
    name_sides(stance.feet);
    stance.low = solve(0.12 * length());
    if (stance.held) lift(stance);
    return stance;
  }

 private:
  // How far what lies between points reaches in each direction on the ground, counted from `middle`: use(low, high).
  template <typename Use>
  static void across(const std::vector<Vector3d>& points, const Vector3d& middle, Use&& use) {
    constexpr int directions = 90;
    for (int i = 0; i < directions; ++i) {
      const double angle = i * std::numbers::pi / directions;
      const Vector3d way(std::cos(angle), std::sin(angle), 0);
      double low = std::numeric_limits<double>::infinity(), high = -low;
      for (const Vector3d& point : points) {
        const double at = way.dot(point - middle);
        low = std::min(low, at);
        high = std::max(high, at);
      }
      use(low, high);
    }
  }
  // Of all soles together on the ground, across the direction in which they are narrowest.
  double width_m(const std::vector<StandingFoot>& feet) const {
    std::vector<Vector3d> corners;
    for (const StandingFoot& foot : feet) {
      for (const Vec3& corner : foot.corners_m) corners.push_back(body_.point(foot.link, corner));
    }
    double narrowest = std::numeric_limits<double>::infinity();
    across(corners, Vector3d::Zero(), [&](double low, double high) { narrowest = std::min(narrowest, high - low); });
    return narrowest;
  }

  // What turns without end about an axis that lies, and hangs from the base, on a joint that steers it perhaps.
  bool may_be_wheel(std::size_t joint) const {
    if (model_.joints[joint].type != JointType::continuous || std::abs(body_.axis(joint).z()) > 0.3) return false;
    if (model_.coupling_of(joint) != nullptr) return false;  // it runs in one mode with what it is coupled to
    for (std::size_t link = model_.joints[joint].parent; link > 0; link = model_.joints[link - 1].parent) {
      if (std::abs(body_.axis(link - 1).z()) < 0.9) return false;
    }
    return round_about_axis(joint);
  }
  // Within what a wheel of six corners is.
  bool round_about_axis(std::size_t joint) const {
    constexpr double roundness = 0.8;
    const Vector3d axis = eigen(model_.joints[joint].axis), across_axis = axis.unitOrthogonal();
    double near = std::numeric_limits<double>::infinity(), far = 0;
    for (int i = 0; i < 24; ++i) {
      const double angle = i * std::numbers::pi / 12;
      const Vector3d way = std::cos(angle) * across_axis + std::sin(angle) * axis.cross(across_axis);
      double reach = 0;
      for (const Vec3& tip : body_.tips_of(joint + 1)) reach = std::max(reach, way.dot(eigen(tip)));
      near = std::min(near, reach);
      far = std::max(far, reach);
    }
    return near > roundness * far;
  }
  // Wheels, none when they and what else is as low do not carry the centre of mass.
  void find_wheels(StandingPose& stance) {
    const auto [low, high] = extent();
    const double near_m = std::clamp(0.05 * (high - low), 0.005, 0.01);
    std::vector<Vector3d> carrying;
    bool any = false;
    for (std::size_t i = 0; i < model_.links.size(); ++i) {
      if (body_.tips_of(i).empty() || body_.lowest(i) > low + near_m) continue;
      if (i > 0 && may_be_wheel(i - 1)) {
        any = true;
        carrying.push_back(body_.resting(i, Quat{1, 0, 0, 0}).center());
        if (!model_.joints[i - 1].passive()) stance.wheels.push_back({.joint = i - 1});
        continue;
      }
      for (const Vec3& tip : body_.tips_of(i)) {
        if (body_.point(i, tip).z() < low + near_m) carrying.push_back(body_.point(i, tip));
      }
    }
    bool carried = true;
    across(carrying, body_.com(),
           [&](double low_m, double high_m) { carried = carried && low_m < -least_reach_m && high_m > least_reach_m; });
    if (!carried) stance.wheels.clear();
    if (stance.wheels.empty() && any)
      stance.why_held = carried ? "its wheels have no motors" : "its wheels do not carry its centre of mass";
    if (stance.wheels.empty()) return;
    stance.held = false;
    stance.height_m = -low;
    point_forward(stance.wheels);
  }
  // Those whose axes lie across x roll along it; of a robot that has none, those like its first one.
  void point_forward(std::vector<StandingWheel>& wheels) const {
    const auto rolls_along_x = [&](const StandingWheel& wheel) { return std::abs(body_.axis(wheel.joint).y()) > 0.5; };
    const bool along_x = std::ranges::any_of(wheels, rolls_along_x);
    const Vector3d axis = along_x ? Vector3d::UnitY() : body_.axis(wheels.front().joint);
    for (StandingWheel& wheel : wheels) {
      const double alike = axis.dot(body_.axis(wheel.joint));
      wheel.forward = std::abs(alike) > 0.5 ? std::copysign(1.0, alike) : 0;
    }
  }
  // The heights between which all its shapes lie.
  std::pair<double, double> extent() const {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (std::size_t i = 0; i < model_.links.size(); ++i) {
      for (const Vec3& tip : body_.tips_of(i)) {
        low = std::min(low, body_.point(i, tip).z());
        high = std::max(high, body_.point(i, tip).z());
      }
    }
    return {low, high};
  }
  bool is_fixed() const {
    const auto& merged = model_.links[0].merged;
    return model_.links[0].name == "world" || std::ranges::find(merged, "world") != merged.end();
  }

  // Joints that bear more than their motors can give, but those of legs, move until there is some to spare: what stands
  // on them to where it is balanced, and what hangs on them down, as it would by itself.
  void relieve(std::vector<double>& position) {
    constexpr double share = 0.8, step_rad = 0.02;
    constexpr int rounds = 300;
    std::vector<bool> of_legs(position.size());
    for (const Leg& leg : legs_) {
      for (const std::size_t joint : leg.joints) of_legs[joint] = true;
    }
    const auto joints = static_cast<Eigen::Index>(position.size());
    Eigen::MatrixXd slope_Nm_per_rad(joints, joints);
    for (int round = 0; round < rounds; ++round) {
      body_.place(position);
      const Eigen::VectorXd gravity_Nm = body_.dynamics().gravity().tail(joints);
      body_.dynamics().gravity_gradient(slope_Nm_per_rad);
      bool moves = false;
      for (std::size_t i = 0; i < position.size(); ++i) {
        const Joint& joint = model_.joints[i];
        const auto at = static_cast<Eigen::Index>(i);
        const double bears_Nm = gravity_Nm[at];
        if (of_legs[i] || joint.passive() || joint.type == JointType::prismatic ||
            std::abs(bears_Nm) <= share * joint.effort_max_Nm)
          continue;
        const bool stands = slope_Nm_per_rad(at, at) < -std::abs(bears_Nm);  // within 45 degrees of its balance
        const double next = within(i, position[i] + std::copysign(step_rad, stands ? bears_Nm : -bears_Nm), 0);
        moves = moves || next != position[i];
        position[i] = next;
      }
      if (!moves) return;
    }
  }

  // As high as keeps all its links off the ground.
  void lift(StandingPose& stance) {
    constexpr double least_m = 1, clear_m = 0.2;
    stance.height_m = least_m;
    for (const std::vector<double>* position : {&stance.stand, &stance.low}) {
      body_.place(*position);
      for (std::size_t i = 0; i < model_.links.size(); ++i) {
        if (!body_.tips_of(i).empty()) stance.height_m = std::max(stance.height_m, clear_m - body_.lowest(i));
      }
    }
  }

  // left and right, or front_left to rear_right, where each side has one; the left one, and the front, comes first.
  void name_sides(std::vector<StandingFoot>& feet) const {
    if (feet.size() != 2 && feet.size() != 4) return;
    double middle_m = 0;
    for (const Leg& leg : legs_) middle_m += body_.point(leg.foot, leg.sole).x() / static_cast<double>(legs_.size());
    std::map<std::string, StandingFoot> named;
    for (std::size_t i = 0; i < feet.size(); ++i) {
      const Vector3d at = body_.point(legs_[i].foot, legs_[i].sole);
      const std::string side = at.y() > 0 ? "left" : "right", end = at.x() > middle_m ? "front_" : "rear_";
      named[feet.size() == 2 ? side : end + side] = feet[i];
    }
    if (named.size() != feet.size()) return;
    feet.clear();
    for (auto& [name, foot] : named) {
      feet.push_back(std::move(foot));
      feet.back().name = name;
    }
  }

  double within(std::size_t i, double wanted, double margin_share) const {
    const Joint& joint = model_.joints[i];
    const double lower = std::max(joint.lower_rad, joint.soft_lower_rad);
    const double upper = std::min(joint.upper_rad, joint.soft_upper_rad);
    const bool bounded = std::isfinite(lower) && std::isfinite(upper);
    const double range = upper - lower;
    // The safety layer's soft stops begin 0.03 rad before the limits.
    const double margin = bounded ? std::min(std::max(margin_share * range, 0.06), 0.25 * range) : 0;
    return std::clamp(wanted, lower + margin, upper - margin);
  }

  void find_legs(StandingPose& stance) {
    std::vector<bool> ends(model_.links.size(), true);
    for (const Joint& joint : model_.joints) ends[joint.parent] = false;
    const auto [low, high] = extent();
    const double share = 0.1 * (high - low);
    const bool low_base = !body_.tips_of(0).empty() && body_.lowest(0) < low + share;
    if (stance.why_held.empty())
      stance.why_held =
          low_base ? "its base is as low as what it would stand on" : "no two links at its ends are the lowest of all";
    if (low_base) return;
    for (std::size_t i = 1; i < model_.links.size(); ++i) {
      if (!ends[i] || body_.tips_of(i).empty() || body_.lowest(i) > low + share) continue;
      Leg leg{.foot = i};
      for (std::size_t link = i; link > 0; link = model_.joints[link - 1].parent) leg.joints.push_back(link - 1);
      std::ranges::reverse(leg.joints);
      const Quat turn = leg.joints.size() >= level_joints ? body_.to_sole(i) : Quat{1, 0, 0, 0};
      leg.sole = body_.sole(i, turn);
      leg.level = multiply(turn, body_.link(i).orientation);
      legs_.push_back(leg);
    }
  }

  // From the first joint that swings the leg forward to the sole, stretched.
  double length() const {
    double longest = 0;
    for (const Leg& leg : legs_) {
      std::optional<Vector3d> last;
      double sum = 0;
      for (const std::size_t joint : leg.joints) {
        if (!body_.swings(joint)) continue;
        if (last) sum += (body_.place_of(joint) - *last).norm();
        last = body_.place_of(joint);
      }
      if (last) sum += (body_.point(leg.foot, leg.sole) - *last).norm();
      longest = std::max(longest, sum);
    }
    return longest;
  }

  // Knees, and what else bends one way alone, a little: a straight leg can move nowhere.
  void bend() {
    constexpr double much = 1.5, bent_rad = 0.4;
    body_.place(position_);
    const double leg_m = length();
    for (Leg& leg : legs_) {
      leg.target = body_.point(leg.foot, leg.sole);
      if (leg.joints.size() >= level_joints) {
        leg.target.z() += 0.06 * leg_m;
      } else {
        const auto swinging = std::ranges::find_if(leg.joints, [&](std::size_t j) { return body_.swings(j); });
        const Vector3d top = body_.place_of(swinging == leg.joints.end() ? leg.joints.front() : *swinging);
        leg.target.x() = top.x();
        leg.target.z() = top.z() - 0.72 * leg_m;
      }
      for (const std::size_t i : leg.joints) {
        const Joint& joint = model_.joints[i];
        if (!body_.swings(i) || joint.passive()) continue;
        if (joint.upper_rad > -much * joint.lower_rad) position_[i] = within(i, std::max(position_[i], bent_rad), 0.02);
        if (-joint.lower_rad > much * joint.upper_rad)
          position_[i] = within(i, std::min(position_[i], -bent_rad), 0.02);
      }
    }
  }

  // Legs at their targets, lowered by so much, the centre of mass over the middle of the soles.
  std::vector<double> solve(double lowered_m) {
    std::vector<double> position = position_;
    Vector3d shift(0, 0, lowered_m);
    for (int round = 0; round < 8; ++round) {
      for (int step = 0; step < 40; ++step) {
        for (const Leg& leg : legs_) improve(leg, leg.target + shift, position);
      }
      body_.place(position);
      Vector3d middle = Vector3d::Zero();
      for (const Leg& leg : legs_) middle += body_.point(leg.foot, leg.sole) / static_cast<double>(legs_.size());
      Vector3d off = body_.com() - middle;
      off.z() = 0;
      shift += off;
    }
    return position;
  }

  void improve(const Leg& leg, const Vector3d& target, std::vector<double>& position) {
    constexpr double damping = 1e-3, step_max_rad = 0.1;
    const double turn_m = leg.joints.size() >= level_joints ? 0.2 : 0;
    const auto count = static_cast<Eigen::Index>(leg.joints.size());
    body_.place(position);
    Eigen::Vector<double, 6> error;
    error << target - body_.point(leg.foot, leg.sole),
        turn_m * turn_between(body_.link(leg.foot).orientation, leg.level);
    Eigen::MatrixXd all(6, static_cast<Eigen::Index>(position.size())), slope = Eigen::MatrixXd::Zero(6, count);
    body_.dynamics().link_jacobian(leg.foot, leg.sole, all);
    all.bottomRows<3>() *= turn_m;
    for (Eigen::Index k = 0; k < count; ++k) {
      const std::size_t joint = leg.joints[static_cast<std::size_t>(k)];
      if (!model_.joints[joint].passive()) slope.col(k) = all.col(static_cast<Eigen::Index>(joint));
    }
    const Eigen::MatrixXd square = slope.transpose() * slope + damping * Eigen::MatrixXd::Identity(count, count);
    const Eigen::VectorXd way = square.ldlt().solve(slope.transpose() * error);
    for (Eigen::Index k = 0; k < count; ++k) {
      const std::size_t joint = leg.joints[static_cast<std::size_t>(k)];
      position[joint] = within(joint, position[joint] + std::clamp(way[k], -step_max_rad, step_max_rad), 0.02);
    }
  }

  static constexpr std::size_t level_joints = 5;
  static constexpr double sway_s = 2, peak_speed = 1.875;  // of the written behavior: in units of its mean speed
  static constexpr double narrowest_m = 0.06;
  static constexpr double least_reach_m = 0.003;  // of what a base on wheels stands on, beyond its centre of mass

  const RobotModel& model_;
  Body body_;
  std::vector<double> position_;
  std::vector<Leg> legs_;
};

struct Carried {
  double mass_kg = 0;
  Vector3d moment = Vector3d::Zero();  // mass times place
};

// What each link carries, itself included.
std::vector<Carried> carried(const RobotModel& model, const Body& body) {
  std::vector<Carried> all;
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const Inertia& own = model.links[i].inertia;
    all.push_back({own.mass_kg, own.mass_kg * body.point(i, own.com_m)});
  }
  for (std::size_t i = model.joints.size(); i-- > 0;) {  // children come after their parents
    Carried& parent = all[model.joints[i].parent];
    parent.mass_kg += all[i + 1].mass_kg;
    parent.moment += all[i + 1].moment;
  }
  return all;
}

// The mass matrix of the joints in `stand`, without rotors: of a robot that is not held the base gives way, too.
Eigen::MatrixXd mass_of_joints(const RobotModel& model, const StandingPose& stance) {
  Dynamics dynamics(model, {.base = stance.held ? Dynamics::Base::fixed : Dynamics::Base::floating});
  dynamics.update(stance.stand, std::vector<double>(model.joints.size()), {});
  const auto base = static_cast<Eigen::Index>(dynamics.base_size());
  const Eigen::MatrixXd& mass = dynamics.mass_matrix();
  if (base == 0) return mass;
  const Eigen::MatrixXd shared = mass.bottomLeftCorner(mass.rows() - base, base);
  const Eigen::MatrixXd own = mass.bottomRightCorner(mass.rows() - base, mass.cols() - base);
  return own - shared * mass.topLeftCorner(base, base).ldlt().solve(shared.transpose());
}

// Lowers gains until no movement of the joints together is faster than `most`: the largest eigenvalue of
// mass^-1 diag(gains). Each gain is lowered by its share in the fastest movement.
void slow_down(const Eigen::MatrixXd& mass, double most, Eigen::VectorXd& gains) {
  if (gains.size() == 0) return;
  for (int round = 0; round < 300; ++round) {
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> modes(Eigen::MatrixXd(gains.asDiagonal()), mass);
    const double fastest = modes.eigenvalues().tail<1>()[0];
    if (fastest <= most) return;
    const Eigen::ArrayXd way = modes.eigenvectors().rightCols<1>().array().square() * gains.array();
    gains.array() *= 1 - 0.5 * (1 - most / fastest) * way / way.maxCoeff();
  }
}

// With two ticks of delay at 1 kHz and a velocity filtered at 100 Hz stiffness / inertia of 28000 is the edge of
// stability: half of that. With a longer delay, the filter's among it, all of it is slower by as much.
double loop_lag_s(const JointLoop& loop) {
  return loop.delay_s + std::numbers::sqrt2 / (2 * std::numbers::pi * loop.velocity_cutoff_Hz);
}
double loop_speed(const JointLoop& loop) { return loop_lag_s({}) / loop_lag_s(loop); }

}  // namespace

StandingPose find_stance(const RobotModel& model) {
  StandingPose stance = StanceSearch(model).run();
  model.lead_mimics(stance.stand);
  model.lead_mimics(stance.low);
  return stance;
}

double stiffest_per_s2(const JointLoop& loop) { return 14000 * loop_speed(loop) * loop_speed(loop); }

std::vector<JointHold> hold_joints(const RobotModel& model, const StandingPose& stance,
                                   const std::vector<JointLoop>& loops) {
  // A rotor that its motor's whole torque brings to 2500 rad/s2 is typical of drives of legs and arms; E.
  constexpr double rotor_per_Nm = 1.0 / 2500, implausible_Nm = 5000;
  constexpr double most_damped = 135;  // damping / inertia, half of the edge with the delay of 14000
  constexpr double most_stiffness = 50000, most_damping = 5000;         // that joint_pid takes
  constexpr double own_bandwidth = 225, sag_rad = 0.04, over_load = 3;  // (15 rad/s)^2
  constexpr double stuck_rad = 0.005;                                   // where friction holds it, at most
  constexpr double slowest_s = 0.05;                                    // in which what damps it lets it come home
  constexpr double stiffness_per_damping = 40;                          // that a delay of 4 ms allows, by far
  Body body(model);
  body.place(stance.stand);
  Eigen::MatrixXd mass = mass_of_joints(model, stance);
  Eigen::VectorXd stiffness = Eigen::VectorXd::Zero(mass.rows()), damping = stiffness;
  const std::vector<Carried> all = carried(model, body);
  // What each foot carries.
  const double weight_N = g_m_s2 * model.mass_kg() / std::max(1.0, static_cast<double>(stance.feet.size()));
  std::map<std::size_t, std::size_t> foot_of;  // by joint of a leg
  for (const StandingFoot& foot : stance.stands_on()) {
    for (const std::size_t joint : foot.leg) foot_of[joint] = foot.link;
  }
  std::vector<JointHold> holds(model.joints.size());
  for (std::size_t i = 0; i < holds.size(); ++i) {
    const Joint& joint = model.joints[i];
    if (joint.passive()) continue;
    JointHold& hold = holds[i];
    const Carried& hung = all[i + 1];
    const bool slides = joint.type == JointType::prismatic;
    const auto at_joint = static_cast<Eigen::Index>(i);
    const JointLoop loop = loops.empty() ? JointLoop{} : loops[i];
    // A torque that no motor of the size has says nothing of its rotor.
    const double by_torque =
        joint.effort_max_Nm < implausible_Nm ? rotor_per_Nm * joint.effort_max_Nm : mass(at_joint, at_joint);
    hold.rotor_inertia_kg_m2 =
        joint.rotor_inertia_kg_m2 > 0 ? joint.rotor_inertia_kg_m2 : std::clamp(by_torque, 1e-4, 10.0);
    mass(at_joint, at_joint) += hold.rotor_inertia_kg_m2;
    // A joint with damping is as slow as one with more inertia, and may be held as stiffly.
    mass(at_joint, at_joint) += stiffness_per_damping * joint.damping_Nms_per_rad / stiffest_per_s2({});
    const double inertia = loop.inertia_kg_m2 > 0 ? loop.inertia_kg_m2 : mass(at_joint, at_joint);
    const double friction_Nm = loops.empty() ? joint.friction_Nm : loop.friction_Nm;
    const Vector3d at = body.place_of(i);
    hold.load_Nm_per_rad = slides ? 0 : g_m_s2 * (hung.moment - hung.mass_kg * at).norm();
    double wanted = std::max({over_load * hold.load_Nm_per_rad, own_bandwidth * inertia, friction_Nm / stuck_rad});
    wanted = std::max(wanted, joint.damping_Nms_per_rad / slowest_s);
    if (slides) wanted = std::max(wanted, hung.mass_kg * g_m_s2 / 0.005);
    const auto foot = slides ? foot_of.end() : foot_of.find(i);
    const bool leg = foot != foot_of.end();
    if (leg) {
      const Vector3d sole = body.point(foot->second, body.sole(foot->second));
      const double standing = weight_N * std::max(0.0, body.com().z() - sole.z());
      const double torque_Nm = std::abs(body.axis(i).dot((sole - at).cross(Vector3d(0, 0, weight_N))));
      hold.load_Nm_per_rad = std::max(hold.load_Nm_per_rad, standing);
      wanted = std::max({wanted, over_load * standing, torque_Nm / sag_rad});
    }
    stiffness[at_joint] = std::min({wanted, stiffest_per_s2(loop) * inertia, most_stiffness});
    const double critical = 1.4 * std::sqrt(stiffness[at_joint] * inertia);
    damping[at_joint] = std::min({leg ? std::max(critical, 0.03 * stiffness[at_joint]) : critical,
                                  most_damped * loop_speed(loop) * inertia, most_damping});
  }
  if (loops.empty()) {  // what was measured was measured joint by joint
    slow_down(mass, stiffest_per_s2({}), stiffness);
    slow_down(mass, most_damped, damping);
  }
  for (std::size_t i = 0; i < holds.size(); ++i) {
    const auto at_joint = static_cast<Eigen::Index>(i);
    holds[i].stiffness_Nm_per_rad = stiffness[at_joint];
    holds[i].damping_Nms_per_rad = damping[at_joint];
    holds[i].weak = stiffness[at_joint] < 1.2 * holds[i].load_Nm_per_rad;
  }
  return holds;
}

}  // namespace kadans
