#include "match_world.h"

namespace kadans::football {

Pose2 ground_pose(const Pose& base) noexcept {
  const Quat& q = base.orientation;
  const double yaw_rad = std::atan2(2 * (q[0] * q[3] + q[1] * q[2]), 1 - 2 * (q[2] * q[2] + q[3] * q[3]));
  return {base.position_m[0], base.position_m[1], yaw_rad};
}

SimulatedMatch::SimulatedMatch(const MatchConfig& match, std::uint64_t seed) try
    : simulation_(scenario_of(match, seed), match.file, seed) {
  for (std::size_t i = 0; i < simulation_.robots(); ++i) sent_.push_back(catalog(i).signals.find("supervisor.sent"));
} catch (const InputError& error) {
  throw told_of_match(error, match, seed);
}

bool SimulatedMatch::active(std::size_t number) const {
  return simulation_.status(number).safety.level < SafetyLevel::damp;
}

Pose2 SimulatedMatch::odometry(std::size_t number) const {
  const OdometryStatus& odometry = simulation_.status(number).odometry;
  return {odometry.path_x_m, odometry.path_y_m, odometry.path_heading_rad};
}

std::uint64_t SimulatedMatch::messages(std::size_t number) {
  return sent_.at(number) ? static_cast<std::uint64_t>(simulation_.signal(number, *sent_[number])) : 0;
}

}  // namespace kadans::football
