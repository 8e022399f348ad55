// The text of the robot's configuration as the instance read it, and the way back into the file: parameters that were
// tuned while it ran are written where they stand, those of behaviors under `behaviors`, everything else stays as it
// is. The file is there whole at any time, and nothing that somebody wrote meanwhile is lost: then nothing is written.
#pragma once

#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "kadans/control/catalog.h"
#include "kadans/remote/order.h"

namespace kadans {

// A preset that gives a parameter another value than the one that was saved: a behavior that chooses it has that.
struct PresetOverride {
  std::string name;  // of the parameter
  std::string preset;
  double value = 0;
};

// What goes into a preset besides: those of the values that it sets.
struct PresetSave {
  std::string preset;  // "": none
  std::vector<ParameterChange> values{};
};

class ConfigurationText {
 public:
  // Before the loop. Without a file nothing can be saved. `robot`: the folder in behaviors/ whose behaviors it may
  // name.
  explicit ConfigurationText(std::filesystem::path file, std::string robot = {});

  const std::filesystem::path& file() const noexcept { return file_; }
  // Threads that serve clients. Gives the presets that override what was saved. Throws InputError when the file is no
  // longer what was read, a parameter has no place in it, or the preset sets none of its values; std::system_error when
  // it cannot be written. Nothing is written then.
  std::vector<PresetOverride> save(const std::vector<ParameterChange>& changes, const Catalog& catalog,
                                   const PresetSave& also = {});
  // "2 parameters stand in robot.json; presets override kp (stiff 300)": for a line in which that is told.
  std::string told(std::size_t saved, const std::vector<PresetOverride>& overridden) const;

 private:
  struct Edits;
  Edits edits_of(const std::vector<ParameterChange>& changes, const Catalog& catalog, const PresetSave& also) const;
  std::string behavior_of(const ParameterChange& change) const;

  std::filesystem::path file_;
  std::string robot_;
  std::map<std::pair<std::string, std::string>, double> presets_;  // what was saved in them, by preset and parameter
  std::mutex mutex_;
  std::string text_;
};

}  // namespace kadans
