// The masses of a URDF: whether each body that moves can be simulated.
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <Eigen/Dense>

#include "kadans/model/inertia.h"
#include "kadans/model/kinematics.h"
#include "urdf_description.h"

namespace kadans {
namespace {

// A body is a link with all that is fixed to it. The root may be without mass: a base that is bolted to the world. So
// may a link that moves, when links with mass hang on it: as between the joints of a universal joint. What moves it
// then are the forces of those, and it is simulated as it is, unless it could move while all masses stand still.
class MassCheck {
 public:
  MassCheck(UrdfDocument& document, const UrdfDescription& robot) : document_(document), robot_(robot) {
    for (const UrdfLink& link : robot.links) links_.emplace(link.name, &link);
    for (const UrdfJoint& joint : robot.joints) above_.emplace(joint.child.link, &joint);
    for (const UrdfLink& link : robot.links) {
      Pose pose;
      std::string at = link.name;
      for (auto up = above_.find(at); up != above_.end() && !up->second->moves; up = above_.find(at)) {
        pose = compose(up->second->joint.origin, pose);
        at = up->second->parent.link;
      }
      places_.emplace(link.name, Place{at, pose});
      if (!link.inertia) continue;
      Inertia& body = bodies_[at];
      body = combined(body, moved(*link.inertia, pose));
    }
  }

  void run() {
    bool carried = true;
    for (const UrdfJoint& joint : robot_.joints) {
      if (joint.moves && !has_mass(joint)) carried = check_carrier(joint) && carried;
    }
    if (carried) check_resistance();
    for (const UrdfLink& link : robot_.links) {
      if (link.inertia) check_inertia(link, bodies_.at(places_.at(link.name).body));
    }
  }

 private:
  struct Place {
    std::string body;  // its top link
    Pose pose;         // of the link in it
  };
  using Twist = Eigen::Matrix<double, 6, 1>;

  bool has_mass(const UrdfJoint& joint) const { return bodies_.contains(joint.child.link); }  // what it moves
  const std::string& parent_body(const UrdfJoint& joint) const { return places_.at(joint.parent.link).body; }
  const UrdfJoint* carrier(const UrdfJoint& joint) const {  // the joint that moves what this one stands on
    const auto found = above_.find(parent_body(joint));
    return found == above_.end() ? nullptr : found->second;
  }

  bool carries_mass(const UrdfJoint& joint) const {
    for (const UrdfJoint& other : robot_.joints) {
      if (!other.moves || !has_mass(other)) continue;
      for (const UrdfJoint* at = &other; at != nullptr; at = carrier(*at))
        if (at == &joint) return true;
    }
    return false;
  }

  bool check_carrier(const UrdfJoint& joint) {
    const UrdfLink& link = *links_.at(joint.child.link);
    const std::string what = "link " + shown_quoted(link.name) + " moves on joint " + shown_quoted(joint.name);
    if (!carries_mass(joint)) {
      document_.refuse(
          link.at, what + " but has no mass: it, or a link fixed to it, needs an <inertial>; or make the joint fixed",
          "no mass");
      return false;
    }
    if (!link.between_joints)
      document_.warn(link.at, what + " and has no mass: what hangs on it gives it all its inertia", "carrier");
    return true;
  }

  // The links without mass that hang together, with the joints above and below them. They can move without any mass
  // when rates of these joints add up to no motion of each link with mass below. Joints that have a rotor do not.
  void check_resistance() {
    for (const UrdfJoint& top : robot_.joints) {
      const UrdfJoint* const above = carrier(top);
      if (!top.moves || has_mass(top) || (above != nullptr && !has_mass(*above))) continue;
      std::vector<const UrdfJoint*> joints;
      for (const UrdfJoint& joint : robot_.joints) {
        if (joint.moves && reaches(joint, top)) joints.push_back(&joint);
      }
      const std::string in_a_line = "link " + shown_quoted(top.child.link) + " has no mass, and nothing resists when " +
                                    names(joints) + " move against each other";
      const std::string remedy =
          ": give one of them a rotor inertia (<dynamics armature=...>, in MJCF armature), or the link an <inertial>";
      const std::size_t at = links_.at(top.child.link)->at;
      if (!resists(joints, top, 1))
        document_.refuse(at, in_a_line + remedy, "no resistance");
      else if (!resists(joints, top, 0))
        document_.warn(at, in_a_line + ", at least where all are at 0" + remedy, "no resistance at 0");
    }
  }

