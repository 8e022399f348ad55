// `kadans check` and `kadans behavior check`: what is wrong in files.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "checked_files.h"
#include "kadans/app/assembly.h"

namespace kadans {

class FileChecks {
 public:
  // `robot`: configuration that behaviors are checked against; "" = that of the folder they are in. A plug-in that is
  // loaded runs code of its own, whoever wrote it: only when `plugins` says so.
  FileChecks(std::string robot, bool plugins);

  // What it is, for people, "" for JSON that was found and is none of ours. Throws InputError with everything that is
  // wrong.
  std::string check(const CheckedFile& checked);
  // A file of Lua: "fits tulip", "a module", "tests". Throws InputError.
  std::string check_script_file(const CheckedFile& checked);

 private:
  struct Known {
    Robot robot;
    std::unique_ptr<ControlSystem> system;
  };
  const Known& robot_at(const std::filesystem::path& config);
  const Known* robot_of(const std::filesystem::path& script, std::string& missing);
  std::string check_json(const std::filesystem::path& file);

  std::string check_robot(const std::filesystem::path& file);
  std::string check_scenario(const std::filesystem::path& file);

  std::string robot_;
  PluginGate gate_;
  std::map<std::filesystem::path, std::unique_ptr<Known>> robots_;  // that were read
};

}  // namespace kadans
