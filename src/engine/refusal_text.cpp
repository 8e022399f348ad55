#include "refusal_text.h"

#include <cstdio>

#include "signal/number_text.h"

namespace kadans {
namespace {

// What the command addresses; "" when there is no such thing.
std::string target(const Refusal& refusal, const Catalog& catalog) {
  switch (refusal.kind) {
    case CommandKind::set_parameter:
      return refusal.index < catalog.parameters.size() ? catalog.parameters.info(refusal.index).name : "";
    case CommandKind::set_point:
    case CommandKind::cancel_motion:
    case CommandKind::trapezoid:
    case CommandKind::via_point:
      return refusal.index < catalog.setpoints.size() ? catalog.setpoints[refusal.index].name : "";
    case CommandKind::switch_set:
      return refusal.index < catalog.sets.size() ? "control set " + catalog.sets[refusal.index].name : "";
    case CommandKind::order_drive:
      return refusal.index < catalog.model->joints.size() ? "drive of " + catalog.model->joints[refusal.index].name
                                                          : "";
    default:
      return "";
  }
}

std::string out_of_range(const Refusal& refusal, const Catalog& catalog) {
  const auto text = [&](const auto& of) { return outside_range(of.name, refusal.value, of.min, of.max, of.unit); };
  return refusal.kind == CommandKind::set_parameter ? text(catalog.parameters.info(refusal.index))
                                                    : text(catalog.setpoints[refusal.index]);
}

std::string seconds_text(double seconds) { return printed("%.3f s", seconds); }

}  // namespace

const char* refusal_word(RefusalReason reason) noexcept {
  switch (reason) {
    case RefusalReason::none:
      return "none";
    case RefusalReason::malformed:
      return "malformed";
    case RefusalReason::unknown:
      return "unknown";
    case RefusalReason::out_of_range:
      return "out_of_range";
    case RefusalReason::motion:
      return "motion";
    case RefusalReason::too_old:
      return "too_old";
    case RefusalReason::robot_held:
      return "robot_held";
    case RefusalReason::joint_held:
      return "joint_held";
    case RefusalReason::armed_full:
      return "armed_full";
    case RefusalReason::set_dwells:
      return "set_dwells";
  }
  return "none";
}

std::string refusal_text(const Refusal& refusal, const Catalog& catalog) {
  const std::string name = target(refusal, catalog);
  const std::string of = name.empty() ? "" : name + ": ";
  switch (refusal.reason) {
    case RefusalReason::none:
      return "";
    case RefusalReason::malformed:
      return "a command of no known kind";
    case RefusalReason::unknown:
      if (refusal.kind == CommandKind::reset_odometry) return "the robot has no feet, so it has no odometry";
      return "number " + std::to_string(refusal.index) + " is unknown";
    case RefusalReason::out_of_range:
      return out_of_range(refusal, catalog);
    case RefusalReason::motion:
      return of + "it cannot be moved with this duration and these limits";
    case RefusalReason::too_old:
      return "the commands were too old";
    case RefusalReason::robot_held:  // orders to drives are refused under the emergency stop alone
      return of +
             (refusal.kind == CommandKind::order_drive ? "the emergency stop holds the robot" : "the robot is held");
    case RefusalReason::joint_held:
      return of + "joint " +
             (refusal.joint < catalog.model->joints.size() ? catalog.model->joints[refusal.joint].name : "?") +
             " is held";
    case RefusalReason::armed_full:
      return "as many transactions as can wait are armed already";
    case RefusalReason::set_dwells:
      return of + (refusal.joint < catalog.sets.size() ? catalog.sets[refusal.joint].name : "?") +
             " cannot be switched for another " + seconds_text(refusal.value) + " (switch_dwell_s)";
  }
  return "";
}

void copy_refusal_text(const Refusal& refusal, const Catalog& catalog, std::span<char> text) {
  std::snprintf(text.data(), text.size(), "%s", refusal_text(refusal, catalog).c_str());
}

}  // namespace kadans