  // Whether it stands on `top`, or is it, with no link with mass between.
  bool reaches(const UrdfJoint& joint, const UrdfJoint& top) const {
    const UrdfJoint* at = &joint;
    while (at != nullptr && at != &top) {
      at = carrier(*at);
      if (at != nullptr && has_mass(*at)) return false;
    }
    return at == &top;
  }

  static std::string names(const std::vector<const UrdfJoint*>& joints) {
    std::string text;
    for (std::size_t i = 0; i < joints.size() && i < 4; ++i)
      text += (i == 0 ? "joints " : i + 1 == joints.size() ? " and " : ", ") + shown_quoted(joints[i]->name);
    return text + (joints.size() > 4 ? " ..." : "");
  }

  // In a pose where no axes lie in one line by chance, or, with `share` 0, with all joints at 0.
  bool resists(const std::vector<const UrdfJoint*>& joints, const UrdfJoint& top, double share) const {
    std::map<const UrdfJoint*, Pose> poses;  // of what they move, in the frame that `top` stands on
    std::map<const UrdfJoint*, Eigen::Index> columns;
    std::vector<Twist> axes;
    std::vector<const UrdfJoint*> ends;
    // Parents come first in none of these lists: as many passes as the chain is long.
    while (poses.size() < joints.size()) {
      for (const UrdfJoint* const joint : joints) {
        const bool first = joint == &top;
        if (poses.contains(joint) || (!first && !poses.contains(carrier(*joint)))) continue;
        const Pose stand = first ? Pose{} : compose(poses.at(carrier(*joint)), places_.at(joint->parent.link).pose);
        const Pose origin = compose(stand, joint->joint.origin);
        const double position = share * std::sin(1.0 + 1.7 * static_cast<double>(poses.size()));
        poses[joint] = compose(origin, motion_of(joint->joint, position));
        columns[joint] = static_cast<Eigen::Index>(axes.size());
        axes.push_back(twist(joint->joint, origin));
        if (has_mass(*joint)) ends.push_back(joint);
      }
    }
    Eigen::MatrixXd moves = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(6 * ends.size() + joints.size()),
                                                  static_cast<Eigen::Index>(joints.size()));
    Eigen::Index row = 0;
    for (const UrdfJoint* const end : ends) {
      for (const UrdfJoint* at = end;; at = carrier(*at)) {
        moves.block<6, 1>(row, columns.at(at)) = axes[static_cast<std::size_t>(columns.at(at))];
        if (at == &top) break;
      }
      row += 6;
    }
    for (const UrdfJoint* const joint : joints)
      moves(row++, columns.at(joint)) = joint->joint.rotor_inertia_kg_m2 > 0 ? 1 : 0;
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> solved(moves);
    solved.setThreshold(1e-6);
    return solved.rank() == moves.cols();
  }

  static Twist twist(const Joint& joint, const Pose& origin) {
    const Vec3 axis = rotate(origin.orientation, joint.axis);
    const Vec3 arm = cross(origin.position_m, axis);
    Twist result;
    if (joint.type == JointType::prismatic)
      result << axis[0], axis[1], axis[2], 0, 0, 0;
    else
      result << arm[0], arm[1], arm[2], axis[0], axis[1], axis[2];
    return result;
  }

  // What other links of its body make good can be simulated, and so can what rounding to two digits has done.
  void check_inertia(const UrdfLink& link, const Inertia& body) {
    constexpr double rounded = 0.05;
    const std::string what = "the inertia of link " + shown_quoted(link.name) + " ";
    const Inertia& own = *link.inertia;
    const bool point = own.xx == 0 && own.yy == 0 && own.zz == 0 && own.xy == 0 && own.xz == 0 && own.yz == 0;
    const auto defect = inertia_defect(own);
    if (!defect || (point && !inertia_defect(body, rounded))) return;
    if (!inertia_defect(own, rounded))
      document_.warn(link.inertia_at, what + *defect + "; by so little that it is rounding", "inertia rounded");
    else if (!inertia_defect(body, rounded))
      document_.warn(link.inertia_at, what + *defect + "; with what is fixed to it, it makes a possible body",
                     "inertia of a part");
    else
      document_.refuse(link.inertia_at,
                       what + *defect + "; compute it anew from the shape, about the centre of mass, in kg m2");
  }

  UrdfDocument& document_;
  const UrdfDescription& robot_;
  std::map<std::string, const UrdfLink*> links_;
  std::map<std::string, const UrdfJoint*> above_;  // child link -> its joint
  std::map<std::string, Place> places_;            // by link
  std::map<std::string, Inertia> bodies_;          // with mass, by their top link
};

}  // namespace

void check_masses(UrdfDocument& document, const UrdfDescription& robot) { MassCheck(document, robot).run(); }

}  // namespace kadans
