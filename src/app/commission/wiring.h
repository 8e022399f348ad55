// What a robot's configuration says about each drive's wiring, and what commissioning writes there: the fields that a
// type of plant has for it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "config/json/json_edit.h"
#include "config/json/json_value.h"

namespace kadans {

// Names of fields under plant.TYPE.SECTION.DRIVE.
struct WiringFields {
  std::string_view type, section;
  std::vector<std::string_view> both;     // of what motor and encoder share
  std::vector<std::string_view> motor;    // where the motor is wired to
  std::vector<std::string_view> encoder;  // where the encoder is; none: motor and encoder are one device
  std::string_view motor_reversed, encoder_reversed;
  std::string_view home;           // of a drive that looks for its zero; "": none does
  std::string_view zero;           // where the zero is ...
  double zero_default, zero_unit;  // ... of so many radians; of pulses of a turn it wraps
  double zero_turn;                // 0: it does not
};
// Throws InputError for a type of plant that has no wiring to find out.
const WiringFields& wiring_fields(const std::string& type, const std::string& robot);

// The configuration's text, and what it says together with the files that it is based on.
class Wiring {
 public:
  Wiring(const WiringFields& fields, std::string file);  // reads it; throws InputError

  const WiringFields& fields() const noexcept { return fields_; }
  const std::string& file() const noexcept { return file_; }
  // A field of a drive as JSON; "" where the configuration does not give it.
  std::string value(const std::string& drive, std::string_view field) const;
  bool flag(const std::string& drive, std::string_view field) const { return value(drive, field) == "true"; }
  double number(const std::string& drive, std::string_view field, double otherwise) const;
  // "encoder 0, pwm 0, enable 20"
  std::string told(const std::string& drive) const;

  void set(const std::string& drive, std::string_view field, std::string value);
  void set(std::vector<std::string> path, std::string value) { edits_.push_back({std::move(path), std::move(value)}); }
  // Writes what was set, durably, and reads it back. Throws InputError, and writes nothing, when the edited text is not
  // a valid configuration, or does not say what was set.
  void write();

 private:
  const WiringFields& fields_;
  std::string file_, text_;
  JsonValue merged_;
  std::vector<JsonEdit> edits_;
};

}  // namespace kadans
