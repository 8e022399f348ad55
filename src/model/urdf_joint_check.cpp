#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <set>

#include "kadans/signal/capacity.h"
#include "kadans/signal/nearest_name.h"
#include "urdf_checks.h"
#include "urdf_value.h"

namespace kadans {
namespace {

using tinyxml2::XMLElement;

void check_type(UrdfDocument& document, const UrdfJoint& joint) {
  const std::vector<std::string> known{"revolute", "continuous", "prismatic", "fixed"};
  if (joint.type.empty() || std::find(known.begin(), known.end(), joint.type) != known.end()) return;
  if (joint.type == "floating" || joint.type == "planar") {
    document.refuse_value(*joint.element, "type",
                          "joint " + quoted(joint.name) + " is " + joint.type +
                              ", which is not supported: the root link floats by itself; use "
                              "revolute, continuous, prismatic or fixed");
    return;
  }
  const std::string hint = did_you_mean(joint.type, known);
  document.refuse_value(*joint.element, "type",
                        "unknown joint type " + quoted(joint.type) +
                            (hint.empty() ? "; known are: revolute, continuous, prismatic, fixed" : hint));
}

void check_limit(UrdfDocument& document, const UrdfJoint& joint) {
  const bool bounded = joint.type == "revolute" || joint.type == "prismatic";
  const XMLElement* limit = joint.element->FirstChildElement("limit");
  if (bounded && limit == nullptr) {
    document.refuse(*joint.element, joint.type + " joint " + quoted(joint.name) + " has no <limit>" +
                                        (joint.type == "revolute" ? "; without limits it is 'continuous'" : ""));
  }
  if (!bounded || limit == nullptr) return;
  const char *lower = limit->Attribute("lower"), *upper = limit->Attribute("upper");
  if (lower == nullptr && upper == nullptr) {
    document.refuse(*limit, "joint " + quoted(joint.name) + " has neither 'lower' nor 'upper' in its <limit>");
    return;
  }
  const auto low = read_number(lower == nullptr ? "0" : lower), high = read_number(upper == nullptr ? "0" : upper);
  if (low && high && *low > *high) {
    document.refuse(*limit, "joint " + quoted(joint.name) + " has its lower limit " + (lower == nullptr ? "0" : lower) +
                                " above its upper " + (upper == nullptr ? "0" : upper));
  }
}

void check_axis(UrdfDocument& document, const UrdfJoint& joint) {
  constexpr double tolerance = 1e-3;
  const XMLElement* axis = joint.element->FirstChildElement("axis");
  if (!joint.moves() || axis == nullptr) return;
  const auto v = read_vector(attribute_or_empty(*axis, "xyz"));
  if (!v) return;
  const double norm = std::hypot((*v)[0], (*v)[1], (*v)[2]);
  if (std::abs(norm - 1) <= tolerance) return;
  const std::string what = "the axis of joint " + quoted(joint.name);
  if (!(norm > 0)) return document.refuse_value(*axis, "xyz", what + " is zero: it has no direction");
  std::array<char, 160> text{};
  std::snprintf(text.data(), text.size(), " has the length %.6g instead of 1, did you mean '%.6g %.6g %.6g'?", norm,
                (*v)[0] / norm, (*v)[1] / norm, (*v)[2] / norm);
  document.refuse_value(*axis, "xyz", what + text.data());
}

void check_dynamics(UrdfDocument& document, const UrdfJoint& joint) {
  const XMLElement* dynamics = joint.element->FirstChildElement("dynamics");
  if (dynamics == nullptr || dynamics->Attribute("damping") != nullptr || dynamics->Attribute("friction") != nullptr)
    return;
  document.refuse(*dynamics, "<dynamics> has neither 'damping' nor 'friction'");
}

// From the joint along its mimics: their names when they come back to it, else "".
std::string ring(const UrdfOutline& outline, const UrdfJoint& start) {
  std::string path = shown(start.name);
  const UrdfJoint* at = &start;
  for (std::size_t steps = 0; steps <= outline.joints.size(); ++steps) {
    at = at->mimic == nullptr ? nullptr : outline.find_joint(attribute_or_empty(*at->mimic, "joint"));
    if (at == nullptr) return "";
    path += " -> " + shown(at->name);
    if (at == &start) return path;
  }
  return "";
}

}  // namespace

void check_joints(UrdfDocument& document, const UrdfOutline& outline) {
  std::size_t moving = 0;
  for (const UrdfJoint& joint : outline.joints) {
    check_type(document, joint);
    check_limit(document, joint);
    check_axis(document, joint);
    check_dynamics(document, joint);
    if (joint.moves() && ++moving == max_joints + 1) {
      document.refuse(*joint.element, "more than " + std::to_string(max_joints) + " moving joints");
      document.throw_if_refused();  // what follows is bounded by max_joints
    }
  }
}

void check_mimics(UrdfDocument& document, const UrdfOutline& outline) {
  std::set<std::string> in_rings;
  for (const UrdfJoint& joint : outline.joints) {
    if (joint.mimic == nullptr) continue;
    const XMLElement& mimic = *joint.mimic;
    const std::string wanted = attribute_or_empty(mimic, "joint");
    if (wanted.empty()) continue;  // the grammar has said so
    const UrdfJoint* leader = outline.find_joint(wanted);
    std::string what = "joint ";
    what.append(quoted(joint.name)).append(" mimics joint ").append(quoted(wanted));
    if (leader == nullptr) {
      what.append(", which does not exist").append(did_you_mean(wanted, outline.joint_names()));
      document.refuse_value(mimic, "joint", what);
    } else if (!joint.moves()) {
      document.refuse(mimic, "joint " + quoted(joint.name) + " is fixed and cannot mimic another");
    } else if (!leader->moves()) {
      document.refuse_value(mimic, "joint", what.append(", which is fixed"));
    } else if (const std::string path = ring(outline, joint); !path.empty() && !in_rings.contains(joint.name)) {
      document.refuse_value(mimic, "joint", "joints mimic each other in a ring: " + path);
      for (const UrdfJoint* at = &joint; at != nullptr && at->mimic != nullptr && in_rings.insert(at->name).second;) {
        at = outline.find_joint(attribute_or_empty(*at->mimic, "joint"));
      }
    }
  }
}

}  // namespace kadans
