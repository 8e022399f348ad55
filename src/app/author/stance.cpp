#include "stance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>

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

  void place(const std::vector<double>& position) { dynamics_.update(position, at_rest_, {}); }
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
  // The middle of what stands on the ground, in the link's frame.
  Vec3 sole(std::size_t link) const {
    constexpr double near_m = 0.01;
    const double low = lowest(link);
    Vector3d sum = Vector3d::Zero();
    double count = 0;
    for (const Vec3& tip : tips_[link]) {
      if (point(link, tip).z() > low + near_m) continue;
      sum += eigen(tip);
      ++count;
    }
    return vec3(sum / count);
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

bool moves(const Joint& joint) { return !joint.passive() && !joint.mimic; }

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
    find_legs();
    if (legs_.size() < 2) {
      stance.stand = stance.low = position_;
      for (std::size_t i = 0; i < position_.size(); ++i) {
        if (!moves(model_.joints[i])) continue;
        const double aside = within(i, position_[i] + 0.3, 0.1);
        stance.low[i] = aside > position_[i] + 0.1 ? aside : within(i, position_[i] - 0.3, 0.1);
      }
      return stance;
    }
    for (const Leg& leg : legs_) stance.feet.push_back(leg.foot);
    bend();
    stance.stand = solve(0);
    body_.place(stance.stand);
    for (const Leg& leg : legs_) stance.height_m = std::max(stance.height_m, -body_.lowest(leg.foot));
    stance.low = solve(0.12 * length());
    return stance;
  }

 private:
  double within(std::size_t i, double wanted, double margin_share) const {
    const Joint& joint = model_.joints[i];
    const bool bounded = std::isfinite(joint.lower_rad) && std::isfinite(joint.upper_rad);
    const double range = joint.upper_rad - joint.lower_rad;
    // The safety layer's soft stops begin 0.03 rad before the limits.
    const double margin = bounded ? std::min(std::max(margin_share * range, 0.06), 0.25 * range) : 0;
    return std::clamp(wanted, joint.lower_rad + margin, joint.upper_rad - margin);
  }

  void find_legs() {
    body_.place(position_);
    std::vector<bool> ends(model_.links.size(), true);
    for (const Joint& joint : model_.joints) ends[joint.parent] = false;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (std::size_t i = 0; i < model_.links.size(); ++i) {
      for (const Vec3& tip : body_.tips_of(i)) {
        const double z = body_.point(i, tip).z();
        low = std::min(low, z);
        high = std::max(high, z);
      }
    }
    const double share = 0.1 * (high - low);
    const auto& merged = model_.links[0].merged;
    if (model_.links[0].name == "world" || std::ranges::find(merged, "world") != merged.end()) return;
    if (!body_.tips_of(0).empty() && body_.lowest(0) < low + share) return;
    for (std::size_t i = 1; i < model_.links.size(); ++i) {
      if (!ends[i] || body_.tips_of(i).empty() || body_.lowest(i) > low + share) continue;
      Leg leg{.foot = i};
      for (std::size_t link = i; link > 0; link = model_.joints[link - 1].parent) leg.joints.push_back(link - 1);
      std::ranges::reverse(leg.joints);
      leg.sole = body_.sole(i);
      leg.level = body_.link(i).orientation;
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
        if (!body_.swings(i) || !moves(joint)) continue;
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
      if (moves(model_.joints[joint])) slope.col(k) = all.col(static_cast<Eigen::Index>(joint));
    }
    const Eigen::MatrixXd square = slope.transpose() * slope + damping * Eigen::MatrixXd::Identity(count, count);
    const Eigen::VectorXd way = square.ldlt().solve(slope.transpose() * error);
    for (Eigen::Index k = 0; k < count; ++k) {
      const std::size_t joint = leg.joints[static_cast<std::size_t>(k)];
      position[joint] = within(joint, position[joint] + std::clamp(way[k], -step_max_rad, step_max_rad), 0.02);
    }
  }

  static constexpr std::size_t level_joints = 5;

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

