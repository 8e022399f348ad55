// The seam between the control engine and what it controls: the robot's hardware, or a robot in a simulated world
// (world.h). Engines see only plants.
//
// read and write are called once a tick by the control thread: sample first, actuate a constant time later. Both are
// bounded and make no system call that may block. The rest is called off the tick, before the first and after the last.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kadans/signal/frames.h"
#include "kadans/signal/signal.h"

namespace kadans {

// A count of the messages between a plant and its drives: "lost", 3.
struct PlantCount {
  const char* name;
  std::uint64_t value;
};

// One of the counts that a plant keeps in a struct of its own. A list of them is what link_counts() tells, and what is
// recorded as the signals plant.bus.NAME.
template <typename Counts>
struct NamedCount {
  const char* name;
  std::uint32_t Counts::*value;
  const char* doc;
};
template <typename Names, typename Counts>
std::vector<PlantCount> counts_of(const Names& names, const Counts& counts) {
  std::vector<PlantCount> all;
  for (const auto& one : names) all.push_back({one.name, counts.*one.value});
  return all;
}
// The counts must outlive the table's use.
template <typename Names, typename Counts>
void declare_counts(SignalTable& table, const Names& names, const Counts& counts) {
  for (const auto& one : names) table.add({std::string("plant.bus.") + one.name, "1", one.doc}, &(counts.*one.value));
}

class Plant {
 public:
  virtual ~Plant() = default;
  Plant() = default;
  Plant(const Plant&) = delete;
  Plant& operator=(const Plant&) = delete;

  // Before the loop: declares the signals that it has beside the sensors.
  virtual void declare_signals(SignalTable& table) const { (void)table; }
  // Before the loop: finds the drives and waits until they can be driven. Throws InputError that says what is in the
  // way, and what to do about it. It asks give_up() repeatedly, and after each signal of the system; when that says
  // true, open returns false.
  virtual bool open(bool (*give_up)() noexcept = nullptr) {
    (void)give_up;
    return true;
  }
  // After the loop: nobody drives it any more. Its safe state is what it does by itself from now on.
  virtual void close() noexcept {}
  // After the loop.
  virtual std::vector<PlantCount> link_counts() const { return {}; }

  // Control thread. Fills the frame with the sensors as they are now, counts included.
  virtual void read(SensorFrame& sensors) noexcept = 0;
  // Control thread. The actuation holds until the next write.
  virtual void write(const ActuationFrame& actuation) noexcept = 0;
};

}  // namespace kadans
