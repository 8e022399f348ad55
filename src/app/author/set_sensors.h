// What a test sets of the things that a behavior sees: it replaces numbers of the snapshot.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "estimate/leg_chain.h"
#include "kadans/control/catalog.h"
#include "signal/sine_cosine.h"
#include "signal/status_fields.h"

namespace kadans {

class SetSensors {
 public:
  explicit SetSensors(const Catalog& catalog)
      : joints_(catalog.model->joint_names()), fields_(status_fields(catalog.sensors, catalog.seen)) {
    for (const FootInfo& sole : catalog.feet) feet_.push_back(sole.name);
    for (const SeenInfo& entry : catalog.seen) seen_.push_back(entry.name);
  }

  // False: there is no such number, or it is not finite.
  bool set(const std::string& name, double value) {
    if (!std::isfinite(value)) return false;
    Snapshot probe;
    if (!put(probe, name, value)) return false;
    values_[name] = value;
    return true;
  }
  void change(Snapshot& snapshot) const noexcept {
    for (const auto& [name, value] : values_) (void)put(snapshot, name, value);
    if (!values_.contains("base.posture") && (values_.contains("base.roll_rad") || values_.contains("base.pitch_rad")))
      lie_as_leant(snapshot.status.base);
  }

 private:
  bool put(Snapshot& snapshot, const std::string& name, double value) const {
    for (const StatusField& field : fields_) {
      const bool chosen = field.type == StatusField::Type::choice;
      if (field.at == nullptr || (chosen && !(value >= 0 && value < static_cast<double>(field.choices)))) continue;
      const std::optional<std::size_t> index = index_in(name, field);
      if (!index) continue;
      field.at(snapshot, *index).set(value);
      return true;
    }
    return false;
  }

  // A test that sets the angles expects the posture that belongs to them.
  static void lie_as_leant(BaseStatus& base) noexcept {
    const auto [sin_roll, cos_roll] = sine_cosine(base.roll_rad);
    const auto [sin_pitch, cos_pitch] = sine_cosine(base.pitch_rad);
    base.posture = posture_of({-sin_pitch, cos_pitch * sin_roll, cos_pitch * cos_roll});
  }

  // The index of the joint or foot if `name` is this field of it: "joints.l_knee.position_rad", "feet.left.contact"; 0
  // for "base.roll_rad".
  std::optional<std::size_t> index_in(const std::string& name, const StatusField& field) const {
    using enum StatusField::Part;
    const auto is = [&](const std::string& path) { return name == path + "." + field.name; };
    const auto only = [&](const char* path) { return is(path) ? std::optional<std::size_t>(0) : std::nullopt; };
    const auto one_of = [&](const char* part, const std::vector<std::string>& names) -> std::optional<std::size_t> {
      for (std::size_t i = 0; i < names.size(); ++i) {
        if (is(std::string(part) + "." + names[i])) return i;
      }
      return std::nullopt;
    };
    constexpr std::pair<StatusField::Part, const char*> of_the_robot[] = {
        {base, "base"},       {rate, "base.angular_velocity_rad_s"},
        {support, "support"}, {odometry, "odometry"},
        {safety, "safety"},   {joystick, "joystick"},
        {sensors, "sensors"}};
    for (const auto& [part, path] : of_the_robot) {
      if (field.part == part) return only(path);
    }
    if (field.part == joint) return one_of("joints", joints_);
    if (field.part == foot) return one_of("feet", feet_);
    // An entry of the world model with that name takes its place.
    if (field.part == ball && std::ranges::find(seen_, "ball") == seen_.end()) return only("seen.ball");
    if (field.part == seen) {
      const std::optional<std::size_t> entry = one_of("seen", seen_);
      if (entry && field.is_of(seen, *entry)) return entry;
    }
    return std::nullopt;
  }

  std::vector<std::string> joints_, feet_, seen_;
  std::vector<StatusField> fields_;
  std::map<std::string, double> values_;
};

}  // namespace kadans
