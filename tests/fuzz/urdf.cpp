// Descriptions of robots: a URDF is a tree of links with numbers in it, or is refused with the places of all mistakes;
// an MJCF becomes one.
#include "kadans/model/urdf.h"

#include <cmath>

#include "fuzz_input.h"
#include "kadans/model/mjcf.h"
namespace {

using namespace kadans;
using fuzz::require;

void require_finite(std::initializer_list<double> values) {
  for (const double value : values) require(std::isfinite(value), "a number is finite");
}

void require_finite(const Pose& pose) {
  for (const double value : pose.position_m) require_finite({value});
  double length = 0;
  for (const double value : pose.orientation) length += value * value;
  require(std::abs(length - 1) < 1e-6, "a rotation is a rotation");
}

void require_right(const RobotModel& model) {
  require(model.links.size() == model.joints.size() + 1 && model.joints.size() <= max_joints, "a joint moves a link");
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    const Joint& joint = model.joints[i];
    require(joint.parent <= i, "parents come first");
    require_finite(joint.origin);
    require(joint.lower_rad <= joint.upper_rad, "a joint has a range");
    require_finite({joint.effort_max_Nm, joint.velocity_max_rad_s, joint.damping_Nms_per_rad, joint.friction_Nm,
                    joint.rotor_inertia_kg_m2});
    require(joint.effort_max_Nm >= 0 && joint.velocity_max_rad_s >= 0, "limits are not negative");
    double length = 0;
    for (const double value : joint.axis) length += value * value;
    require(std::abs(length - 1) < 1e-6, "an axis has length 1");
    require(model.find_joint(joint.name) == i, "a name is one joint's");
    if (joint.mimic)
      require(joint.mimic->joint < model.joints.size() && joint.mimic->joint != i, "a mimic follows another");
  }
  for (const Link& link : model.links) {
    const Inertia& of = link.inertia;
    require_finite({of.mass_kg, of.xx, of.yy, of.zz, of.xy, of.xz, of.yz, of.com_m[0], of.com_m[1], of.com_m[2]});
    require(of.mass_kg >= 0, "no mass is negative");
    for (const auto* shapes : {&link.collisions, &link.visuals}) {
      for (const Geometry& shape : *shapes) require_finite(shape.pose);
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  for (const MeshHull& hull : {MeshHull(), MeshHull([](const std::string&) { return std::vector<Vec3>{{0, 0, 1}}; })}) {
    try {
      std::vector<InputProblem> warnings;
      const RobotModel model = read_urdf_text(text, "it.urdf", {.mesh_hull = hull}, &warnings);
      require_right(model);
      for (std::size_t i = 0; i < warnings.size(); ++i)
        require(warnings[i].line > 0 || i == 25, "a warning has a place, but for the number of those left out");
      const std::vector<UrdfFrame> frames = urdf_frames(model, text);
      require(frames.size() >= model.joints.size(), "each joint has a frame");
      for (const UrdfFrame& frame : frames) require_finite(frame.origin);
    } catch (const InputError& error) {
      fuzz::require_told(error, "it.urdf", size > 0 ? fuzz::Placed::line : fuzz::Placed::nowhere);
    }
  }
  try {
    if (is_mjcf(text)) require_right(read_urdf_text(read_mjcf_text(text, "it.xml").urdf, "it.xml"));
  } catch (const InputError& error) {
    fuzz::require_told(error, "it.xml", fuzz::Placed::nowhere);
  }
  return 0;
}
