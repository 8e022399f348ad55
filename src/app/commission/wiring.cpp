#include "wiring.h"

#include <algorithm>
#include <array>
#include <numbers>

#include "app/assembly.h"
#include "config/scenario/based_on.h"
#include "signal/durable_file.h"
#include "signal/input_file.h"

namespace kadans {
namespace {

const std::array<WiringFields, 2>& known_wirings() {
  static const std::array<WiringFields, 2> known{{{"hm2-eth",
                                                   "drives",
                                                   {"board"},
                                                   {"pwm", "output", "enable", "brake", "fault"},
                                                   {"encoder", "low", "high", "home_switch"},
                                                   "pwm_reversed",
                                                   "reversed",
                                                   "home",
                                                   "home_rad",
                                                   0,
                                                   1,
                                                   0},
                                                  {"dynamixel",
                                                   "servos",
                                                   {"port", "id", "model"},
                                                   {},
                                                   {},
                                                   "reversed",
                                                   "reversed",
                                                   "",
                                                   "zero_pulse",
                                                   2048,
                                                   2 * std::numbers::pi / 4096,
                                                   4096}}};
  return known;
}

const JsonValue* at_path(const JsonValue& root, const std::vector<std::string>& path) {
  const JsonValue* here = &root;
  for (const std::string& key : path) {
    const JsonMember* const found = here->find(key);
    if (found == nullptr) return nullptr;
    here = &found->value;
  }
  return here;
}

std::string json_of(const JsonValue& value) {
  if (value.kind == JsonValue::Kind::boolean) return value.boolean ? "true" : "false";
  return value.kind == JsonValue::Kind::string ? "\"" + value.text + "\"" : value.text;
}

}  // namespace

const WiringFields& wiring_fields(const std::string& type, const std::string& robot) {
  const auto found = std::ranges::find(known_wirings(), type, &WiringFields::type);
  if (found != known_wirings().end()) return *found;
  throw InputError({.file = "--plant",
                    .message = "'" + type + "' has no wiring to find out; " + robot +
                               " is commissioned through hm2-eth or dynamixel"});
}

Wiring::Wiring(const WiringFields& fields, std::string file)
    : fields_(fields),
      file_(std::move(file)),
      text_(read_input_file(file_)),
      merged_(parse_based_json(text_, file_).value) {}

std::string Wiring::value(const std::string& drive, std::string_view field) const {
  const JsonValue* const found =
      at_path(merged_, {"plant", std::string(fields_.type), std::string(fields_.section), drive, std::string(field)});
  return found == nullptr ? "" : json_of(*found);
}

double Wiring::number(const std::string& drive, std::string_view field, double otherwise) const {
  const JsonValue* const found =
      at_path(merged_, {"plant", std::string(fields_.type), std::string(fields_.section), drive, std::string(field)});
  return found == nullptr || found->kind != JsonValue::Kind::number ? otherwise : found->number;
}

std::string Wiring::told(const std::string& drive) const {
  std::string text;
  for (const auto* group : {&fields_.both, &fields_.motor, &fields_.encoder}) {
    for (const std::string_view field : *group) {
      const std::string is = value(drive, field);
      if (!is.empty()) text += (text.empty() ? "" : ", ") + std::string(field) + " " + is;
    }
  }
  std::erase(text, '"');
  return text;
}

void Wiring::set(const std::string& drive, std::string_view field, std::string value) {
  set({"plant", std::string(fields_.type), std::string(fields_.section), drive, std::string(field)}, std::move(value));
}

void Wiring::write() {
  if (edits_.empty()) return;
  const std::string edited = edit_json(text_, file_, edits_);
  const JsonValue merged = parse_based_json(edited, file_).value;
  for (const JsonEdit& edit : edits_) {
    const JsonValue* const is = at_path(merged, edit.path);
    if (is == nullptr || json_of(*is) != edit.value)
      throw InputError({.file = file_, .message = "'" + edit.path.back() + "' could not be written"});
  }
  // Not what other programs do not take: the whole configuration is checked before the old one is gone.
  (void)read_robot_config_text(edited, file_, {});
  write_durably(file_, edited);
  text_ = read_input_file(file_);
  if (text_ != edited) throw InputError({.file = file_, .message = "somebody else writes it"});
  merged_ = merged;
  edits_.clear();
}

}  // namespace kadans
