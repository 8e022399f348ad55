// The parameters that were changed from outside: their history, and the way to save them into the robot's
// configuration.
#pragma once

#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "kadans/control/catalog.h"
#include "remote/order/order.h"

namespace kadans {

// The history of parameter changes from outside: the steps for undo, and the changes that are not yet saved in the
// configuration.
class ParameterHistory {
 public:
  static constexpr std::size_t steps_max = 1000;

  // Notes that a parameter was set.
  void note(const ParameterChange& change);
  // The newest step; nullptr when there is none. It stays until drop().
  const ParameterChange* newest() const noexcept { return steps_.empty() ? nullptr : &steps_.back(); }
  // Removes the newest step after it was undone.
  void drop();
  // Notes that these values are now saved in the configuration.
  void saved(const std::vector<ParameterChange>& changes);
  // The differences from the configuration, sorted by name.
  std::vector<ParameterChange> unsaved() const { return listed(unsaved_); }
  // The differences from the values at the start, saved or not, sorted by name.
  std::vector<ParameterChange> set() const { return listed(set_); }

 private:
  using Changes = std::map<std::string, ParameterChange>;
  static std::vector<ParameterChange> listed(const Changes& changes) {
    std::vector<ParameterChange> all;
    for (const auto& [name, change] : changes) all.push_back(change);
    return all;
  }
  void move_on(const ParameterChange& change);

  std::vector<ParameterChange> steps_;
  Changes unsaved_, set_;
};

// The text of the robot's configuration as the instance read it, and the way to save tuned parameters into the file.
// Parameters of control objects are written where they stand, those of behaviors under `behaviors`; everything else
// stays as it is. The file is whole at any time. When somebody else has changed the file meanwhile, nothing is written.

// A preset that sets a parameter to another value than the saved one. A behavior that chooses this preset gets the
// value of the preset.
struct PresetOverride {
  std::string name;  // of the parameter
  std::string preset;
  double value = 0;
};

// Values to be saved in a preset, too: those parameters of `values` that the preset sets.
struct PresetSave {
  std::string preset;  // "": none
  std::vector<ParameterChange> values{};
};

class ConfigurationText {
 public:
  // Call it before the loop. Without a file nothing can be saved. `robot` is the folder in behaviors/ whose behaviors
  // the file may name.
  explicit ConfigurationText(std::filesystem::path file, std::string robot = {});

  const std::filesystem::path& file() const noexcept { return file_; }
  // Call it on threads that serve clients. Returns the presets that override saved values. Throws InputError when the
  // file was changed since it was read, when a parameter has no place in it, or when the preset sets none of the
  // values; InputError or std::system_error when the file cannot be written. Then nothing is written.
  std::vector<PresetOverride> save(const std::vector<ParameterChange>& changes, const Catalog& catalog,
                                   const PresetSave& also = {});
  // A line for people: "2 parameters stand in robot.json; presets override kp (stiff 300)".
  std::string told(std::size_t saved, const std::vector<PresetOverride>& overridden) const;

 private:
  struct Edits;
  Edits edits_of(const std::vector<ParameterChange>& changes, const Catalog& catalog, const PresetSave& also) const;
  std::string behavior_of(const ParameterChange& change) const;

  std::filesystem::path file_;
  std::string robot_;
  std::map<std::pair<std::string, std::string>, double> presets_;  // values saved in presets, by preset and parameter
  std::mutex mutex_;
  std::string text_;
};

}  // namespace kadans
