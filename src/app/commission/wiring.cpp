#include "wiring.h"

#include <algorithm>

#include "app/assembly/robot.h"
#include "config/scenario/based_on.h"
#include "signal/durable_file.h"
#include "signal/input_file.h"

namespace kadans {
namespace {

const DriveWiringFields& fields_of(const PlantType& type) {
  if (const DriveWiringFields* const fields = type.wiring()) return *fields;
  std::string known;
  for (const auto& one : plant_types()) {
    if (one->wiring() != nullptr) known += (known.empty() ? "" : ", ") + std::string(one->name());
  }
  refuse("--plant", "'" + std::string(type.name()) + "' has no wiring to find out; such types of plant have: " + known);
}

std::string json_of(const JsonValue& value) {
  if (value.kind == JsonValue::Kind::boolean) return value.boolean ? "true" : "false";
  return value.kind == JsonValue::Kind::string ? "\"" + value.text + "\"" : value.text;
}

}  // namespace

Wiring::Wiring(const PlantType& type, const RobotModel& model, std::string file)
    : type_(type),
      fields_(fields_of(type)),
      file_(std::move(file)),
      text_(read_input_file(file_)),
      merged_(parse_based_json(text_, file_).value) {
  const std::vector<std::string> names = model.drive_names();
  for (std::size_t i = 0; i < names.size(); ++i) drives_[model.joints[i].name] = {.name = names[i]};
  for (const Transmission& one : model.transmissions) {
    if (!one.coupled()) drives_[model.joints[one.joints()[0]].name].per_joint = one.drive_per_joint(0, 0);
    for (const std::string& drive : one.drives()) drives_.try_emplace(drive, Drive{.name = drive});
  }
}

const JsonValue* Wiring::find(const std::string& joint, std::string_view field) const {
  return find_at(merged_, path_of(joint, field));
}

std::vector<std::string> Wiring::path_of(const std::string& joint, std::string_view field) const {
  return {"plant", std::string(type_.name()), std::string(fields_.section), drive_name(joint), std::string(field)};
}

std::string Wiring::value(const std::string& joint, std::string_view field) const {
  const JsonValue* const found = find(joint, field);
  return found == nullptr ? "" : json_of(*found);
}

double Wiring::number(const std::string& joint, std::string_view field, double otherwise) const {
  const JsonValue* const found = find(joint, field);
  return found == nullptr || found->kind != JsonValue::Kind::number ? otherwise : found->number;
}

std::string Wiring::told(const std::string& joint) const {
  std::string text;
  for (const auto* group : {&fields_.both, &fields_.motor, &fields_.encoder}) {
    for (const std::string_view field : *group) {
      const std::string is = value(joint, field);
      if (!is.empty()) text += (text.empty() ? "" : ", ") + std::string(field) + " " + is;
    }
  }
  std::erase(text, '"');
  return text;
}

void Wiring::write() {
  if (edits_.empty()) return;
  const std::string edited = edit_json(text_, file_, edits_);
  const JsonValue merged = parse_based_json(edited, file_).value;
  for (const JsonEdit& edit : edits_) {
    const JsonValue* const is = find_at(merged, edit.path);
    if (is == nullptr || json_of(*is) != edit.value) refuse(file_, "'" + edit.path.back() + "' could not be written");
  }
  // Not what other programs do not take: the whole configuration is checked before the old one is gone.
  (void)read_robot_config_text(edited, file_, {});
  write_durably(file_, edited);
  text_ = read_input_file(file_);
  if (text_ != edited) refuse(file_, "somebody else writes it");
  merged_ = merged;
  edits_.clear();
}

}  // namespace kadans
