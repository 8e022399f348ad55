// Finds mistakes in files, for `kadans check` and `kadans behavior check`.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/assembly/robot.h"
#include "config/json/json_value.h"
#include "kadans/model/urdf.h"

namespace kadans {

struct CheckedFile {
  std::filesystem::path file;
  bool found = false;  // found in a folder: a file there that is not ours is passed over
};

class FileChecks {
 public:
  // `robot` is the configuration against which behaviors are checked; "": the one for their folder. Loading a plug-in
  // executes its code, which anybody may have written. So plug-ins are loaded only when `plugins` is true.
  FileChecks(std::string robot, bool plugins, UrdfOptions urdf = {});

  // Says what the file is, for people; "" for a JSON file found in a folder that is not ours. Throws InputError with
  // all mistakes.
  std::string check(const CheckedFile& checked);
  // Prints what the named files are, with those in named folders and of patterns ("config/*/robot.json"), or on stderr
  // their mistakes. `scripts_only`: only those in Lua. Returns the program's exit code. Throws InputError for a file
  // that does not exist, and where there is nothing to check.
  int print_all(const std::vector<std::string>& named, bool scripts_only);

 private:
  struct Known {
    Robot robot;
    std::unique_ptr<ControlSystem> system;
    std::unique_ptr<Snapshot> measured = std::make_unique<Snapshot>();  // for the names of what is measured
  };
  const Known& robot_at(const std::filesystem::path& config);
  const Known* robot_of(const std::filesystem::path& script, std::string& missing);
  std::string check_script_file(const CheckedFile& checked);  // "fits tulip", "a module", "tests"
  std::string check_json(const std::filesystem::path& file);

  std::string check_description_of(const std::filesystem::path& file);
  std::string check_robot(const std::filesystem::path& file);
  std::string told_robot(const RobotConfig& robot, const std::string& what) const;
  std::string check_scenario(const std::filesystem::path& file);

  std::string robot_;
  PluginGate gate_;
  UrdfOptions urdf_;
  std::map<std::filesystem::path, std::unique_ptr<Known>> robots_;  // the robots that were read
};

// Tells the kind of one of our JSON files by its keys, for a command that was given the wrong kind.
enum class JsonKind : std::uint8_t { other, scenario, robot, sweep, tuning };

std::optional<JsonKind> kind_in(const std::filesystem::path& file);  // nullopt: it cannot be read
// Throws InputError for a file of another kind; the message says what it is and which command takes it. A file that
// cannot be read, or whose kind is unknown, passes: its reader refuses it.
void require_kind(const std::filesystem::path& file, JsonKind wanted);

}  // namespace kadans
