// The files that a run reads: as they are now, against those of a record, and unpacked out of one.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kadans/app/assembly.h"
#include "kadans/telemetry/run_inputs.h"
#include "run_request.h"

namespace kadans {

// Scenario, robot, URDF, behaviors with their modules: text and all. Plug-ins by hash; meshes only as being there,
// since nothing is computed from them. By path.
std::vector<InputFile> input_files(const ScenarioConfig& scenario, const Assembly& assembly);

// Everything for the record of a run that is asked for so.
RunInputs inputs_of(const RunRequest& request, const ScenarioConfig& scenario, const Assembly& assembly);

// What is no longer as it was.
struct InputChange {
  std::string what;  // path of a file, or part of the program
  std::string how;   // "changed", "is gone", "is new"
};
// Files as they lie around the scenario now against the recorded ones; `added`: what a run reads that the record lacks.
std::vector<InputChange> changed_files(const RunInputs& recorded, const std::filesystem::path& scenario,
                                       const std::vector<InputFile>& added);
std::vector<InputChange> changed_program(const RunInputs& recorded);
// "behaviors/tulip/squat.lua changed, libm.so.6 changed"
std::string change_text(const std::vector<InputChange>& changes);

// For a record whose scenario lies here: its project's plug-ins are loaded when that is the project around the working
// directory, or `any_plugins`.
PluginGate plugins_beside(const std::filesystem::path& scenario, bool any_plugins);

// Where the scenario of a record is now: as it was written, in the project around the working directory or the record.
// Throws InputError when it is nowhere.
std::filesystem::path find_scenario(const RunInputs& recorded, const std::filesystem::path& record);

// The files of a record in a temporary folder of this user's alone, gone with this object. Each is made anew there, so
// nothing that exists is written to, and no link is followed. Native code never comes out of a record: a plug-in that
// it knows is the one of that path in the project around the working directory, and only if it is the same by its hash,
// or `any_plugins`.
class UnpackedInputs {
 public:
  // Throws InputError when a text is missing in the record, cannot be written, or a plug-in is not here as it was.
  UnpackedInputs(const RunInputs& recorded, const std::string& record, bool any_plugins);
  ~UnpackedInputs();
  UnpackedInputs(const UnpackedInputs&) = delete;
  UnpackedInputs& operator=(const UnpackedInputs&) = delete;

  // Behaviors of the project around the working directory that the record has not, for who wants to play them; from
  // then on they are among its inputs.
  void add_behaviors(RunInputs& inputs) const;

  const std::filesystem::path& scenario() const noexcept { return scenario_; }
  const PluginGate& plugins() const noexcept { return plugins_; }

 private:
  void unpack(const InputFile& file) const;
  void link_plugin(const InputFile& file, const std::string& record, bool any_plugins);

  std::filesystem::path folder_, scenario_;
  PluginGate plugins_;
  int owner_;  // a process split off later leaves the folder alone
};

}  // namespace kadans
