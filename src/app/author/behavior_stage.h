// Robots of their own for tests of behaviors, on the ideal plant where no other is asked for.
#pragma once

#include <filesystem>

#include "script/test/behavior_test.h"

namespace kadans {

// The configuration of the robot for which a behavior is: config/<name of its folder>/robot.json, or else the only
// robot of the project. Throws InputError when there is no robot, or more than one.
std::filesystem::path robot_of_behavior(const std::filesystem::path& behavior);
// The only robot of the project around this folder. Throws InputError that lists the robots when there is not exactly
// one.
std::filesystem::path only_robot(const std::filesystem::path& folder, const std::string& named = "--robot FILE");

class RobotStages final : public TestStages {
 public:
  explicit RobotStages(std::filesystem::path robot) : robot_(std::move(robot)) {}  // "": by the behavior's folder
  std::unique_ptr<TestStage> make(const std::filesystem::path& behavior, const Options& options) override;

 private:
  std::filesystem::path robot_of(const std::filesystem::path& behavior, const Options& options) const;

  std::filesystem::path robot_;
};

}  // namespace kadans
