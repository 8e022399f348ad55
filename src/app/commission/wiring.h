// What a robot's configuration says about each drive's wiring, and what commissioning writes there: the fields that the
// type of plant has for it (PlantType::wiring).
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "config/json/json_edit.h"
#include "config/json/json_value.h"
#include "kadans/model/robot_model.h"
#include "kadans/plant/plant_type.h"

namespace kadans {

// The configuration's text, and what it says together with the files that it is based on. Drives are named by their
// joints here, or by names of their own.
class Wiring {
 public:
  // Reads it. Throws InputError, also for a type of plant that has no wiring to find out.
  Wiring(const PlantType& type, const RobotModel& model, std::string file);

  const DriveWiringFields& fields() const noexcept { return fields_; }
  DriveConstants constants_of(const std::string& joint) const { return type_.constants_of(drive_name(joint)); }
  const std::string& drive_name(const std::string& joint) const {
    const auto found = drives_.find(joint);
    return found == drives_.end() ? joint : found->second.name;
  }
  // Of a gear between them.
  double drive_per_joint(const std::string& joint) const {
    const auto found = drives_.find(joint);
    return found == drives_.end() ? 1 : found->second.per_joint;
  }
  // A field of a drive as JSON; "" where the configuration does not give it.
  std::string value(const std::string& joint, std::string_view field) const;
  bool flag(const std::string& joint, std::string_view field) const { return value(joint, field) == "true"; }
  double number(const std::string& joint, std::string_view field, double otherwise) const;
  std::vector<std::string> path_of(const std::string& joint, std::string_view field) const;
  // "encoder 0, pwm 0, enable 20"
  std::string told(const std::string& joint) const;

  void set(const std::string& joint, std::string_view field, std::string value) {
    set(path_of(joint, field), std::move(value));
  }
  void set(std::vector<std::string> path, std::string value) { edits_.push_back({std::move(path), std::move(value)}); }
  // Writes what was set, durably, and reads it back. Throws InputError, and writes nothing, when the edited text is not
  // a valid configuration, or does not say what was set.
  void write();

 private:
  const JsonValue* find(const std::string& joint, std::string_view field) const;

  struct Drive {
    std::string name;
    double per_joint = 1;
  };

  const PlantType& type_;
  const DriveWiringFields& fields_;
  std::map<std::string, Drive> drives_;  // by joint
  std::string file_, text_;
  JsonValue merged_;
  std::vector<JsonEdit> edits_;
};

}  // namespace kadans
