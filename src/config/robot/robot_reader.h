// Reads a robot's configuration, part by part. When there is a model, the settings of its joints are filled. Without a
// model (the URDF is wrong, or the fields are only described), the fields of those settings are still checked.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "robot_config.h"

namespace kadans {

class RobotReader {
 public:
  RobotReader(RobotConfig& config, Problems& problems, std::span<const std::string> object_types)
      : config_(config), problems_(problems), object_types_(object_types) {}

  void read(Fields& f);

 private:
  void load_model(Fields& f);

  // robot_plant.cpp
  void plant(Fields& f);
  void transmission(Fields& f);
  void drive(Fields& entry);
  void default_drives(const Transmission& transmission);
  void leave_to_joints(const Transmission& transmission);
  void surface(Fields& entry);
  void collision(Fields& entry);
  void imu(Fields& f);
  void foot(Fields& f);
  void name_feet(Fields& f);
  void start(Fields& f);
  void estimate(Fields& f);
  void sensor(Fields& entry);
  void safety(Fields& f);
  void reaction(Fields& entry);
  void limits(Fields& entry);
  bool within_urdf(const Fields& entry, const JointLimits& limits, const Joint& joint);

  // robot_config.cpp
  void joystick(Fields& f);
  void behavior(Fields& entry);

  // robot_control.cpp
  void control(Fields& f);
  void initial_sets(Fields& f);
  void drive_objects(Fields& f);
  void unheld(Fields& f);
  void object(Fields& f);
  void object_joints(const std::vector<PlacedName>& patterns, ObjectConfig& object);
  void control_set(Fields& entry);
  bool add_to_set(const PlacedName& object, Composition composition, ControlSetInfo& set);
  void claim_joints(std::size_t object, bool sets, TextPlace place, std::vector<std::size_t>& owner);
  void pose(Fields& entry);
  void pose_value(const Fields& entry, const NumberEntry& value, PoseInfo& pose);

  // The joints that a pattern chooses. Adds a problem at `place` when it chooses none.
  std::vector<std::size_t> joints(std::string_view pattern, TextPlace place) {
    return chosen(pattern, place, "joint", joint_names_);
  }
  std::vector<std::size_t> chosen(std::string_view pattern, TextPlace place, const char* what,
                                  const std::vector<std::string>& names);
  // Runs `read` on the settings of each joint that the entry's key chooses. Without a model, it runs on a scratch copy.
  template <typename Settings, typename Read>
  void each_joint(Fields& entry, std::vector<Settings>& settings, Read&& read) {
    each(have_model_ ? joints(entry.key(), entry.key_place()) : std::vector<std::size_t>(), settings, read);
  }
  template <typename Settings, typename Read>
  static void each(const std::vector<std::size_t>& chosen, std::vector<Settings>& settings, Read&& read) {
    Settings scratch{};
    if (chosen.empty()) read(scratch);
    for (const std::size_t i : chosen) read(settings[i]);
  }

  RobotConfig& config_;
  Problems& problems_;
  std::span<const std::string> object_types_;
  bool have_model_ = false;
  std::size_t of_urdf_ = 0;  // the model's first transmissions, which the URDF brought
  std::vector<std::string> joint_names_, drive_names_;
};

}  // namespace kadans