// With two ticks of delay at 1 kHz and a velocity filtered at 100 Hz stiffness / inertia of 28000 is the edge of
// stability: half of that. With a longer delay, the filter's among it, all of it is slower by as much.
double loop_lag_s(const JointLoop& loop) {
  return loop.delay_s + std::numbers::sqrt2 / (2 * std::numbers::pi * loop.velocity_cutoff_Hz);
}
double loop_speed(const JointLoop& loop) { return loop_lag_s({}) / loop_lag_s(loop); }

}  // namespace

StandingPose find_stance(const RobotModel& model) { return StanceSearch(model).run(); }

double stiffest_per_s2(const JointLoop& loop) { return 14000 * loop_speed(loop) * loop_speed(loop); }

std::vector<JointHold> hold_joints(const RobotModel& model, const StandingPose& stance,
                                   const std::vector<JointLoop>& loops) {
  // A rotor that its motor's whole torque brings to 2500 rad/s2 is typical of drives of legs and arms; E.
  constexpr double rotor_per_Nm = 1.0 / 2500;
  constexpr double most_damped = 135;  // damping / inertia, half of the edge with the delay of 14000
  constexpr double own_bandwidth = 225, sag_rad = 0.04, over_load = 3;  // (15 rad/s)^2
  constexpr double stuck_rad = 0.005;                                   // where friction holds it, at most
  Body body(model);
  body.place(stance.stand);
  const std::vector<Carried> all = carried(model, body);
  // What each foot carries.
  const double weight_N = g_m_s2 * model.mass_kg() / std::max(1.0, static_cast<double>(stance.feet.size()));
  std::map<std::size_t, std::size_t> foot_of;  // by joint of a leg
  for (const std::size_t foot : stance.feet) {
    for (std::size_t link = foot; link > 0; link = model.joints[link - 1].parent) foot_of[link - 1] = foot;
  }
  std::vector<JointHold> holds(model.joints.size());
  for (std::size_t i = 0; i < holds.size(); ++i) {
    const Joint& joint = model.joints[i];
    if (!moves(joint)) continue;
    JointHold& hold = holds[i];
    const Carried& hung = all[i + 1];
    const bool slides = joint.type == JointType::prismatic;
    hold.rotor_inertia_kg_m2 =
        joint.rotor_inertia_kg_m2 > 0 ? joint.rotor_inertia_kg_m2 : std::max(1e-4, rotor_per_Nm * joint.effort_max_Nm);
    if (!std::isfinite(hold.rotor_inertia_kg_m2) || joint.effort_max_Nm > 1e5) hold.rotor_inertia_kg_m2 = 0.01;
    const auto at_joint = static_cast<Eigen::Index>(i);
    const JointLoop loop = loops.empty() ? JointLoop{} : loops[i];
    const double inertia = loop.inertia_kg_m2 > 0
                               ? loop.inertia_kg_m2
                               : body.dynamics().mass_matrix()(at_joint, at_joint) + hold.rotor_inertia_kg_m2;
    const Vector3d at = body.place_of(i);
    hold.load_Nm_per_rad = slides ? 0 : g_m_s2 * (hung.moment - hung.mass_kg * at).norm();
    double wanted = std::max({over_load * hold.load_Nm_per_rad, own_bandwidth * inertia, loop.friction_Nm / stuck_rad});
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
    hold.stiffness_Nm_per_rad = std::min(wanted, stiffest_per_s2(loop) * inertia);
    hold.weak = hold.stiffness_Nm_per_rad < 1.2 * hold.load_Nm_per_rad;
    const double critical = 1.4 * std::sqrt(hold.stiffness_Nm_per_rad * inertia);
    const double damping = leg ? std::max(critical, 0.03 * hold.stiffness_Nm_per_rad) : critical;
    hold.damping_Nms_per_rad = std::min(damping, most_damped * loop_speed(loop) * inertia);
  }
  return holds;
}

}  // namespace kadans
