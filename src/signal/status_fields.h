// The fields of the snapshot that have a name, in one table. Records and checks take their signals from it, behaviors
// their `s`, the reference its text, and tests of behaviors the fields that they may set.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "kadans/signal/seen_info.h"
#include "kadans/signal/sensor_channel.h"
#include "kadans/signal/signal.h"
#include "kadans/signal/status.h"

namespace kadans {

// A reference to a field of one of a few types, which reads and writes it as a number.
class StatusReference {
  using At = std::variant<double*, bool*, std::uint8_t*, std::uint32_t*, FaultCode*, std::uint64_t*>;

 public:
  template <typename T>
  requires(std::constructible_from<At, T*>) StatusReference(T& at)
  noexcept : at_(&at) {}  // NOLINT(google-explicit-constructor): a field's own type
  template <typename Choice>
  requires(std::is_enum_v<Choice> && sizeof(Choice) == 1) StatusReference(Choice& at)
  noexcept  // NOLINT(google-explicit-constructor)
      : at_(reinterpret_cast<std::uint8_t*>(&at)) {}

  double value() const noexcept;
  void set(double value) const noexcept;  // within the field's range
  // Declares a signal that gathers it. For numbers, flags, choices and counts only.
  void declare(SignalTable& table, Signal signal) const;

 private:
  At at_;
};

struct StatusField {
  enum class Part : std::uint8_t {
    root,
    joint,
    base,
    rate,
    foot,
    support,
    odometry,
    safety,
    joystick,
    ball,
    seen,
    sensors
  };
  enum class Type : std::uint8_t { number, flag, choice };

  Part part;
  Type type;
  const char* name;  // in `s`: "roll_rad"
  const char* unit;
  const char* doc;                                               // without its unit and a full stop
  StatusReference (*at)(Snapshot& snapshot, std::size_t index);  // nullptr: time_s, which each reader has itself
  const char* signal = nullptr;                                  // its name in records, when that differs from `s`
  // Of a choice: the name of each value; how many there are.
  const char* (*choice)(std::size_t value) = nullptr;
  std::size_t choices = 0;
  std::size_t only = any_index;  // the one thing of its part that has it

  static constexpr std::size_t any_index = static_cast<std::size_t>(-1);
  bool is_of(Part other, std::size_t index) const noexcept {
    return part == other && (only == any_index || only == index);
  }

  double value(const Snapshot& snapshot, std::size_t index) const noexcept {
    return at(const_cast<Snapshot&>(snapshot), index).value();  // which is not written
  }
};

// Part by part, in the order in which records have them.
std::span<const StatusField> status_fields() noexcept;
// With the fields of the sensors and of the entries of the world model that a robot's configuration names; these must
// outlive them.
std::vector<StatusField> status_fields(const std::vector<SensorChannel>& sensors, const std::vector<SeenInfo>& seen);

// Declares the fields of a part as signals "topic.name". The snapshot must outlive the table's use. Throws
// std::invalid_argument on a name that is taken.
void declare_part(SignalTable& table, StatusField::Part part, const std::string& topic, const Snapshot& snapshot,
                  std::size_t index = 0);

}  // namespace kadans
