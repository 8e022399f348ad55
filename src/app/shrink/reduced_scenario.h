// A scenario and what can be taken away from it: its disturbances (pushes, faults, events, of each robot, and what
// befalls a bus), and the quantities that it sets or draws.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "config/json/json_value.h"
#include "scenario/disturb/quantities.h"

namespace kadans {

// One disturbance: an item of a list of the scenario.
struct Disturbance {
  std::string robot;  // "": the first
  std::string list;   // "pushes", "faults", "events", "bus"
  std::size_t index = 0;
  double impulse_Ns = 0;            // of a push
  double from_s = 0;                // of a fault
  std::optional<double> until_s{};  // of a fault that can end earlier; infinite without an end of its own
  bool is_push() const noexcept { return list == "pushes"; }
};

// A quantity with the value that it had in the failing run, and the entry from which it came: a pattern of `set`, of
// `randomise` or of the command line.
struct VariedQuantity {
  std::string robot;
  std::string name;
  double value = 0;
  std::size_t entry = 0;
};

// What is left of the scenario. The default is all of it.
struct Reduction {
  std::vector<bool> disturbances;
  std::vector<bool> quantities;
  std::vector<double> share;                   // of the impulse, of each disturbance that is a push
  std::vector<std::optional<double>> until_s;  // of each disturbance that is a fault
  int digits = 17;                             // of quantities
  bool seeded = true;                          // it keeps its seed
  double duration_s = 0;
};

class ReducedScenario {
 public:
  // `scenario` is the whole text, all that it is based on taken in.
  ReducedScenario(JsonValue scenario, std::string file);

  // Before it is reduced: with this seed and list in place of its own, as the whole run has them.
  void choose(std::optional<std::uint64_t> seed, const std::string& play);
  // What the run of the whole has set and drawn; its entries are those of the file, then those of the command line.
  void take_quantities(const std::vector<QuantityValue>& values, const std::vector<std::string>& set);
  // The check that stays alone; "": none does.
  void keep_check(const std::string& name) { check_ = name; }

  const std::vector<Disturbance>& disturbances() const noexcept { return disturbances_; }
  const std::vector<VariedQuantity>& quantities() const noexcept { return quantities_; }
  std::size_t entries() const noexcept { return entries_.size(); }
  double duration_s() const noexcept;
  std::string seed() const;  // "": none is written
  Reduction all() const;

  // With the one check that is kept, for a trial.
  std::string text(const Reduction& reduction) const;
  // As a file that a person reads, at this path and with this sentence. The second is based on the original file and
  // keeps all of its checks; nothing where such a file cannot say it.
  std::string text(const Reduction& reduction, const std::string& out, const std::string& doc) const;
  std::optional<std::string> based_text(const Reduction& reduction, const std::string& out,
                                        const std::string& doc) const;
  // "a push of 3.4 Ns on torso at 1 s", of those that are left.
  std::vector<std::string> told(const Reduction& reduction) const;

 private:
  struct Entry {
    std::string robot, pattern;
  };
  JsonValue reduced(const Reduction& reduction) const;
  void keep_one_check(JsonValue& tree) const;
  void describe(const std::string& out, const std::string& doc, JsonValue& tree) const;
  void find_disturbances(const JsonValue& robot, const std::string& name);
  void find_entries(const JsonValue& robot, const std::string& name);
  void reduce_robot(const std::string& name, const Reduction& reduction, JsonValue& robot) const;
  void reduce_item(std::size_t at, const Reduction& reduction, JsonValue& item) const;
  JsonValue set_of(const std::string& robot, const Reduction& reduction) const;
  std::string told(std::size_t at, const Reduction& reduction) const;

  JsonValue whole_;
  std::string file_, check_;
  std::vector<Disturbance> disturbances_;
  std::vector<Entry> entries_;
  std::vector<VariedQuantity> quantities_;
};

}  // namespace kadans
